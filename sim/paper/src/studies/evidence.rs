//! Evidence for a claim, as text.

use super::claims::Rule;
use super::reading::{CaseKey, Reading};

/// Formats the readings that decide a rule.
pub(super) fn format_evidence(rule: Rule, keys: &[CaseKey], found: &[&Reading]) -> String {
    let cases: Vec<(&CaseKey, &&Reading)> = keys.iter().zip(found).collect();
    let each = |say: &dyn Fn(&CaseKey, &Reading) -> String| -> String {
        let parts: Vec<String> = cases
            .iter()
            .map(|(key, reading)| say(key, reading))
            .collect();
        parts.join("; ")
    };
    match rule {
        Rule::Regular(_) | Rule::Chaotic(_) | Rule::FlexibilityMatters => {
            let parts = cases.iter().map(|(key, reading)| match cases.len() {
                1 => reading.sentence.clone(),
                _ => format!("{key}: {}", reading.sentence),
            });
            parts.collect::<Vec<_>>().join(" ")
        }
        Rule::Route(_) | Rule::FrequencyMatters => {
            each(&|key, reading| format!("{key}: {}", format_kind(reading)))
        }
        Rule::ErrorGrows(_) => each(&|key, reading| {
            let printed = 1e3 * reading.f_la.largest;
            let signed = 1e3 * reading.f_la_signed.largest;
            let b = key.micrometres;
            format!("b = {b}: |f_la| <= {printed:.3} mm, |dr - l dtheta| <= {signed:.3} mm")
        }),
        Rule::DeflectionDominates(_)
        | Rule::TransmissionDominates(_)
        | Rule::ShareGrows(_)
        | Rule::DeflectionSteady(_) => each(&format_components),
        Rule::DominantMode(..) | Rule::ModeChanges(_) => each(&format_modes),
        Rule::OrderSuffices => each(&|key, reading| {
            let (span, rms) = (1e3 * reading.dr.span, 1e3 * reading.dr.rms);
            format!(
                "S = {}: dr {span:.4} mm peak to peak, rms {rms:.4}",
                key.order
            )
        }),
    }
}

fn format_kind(reading: &Reading) -> &str {
    // The verdict precedes the first colon.
    reading.sentence.split(':').next().unwrap_or_default()
}

fn format_components(key: &CaseKey, reading: &Reading) -> String {
    let (t, d) = (&reading.transmission, &reading.dr);
    format!(
        "b = {}: l dtheta {:.3} mm peak to peak, rms {:.4}; dr {:.3} mm, rms {:.4}",
        key.micrometres,
        1e3 * t.span,
        1e3 * t.rms,
        1e3 * d.span,
        1e3 * d.rms
    )
}

/// Formats the share of each mode in the vibration.
fn format_modes(key: &CaseKey, reading: &Reading) -> String {
    let sum: f64 = reading.vibration.iter().sum();
    let shares: Vec<String> = reading
        .vibration
        .iter()
        .map(|power| format!("{:.1}", 100.0 * power / sum))
        .collect();
    let rms = 1e6 * sum.sqrt();
    format!(
        "b = {}: modes 1.. have {} % of a vibration of {rms:.1} um rms",
        key.micrometres,
        shares.join(", ")
    )
}
