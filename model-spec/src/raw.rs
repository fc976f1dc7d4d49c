//! A specification as its file says it: names, numbers and expressions with their places,
//! nothing looked up and nothing parsed. Made by `document` and `entries`, read by
//! `resolve`.

use crate::model::{Basis, STABILISATION_RATE};
use crate::span::Span;
use crate::table::{Name, Number, Quantity, Written};

/// A specification as written.
#[derive(Debug)]
pub struct Document {
    /// `name` of `[model]`, with its quotes' place.
    pub name: Name,
    /// `title` of `[model]`.
    pub title: String,
    /// `gravity` of `[model]`: the acceleration of free fall, along the fixed axes.
    pub gravity: Option<Vec<Quantity>>,
    /// `[parameters]`
    pub parameters: Vec<RawParameter>,
    /// `[coordinates]`
    pub coordinates: Vec<RawCoordinate>,
    /// `[inputs]`
    pub inputs: Vec<RawInput>,
    /// `[states]`
    pub states: Vec<RawState>,
    /// `[fields.NAME]`
    pub fields: Vec<RawField>,
    /// `[definitions]`
    pub definitions: Vec<RawTerm>,
    /// Those of `[definitions]` that are vectors; their components are among the definitions.
    pub vectors: Vec<Name>,
    /// `[frames.NAME]`
    pub frames: Vec<RawFrame>,
    /// `[bodies.NAME]`
    pub bodies: Vec<RawBody>,
    /// `[kinetic]`
    pub kinetic: Vec<RawTerm>,
    /// `[potential]`
    pub potential: Vec<RawTerm>,
    /// `[dissipation]`
    pub dissipation: Vec<RawTerm>,
    /// `[forces]`: each with what it works on.
    pub forces: Vec<(RawTerm, Quantity)>,
    /// `[constraints]`
    pub constraints: Vec<RawTerm>,
    /// `[impacts]`: each with its restitution.
    pub impacts: Vec<(RawTerm, Quantity)>,
    /// `[observables]`: each with its declared unit.
    pub observables: Vec<(RawTerm, Option<Written>)>,
    /// `[coefficients]`
    pub coefficients: Vec<RawCoefficient>,
    /// `[sensors.CHANNEL]`
    pub sensors: Vec<RawSensor>,
    /// `[drawing]`
    pub drawing: Option<RawDrawing>,
}

impl Document {
    /// Where there are constraints, how fast emitted equations bring them back to zero is a
    /// parameter: 0 unless the specification declares it.
    pub fn declare_stabilisation_rate(&mut self) {
        let Some(first) = self.constraints.first() else {
            return;
        };
        let mut names = self.parameters.iter().map(|parameter| &parameter.name.text);
        if names.any(|name| name == STABILISATION_RATE) {
            return;
        }
        let span = first.name.span;
        self.parameters.push(RawParameter {
            name: Name {
                text: STABILISATION_RATE.to_owned(),
                span,
            },
            value: Quantity::Number(Number { value: 0.0, span }),
            unit: Some(Written::inferred("1/s", span)),
            doc: "how fast residuals of constraints decay (Baumgarte)".to_owned(),
            origin: "0: not at all".to_owned(),
            min: None,
            max: None,
            uncertainty: None,
        });
    }
}

/// A `[drawing]`.
#[derive(Debug)]
pub struct RawDrawing {
    /// `[drawing.points]`
    pub points: Vec<RawPoint>,
    /// `[drawing.lines]`
    pub lines: Vec<RawLine>,
}

/// An entry of `[drawing.points]`.
#[derive(Debug)]
pub struct RawPoint {
    /// Its key.
    pub name: Name,
    /// `x`
    pub x: Quantity,
    /// `y`
    pub y: Quantity,
}

/// An entry of `[drawing.lines]`.
#[derive(Debug)]
pub struct RawLine {
    /// Its key.
    pub name: Name,
    /// The names of its points.
    pub points: Vec<Written>,
}

/// An entry of `[parameters]`.
#[derive(Debug)]
pub struct RawParameter {
    /// Its key.
    pub name: Name,
    /// `value`
    pub value: Quantity,
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
    /// `source`
    pub origin: String,
    /// `min`
    pub min: Option<Number>,
    /// `max`
    pub max: Option<Number>,
    /// `uncertainty`
    pub uncertainty: Option<RawUncertainty>,
}

/// The `uncertainty` of a parameter.
#[derive(Debug)]
pub enum RawUncertainty {
    /// `relative`
    Relative(Number),
    /// `sd`
    StandardDeviation(Number),
    /// `between`
    Between([Number; 2]),
}

/// An entry of `[coordinates]`.
#[derive(Debug)]
pub struct RawCoordinate {
    /// Its key.
    pub name: Name,
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
    /// `initial`
    pub initial: Option<Quantity>,
    /// `initial_rate`
    pub initial_rate: Option<Quantity>,
    /// `range`
    pub range: Option<RawRange>,
}

