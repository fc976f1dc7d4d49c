//! Dense Jacobians of a compiled model, and its linearisation. The crate `codegen` derives them.

use std::sync::Arc;

use eomgen_codegen::program::evaluator::{Evaluator, MachineCode, Point};
use eomgen_codegen::program::{Op, Program, Variable};
use eomgen_codegen::singular_terms::{SingularTerm, singular_terms};
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::RESIDUAL;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::{CompiledModel, prepare_evaluator};

/// Largest magnitude of a state or an input whose fourth power does not overflow.
const LARGEST_VALUE: f64 = 1e75;

/// Variables listed in a message.
const MAX_LISTED: usize = 6;

/// Cure of a term without a derivative.
const SMOOTH_FORMS: &str = "choose another state (--state), or write a smooth form with a small eps: sqrt(v^2 + eps^2) \
    instead of norm(v) or abs(v), x/sqrt(x + eps) instead of sqrt(x)";

/// A Jacobian of a model: the function and the variable of differentiation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jacobian {
    /// Derivatives of the rates with respect to the state.
    RatesByState,
    /// Derivatives of the rates with respect to the inputs.
    RatesByInputs,
    /// Derivatives of the rates with respect to the independent parameters, SI.
    RatesByParameters,
    /// Derivatives of the rates with respect to time at constant state and inputs; one column.
    RatesByTime,
    /// Derivatives of the observables with respect to the state.
    ObservablesByState,
    /// Derivatives of the observables with respect to the inputs.
    ObservablesByInputs,
    /// Derivatives of the observables with respect to the independent parameters, SI.
    ObservablesByParameters,
}

impl Jacobian {
    /// Every Jacobian.
    pub const ALL: [Self; 7] = [
        Self::RatesByState,
        Self::RatesByInputs,
        Self::RatesByParameters,
        Self::RatesByTime,
        Self::ObservablesByState,
        Self::ObservablesByInputs,
        Self::ObservablesByParameters,
    ];

    /// Returns the name used in emitted code.
    pub fn name(self) -> &'static str {
        match self {
            Self::RatesByState => "rates_by_state",
            Self::RatesByInputs => "rates_by_inputs",
            Self::RatesByParameters => "rates_by_parameters",
            Self::RatesByTime => "rates_by_time",
            Self::ObservablesByState => "observables_by_state",
            Self::ObservablesByInputs => "observables_by_inputs",
            Self::ObservablesByParameters => "observables_by_parameters",
        }
    }
}

/// Positions of the structural nonzeros of one Jacobian.
struct JacobianLayout {
    place: usize,
    rows: usize,
    columns: usize,
    /// Index of each nonzero in the dense row-major matrix.
    dense: Vec<usize>,
    nonzeros: Vec<f64>,
}

/// Evaluator of Jacobians at one set of parameter values.
pub struct JacobianEvaluator {
    evaluator: Evaluator,
    /// Layouts in the order of [`Jacobian::ALL`].
    layouts: Vec<JacobianLayout>,
}

impl JacobianEvaluator {
    /// Returns the numbers of rows and columns.
    pub fn shape(&self, of: Jacobian) -> (usize, usize) {
        let layout = &self.layouts[of as usize];
        (layout.rows, layout.columns)
    }

    pub(crate) fn evaluate_dense(&mut self, of: Jacobian, point: Point<'_>) -> Vec<f64> {
        let (rows, columns) = self.shape(of);
        let mut matrix = vec![0.0; rows * columns];
        self.evaluate(of, point, &mut matrix);
        matrix
    }

    /// Writes the dense row-major matrix at a point to `out`, of rows times columns numbers. On a
    /// switching surface the derivatives are one-sided.
    pub fn evaluate(&mut self, of: Jacobian, point: Point<'_>, out: &mut [f64]) {
        let layout = &mut self.layouts[of as usize];
        self.evaluator
            .jacobian(layout.place, point, &mut layout.nonzeros);
        out.fill(0.0);
        for (place, value) in layout.dense.iter().zip(&layout.nonzeros) {
            out[*place] = *value;
        }
    }
}

