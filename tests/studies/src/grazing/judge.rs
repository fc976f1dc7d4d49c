//! Checks of the motions of one machine: energy and agreement of solvers.

use eomgen_compiled_model::{CompiledModel, Instance, Orders, Request, Solver};

use super::machine::Machine;
use super::turning_point::place_of_stop;

const SAMPLES: usize = 200;

const TOLERANCES: [f64; 2] = [1e-9, 1e-11];

/// Tolerance of the reference motion and of the neighbouring motions.
const REFERENCE: f64 = 1e-12;

/// Minimum of the accepted sum of errors of a motion, in tolerances relative to the sizes of the states. Every located
/// switch adds one tolerance.
const LEAST_ERRORS: f64 = 100.0;

/// Accepted error per step of the reference, in tolerances, because errors accumulate in fast modes. In a motion of
/// 17,905 steps without contact, the error relative to the exact solver is 0.06 tolerances per step.
const ERROR_PER_STEP: f64 = 0.05;

/// Number of pairs of neighbouring motions that start on both sides of the initial state of the reference.
const PAIRS: usize = 2;

/// Positions of the contacts within which neighbouring motions start, as fractions of the list of switches of the
/// reference.
const CONTACTS: [f64; 3] = [0.25, 0.5, 0.75];

/// Relative distance from which on neighbouring motions count as diverged and are no longer compared.
const DIVERGED_DISTANCE: f64 = 0.05;

/// Maximum increase of the energy, in tolerances times the square root of the stop's stiffness ratio. An error of the
/// deflection has this weight in the energy of the stop.
const MAX_RISE: f64 = 10.0;

pub struct Verdict {
    pub failures: Vec<String>,
    pub runs: usize,
    /// True if the exact solver supports the machine.
    pub is_exact: bool,
    pub switches: usize,
    /// Largest increase of the energy, relative to the accepted increase.
    pub rise: f64,
    /// Largest difference from the reference, relative to the accepted difference.
    pub difference: f64,
}

impl Verdict {
    /// Returns the verdict for a machine that could not be checked.
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
    /// Times of the switches, s.
    switches: Vec<f64>,
    steps: u64,
}

/// Reference motion for the comparison of solvers.
struct Reference {
    times: Vec<f64>,
    motion: Sampled,
    /// Largest magnitude of each state.
    sizes: Vec<f64>,
    /// Accepted sum of the errors of a motion, in tolerances.
    errors: f64,
}

/// Function that computes states and energies of a motion at times, from a state at the first time.
type Sampling<'a> = dyn Fn(&[f64], &[f64], Solver, f64) -> Result<Sampled, String> + 'a;

