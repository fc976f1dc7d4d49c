//! Checked model: every name is resolved and every unit is consistent. It is the input of the derivation and
//! independent of TOML.
//!
//! All numbers are in coherent SI units. The state of a model of order S contains the coordinates in the order of the
//! specification, the S modes of each field, the rates of coordinates and modes in the same order, and the
//! first-order states.

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

pub use crate::function::Function;

/// Highest modal truncation order accepted.
pub const MAX_ORDER: usize = 128;

/// Name of the parameter for the decay rate of constraint residuals in emitted equations, 1/s.
pub const STABILISATION_RATE: &str = "stabilisation_rate";

/// Origin of a parameter of value 1 that gives a unit to the numbers of a prescribed input.
pub const UNIT_FACTOR_ORIGIN: &str = "unit of a number in a prescribed input";

/// Prefix of the observable for the multiplier of a constraint.
pub const MULTIPLIER: &str = "lambda_";

/// Prefix of the observable for the residual of a constraint.
pub const RESIDUAL: &str = "residual_";

/// Largest number of constraints: the cost grows with the cube of their number.
pub const MAX_CONSTRAINTS: usize = 100;

/// Largest number of impacts: the cost grows with the cube of their number.
pub const MAX_IMPACTS: usize = 100;

/// Mechanical system: parameters, coordinates and the terms of its Lagrangian.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the model, a valid Rust and C identifier.
    pub name: String,
    /// Title in one line.
    pub title: String,
    /// Text of the specification.
    pub source: Source,
    /// Parameters that were changed, with their values in declared units.
    pub settings: Vec<(String, f64)>,
    /// Parameters in the order of the specification.
    pub parameters: Vec<Parameter>,
    /// Generalised coordinates in the order of the specification, without the modes.
    pub coordinates: Vec<Coordinate>,
    /// Signals supplied at run time.
    pub inputs: Vec<Input>,
    /// First-order states, with rates given by the specification.
    pub states: Vec<State>,
    /// Flexible fields.
    pub fields: Vec<Field>,
    /// Named expressions; each refers only to earlier ones in [`Model::definition_order`].
    pub definitions: Vec<Definition>,
    /// Terms of the kinetic energy, in J.
    pub kinetic: Vec<Term>,
    /// Terms of the potential energy, in J.
    pub potential: Vec<Term>,
    /// Frames and bodies, if any. The energies above contain those of the bodies, as terms with the
    /// bodies' names.
    pub rigid_tree: Option<RigidTree<Expr>>,
    /// Rayleigh functions, in W: the force on coordinate j is minus the derivative with respect to
    /// its rate.
    pub dissipation: Vec<Term>,
    /// Forces acting by virtual work.
    pub forces: Vec<Force>,
    /// Constraints, holonomic or nonholonomic.
    pub constraints: Vec<Constraint>,
    /// Unilateral contacts with impacts.
    pub impacts: Vec<Impact>,
    /// Observables of the specification, then the multiplier and the residual of each constraint.
    /// `energy` and `power` exist in every model and are not in this list.
    pub observables: Vec<Observable>,
    /// Names that the specification gives to coefficients of the derived equations.
    pub coefficients: Vec<Coefficient>,
    /// Gain, bias and delay of measured channels.
    pub sensors: Vec<Sensor>,
    /// Sampled controllers. They are not part of the equations.
    pub controllers: Vec<Controller>,
    /// Drawing of the machine, if the specification has one. Derivation and emission do not use it.
    pub drawing: Option<Drawing>,
    /// Parameters in dependency order.
    pub parameter_order: Vec<ParameterId>,
    /// Definitions in dependency order.
    pub definition_order: Vec<DefinitionId>,
}

/// Drawing of the machine in a plane: moving points, and lines between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Points: `origin` at (0, 0), then those of the specification in its order.
    pub points: Vec<DrawnPoint>,
    /// Lines in the order of the specification.
    pub lines: Vec<DrawnLine>,
}

/// Point of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPoint {
    /// Name.
    pub name: String,
    /// Ordinate to the right, in m.
    pub x: Ordinate,
    /// Ordinate upwards, in m.
    pub y: Ordinate,
    /// Positions of x and y in the text.
    pub spans: [Span; 2],
}

