//! Description of the residual force in words: equation, form and explained fraction.

use crate::residual_force::equations::Equation;
use crate::residual_force::types::{ForceKind, Profile, ResidualForce, SimpleFunction, SimpleTerm};
use crate::thresholds;

/// Relative rounding error of a frequency.
const RELATIVE_ROUNDING: f64 = 1e-9;

/// Describes the residual force of the original model in one or two sentences.
pub fn describe_residual_force(force: &ResidualForce) -> String {
    let Some(kind) = &force.kind else {
        return "No force in a single equation is significant.".to_owned();
    };
    let equation = &force.equations[force.best_equation];
    let mut text = format!(
        "The residual is best explained by a force on {}: {}; it explains {:.0} % of the squares.",
        equation.name,
        describe_shape(force, kind),
        100.0 * force.explained_fraction
    );
    let own = |ranking: &crate::residual_force::types::RankedEquation| match kind {
        ForceKind::Time => ranking.fraction_by_time,
        ForceKind::Rate(_) | ForceKind::Position(_) => ranking.fraction_by_state,
    };
    let others = force
        .ranking
        .iter()
        .filter(|r| r.equation != force.best_equation);
    let as_well =
        others.filter(|r| own(r) > thresholds::MIN_FRACTION_OF_BEST * force.explained_fraction);
    let names: Vec<&str> = as_well
        .map(|r| force.equations[r.equation].name.as_str())
        .collect();
    if !names.is_empty() {
        text += &format!(
            " A force on {} explains nearly as much.",
            names.join(" or ")
        );
    }
    text
}

/// Describes the residual force of the extended model.
pub fn describe_remaining_force(force: &ResidualForce) -> String {
    match &force.kind {
        None => "With the found effects in the model, no force is significant.".to_owned(),
        Some(_) => describe_residual_force(force).replacen(
            "The residual is best explained",
            "The remaining residual is best explained",
            1,
        ),
    }
}

fn describe_shape(force: &ResidualForce, kind: &ForceKind) -> String {
    let equation = &force.equations[force.best_equation];
    match kind {
        ForceKind::Rate(parts) if parts.is_empty() => describe_range(force, &force.rate, true),
        ForceKind::Position(parts) if parts.is_empty() => {
            describe_range(force, &force.position, false)
        }
        ForceKind::Rate(parts) => describe_simple_functions(parts, equation, true),
        ForceKind::Position(parts) => describe_simple_functions(parts, equation, false),
        ForceKind::Time => {
            let frequencies = &force.frequency;
            let is_looked_at = force.best_equation == force.equation;
            let (rate, place) = name_rate_and_position(equation);
            let text = format!("it is a function of neither the {rate} nor the {place}");
            match frequencies.peak {
                Some(peak)
                    if is_looked_at
                        && frequencies.explained_fraction > 0.5 * force.explained_fraction =>
                {
                    match is_resolved(frequencies, peak) {
                        true => format!(
                            "{text}, most of it near {} Hz",
                            format_frequency(frequencies.arguments[peak], frequencies.arguments[0])
                        ),
                        false => {
                            format!("{text}, mostly at frequencies below three periods per window")
                        }
                    }
                }
                _ => text,
            }
        }
    }
}

/// Formats a frequency with the digits that a resolution justifies. The amplitude at the frequency
/// is not reported: the initial states of windows imitate a part of the motion, so that the profile
/// does not contain it.
fn format_frequency(frequency: f64, resolution: f64) -> String {
    let decimals = (-resolution.log10()).ceil().max(0.0) as usize;
    format!("{frequency:.decimals$}")
}

/// Returns true if a wave of a frequency profile has enough periods in a window to be distinguished
/// from a drift. The first wave of the profile has one period per window.
fn is_resolved(frequencies: &Profile, peak: usize) -> bool {
    let least = thresholds::FIRST_SPECTRAL_LINE as f64 * frequencies.arguments[0];
    frequencies.arguments[peak] > (1.0 - RELATIVE_ROUNDING) * least
}

/// Returns the words for rate and position of an equation.
fn name_rate_and_position(equation: &Equation) -> (&'static str, &'static str) {
    match equation.unit {
        "rad" => ("rate", "angle"),
        _ => ("speed", "position"),
    }
}

