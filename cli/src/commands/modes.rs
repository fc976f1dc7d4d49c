//! `eomgen modes`: natural frequencies, damping ratios and mode shapes at a state.

use eomgen_analysis::constrained_modes::constrained_modes;
use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_compiled_model::CompiledModel;
use serde_json::{Value, json};

use crate::arguments::Modes;
use crate::error::{Error, Result, print_json, print_text};
use crate::mode_figure::figure;
use crate::operating_point::{head, is_equilibrium, model, point, shape_names, values_by_name};
use crate::output::Destination;
use crate::regime::{Side, regime, summary};

pub fn run(options: &Modes) -> Result {
    let drawing = options.plot.as_deref();
    let drawing = drawing.map(|plot| Destination::for_figure(plot, None, options.output.json));
    let drawing = drawing.transpose()?;
    let compiled = model(
        &options.model.spec,
        options.model.order.text(),
        &options.parameters.set,
    )?;
    let run = compiled.with_declared_parameters()?;
    let at = point(&run, &options.point.state)?;
    let is_equilibrium = is_equilibrium(&run, &at)?;
    let found = run.linearise(at.point())?;
    let degrees = compiled.program().degrees_of_freedom();
    let modes = constrained_modes(&found.a, &found.constraint_matrix(&compiled), degrees)
        .map_err(|error| Error::input(error.to_string()))?;
    let regime = regime(&run, &at)?;
    if let Some(drawing) = &drawing {
        drawing.write(figure(&run, &regime, &modes)?.as_bytes())?;
    }
    if !options.output.json {
        let text = table(&compiled, &modes) + &sides(&regime);
        return drawing.map_or_else(|| print_text(&text), |drawing| drawing.summarise(&text));
    }
    let mut document = head(&compiled);
    document.insert("at".to_owned(), values_by_name(&compiled, &at));
    document.insert("equilibrium".to_owned(), json!(is_equilibrium));
    document.insert("coordinates".to_owned(), json!(shape_names(&compiled)));
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
        "damping": mode.damping(),
        "eigenvalue": [mode.eigenvalue.re, mode.eigenvalue.im],
        "shape": real,
        "shape_imaginary": imaginary,
    })
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

fn table(compiled: &CompiledModel, modes: &[NaturalMode]) -> String {
    let mut text = "frequency, Hz   damping ratio   shape (its largest coordinates)\n".to_owned();
    let names = shape_names(compiled);
    for mode in modes {
        let mut parts: Vec<_> = names.iter().zip(&mode.shape).collect();
        parts.sort_by(|a, b| b.1.norm().total_cmp(&a.1.norm()));
        let parts = parts
            .iter()
            .take(LISTED)
            .filter(|(_, value)| value.norm() >= MIN_AMPLITUDE);
        let parts: Vec<String> = parts
            .map(|(name, value)| part(name, value.re, value.im))
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

/// Formats an amplitude, with its phase unless it is in phase or antiphase with the largest.
fn part(name: &str, real: f64, imaginary: f64) -> String {
    let (size, phase) = (
        real.hypot(imaginary),
        imaginary.atan2(real).to_degrees().round(),
    );
    match phase {
        phase if phase.abs() >= 180.0 => format!("{name} -{size:.4}"),
        0.0 => format!("{name} {size:.4}"),
        phase => format!("{name} {size:.4} at {phase} deg"),
    }
}
