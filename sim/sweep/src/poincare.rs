//! The measure `poincare`: the first coordinate seen once per forcing period. Where the model
//! is linear between its switches the motion is exact, elsewhere it is the general solver's.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::error::SweepError;
use super::forcing::{Frequency, frequency};
use super::measure::{Column, Description, Failure, Measure, Worker};
use super::span::Span;
use eomgen_analysis::poincare::{LONGEST_PERIOD, Section};
use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_sim::ode::{Settings, Trajectory, simulate};

/// Looks at the motion per forcing period: one belongs to the section, all together give the
/// extent of the motion.
const LOOKS: usize = 8;

/// Points of the section are equal within this share of the extent of the motion.
const EQUAL: f64 = 1e-3;

/// The most points of the section that become columns.
pub const MOST_POINTS_KEPT: usize = 1000;

/// Measures a model at many parameter values.
pub struct Poincare<'a> {
    model: &'a CompiledModel,
    frequency: Frequency,
    coordinate: String,
    unit: String,
    span: Span,
    keep_points: bool,
    settings: Settings,
}

impl<'a> Poincare<'a> {
    /// Measures over `span`; `forcing` names the parameter that is the angular frequency
    /// of the forcing. With `keep_points` the points themselves become columns: the
    /// bifurcation diagram.
    ///
    /// # Errors
    /// A model without a coordinate or without that parameter, a span that makes no sense.
    pub fn new(
        model: &'a CompiledModel,
        forcing: &str,
        span: Span,
        keep_points: bool,
    ) -> Result<Self, SweepError> {
        let refused = |reason: String| Err(SweepError::Request(reason));
        span.check("poincare", 2)?;
        if keep_points && span.periods > MOST_POINTS_KEPT {
            return refused(format!(
                "--periods {}: at most {MOST_POINTS_KEPT} points become columns",
                span.periods
            ));
        }
        let Some(first) = model.model().coordinates.first() else {
            return refused("the model has no coordinate to look at".to_owned());
        };
        Ok(Self {
            frequency: frequency(model.model(), forcing)?,
            coordinate: first.name.clone(),
            unit: first.unit.to_string(),
            model,
            span,
            keep_points,
            settings: Settings::default(),
        })
    }

    /// What is written, in this order.
    fn columns(&self) -> Vec<Column> {
        let (name, unit) = (&self.coordinate, &self.unit);
        let longest = LONGEST_PERIOD.min(self.span.periods / 2);
        let columns = [
            (
                "period",
                "1",
                format!("period in forcing periods, to {longest}; 0: none"),
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
        let about = format!("{name} on the section, one forcing period after the other");
        let points = self.points().into_iter();
        columns
            .into_iter()
            .map(|(part, unit, about)| Column::new(format!("poincare_{part}"), unit, about))
            .chain(points.map(|point| Column::new(point, unit, &about)))
            .collect()
    }

    /// Names of the columns that hold the points.
    fn points(&self) -> Vec<String> {
        let count = if self.keep_points {
            self.span.periods
        } else {
            0
        };
        (1..=count)
            .map(|point| format!("poincare_{point}"))
            .collect()
    }
}

impl Measure for Poincare<'_> {
    fn describe(&self) -> Description {
        let (name, points) = (&self.coordinate, self.points());
        let option = |name: &str, value: String| (name.to_owned(), value);
        let solver = match self.model.piecewise_linear() {
            Ok(_) => vec![option("solver", "exact".to_owned())],
            Err(_) => vec![
                option("solver", "rk".to_owned()),
                option("tolerance", format!("{:?}", self.settings.tolerance)),
            ],
        };
        let (drawn, quantity) = if points.is_empty() {
            (vec!["poincare_period".to_owned()], "period".to_owned())
        } else {
            (points, name.clone())
        };
        Description {
            name: "poincare".to_owned(),
            about: format!(
                "{name} at t = k 2 pi/{}, k the whole numbers after the transient; period and \
                 clusters also of its rate, points being equal within {EQUAL} of the extent of \
                 the motion",
                self.frequency.name()
            ),
            options: BTreeMap::from_iter(solver.into_iter().chain([
                option("frequency", self.frequency.name().to_owned()),
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
        let times = self.times(self.frequency.period(&instance)?);
        let motion = self.motion(&instance, &times)?;
        let rate = instance.initial().len() / 2;
        let seen: Vec<[f64; 2]> = motion.states.iter().map(|y| [y[0], y[rate]]).collect();
        let numbers = statistics(&seen).ok_or(Failure::Undefined)?;
        let points = on_section(&seen).map(|[x, _]| x);
        let numbers = numbers.into_iter().chain(points);
        for (place, number) in out.iter_mut().zip(numbers) {
            *place = number;
        }
        Ok(())
    }
}

impl Poincare<'_> {
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

/// Those of the looks that belong to the section.
fn on_section(seen: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> {
    seen.iter().step_by(LOOKS).copied()
}

/// Period, clusters, mean, least, greatest and root mean square.
fn statistics(seen: &[[f64; 2]]) -> Option<[f64; 6]> {
    let points: Vec<f64> = on_section(seen).flatten().collect();
    let extents = [extent(seen, 0), extent(seen, 1)];
    let section = Section {
        points: &points,
        scale: &extents,
    };
    // At rest there is no extent to compare with, and nothing to compare.
    let at_rest = extents.contains(&0.0);
    let (period, clusters) = if at_rest {
        (Some(1), Some(1))
    } else {
        let shape = section.shape(EQUAL).ok()?;
        (shape.period, shape.clusters)
    };
    let values = || on_section(seen).map(|[x, _]| x);
    let count = values().count() as f64;
    Some([
        period.unwrap_or(0) as f64,
        clusters.unwrap_or(0) as f64,
        values().sum::<f64>() / count,
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
        (values().map(|x| x * x).sum::<f64>() / count).sqrt(),
    ])
}

/// Greatest less least.
fn extent(seen: &[[f64; 2]], place: usize) -> f64 {
    let values = || seen.iter().map(|pair| pair[place]);
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The looks at x = a + b cos(t) + c cos(t/2) at the phases of cos(t), over `periods`.
    fn seen(periods: usize, [a, b, c]: [f64; 3]) -> Vec<[f64; 2]> {
        let look = |look: usize| {
            let t = std::f64::consts::TAU * look as f64 / LOOKS as f64;
            [
                a + b * t.cos() + c * (t / 2.0).cos(),
                -b * t.sin() - c / 2.0 * (t / 2.0).sin(),
            ]
        };
        (0..periods * LOOKS).map(look).collect()
    }

    fn close(found: f64, expected: f64) {
        // Rounding of a few dozen terms of order 10.
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }

    #[test]
    fn a_motion_of_half_the_forcing_frequency_has_two_points() {
        // On the section x = a + b + c and a + b - c in turn.
        let [period, clusters, mean, min, max, rms] =
            statistics(&seen(10, [3.0, 4.0, 1.0])).expect("numbers");
        assert_eq!((period, clusters), (2.0, 2.0));
        close(mean, 7.0);
        close(min, 6.0);
        close(max, 8.0);
        close(rms, 50.0_f64.sqrt());
    }

    #[test]
    fn a_motion_of_the_forcing_frequency_has_one_point_and_rest_has_one() {
        let found = statistics(&seen(10, [3.0, 4.0, 0.0])).expect("numbers");
        assert_eq!(found[..2], [1.0, 1.0]);
        close(found[2], 7.0);
        let rest = statistics(&[[2.0, 0.0]; 5 * LOOKS]).expect("numbers");
        assert_eq!(rest, [1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
    }
}
