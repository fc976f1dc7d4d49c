//! CSV file of an experiment for a test rig: columns `t` and the driven inputs, in the units of the
//! dataset.

use eomgen_records::experiment::ExperimentUnits;

use crate::experiment::bounds::Bounds;
use crate::experiment::proposal::{Proposal, rest_value};

/// Returns the text of `experiment.csv`.
pub(super) fn write_experiment_csv(
    (bounds, times): (&Bounds, &[f64]),
    proposal: &Proposal,
    names: &[String],
    played: &ExperimentUnits,
) -> String {
    let driven: Vec<usize> = (0..names.len())
        .filter(|index| played.inputs.get(*index).is_some_and(Option::is_some))
        .collect();
    let heading: Vec<&str> = driven.iter().map(|index| names[*index].as_str()).collect();
    let mut text = format!("t,{}\n", heading.join(","));
    for (t, value) in times
        .iter()
        .zip(&proposal.values)
        .step_by(bounds.samples_per_value)
    {
        text += &format!("{}", round_to_twelve_digits(played.time.from_si(*t)));
        for index in &driven {
            let own = match *index == proposal.input_index {
                true => *value,
                false => {
                    let mut others = bounds.inputs.iter();
                    let other = others.find(|other| other.index == *index);
                    other.map_or(0.0, |other| rest_value(other.range))
                }
            };
            let unit = played.inputs[*index].as_ref();
            let own = unit.map_or(own, |unit| unit.from_si(own));
            text += &format!(",{}", round_to_twelve_digits(own));
        }
        text.push('\n');
    }
    text
}

/// Rounds to twelve digits, which removes the rounding errors of time differences.
fn round_to_twelve_digits(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.11e}").parse().unwrap_or(value)
}
