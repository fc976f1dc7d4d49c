//! Measures `max:NAME` and `rms:NAME` of the entire motion, and `final:NAME`, the last row of `simulate`.

use eomgen_model_spec::argument::Argument;
use std::collections::BTreeMap;

use eomgen_compiled_model::{
    CompiledModel, Instance, Measurement, Motion, Quantity, Request, Solver, Statistic,
};
use eomgen_model_spec::foreign::suggest_state;

use crate::conditions::Conditions;
use crate::error::SweepError;
use crate::failure::require_finished_motion;
use crate::measure::{Column, Description, Failure, Measure, Worker};
use crate::window::{Times, Window};

/// Number of output intervals of `final:NAME`, the same as in `simulate`.
const SAMPLES_IN_WINDOW: usize = 1000;

const TOLERANCE: f64 = 1e-9;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    Of(Statistic),
    Final,
}

impl Number {
    const ALL: [Self; 3] = [
        Self::Of(Statistic::Maximum),
        Self::Of(Statistic::RootMeanSquare),
        Self::Final,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Of(Statistic::Maximum) => "max",
            Self::Of(Statistic::RootMeanSquare) => "rms",
            Self::Final => "final",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Of(Statistic::Maximum) => "greatest",
            Self::Of(Statistic::RootMeanSquare) => "root mean square of",
            Self::Final => "last",
        }
    }
}

/// Returns the names that [`OverTime::new`] accepts, with `NAME` for the quantity.
pub fn measure_names() -> impl Iterator<Item = String> {
    Number::ALL
        .into_iter()
        .map(|number| format!("{}:NAME", number.name()))
}

/// Splits the name of a measure over time, for example `max:tip`.
fn split_name(measure_name: &str) -> Option<(Number, &str)> {
    let (number, name) = measure_name.split_once(':')?;
    let mut numbers = Number::ALL.into_iter();
    Some((numbers.find(|known| known.name() == number)?, name))
}

fn find_number(model: &CompiledModel, measure_name: &str) -> Result<NumberOfQuantity, SweepError> {
    let Some((number, name)) = split_name(measure_name) else {
        let message = format!(
            "{}: expected a measure over time",
            Argument::Measure.with_text(measure_name)
        );
        return Err(SweepError::Request(message));
    };
    let (states, observables) = (model.state_names(), model.observable_names());
    let place = |names: &[String]| names.iter().position(|known| known == name);
    let (quantity, unit) = if let Some(place) = place(&observables) {
        let unit = model.program().observables[place].unit.clone();
        (Quantity::Observable(place), unit)
    } else if let Some(place) = place(&states) {
        (Quantity::State(place), model.state_units()[place].clone())
    } else {
        if let Some(controller) = find_controller(model, name) {
            return Err(SweepError::Request(format!(
                "{}: `{name}` is a state of the controller `{controller}`, which a sweep does not measure: measure an \
                 observable, a coordinate or a rate; `simulate` writes the states of controllers",
                Argument::Measure.with_text(measure_name)
            )));
        }
        let known = observables.iter().chain(&states).map(String::as_str);
        let hint = suggest_state(name, known).unwrap_or_else(|| {
            format!(
                "it has {}",
                [observables.join(", "), states.join(", ")].join(", ")
            )
        });
        return Err(SweepError::Request(format!(
            "{}: the model `{}` has no observable, coordinate or rate `{name}`: {hint}",
            Argument::Measure.with_text(measure_name),
            model.model().name
        )));
    };
    Ok(NumberOfQuantity {
        number,
        quantity,
        typical_size: model.typical_size(quantity),
        name: name.to_owned(),
        unit,
    })
}

/// Returns the name of the controller with the given state, if any.
fn find_controller<'m>(model: &'m CompiledModel, state: &str) -> Option<&'m str> {
    let mut controllers = model.model().controllers.iter();
    let own = controllers.find(|own| own.states.iter().any(|known| known.name == state));
    own.map(|own| own.name.as_str())
}

/// Measures of quantities at many parameter values, from one motion per point.
pub struct OverTime<'a> {
    model: &'a CompiledModel,
    conditions: &'a Conditions,
    numbers: Vec<NumberOfQuantity>,
    times: Times,
}

/// Measure of one quantity.
struct NumberOfQuantity {
    number: Number,
    quantity: Quantity,
    /// Typical size of the quantity, SI.
    typical_size: f64,
    name: String,
    unit: String,
}

impl NumberOfQuantity {
    /// Returns the name on the command line.
    fn measure_name(&self) -> String {
        format!("{}:{}", self.number.name(), self.name)
    }
}

impl<'a> OverTime<'a> {
    /// Returns true for a measure over time, for example `max:tip`.
    pub fn accepts(measure_name: &str) -> bool {
        split_name(measure_name).is_some()
    }

