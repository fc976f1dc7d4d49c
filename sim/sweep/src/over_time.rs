//! Measures `max:NAME`, `rms:NAME` and `final:NAME`, with the same samples as `simulate`.

use std::collections::BTreeMap;

use eomgen_analysis::time_history::{greatest, root_mean_square};
use eomgen_compiled_model::{CompiledModel, Instance, Motion, Request, Solver};
use eomgen_model_spec::suggest::did_you_mean;

use crate::conditions::Conditions;
use crate::error::SweepError;
use crate::failure::finished_motion;
use crate::measure::{Column, Description, Failure, Measure, Worker};
use crate::window::{Times, Window};

/// Number of sample intervals, the same as in `simulate`.
const SAMPLES_IN_WINDOW: usize = 1000;

const TOLERANCE: f64 = 1e-9;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Statistic {
    Maximum,
    RootMeanSquare,
    Final,
}

impl Statistic {
    const ALL: [Self; 3] = [Self::Maximum, Self::RootMeanSquare, Self::Final];

    fn name(self) -> &'static str {
        match self {
            Self::Maximum => "max",
            Self::RootMeanSquare => "rms",
            Self::Final => "final",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Maximum => "greatest",
            Self::RootMeanSquare => "root mean square of",
            Self::Final => "last",
        }
    }
}

/// Returns the names that [`OverTime::new`] accepts, with `NAME` for the quantity.
pub fn measure_names() -> impl Iterator<Item = String> {
    Statistic::ALL
        .into_iter()
        .map(|statistic| format!("{}:NAME", statistic.name()))
}

enum Quantity {
    State(usize),
    Observable(usize),
}

/// Statistic of a quantity at many parameter values.
pub struct OverTime<'a> {
    model: &'a CompiledModel,
    conditions: &'a Conditions,
    statistic: Statistic,
    quantity: Quantity,
    name: String,
    unit: String,
    times: Times,
}

impl<'a> OverTime<'a> {
    /// Creates the measure `asked`, for example `max:tip`; `None` for another measure's name.
    ///
    /// # Errors
    /// A quantity that the model does not have, or an invalid window.
    pub fn new(
        driven: (&'a CompiledModel, &'a Conditions),
        asked: &str,
        window: &Window,
    ) -> Option<Result<Self, SweepError>> {
        let (statistic, name) = asked.split_once(':')?;
        let mut statistics = Statistic::ALL.into_iter();
        let statistic = statistics.find(|known| known.name() == statistic)?;
        Some(Self::build(driven, statistic, name, window))
    }

    fn build(
        (model, conditions): (&'a CompiledModel, &'a Conditions),
        statistic: Statistic,
        name: &str,
        window: &Window,
    ) -> Result<Self, SweepError> {
        let asked = format!("{}:{name}", statistic.name());
        let (states, observables) = (model.state_names(), model.observable_names());
        let place = |names: &[String]| names.iter().position(|known| known == name);
        let (quantity, unit) = if let Some(place) = place(&observables) {
            let unit = model.program().observables[place].unit.clone();
            (Quantity::Observable(place), unit)
        } else if let Some(place) = place(&states) {
            (Quantity::State(place), model.state_units()[place].clone())
        } else {
            let known = observables.iter().chain(&states).map(String::as_str);
            let hint = did_you_mean(name, known).unwrap_or_else(|| {
                format!(
                    "it has {}",
                    [observables.join(", "), states.join(", ")].join(", ")
                )
            });
            return Err(SweepError::Request(format!(
                "--measure {asked}: the model `{}` has no observable, coordinate or rate `{name}`: {hint}",
                model.model().name
            )));
        };
        let times = Times::from_window((model.model(), conditions), window, &asked, 1)?;
        Ok(Self {
            model,
            conditions,
            statistic,
            quantity,
            name: name.to_owned(),
            unit,
            times,
        })
    }

    /// Returns the times of the samples in s, and the index of the first one in the window.
    fn sample_times(&self, instance: &Instance<'_>) -> Result<(Vec<f64>, usize), Failure> {
        let (begin, end) = self.times.range(instance, self.conditions)?;
        if let Some(record) = self.record_times() {
            let times = record.iter().copied().take_while(|t| *t <= end);
            return Ok((times.collect(), 0));
        }
        let start = self.conditions.start();
        let sample = |place: usize| match place {
            SAMPLES_IN_WINDOW => end,
            _ => begin + (end - begin) * place as f64 / SAMPLES_IN_WINDOW as f64,
        };
        let looked_at = (0..=SAMPLES_IN_WINDOW).map(sample);
        let before = usize::from(begin > start);
        let times = std::iter::repeat_n(start, before).chain(looked_at);
        Ok((times.collect(), before))
    }

    /// Returns the times of a record that are sampled, as in `simulate`.
    fn record_times(&self) -> Option<&[f64]> {
        match self.times {
            Times::Until(_) => self.conditions.record_times(),
            Times::Periods(..) => None,
        }
    }

    fn values_over_time(
        &self,
        instance: &Instance<'_>,
        motion: &Motion,
    ) -> Result<Vec<f64>, Failure> {
        Ok(match self.quantity {
            Quantity::State(place) => {
                let states = motion.trajectory.states.iter();
                states.map(|state| state[place]).collect()
            }
            Quantity::Observable(place) => {
                let mut course = Vec::with_capacity(motion.trajectory.times.len());
                instance.observe(motion, |_, _, observables| course.push(observables[place]))?;
                course
            }
        })
    }
}

impl Measure for OverTime<'_> {
    fn describe(&self) -> Description {
        let option = |name: &str, value: String| (name.to_owned(), value);
        let asked = format!("{}:{}", self.statistic.name(), self.name);
        let about = format!("{} {}", self.statistic.about(), self.name);
        let (sampled, samples) = match self.record_times() {
            Some(_) => (
                "at the samples of the record".to_owned(),
                "record".to_owned(),
            ),
            None => (
                format!("of {SAMPLES_IN_WINDOW} samples and one"),
                (SAMPLES_IN_WINDOW + 1).to_string(),
            ),
        };
        Description {
            about: format!("{about}, {sampled}"),
            options: BTreeMap::from_iter(self.times.options().into_iter().chain([
                option("solver", Solver::Auto.name().to_owned()),
                option("tolerance", format!("{TOLERANCE:?}")),
                option("samples", samples),
            ])),
            columns: vec![Column::new(&asked, &self.unit, about)],
            drawn: vec![asked.clone()],
            quantity: self.name.clone(),
            name: asked,
        }
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(self)
    }
}

impl Worker for &OverTime<'_> {
    fn measure(&mut self, settings: &[(&str, f64)], out: &mut [f64]) -> Result<(), Failure> {
        let instance = self.model.with_parameters(settings)?;
        let (times, first) = self.sample_times(&instance)?;
        let start = self.conditions.start_at(&instance, settings)?;
        let request = Request {
            initial: &start.state,
            times: &times,
            inputs: &start.inputs,
            solver: Solver::Auto,
            tolerance: TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        };
        let motion = finished_motion(instance.simulate_until_stop(&request, &mut |_| {}))?;
        let course = self.values_over_time(&instance, &motion)?;
        let (times, course) = (&times[first..], &course[first..]);
        out[0] = match self.statistic {
            Statistic::Maximum => greatest(course),
            Statistic::RootMeanSquare => root_mean_square(times, course),
            Statistic::Final => course.last().copied(),
        }
        .ok_or(Failure::Undefined)?;
        Ok(())
    }
}
