//! Checks of the motions of one machine: energy conservation and agreement.

use eomgen_compiled_model::{CompiledModel, Instance, Orders, Request, Solver};

use super::machine::Machine;
use super::turning_point::place_of_stop;

const SAMPLES: usize = 200;

const TOLERANCES: [f64; 2] = [1e-9, 1e-11];

/// Tolerance of the reference and of its neighbouring motions.
const REFERENCE: f64 = 1e-12;

/// Initial distance of neighbouring motions from the reference, in tolerances relative to the
/// magnitudes of the states.
const NEIGHBOUR_DISTANCE: f64 = 100.0;

/// Number of pairs of neighbouring motions, on either side of the reference.
const PAIRS: usize = 2;

/// Maximum difference of a motion from the reference, in tolerances beyond that of neighbouring
/// motions.
const MAX_DIFFERENCE: f64 = 100.0;

/// Relative distance at which neighbouring motions have diverged and are no longer compared.
const DIVERGED_DISTANCE: f64 = 0.05;

/// Maximum rise of the energy in tolerances, times the square root of the stop's stiffness ratio: an
/// error of the deflection has this weight in the energy of the stop.
const MAX_RISE: f64 = 10.0;

pub struct Verdict {
    pub failures: Vec<String>,
    pub runs: usize,
    /// Whether the exact solver accepted the machine.
    pub is_exact: bool,
    pub switches: usize,
    /// Largest rise of the energy relative to the allowed one.
    pub rise: f64,
    /// Largest difference from the reference relative to the allowed one.
    pub difference: f64,
}

impl Verdict {
    /// Returns the verdict for a machine that could not be judged.
    pub fn failed(problem: String) -> Self {
        Self {
            failures: vec![problem],
            runs: 0,
            is_exact: false,
            switches: 0,
            rise: 0.0,
            difference: 0.0,
        }
    }
}

struct Sampled {
    states: Vec<Vec<f64>>,
    energies: Vec<f64>,
    switches: usize,
}

/// Judges the motions of a machine.
///
/// # Errors
///
/// Returns an error if the machine has no reference.
pub fn judge(machine: &Machine) -> Result<Verdict, String> {
    let text = machine.specification(place_of_stop(machine)?);
    let model = CompiledModel::of_text("grazing.toml", &text, Orders::Declared)
        .map_err(|error| error.to_string())?;
    let run = model.with(&[]).map_err(|error| error.to_string())?;
    let times: Vec<f64> = (0..=SAMPLES)
        .map(|place| machine.duration * place as f64 / SAMPLES as f64)
        .collect();
    let sampled =
        |initial: &[f64], solver, tolerance| sample(&run, (initial, &times), solver, tolerance);
    let reference = sampled(&machine.initial, Solver::Rk, REFERENCE)
        .map_err(|error| format!("reference: {error}"))?;
    let sizes = sizes_of(&reference.states);
    let mut verdict = Verdict::failed(String::new());
    verdict.failures.clear();
    verdict.switches = reference.switches;
    verdict.is_exact = model.piecewise_linear().is_ok();
    for tolerance in TOLERANCES {
        let parting = parting(machine, &reference, &sizes, tolerance, &sampled)?;
        let mut solvers = vec![Solver::Rk, Solver::Radau];
        if verdict.is_exact && tolerance == TOLERANCES[0] {
            solvers.push(Solver::Exact);
        }
        for solver in solvers {
            verdict.runs += 1;
            let failure = match sampled(&machine.initial, solver, tolerance) {
                Err(error) => Some(error),
                Ok(motion) => {
                    let rise = rise_of(machine, &motion.energies, tolerance);
                    let difference =
                        difference_of(&motion, (&reference, &sizes), &parting, tolerance);
                    verdict.rise = verdict.rise.max(rise);
                    verdict.difference = verdict.difference.max(difference);
                    (rise > 1.0 || difference > 1.0).then(|| {
                        format!(
                            "energy {rise:.1e} and difference {difference:.1e} relative to the allowed values"
                        )
                    })
                }
            };
            if let Some(failure) = failure {
                let line = format!("{machine}: {solver} at {tolerance:.0e}: {failure}");
                verdict.failures.push(line);
            }
        }
    }
    Ok(verdict)
}

