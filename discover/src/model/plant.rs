//! A model as something that can be run: its derived program, its part that is linear between
//! switches, and the measured quantities among its outputs. It runs in [`crate::model::runner`]; what
//! is estimated with it is decided elsewhere.

use codegen::program::evaluator::Evaluator;
use eomgen_compiled_model::{CompiledModel, Error, Orders};
use model_spec::model::{Model, ParameterValue};

use crate::model::beside::Beside;
use crate::model::runner::{Runner, Shown};
use eomgen_records::dataset::{Channel, Quantity};
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;
use sim::exponential::ExponentialIntegrator;

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
    /// The model.
    compiled: CompiledModel,
    /// The names of the independent parameters, in the order of their values.
    pub parameters: Vec<String>,
    /// The values the specification gives them, SI.
    pub values: Vec<f64>,
    /// The names of the states.
    pub states: Vec<String>,
    /// Where each coordinate lives, for those of which the specification says so.
    ranges: Vec<Option<(f64, f64)>>,
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

/// What of a model is linear between switches.
enum LinearPart {
    /// All of it.
    Whole,
    /// The model of this part and, for each of its parameters, the place among the whole
    /// model's.
    Part(Box<CompiledModel>, Vec<usize>),
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
        plant.linear = match (plant.compiled.piecewise_linear(), linear) {
            (Ok(_), _) => Some(LinearPart::Whole),
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
        let compiled = compiled(text, name, order).map_err(in_words)?;
        let ranges = compiled.model().coordinate_ranges();
        let ranges = ranges.map_err(|error| error.to_string())?;
        let program = compiled.program();
        let is_number =
            |p: &&model_spec::model::Parameter| matches!(p.value, ParameterValue::Number(_));
        let independent = compiled.model().parameters.iter().filter(is_number);
        let parameters = independent.map(|p| p.name.clone()).collect();
        let degrees = program.degrees_of_freedom();
        let outputs = channels.iter().map(|channel| match channel.quantity {
            Quantity::Observable(place) => Output::Observable(place),
            Quantity::Coordinate(place) => Output::State(place),
            Quantity::Rate(place) => Output::State(degrees + place),
        });
        Ok(Self {
            outputs: outputs.collect(),
            channels: channels
                .iter()
                .map(|channel| channel.name.clone())
                .collect(),
            parameters,
            values: program.default_parameters(),
            states: compiled.state_names(),
            ranges,
            linear: None,
            steps: None,
            sample: 0.0,
            refinement: 1.0,
            compiled,
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

    /// The checked model.
    pub fn model(&self) -> &Model {
        self.compiled.model()
    }

    /// The order of each field.
    pub fn orders(&self) -> &[usize] {
        self.compiled.orders()
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
        self.compiled.program().observables.len()
    }

    /// A text with no terms but those that are linear between switches is enough for the
    /// whole model.
    pub fn is_linear(&self) -> bool {
        matches!(self.linear, Some(LinearPart::Whole))
    }

    /// The initial state that the specification gives.
    pub fn initial(&self) -> Vec<f64> {
        let given = self.compiled.model().initial_state(self.compiled.orders());
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
        let mut evaluator = self.compiled.evaluator(values);
        if !evaluator.pivots_are_positive() {
            return Err("the mass matrix is not positive definite".to_owned());
        }
        let shown = Shown::of(self, &mut evaluator);
        let mut runner = Runner::new(self, evaluator, shown);
        let (linear, own) = match &self.linear {
            None => return Ok(runner),
            Some(LinearPart::Whole) => (&self.compiled, values.to_vec()),
            Some(LinearPart::Part(part, places)) => {
                let own = places.iter().map(|place| values[*place]);
                (&**part, own.collect())
            }
        };
        let exact = linear.piecewise_linear().map_err(ToString::to_string)?;
        runner.march =
            ExponentialIntegrator::new(exact.evaluator(&own), self.sample, self.refinement);
        match (&runner.march, self.is_linear()) {
            (None, true) => {
                let exact = exact.at(values).map_err(|error| error.to_string())?;
                runner.propagate(exact, FASTEST_SWITCHING);
            }
            (Some(_), false) => {
                let whole = self.compiled.evaluator(values);
                runner.beside = Some(Beside::new(whole, linear.evaluator(&own)));
            }
            (Some(_), true) | (None, false) => {}
        }
        Ok(runner)
    }

    /// The model's equations at these values, to be compared with others.
    pub(crate) fn evaluator(&self, values: &[f64]) -> (Evaluator, Option<Shown>) {
        let mut evaluator = self.compiled.evaluator(values);
        let shown = Shown::of(self, &mut evaluator);
        (evaluator, shown)
    }
}

/// Whether a text's model is linear between its switches.
pub fn is_linear(text: &str, name: &str, order: Option<usize>) -> bool {
    compiled(text, name, order).is_ok_and(|compiled| compiled.piecewise_linear().is_ok())
}

/// The linear part of a model whose text is given, if it has the model's states.
fn linear_part(text: &str, name: &str, order: Option<usize>, plant: &Plant) -> Option<LinearPart> {
    let part = compiled(text, name, order).ok()?;
    if part.state_names() != plant.states {
        return None;
    }
    let exact = part.piecewise_linear().ok()?;
    let places = exact.parameters().iter().map(|own| plant.place(own));
    let places = places.collect::<Option<Vec<usize>>>()?;
    Some(LinearPart::Part(Box::new(part), places))
}

/// The model of a text.
fn compiled(text: &str, name: &str, order: Option<usize>) -> Result<CompiledModel, Error> {
    CompiledModel::of_text(name, text, order.map_or(Orders::Declared, Orders::All))
}

/// What is wrong with a text, for a file or a page.
fn in_words(error: Error) -> String {
    match error {
        Error::Specification(found) => found.render(false),
        other => other.to_string(),
    }
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