/// Ordinate of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ordinate {
    /// Number, in m.
    Number(f64),
    /// Coordinate with the unit m.
    Coordinate(CoordinateId),
    /// Observable with the unit m.
    Observable(ObservableId),
}

/// Line of a drawing, from point to point.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLine {
    /// Name.
    pub name: String,
    /// Points of the line, at least two.
    pub points: Vec<PointId>,
}

/// Parameter of the model.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// ASCII name.
    pub name: String,
    /// Unit declared in the specification; `value` is in SI.
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Origin of the value ("Table I", "assumed: ...", "fitted to ...").
    pub origin: String,
    /// Number in SI, or expression in other parameters.
    pub value: ParameterValue,
    /// Smallest admissible value in SI, if given.
    pub min: Option<f64>,
    /// Largest admissible value in SI, if given.
    pub max: Option<f64>,
    /// Uncertainty of the value, if given.
    pub uncertainty: Option<Uncertainty>,
    /// Position of the name in the text.
    pub span: Span,
}

impl Parameter {
    /// Returns true if the parameter only gives a unit to the numbers of a prescribed input.
    pub fn is_unit_factor(&self) -> bool {
        self.origin == UNIT_FACTOR_ORIGIN
    }
}

/// Uncertainty of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uncertainty {
    /// Normal distribution; standard deviation as a fraction of the value.
    Relative(f64),
    /// Normal distribution; standard deviation in SI.
    StandardDeviation(f64),
    /// Uniform distribution between two ends, in SI.
    Between([f64; 2]),
}

/// Value of a parameter.
#[derive(Clone, Debug)]
pub enum ParameterValue {
    /// Number in SI.
    Number(f64),
    /// Expression in other parameters, without coordinates, inputs, time or fields.
    Expression(Expr),
}

/// Generalised coordinate.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// ASCII name.
    pub name: String,
    /// Unit (coherent SI).
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Initial value (parameters only), 0 if absent.
    pub initial: Option<Expr>,
    /// Initial rate (parameters only), 0 if absent.
    pub initial_rate: Option<Expr>,
    /// Range of validity, if given.
    pub range: Option<Range>,
    /// Position of the name in the text.
    pub span: Span,
}

/// Range of a coordinate, an input or a state. Outside the range the model is not valid.
#[derive(Clone, Debug)]
pub struct Range {
    /// Lower end (parameters only).
    pub low: Expr,
    /// Upper end (parameters only), above the lower one.
    pub high: Expr,
    /// Position of the array in the text.
    pub span: Span,
}

/// Signal supplied at run time.
#[derive(Clone, Debug)]
pub struct Input {
    /// ASCII name.
    pub name: String,
    /// Unit (coherent SI).
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Range of validity, if given.
    pub range: Option<Range>,
    /// Input that is the rate of this input, if given: `s_dot` for the prescribed motion s, `s_ddot` for `s_dot`.
    pub rate: Option<InputId>,
    /// Input whose rate this input is, if any.
    pub rate_of: Option<InputId>,
    /// Position of the name in the text.
    pub span: Span,
}

impl Input {
    /// Returns true for a prescribed motion, but not for its rates.
    pub fn is_prescribed(&self) -> bool {
        self.rate.is_some() && self.rate_of.is_none()
    }
}

/// First-order state z, with dz/dt = `rate`: a filter, an actuator, a current.
#[derive(Clone, Debug)]
pub struct State {
    /// ASCII name.
    pub name: String,
    /// Unit (coherent SI).
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Rate, in the state's unit per s: an expression of coordinates, rates, states, inputs,
    /// parameters and time. The rates of states in it, also through definitions, have no cycle.
    pub rate: Expr,
    /// Initial value (parameters only), 0 if absent.
    pub initial: Option<Expr>,
    /// Range of validity, if given.
    pub range: Option<Range>,
    /// Position of the name in the text.
    pub span: Span,
}

