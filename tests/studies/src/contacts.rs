//! Study `contacts`: stacks of two to five falling balls, and boxes of `examples/impacts`, without and with friction,
//! dropped from random states. Every motion must reach the end without overlaps and without an increase of the energy,
//! and the stacks must stop moving.

use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Instance, Motion, Orders, Solver};
use eomgen_validate::random::Random;

use crate::sample::Sample;

/// Duration of each motion, s.
const UNTIL: f64 = 6.0;

const SAMPLES: usize = 101;

/// Largest accepted increase of the energy between two samples, relative to its largest magnitude.
const MAX_ENERGY_RISE: f64 = 1e-8;

/// Largest accepted overlap of two bodies, relative to the amplitude of the motion.
const MAX_OVERLAP: f64 = 1e-9;

/// Largest speed at which a stack counts as at rest, in m/s.
const MAX_REST_SPEED: f64 = 1e-9;

/// Runs the study and returns its summary.
///
/// # Errors
/// Returns a report of all motions that stop early, gain energy, have overlaps or do not come to rest.
pub fn run(sample: &Sample) -> Result<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/impacts");
    let load = |file| CompiledModel::load(folder.join(file), Orders::Declared);
    let dropped = load("dropped_box.toml").map_err(|e| e.to_string())?;
    let rough = load("box_with_friction.toml").map_err(|e| e.to_string())?;
    let mut failures = String::new();
    for index in 0..sample.count {
        let seed = sample.seed.wrapping_mul(1_000_003) + index as u64;
        let random = &mut Random::new(seed);
        for solver in [Solver::Rk, Solver::Radau] {
            for model in [&dropped, &rough] {
                if let Err(problem) = drop_box(model, &mut random.clone(), solver) {
                    let name = &model.model().name;
                    failures += &format!("{name} {index} by {solver}: {problem}\n");
                }
            }
            let text = stack(&mut random.clone());
            if let Err(problem) = drop_stack(&text, solver) {
                failures += &format!("stack {index} by {solver}: {problem}\n{text}\n");
            }
        }
    }
    let summary = format!(
        "contacts: {} boxes, as many with friction and as many stacks of seed {}, each by rk and radau",
        sample.count, sample.seed
    );
    match failures.is_empty() {
        true => Ok(summary),
        false => Err(failures + &summary),
    }
}

fn draw_between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

fn drop_box(model: &CompiledModel, random: &mut Random, solver: Solver) -> Result<(), String> {
    let restitution = draw_between(random, 0.0, 0.7);
    let half_width = draw_between(random, 0.1, 0.4);
    let mut settings = vec![("e", restitution), ("b", half_width)];
    if model.model().name == "box_with_friction" {
        settings.push(("mu", draw_between(random, 0.0, 1.5)));
    }
    let run = model
        .with_parameters(&settings)
        .map_err(|e| e.to_string())?;
    let initial = [
        0.0,
        draw_between(random, 0.5, 1.0),
        draw_between(random, -3.2, 3.2),
        draw_between(random, -2.0, 2.0),
        draw_between(random, -2.0, 1.0),
        draw_between(random, -8.0, 8.0),
    ];
    simulate(&run, &initial, solver).map(drop)
}

/// Returns the specification of a random stack of balls of radius 0.1 m.
fn stack(random: &mut Random) -> String {
    let count = 2 + (4.0 * random.unit()) as usize;
    let [mut parameters, mut coordinates, mut impacts] = [const { String::new() }; 3];
    let (mut kinetic, mut weight) = (Vec::new(), Vec::new());
    let mut height = draw_between(random, 0.1, 0.4);
    for ball in 0..count {
        let mass = 10_f64.powf(random.symmetric());
        parameters += &format!("m{ball} = {{ value = {mass:?}, unit = \"kg\" }}\n");
        coordinates += &format!("y{ball} = {{ unit = \"m\", initial = {height:?} }}\n");
        kinetic.push(format!("1/2*m{ball}*dot(y{ball})^2"));
        weight.push(format!("m{ball}*g*y{ball}"));
        let distance = match ball {
            0 => "y0 - r".to_owned(),
            _ => format!("y{ball} - y{} - 2*r", ball - 1),
        };
        let restitution = draw_between(random, 0.0, 0.7);
        impacts +=
            &format!("c{ball} = {{ when = \"{distance}\", restitution = {restitution:?} }}\n");
        // Some balls touch at the start.
        height += 0.2 + 0.3 * random.symmetric().max(0.0);
    }
    let (kinetic, weight) = (kinetic.join(" + "), weight.join(" + "));
    format!(
        r#"
[model]
name = "stack"
[parameters]
g = {{ value = 9.81, unit = "m/s^2" }}
r = {{ value = 0.1, unit = "m" }}
{parameters}
[coordinates]
{coordinates}
[kinetic]
balls = "{kinetic}"
[potential]
weight = "{weight}"
[impacts]
{impacts}"#
    )
}

fn drop_stack(text: &str, solver: Solver) -> Result<(), String> {
    let model = CompiledModel::from_text("stack.toml", text, Orders::Declared)
        .map_err(|e| e.to_string())?;
    let run = model
        .with_declared_parameters()
        .map_err(|e| e.to_string())?;
    let motion = simulate(&run, run.initial_state(), solver)?;
    let last = &motion.trajectory.final_state;
    let speeds = last[last.len() / 2..].iter();
    let speed = speeds.fold(0.0_f64, |most, rate| most.max(rate.abs()));
    match speed <= MAX_REST_SPEED {
        true => Ok(()),
        false => Err(format!("moves with {speed:e} m/s at the end")),
    }
}

/// Simulates until the end and checks overlaps and the energy.
fn simulate(run: &Instance<'_>, initial: &[f64], solver: Solver) -> Result<Motion, String> {
    let times: Vec<f64> = (0..SAMPLES)
        .map(|k| UNTIL * k as f64 / (SAMPLES - 1) as f64)
        .collect();
    let motion = run
        .simulate(initial, &times, &run.default_inputs(), solver)
        .map_err(|e| e.to_string())?;
    let overlap = run.find_first_overlap(&motion, MAX_OVERLAP);
    if let Some(overlap) = overlap.map_err(|e| e.to_string())? {
        return Err(format!("overlaps: {overlap:?}"));
    }
    let rows = run.observables(&motion).map_err(|e| e.to_string())?;
    let names = run.model().observable_names();
    let place = names.iter().position(|name| name == "energy");
    let energies: Vec<f64> = place.map_or(Vec::new(), |place| {
        rows.iter().map(|row| row[place]).collect()
    });
    let size = energies.iter().fold(0.0_f64, |size, e| size.max(e.abs()));
    for (pair, t) in energies.windows(2).zip(&times) {
        let rise = pair[1] - pair[0];
        if rise.is_nan() || rise > MAX_ENERGY_RISE * size {
            return Err(format!(
                "the energy rises from {} to {} J after {t} s",
                pair[0], pair[1]
            ));
        }
    }
    Ok(motion)
}
