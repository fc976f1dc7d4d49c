//! The checked model: every name looked up, every unit consistent. This is what the
//! derivation reads; it knows nothing of TOML, and nothing of how equations are derived.
//!
//! All numbers are in coherent SI units. The state of a model of order S is the
//! coordinates in the order of the specification, then each field's S modes, then the
//! rates of all these in the same order, then the states of first order in the order of the
//! specification.

use std::sync::Arc;

use crate::ast::BinaryOperator;
use crate::ids::{
    CoefficientId, ConstraintId, CoordinateId, DefinitionId, FieldId, InputId, ObservableId,
    ParameterId, PointId, StateId,
};
use crate::rigid_tree::RigidTree;
use crate::shape_table::ShapeTable;
use crate::source::Source;
use crate::span::Span;
use crate::unit::Unit;

/// The highest modal truncation order accepted.
pub const MAX_ORDER: usize = 128;

/// The parameter that says how fast emitted equations bring residuals of constraints back to
/// zero, in 1/s.
pub const STABILISATION_RATE: &str = "stabilisation_rate";

/// What the observable of a constraint's multiplier is called before the constraint's name.
pub const MULTIPLIER: &str = "lambda_";

/// What the observable of a constraint's residual is called before the constraint's name.
pub const RESIDUAL: &str = "residual_";

/// The most constraints accepted: what they cost grows with the cube of their number.
pub const MAX_CONSTRAINTS: usize = 100;

/// The most impacts accepted: what they cost grows with the cube of their number.
pub const MAX_IMPACTS: usize = 100;

/// A mechanical system: parameters, coordinates and the terms of its Lagrangian.
#[derive(Clone, Debug)]
pub struct Model {
    /// Identifier of the model (a valid Rust and C identifier).
    pub name: String,
    /// One line for people.
    pub title: String,
    /// The text the model was read from.
    pub source: Source,
    /// Parameters in the order of the specification.
    pub parameters: Vec<Parameter>,
    /// Generalised coordinates in the order of the specification, without the modes.
    pub coordinates: Vec<Coordinate>,
    /// Signals supplied at run time.
    pub inputs: Vec<Input>,
    /// States of first order, whose rates the specification gives.
    pub states: Vec<State>,
    /// Flexible fields.
    pub fields: Vec<Field>,
    /// Named expressions; a definition refers only to definitions before it in
    /// [`Model::definition_order`].
    pub definitions: Vec<Definition>,
    /// Terms of the kinetic energy, in J.
    pub kinetic: Vec<Term>,
    /// Terms of the potential energy, in J.
    pub potential: Vec<Term>,
    /// The frames and the bodies, if there are any. The energies above hold those of the bodies,
    /// as terms of the bodies' names.
    pub rigid_tree: Option<RigidTree<Expr>>,
    /// Rayleigh functions, in W: the force on coordinate j is minus the derivative by
    /// its rate.
    pub dissipation: Vec<Term>,
    /// Forces acting by virtual work.
    pub forces: Vec<Force>,
    /// Expressions that stay zero.
    pub constraints: Vec<Constraint>,
    /// Distances that do not fall below zero: bodies hit each other there.
    pub impacts: Vec<Impact>,
    /// Quantities to be reported; of each constraint its multiplier and its residual, last.
    /// `energy` and `power` are added to these for every model and are not in this list.
    pub observables: Vec<Observable>,
    /// Names the specification gives to coefficients of the derived equations.
    pub coefficients: Vec<Coefficient>,
    /// How measured channels differ from the quantities of the model.
    pub sensors: Vec<Sensor>,
    /// How the machine is drawn, if the specification says so. Nothing that is derived or emitted
    /// depends on it.
    pub drawing: Option<Drawing>,
    /// The parameters in an order such that each comes after those it refers to.
    pub parameter_order: Vec<ParameterId>,
    /// The definitions in an order such that each comes after those it refers to.
    pub definition_order: Vec<DefinitionId>,
}

/// A drawing of the machine in a plane: points that move and lines between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The points: `origin`, which is (0, 0), then those of the specification in its order.
    pub points: Vec<DrawnPoint>,
    /// The lines in the order of the specification.
    pub lines: Vec<DrawnLine>,
}