/// Checks the motions of a machine.
///
/// # Errors
///
/// Returns an error if the reference motion cannot be computed.
pub fn judge(machine: &Machine) -> Result<Verdict, String> {
    let text = machine.specification(place_of_stop(machine)?);
    let model = CompiledModel::from_text("grazing.toml", &text, Orders::Declared)
        .map_err(|error| error.to_string())?;
    let run = model
        .with_parameters(&[])
        .map_err(|error| error.to_string())?;
    let times: Vec<f64> = (0..=SAMPLES)
        .map(|place| machine.duration * place as f64 / SAMPLES as f64)
        .collect();
    let sampled = |initial: &[f64], times: &[f64], solver, tolerance| {
        sample(&run, (initial, times), solver, tolerance)
    };
    let motion = sampled(&machine.initial, &times, Solver::Rk, REFERENCE)
        .map_err(|error| format!("reference: {error}"))?;
    let reference = Reference {
        sizes: sizes_of(&motion.states),
        errors: LEAST_ERRORS
            .max(motion.switches.len() as f64)
            .max(ERROR_PER_STEP * motion.steps as f64),
        times,
        motion,
    };
    let mut verdict = Verdict::failed(String::new());
    verdict.failures.clear();
    verdict.switches = reference.motion.switches.len();
    verdict.is_exact = model.piecewise_linear().is_ok();
    for tolerance in TOLERANCES {
        let parting = parting(machine, &reference, tolerance, &sampled)?;
        let mut solvers = vec![Solver::Rk, Solver::Radau];
        if verdict.is_exact && tolerance == TOLERANCES[0] {
            solvers.push(Solver::Exact);
        }
        for solver in solvers {
            verdict.runs += 1;
            let failure = match sampled(&machine.initial, &reference.times, solver, tolerance) {
                Err(error) => Some(error),
                Ok(motion) => {
                    let rise = rise_of(machine, &motion.energies, tolerance);
                    let difference = difference_of(&motion, &reference, &parting, tolerance);
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
    let inputs = run.default_inputs();
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
        .simulate_until_stop(&request, &mut |_| {})
        .and_then(|motion| motion.into_complete());
    let motion = motion.map_err(|error| error.to_string())?;
    let names = run.model().observable_names();
    let place = names.iter().position(|name| name == "energy").unwrap_or(0);
    let rows = run
        .observables(&motion)
        .map_err(|error| error.to_string())?;
    Ok(Sampled {
        switches: motion.trajectory.events.iter().map(|s| s.t).collect(),
        steps: motion.trajectory.statistics.steps,
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

/// Returns the largest increase of the energy above its lowest earlier value, relative to the accepted increase. Losses
/// by numerical damping are checked through the states.
fn rise_of(machine: &Machine, energies: &[f64], tolerance: f64) -> f64 {
    let first = energies[0];
    let mut lowest = first;
    let mut rise = 0.0_f64;
    for energy in energies {
        lowest = lowest.min(*energy);
        rise = rise.max(energy - lowest);
        if energy.is_nan() {
            return f64::INFINITY;
        }
    }
    rise / (MAX_RISE * tolerance * machine.stiffness_ratio.sqrt() * first)
}

/// Returns the largest distance of neighbouring motions from the reference up to each sample. Neighbouring motions
/// start close to the initial state, and close to the reference within several contacts.
fn parting(
    machine: &Machine,
    reference: &Reference,
    tolerance: f64,
    sampled: &Sampling<'_>,
) -> Result<Vec<f64>, String> {
    let mut starts = vec![(0, 0.0, machine.initial.clone(), PAIRS)];
    for t in contacts(&reference.motion.switches) {
        let before = reference.times.partition_point(|time| *time < t) - 1;
        let times = [reference.times[before], t];
        let way = sampled(
            &reference.motion.states[before],
            &times,
            Solver::Rk,
            REFERENCE,
        )?;
        starts.push((before + 1, t, way.states[1].clone(), 1));
    }
    let mut parted = vec![0.0_f64; reference.times.len()];
    for (first, t, state, pairs) in starts {
        let times: Vec<f64> = std::iter::once(t)
            .chain(
                reference.times[first..]
                    .iter()
                    .copied()
                    .filter(|time| *time > t),
            )
            .collect();
        let skipped = reference.times.len() + 1 - times.len();
        for pair in 0..2 * pairs {
            let sign = if pair % 2 == 0 { 1.0 } else { -1.0 };
            let entries = state.iter().zip(&reference.sizes).enumerate();
            // The directions are not along an axis, and no direction is a multiple of another.
            let beside: Vec<f64> = entries
                .map(|(index, (y, size))| {
                    let direction = (1.0 + 2.0 * index as f64 + 1.7 * (pair / 2) as f64).sin();
                    y + sign * direction * reference.errors * tolerance * size
                })
                .collect();
            // If a neighbouring motion cannot be simulated, it is ignored, which makes the check stricter.
            let Ok(motion) = sampled(&beside, &times, Solver::Rk, REFERENCE) else {
                continue;
            };
            let mut so_far = 0.0_f64;
            for (place, state) in motion.states.iter().enumerate().skip(1) {
                let place = place + skipped - 1;
                let states = (state, &reference.motion.states[place]);
                so_far = so_far.max(distance(states, &reference.sizes));
                parted[place] = parted[place].max(so_far);
            }
        }
    }
    Ok(parted)
}

/// Returns times (in s) within contacts: near each position of [`CONTACTS`], the middle of the shortest interval
/// between switches.
fn contacts(switches: &[f64]) -> Vec<f64> {
    let intervals: Vec<(f64, f64)> = switches
        .windows(2)
        .map(|pair| (pair[1] - pair[0], 0.5 * (pair[0] + pair[1])))
        .filter(|(length, _)| *length > 0.0)
        .collect();
    let shortest = |part: f64| {
        let place = (part * intervals.len() as f64) as usize;
        let near = intervals.iter().skip(place).take(2);
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|near| near.1)
    };
    CONTACTS.into_iter().filter_map(shortest).collect()
}

/// Returns the largest difference from the reference, relative to the accepted difference, as long as neighbouring
/// motions have not diverged.
fn difference_of(motion: &Sampled, reference: &Reference, parting: &[f64], tolerance: f64) -> f64 {
    let pairs = motion.states.iter().zip(&reference.motion.states);
    pairs
        .zip(parting)
        .take_while(|(_, parted)| **parted < DIVERGED_DISTANCE)
        .map(|(states, parted)| {
            let allowed = reference.errors * tolerance + parted;
            distance(states, &reference.sizes) / allowed
        })
        .fold(0.0, f64::max)
}

/// Returns the largest difference of a state, relative to its magnitude.
fn distance((a, b): (&Vec<f64>, &Vec<f64>), sizes: &[f64]) -> f64 {
    let differences = a.iter().zip(b).zip(sizes);
    differences
        .map(|((a, b), size)| (a - b).abs() / size)
        .fold(0.0, f64::max)
}
