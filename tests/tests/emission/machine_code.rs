//! Bit-for-bit comparison of machine code with the interpreter for every shipped specification and every language
//! feature, at ordinary points and at limits of the arithmetic. The sign and payload of NaN are not compared.

use std::cell::RefCell;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::equations::derive;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::program::lowering::lower;
use eomgen_codegen::program::{Op, Program};
use eomgen_compiled_model::DrivenModel;
use eomgen_model_spec::model::Model;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Settings, simulate};
use eomgen_tests::models::{load, project, shipped_specifications};
use eomgen_validate::random::Random;

const POINTS: usize = 40;

/// Limit values of arithmetic and comparisons.
const SPECIAL: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE,
    5e-324,
    1e-200,
    1e200,
];

const FUNCTIONS: [&str; 20] = [
    "Sin", "Cos", "Tan", "Asin", "Acos", "Atan", "Atan2", "Sinh", "Cosh", "Tanh", "Exp", "Ln",
    "Sqrt", "Abs", "Sign", "Min", "Max", "Deadzone", "Contact", "Above",
];

/// Values that [`kind`] can return.
const OPERATIONS: [&str; 26] = [
    "Add",
    "Apply",
    "Assemble",
    "Call",
    "Cholesky",
    "CholeskySolve",
    "Constant",
    "Coordinate",
    "Divide",
    "Gram",
    "GramDiagonal",
    "Input",
    "ModeCoordinates",
    "ModeRates",
    "Multiply",
    "Negate",
    "Parameter",
    "PivotReciprocal",
    "Power",
    "Rate",
    "Select",
    "State",
    "Subtract",
    "Table",
    "Time",
    "Total",
];

/// Returns the operation's name. If the compiler reports a new operation here, add it to this function and to
/// [`OPERATIONS`].
fn kind(op: &Op) -> &'static str {
    match op {
        Op::Add(..) => "Add",
        Op::Apply { .. } => "Apply",
        Op::Argument(..) => "Argument",
        Op::Assemble { .. } => "Assemble",
        Op::Call(..) => "Call",
        Op::Cholesky(_) => "Cholesky",
        Op::CholeskySolve(..) => "CholeskySolve",
        Op::Constant(_) => "Constant",
        Op::Coordinate(_) => "Coordinate",
        Op::Divide(..) => "Divide",
        Op::Gram { .. } => "Gram",
        Op::GramDiagonal { .. } => "GramDiagonal",
        Op::Input(_) => "Input",
        Op::ModeCoordinates(_) => "ModeCoordinates",
        Op::ModeRates(_) => "ModeRates",
        Op::Multiply(..) => "Multiply",
        Op::Negate(_) => "Negate",
        Op::Parameter(_) => "Parameter",
        Op::PivotReciprocal(_) => "PivotReciprocal",
        Op::Power(..) => "Power",
        Op::Rate(_) => "Rate",
        Op::State(_) => "State",
        Op::Select { .. } => "Select",
        Op::Subtract(..) => "Subtract",
        Op::Table(_) => "Table",
        Op::Time => "Time",
        Op::Total(_) => "Total",
    }
}

/// Interpreter and machine code of one program.
struct Pair {
    name: String,
    interpreted: Evaluator,
    compiled: Evaluator,
}

/// Random time, state and inputs.
struct RandomPoint {
    t: f64,
    state: Vec<f64>,
    inputs: Vec<f64>,
}

impl Pair {
    fn new(name: String, program: Program) -> Self {
        let machine = eomgen_jit::compile(&program).expect("machine code for this machine");
        Self {
            name,
            compiled: Evaluator::with_code(program.clone(), std::sync::Arc::new(machine)),
            interpreted: Evaluator::new(program),
        }
    }

    fn evaluators(&mut self) -> [&mut Evaluator; 2] {
        [&mut self.interpreted, &mut self.compiled]
    }

