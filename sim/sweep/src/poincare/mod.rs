//! Measure `poincare`: a coordinate or a rate on a section, once per forcing period or at a
//! `crossing`. `quantity` selects the coordinate, `rotation` removes the drift of rotating
//! machines, `numbers` computes statistics. With forcing, the motion is exact if the model is
//! linear between its switches; otherwise the general solver computes it.

mod crossing;
mod numbers;
mod quantity;
mod rotation;

use eomgen_model_spec::argument::Argument;
use std::cell::RefCell;
use std::collections::BTreeMap;

use self::crossing::{Crossing, find_crossings};
use self::numbers::{
    MAX_RELATIVE_DISTANCE, compute_statistics, create_linear_comparisons, find_repetition,
};
use self::quantity::Quantity;
use self::rotation::{MotionSamples, remove_drift};
use crate::conditions::{Conditions, Start};
use crate::error::SweepError;
use crate::forcing::{Frequency, frequency};
use crate::measure::{Column, Description, Failure, Measure, Worker};
use crate::span::Span;
use crate::window::{check_end, reject_controllers, require_inputs};
use eomgen_analysis::poincare::LONGEST_PERIOD;
use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_sim::ode::{Settings, Trajectory, simulate};

/// Number of samples per forcing period: one is on the section, all are used for the extent of the motion.
const SAMPLES_PER_PERIOD: usize = 8;

/// Maximum number of points that become columns.
pub const MAX_POINTS_KEPT: usize = 1000;

/// Relative accuracy of the states of the exact solver. For the general solver it is ten times the tolerance.
const EXACT_RESOLUTION: f64 = 1e-12;

const NAME: &str = "poincare";

/// Suffix of the column with the number of crossings.
const CROSSINGS: &str = "crossings";

/// Returns the column with the number of crossings of a measure.
pub(crate) fn crossings_column(measure: &str) -> String {
    format!("{measure}_{CROSSINGS}")
}

/// Section of the motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// Once per forcing period; contains the parameter that is the angular frequency.
    Forcing(String),
    /// Crossings of a value by a coordinate or a rate.
    Crossing {
        /// `NAME=VALUE` (upwards), `NAME=VALUE:up` or `NAME=VALUE:down`.
        event: String,
        /// Maximum time of the search for crossings, in s.
        until: f64,
    },
}

enum ResolvedSection {
    Forcing(Frequency),
    Crossing(Crossing, f64),
}

/// Section of a model's motion at many parameter values.
pub struct Poincare<'a> {
    model: &'a CompiledModel,
    conditions: &'a Conditions,
    measure_name: String,
    quantity: Quantity,
    places: ResolvedSection,
    span: Span,
    keep_points: bool,
    settings: Settings,
}

impl<'a> Poincare<'a> {
    /// Creates the measure `measure_name`: `poincare` for the first coordinate, or for example `poincare:theta`. `span` counts
    /// forcing periods or crossings. With `keep_points`, the points become columns of a bifurcation diagram. Returns
    /// `None` for the name of another measure.
    ///
    /// # Errors
    /// A missing coordinate, rate or forcing, an invalid section or an invalid span.
    pub fn new(
        driven: (&'a CompiledModel, &'a Conditions),
        measure_name: &str,
        section: &Section,
        span: Span,
        keep_points: bool,
    ) -> Option<Result<Self, SweepError>> {
        let name = match measure_name.split_once(':') {
            None if measure_name == NAME => None,
            Some((NAME, name)) => Some(name),
            _ => return None,
        };
        Some(Self::build(
            driven,
            (measure_name, name),
            section,
            span,
            keep_points,
        ))
    }

    fn build(
        (model, conditions): (&'a CompiledModel, &'a Conditions),
        (measure_name, name): (&str, Option<&str>),
        section: &Section,
        span: Span,
        keep_points: bool,
    ) -> Result<Self, SweepError> {
        let refused = |reason: String| SweepError::Request(reason);
        reject_controllers(model, measure_name)?;
        span.check(measure_name, 2)?;
        if keep_points && span.periods > MAX_POINTS_KEPT {
            return Err(refused(format!(
                "{}: expected at most {MAX_POINTS_KEPT}, because each point becomes a column",
                Argument::Periods.with_number(span.periods)
            )));
        }
        let states = model.state_names();
        let name = name.or(states.first().map(String::as_str));
        let of_measure = Argument::Measure.with_text(measure_name);
        let name =
            name.ok_or_else(|| refused(format!("{of_measure}: the model has no coordinate")))?;
        let quantity = Quantity::from_name(model, name);
        let places = match section {
            Section::Forcing(parameter) => {
                let known = frequency(model.model(), parameter).map_err(|error| {
                    refused(format!(
                        "{of_measure}: {error}; or give {}, the event of the section",
                        Argument::Section.with_text("NAME=VALUE")
                    ))
                })?;
                ResolvedSection::Forcing(known)
            }
            Section::Crossing { event, until } => ResolvedSection::Crossing(
                Crossing::parse(model, event)?,
                check_end(*until, conditions)?,
            ),
        };
        Ok(Self {
            quantity: quantity.map_err(|reason| refused(format!("{of_measure}: {reason}")))?,
            places,
            measure_name: measure_name.to_owned(),
            model,
            conditions,
            span,
            keep_points,
            settings: Settings::default(),
        })
    }