/// A point of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPoint {
    /// Its name.
    pub name: String,
    /// To the right, in m.
    pub x: Ordinate,
    /// Upwards, in m.
    pub y: Ordinate,
    /// Where x and y stand.
    pub spans: [Span; 2],
}

/// What places a point along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ordinate {
    /// A number, in m.
    Number(f64),
    /// A coordinate that is a length.
    Coordinate(CoordinateId),
    /// An observable that is a length.
    Observable(ObservableId),
}

/// A line of a drawing, from point to point.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLine {
    /// Its name.
    pub name: String,
    /// Two points or more.
    pub points: Vec<PointId>,
}

/// A parameter of the model.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// ASCII name.
    pub name: String,
    /// The unit the specification declares; the value below is already in SI.
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Where its value comes from ("Table I", "assumed: ...", "fitted to ...").
    pub origin: String,
    /// A number in SI, or an expression in other parameters.
    pub value: ParameterValue,
    /// Smallest admissible value in SI, if stated.
    pub min: Option<f64>,
    /// Largest admissible value in SI, if stated.
    pub max: Option<f64>,
    /// What is not known of its value, if stated.
    pub uncertainty: Option<Uncertainty>,
    /// Where its name stands.
    pub span: Span,
}

/// What is not known of a parameter's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uncertainty {
    /// It is normal, with this standard deviation as a part of the value.
    Relative(f64),
    /// It is normal, with this standard deviation in SI.
    StandardDeviation(f64),
    /// It lies between these ends, in SI, anywhere alike.
    Between([f64; 2]),
}

/// The value of a parameter.
#[derive(Clone, Debug)]
pub enum ParameterValue {
    /// A number in SI.
    Number(f64),
    /// An expression in other parameters (no coordinate, input, time or field).
    Expression(Expr),
}

/// A generalised coordinate.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// ASCII name.
    pub name: String,
    /// Its unit (coherent SI).
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Initial value (parameters only), 0 if absent.
    pub initial: Option<Expr>,
    /// Initial rate (parameters only), 0 if absent.
    pub initial_rate: Option<Expr>,
    /// Where it lives, if the specification says so.
    pub range: Option<Range>,
    /// Where its name stands.
    pub span: Span,
}

/// Interval of a coordinate, an input or a state. The model makes no statement outside.
#[derive(Clone, Debug)]
pub struct Range {
    /// The lower end (parameters only).
    pub low: Expr,
    /// The upper end (parameters only), above the lower one.
    pub high: Expr,
    /// Where both stand.
    pub span: Span,
}

/// A signal supplied at run time.
#[derive(Clone, Debug)]
pub struct Input {
    /// ASCII name.
    pub name: String,
    /// Its unit (coherent SI).
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Where it lives, if the specification says so.
    pub range: Option<Range>,
    /// The input that is its rate, if that is given: of prescribed motion s this is `s_dot`, of
    /// `s_dot` it is `s_ddot`.
    pub rate: Option<InputId>,
    /// The input that it is the rate of, if it is one.
    pub rate_of: Option<InputId>,
    /// Where its name stands.
    pub span: Span,
}

/// A state of first order z, with dz/dt = `rate`: a filter, an actuator, a current.
#[derive(Clone, Debug)]
pub struct State {
    /// ASCII name.
    pub name: String,
    /// Its unit (coherent SI).
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Its rate, in its unit per s: an expression of coordinates, rates, states, inputs,
    /// parameters and time. The rates of states that it holds, in definitions too, lead to no
    /// circle.
    pub rate: Expr,
    /// Initial value (parameters only), 0 if absent.
    pub initial: Option<Expr>,
    /// Interval outside which the model makes no statement, if the specification gives one.
    pub range: Option<Range>,
    /// Where its name stands.
    pub span: Span,
}

