//! Inputs and other functions of time that have no finite value at a time of the motion.

use eomgen_model_spec::evaluate::evaluate_at_time;
use eomgen_model_spec::ids::DefinitionId;
use eomgen_model_spec::model::{ExprKind, Model};
use eomgen_sim::inputs::HeldInputs;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::CompiledModel;

/// Distances after the end of a motion at which functions are tested, relative to the time. A solver fails at trial
/// steps, which are later than the end.
const DISTANCES_AFTER: [f64; 5] = [0.0, 1e-15, 1e-13, 1e-11, 1e-9];

/// Distances before the end of a motion at which functions are tested for a pole, relative to the simulated time.
const DISTANCES_BEFORE: [f64; 3] = [1e-9, 1e-7, 1e-5];

/// Smallest growth of a function towards a pole from one of [`DISTANCES_BEFORE`] to the next smaller one. A pole of
/// order 1/2 gives 10.
const MIN_POLE_GROWTH: f64 = 5.0;

/// Distances after the end of a motion for second differences, which show an infinite second derivative. They are
/// relative to the simulated time, or to [`UNIT_TIME`] at the start.
const DIFFERENCE_STEPS: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// Reference time for a motion that ends at its start, s.
const UNIT_TIME: f64 = 1.0;

impl Instance<'_> {
    /// Rejects inputs that are held at infinity or NaN during the simulated time span, in s.
    pub(crate) fn check_held_inputs(
        &self,
        inputs: &HeldInputs,
        (begin, end): (f64, f64),
    ) -> Result<(), Error> {
        let Some((t, place, value)) = inputs.first_not_finite(begin, end) else {
            return Ok(());
        };
        // A sample before the span gives the value at its start.
        let t = t.max(begin);
        let known = self.model().model().inputs.get(place);
        let name = known.map_or("", |input| &input.name);
        Err(Error::Request(format!(
            "the input `{name}` is {} from t = {t:?} s on: correct the expression or the record, or simulate \
             another time span",
            describe(value)
        )))
    }
}

/// Returns the message for a definition that depends on time only, such as an input given by an expression, and that is
/// not finite where the motion ended. `begin` and the end are times in s. `parameters` are all parameters of the
/// specification, SI.
pub(crate) fn find_infinite_function(
    model: &CompiledModel,
    parameters: &[f64],
    (begin, end): (f64, f64),
) -> Option<String> {
    let model = model.model();
    let definitions = model.definition_order.iter();
    let functions = definitions
        .map(|index| (index, &model.definitions[*index]))
        .filter(|(_, definition)| model.is_function_of_time(&definition.value));
    let cure = "write an expression that is finite at all times, such as 1/max(t, 0.001) for 1/t, or simulate \
                another time span";
    for (index, definition) in functions {
        let name = &definition.name;
        let value = |t| evaluate_at_time(model, &definition.value, parameters, t);
        let (span, size) = (end - begin, end.abs().max(end - begin));
        let after = DISTANCES_AFTER.map(|distance| value(end + distance * size));
        if let Some(at) = after.iter().position(|value| !value.is_finite()) {
            let (kind, when) = (describe(after[at]), if at == 0 { "at" } else { "after" });
            return Some(format!(
                "the function of time `{name}` is {kind} {when} t = {end:?} s: {cure}"
            ));
        }
        let before = DISTANCES_BEFORE.map(|distance| value(end - distance * span).abs());
        if before
            .windows(2)
            .all(|pair| pair[0] > MIN_POLE_GROWTH * pair[1])
        {
            return Some(format!(
                "the function of time `{name}` becomes infinite near t = {end:.9} s: {cure}"
            ));
        }
        let unit = if span > 0.0 { span } else { UNIT_TIME };
        if has_rate_in_motion(model, *index) && has_infinite_rate(&value, end, unit) {
            return Some(format!(
                "the rate or the second derivative of `{name}` is infinite at t = {end:.9} s, but the motion of the \
                 machine depends on them: write a motion with finite derivatives, or simulate another time span"
            ));
        }
    }
    None
}

/// Returns true if the motion depends on the rate of a definition.
fn has_rate_in_motion(model: &Model, definition: DefinitionId) -> bool {
    let mut has_rate = false;
    for expression in model.motion_expressions() {
        expression.visit(&mut |part| {
            if let ExprKind::Dot(operand) = &part.kind {
                has_rate |= matches!(operand.kind, ExprKind::Definition(id) if id == definition);
            }
        });
    }
    has_rate
}

/// Returns true if the second differences of a function grow beyond all bounds towards a time from either side.
fn has_infinite_rate(value: &impl Fn(f64) -> f64, t: f64, unit: f64) -> bool {
    [1.0, -1.0].into_iter().any(|side| {
        let differences = DIFFERENCE_STEPS.map(|step| {
            let step = side * step * unit;
            ((value(t + 2.0 * step) - 2.0 * value(t + step) + value(t)) / (step * step)).abs()
        });
        let mut pairs = differences.windows(2);
        pairs.all(|pair| pair[0] > MIN_POLE_GROWTH * pair[1])
    })
}

fn describe(value: f64) -> &'static str {
    match value.is_nan() {
        true => "not a number (NaN)",
        false => "infinite",
    }
}