    /// Creates the measures with the given names.
    ///
    /// # Errors
    /// The name of another measure, a quantity that the model does not have, or an invalid window.
    pub fn new(
        (model, conditions): (&'a CompiledModel, &'a Conditions),
        measure_name: &[String],
        window: &Window,
    ) -> Result<Self, SweepError> {
        let numbers = measure_name
            .iter()
            .map(|measure_name| find_number(model, measure_name));
        let measure_name = measure_name.join(",");
        Ok(Self {
            model,
            conditions,
            numbers: numbers.collect::<Result<_, _>>()?,
            times: Times::from_window((model.model(), conditions), window, &measure_name, 1)?,
        })
    }

    /// Returns the output times of `simulate` up to the end of the window, s.
    fn list_row_times(&self, (begin, end): (f64, f64)) -> Vec<f64> {
        if let (Times::Until(_), Some(record)) = (&self.times, self.conditions.record_times()) {
            return record.iter().copied().take_while(|t| *t <= end).collect();
        }
        let start = self.conditions.start();
        let sample = |place: usize| match place {
            SAMPLES_IN_WINDOW => end,
            _ => begin + (end - begin) * place as f64 / SAMPLES_IN_WINDOW as f64,
        };
        let before = usize::from(begin > start);
        let rows = (0..=SAMPLES_IN_WINDOW).map(sample);
        std::iter::repeat_n(start, before).chain(rows).collect()
    }

    /// Simulates and measures the motion at a point. Calls `check` between steps.
    fn simulate(
        &self,
        settings: &[(&str, f64)],
        check: &dyn Fn(),
    ) -> Result<(Instance<'a>, Motion), Failure> {
        let instance = self.model.with_parameters(settings)?;
        let (begin, end) = self.times.range(&instance, self.conditions)?;
        let start = self.conditions.start_at(&instance, settings)?;
        let has_final = self.numbers.iter().any(|own| own.number == Number::Final);
        let rows = match has_final {
            true => self.list_row_times((begin, end)),
            false => vec![self.conditions.start(), end],
        };
        let request = Request {
            initial: &start.state,
            times: &rows,
            inputs: &start.inputs,
            solver: Solver::Auto,
            tolerance: TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        };
        let measurements = self.numbers.iter().filter_map(|own| match own.number {
            Number::Of(statistic) => Some(Measurement {
                quantity: own.quantity,
                statistic,
                begin,
                typical_size: own.typical_size,
            }),
            Number::Final => None,
        });
        let measurements: Vec<Measurement> = measurements.collect();
        let motion = instance.simulate_measured(&request, &measurements, &mut |_| check());
        Ok((instance, require_finished_motion(motion)?))
    }
}

/// Returns the state and the observables in the last row of a motion.
fn evaluate_last_row(
    instance: &Instance<'_>,
    motion: &Motion,
) -> Result<(Vec<f64>, Vec<f64>), Failure> {
    let mut last = (Vec::new(), Vec::new());
    instance.observe(motion, |_, state, observables| {
        last.0.clear();
        last.1.clear();
        last.0.extend_from_slice(state);
        last.1.extend_from_slice(observables);
    })?;
    Ok(last)
}

impl Measure for OverTime<'_> {
    fn describe(&self) -> Vec<Description> {
        let option = |name: &str, value: String| (name.to_owned(), value);
        let numbers = self.numbers.iter().map(|own| {
            let measure_name = own.measure_name();
            let about = format!("{} {}", own.number.about(), own.name);
            Description {
                about: match own.number {
                    Number::Of(_) => format!("{about}, over the entire motion"),
                    Number::Final => about.clone(),
                },
                options: BTreeMap::from_iter(self.times.options().into_iter().chain([
                    option("solver", Solver::Auto.name().to_owned()),
                    option("tolerance", format!("{TOLERANCE:?}")),
                ])),
                columns: vec![Column::new(&measure_name, &own.unit, about)],
                drawn: vec![measure_name.clone()],
                quantity: own.name.clone(),
                name: measure_name,
            }
        });
        numbers.collect()
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(self)
    }
}

impl Worker for &OverTime<'_> {
    fn measure(
        &mut self,
        settings: &[(&str, f64)],
        out: &mut [f64],
        check: &dyn Fn(),
    ) -> Result<(), Failure> {
        let (instance, motion) = self.simulate(settings, check)?;
        let is_final = |own: &NumberOfQuantity| own.number == Number::Final;
        let (state, observables) = match self.numbers.iter().any(is_final) {
            true => evaluate_last_row(&instance, &motion)?,
            false => (Vec::new(), Vec::new()),
        };
        let mut measured = motion.measured.iter();
        for (out, own) in out.iter_mut().zip(&self.numbers) {
            let number = match (own.number, own.quantity) {
                (Number::Of(_), _) => measured.next().copied().flatten(),
                (Number::Final, Quantity::State(place)) => state.get(place).copied(),
                (Number::Final, Quantity::Observable(place)) => observables.get(place).copied(),
            };
            *out = number.ok_or(Failure::Undefined)?;
        }
        Ok(())
    }
}
