//! Specification as read from TOML: names, numbers and unparsed expressions, with their positions. `document` and
//! `entries` create it, and `resolve` reads it.

use crate::model::{Basis, STABILISATION_RATE};
use crate::quantity::{Name, Number, Quantity, StringValue};
use crate::span::Span;

#[derive(Debug)]
pub struct Document {
    /// `name` of `[model]`; the span includes its quotes.
    pub name: Name,
    pub title: String,
    /// Acceleration of free fall, as components along the fixed axes.
    pub gravity: Option<Vec<Quantity>>,
    pub parameters: Vec<RawParameter>,
    pub coordinates: Vec<RawCoordinate>,
    pub inputs: Vec<RawInput>,
    pub states: Vec<RawState>,
    pub fields: Vec<RawField>,
    pub definitions: Vec<RawTerm>,
    /// Names of the vectors in `[definitions]`; their components are among the definitions.
    pub vectors: Vec<Name>,
    pub frames: Vec<RawFrame>,
    pub bodies: Vec<RawBody>,
    pub kinetic: Vec<RawTerm>,
    pub potential: Vec<RawTerm>,
    pub dissipation: Vec<RawTerm>,
    /// Each force with the quantity it acts on.
    pub forces: Vec<(RawTerm, Quantity)>,
    pub constraints: Vec<RawTerm>,
    pub impacts: Vec<RawImpact>,
    /// Each observable with its declared unit.
    pub observables: Vec<(RawTerm, Option<StringValue>)>,
    pub coefficients: Vec<RawCoefficient>,
    pub sensors: Vec<RawSensor>,
    pub controllers: Vec<RawController>,
    pub drawing: Option<RawDrawing>,
}

impl Document {
    /// Adds the parameter for the decay rate of constraint residuals, 0, if the specification has
    /// constraints and does not declare it.
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
            unit: Some(StringValue::without_text("1/s", span)),
            doc: "decay rate of constraint residuals (Baumgarte)".to_owned(),
            origin: "default: no stabilisation".to_owned(),
            min: None,
            max: None,
            uncertainty: None,
        });
    }
}

#[derive(Debug)]
pub struct RawDrawing {
    pub points: Vec<RawPoint>,
    pub lines: Vec<RawLine>,
}

#[derive(Debug)]
pub struct RawPoint {
    pub name: Name,
    pub x: Quantity,
    pub y: Quantity,
}

#[derive(Debug)]
pub struct RawLine {
    pub name: Name,
    pub points: Vec<StringValue>,
}

#[derive(Debug)]
pub struct RawParameter {
    pub name: Name,
    pub value: Quantity,
    pub unit: Option<StringValue>,
    pub doc: String,
    /// `source`
    pub origin: String,
    pub min: Option<Number>,
    pub max: Option<Number>,
    pub uncertainty: Option<RawUncertainty>,
}

#[derive(Debug)]
pub enum RawUncertainty {
    Relative(Number),
    StandardDeviation(Number),
    Between([Number; 2]),
}

#[derive(Debug)]
pub struct RawCoordinate {
    pub name: Name,
    pub unit: Option<StringValue>,
    pub doc: String,
    pub initial: Option<Quantity>,
    pub initial_rate: Option<Quantity>,
    pub range: Option<RawRange>,
}

/// The `range` of a coordinate, an input or a state.
#[derive(Debug)]
pub struct RawRange {
    pub low: Quantity,
    pub high: Quantity,
    /// Position of the array.
    pub span: Span,
}

#[derive(Debug)]
pub struct RawInput {
    pub name: Name,
    pub unit: Option<StringValue>,
    pub doc: String,
    pub range: Option<RawRange>,
    /// Order of the derivative: 0 for the input itself, 1 for `s_dot`, 2 for `s_ddot`.
    pub rate_order: u8,
    /// Number of given time derivatives of this input.
    pub rates: u8,
}