/// Flexible field w(x, t) = sum over i of phi_i(x) q_i(t), x from `from` to `to`.
#[derive(Clone, Debug)]
pub struct Field {
    /// ASCII name, for example `w`.
    pub name: String,
    /// Unit of the field and of its modal coordinates (phi is dimensionless).
    pub unit: Unit,
    /// Name of the position variable inside the field's functions.
    pub along: String,
    /// Start of the domain (parameters only).
    pub from: Expr,
    /// End of the domain (parameters only).
    pub to: Expr,
    /// Mode shapes.
    pub basis: Basis,
    /// Name of the modal coordinates: `q` gives `q_1 .. q_S`.
    pub coordinates: String,
    /// Default order of the specification.
    pub order: usize,
    /// Description.
    pub doc: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Mode shapes of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Basis {
    /// Elastic modes of a uniform beam. Clamped-free: Eq. (17) of the paper with beta_r l the roots of cos z
    /// cosh z = -1 and the corrected xi_r. Rods in tension or torsion, and strings, use the same
    /// shapes: a fixed end equals a pinned one, a free end equals a guided one. In a specification:
    /// `"clamped_free"`, `"string"` and others.
    Beam {
        /// End at `from`.
        from: End,
        /// End at `to`.
        to: End,
    },
    /// Eq. (17) of the paper with beta_r and xi_r as printed in Eq. (18) and (19), for comparison. These shapes
    /// are not orthogonal and violate the boundary conditions at the free end. In a specification:
    /// `"clamped_free_printed"`.
    ClampedFreePrinted,
    /// Shapes from a file, with a cubic spline between its rows. They are functions of s = (x - from)/(to - from), so
    /// they are stretched if the length changes. In a specification: `"table"`.
    Table {
        /// Shapes.
        table: Arc<ShapeTable>,
        /// Position of the file's name in the text.
        span: Span,
    },
}

impl Basis {
    /// Returns the table of a basis from a file.
    pub fn table(&self) -> Option<&ShapeTable> {
        match self {
            Self::Table { table, .. } => Some(table),
            Self::Beam { .. } | Self::ClampedFreePrinted => None,
        }
    }

    /// Clamped-free beam of the paper.
    pub const CLAMPED_FREE: Self = Self::Beam {
        from: End::Clamped,
        to: End::Free,
    };
}

/// Boundary condition at an end of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum End {
    /// No deflection, no slope.
    Clamped,
    /// No deflection, no moment.
    Pinned,
    /// No moment, no shear.
    Free,
    /// No slope, no shear: the end moves perpendicular to the beam without rotation.
    Guided,
}