/// A flexible field w(x, t) = sum over i of phi_i(x) q_i(t), x from `from` to `to`.
#[derive(Clone, Debug)]
pub struct Field {
    /// ASCII name, `w` in the paper.
    pub name: String,
    /// Unit of the field and of its mode coordinates (phi is dimensionless).
    pub unit: Unit,
    /// Name of the position variable inside the field's functions.
    pub along: String,
    /// Start of the domain (parameters only).
    pub from: Expr,
    /// End of the domain (parameters only).
    pub to: Expr,
    /// The mode shapes.
    pub basis: Basis,
    /// Name of the mode coordinates: `q` gives `q_1 .. q_S`.
    pub coordinates: String,
    /// The specification's default order.
    pub order: usize,
    /// What it is.
    pub doc: String,
    /// Where its name stands.
    pub span: Span,
}

/// The mode shapes of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Basis {
    /// The elastic modes of a uniform beam. Clamped and free: Eq. (17) with beta_r l the roots of
    /// cos z cosh z = -1 and the corrected xi_r. A rod in tension or torsion, or a string, fixed
    /// at an end has the shapes of a beam pinned there, one free at an end those of a beam guided
    /// there. In a specification `"clamped_free"`, `"string"` and so on.
    Beam {
        /// The end at `from`.
        from: End,
        /// The end at `to`.
        to: End,
    },
    /// Eq. (17) with beta_r and xi_r as Eq. (18) and (19) print them, for comparison
    /// only: these shapes are not orthogonal and violate the free end's conditions.
    /// In a specification `"clamped_free_printed"`.
    ClampedFreePrinted,
    /// Shapes from a file, between whose rows a cubic spline runs. They belong to
    /// s = (x - from)/(to - from): another length stretches them. In a specification `"table"`.
    Table {
        /// The shapes.
        table: Arc<ShapeTable>,
        /// Where the file's name stands.
        span: Span,
    },
}

impl Basis {
    /// The table of a basis that has one.
    pub fn table(&self) -> Option<&ShapeTable> {
        match self {
            Self::Table { table, .. } => Some(table),
            Self::Beam { .. } | Self::ClampedFreePrinted => None,
        }
    }

    /// The beam of the paper.
    pub const CLAMPED_FREE: Self = Self::Beam {
        from: End::Clamped,
        to: End::Free,
    };
}

/// What holds the end of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum End {
    /// No deflection and no slope.
    Clamped,
    /// No deflection and no moment.
    Pinned,
    /// No moment and no shear.
    Free,
    /// No slope and no shear: it slides across the beam without turning.
    Guided,
}

/// A named expression of coordinates, rates, inputs, parameters and time (no bare field or
/// position: a field appears through `at`, `integral` or `sum`).
#[derive(Clone, Debug)]
pub struct Definition {
    /// ASCII name.
    pub name: String,
    /// What it stands for.
    pub value: Expr,
    /// Its unit, inferred.
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Where its name stands.
    pub span: Span,
}

/// A named term of an energy or of the dissipation.
#[derive(Clone, Debug)]
pub struct Term {
    /// The term's own name.
    pub name: String,
    /// Its value.
    pub value: Expr,
    /// What it is.
    pub doc: String,
    /// Where it comes from ("Eq. (21)", "fitted to ...").
    pub origin: String,
    /// Where its name stands.
    pub span: Span,
}

/// A force that acts by virtual work: Q_j = value * d(on)/d(q_j).
#[derive(Clone, Debug)]
pub struct Force {
    /// The force's own name.
    pub name: String,
    /// What it does work on: an expression of coordinates (often a coordinate or a
    /// definition), free of rates and inputs.
    pub on: Expr,
    /// The force or torque.
    pub value: Expr,
    /// What it is.
    pub doc: String,
    /// Where it comes from ("Eq. (11)", "fitted to ...").
    pub origin: String,
    /// Where its name stands.
    pub span: Span,
}

/// The name of an entry as the specification writes it at `span`: that of the vector for a component.
pub fn written_name<'n>(name: &'n str, span: Span, source: &Source) -> &'n str {
    match source.text.get(span.start..span.end) {
        Some(text) if !text.is_empty() && name.starts_with(text) => &name[..text.len()],
        _ => name,
    }
}

/// An expression that stays zero along the motion. Its force on the coordinates is A^T lambda, A
/// the derivative of the expression by the coordinates or, of a nonholonomic one, by their rates.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// ASCII name.
    pub name: String,
    /// What stays zero: of coordinates, prescribed motion and time, or linear in the rates.
    pub zero: Expr,
    /// Whether it holds rates: its multiplier is then in W per unit of the expression, else in J.
    pub is_nonholonomic: bool,
    /// Its unit, inferred.
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Where it comes from.
    pub origin: String,
    /// Where its name stands.
    pub span: Span,
}