/// Linearisation of a model about a point: d(dx)/dt = f + A dx + B du and dy = C dx + D du, with
/// the deviations dx, du, dy from the point. Matrices are row-major.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearisation {
    /// Matrix A: rates by states.
    pub a: Vec<f64>,
    /// Matrix B: rates by inputs.
    pub b: Vec<f64>,
    /// Matrix C: observables by states.
    pub c: Vec<f64>,
    /// Matrix D: observables by inputs.
    pub d: Vec<f64>,
    /// Rates f at the point, SI; zero at an equilibrium.
    pub rates: Vec<f64>,
    /// Observables at the point, SI.
    pub observables: Vec<f64>,
}

impl Linearisation {
    /// Returns the rows of H in H dx = 0, the constraints on small motions dx, row-major:
    /// derivatives of all residuals, and of the rates of holonomic residuals. Empty without
    /// constraints.
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

impl Instance<'_> {
    /// Returns an evaluator of Jacobians at these parameters, with machine code.
    ///
    /// # Errors
    /// Terms that cannot be differentiated, or a mass matrix that is not positive definite.
    pub fn jacobian_evaluator(&self) -> Result<JacobianEvaluator, Error> {
        self.interpreter()?;
        let differentiated = self.model().jacobian_program()?;
        Ok(self.jacobians(&differentiated.program, differentiated.machine_code()))
    }

    /// Returns an evaluator of Jacobians without machine code, for a few evaluations. It does not
    /// check that the mass matrix is positive definite, so its accelerations may be invalid.
    pub(crate) fn interpreted_jacobians(&self) -> Result<JacobianEvaluator, Error> {
        let program = &self.model().jacobian_program()?.program;
        Ok(self.jacobians(program, None))
    }

    fn jacobians(
        &self,
        program: &Program,
        code: Option<&Arc<dyn MachineCode>>,
    ) -> JacobianEvaluator {
        let layouts = Jacobian::ALL
            .iter()
            .filter_map(|of| find_layout(program, *of));
        JacobianEvaluator {
            layouts: layouts.collect(),
            evaluator: prepare_evaluator(program, code, self.parameters()),
        }
    }

    /// Returns true for each state that a rate or a switching function depends on. An unrestrained
    /// rotation angle, for example, has no influence.
    ///
    /// # Errors
    /// Same as [`Instance::jacobian_evaluator`].
    pub fn influential_states(&self) -> Result<Vec<bool>, Error> {
        let program = &self.model().jacobian_program()?.program;
        let mut felt = vec![false; program.states()];
        if let Some(layout) = find_layout(program, Jacobian::RatesByState) {
            for place in &layout.dense {
                felt[place % layout.columns] = true;
            }
        }
        let guards: Vec<_> = program.guards.iter().map(|guard| guard.value).collect();
        for id in program.reachable(&guards) {
            let (variable, count) = match program.value(id).op {
                Op::Coordinate(index) => (Variable::Coordinate(index), 1),
                Op::Rate(index) => (Variable::Rate(index), 1),
                Op::ModeCoordinates(field) => {
                    (Variable::ModeCoordinates(field), mode_count(program, field))
                }
                Op::ModeRates(field) => (Variable::ModeRates(field), mode_count(program, field)),
                _ => continue,
            };
            let first = program.variable_place(variable);
            felt[first..first + count].fill(true);
        }
        Ok(felt)
    }