    fn columns(&self) -> Vec<Column> {
        let Quantity { name, unit, .. } = &self.quantity;
        let longest = LONGEST_PERIOD.min(self.span.periods / 2);
        let (periods, after) = match self.places {
            ResolvedSection::Forcing(_) => ("forcing periods", "in successive forcing periods"),
            ResolvedSection::Crossing(..) => ("returns", "at successive crossings"),
        };
        let columns = [
            (
                "period",
                "1",
                format!("period in {periods}, up to {longest}; 0 if there is none"),
            ),
            (
                "clusters",
                "1",
                format!("number of clusters, up to {LONGEST_PERIOD}; 0 if there are more"),
            ),
            ("mean", unit, format!("mean of {name} on the section")),
            ("min", unit, format!("minimum of {name} on the section")),
            ("max", unit, format!("maximum of {name} on the section")),
            (
                "rms",
                unit,
                format!("root mean square of {name} on the section"),
            ),
        ];
        let time = match self.places {
            ResolvedSection::Forcing(_) => None,
            ResolvedSection::Crossing(..) => Some([
                ("time", "s", "mean time between crossings".to_owned()),
                (
                    CROSSINGS,
                    "1",
                    format!(
                        "number of crossings, up to {}",
                        self.span.transient + self.span.periods
                    ),
                ),
            ]),
        };
        let about = format!("{name} on the section, {after}");
        let points = self.name_point_columns().into_iter();
        columns
            .into_iter()
            .chain(time.into_iter().flatten())
            .map(|(part, unit, about)| Column::new(self.column(part), unit, about))
            .chain(points.map(|point| Column::new(point, unit, &about)))
            .collect()
    }

    fn column(&self, part: &str) -> String {
        format!("{}_{part}", self.measure_name)
    }

    /// Returns the index of the column with the number of crossings; `None` for a section per forcing period.
    fn crossings_index(&self) -> Option<usize> {
        let name = crossings_column(&self.measure_name);
        self.columns().iter().position(|column| column.name == name)
    }

    fn name_point_columns(&self) -> Vec<String> {
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
    fn describe(&self) -> Vec<Description> {
        let (name, points) = (&self.quantity.name, self.name_point_columns());
        let option = |name: &str, value: String| (name.to_owned(), value);
        let general = || {
            vec![
                option("solver", "rk".to_owned()),
                option("tolerance", format!("{:?}", self.settings.tolerance)),
            ]
        };
        let (seen, options) = match &self.places {
            ResolvedSection::Forcing(frequency) => {
                let mut options = match self.is_exact() {
                    true => vec![option("solver", "exact".to_owned())],
                    false => general(),
                };
                options.push(option("frequency", frequency.name().to_owned()));
                let at = format!(
                    "at t = k 2 pi/{} for all integers k after the transient",
                    frequency.name()
                );
                (at, options)
            }
            ResolvedSection::Crossing(crossing, until) => {
                let mut options = general();
                options.push(option("section", crossing.to_string()));
                options.push(option("until", format!("{until:?}")));
                let at = format!("at the crossings of {crossing} after the transient");
                (at, options)
            }
        };
        let (drawn, quantity) = if points.is_empty() {
            (vec![self.column("period")], "period".to_owned())
        } else {
            (points, name.clone())
        };
        vec![Description {
            name: self.measure_name.clone(),
            about: format!(
                "{name} {seen}. Period and clusters are computed from {name} and its {}. Points closer than \
                 {MAX_RELATIVE_DISTANCE} of the extent of the motion count as equal",
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
        }]
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(self)
    }
}

impl Worker for &Poincare<'_> {
    fn measure(
        &mut self,
        settings: &[(&str, f64)],
        out: &mut [f64],
        check: &dyn Fn(),
    ) -> Result<(), Failure> {
        let instance = self.model.with_parameters(settings)?;
        let start = self.conditions.start_at(&instance, settings)?;
        let found = match &self.places {
            ResolvedSection::Forcing(frequency) => {
                self.sample_points_per_period((&instance, &start), frequency, check)
            }
            ResolvedSection::Crossing(crossing, until) => {
                self.find_points_at_crossings((&instance, &start), (crossing, *until), check)
            }
        };
        if let Err(Failure::FewCrossings(count)) = found
            && let Some(place) = self.crossings_index()
        {
            out[place] = count as f64;
        }
        let SectionPoints {
            points,
            repetition,
            time,
        } = found?;
        let crossings = (self.span.transient + self.span.periods) as f64;
        let statistics = compute_statistics(&points).ok_or(Failure::Undefined)?;
        let points = points.iter().map(|[x, _]| *x);
        let numbers = repetition
            .into_iter()
            .chain(statistics)
            .chain(time.into_iter().flat_map(|time| [time, crossings]))
            .chain(points);
        for (place, number) in out.iter_mut().zip(numbers) {
            *place = number;
        }
        Ok(())
    }
}

struct SectionPoints {
    /// Points, without full turns of a rotating angle.
    points: Vec<[f64; 2]>,
    /// Period and number of clusters of the points; 0 if there is none.
    repetition: [f64; 2],
    /// Mean time between crossings, in s.
    time: Option<f64>,
}

impl Poincare<'_> {
    /// Returns true if the motion is solved exactly.
    fn is_exact(&self) -> bool {
        matches!(self.places, ResolvedSection::Forcing(_))
            && self.model.piecewise_linear().is_ok()
            && !self.conditions.are_time_varying()
    }