fn describe_simple_functions(parts: &[SimpleTerm], equation: &Equation, is_rate: bool) -> String {
    let (rate, position) = name_rate_and_position(equation);
    let of = if is_rate { rate } else { position };
    let force = equation.force_unit();
    let by = match (is_rate, equation.unit) {
        (true, "rad") => "s/rad",
        (true, _) => "s/m",
        (false, "rad") => "1/rad",
        (false, _) => "1/m",
    };
    // `N m` per `1/rad` would be printed as `N m 1/rad`.
    let unit = match by.strip_prefix("1/") {
        Some(below) => format!("{force}/{below}"),
        None => format!("{force} {by}"),
    };
    let squared = match equation.unit {
        "rad" => format!("{force} s^2/rad^2"),
        _ => format!("{force} s^2/m^2"),
    };
    let along = |value: f64| if value < 0.0 { "against" } else { "with" };
    let texts = parts.iter().map(|part| {
        let SimpleTerm {
            function,
            value,
            sd,
        } = part;
        let number = |unit: &str| {
            format!(
                "{} ± {}",
                format_two_digits(value.abs()),
                format_with_unit(*sd, unit)
            )
        };
        match function {
            SimpleFunction::Constant => {
                format!(
                    "a constant {} ± {}",
                    format_two_digits(*value),
                    format_with_unit(*sd, force)
                )
            }
            SimpleFunction::Sign => {
                format!("{} {} the sign of the {of}", number(force), along(*value))
            }
            SimpleFunction::Linear => format!("{} {} the {of}", number(&unit), along(*value)),
            SimpleFunction::Absolute => format!(
                "{} times the magnitude of the {of}, {}",
                number(&unit),
                if *value < 0.0 {
                    "in the negative direction"
                } else {
                    "in the positive direction"
                }
            ),
            SimpleFunction::SignedSquare => format!(
                "{} {} the signed square of the {of}",
                number(&squared),
                along(*value)
            ),
        }
    });
    texts.collect::<Vec<String>>().join(" and ")
}

/// Describes the lowest and the highest value of a profile among those with a small standard
/// deviation.
fn describe_range(force: &ResidualForce, profile: &Profile, is_rate: bool) -> String {
    let equation = &force.equations[force.best_equation];
    let (rate, position) = name_rate_and_position(equation);
    let (of, unit) = match is_rate {
        true => (rate, equation.rate_unit()),
        false => (position, equation.unit),
    };
    let is_known =
        |k: &usize| profile.sd[*k] > 0.0 && profile.values[*k].abs() > 2.0 * profile.sd[*k];
    let known: Vec<usize> = (0..profile.values.len()).filter(is_known).collect();
    let order = |a: &&usize, b: &&usize| profile.values[**a].total_cmp(&profile.values[**b]);
    let (low, high) = (known.iter().min_by(order), known.iter().max_by(order));
    match (low, high) {
        // The two knots at zero rate have the same argument.
        (Some(low), Some(high))
            if profile.arguments[*low] != profile.arguments[*high]
                && force.best_equation == force.equation =>
        {
            format!(
                "it changes with the {of}, from {} at {} to {} at {}",
                format_with_unit(profile.values[*low], equation.force_unit()),
                format_with_unit(profile.arguments[*low], unit),
                format_with_unit(profile.values[*high], equation.force_unit()),
                format_with_unit(profile.arguments[*high], unit)
            )
        }
        _ => format!("it changes with the {of}"),
    }
}

fn format_with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", format_two_digits(value))
}

/// Formats a number with two significant digits.
fn format_two_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    let digits = 1 - value.abs().log10().floor() as i32;
    if (-3..=5).contains(&digits) {
        format!("{value:.*}", digits.max(0) as usize)
    } else {
        format!("{value:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::is_resolved;
    use crate::residual_force::types::Profile;

    #[test]
    fn waves_of_less_than_three_periods_per_window_are_not_resolved() {
        // Windows of 0.7 s.
        let frequencies = Profile {
            arguments: [1.0, 2.0, 3.0, 4.0, 6.4]
                .map(|periods| periods / 0.7)
                .to_vec(),
            ..Profile::default()
        };
        let resolved = [0, 1, 2, 3, 4].map(|wave| is_resolved(&frequencies, wave));
        assert_eq!(resolved, [false, false, true, true, true]);
    }
}
