//! A model as something that can be run: its derived program, its part that is linear between
//! switches, and the measured quantities among its outputs. It runs in [`crate::model::runner`]; what
//! is estimated with it is decided elsewhere.

use std::sync::Arc;

use codegen::program::Program;
use codegen::program::evaluator::{Evaluator, MachineCode};
use codegen::variant::Variant;
use model_spec::model::{Model, ParameterValue};
use model_spec::source::Source;
use sim::piecewise_linear::PiecewiseLinear;

use crate::beside::Beside;
use crate::model::runner::{Runner, Shown};
use eomgen_records::dataset::{Channel, Quantity};
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;
use sim::exponential::March;

/// Switches per simulated second beyond which a trial motion is given up, 1/s.
pub(crate) const FASTEST_SWITCHING: f64 = 1e5;

/// Samples on which the number of marching steps is tried.
const TRIED_SAMPLES: usize = 100;

/// Marching steps from sample to sample are tried up to two to this power.
const MOST_DOUBLINGS: u32 = 7;

/// The root mean square error of marching, in noises: what is marched is compared with noise.
const MARCHING_ERROR: f64 = 0.2;

/// A derived model with its measured outputs.
pub struct Plant {
    /// The checked model.
    pub model: Model,
    /// The order of each field.
    pub orders: Vec<usize>,
    /// The names of the independent parameters, in the order of their values.
    pub parameters: Vec<String>,
    /// The values the specification gives them, SI.
    pub values: Vec<f64>,
    /// The names of the states.
    pub states: Vec<String>,
    /// Where each coordinate lives, for those of which the specification says so.
    ranges: Vec<Option<(f64, f64)>>,
    code: Code,
    linear: Option<LinearPart>,
    pub(crate) outputs: Vec<Output>,
    channels: Vec<String>,
    /// Runge-Kutta steps from sample to sample, where the motion has no linear part; none
    /// where a solver decides.
    pub(crate) steps: Option<usize>,
    /// The usual time from sample to sample, s, and into how many parts of it steps are made
    /// shorter where the linear part is not all.
    sample: f64,
    refinement: f64,
}

/// A program with its machine code.
struct Code {
    program: Program,
    code: Option<Arc<dyn MachineCode>>,
}

impl Code {
    fn of(program: Program) -> Self {
        Self {
            code: jit::code(&program),
            program,
        }
    }

    fn evaluator(&self, values: &[f64]) -> Evaluator {
        let mut evaluator = match &self.code {
            Some(code) => Evaluator::with_code(self.program.clone(), code.clone()),
            None => Evaluator::new(self.program.clone()),
        };
        evaluator.prepare(values);
        evaluator
    }
}

/// What of a model is linear between switches.
struct LinearPart {
    exact: PiecewiseLinear,
    /// Where it is not all: the program of this part and, for each of its parameters, the
    /// place among the whole model's.
    beside: Option<(Code, Vec<usize>)>,
}

/// Where a channel's quantity is found.
#[derive(Clone, Copy)]
pub(crate) enum Output {
    State(usize),
    Observable(usize),
}

impl Plant {
    /// Derives the model of a specification's text. `linear`: a text of the same model without
    /// terms that are not linear between switches, if there are such terms.
    ///
    /// # Errors
    /// What is wrong with the text, in words.
    pub fn of(
        text: &str,
        linear: Option<&str>,
        name: &str,
        order: Option<usize>,
        channels: &[Channel],
    ) -> Result<Self, String> {
        let mut plant = Self::equations(text, name, order, channels)?;
        plant.linear = match (PiecewiseLinear::of(&plant.model, &plant.orders), linear) {
            (Ok(exact), _) => Some(LinearPart {
                exact,
                beside: None,
            }),
            (Err(_), Some(linear)) => linear_part(linear, name, order, &plant),
            (Err(_), None) => None,
        };
        Ok(plant)
    }

