//! Measure `lyapunov`: growth rate of the distance between neighbouring motions. For a model that
//! is linear between its switches, [`eomgen_sim::piecewise_linear`] propagates the tangent vector
//! exactly. Other models use the variational equation, [`eomgen_sim::variational`].

use eomgen_model_spec::argument::Argument;
use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::conditions::{Conditions, Start};
use crate::error::SweepError;
use crate::measure::{Column, Description, Failure, Measure, Worker};
use crate::window::{Times, Window, reject_controllers};
use eomgen_analysis::exponent::{MIN_GROWTHS, mean_exponent};
use eomgen_compiled_model::{CompiledModel, DrivenModel, Instance};
use eomgen_sim::ode::Settings;
use eomgen_sim::piecewise_linear::LyapunovRequest as Request;
use eomgen_sim::variational::{GrowthMeasurements, MeasurementTimes, measure_growth};

const TOLERANCE: f64 = 1e-9;

/// Lyapunov exponent of a model at many parameter values.
pub struct Lyapunov<'a> {
    model: &'a CompiledModel,
    conditions: &'a Conditions,
    times: Times,
}

impl<'a> Lyapunov<'a> {
    /// Creates the measure. Growth is measured once per forcing period, or over the second half of a time.
    ///
    /// # Errors
    /// An invalid window, or a model that cannot be differentiated.
    pub fn new(
        model: &'a CompiledModel,
        conditions: &'a Conditions,
        window: &Window,
    ) -> Result<Self, SweepError> {
        let known = (model.model(), conditions);
        let times = Times::from_window(known, window, "lyapunov", MIN_GROWTHS)?;
        reject_controllers(model, "lyapunov")?;
        let measure_name = Argument::Measure.with_text("lyapunov");
        if let Some(constraint) = model.model().constraints.first() {
            return Err(SweepError::Request(format!(
                "{measure_name}: the model has constraints (`{}`), which this measure does not \
                 support yet",
                constraint.name
            )));
        }
        if let Some(impact) = model.model().impacts.first() {
            return Err(SweepError::Request(format!(
                "{measure_name}: the model has impacts (`{}`), which this measure does not \
                 support yet",
                impact.name
            )));
        }
        if let Some(surface) = model.first_corner() {
            return Err(SweepError::Request(format!(
                "{measure_name}: the energies of the model jump where `{surface}` is zero, and the \
                 rates with them, which this measure does not support yet"
            )));
        }
        let measure = Self {
            model,
            conditions,
            times,
        };
        if !measure.is_exact() {
            let refused = |error| SweepError::Request(format!("{measure_name}: {error}"));
            model.differentiate().map_err(refused)?;
        }
        Ok(measure)
    }

    fn is_exact(&self) -> bool {
        self.model.piecewise_linear().is_ok() && !self.conditions.are_time_varying()
    }

    fn method_and_options(&self) -> (&'static str, Vec<(String, String)>) {
        if self.is_exact() {
            return ("carried exactly", Vec::new());
        }
        let options = [
            ("solver", "rk".to_owned()),
            ("tolerance", format!("{TOLERANCE:?}")),
        ];
        let options = options.map(|(name, value)| (name.to_owned(), value));
        ("that satisfies the variational equation", options.to_vec())
    }
}

impl Measure for Lyapunov<'_> {
    fn describe(&self) -> Vec<Description> {
        let column = |(name, unit, about): (&str, &str, &str)| Column::new(name, unit, about);
        let (how, options) = self.method_and_options();
        let when = match self.times {
            Times::Until(_) => "over the second half of the time",
            Times::Periods(..) => "once per forcing period",
        };
        vec![Description {
            name: "lyapunov".to_owned(),
            about: format!(
                "largest Lyapunov exponent of the motion from the specification's initial state, by \
                 one tangent vector {how} and measured {when}"
            ),
            options: BTreeMap::from_iter(self.times.options().into_iter().chain(options)),
            columns: [
                ("lambda_1", "1/s", "largest Lyapunov exponent"),
                (
                    "lambda_1_se",
                    "1/s",
                    "standard error of lambda_1, by batch means",
                ),
                (
                    "switch_rate",
                    "1/s",
                    "switches per second, transient included",
                ),
            ]
            .map(column)
            .to_vec(),
            drawn: vec!["lambda_1".to_owned()],
            quantity: "lambda_1".to_owned(),
        }]
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(self)
    }
}

impl Worker for &Lyapunov<'_> {
    fn measure(
        &mut self,
        settings: &[(&str, f64)],
        out: &mut [f64],
        check: &dyn Fn(),
    ) -> Result<(), Failure> {
        let instance = self.model.with_parameters(settings)?;
        let stretches = self
            .times
            .list_growth_intervals(&instance, self.conditions)?;
        let start = self.conditions.start_at(&instance, settings)?;
        let GrowthMeasurements {
            growth_exponents: growths,
            switches,
        } = match self.is_exact() {
            true => exact_growth(&instance, &start, &stretches, check)?,
            false => variational_growth(&instance, &start, &stretches, check)?,
        };
        let exponent =
            mean_exponent(&growths, stretches.interval).map_err(|_| Failure::Undefined)?;
        let whole = stretches.transient + stretches.intervals as f64 * stretches.interval;
        let rate = switches as f64 / whole;
        let numbers = [exponent.value, exponent.standard_error, rate];
        for (place, number) in out.iter_mut().zip(numbers) {
            *place = number;
        }
        Ok(())
    }
}

fn exact_growth(
    instance: &Instance<'_>,
    start: &Start,
    stretches: &MeasurementTimes,
    check: &dyn Fn(),
) -> Result<GrowthMeasurements, Failure> {
    let request = Request {
        transient: stretches.transient,
        interval: stretches.interval,
        interval_count: stretches.intervals,
        exponent_count: 1,
    };
    let mut propagator = instance.propagator()?;
    let begin = (stretches.start, &start.state[..]);
    let growth = propagator.measure_lyapunov(begin, &start.inputs, &request, check)?;
    Ok(GrowthMeasurements {
        growth_exponents: growth
            .growth_exponents
            .into_iter()
            .next()
            .ok_or(Failure::Undefined)?,
        switches: growth.switches,
    })
}

fn variational_growth(
    instance: &Instance<'_>,
    start: &Start,
    stretches: &MeasurementTimes,
    check: &dyn Fn(),
) -> Result<GrowthMeasurements, Failure> {
    let evaluator = RefCell::new(instance.evaluator()?);
    let system = DrivenModel::new(&evaluator, &start.inputs)
        .with_typical_sizes(instance.model().typical_sizes())
        .with_sides(instance.sided_model()?, TOLERANCE)
        .without_holding()
        .with_jacobian(instance.jacobian_evaluator()?);
    let (felt, settings) = (
        instance.influential_states()?,
        Settings::with_tolerance(TOLERANCE),
    );
    Ok(measure_growth(
        &system,
        &start.state,
        &felt,
        (stretches, check),
        &settings,
    )?)
}
