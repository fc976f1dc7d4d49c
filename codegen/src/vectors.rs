//! Test vectors of a program: states with all outputs as bit patterns, and the coefficients of the default
//! parameters. The backends write them next to the emitted source, with a function that compares a target with them.

use crate::program::evaluator::{Evaluator, Point};
use crate::program::{Extent, Program, ValueId};
use crate::statements::{EmitError, File, collect_coefficients};

/// Time, state and inputs of a call.
#[derive(Clone, Debug, PartialEq)]
pub struct CallArguments {
    /// Time in s.
    pub time: f64,
    /// State, in SI units.
    pub state: Vec<f64>,
    /// Inputs, in SI units.
    pub inputs: Vec<f64>,
}

impl CallArguments {
    /// Returns time, state and inputs in this order.
    pub fn numbers(&self) -> Vec<f64> {
        [&[self.time][..], &self.state, &self.inputs].concat()
    }

    fn rounded(&self) -> Self {
        let round = |number: &f64| f64::from(*number as f32);
        Self {
            time: round(&self.time),
            state: self.state.iter().map(round).collect(),
            inputs: self.inputs.iter().map(round).collect(),
        }
    }
}

/// Arguments of a call and the expected results.
#[derive(Clone, Debug, PartialEq)]
pub struct TestVector {
    /// Arguments.
    pub arguments: CallArguments,
    /// Rates, observables, energy, power, guards and mass matrix, in this order.
    pub expected: Vec<f64>,
}

impl TestVector {
    /// Returns the arguments, then the results.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        [self.arguments.numbers(), self.expected.clone()].concat()
    }
}

/// Test vectors in both precisions. All single-precision numbers are exactly representable in `f32`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TestVectors {
    /// Double precision.
    pub double: Vec<TestVector>,
    /// Single precision, with coefficients that are prepared in double precision.
    pub single: Vec<TestVector>,
}

impl TestVectors {
    /// Computes all outputs of `program` for each call. Calls with a result that is not finite are left out.
    pub fn new(program: &Program, calls: &[CallArguments]) -> Self {
        let vectors = |evaluator: &mut Evaluator, calls: Vec<CallArguments>| {
            let calls = calls.into_iter();
            let vectors = calls.map(|arguments| TestVector {
                expected: compute_outputs(evaluator, &arguments),
                arguments,
            });
            vectors
                .filter(|vector| vector.expected.iter().all(|number| number.is_finite()))
                .collect()
        };
        let mut evaluator = Evaluator::new(program.clone());
        let double = vectors(&mut evaluator, calls.to_vec());
        let mut evaluator = evaluator.in_single_precision(&collect_coefficients(program));
        let single = vectors(
            &mut evaluator,
            calls.iter().map(CallArguments::rounded).collect(),
        );
        Self { double, single }
    }
}

fn compute_outputs(evaluator: &mut Evaluator, arguments: &CallArguments) -> Vec<f64> {
    let program = evaluator.program();
    let (states, degrees) = (program.states(), program.degrees_of_freedom());
    let (known, observables) = (program.observable_values.len(), program.observables.len());
    let guards = evaluator.guard_count();
    let [mut rates, mut values, mut surfaces, mut mass] =
        [states, known, guards, degrees * degrees].map(|length| vec![0.0; length]);
    let point = Point {
        t: arguments.time,
        state: &arguments.state,
        inputs: &arguments.inputs,
    };
    evaluator.rates(point, &mut rates);
    evaluator.observables(point, &mut values);
    evaluator.guards(point, &mut surfaces);
    evaluator.mass_matrix(point, &mut mass);
    let energy_and_power = &values[known - 2..];
    [
        &rates[..],
        &values[..observables],
        energy_and_power,
        &surfaces,
        &mass,
    ]
    .concat()
}

/// Coefficients of the default parameters, as literals of the target language.
pub(crate) struct DefaultCoefficients {
    /// Names of the fields with their literals, in the order of the emitted file.
    pub fields: Vec<(String, String)>,
    /// True if the mass matrix is positive definite.
    pub is_definite: bool,
}

/// Computes the coefficients of the default parameters and writes each number by `literal` and each array by `array`.
///
/// # Errors
/// A coefficient that is not finite, with its name.
pub(crate) fn compute_default_coefficients(
    file: &File<'_>,
    literal: impl Fn(f64) -> String,
    array: impl Fn(&[String]) -> String,
) -> Result<DefaultCoefficients, EmitError> {
    let evaluator = Evaluator::new(file.program.clone());
    let field = |id: &ValueId| {
        let (name, numbers) = (&file.field_names[id], evaluator.slice(*id));
        if let Some(bad) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(EmitError::Value(format!(
                "the coefficient `{name}` is {bad} for the default parameters"
            )));
        }
        let literals: Vec<String> = numbers.iter().map(|number| literal(*number)).collect();
        let text = match file.program.value(*id).extent {
            Extent::Scalar => literals.concat(),
            Extent::Vector(_) => array(&literals),
            Extent::Matrix(_, columns) => {
                let rows: Vec<String> = literals.chunks(columns.max(1)).map(&array).collect();
                array(&rows)
            }
        };
        Ok((name.clone(), text))
    };
    Ok(DefaultCoefficients {
        fields: file.fields.iter().map(field).collect::<Result<_, _>>()?,
        is_definite: evaluator.pivots_are_positive(),
    })
}