    /// The same with its equations alone, to be compared with another's.
    ///
    /// # Errors
    /// As for [`Plant::of`].
    pub fn equations(
        text: &str,
        name: &str,
        order: Option<usize>,
        channels: &[Channel],
    ) -> Result<Self, String> {
        let checked = model_spec::check(Source::new(name, text)).map_err(|d| d.render(false))?;
        let model = checked.model;
        let orders = model.orders(order).map_err(|error| error.to_string())?;
        let variant = Variant::derive(&model, &orders).map_err(|d| d.render(false))?;
        let states = model.state_names(&orders);
        let ranges = model
            .coordinate_ranges()
            .map_err(|error| error.to_string())?;
        let program = variant.program;
        let independent =
            |p: &&model_spec::model::Parameter| matches!(p.value, ParameterValue::Number(_));
        let parameters = model
            .parameters
            .iter()
            .filter(independent)
            .map(|p| p.name.clone())
            .collect::<Vec<_>>();
        let outputs = channels.iter().map(|channel| match channel.quantity {
            Quantity::Observable(place) => Output::Observable(place),
            Quantity::Coordinate(place) => Output::State(place),
            Quantity::Rate(place) => Output::State(program.degrees_of_freedom() + place),
        });
        Ok(Self {
            outputs: outputs.collect(),
            channels: channels
                .iter()
                .map(|channel| channel.name.clone())
                .collect(),
            parameters,
            values: program.default_parameters(),
            states,
            ranges,
            code: Code::of(program),
            linear: None,
            steps: None,
            sample: 0.0,
            refinement: 1.0,
            model,
            orders,
        })
    }

    /// A state moved to where the model lives.
    pub fn admissible(&self, mut state: Vec<f64>) -> Vec<f64> {
        for (entry, range) in state.iter_mut().zip(&self.ranges) {
            if let Some((low, high)) = range {
                *entry = entry.clamp(*low, *high);
            }
        }
        state
    }

    /// The place of an independent parameter among the values.
    pub fn place(&self, parameter: &str) -> Option<usize> {
        self.parameters.iter().position(|name| name == parameter)
    }

    /// Sets an independent parameter among the values, SI.
    pub fn set(&self, values: &mut [f64], parameter: &str, value: f64) {
        if let Some(place) = self.place(parameter) {
            values[place] = value;
        }
    }

    /// The place of a measured channel.
    pub fn channel(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|channel| channel == name)
    }

    pub(crate) fn shows_states_only(&self) -> bool {
        self.outputs
            .iter()
            .all(|output| matches!(output, Output::State(_)))
    }

    /// How many states there are.
    pub fn state_count(&self) -> usize {
        self.states.len()
    }

    /// How many observables the model has.
    pub(crate) fn observables(&self) -> usize {
        self.code.program.observables.len()
    }

    /// A text with no terms but those that are linear between switches is enough for the
    /// whole model.
    pub fn is_linear(&self) -> bool {
        self.linear
            .as_ref()
            .is_some_and(|part| part.beside.is_none())
    }

    /// The initial state that the specification gives.
    pub fn initial(&self) -> Vec<f64> {
        let given = self.model.initial_state(&self.orders);
        given.unwrap_or_else(|_| vec![0.0; self.state_count()])
    }

    /// Decides in how many steps a motion is marched from sample to sample, where that is not
    /// known beforehand: as many as change its outputs by less than a part of the noise, tried
    /// on the beginning of a record. Where there are none, a solver with error control goes on
    /// deciding.
    pub fn choose_steps(&mut self, record: &Record, initial: &[f64], noise: &[f64]) {
        self.sample = typical_step(&record.times);
        if self.is_linear() {
            return;
        }
        let times = &record.times[..record.times.len().min(TRIED_SAMPLES)];
        let marched = self.linear.is_some();
        let run = |plant: &mut Self, doubling: u32| {
            if marched {
                plant.refinement = f64::from(1 << doubling);
            } else {
                plant.steps = Some(1 << doubling);
            }
            let mut runner = plant.at(&plant.values).ok()?;
            if marched && runner.march.is_none() {
                return None;
            }
            let outputs = runner.outputs(initial, times, &record.inputs).ok()?;
            Some(outputs.values)
        };
        let mut coarse = run(self, 0);
        for doubling in 1..MOST_DOUBLINGS {
            let fine = run(self, doubling);
            let near = |(coarse, fine): (&Vec<f64>, &Vec<f64>)| {
                let pairs = coarse.iter().zip(fine).enumerate();
                let square = |(place, (a, b)): (usize, (&f64, &f64))| {
                    ((a - b) / noise[place % noise.len()]).powi(2)
                };
                let sum: f64 = pairs.map(square).sum();
                sum < MARCHING_ERROR.powi(2) * coarse.len() as f64
            };
            if coarse.as_ref().zip(fine.as_ref()).is_some_and(near) {
                if marched {
                    // A march gains a factor of four by each doubling: the coarser is enough.
                    self.refinement = f64::from(1 << (doubling - 1));
                }
                return;
            }
            coarse = fine;
        }
        if marched {
            self.refinement = 1.0;
        }
        self.steps = None;
    }

    /// The model at these values of the independent parameters, ready to run.
    ///
    /// # Errors
    /// Values at which there is no motion, in words.
    pub fn at(&self, values: &[f64]) -> Result<Runner<'_>, String> {
        let mut evaluator = self.code.evaluator(values);
        if !evaluator.pivots_are_positive() {
            return Err("the mass matrix is not positive definite".to_owned());
        }
        let shown = Shown::of(self, &mut evaluator);
        let mut runner = Runner::new(self, evaluator, shown);
        let Some(part) = &self.linear else {
            return Ok(runner);
        };
        let own = match &part.beside {
            None => values.to_vec(),
            Some((_, places)) => places.iter().map(|place| values[*place]).collect(),
        };
        let evaluator = part.exact.evaluator(&own);
        runner.march = March::new(evaluator, self.sample, self.refinement);
        match (&runner.march, &part.beside) {
            (Some(_), None) => {}
            (Some(_), Some((code, _))) => {
                let whole = self.code.evaluator(values);
                runner.beside = Some(Beside::new(whole, code.evaluator(&own)));
            }
            (None, None) => {
                let exact = part.exact.at(values).map_err(|error| error.to_string())?;
                runner.propagate(exact, FASTEST_SWITCHING);
            }
            (None, Some(_)) => {}
        }
        Ok(runner)
    }

    /// The model's equations at these values, to be compared with others.
    pub(crate) fn evaluator(&self, values: &[f64]) -> (Evaluator, Option<Shown>) {
        let mut evaluator = self.code.evaluator(values);
        let shown = Shown::of(self, &mut evaluator);
        (evaluator, shown)
    }
}

