//! Jacobians of a compiled model, computed as dense matrices. How they are derived is the business
//! of `codegen`.

use std::sync::Arc;

use eomgen_codegen::program::evaluator::{Evaluator, MachineCode, Point};
use eomgen_codegen::program::{Op, Program, Variable};
use eomgen_codegen::singular_terms::without_derivative;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::RESIDUAL;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::{CompiledModel, evaluator};

/// Which Jacobian: of what, by what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jacobian {
    /// Of the rates by the state.
    RatesByState,
    /// Of the rates by the inputs.
    RatesByInputs,
    /// Of the rates by the independent parameters, SI.
    RatesByParameters,
    /// Of the rates by the time, with state and inputs held: one column.
    RatesByTime,
    /// Of the observables by the state.
    ObservablesByState,
    /// Of the observables by the inputs.
    ObservablesByInputs,
    /// Of the observables by the independent parameters, SI.
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

    /// Its name, as in emitted code.
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

/// Where the structural nonzeros of one Jacobian stand.
struct Layout {
    /// Its place among those of the program.
    place: usize,
    rows: usize,
    columns: usize,
    /// For each nonzero its place in the dense matrix, row by row.
    dense: Vec<usize>,
    nonzeros: Vec<f64>,
}

/// Computes Jacobians at one set of parameter values.
pub struct JacobianEvaluator {
    evaluator: Evaluator,
    /// In the order of [`Jacobian::ALL`].
    layouts: Vec<Layout>,
}

impl JacobianEvaluator {
    /// Rows and columns.
    pub fn shape(&self, of: Jacobian) -> (usize, usize) {
        let layout = &self.layouts[of as usize];
        (layout.rows, layout.columns)
    }

    /// The dense matrix at a point, row by row.
    pub(crate) fn dense(&mut self, of: Jacobian, point: Point<'_>) -> Vec<f64> {
        let (rows, columns) = self.shape(of);
        let mut matrix = vec![0.0; rows * columns];
        self.evaluate(of, point, &mut matrix);
        matrix
    }

    /// The dense matrix at a point, row by row; `out` has rows times columns numbers. Of the regime
    /// that the point is in; on a switching surface one-sided.
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

/// A model linearised about a point: with dx, du, dy the differences from there,
/// d(dx)/dt = f + A dx + B du and dy = C dx + D du. Matrices are given row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearisation {
    /// Rates by states.
    pub a: Vec<f64>,
    /// Rates by inputs.
    pub b: Vec<f64>,
    /// Observables by states.
    pub c: Vec<f64>,
    /// Observables by inputs.
    pub d: Vec<f64>,
    /// The rates at the point, f: zero in an equilibrium.
    pub rates: Vec<f64>,
    /// The observables at the point.
    pub observables: Vec<f64>,
}

