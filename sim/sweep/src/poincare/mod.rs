//! The measure `poincare`: a coordinate or a rate seen on a section, once per forcing period or
//! wherever a `crossing` says so; `quantity` is what is seen, `rotation` takes the drift of turning machines
//! away, `numbers` sum it up. Where the model is linear between its switches the motion over a forcing is
//! exact, elsewhere it is the general solver's.

mod crossing;
mod numbers;
mod quantity;
mod rotation;

use std::cell::RefCell;
use std::collections::BTreeMap;

use self::crossing::{Crossing, crossings};
use self::numbers::{EQUAL, linear_parts, repetition, statistics};
use self::quantity::Quantity;
use self::rotation::{Looks, without_drift};
use crate::error::SweepError;
use crate::forcing::{Frequency, frequency};
use crate::measure::{Column, Description, Failure, Measure, Worker};
use crate::span::Span;
use crate::window::time;
use eomgen_analysis::poincare::LONGEST_PERIOD;
use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_sim::ode::{Settings, Trajectory, simulate};

/// Looks at the motion per forcing period: one belongs to the section, all together give the
/// extent of the motion.
const LOOKS: usize = 8;

/// The most points of the section that become columns.
pub const MOST_POINTS_KEPT: usize = 1000;

/// The exact solver's numbers are right to this part of a state, the general solver's to ten tolerances.
const EXACT_RESOLUTION: f64 = 1e-12;

/// What the measure is called, alone or with `:NAME` behind it.
const NAME: &str = "poincare";

/// Where a motion is seen.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// Once per period of the forcing that has this parameter for its angular frequency.
    Forcing(String),
    /// Where a coordinate or a rate goes through a value.
    Crossing {
        /// `NAME=VALUE`, upwards, or with `:up` or `:down` behind it.
        event: String,
        /// How long crossings are looked for, s.
        until: f64,
    },
}

/// A section with its names looked up.
enum Places {
    Forcing(Frequency),
    Crossing(Crossing, f64),
}

/// Measures a model at many parameter values.
pub struct Poincare<'a> {
    model: &'a CompiledModel,
    /// What it was asked for by.
    asked: String,
    quantity: Quantity,
    places: Places,
    span: Span,
    keep_points: bool,
    settings: Settings,
}

impl<'a> Poincare<'a> {
    /// Measures what `asked` says, `poincare` for the first coordinate or `poincare:theta`, over the
    /// `span`, of forcing periods or of crossings. With `keep_points` the points themselves become
    /// columns: the bifurcation diagram. Nothing if it is no such measure.
    ///
    /// # Errors
    /// A model without that coordinate, rate or forcing, a section or a span that makes no sense.
    pub fn new(
        model: &'a CompiledModel,
        asked: &str,
        section: &Section,
        span: Span,
        keep_points: bool,
    ) -> Option<Result<Self, SweepError>> {
        let name = match asked.split_once(':') {
            None if asked == NAME => None,
            Some((NAME, name)) => Some(name),
            _ => return None,
        };
        Some(Self::of(model, (asked, name), section, span, keep_points))
    }

    fn of(
        model: &'a CompiledModel,
        (asked, name): (&str, Option<&str>),
        section: &Section,
        span: Span,
        keep_points: bool,
    ) -> Result<Self, SweepError> {
        let refused = |reason: String| SweepError::Request(reason);
        span.check(asked, 2)?;
        if keep_points && span.periods > MOST_POINTS_KEPT {
            return Err(refused(format!(
                "--periods {}: at most {MOST_POINTS_KEPT} points become columns",
                span.periods
            )));
        }
        let states = model.state_names();
        let name = name.or(states.first().map(String::as_str));
        let name =
            name.ok_or_else(|| refused("the model has no coordinate to look at".to_owned()))?;
        let quantity = Quantity::of(model, name);
        let places = match section {
            Section::Forcing(parameter) => {
                let known = frequency(model.model(), parameter).map_err(|error| {
                    refused(format!(
                        "--measure {asked}: {error}; or give --section NAME=VALUE, where the motion \
                         is seen"
                    ))
                })?;
                Places::Forcing(known)
            }
            Section::Crossing { event, until } => {
                Places::Crossing(Crossing::parse(model, event)?, time(*until)?)
            }
        };
        Ok(Self {
            quantity: quantity.map_err(|reason| refused(format!("--measure {asked}: {reason}")))?,
            places,
            asked: asked.to_owned(),
            model,
            span,
            keep_points,
            settings: Settings::default(),
        })
    }

