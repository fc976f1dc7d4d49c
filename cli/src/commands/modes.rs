//! `eomgen modes`: natural frequencies, damping ratios and mode shapes at a state.

use std::cmp::Ordering;
use std::collections::HashMap;

use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_compiled_model::CompiledModel;
use serde_json::{Value, json};

use crate::arguments::Modes;
use crate::error::{Result, print_json, print_text};
use crate::mode_figure::figure;
use crate::operating_point::{head, is_equilibrium, model, point, values_by_name};
use crate::output::Destination;
use crate::regime::{Side, note_surfaces, regime, summary};

/// Consequence for a state that is not an equilibrium. The modes depend on the choice of coordinates, because the
/// gradient of the forces does.
const OFF_EQUILIBRIUM: &str =
    "the modes are valid for a short time only, and they depend on the choice of coordinates";

pub fn run(options: &Modes) -> Result {
    let drawing = options.plot.as_deref();
    let drawing = drawing.map(|plot| Destination::for_figure(plot, None, options.output.json));
    let drawing = drawing.transpose()?;
    let compiled = model(&options.model, &options.parameters)?;
    let run = compiled.with_declared_parameters()?;
    let at = point(&run, &options.point.state)?;
    let is_equilibrium = is_equilibrium(&run, &at, OFF_EQUILIBRIUM)?;
    let linear = run.linearise(at.point())?;
    let regime = regime(&run, &at)?;
    if linear.is_one_sided {
        note_surfaces(&regime);
    }
    let modes = run.natural_modes(&linear, at.point())?;
    if let Some(drawing) = &drawing {
        drawing.write(figure(&run, &regime, &modes)?.as_bytes())?;
    }
    if !options.output.json {
        let text = table(&compiled, &modes) + &describe_rigid_motions(&modes) + &sides(&regime);
        return drawing.map_or_else(|| print_text(&text), |drawing| drawing.summarise(&text));
    }
    let mut document = head(&compiled);
    document.insert("at".to_owned(), values_by_name(&compiled, &at));
    document.insert("equilibrium".to_owned(), json!(is_equilibrium));
    let (coordinates, units): (Vec<String>, Vec<String>) =
        compiled.amplitudes().into_iter().unzip();
    document.insert("coordinates".to_owned(), json!(coordinates));
    let units = json!({ "coordinates": units });
    document.insert("units".to_owned(), units);
    let regime = regime.iter().map(Side::json);
    document.insert("regime".to_owned(), regime.collect());
    document.insert("modes".to_owned(), modes.iter().map(record).collect());
    print_json(&Value::Object(document))
}

fn record(mode: &NaturalMode) -> Value {
    let real: Vec<f64> = mode.shape.iter().map(|value| value.re).collect();
    let imaginary: Vec<f64> = mode.shape.iter().map(|value| value.im).collect();
    json!({
        "frequency": mode.frequency(),
        "frequency_limit": mode.frequency_limit(),
        "damping": mode.damping(),
        "eigenvalue": [mode.eigenvalue.re, mode.eigenvalue.im],
        "shape": real,
        "shape_imaginary": imaginary,
    })
}

/// Describes the accuracy to which a frequency is 0.
fn describe_rigid_motions(modes: &[NaturalMode]) -> String {
    let limits = modes.iter().filter_map(NaturalMode::frequency_limit);
    match limits.reduce(f64::max) {
        Some(limit) => format!("frequency 0: below the accuracy of {limit:.1e} Hz\n"),
        None => String::new(),
    }
}

/// Describes the regime of a piecewise model.
fn sides(regime: &[Side]) -> String {
    match regime {
        [] => String::new(),
        sides => format!("regime: {}\n", summary(sides).join(", ")),
    }
}

/// Number of coordinates per mode in the table.
const LISTED: usize = 3;

/// Smallest listed amplitude; smaller ones would be printed as 0.
const MIN_AMPLITUDE: f64 = 5e-5;

/// Largest amplitude that is printed without an exponent.
const MAX_PLAIN_AMPLITUDE: f64 = 1e5;

fn table(compiled: &CompiledModel, modes: &[NaturalMode]) -> String {
    let mut text = "frequency, Hz   damping ratio   shape (its largest coordinates)\n".to_owned();
    let (names, units): (Vec<String>, Vec<String>) = compiled.amplitudes().into_iter().unzip();
    for mode in modes {
        let sizes: Vec<f64> = mode.shape.iter().map(|value| value.norm()).collect();
        let parts: Vec<String> = find_largest_amplitudes(&units, &sizes)
            .into_iter()
            .map(|place| {
                let value = mode.shape[place];
                format_amplitude(
                    &names[place],
                    (value.re, value.im),
                    unit_shown(&units, place),
                )
            })
            .collect();
        // Rounded as printed; adding 0.0 removes the sign of -0.
        let damping = (mode.damping() * 1e6).round() / 1e6 + 0.0;
        let frequency = frequency_in_words(mode.frequency());
        text += &format!("{frequency:<13}   {damping:<13.6}   {}\n", parts.join(", "));
    }
    text
}

/// Formats a frequency for its column.
fn frequency_in_words(frequency: f64) -> String {
    match frequency == 0.0 || (1e-3..1e6).contains(&frequency) {
        true => format!("{frequency:.6}"),
        false => format!("{frequency:.6e}"),
    }
}

/// Returns the indices of the largest amplitudes of a shape, in descending order. Amplitudes in different units are
/// compared relative to the largest amplitude in their unit. At least one amplitude of each unit is listed.
fn find_largest_amplitudes(units: &[String], sizes: &[f64]) -> Vec<usize> {
    let mut most: HashMap<&String, f64> = HashMap::new();
    for (unit, size) in units.iter().zip(sizes) {
        let most = most.entry(unit).or_insert(f64::MIN_POSITIVE);
        *most = most.max(*size);
    }
    let relative: Vec<(f64, f64)> = (units.iter().zip(sizes))
        .map(|(unit, size)| (size / most[unit], *size))
        .collect();
    let moves = |place: &usize| sizes[*place] >= MIN_AMPLITUDE;
    let mut places: Vec<usize> = (0..relative.len()).filter(moves).collect();
    places.sort_by(|a, b| {
        relative[*b]
            .partial_cmp(&relative[*a])
            .unwrap_or(Ordering::Equal)
    });
    places.truncate(LISTED.max(most.len()));
    places
}

/// Returns the unit of an amplitude; `None` if all amplitudes are dimensionless.
fn unit_shown(units: &[String], place: usize) -> Option<&str> {
    let is_dimensional = units.iter().any(|unit| !unit.is_empty());
    is_dimensional.then(|| match &units[place][..] {
        "" => "1",
        unit => unit,
    })
}

/// Formats an amplitude with its unit, and with its phase unless it is in phase or antiphase with the reference
/// coordinate of amplitude 1.
fn format_amplitude(name: &str, (real, imaginary): (f64, f64), unit: Option<&str>) -> String {
    let (size, phase) = (
        real.hypot(imaginary),
        imaginary.atan2(real).to_degrees().round(),
    );
    let size = match size < MAX_PLAIN_AMPLITUDE {
        true => format!("{size:.4}"),
        false => format!("{size:.4e}"),
    };
    let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
    match phase {
        phase if phase.abs() >= 180.0 => format!("{name} -{size}{unit}"),
        0.0 => format!("{name} {size}{unit}"),
        phase => format!("{name} {size}{unit} at {phase} deg"),
    }
}