impl RawInput {
    /// Returns the input and its given rates: `s`, `s_dot`, `s_ddot`.
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

#[derive(Debug)]
pub enum RawBasis {
    /// Shapes with a formula, selected by name.
    Named(Basis),
    /// Shapes from a file.
    Table(StringValue),
}

#[derive(Debug)]
pub struct RawState {
    pub name: Name,
    pub unit: Option<StringValue>,
    pub rate: Quantity,
    pub initial: Option<Quantity>,
    pub range: Option<RawRange>,
    pub doc: String,
}

#[derive(Debug)]
pub struct RawField {
    pub name: Name,
    pub along: Name,
    pub from: Quantity,
    pub to: Quantity,
    pub basis: RawBasis,
    pub coordinates: Name,
    /// `order` and its position.
    pub order: (i64, Span),
    pub unit: Option<StringValue>,
    pub doc: String,
}

#[derive(Debug)]
pub struct RawTerm {
    pub name: Name,
    pub value: Quantity,
    pub doc: String,
    /// `source`
    pub origin: String,
}

/// Unilateral contact: its distance with name and origin.
#[derive(Debug)]
pub struct RawImpact {
    pub distance: RawTerm,
    pub restitution: Quantity,
    pub friction: Option<RawContactFriction>,
}

#[derive(Debug)]
pub struct RawContactFriction {
    pub coefficient: Quantity,
    /// Tangential velocity of the contact.
    pub slip: Quantity,
}

#[derive(Debug)]
pub struct RawFrame {
    pub name: Name,
    /// Frame of reference; the fixed axes if absent.
    pub parent: Option<StringValue>,
    /// Position, along the axes of the parent.
    pub origin: Option<Quantity>,
    /// Rotation from the frame's axes to the parent's.
    pub rotation: Option<StringValue>,
    pub doc: String,
}

#[derive(Debug)]
pub struct RawBody {
    pub name: Name,
    pub frame: StringValue,
    /// A body without a mass has only inertia.
    pub mass: Option<Quantity>,
    /// Centre of mass, along the axes of the frame.
    pub centre: Option<Quantity>,
    /// Three principal moments or six elements, about the centre of mass.
    pub inertia: Option<Vec<Quantity>>,
    pub doc: String,
    /// `source`
    pub origin: String,
}

#[derive(Debug)]
pub struct RawCoefficient {
    pub name: Name,
    pub kind: RawCoefficientKind,
    /// Field and index of a family of coefficients, as `w[i]`.
    pub each: Option<StringValue>,
    pub doc: String,
}

/// Form of an entry of `[coefficients]`.
#[derive(Debug)]
pub enum RawCoefficientKind {
    Value(Quantity),
    /// The keys `of`, `by` and `times`.
    Factor(Quantity, Quantity, Option<Quantity>),
}

#[derive(Debug)]
pub struct RawSensor {
    pub channel: Name,
    /// Observable that the sensor measures; the channel's name if absent.
    pub observable: Option<StringValue>,
    /// Gain; 1 if absent.
    pub gain: f64,
    /// Bias in the channel's unit; 0 if absent.
    pub bias: f64,
    /// Delay in s, negative for an early signal; 0 if absent.
    pub delay: f64,
}

#[derive(Debug)]
pub struct RawController {
    pub name: Name,
    pub period: RawTime,
    pub offset: RawTime,
    pub delay: RawTime,
    pub states: Vec<RawControllerState>,
    pub outputs: Vec<(Name, Quantity)>,
    pub doc: String,
}

/// Time with the unit of a plain number; s if absent.
#[derive(Debug)]
pub struct RawTime {
    pub value: Quantity,
    pub unit: Option<StringValue>,
}

#[derive(Debug)]
pub struct RawControllerState {
    pub name: Name,
    pub unit: Option<StringValue>,
    pub next: Quantity,
    pub initial: Option<Quantity>,
    pub doc: String,
}
