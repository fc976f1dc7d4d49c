//! Study `solvers`: random machines are simulated by all solvers. At each of several tolerances, the motions of two
//! solvers may differ by ten tolerances times the growth of a small difference along the motion. The energy of a
//! passive machine must not increase.

pub(crate) mod growth;
pub(crate) mod machine;

use std::panic::{AssertUnwindSafe, catch_unwind};

use eomgen_compiled_model::{CompiledModel, Error, Instance, Motion, Orders, Request, Solver};
use eomgen_validate::random::Random;

use crate::sample::Sample;
use growth::{STARTS, difference, growth, magnitudes};
use machine::{Machine, draw};

const TOLERANCES: [f64; 3] = [1e-6, 1e-8, 1e-10];

/// Tolerance of the motions that measure the growth.
const GROWTH_TOLERANCE: f64 = 1e-11;

/// Accepted difference of two solvers, in tolerances times the growth of small differences.
const ALLOWED_TOLERANCES: f64 = 10.0;

/// Ratio of the relative error of an energy difference to the relative error of the states. Energies contain up to the
/// fourth power of a coordinate, and both samples have an error.
const ENERGY_SENSITIVITY: f64 = 8.0;

const SAMPLES: usize = 61;

struct Outcome {
    /// Largest difference of two solvers, relative to the accepted difference.
    worst: f64,
    is_exact: bool,
    /// True if the machine is passive and its energy was checked.
    is_passive: bool,
}

/// Runs the study and returns its summary.
///
/// # Errors
///
/// Returns a report of all machines for which solvers disagree, stop or panic, or the energy increases.
pub fn run(sample: &Sample) -> Result<String, String> {
    let mut outcomes = Vec::new();
    let mut failures = String::new();
    for index in 0..sample.count {
        let seed = sample
            .seed
            .wrapping_mul(1_000_003)
            .wrapping_add(index as u64);
        let mut random = Random::new(seed);
        let machine = draw(&mut random);
        let judged = catch_unwind(AssertUnwindSafe(|| judge(&machine, &mut random)));
        let problem = match judged {
            Ok(Ok(outcome)) => {
                outcomes.push(outcome);
                continue;
            }
            Ok(Err(problem)) => problem,
            Err(_) => "panics".to_owned(),
        };
        failures += &format!(
            "machine {index} with {:?}: {problem}\n{}\n",
            machine.features, machine.text
        );
    }
    let worst = outcomes.iter().map(|o| o.worst).fold(0.0, f64::max);
    let exact = outcomes.iter().filter(|o| o.is_exact).count();
    let passive = outcomes.iter().filter(|o| o.is_passive).count();
    let summary = format!(
        "{} of {} machines agree: {exact} by the exact solver too, {passive} passive; largest \
         difference {worst:.2} of what is allowed",
        outcomes.len(),
        sample.count
    );
    match failures.is_empty() {
        true => Ok(summary),
        false => Err(failures + &summary),
    }
}

fn judge(machine: &Machine, random: &mut Random) -> Result<Outcome, String> {
    let model = CompiledModel::from_text("drawn.toml", &machine.text, Orders::Declared)
        .map_err(|error| error.to_string())?;
    let instance = model
        .with_declared_parameters()
        .map_err(|error| error.to_string())?;
    let times: Vec<f64> = (0..SAMPLES)
        .map(|k| machine.until * k as f64 / (SAMPLES - 1) as f64)
        .collect();
    let request = |solver, tolerance| Request {
        initial: instance.initial_state(),
        times: &times,
        inputs: &machine.inputs,
        solver,
        tolerance,
        max_step: f64::INFINITY,
        audit: false,
    };
    let reference = simulate_to_end(&instance, &request(Solver::Rk, GROWTH_TOLERANCE))?;
    let states = &reference.trajectory.states;
    let sizes = magnitudes(states, &model.state_units());
    let initial_request = request(Solver::Rk, GROWTH_TOLERANCE);
    let growth = growth(
        &instance,
        &initial_request,
        states,
        &sizes,
        (&STARTS, random),
    )
    .map_err(|error| format!("a neighbour of the motion: {error}"))?;
    check_energy(
        machine,
        &instance,
        &reference,
        ALLOWED_TOLERANCES * GROWTH_TOLERANCE * growth,
    )?;
    let exact = exact_motion(&instance, &request(Solver::Exact, GROWTH_TOLERANCE))?;
    let mut worst = 0.0_f64;
    for tolerance in TOLERANCES {
        let allowed = ALLOWED_TOLERANCES * tolerance * growth;
        let rk = simulate_to_end(&instance, &request(Solver::Rk, tolerance))?;
        let radau = simulate_to_end(&instance, &request(Solver::Radau, tolerance))?;
        let motions = [Some(&rk), Some(&radau), exact.as_ref()];
        let motions: Vec<&Motion> = motions.into_iter().flatten().collect();
        for motion in &motions {
            check_energy(machine, &instance, motion, allowed)?;
        }
        for (place, a) in motions.iter().enumerate() {
            for b in &motions[place + 1..] {
                let gap = difference(&a.trajectory.states, &b.trajectory.states, &sizes);
                if gap.is_nan() || gap > allowed {
                    let names = (a.solver.name(), b.solver.name());
                    return Err(format!(
                        "{} and {} differ by {gap:.1e} at a tolerance of {tolerance:.0e} and a \
                         growth of {growth:.1e}",
                        names.0, names.1
                    ));
                }
                worst = worst.max(gap / allowed);
            }
        }
    }
    Ok(Outcome {
        worst,
        is_exact: exact.is_some(),
        is_passive: machine.is_passive(),
    })
}

/// Simulates to the last requested time; returns an error if the motion stops early.
fn simulate_to_end(instance: &Instance<'_>, request: &Request<'_>) -> Result<Motion, String> {
    let solver = request.solver.name();
    let motion = instance.simulate_until_stop(request, &mut |_| {});
    motion
        .and_then(Motion::into_complete)
        .map_err(|error| format!("{solver} at {:.0e}: {error}", request.tolerance))
}

/// Simulates with the exact solver; `None` if it does not support the model.
fn exact_motion(instance: &Instance<'_>, request: &Request<'_>) -> Result<Option<Motion>, String> {
    if instance.model().piecewise_linear().is_err() || !instance.model().model().impacts.is_empty()
    {
        return Ok(None);
    }
    simulate_to_end(instance, request).map(Some)
}

/// Checks that the energy of a passive machine never increases from one sample to a later one by more than the fraction
/// `allowed` of its largest magnitude.
fn check_energy(
    machine: &Machine,
    instance: &Instance<'_>,
    motion: &Motion,
    allowed: f64,
) -> Result<(), String> {
    if !machine.is_passive() {
        return Ok(());
    }
    let rows = instance
        .observables(motion)
        .map_err(|error: Error| error.to_string())?;
    let energies: Vec<f64> = rows.iter().map(|row| row[row.len() - 2]).collect();
    let allowed =
        ENERGY_SENSITIVITY * allowed * energies.iter().fold(0.0_f64, |size, e| size.max(e.abs()));
    let mut lowest = f64::INFINITY;
    for (energy, t) in energies.iter().zip(&motion.trajectory.times) {
        lowest = lowest.min(*energy);
        let rise = energy - lowest;
        if rise.is_nan() || rise > allowed {
            return Err(format!(
                "by {} the energy rises by {rise:.1e} J to {energy:e} J until {t:e} s, {allowed:.1e} J are \
                 allowed",
                motion.solver.name(),
            ));
        }
    }
    Ok(())
}