fn sample(
    run: &Instance<'_>,
    (initial, times): (&[f64], &[f64]),
    solver: Solver,
    tolerance: f64,
) -> Result<Sampled, String> {
    let inputs = run.no_inputs();
    let request = Request {
        initial,
        times,
        inputs: &inputs,
        solver,
        tolerance,
        audit: false,
        max_step: f64::INFINITY,
    };
    let motion = run
        .follow(&request, &mut |_| {})
        .and_then(|motion| motion.complete());
    let motion = motion.map_err(|error| error.to_string())?;
    let names = run.model().observable_names();
    let place = names.iter().position(|name| name == "energy").unwrap_or(0);
    let rows = run
        .observables(&motion)
        .map_err(|error| error.to_string())?;
    Ok(Sampled {
        switches: motion.trajectory.switches.len(),
        energies: rows.iter().map(|row| row[place]).collect(),
        states: motion.trajectory.states,
    })
}

fn sizes_of(states: &[Vec<f64>]) -> Vec<f64> {
    (0..states[0].len())
        .map(|index| {
            states
                .iter()
                .map(|state| state[index].abs())
                .fold(0.0, f64::max)
        })
        .collect()
}

/// Returns the largest rise of the energy above its previous minimum, relative to the allowed one.
/// For a conservative machine, returns the largest deviation from the initial energy instead.
fn rise_of(machine: &Machine, energies: &[f64], tolerance: f64) -> f64 {
    let first = energies[0];
    let mut lowest = first;
    let mut rise = 0.0_f64;
    for energy in energies {
        lowest = lowest.min(*energy);
        rise = rise.max(match machine.is_conservative() {
            true => (energy - first).abs(),
            false => energy - lowest,
        });
        if energy.is_nan() {
            return f64::INFINITY;
        }
    }
    rise / (MAX_RISE * tolerance * machine.stiffness_ratio.sqrt() * first)
}

/// Returns the largest distance of the neighbouring motions from the reference up to each sample.
fn parting(
    machine: &Machine,
    reference: &Sampled,
    sizes: &[f64],
    tolerance: f64,
    sampled: &impl Fn(&[f64], Solver, f64) -> Result<Sampled, String>,
) -> Result<Vec<f64>, String> {
    let mut parted = vec![0.0_f64; reference.states.len()];
    for pair in 0..PAIRS {
        for sign in [1.0, -1.0] {
            let beside = machine.initial.iter().zip(sizes).enumerate();
            // Directions that are not parallel to an axis or to each other.
            let beside: Vec<f64> = beside
                .map(|(index, (y, size))| {
                    let direction = (1.0 + 2.0 * index as f64 + 1.7 * pair as f64).sin();
                    y + sign * direction * NEIGHBOUR_DISTANCE * tolerance * size
                })
                .collect();
            let motion = sampled(&beside, Solver::Rk, REFERENCE)
                .map_err(|error| format!("neighbouring motion: {error}"))?;
            let mut so_far = 0.0_f64;
            for (place, parted) in parted.iter_mut().enumerate() {
                let states = (&motion.states[place], &reference.states[place]);
                so_far = so_far.max(distance(states, sizes));
                *parted = parted.max(so_far);
            }
        }
    }
    Ok(parted)
}

/// Returns the largest difference from the reference relative to the allowed one, until the
/// neighbouring motions have diverged.
fn difference_of(
    motion: &Sampled,
    (reference, sizes): (&Sampled, &[f64]),
    parting: &[f64],
    tolerance: f64,
) -> f64 {
    let pairs = motion.states.iter().zip(&reference.states).zip(parting);
    pairs
        .take_while(|(_, parted)| **parted < DIVERGED_DISTANCE)
        .map(|(states, parted)| distance(states, sizes) / (MAX_DIFFERENCE * tolerance + parted))
        .fold(0.0, f64::max)
}

/// Returns the largest difference of a state, relative to its magnitude.
fn distance((a, b): (&Vec<f64>, &Vec<f64>), sizes: &[f64]) -> f64 {
    let differences = a.iter().zip(b).zip(sizes);
    differences
        .map(|((a, b), size)| (a - b).abs() / size)
        .fold(0.0, f64::max)
}