    /// Prepares both evaluators and compares the prepared numbers and the results.
    fn compare(&mut self, parameters: &[f64], random: &mut Random) {
        let [prepared, found]: [Vec<f64>; 2] = self.evaluators().map(|evaluator| {
            evaluator.prepare(parameters);
            let program = evaluator.program();
            let ids = program.ids().filter(|id| program.value(*id).parameter_only);
            ids.flat_map(|id| evaluator.slice(id).to_vec()).collect()
        });
        self.assert_same("prepare", &prepared, &found, parameters);
        for place in 0..POINTS {
            let drawn = self.draw(random, place % 4 == 3);
            let point = Point {
                t: drawn.t,
                state: &drawn.state,
                inputs: &drawn.inputs,
            };
            let [expected, found] = self
                .evaluators()
                .map(|evaluator| compute_all(evaluator, point));
            for ((what, expected), (_, found)) in expected.iter().zip(&found) {
                self.assert_same(what, expected, found, &drawn.state);
            }
        }
    }

    fn assert_same(&self, what: &str, expected: &[f64], found: &[f64], at: &[f64]) {
        let words = |numbers: &[f64]| -> Vec<u64> { numbers.iter().map(|x| bits(*x)).collect() };
        let first = words(expected)
            .iter()
            .zip(words(found))
            .position(|(left, right)| *left != right);
        assert!(
            first.is_none() && expected.len() == found.len(),
            "{}: {what} differs first at {first:?}: {expected:?} and {found:?} at {at:?}",
            self.name
        );
    }

    fn draw(&self, random: &mut Random, special: bool) -> RandomPoint {
        let program = self.interpreted.program();
        let scale = 10_f64.powi((random.symmetric() * 6.0) as i32);
        let mut number = || match random.pick(&SPECIAL) {
            Some(number) if special => *number,
            _ => scale * random.symmetric(),
        };
        RandomPoint {
            t: number(),
            state: (0..program.states()).map(|_| number()).collect(),
            inputs: program.inputs.iter().map(|_| number()).collect(),
        }
    }
}

/// Returns the bits of a number; all NaNs have the same result.
fn bits(number: f64) -> u64 {
    if number.is_nan() {
        f64::NAN.to_bits()
    } else {
        number.to_bits()
    }
}

fn compute_all(evaluator: &mut Evaluator, point: Point<'_>) -> [(&'static str, Vec<f64>); 6] {
    let program = evaluator.program();
    let (states, degrees) = (program.states(), program.degrees_of_freedom());
    let of_length = |length| vec![f64::NAN; length];
    let mut rates = of_length(states);
    let mut observables = of_length(program.observables.len());
    let mut mass = of_length(degrees * degrees);
    let (mut bias, mut forces) = (of_length(degrees), of_length(degrees));
    let mut guards = of_length(evaluator.guard_count());
    evaluator.rates(point, &mut rates);
    evaluator.observables(point, &mut observables);
    evaluator.guards(point, &mut guards);
    evaluator.mass_matrix(point, &mut mass);
    evaluator.bias_and_forces(point, &mut bias, &mut forces);
    [
        ("rates", rates),
        ("observables", observables),
        ("guards", guards),
        ("mass matrix", mass),
        ("bias", bias),
        ("forces", forces),
    ]
}

/// Returns the program of a model with every field at one order; `None` if it cannot be derived.
fn program(model: &Model, order: usize) -> Option<Program> {
    let values = model
        .parameter_values()
        .expect("the parameters have values");
    let orders = vec![order; model.fields.len()];
    let equations = derive(model, &orders).ok()?;
    Some(lower(model, &equations, &values))
}

fn compare(name: &str, model: &Model, order: usize) {
    let Some(program) = program(model, order) else {
        // Some models cannot be derived without a mode; other tests check the error.
        assert_eq!(order, 0, "{name} cannot be derived");
        return;
    };
    let defaults = program.default_parameters();
    let mut pair = Pair::new(format!("{name} of order {order}"), program);
    let mut random = Random::new(0x5eed_0004 + order as u64);
    pair.compare(&defaults, &mut random);
    let varied: Vec<f64> = defaults
        .iter()
        .map(|value| value * (1.0 + 0.3 * random.symmetric()))
        .collect();
    pair.compare(&varied, &mut random);
    let at_limits: Vec<f64> = defaults
        .iter()
        .map(|_| *random.pick(&SPECIAL).expect("a number"))
        .collect();
    pair.compare(&at_limits, &mut random);
}