/// Named expression of coordinates, rates, inputs, parameters and time. A field appears in it
/// through `at`, `integral` or `sum`.
#[derive(Clone, Debug)]
pub struct Definition {
    /// ASCII name.
    pub name: String,
    /// Value.
    pub value: Expr,
    /// Unit, inferred.
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Named term of an energy or of the dissipation.
#[derive(Clone, Debug)]
pub struct Term {
    /// Name of the term.
    pub name: String,
    /// Value.
    pub value: Expr,
    /// Description.
    pub doc: String,
    /// Origin ("Eq. (21)", "fitted to ...").
    pub origin: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Force that acts by virtual work: Q_j = value * d(on)/d(q_j).
#[derive(Clone, Debug)]
pub struct Force {
    /// Name of the force.
    pub name: String,
    /// Expression of coordinates, without rates and inputs; often a coordinate or a definition.
    pub on: Expr,
    /// Force or torque.
    pub value: Expr,
    /// Description.
    pub doc: String,
    /// Origin ("Eq. (11)", "fitted to ...").
    pub origin: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Returns the name that is written at `span` in the specification. For a component, this is the name of the vector.
pub fn written_name<'n>(name: &'n str, span: Span, source: &Source) -> &'n str {
    match source.text.get(span.start..span.end) {
        Some(text) if !text.is_empty() && name.starts_with(text) => &name[..text.len()],
        _ => name,
    }
}

/// Expression that is zero along the motion. Its generalised force is A^T lambda. A is the
/// derivative of the expression with respect to the coordinates or, if it is nonholonomic, to
/// their rates.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// ASCII name.
    pub name: String,
    /// Expression of coordinates, prescribed motion and time, or linear in the rates.
    pub zero: Expr,
    /// True if the expression contains rates. The multiplier is then in W per unit of the
    /// expression, else in J.
    pub is_nonholonomic: bool,
    /// Unit, inferred.
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Origin.
    pub origin: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Unilateral contact: a distance g(q, t) >= 0. When g falls to zero, the rates jump by M^-1
/// A^T P. A is the derivative of g with respect to the coordinates, and the impulse P >= 0
/// gives the rate of g after the impact: minus the restitution times the rate before (Newton).
#[derive(Clone, Debug)]
pub struct Impact {
    /// ASCII name.
    pub name: String,
    /// Distance: an expression of coordinates, prescribed motion and time.
    pub when: Expr,
    /// Coefficient of restitution, from 0 to 1 (parameters only).
    pub restitution: Expr,
    /// Coulomb friction; `None` for a smooth contact.
    pub friction: Option<ContactFriction>,
    /// Unit of the distance, inferred.
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Origin.
    pub origin: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Coulomb friction of a contact along one direction. With friction, restitution is energetic (Stronge).
#[derive(Clone, Debug)]
pub struct ContactFriction {
    /// Coefficient, at least 0 (parameters only).
    pub coefficient: Expr,
    /// Tangential velocity of the contact, linear in the rates.
    pub slip: Expr,
}

/// Reported quantity.
#[derive(Clone, Debug)]
pub struct Observable {
    /// ASCII name.
    pub name: String,
    /// Value, without accelerations.
    pub value: Expr,
    /// Present if the observable is the time derivative of another observable; see [`Model::observe_rate`].
    pub rate_of: Option<ObservedRate>,
    /// Unit (coherent SI), inferred and compared with the declared unit.
    pub unit: Unit,
    /// Description.
    pub doc: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Time derivative of an observable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObservedRate {
    /// Index into [`Model::observables`].
    pub observable: usize,
    /// 1 for the rate, 2 for the acceleration.
    pub times: u8,
}

/// Name for a coefficient of the derived accelerations, as in Eq. (22) of the paper.
#[derive(Clone, Debug)]
pub struct Coefficient {
    /// ASCII name. Coefficients of each mode are named `name_1 ..` by the derivation.
    pub name: String,
    /// Meaning.
    pub kind: CoefficientKind,
    /// Field with one coefficient per mode, if given (`each = "w[i]"`); `phi[i]` is then allowed
    /// outside a sum.
    pub each: Option<FieldId>,
    /// Description.
    pub doc: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Meaning of a coefficient.
#[derive(Clone, Debug)]
pub enum CoefficientKind {
    /// Expression of parameters and of earlier coefficients.
    Value(Expr),
    /// Factor of `by` in the acceleration of `of`, multiplied by `times`.
    Factor {
        /// Coordinate of the acceleration; with a field's modal coordinates, every mode.
        of: Expr,
        /// Quantity multiplied: a coordinate, a rate, `deadzone(p, b)`, `contact(p, b)*dot(p)`, a
        /// field's modal coordinates, or 1 for the remainder.
        by: Expr,
        /// Additional factor (parameters and earlier coefficients), if any.
        times: Option<Expr>,
    },
}

/// Measured channel: measured(t) = gain * quantity(t - delay) + bias.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Name of the channel.
    pub channel: String,
    /// Name of a coordinate, a rate (`NAME_dot`), an observable, `energy` or `power`.
    pub observable: String,
    /// Gain; 1 for an ideal sensor.
    pub gain: f64,
    /// Bias in the channel's SI unit.
    pub bias: f64,
    /// Delay in s; negative for an early signal.
    pub delay: f64,
    /// Position of the observable's name in the text.
    pub span: Span,
}

/// Sampled controller. At the times `offset` + k `period`, k = 0, 1, ..., it computes all new states and all outputs
/// from the values before that time. An output takes effect after `delay` and is held until the next output takes
/// effect.
#[derive(Clone, Debug)]
pub struct Controller {
    /// ASCII name.
    pub name: String,
    /// Description.
    pub doc: String,
    /// Time between two samples.
    pub period: SampleTime,
    /// Time of the first sample.
    pub offset: SampleTime,
    /// Time between a sample and the effect of its outputs.
    pub delay: SampleTime,
    /// Quantities in the expressions.
    pub measured: Vec<MeasuredQuantity>,
    /// States.
    pub states: Vec<ControllerState>,
    /// Outputs.
    pub outputs: Vec<ControllerOutput>,
    /// Position of the name in the text.
    pub span: Span,
}

/// Time of a controller (parameters only).
#[derive(Clone, Debug)]
pub struct SampleTime {
    /// Value in `unit`. The value of an expression is in SI if no unit is declared.
    pub value: Expr,
    /// Unit of a plain number.
    pub unit: Unit,
    /// Position in the text.
    pub span: Span,
}

/// State of a controller.
#[derive(Clone, Debug)]
pub struct ControllerState {
    /// ASCII name, unique in the model.
    pub name: String,
    /// Unit (coherent SI).
    pub unit: Unit,
    /// Value after a sample.
    pub next: SampledExpression,
    /// Initial value (parameters only), 0 if absent.
    pub initial: Option<Expr>,
    /// Description.
    pub doc: String,
    /// Position of the name in the text.
    pub span: Span,
}

/// Output of a controller.
#[derive(Clone, Debug)]
pub struct ControllerOutput {
    /// Input that it drives.
    pub input: InputId,
    /// Value of the input, SI.
    pub value: SampledExpression,
    /// Position of the name in the text.
    pub span: Span,
}

/// Expression of a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledExpression {
    /// Form of the expression.
    pub kind: SampledKind,
    /// Position in the text.
    pub span: Span,
}

/// Forms of an expression of a controller.
#[derive(Clone, Debug, PartialEq)]
pub enum SampledKind {
    /// Number in SI.
    Number(f64),
    /// Quantity, an index into [`Controller::measured`].
    Measured(usize),
    /// `-operand`.
    Negate(Box<SampledExpression>),
    /// `left operator right`.
    Binary(
        BinaryOperator,
        Box<SampledExpression>,
        Box<SampledExpression>,
    ),
    /// Function of one or two arguments.
    Call(Function, Vec<SampledExpression>),
    /// `clamp(x, low, high)`: x, limited to the interval from `low` to `high`.
    Clamp([Box<SampledExpression>; 3]),
    /// `quantise(x, step)`: the multiple of `step` that is nearest to x; halves are rounded away from zero.
    Quantise([Box<SampledExpression>; 2]),
}

/// Quantity in the expressions of a controller.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasuredQuantity {
    /// Time of the sample.
    Time,
    /// Time between two samples.
    Period,
    /// Parameter.
    Parameter(ParameterId),
    /// Input before the sample.
    Input(InputId),
    /// Coordinate.
    Coordinate(CoordinateId),
    /// Rate of a coordinate.
    CoordinateRate(CoordinateId),
    /// First-order state.
    State(StateId),
    /// Modal coordinate of a field, or its rate; modes are numbered from 1.
    Mode {
        /// Index of the field.
        field: usize,
        /// Number of the mode.
        number: usize,
        /// True for the rate.
        is_rate: bool,
        /// Position of its first use in the text.
        span: Span,
    },
    /// Observable, by name.
    Observable(String),
    /// State of this controller, by its index.
    Own(usize),
}

/// Expression with every name resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// Form of the expression.
    pub kind: ExprKind,
    /// Position in the text.
    pub span: Span,
}

