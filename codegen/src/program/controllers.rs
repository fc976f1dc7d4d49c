//! Sampled controllers of a program: operations on the values of a sample. The evaluator and the emitted code execute
//! the same operations in the same order; their results are bit-identical.

use eomgen_elementary::Function as Elementary;
use eomgen_model_spec::function::Function;

use super::evaluator::call;
use super::quantity::Quantity;

/// Operation of a controller. Operands are indices of earlier operations.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlOp {
    /// Number.
    Constant(f64),
    /// Independent parameter, by its index in [`Program::parameters`](super::Program::parameters).
    Parameter(usize),
    /// Time between two samples, s.
    Period,
    /// Measured quantity, by its index in [`ProgramController::measured`].
    Measured(usize),
    /// State of the controller before the sample.
    State(usize),
    /// -a
    Negate(usize),
    /// a + b
    Add(usize, usize),
    /// a - b
    Subtract(usize, usize),
    /// a b
    Multiply(usize, usize),
    /// a / b
    Divide(usize, usize),
    /// Function of the expression language, of one or two arguments.
    Call(Function, Vec<usize>),
    /// Function of two arguments that has no function name in the expression language.
    Elementary(Elementary, [usize; 2]),
    /// `[a, b, then, otherwise]`: `then` if a > b, else `otherwise`.
    Select([usize; 4]),
}

impl ControlOp {
    /// Returns the operands.
    pub fn operands(&self) -> Vec<usize> {
        match self {
            Self::Constant(_)
            | Self::Parameter(_)
            | Self::Period
            | Self::Measured(_)
            | Self::State(_) => Vec::new(),
            Self::Negate(a) => vec![*a],
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => {
                vec![*a, *b]
            }
            Self::Call(_, arguments) => arguments.clone(),
            Self::Elementary(_, both) => both.to_vec(),
            Self::Select(parts) => parts.to_vec(),
        }
    }
}

/// Source of a measured quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredSource {
    /// Time of the sample.
    Time,
    /// State of the model, by its index.
    State(usize),
    /// Input before the sample, by its index.
    Input(usize),
    /// Observable with the inputs before the sample, by its index.
    Observable(usize),
}

/// Controller of a program.
#[derive(Clone, Debug)]
pub struct ProgramController {
    /// ASCII name.
    pub name: String,
    /// Description.
    pub doc: String,
    /// Measured quantities.
    pub measured: Vec<Quantity>,
    /// Source of each measured quantity.
    pub sources: Vec<MeasuredSource>,
    /// States.
    pub states: Vec<Quantity>,
    /// Driven inputs.
    pub outputs: Vec<Quantity>,
    /// Index of each driven input.
    pub driven: Vec<usize>,
    /// Operations, operands first.
    pub values: Vec<ControlOp>,
    /// Operations that compute period, offset and delay in s from the parameters.
    pub times: [usize; 3],
    /// Operations that compute the initial states from the parameters.
    pub initial: Vec<usize>,
    /// Operations that compute the states after a sample.
    pub next: Vec<usize>,
    /// Operations that compute the outputs.
    pub output_values: Vec<usize>,
}

/// Values that the operations of a controller read.
#[derive(Clone, Copy, Debug)]
pub struct ControlValues<'v> {
    /// Independent parameters in SI units.
    pub parameters: &'v [f64],
    /// Time between two samples, s.
    pub period: f64,
    /// Measured quantities.
    pub measured: &'v [f64],
    /// States before the sample.
    pub states: &'v [f64],
}

impl ProgramController {
    /// Computes all operations; operations with missing operands are NaN.
    pub fn evaluate(&self, given: ControlValues<'_>, results: &mut Vec<f64>) {
        results.clear();
        let read = |from: &[f64], place: usize| from.get(place).copied().unwrap_or(f64::NAN);
        for op in &self.values {
            let at = |place: &usize| results[*place];
            let result = match op {
                ControlOp::Constant(value) => *value,
                ControlOp::Parameter(place) => read(given.parameters, *place),
                ControlOp::Period => given.period,
                ControlOp::Measured(place) => read(given.measured, *place),
                ControlOp::State(place) => read(given.states, *place),
                ControlOp::Negate(a) => -at(a),
                ControlOp::Add(a, b) => at(a) + at(b),
                ControlOp::Subtract(a, b) => at(a) - at(b),
                ControlOp::Multiply(a, b) => at(a) * at(b),
                ControlOp::Divide(a, b) => at(a) / at(b),
                ControlOp::Call(function, arguments) => {
                    let argument = |place: usize| arguments.get(place).map_or(f64::NAN, at);
                    call(*function, argument(0), argument(1))
                }
                ControlOp::Elementary(function, [a, b]) => function.apply(&[at(a), at(b)]),
                ControlOp::Select([a, b, then, otherwise]) => match at(a) > at(b) {
                    true => at(then),
                    false => at(otherwise),
                },
            };
            results.push(result);
        }
    }

    /// Returns period, offset and delay in s, and the initial states, for given independent parameters in SI units.
    pub fn start(&self, parameters: &[f64]) -> ([f64; 3], Vec<f64>) {
        let mut results = Vec::new();
        let given = ControlValues {
            parameters,
            period: f64::NAN,
            measured: &[],
            states: &[],
        };
        self.evaluate(given, &mut results);
        let initial = self.initial.iter().map(|place| results[*place]).collect();
        (self.times.map(|place| results[place]), initial)
    }
}