/// A `range` of a coordinate, an input or a state.
#[derive(Debug)]
pub struct RawRange {
    /// The lower end.
    pub low: Quantity,
    /// The upper end.
    pub high: Quantity,
    /// Where both stand.
    pub span: Span,
}

/// An entry of `[inputs]`.
#[derive(Debug)]
pub struct RawInput {
    /// Its key.
    pub name: Name,
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
    /// `range`
    pub range: Option<RawRange>,
    /// Which rate of the input that the entry names it is: 0 for the input itself.
    pub rate_order: u8,
    /// How many rates follow it.
    pub rates: u8,
}

impl RawInput {
    /// The input, then the rates that are given with it: `s`, `s_dot`, `s_ddot`.
    pub fn with_rates(self) -> Vec<Self> {
        let rate = |order: u8, suffix: &str| Self {
            name: Name {
                text: format!("{}_{suffix}", self.name.text),
                span: self.name.span,
            },
            unit: self.unit.clone(),
            doc: match order {
                1 => format!("rate of {}", self.name.text),
                _ => format!("second rate of {}", self.name.text),
            },
            range: None,
            rate_order: order,
            rates: self.rates - order,
        };
        let rates: Vec<Self> = (1..=self.rates)
            .zip(["dot", "ddot"])
            .map(|(order, suffix)| rate(order, suffix))
            .collect();
        std::iter::once(self).chain(rates).collect()
    }
}

/// The mode shapes that a field asks for.
#[derive(Debug)]
pub enum RawBasis {
    /// Those of a formula.
    Named(Basis),
    /// Those of the file `table`.
    Table(Written),
}

/// An entry of `[states]`.
#[derive(Debug)]
pub struct RawState {
    /// Its key.
    pub name: Name,
    /// `unit`
    pub unit: Option<Written>,
    /// `rate`
    pub rate: Quantity,
    /// `initial`
    pub initial: Option<Quantity>,
    /// `range`
    pub range: Option<RawRange>,
    /// `doc`
    pub doc: String,
}

/// A `[fields.NAME]`.
#[derive(Debug)]
pub struct RawField {
    /// Its key.
    pub name: Name,
    /// `along`
    pub along: Name,
    /// `from`
    pub from: Quantity,
    /// `to`
    pub to: Quantity,
    /// `basis`
    pub basis: RawBasis,
    /// `coordinates`
    pub coordinates: Name,
    /// `order` and its place.
    pub order: (i64, Span),
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
}

/// A named expression.
#[derive(Debug)]
pub struct RawTerm {
    /// Its key.
    pub name: Name,
    /// The expression.
    pub value: Quantity,
    /// `doc`
    pub doc: String,
    /// `source`
    pub origin: String,
}

/// A `[frames.NAME]`.
#[derive(Debug)]
pub struct RawFrame {
    /// Its key.
    pub name: Name,
    /// `in`: the frame it is placed in; the fixed axes if absent.
    pub parent: Option<Written>,
    /// `origin`: a vector along the parent's axes.
    pub origin: Option<Quantity>,
    /// `rotation`: from its own axes to the parent's.
    pub rotation: Option<Written>,
    /// `doc`
    pub doc: String,
}

/// A `[bodies.NAME]`.
#[derive(Debug)]
pub struct RawBody {
    /// Its key.
    pub name: Name,
    /// `frame`
    pub frame: Written,
    /// `mass`; a body without one has inertia only.
    pub mass: Option<Quantity>,
    /// `centre`: a vector along the frame's axes.
    pub centre: Option<Quantity>,
    /// `inertia`: three principal moments or six elements, about the centre of mass.
    pub inertia: Option<Vec<Quantity>>,
    /// `doc`
    pub doc: String,
    /// `source`
    pub origin: String,
}

/// An entry of `[coefficients]`.
#[derive(Debug)]
pub struct RawCoefficient {
    /// Its key.
    pub name: Name,
    /// What it names.
    pub kind: RawCoefficientKind,
    /// `each`: the field and index it is given for, as `w[i]`.
    pub each: Option<Written>,
    /// `doc`
    pub doc: String,
}

/// What an entry of `[coefficients]` names.
#[derive(Debug)]
pub enum RawCoefficientKind {
    /// `value`
    Value(Quantity),
    /// `of`, `by` and `times`
    Factor(Quantity, Quantity, Option<Quantity>),
}

/// A `[sensors.CHANNEL]`.
#[derive(Debug)]
pub struct RawSensor {
    /// The channel.
    pub channel: Name,
    /// What it measures, where that is not its name.
    pub observable: Option<Written>,
    /// `gain`, 1 if absent.
    pub gain: f64,
    /// `bias` in the channel's unit, 0 if absent.
    pub bias: f64,
    /// `delay` in s, negative where it is early; 0 if absent.
    pub delay: f64,
}