impl Model {
    /// Returns the index of each prescribed motion among the inputs. The next two inputs are its rate and its second
    /// rate.
    pub fn prescribed_inputs(&self) -> impl Iterator<Item = usize> {
        let inputs = self.inputs.iter().enumerate();
        inputs.filter_map(|(place, input)| input.is_prescribed().then_some(place))
    }

    /// Returns true if an expression contains the time and no other quantities than numbers, parameters, and
    /// definitions that consist of these.
    pub fn is_function_of_time(&self, expr: &Expr) -> bool {
        let (mut has_time, mut has_others) = (false, false);
        self.visit_time(expr, &mut has_time, &mut has_others);
        has_time && !has_others
    }

    /// Returns true if an expression contains the motion, directly or in a definition: coordinates, states, fields and
    /// multipliers.
    pub fn contains_motion(&self, expr: &Expr) -> bool {
        let mut contains = false;
        expr.visit(&mut |part| match &part.kind {
            ExprKind::Coordinate(_)
            | ExprKind::State(_)
            | ExprKind::Field(_)
            | ExprKind::ModeCoordinate(_)
            | ExprKind::SingleMode { .. }
            | ExprKind::Multiplier(_)
            | ExprKind::Residual(_) => contains = true,
            ExprKind::Definition(index) => {
                contains |= self.contains_motion(&self.definitions[*index].value);
            }
            _ => {}
        });
        contains
    }

