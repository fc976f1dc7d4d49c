//! Linearisation of a model at a point, and the cause if none exists.

use eomgen_analysis::discretisation::{DiscreteSystem, hold_inputs};
use eomgen_codegen::program::Variable;
use eomgen_codegen::program::evaluator::Point;
use eomgen_codegen::singular_terms::{SingularTerm, find_singular_terms};
use eomgen_model_spec::argument::Argument;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::RESIDUAL;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::CompiledModel;
use crate::motion_model::MotionModel;
use crate::state_space::StateSpace;

/// Largest magnitude of a state or an input whose fourth power does not overflow.
const LARGEST_VALUE: f64 = 1e75;

/// Displacement of the states from a switching surface to each side, relative to their natural scales. One-sided
/// derivatives change by a fraction of this size.
const SIDE_DISPLACEMENT: f64 = 1e-9;

/// Smallest growth of the difference between both sides at twice the distance if a derivative has no jump.
const MIN_GROWTH: f64 = 1.5;

/// Largest difference between both sides that counts as rounding, relative to the derivative.
const MAX_SIDE_DIFFERENCE: f64 = 1e-6;

/// Maximum number of variables listed in a message.
const MAX_LISTED: usize = 6;

/// Smooth replacements of terms without a derivative.
const SMOOTH_FORMS: &str = "write a smooth form with a small eps: sqrt(v^2 + eps^2) instead of norm(v) or abs(v), \
    x/sqrt(x + eps) instead of sqrt(x)";

/// Linearisation of a model about a point: d(dx)/dt = f + A dx + B du and dy = C dx + D du, with the deviations dx, du,
/// dy from the point. Matrices are row-major.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearisation {
    /// Matrix A: derivatives of the rates with respect to the state.
    pub a: Vec<f64>,
    /// Matrix B: derivatives of the rates with respect to the inputs.
    pub b: Vec<f64>,
    /// Matrix C: derivatives of the observables with respect to the state.
    pub c: Vec<f64>,
    /// Matrix D: derivatives of the observables with respect to the inputs.
    pub d: Vec<f64>,
    /// Rates f at the point, SI; zero at an equilibrium.
    pub rates: Vec<f64>,
    /// Observables at the point, SI.
    pub observables: Vec<f64>,
    /// True on a switching surface whose sides have different linearisations. The matrices are then valid on one side.
    pub is_one_sided: bool,
}

impl Linearisation {
    /// Returns the rows of H in H dx = 0, the constraints on small motions dx, row-major. The rows are derivatives of
    /// all residuals, and of the rates of holonomic residuals. Empty without constraints.
    pub fn constraint_matrix(&self, model: &CompiledModel) -> Vec<f64> {
        let states = self.rates.len();
        let names = model.observable_names();
        let mut held = Vec::new();
        for constraint in &model.model().constraints {
            let residual = format!("{RESIDUAL}{}", constraint.name);
            let Some(row) = names.iter().position(|name| *name == residual) else {
                continue;
            };
            let row = &self.c[row * states..][..states];
            held.extend(row);
            if !constraint.is_nonholonomic {
                let rate = |column: usize| -> f64 {
                    let entries = row.iter().enumerate();
                    entries
                        .map(|(place, entry)| entry * self.a[place * states + column])
                        .sum()
                };
                held.extend((0..states).map(rate));
            }
        }
        held
    }
}

impl CompiledModel {
    /// Computes the discrete form of matrices A and B (row-major) for inputs held over `period` (s).
    ///
    /// # Errors
    /// Prescribed motion, because its input and rates cannot all be held; an inadmissible period; motions that are too
    /// fast for the period.
    pub fn discretise(&self, a: &[f64], b: &[f64], period: f64) -> Result<DiscreteSystem, Error> {
        let inputs = &self.model().inputs;
        if let Some(input) = inputs.iter().find(|input| input.rate.is_some()) {
            return Err(Error::Request(format!(
                "the input `{}` is prescribed motion: it has no discrete form, because a sample would hold both the \
                 motion and its rate",
                input.name
            )));
        }
        let states = a.len().isqrt();
        hold_inputs(a, b, states, period)
            .map_err(|error| Error::Request(format!("period {period:?} s: {error}")))
    }
}

