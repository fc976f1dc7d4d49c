//! Records of a machine whose parameters and sensors are drawn from their priors.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Instance, Solver};
use eomgen_sim::inputs::HeldInputs;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::machines::Machine;
use eomgen_discover::thresholds::MAX_PRIOR_DEVIATION;

/// Default priors of a sensor: standard deviations of the gain, of the bias (relative to the noise) and of the delay
/// (in samples).
const SENSOR: [f64; 3] = [0.01, 10.0, 0.5];

struct Sensor {
    gain: f64,
    bias: f64,
    delay: f64,
}

/// Writes a dataset with a fitted and a held-out record to a folder; returns the true values of the
/// uncertain parameters.
///
/// # Errors
///
/// Returns an error if a motion cannot be simulated or a file cannot be written.
pub fn write(
    machine: &Machine,
    model: &CompiledModel,
    (seed, stream): (u64, u64),
    folder: &Path,
) -> Result<Vec<f64>, String> {
    let mut draw = ChaCha8Rng::seed_from_u64(seed);
    draw.set_stream(stream);
    let declared = model
        .with_declared_parameters()
        .map_err(|error| error.to_string())?;
    let mut truth = Vec::new();
    for (name, relative) in machine.uncertain {
        let value = declared.value(name).ok_or("an unknown parameter")?;
        truth.push(value * (1.0 + relative * truncated_normal(&mut draw)));
    }
    let names = machine.uncertain.iter().map(|(name, _)| *name);
    let settings: Vec<(&str, f64)> = names.zip(truth.iter().copied()).collect();
    let instance = model
        .with_parameters(&settings)
        .map_err(|error| error.to_string())?;
    let sensors: Vec<Sensor> = (machine.channels.iter())
        .map(|channel| Sensor {
            gain: 1.0 + SENSOR[0] * truncated_normal(&mut draw),
            bias: SENSOR[1] * channel.noise * truncated_normal(&mut draw),
            delay: SENSOR[2] * machine.sample * truncated_normal(&mut draw),
        })
        .collect();
    for (file, samples) in [
        ("train.csv", machine.samples),
        ("test.csv", machine.samples / 2),
    ] {
        let text = record(machine, &instance, &sensors, samples, &mut draw)?;
        fs::write(folder.join(file), text).map_err(|error| error.to_string())?;
    }
    fs::write(folder.join("dataset.toml"), dataset(machine)).map_err(|error| error.to_string())?;
    Ok(truth)
}

/// Returns the text of a record: times, input and channels, with noise.
fn record(
    machine: &Machine,
    instance: &Instance<'_>,
    sensors: &[Sensor],
    samples: usize,
    draw: &mut ChaCha8Rng,
) -> Result<String, String> {
    let times: Vec<f64> = (0..samples).map(|k| k as f64 * machine.sample).collect();
    let phases: Vec<f64> = machine.waves.iter().map(|_| uniform(draw) * TAU).collect();
    let value = |t: &f64| {
        let waves = machine.waves.iter().zip(&phases);
        waves
            .map(|((size, frequency), phase)| size * (TAU * frequency * t + phase).sin())
            .sum::<f64>()
    };
    let input: Vec<f64> = times.iter().map(value).collect();
    let inputs = HeldInputs::new(times.clone(), input.clone(), 1).ok_or("no inputs")?;
    let mut columns = Vec::new();
    for (channel, sensor) in machine.channels.iter().zip(sensors) {
        let quantity = quantity(instance, channel.name, &inputs, &times, sensor.delay)?;
        let seen = quantity.iter().map(|quantity| {
            let noise = channel.noise * normal(draw);
            sensor.gain * quantity + sensor.bias + noise
        });
        columns.push(seen.collect::<Vec<f64>>());
    }
    let names = machine.channels.iter().map(|channel| channel.name);
    let mut text = format!("t,{}", machine.input.0);
    names.for_each(|name| text += &format!(",{name}"));
    for (sample, (t, input)) in times.iter().zip(&input).enumerate() {
        let _ = write!(text, "\n{t},{input}");
        for column in &columns {
            let _ = write!(text, ",{}", column[sample]);
        }
    }
    Ok(text + "\n")
}

/// Returns a coordinate or observable of the motion from rest, at times shifted by a delay.
fn quantity(
    instance: &Instance<'_>,
    name: &str,
    inputs: &HeldInputs,
    times: &[f64],
    delay: f64,
) -> Result<Vec<f64>, String> {
    let late = times.iter().map(|t| (t - delay).max(0.0));
    let mut simulated: Vec<f64> = [0.0].into_iter().chain(late.clone()).collect();
    simulated.dedup();
    let motion = instance
        .simulate(instance.initial_state(), &simulated, inputs, Solver::Auto)
        .map_err(|error| error.to_string())?;
    let model = instance.model();
    let position = |names: Vec<String>| names.iter().position(|known| known == name);
    let values: Vec<f64> = match position(model.state_names()) {
        Some(place) => motion.trajectory.states.iter().map(|s| s[place]).collect(),
        None => {
            let place = position(model.observable_names()).ok_or("an unknown channel")?;
            let rows = instance.observables(&motion).map_err(|e| e.to_string())?;
            rows.iter().map(|row| row[place]).collect()
        }
    };
    let at = |t: f64| values[simulated.partition_point(|known| *known < t)];
    Ok(late.map(at).collect())
}

fn dataset(machine: &Machine) -> String {
    let (input, unit) = machine.input;
    let mut text = format!(
        "title = \"{}\"\n[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\
         [time]\ncolumn = \"t\"\nunit = \"s\"\n[inputs.{input}]\ncolumn = \"{input}\"\nunit = \"{unit}\"\n\
         [initial]\nstate = \"rest\"\n[windows]\nlength = {}\n",
        machine.name, machine.window
    );
    for channel in machine.channels {
        let (name, unit, noise) = (channel.name, channel.unit, channel.noise);
        let _ = write!(
            text,
            "[channels.{name}]\ncolumn = \"{name}\"\nunit = \"{unit}\"\nnoise = {noise}\n"
        );
    }
    text += "[uncertain]\n";
    for (name, relative) in machine.uncertain {
        let _ = writeln!(text, "{name} = {{ relative = {relative} }}");
    }
    text
}

fn normal(draw: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(draw)
}

/// Draws a normal number truncated to [`SHIFTED`] standard deviations. Fits keep parameters and sensors within these
/// bounds; larger deviations are reported as effects.
fn truncated_normal(draw: &mut ChaCha8Rng) -> f64 {
    loop {
        let value = normal(draw);
        if value.abs() < MAX_PRIOR_DEVIATION {
            return value;
        }
    }
}

fn uniform(draw: &mut ChaCha8Rng) -> f64 {
    (draw.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}