    fn visit_time(&self, expr: &Expr, has_time: &mut bool, has_others: &mut bool) {
        expr.visit(&mut |part| match &part.kind {
            ExprKind::Number(_)
            | ExprKind::Pi
            | ExprKind::Parameter(_)
            | ExprKind::Negate(_)
            | ExprKind::Binary(..)
            | ExprKind::Call(..) => {}
            ExprKind::Time => *has_time = true,
            ExprKind::Definition(index) => {
                self.visit_time(&self.definitions[*index].value, has_time, has_others);
            }
            _ => *has_others = true,
        });
    }
}

impl Expr {
    /// Calls `see` with this expression, then with all its subexpressions.
    pub fn visit<'e>(&'e self, see: &mut impl FnMut(&'e Expr)) {
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
            | ExprKind::ModeShape(_)
            | ExprKind::SingleMode { .. } => {}
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

/// Forms of a checked expression.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// Number in SI; literals are dimensionless.
    Number(f64),
    /// The constant pi.
    Pi,
    /// Time t, in s.
    Time,
    /// Position along a field; only in functions of that field.
    Position(FieldId),
    /// Parameter.
    Parameter(ParameterId),
    /// Generalised coordinate, not a mode.
    Coordinate(CoordinateId),
    /// Input.
    Input(InputId),
    /// First-order state.
    State(StateId),
    /// Definition.
    Definition(DefinitionId),
    /// Earlier entry of [`Model::coefficients`]; only in coefficients.
    Coefficient(CoefficientId),
    /// Multiplier of a constraint; only in observables.
    Multiplier(ConstraintId),
    /// Residual of a constraint; only in observables.
    Residual(ConstraintId),
    /// Field w(x, t); only in `integral`, `at` or `diff` of that field.
    Field(FieldId),
    /// Modal coordinate `q[i]` of a field; i is the index of the innermost enclosing sum over that
    /// field.
    ModeCoordinate(FieldId),
    /// Coordinate `q_3` of one mode of a field; variants of a lower order do not have it.
    SingleMode {
        /// Field of the mode.
        field: FieldId,
        /// Number of the mode, from 1.
        mode: usize,
    },
    /// Mode shape `phi[i]` of a field, a function of the position; i as for modal coordinates.
    ModeShape(FieldId),
    /// Time derivative of a coordinate, definition, field, modal coordinate or state.
    Dot(Box<Expr>),
    /// Derivative of `w`, `dot(w)` or `phi[i]` with respect to the position, 1 to 4 times.
    Diff(Box<Expr>, u8),
    /// `at(expression, position)`: a function of the position, evaluated at `position` (parameters
    /// only).
    At {
        /// Field with the position.
        field: FieldId,
        /// Function of the position.
        value: Box<Expr>,
        /// Position of the evaluation.
        position: Box<Expr>,
    },
    /// Integral of an expression over the field's domain.
    Integral {
        /// Field with the domain.
        field: FieldId,
        /// Integrand, a function of the position.
        integrand: Box<Expr>,
    },
    /// Sum over the field's modes; 0 at order 0.
    Sum {
        /// Field with the modes.
        field: FieldId,
        /// Summand, with `q[i]` and `phi[i]`.
        summand: Box<Expr>,
    },
    /// `-operand`.
    Negate(Box<Expr>),
    /// `left operator right`.
    Binary(BinaryOperator, Box<Expr>, Box<Expr>),
    /// Function of one or two scalar arguments.
    Call(Function, Vec<Expr>),
}