    /// What is written, in this order.
    fn columns(&self) -> Vec<Column> {
        let Quantity { name, unit, .. } = &self.quantity;
        let longest = LONGEST_PERIOD.min(self.span.periods / 2);
        let (periods, after) = match self.places {
            Places::Forcing(_) => ("forcing periods", "one forcing period after the other"),
            Places::Crossing(..) => ("returns", "one return after the other"),
        };
        let columns = [
            (
                "period",
                "1",
                format!("period in {periods}, to {longest}; 0: none"),
            ),
            (
                "clusters",
                "1",
                format!("number of clusters, to {LONGEST_PERIOD}; 0: more"),
            ),
            ("mean", unit, format!("mean of {name} on the section")),
            ("min", unit, format!("least {name} on the section")),
            ("max", unit, format!("greatest {name} on the section")),
            (
                "rms",
                unit,
                format!("root mean square of {name} on the section"),
            ),
        ];
        let time = match self.places {
            Places::Forcing(_) => None,
            Places::Crossing(..) => Some(("time", "s", "mean time between crossings".to_owned())),
        };
        let about = format!("{name} on the section, {after}");
        let points = self.points().into_iter();
        columns
            .into_iter()
            .chain(time)
            .map(|(part, unit, about)| Column::new(self.column(part), unit, about))
            .chain(points.map(|point| Column::new(point, unit, &about)))
            .collect()
    }

    /// The name of a column.
    fn column(&self, part: &str) -> String {
        format!("{}_{part}", self.asked)
    }

    /// Names of the columns that hold the points.
    fn points(&self) -> Vec<String> {
        let count = if self.keep_points {
            self.span.periods
        } else {
            0
        };
        (1..=count)
            .map(|point| self.column(&point.to_string()))
            .collect()
    }
}

impl Measure for Poincare<'_> {
    fn describe(&self) -> Description {
        let (name, points) = (&self.quantity.name, self.points());
        let option = |name: &str, value: String| (name.to_owned(), value);
        let general = || {
            vec![
                option("solver", "rk".to_owned()),
                option("tolerance", format!("{:?}", self.settings.tolerance)),
            ]
        };
        let (seen, options) = match &self.places {
            Places::Forcing(frequency) => {
                let mut options = match self.model.piecewise_linear() {
                    Ok(_) => vec![option("solver", "exact".to_owned())],
                    Err(_) => general(),
                };
                options.push(option("frequency", frequency.name().to_owned()));
                let at = format!(
                    "at t = k 2 pi/{}, k the whole numbers after the transient",
                    frequency.name()
                );
                (at, options)
            }
            Places::Crossing(crossing, until) => {
                let mut options = general();
                options.push(option("section", crossing.to_string()));
                options.push(option("until", format!("{until:?}")));
                let at = format!("where {crossing} is crossed, after the transient");
                (at, options)
            }
        };
        let (drawn, quantity) = if points.is_empty() {
            (vec![self.column("period")], "period".to_owned())
        } else {
            (points, name.clone())
        };
        Description {
            name: self.asked.clone(),
            about: format!(
                "{name} {seen}; period and clusters also of its {}, points being equal within {EQUAL} \
                 of the extent of the motion",
                match name.ends_with("_dot") {
                    true => "coordinate",
                    false => "rate",
                }
            ),
            options: BTreeMap::from_iter(options.into_iter().chain([
                option("transient", self.span.transient.to_string()),
                option("periods", self.span.periods.to_string()),
            ])),
            columns: self.columns(),
            drawn,
            quantity,
        }
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(self)
    }
}

impl Worker for &Poincare<'_> {
    fn measure(&mut self, settings: &[(&str, f64)], out: &mut [f64]) -> Result<(), Failure> {
        let instance = self.model.with(settings)?;
        let OnSection {
            points,
            repetition,
            time,
        } = match &self.places {
            Places::Forcing(frequency) => self.once_per_period(&instance, frequency)?,
            Places::Crossing(crossing, until) => self.where_crossed(&instance, crossing, *until)?,
        };
        let statistics = statistics(&points).ok_or(Failure::Undefined)?;
        let points = points.iter().map(|[x, _]| *x);
        let numbers = repetition
            .into_iter()
            .chain(statistics)
            .chain(time)
            .chain(points);
        for (place, number) in out.iter_mut().zip(numbers) {
            *place = number;
        }
        Ok(())
    }
}

