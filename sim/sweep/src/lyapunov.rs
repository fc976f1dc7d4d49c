//! The measure `lyapunov`: how fast neighbouring motions part, with tangent vectors that are
//! carried exactly. The numbers themselves come from [`eomgen_sim::piecewise_linear`].

use std::collections::BTreeMap;

use super::error::SweepError;
use super::forcing::{Frequency, frequency};
use super::measure::{Column, Description, Failure, Measure, Worker};
use super::span::Span;
use eomgen_analysis::exponent::{FEWEST, mean_exponent};
use eomgen_compiled_model::CompiledModel;
use eomgen_sim::piecewise_linear::{ExactError, Lyapunov as Request};

/// Measures a model at many parameter values that are linear between their switches.
pub struct Lyapunov<'a> {
    model: &'a CompiledModel,
    frequency: Frequency,
    span: Span,
}

impl<'a> Lyapunov<'a> {
    /// Measures over `span`, once per forcing period; `forcing` names the parameter that
    /// is the angular frequency of the forcing.
    ///
    /// # Errors
    /// A model that is not linear between its switches or has no such parameter, a span that
    /// makes no sense.
    pub fn new(model: &'a CompiledModel, forcing: &str, span: Span) -> Result<Self, SweepError> {
        span.check("lyapunov", FEWEST)?;
        if let Err(error) = model.piecewise_linear() {
            return Err(SweepError::Request(refusal(error)));
        }
        Ok(Self {
            frequency: frequency(model.model(), forcing)?,
            model,
            span,
        })
    }
}

/// Why there are no exponents.
fn refusal(error: &ExactError) -> String {
    match error {
        ExactError::NotLinear { formula } => format!(
            "--measure lyapunov: the model is not linear between its switches: `{formula}`; \
             exponents are measured only where tangent vectors can be carried exactly"
        ),
        other => format!("--measure lyapunov: {other}"),
    }
}

impl Measure for Lyapunov<'_> {
    fn describe(&self) -> Description {
        let option = |name: &str, value: String| (name.to_owned(), value);
        let column = |(name, unit, about): (&str, &str, &str)| Column::new(name, unit, about);
        Description {
            name: "lyapunov".to_owned(),
            about: "largest Lyapunov exponent of the motion from the specification's initial \
                    state, by one tangent vector carried exactly and measured once per forcing \
                    period"
                .to_owned(),
            options: BTreeMap::from([
                option("frequency", self.frequency.name().to_owned()),
                option("transient", self.span.transient.to_string()),
                option("periods", self.span.periods.to_string()),
            ]),
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
        }
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(self)
    }
}

impl Worker for &Lyapunov<'_> {
    fn measure(&mut self, settings: &[(&str, f64)], out: &mut [f64]) -> Result<(), Failure> {
        let instance = self.model.with(settings)?;
        let period = self.frequency.period(&instance)?;
        let request = Request {
            transient: self.span.transient as f64 * period,
            interval: period,
            intervals: self.span.periods,
            exponents: 1,
        };
        let mut propagator = instance.propagator()?;
        let inputs = instance.no_inputs();
        let growth = propagator.lyapunov(instance.initial(), 0.0, &inputs, &request)?;
        let first = growth.growths.first().ok_or(Failure::Undefined)?;
        let exponent = mean_exponent(first, period).map_err(|_| Failure::Undefined)?;
        let whole = (self.span.transient + self.span.periods) as f64 * period;
        let rate = growth.switches as f64 / whole;
        let numbers = [exponent.value, exponent.standard_error, rate];
        for (place, number) in out.iter_mut().zip(numbers) {
            *place = number;
        }
        Ok(())
    }
}