    fn sample_points_per_period(
        &self,
        (instance, start): (&Instance<'_>, &Start),
        frequency: &Frequency,
        check: &dyn Fn(),
    ) -> Result<SectionPoints, Failure> {
        let times = self.compute_sample_times(frequency.period(instance)?);
        let motion = self.motion((instance, start), &times, check)?;
        let seen: Vec<[f64; 2]> = self.extract_quantity(&motion.states);
        let points = seen.iter().step_by(SAMPLES_PER_PERIOD).copied().collect();
        let looks = MotionSamples {
            start,
            times: &motion.times,
            states: &motion.states,
        };
        self.analyse_points(instance, &looks, (&seen, points), None)
    }

    fn analyse_points(
        &self,
        instance: &Instance<'_>,
        looks: &MotionSamples<'_>,
        (seen, mut points): (&[[f64; 2]], Vec<[f64; 2]>),
        time: Option<f64>,
    ) -> Result<SectionPoints, Failure> {
        let resolution = match self.is_exact() {
            true => EXACT_RESOLUTION,
            false => 10.0 * self.settings.tolerance,
        };
        let mut parts = create_linear_comparisons(seen, resolution);
        let mut found = find_repetition(&points, parts).ok_or(Failure::Undefined)?;
        if found[0] == 0.0 {
            let seen = (seen, &mut points[..]);
            remove_drift(
                (instance, resolution),
                &self.quantity,
                looks,
                seen,
                &mut parts,
            )?;
            found = find_repetition(&points, parts).ok_or(Failure::Undefined)?;
        }
        Ok(SectionPoints {
            points,
            repetition: found,
            time,
        })
    }

    fn find_points_at_crossings(
        &self,
        (instance, start): (&Instance<'_>, &Start),
        (crossing, until): (&Crossing, f64),
        check: &dyn Fn(),
    ) -> Result<SectionPoints, Failure> {
        let wanted = (self.span.transient, self.span.periods);
        let span = (self.conditions.start(), until);
        let found = find_crossings(
            (instance, start),
            crossing,
            wanted,
            span,
            (&self.settings, check),
        )?;
        let (points, between) = (
            self.extract_quantity(&found.points),
            self.extract_quantity(&found.states_between),
        );
        let seen = [&points[..], &between].concat();
        let time = found.times.last().zip(found.times.first());
        let time = time.map(|(last, first)| (last - first) / (found.times.len() - 1) as f64);
        let looks = MotionSamples {
            start,
            times: &found.times,
            states: &found.points,
        };
        self.analyse_points(instance, &looks, (&seen, points), time)
    }

    fn extract_quantity(&self, states: &[Vec<f64>]) -> Vec<[f64; 2]> {
        states
            .iter()
            .map(|state| self.quantity.values_in_state(state))
            .collect()
    }

    fn motion(
        &self,
        (instance, start): (&Instance<'_>, &Start),
        times: &[f64],
        check: &dyn Fn(),
    ) -> Result<Trajectory, Failure> {
        let end = times.last().copied().ok_or(Failure::Undefined)?;
        let span = (self.conditions.start(), end);
        require_inputs(end, self.conditions)?;
        let progress = &mut |_: f64| check();
        let Start { state, inputs } = start;
        if self.is_exact() {
            let mut propagator = instance.propagator()?;
            return Ok(propagator.simulate(state, span, times, inputs, progress)?);
        }
        let evaluator = RefCell::new(instance.evaluator()?);
        let system = instance.driven_model(&evaluator, inputs, self.settings.tolerance)?;
        let (initial, _) = instance.find_consistent_state(state, span.0, inputs)?;
        Ok(simulate(
            &system,
            &initial,
            span,
            times,
            &self.settings,
            progress,
        )?)
    }

    /// Returns the times of all samples in s. Every [`SAMPLES_PER_PERIOD`]th sample, from the first, is on the section.
    fn compute_sample_times(&self, period: f64) -> Vec<f64> {
        let start = self.conditions.start();
        let look = |look: usize| {
            let periods = self.span.transient + look / SAMPLES_PER_PERIOD;
            let share = (look % SAMPLES_PER_PERIOD) as f64 / SAMPLES_PER_PERIOD as f64;
            start + (periods as f64 + share) * period
        };
        (0..self.span.periods * SAMPLES_PER_PERIOD)
            .map(look)
            .collect()
    }
}