fn compare_all(paths: &[PathBuf], orders: &[usize]) {
    for path in paths {
        let name = path.file_stem().expect("a name").to_string_lossy();
        let model = eomgen_model_spec::load(path)
            .expect("a specification")
            .model;
        let orders = if model.fields.is_empty() {
            &[0]
        } else {
            orders
        };
        for order in orders {
            compare(&name, &model, *order);
        }
    }
}

#[test]
fn shipped_specifications_give_same_bits() {
    compare_all(&shipped_specifications(), &[0, 1, 2, 4, 16]);
}

#[test]
fn shipped_specifications_of_high_order_give_same_bits() {
    compare_all(&shipped_specifications(), &[64]);
}

#[test]
fn features_give_same_bits() {
    let folder = project().join("tests/features");
    let mut paths = specifications(&folder);
    assert!(!paths.is_empty(), "no feature");
    paths.sort();
    compare_all(&paths, &[1, 3, 9, 13]);
}

#[test]
fn general_solver_takes_same_steps_with_machine_code() {
    for name in ["double_pendulum", "furuta_pendulum", "planetary_arm"] {
        let model = load(name);
        let program = program(&model, 4).expect("equations of motion");
        let orders: Vec<usize> = program.fields.iter().map(|field| field.order).collect();
        let initial = model.initial_state(&orders).expect("an initial state");
        let samples: Vec<f64> = (0..=20).map(|k| f64::from(k) * 1e-3).collect();
        let inputs = HeldInputs::zero(program.inputs.len());
        let evaluators = [
            Evaluator::new(program.clone()),
            eomgen_jit::evaluator(program),
        ];
        let [interpreted, compiled] = evaluators.map(|evaluator| {
            let system = DrivenModel::new(RefCell::new(evaluator), &inputs);
            let settings = Settings::default();
            let span = (0.0, 0.02);
            simulate(&system, &initial, span, &samples, &settings, &mut |_| {}).expect("a motion")
        });
        assert_eq!(interpreted.states, compiled.states, "{name}");
        assert_eq!(interpreted.final_state, compiled.final_state, "{name}");
    }
}

/// Returns a model with a sum over modes of an integral that needs quadrature. No other specification contains such a
/// sum.
fn tapered_sum_model() -> Model {
    let path = project().join("tests/features/exponential_taper.toml");
    let text = std::fs::read_to_string(path).expect("the feature");
    let (integral, sum) = (
        "1/2*integral(rho*A*exp(-x/l)*(x*dot(theta) + dot(w))^2, w)",
        "1/2*sum(i, w, integral(rho*A*exp(-x/l)*phi[i]^2, w)*dot(q[i])^2)",
    );
    assert!(text.contains(integral));
    let checked = eomgen_model_spec::check(eomgen_model_spec::source::Source::new(
        "tapered.toml",
        text.replace(integral, sum),
    ));
    checked.expect("a specification").model
}

#[test]
fn sum_of_integrals_gives_same_bits() {
    for order in [1, 4, 9] {
        compare("tapered by sum", &tapered_sum_model(), order);
    }
}

#[test]
fn test_programs_contain_every_operation_and_function() {
    let folder = project().join("tests/features");
    let mut models: Vec<Model> = [shipped_specifications(), specifications(&folder)]
        .concat()
        .iter()
        .map(|path| {
            eomgen_model_spec::load(path)
                .expect("a specification")
                .model
        })
        .collect();
    models.push(tapered_sum_model());
    let (mut operations, mut functions) = (BTreeSet::new(), BTreeSet::new());
    for model in &models {
        for value in program(model, 3).expect("a model of order 3").values {
            if let Op::Call(function, _) = &value.op {
                functions.insert(format!("{function:?}"));
            }
            operations.insert(kind(&value.op));
        }
    }
    let missing: Vec<_> = OPERATIONS
        .iter()
        .filter(|operation| !operations.contains(*operation))
        .collect();
    assert!(missing.is_empty(), "no test program contains {missing:?}");
    let missing: Vec<_> = FUNCTIONS
        .iter()
        .filter(|function| !functions.contains(**function))
        .collect();
    assert!(missing.is_empty(), "no test program contains {missing:?}");
}

fn specifications(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect()
}