    /// Linearises the model about a time (s), a state and inputs, SI.
    ///
    /// # Errors
    /// Same as [`Instance::jacobian_evaluator`], and a derivative that has no finite limit at the
    /// point, with the place of its term.
    pub fn linearise(&self, point: Point<'_>) -> Result<Linearisation, Error> {
        let mut evaluator = self.interpreter()?;
        let mut jacobians = self.interpreted_jacobians()?;
        let mut dense = |of| jacobians.evaluate_dense(of, point);
        let (a, b) = (
            dense(Jacobian::RatesByState),
            dense(Jacobian::RatesByInputs),
        );
        let (c, d) = (
            dense(Jacobian::ObservablesByState),
            dense(Jacobian::ObservablesByInputs),
        );
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
        })
    }

    /// Returns the error for a point without a linearisation, with its cause.
    pub(crate) fn no_linearisation_error(&self, point: Point<'_>) -> Error {
        let model = self.model().model();
        if let Some(far) = self.out_of_range(point) {
            return Error::Request(far);
        }
        let found = singular_terms(model, self.model().orders(), self.values(), point);
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
            .with_span(first.span, self.singularity(first, point))
            .with_help(SMOOTH_FORMS);
        let diagnostic = others.iter().fold(diagnostic, |diagnostic, other| {
            diagnostic.with_related_span(other.span, self.singularity(other, point))
        });
        Diagnostics::from_one(model.source.clone(), diagnostic).into()
    }

    /// Returns the message for a state or an input so large that its powers overflow.
    fn out_of_range(&self, point: Point<'_>) -> Option<String> {
        let states = self.model().state_names().into_iter().zip(point.state);
        let inputs = self.model().model().inputs.iter();
        let inputs = inputs.map(|input| input.name.clone()).zip(point.inputs);
        let mut all = states.chain(inputs);
        let (name, value) = all.find(|(_, value)| value.abs() > LARGEST_VALUE)?;
        Some(format!(
            "{name} = {value:e} (SI) is out of range: its powers exceed the largest number of a computer, about \
             1e308; give a value that the machine can reach"
        ))
    }

    /// Returns kind, variables and point of a singularity, for a message.
    fn singularity(&self, term: &SingularTerm, point: Point<'_>) -> String {
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
            (true, false) => format!("the {} has no derivative by {by} at {at}", term.name),
        }
    }
}

fn mode_count(program: &Program, field: FieldId) -> usize {
    program.fields[field.index()].order
}

fn find_layout(program: &Program, of: Jacobian) -> Option<JacobianLayout> {
    let jacobians = &program.outputs.jacobians;
    let place = jacobians.iter().position(|known| known.name == of.name())?;
    let jacobian = &jacobians[place];
    let mut dense = vec![0; jacobian.nonzeros()];
    for (entry, block) in jacobian.entries.iter().zip(jacobian.places()) {
        for row in 0..entry.rows {
            for column in 0..entry.width() {
                let of_matrix = entry.column + if entry.diagonal { row } else { column };
                dense[block.start + block.width * row + column] =
                    (entry.row + row) * jacobian.columns + of_matrix;
            }
        }
    }
    Some(JacobianLayout {
        place,
        rows: jacobian.rows,
        columns: jacobian.columns,
        nonzeros: vec![0.0; dense.len()],
        dense,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CompiledModel, Orders};

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
                "the force `motor` has no derivative by `x` at x = 0 m, u = 0 N",
            ),
            (
                "F*(abs(x)/l)^0.3",
                "a derivative has no finite limit",
                "the force `motor` has no derivative by `x` at x = 0 m, u = 0 N",
            ),
            (
                "F*sqrt(max(x/l, 0))",
                "a derivative has no finite limit",
                "the force `motor` has no derivative by `x` at x = 0 m, u = 0 N",
            ),
        ] {
            let found = refused(force, [0.0, 0.0]).to_string();
            for part in [cause, place, force, "sqrt(v^2 + eps^2)"] {
                assert!(found.contains(part), "{part}: {found}");
            }
        }
    }

    #[test]
    fn state_out_of_range_is_named() {
        let found = refused("F*x/l", [1e300, 0.0]).to_string();
        assert!(
            found.starts_with("x = 1e300 (SI) is out of range"),
            "{found}"
        );
        let found = refused("F*(x/l)^3", [0.0, -1e200]).to_string();
        assert!(
            found.starts_with("x_dot = -1e200 (SI) is out of range"),
            "{found}"
        );
    }

    /// Returns the error of the driven machine with another force.
    fn refused(force: &str, state: [f64; 2]) -> Error {
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
        // pull, energy and its rate by the damper and the motor.
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
}