impl Instance<'_> {
    /// Linearises the model about a time (s), a state and inputs, SI.
    ///
    /// # Errors
    /// A derivative that has no finite limit at the point, with the location of its term; a pole of the coordinates;
    /// see also [`Instance::jacobian_evaluator`].
    pub fn linearise(&self, point: Point<'_>) -> Result<Linearisation, Error> {
        if let Some(coordinate) = self.find_coordinate_pole(point)? {
            return Err(self.pole_error(&coordinate, point));
        }
        if let Some(dependence) = self.find_singular_position(point)? {
            return Err(self.singular_position_error(&dependence, point));
        }
        let mut evaluator = self.interpreter()?;
        let mut here = self.state_space_evaluator()?.evaluate(point)?;
        let mut is_one_sided = false;
        if self.is_on_surface(point)? {
            match self.linearise_across(point)? {
                Some(across) => here.replace_different(&across),
                None => is_one_sided = true,
            }
        }
        let StateSpace { a, b, c, d } = here;
        let mut rates = vec![0.0; evaluator.program().states()];
        evaluator.rates(point, &mut rates);
        let mut observables = vec![0.0; evaluator.program().observables.len()];
        evaluator.observables(point, &mut observables);
        let all = [&a, &b, &c, &d, &rates, &observables];
        if !all.into_iter().flatten().all(|number| number.is_finite()) {
            return Err(self.no_linearisation_error(point));
        }
        Ok(Linearisation {
            a,
            b,
            c,
            d,
            rates,
            observables,
            is_one_sided,
        })
    }

    /// Returns the common linearisation of both sides of a point on a surface; `None` if the sides differ. The
    /// derivative on the surface itself is that of one side, or of neither, as for a dead zone of width 0.
    ///
    /// # Errors
    /// Invalid parameter values.
    fn linearise_across(&self, point: Point<'_>) -> Result<Option<StateSpace>, Error> {
        let direction = self.generic_direction()?;
        let mut evaluator = self.state_space_evaluator()?;
        let mut linearise_at = |displacement: f64| {
            let moved = point.state.iter().zip(&direction);
            let state: Vec<f64> = moved
                .map(|(value, part)| value + displacement * part)
                .collect();
            let state = &state;
            evaluator.evaluate(Point { state, ..point })
        };
        let mut matrices = Vec::new();
        for displacement in [-1.0, 1.0, -2.0, 2.0] {
            matrices.push(linearise_at(displacement * SIDE_DISPLACEMENT)?);
        }
        let across = |select: fn(&StateSpace) -> &Vec<f64>| {
            let [below, above, far_below, far_above] = [0, 1, 2, 3].map(|k| select(&matrices[k]));
            let entries = 0..below.len();
            entries
                .map(|place| {
                    let near = (below[place], above[place]);
                    extrapolate_derivative(near, (far_below[place], far_above[place]))
                })
                .collect::<Option<Vec<f64>>>()
        };
        let all = (
            across(|of| &of.a),
            across(|of| &of.b),
            across(|of| &of.c),
            across(|of| &of.d),
        );
        Ok(match all {
            (Some(a), Some(b), Some(c), Some(d)) => Some(StateSpace { a, b, c, d }),
            _ => None,
        })
    }

    fn is_on_surface(&self, point: Point<'_>) -> Result<bool, Error> {
        let mut evaluator = self.interpreter()?;
        let mut guards = vec![0.0; evaluator.guard_count()];
        evaluator.guards(point, &mut guards);
        Ok(guards.contains(&0.0))
    }

    /// Returns the error for a point without a linearisation, with its cause.
    pub(crate) fn no_linearisation_error(&self, point: Point<'_>) -> Error {
        let model = self.model().model();
        if let Some(far) = self.describe_out_of_range(point) {
            return Error::Request(far);
        }
        if let Ok(Some(coordinate)) = self.find_coordinate_pole(point) {
            return self.pole_error(&coordinate, point);
        }
        if let Ok(Some(dependence)) = self.find_singular_position(point) {
            return self.singular_position_error(&dependence, point);
        }
        let found = find_singular_terms(model, self.model().orders(), self.values(), point);
        let found = match found {
            Ok(found) => found,
            Err(found) => return found.into(),
        };
        let Some((first, others)) = found.split_first() else {
            return Error::Request(format!(
                "an acceleration of the model `{}` or its derivative is not finite at this state: check for a \
                 stiffness or mass that is too large or too small",
                model.name
            ));
        };
        let what = match first.has_value {
            true => "a derivative has no finite limit",
            false => "a term has no finite value",
        };
        let message = format!(
            "the model `{}` has no linearisation at this state: {what}",
            model.name
        );
        let diagnostic = Diagnostic::error(message)
            .with_span(first.span, self.describe_singularity(first, point))
            .with_help(format!(
                "choose another state ({}), or {SMOOTH_FORMS}",
                Argument::OperatingState
            ));
        let diagnostic = others.iter().fold(diagnostic, |diagnostic, other| {
            diagnostic.with_related_span(other.span, self.describe_singularity(other, point))
        });
        Diagnostics::from_one(model.source.clone(), diagnostic).into()
    }

    /// Lists the first coordinates with their values, SI.
    fn list_coordinates(&self, point: Point<'_>) -> String {
        let names = self.model().state_names();
        let degrees = self.model().program().degrees_of_freedom();
        let values = names.iter().zip(point.state).take(degrees.min(MAX_LISTED));
        let values: Vec<String> = values
            .map(|(name, value)| format!("{name} = {value:?}"))
            .collect();
        values.join(", ")
    }

    /// Describes the dependence of the constraints if a point is a singular position.
    ///
    /// # Errors
    /// Invalid parameter values.
    pub(crate) fn find_singular_position(&self, point: Point<'_>) -> Result<Option<String>, Error> {
        if self.model().model().constraints.is_empty() {
            return Ok(None);
        }
        let direction = self.generic_direction()?;
        let model: &dyn MotionModel = self;
        Ok(model.describe_singular_position(point, &direction))
    }

    fn singular_position_error(&self, dependence: &str, point: Point<'_>) -> Error {
        Error::Request(format!(
            "the model `{}` has no linearisation at {} (SI): this is a singular position, {dependence}. Choose another \
             state ({})",
            self.model().model().name,
            self.list_coordinates(point),
            Argument::OperatingState,
        ))
    }

    fn pole_error(&self, coordinate: &str, point: Point<'_>) -> Error {
        Error::Request(format!(
            "the model `{}` has no linearisation at {} (SI): the coordinates have a pole there, at which a motion with \
             `{coordinate}` has no inertia, as an angle about an axis has none on the axis. Describe the machine by \
             other coordinates near this state, for example Cartesian ones, or choose another state ({})",
            self.model().model().name,
            self.list_coordinates(point),
            Argument::OperatingState,
        ))
    }

    /// Returns a message if a state or an input is so large that its powers overflow.
    fn describe_out_of_range(&self, point: Point<'_>) -> Option<String> {
        let states = self.model().state_names().into_iter().zip(point.state);
        let inputs = self.model().model().inputs.iter();
        let inputs = inputs.map(|input| input.name.clone()).zip(point.inputs);
        let mut all = states.chain(inputs);
        let (name, value) = all.find(|(_, value)| value.abs() > LARGEST_VALUE)?;
        Some(format!(
            "{name} = {value:e} (SI) is out of range: its powers exceed the largest double-precision number, about \
             1e308; give a value that the machine can reach"
        ))
    }

    /// Describes a singularity for a message: its kind, variables and point.
    fn describe_singularity(&self, term: &SingularTerm, point: Point<'_>) -> String {
        let program = self.model().program();
        let names = self.model().state_names();
        let units = self.model().state_units();
        let inputs = &self.model().model().inputs;
        let quantity = |variable: &Variable| {
            let place = program.variable_place(*variable);
            match variable {
                Variable::Input(_) => {
                    let input = &inputs[place];
                    (
                        input.name.clone(),
                        point.inputs[place],
                        input.unit.to_string(),
                    )
                }
                _ => (
                    names[place].clone(),
                    point.state[place],
                    units[place].clone(),
                ),
            }
        };
        let list = |parts: Vec<String>| match parts.get(..MAX_LISTED) {
            Some(first) if parts.len() > MAX_LISTED => format!("{}, ...", first.join(", ")),
            _ => parts.join(", "),
        };
        let at = term.of.iter().map(quantity);
        let at = list(
            at.map(|(name, value, unit)| format!("{name} = {value} {unit}"))
                .collect(),
        );
        let by = term.by.iter().map(quantity);
        let by = list(by.map(|(name, ..)| format!("`{name}`")).collect());
        match (term.has_value, term.by.is_empty()) {
            (false, _) => format!("the {} has no finite value at {at}", term.name),
            (true, true) => format!("the {} has no derivative at {at}", term.name),
            (true, false) => format!(
                "the {} has no derivative with respect to {by} at {at}",
                term.name
            ),
        }
    }
}