impl Linearisation {
    /// What the constraints of the model hold of small motions dx, C dx = 0, row by row: their
    /// residuals, and the rates of those of holonomic ones. Empty without constraints.
    pub fn held(&self, model: &CompiledModel) -> Vec<f64> {
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
    /// Computes Jacobians at these parameters, by machine code.
    ///
    /// # Errors
    /// What cannot be differentiated, and a mass matrix that is not positive definite.
    pub fn jacobian_evaluator(&self) -> Result<JacobianEvaluator, Error> {
        self.interpreter()?;
        let differentiated = self.model().differentiated()?;
        Ok(self.jacobians(&differentiated.program, differentiated.code()))
    }

    /// The same for a few evaluations: no machine code is made for it. Pivots need not be positive; then
    /// what is asked of it must not rest on accelerations.
    pub(crate) fn interpreted_jacobians(&self) -> Result<JacobianEvaluator, Error> {
        let program = &self.model().differentiated()?.program;
        Ok(self.jacobians(program, None))
    }

    fn jacobians(
        &self,
        program: &Program,
        code: Option<&Arc<dyn MachineCode>>,
    ) -> JacobianEvaluator {
        let layouts = Jacobian::ALL.iter().filter_map(|of| layout(program, *of));
        JacobianEvaluator {
            layouts: layouts.collect(),
            evaluator: evaluator(program, code, self.parameters()),
        }
    }

    /// Whether any rate, or any switching function, depends on each state. The angle of a rotation
    /// that nothing restrains is one that none feels.
    ///
    /// # Errors
    /// As [`Instance::jacobian_evaluator`].
    pub fn felt_states(&self) -> Result<Vec<bool>, Error> {
        let program = &self.model().differentiated()?.program;
        let mut felt = vec![false; program.states()];
        if let Some(layout) = layout(program, Jacobian::RatesByState) {
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
                    (Variable::ModeCoordinates(field), order(program, field))
                }
                Op::ModeRates(field) => (Variable::ModeRates(field), order(program, field)),
                _ => continue,
            };
            let first = program.variable_place(variable);
            felt[first..first + count].fill(true);
        }
        Ok(felt)
    }

    /// The model linearised at a time (s) about a state and inputs, SI.
    ///
    /// # Errors
    /// As [`Instance::jacobian_evaluator`], and a derivative without a limit at the point, at the place of its
    /// term.
    pub fn linearise(&self, point: Point<'_>) -> Result<Linearisation, Error> {
        let mut evaluator = self.interpreter()?;
        let mut jacobians = self.interpreted_jacobians()?;
        let mut dense = |of| jacobians.dense(of, point);
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
            return Err(self.not_linear(point));
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

    /// Why there is no linearisation about a point.
    fn not_linear(&self, point: Point<'_>) -> Error {
        let model = self.model().model();
        let message = format!(
            "the model `{}` has no linearisation there: a derivative has no finite limit",
            model.name
        );
        let places = without_derivative(model, self.model().orders(), self.values(), point);
        let places = match places {
            Ok(places) => places,
            Err(found) => return found.into(),
        };
        let Some((first, others)) = places.split_first() else {
            return Error::Request(message);
        };
        let found = Diagnostic::error(message)
            .at(*first, "has no derivative there")
            .help("linearise elsewhere, or smooth it: sqrt(v^2 + e^2) in place of abs(v)");
        let found = others
            .iter()
            .fold(found, |found, place| found.also(*place, "nor has this"));
        Diagnostics::one(model.source.clone(), found).into()
    }
}

/// How many modes a field has.
fn order(program: &Program, field: FieldId) -> usize {
    program.fields[field.index()].order
}

/// Where a Jacobian's nonzeros stand; every program with Jacobians has all of them.
fn layout(program: &Program, of: Jacobian) -> Option<Layout> {
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
    Some(Layout {
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
    fn a_term_without_a_derivative_is_named_at_its_place() {
        for force in [
            "F*dot(x)/abs(dot(x))",
            "F*sqrt(abs(x)/l)",
            "F*(abs(x)/l)^0.3",
        ] {
            let text = DRIVEN
                .replace("value = \"u\"", &format!("value = \"u + {force}\""))
                .replace(
                    "c = {",
                    "F = { value = 1, unit = \"N\" }\nl = { value = 1, unit = \"m\" }\nc = {",
                );
            let model = CompiledModel::of_text("driven.toml", &text, Orders::Declared);
            let model = model.unwrap_or_else(|error| panic!("{force}: {error}"));
            let run = model.at_declared().expect("an instance");
            let point = Point {
                t: 0.0,
                state: &[0.0, 0.0],
                inputs: &[0.0],
            };
            let Err(Error::Specification(found)) = run.linearise(point) else {
                panic!("{force} was linearised");
            };
            let said = found.render(false);
            assert!(
                said.contains("no finite limit") && said.contains(force),
                "{said}"
            );
        }
    }

    #[test]
    fn a_linear_model_is_its_own_linearisation() {
        let model = CompiledModel::of_text("driven.toml", DRIVEN, Orders::Declared);
        let model = model.expect("a model");
        let run = model.with(&[("k", 18.0)]).expect("an instance");
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