/// A unilateral contact: a distance g(q, t) that does not fall below zero. Where it falls to zero the
/// rates jump by M^-1 A^T P, A the distance's derivative by the coordinates and P an impulse that is
/// not negative, so that its rate comes back as restitution times what it was (Newton).
#[derive(Clone, Debug)]
pub struct Impact {
    /// ASCII name.
    pub name: String,
    /// The distance: of coordinates, prescribed motion and time.
    pub when: Expr,
    /// The part of its rate that comes back, from 0 to 1, of parameters.
    pub restitution: Expr,
    /// The distance's unit, inferred.
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Where it comes from.
    pub origin: String,
    /// Where its name stands.
    pub span: Span,
}

/// A quantity to be reported.
#[derive(Clone, Debug)]
pub struct Observable {
    /// ASCII name.
    pub name: String,
    /// Its value (no accelerations).
    pub value: Expr,
    /// The observable whose time derivative it is instead, if it is one; see
    /// [`Model::observe_rate`].
    pub rate_of: Option<ObservedRate>,
    /// Its unit (coherent SI), inferred, and checked against the declared one if any.
    pub unit: Unit,
    /// What it is.
    pub doc: String,
    /// Where its name stands.
    pub span: Span,
}

/// A time derivative of an observable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObservedRate {
    /// Place of the observable in [`Model::observables`].
    pub observable: usize,
    /// 1 for the rate, 2 for the acceleration.
    pub times: u8,
}

/// A name for a coefficient of the derived accelerations, as Eq. (22) names them.
#[derive(Clone, Debug)]
pub struct Coefficient {
    /// ASCII name; for one per mode the names are listed by the derivation as
    /// `name_1 ..` unless `names` says otherwise.
    pub name: String,
    /// What it names.
    pub kind: CoefficientKind,
    /// The field for each of whose modes it is given, if its specification says so
    /// (`each = "w[i]"`); `phi[i]` then stands outside any sum.
    pub each: Option<FieldId>,
    /// What it is.
    pub doc: String,
    /// Where its name stands.
    pub span: Span,
}

/// What a coefficient names.
#[derive(Clone, Debug)]
pub enum CoefficientKind {
    /// An expression of parameters and of coefficients listed before it.
    Value(Expr),
    /// The factor with which `by` enters the acceleration of `of`, times `times`.
    Factor {
        /// The coordinate (or, with a field's mode coordinates, every mode) whose
        /// acceleration is meant.
        of: Expr,
        /// The quantity it multiplies: a coordinate, a rate, `deadzone(p, b)`,
        /// `contact(p, b)*dot(p)`, a field's mode coordinates, or 1 for what is left.
        by: Expr,
        /// A factor to multiply with (parameters and earlier coefficients), if any.
        times: Option<Expr>,
    },
}

/// A measured channel: measured(t) = gain * quantity(t - delay) + bias.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Its name.
    pub channel: String,
    /// What it measures: a coordinate, a rate (`NAME_dot`), an observable, `energy` or `power`.
    pub observable: String,
    /// Dimensionless, 1 for a true sensor.
    pub gain: f64,
    /// In the channel's SI unit.
    pub bias: f64,
    /// In s, negative where the channel is early.
    pub delay: f64,
    /// Where what it measures is said.
    pub span: Span,
}

/// An expression with every name looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What stands here.
    pub kind: ExprKind,
    /// Where it stands.
    pub span: Span,
}