/// Returns the derivative on a surface, extrapolated from derivatives on both sides at one distance and at twice the
/// distance; `None` if the derivative jumps. Without a jump, the difference between both sides grows at least in
/// proportion to the distance, and the mean is extrapolated.
fn extrapolate_derivative(
    (below, above): (f64, f64),
    (far_below, far_above): (f64, f64),
) -> Option<f64> {
    let (near, far) = ((above - below).abs(), (far_above - far_below).abs());
    let size = far_below.abs().max(far_above.abs());
    let is_continuous = near <= MAX_SIDE_DIFFERENCE * size || far >= MIN_GROWTH * near;
    is_continuous.then_some((below + above) - 0.5 * (far_below + far_above))
}

impl StateSpace {
    /// Replaces the derivatives that differ from those across surfaces by more than rounding. The others keep their
    /// exact zeros.
    fn replace_different(&mut self, across: &Self) {
        let pairs = [
            (&mut self.a, &across.a),
            (&mut self.b, &across.b),
            (&mut self.c, &across.c),
            (&mut self.d, &across.d),
        ];
        for (own, across) in pairs {
            let largest = across
                .iter()
                .fold(0.0_f64, |most, entry| most.max(entry.abs()));
            for (own, across) in own.iter_mut().zip(across) {
                let rounding = MAX_SIDE_DIFFERENCE * across.abs() + f64::EPSILON * largest;
                if own.is_nan() || (*own - across).abs() > rounding {
                    *own = *across;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Jacobian;
    use crate::Orders;
    use crate::operating_point::OperatingPoint;

    const DRIVEN: &str = r#"
[model]
name = "driven"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 8, unit = "N/m" }
c = { value = 3, unit = "N s/m" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
pull = { value = "k*x + u", unit = "N" }
"#;

    #[test]
    fn term_without_derivative_is_named_with_variable_and_point() {
        for (force, cause, place) in [
            (
                "F*dot(x)/abs(dot(x))",
                "a term has no finite value",
                "the force `motor` has no finite value at x_dot = 0 m/s, u = 0 N",
            ),
            (
                "F*sqrt(abs(x)/l)",
                "a derivative has no finite limit",
                "the force `motor` has no derivative with respect to `x` at x = 0 m, u = 0 N",
            ),
            (
                "F*(abs(x)/l)^0.3",
                "a derivative has no finite limit",
                "the force `motor` has no derivative with respect to `x` at x = 0 m, u = 0 N",
            ),
            (
                "F*sqrt(max(x/l, 0))",
                "a derivative has no finite limit",
                "the force `motor` has no derivative with respect to `x` at x = 0 m, u = 0 N",
            ),
        ] {
            let found = linearisation_error(force, [0.0, 0.0]).to_string();
            for part in [cause, place, force, "sqrt(v^2 + eps^2)"] {
                assert!(found.contains(part), "{part}: {found}");
            }
        }
    }

    #[test]
    fn state_out_of_range_is_named() {
        let found = linearisation_error("F*x/l", [1e300, 0.0]).to_string();
        assert!(
            found.starts_with("x = 1e300 (SI) is out of range"),
            "{found}"
        );
        let found = linearisation_error("F*(x/l)^3", [0.0, -1e200]).to_string();
        assert!(
            found.starts_with("x_dot = -1e200 (SI) is out of range"),
            "{found}"
        );
    }

    /// Returns the error of the driven machine with another force.
    fn linearisation_error(force: &str, state: [f64; 2]) -> Error {
        let text = DRIVEN
            .replace("value = \"u\"", &format!("value = \"u + {force}\""))
            .replace("1/2*k*x^2", "1/2*k*x^2 + 1/4*k*x^4/l^2")
            .replace(
                "c = {",
                "F = { value = 1, unit = \"N\" }\nl = { value = 1, unit = \"m\" }\nc = {",
            );
        let model = CompiledModel::from_text("driven.toml", &text, Orders::Declared);
        let model = model.unwrap_or_else(|error| panic!("{force}: {error}"));
        let run = model.with_declared_parameters().expect("an instance");
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &[0.0],
        };
        match run.linearise(point) {
            Err(error) => error,
            Ok(_) => panic!("{force} was linearised"),
        }
    }

    #[test]
    fn linearisation_of_linear_model_is_exact() {
        let model = CompiledModel::from_text("driven.toml", DRIVEN, Orders::Declared);
        let model = model.expect("a model");
        let run = model.with_parameters(&[("k", 18.0)]).expect("an instance");
        let (state, inputs) = ([0.1, 0.3], [4.0]);
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &inputs,
        };
        let found = run.linearise(point).expect("a linearisation");
        assert_eq!(found.a, [0.0, 1.0, -9.0, -1.5]);
        assert_eq!(found.b, [0.0, 0.5]);
        // Derivatives of the observables `pull`, `energy` and `power`; the damper and the motor have a power.
        assert_eq!(found.c[..2], [18.0, 0.0]);
        assert_eq!(found.d[..2], [1.0, 0.0]);
        for (value, right) in found.rates.iter().zip([0.3, 2.0 - 0.9 - 0.45]) {
            assert!((value - right).abs() < 1e-15);
        }
        assert!((found.observables[0] - 5.8).abs() < 1e-15);
        let mut by_parameters = [0.0; 6];
        let mut jacobians = run.jacobian_evaluator().expect("Jacobians");
        jacobians.evaluate(Jacobian::RatesByParameters, point, &mut by_parameters);
        assert_eq!(by_parameters[..3], [0.0; 3]);
        assert!((by_parameters[4] + 0.05).abs() < 1e-16); // d(-k x/m)/dk
    }

    /// Returns the stiffness of a mass of 1 kg at rest at a position, and whether the stiffnesses on both sides differ.
    fn stiffness(potential: &str, position: f64) -> (f64, bool) {
        let text = format!(
            "[model]\nname = \"mass\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             k = {{ value = 100, unit = \"N/m\" }}\nb = {{ value = 0.2, unit = \"m\" }}\n\
             zero = {{ value = 0, unit = \"m\" }}\n[coordinates]\nx = {{ unit = \"m\" }}\n\
             [kinetic]\nT = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"{potential}\"\n"
        );
        let model = CompiledModel::from_text("mass.toml", &text, Orders::Declared)
            .unwrap_or_else(|error| panic!("{error}"));
        let run = model.with_declared_parameters().expect("an instance");
        let at = OperatingPoint {
            t: 0.0,
            state: vec![position, 0.0],
            inputs: Vec::new(),
        };
        let linear = run.linearise(at.point()).expect("a linearisation");
        (-linear.a[2], linear.is_one_sided)
    }

    #[test]
    fn surface_with_equal_sides_has_their_linearisation() {
        for (potential, position, right, differ) in [
            ("1/2*k*deadzone(x, zero)^2", 0.0, 100.0, false),
            ("1/2*k*(max(x, 0)^2 + min(x, 0)^2)", 0.0, 100.0, false),
            ("1/2*k*x^2*abs(x)/b", 0.0, 0.0, false),
            ("1/2*k*max(x, 0)^2 + 1/2*k*x^2", 0.0, 100.0, true),
            ("1/2*k*deadzone(x, b)^2", 0.2, 0.0, true),
            ("1/2*k*deadzone(x, b)^2", 0.3, 100.0, false),
        ] {
            let found = stiffness(potential, position);
            assert!((found.0 - right).abs() < 1e-9, "{potential}: {found:?}");
            assert_eq!(found.1, differ, "{potential}");
        }
    }
}