/// What is found on a section.
struct OnSection {
    /// The points, without whole turns of an angle that turns.
    points: Vec<[f64; 2]>,
    /// Period and clusters of the points; 0: none.
    repetition: [f64; 2],
    /// The mean time between crossings, s.
    time: Option<f64>,
}

impl Poincare<'_> {
    fn once_per_period(
        &self,
        instance: &Instance<'_>,
        frequency: &Frequency,
    ) -> Result<OnSection, Failure> {
        let times = self.times(frequency.period(instance)?);
        let motion = self.motion(instance, &times)?;
        let seen: Vec<[f64; 2]> = self.seen(&motion.states);
        let points = seen.iter().step_by(LOOKS).copied().collect();
        let looks = Looks {
            times: &motion.times,
            states: &motion.states,
        };
        self.on_section(instance, &looks, (&seen, points), None)
    }

    fn on_section(
        &self,
        instance: &Instance<'_>,
        looks: &Looks<'_>,
        (seen, mut points): (&[[f64; 2]], Vec<[f64; 2]>),
        time: Option<f64>,
    ) -> Result<OnSection, Failure> {
        let is_exact =
            matches!(self.places, Places::Forcing(_)) && self.model.piecewise_linear().is_ok();
        let resolution = match is_exact {
            true => EXACT_RESOLUTION,
            false => 10.0 * self.settings.tolerance,
        };
        let mut parts = linear_parts(seen, resolution);
        let mut found = repetition(&points, parts).ok_or(Failure::Undefined)?;
        if found[0] == 0.0 {
            let seen = (seen, &mut points[..]);
            without_drift(instance, &self.quantity, looks, seen, &mut parts)?;
            found = repetition(&points, parts).ok_or(Failure::Undefined)?;
        }
        Ok(OnSection {
            points,
            repetition: found,
            time,
        })
    }

    fn where_crossed(
        &self,
        instance: &Instance<'_>,
        crossing: &Crossing,
        until: f64,
    ) -> Result<OnSection, Failure> {
        let wanted = (self.span.transient, self.span.periods);
        let found = crossings(instance, crossing, wanted, until, &self.settings)?;
        let (points, between) = (self.seen(&found.points), self.seen(&found.between));
        let seen = [&points[..], &between].concat();
        let time = found.times.last().zip(found.times.first());
        let time = time.map(|(last, first)| (last - first) / (found.times.len() - 1) as f64);
        let looks = Looks {
            times: &found.times,
            states: &found.points,
        };
        self.on_section(instance, &looks, (&seen, points), time)
    }

    fn seen(&self, states: &[Vec<f64>]) -> Vec<[f64; 2]> {
        states
            .iter()
            .map(|state| self.quantity.seen(state))
            .collect()
    }

    /// The states at these times, s.
    fn motion(&self, instance: &Instance<'_>, times: &[f64]) -> Result<Trajectory, Failure> {
        let span = (0.0, times.last().copied().ok_or(Failure::Undefined)?);
        let (initial, quiet) = (instance.initial(), &mut |_: f64| {});
        if self.model.piecewise_linear().is_ok() {
            let mut propagator = instance.propagator()?;
            let inputs = instance.no_inputs();
            return Ok(propagator.simulate(initial, span, times, &inputs, quiet)?);
        }
        let (evaluator, inputs) = (RefCell::new(instance.evaluator()?), instance.no_inputs());
        let system = instance.driven(&evaluator, &inputs)?;
        let (initial, _) = instance.consistent(initial, 0.0, &inputs)?;
        Ok(simulate(
            &system,
            &initial,
            span,
            times,
            &self.settings,
            quiet,
        )?)
    }

    /// The times of all looks, in s; the first and every [`LOOKS`]th belong to the section.
    fn times(&self, period: f64) -> Vec<f64> {
        let look = |look: usize| {
            let periods = self.span.transient + look / LOOKS;
            (periods as f64 + (look % LOOKS) as f64 / LOOKS as f64) * period
        };
        (0..self.span.periods * LOOKS).map(look).collect()
    }
}