impl Expr {
    /// Shows this expression and all its parts to `see`, the whole before its parts.
    pub fn visit(&self, see: &mut impl FnMut(&Expr)) {
        see(self);
        match &self.kind {
            ExprKind::Number(_)
            | ExprKind::Pi
            | ExprKind::Time
            | ExprKind::Position(_)
            | ExprKind::Parameter(_)
            | ExprKind::Coordinate(_)
            | ExprKind::Input(_)
            | ExprKind::State(_)
            | ExprKind::Definition(_)
            | ExprKind::Coefficient(_)
            | ExprKind::Multiplier(_)
            | ExprKind::Residual(_)
            | ExprKind::Field(_)
            | ExprKind::ModeCoordinate(_)
            | ExprKind::ModeShape(_) => {}
            ExprKind::Dot(part) | ExprKind::Diff(part, _) | ExprKind::Negate(part) => {
                part.visit(see);
            }
            ExprKind::Integral { integrand, .. } => integrand.visit(see),
            ExprKind::Sum { summand, .. } => summand.visit(see),
            ExprKind::At {
                value, position, ..
            } => {
                value.visit(see);
                position.visit(see);
            }
            ExprKind::Binary(_, left, right) => {
                left.visit(see);
                right.visit(see);
            }
            ExprKind::Call(_, arguments) => {
                for argument in arguments {
                    argument.visit(see);
                }
            }
        }
    }
}

/// The forms of a checked expression.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// A number (literals carry no unit; in SI).
    Number(f64),
    /// The constant pi.
    Pi,
    /// The time t, in s.
    Time,
    /// The position along a field, inside that field's functions only.
    Position(FieldId),
    /// A parameter.
    Parameter(ParameterId),
    /// A generalised coordinate (not a mode).
    Coordinate(CoordinateId),
    /// An input.
    Input(InputId),
    /// A state of first order.
    State(StateId),
    /// A definition.
    Definition(DefinitionId),
    /// An earlier entry of [`Model::coefficients`], inside coefficients only.
    Coefficient(CoefficientId),
    /// The multiplier of a constraint, in observables only.
    Multiplier(ConstraintId),
    /// What the expression of a constraint is, in observables only.
    Residual(ConstraintId),
    /// A field w(x, t), inside that field's `integral`, `at` or `diff` only.
    Field(FieldId),
    /// A field's mode coordinate `q[i]`, i the index of the innermost enclosing sum
    /// over that field.
    ModeCoordinate(FieldId),
    /// A field's mode shape `phi[i]`, a function of the position, i as above.
    ModeShape(FieldId),
    /// The time derivative of a coordinate, definition, field, mode coordinate or state.
    Dot(Box<Expr>),
    /// The derivative of an expression in the field (`w`, `dot(w)` or `phi[i]`) by the
    /// position, this many times (1 to 4).
    Diff(Box<Expr>, u8),
    /// `at(expression, position)` of field `field`: a function of the position,
    /// evaluated at `position` (parameters only).
    At {
        /// The field whose position is replaced.
        field: FieldId,
        /// The function of the position.
        value: Box<Expr>,
        /// Where to evaluate it.
        position: Box<Expr>,
    },
    /// The integral of an expression over the field's domain.
    Integral {
        /// The field whose domain is meant.
        field: FieldId,
        /// The integrand, a function of the position.
        integrand: Box<Expr>,
    },
    /// The sum over the field's modes; 0 at order 0.
    Sum {
        /// The field whose modes are meant.
        field: FieldId,
        /// The summand, with `q[i]` and `phi[i]`.
        summand: Box<Expr>,
    },
    /// `-operand`.
    Negate(Box<Expr>),
    /// `left operator right`.
    Binary(BinaryOperator, Box<Expr>, Box<Expr>),
    /// A function of one or two scalar arguments.
    Call(Function, Vec<Expr>),
}

/// The functions of the expression language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// Sine of an angle.
    Sin,
    /// Cosine of an angle.
    Cos,
    /// Tangent of an angle.
    Tan,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Inverse tangent.
    Atan,
    /// `atan2(y, x)`, the angle of the point (x, y); both of one unit.
    Atan2,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Exponential function.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Square root.
    Sqrt,
    /// Absolute value; switches at 0.
    Abs,
    /// Sign, with sign(0) = 0; switches at 0.
    Sign,
    /// The smaller of two; switches where they are equal.
    Min,
    /// The larger of two; switches where they are equal.
    Max,
    /// `deadzone(p, b)`, f_k of Eq. (7).
    Deadzone,
    /// `contact(p, b)`, 1 where |p| > b and 0 elsewhere, Eq. (8) without the rate.
    Contact,
    /// `above(p)`, 1 where p > 0 and 0 elsewhere.
    Above,
}