/// Whether a text's model is linear between its switches.
pub fn is_linear(text: &str, name: &str, order: Option<usize>) -> bool {
    let Ok(checked) = model_spec::check(Source::new(name, text)) else {
        return false;
    };
    let orders = checked.model.orders(order);
    orders.is_ok_and(|orders| PiecewiseLinear::of(&checked.model, &orders).is_ok())
}

/// The linear part of a model whose text is given, if it has the model's states.
fn linear_part(text: &str, name: &str, order: Option<usize>, plant: &Plant) -> Option<LinearPart> {
    let model = model_spec::check(Source::new(name, text)).ok()?.model;
    let orders = model.orders(order).ok()?;
    if model.state_names(&orders) != plant.states {
        return None;
    }
    let exact = PiecewiseLinear::of(&model, &orders).ok()?;
    let places = exact.parameters().iter().map(|own| plant.place(own));
    let places = places.collect::<Option<Vec<usize>>>()?;
    let program = Variant::derive(&model, &orders).ok()?.program;
    Some(LinearPart {
        exact,
        beside: Some((Code::of(program), places)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEAKER: &str = r#"[model]
name = "speaker"
[parameters]
m = { value = 10, unit = "g" }
b = { value = 5, unit = "mm" }
[coordinates]
y = { unit = "m" }
x = { unit = "m", range = ["-b", "b"] }
[kinetic]
masses = "1/2*m*(dot(x)^2 + dot(y)^2)"
"#;

    #[test]
    fn an_initial_state_stays_where_the_model_lives() {
        let plant = Plant::equations(SPEAKER, "speaker", None, &[]).expect("a plant");
        let moved = |x: f64| plant.admissible(vec![9.0, x, 9.0, 9.0]);
        assert_eq!(moved(0.02), [9.0, 0.005, 9.0, 9.0]);
        assert_eq!(moved(-0.02), [9.0, -0.005, 9.0, 9.0]);
        assert_eq!(moved(0.002), [9.0, 0.002, 9.0, 9.0]);
    }
}
