//! Comparison of the woodpecker toy with Moreau's time-stepping scheme, which has no events and modes.

use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Orders, Request, Solver};
use nalgebra::{Matrix3, Vector3};

const STEP_S: f64 = 2e-6;

/// End of the comparison in s, just before the first impact of the beak. At this impact the program uses energetic
/// restitution, but the time-stepping scheme uses Newton's.
const END_S: f64 = 0.0809;

/// Largest difference of a state, relative to its largest magnitude. The time-stepping scheme is of first order.
const MAX_DIFFERENCE: f64 = 2e-3;

/// Contact: distance, normal direction and tangential direction.
struct Contact {
    distance: fn(Vector3<f64>) -> f64,
    normal: Vector3<f64>,
    tangent: Vector3<f64>,
}

const R_O: f64 = 0.0025;
const R_M: f64 = 0.0031;
const H_M: f64 = 0.0058;

/// Returns the contacts of the sleeve at its lower and upper edges.
fn sleeve() -> [Contact; 2] {
    let tangent = Vector3::new(1.0, R_M, 0.0);
    [
        Contact {
            distance: |q| R_M - R_O + H_M * q[1],
            normal: Vector3::new(0.0, H_M, 0.0),
            tangent,
        },
        Contact {
            distance: |q| R_M - R_O - H_M * q[1],
            normal: Vector3::new(0.0, -H_M, 0.0),
            tangent,
        },
    ]
}

/// Integrates the toy from a state to [`END_S`] and returns position and velocity at these times (in s).
fn step_through(
    (mut q, mut u): (Vector3<f64>, Vector3<f64>),
    times: &[f64],
) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let (l_m, l_g, mass, own) = (0.010, 0.015, 0.0045, 0.0003);
    let (stiffness, g, mu) = (0.0056, 9.81, 0.3);
    let arm = Vector3::new(1.0, l_m, l_g);
    let inertia: Matrix3<f64> =
        mass * arm * arm.transpose() + Matrix3::from_diagonal(&Vector3::new(own, 5e-9, 7e-7));
    let inverse = inertia.try_inverse().expect("a regular mass matrix");
    let contacts = sleeve();
    let mut found = Vec::new();
    let mut t = 0.0;
    while found.len() < times.len() {
        if t >= times[found.len()] {
            found.push((q, u));
        }
        let middle = q + u * (0.5 * STEP_S);
        let bend = stiffness * (middle[2] - middle[1]);
        let force = Vector3::new(-own * g, bend, -bend) - arm * (mass * g);
        let mut next = u + inverse * force * STEP_S;
        let mut impulses = [[0.0; 2]; 2];
        for _ in 0..200 {
            for (contact, [normal, friction]) in contacts.iter().zip(&mut impulses) {
                if (contact.distance)(middle) > 0.0 {
                    continue;
                }
                let effect = inverse * contact.normal;
                let wanted = *normal - contact.normal.dot(&next) / contact.normal.dot(&effect);
                let change = wanted.max(0.0) - *normal;
                next += effect * change;
                *normal += change;
                let effect = inverse * contact.tangent;
                let wanted = *friction - contact.tangent.dot(&next) / contact.tangent.dot(&effect);
                let change = wanted.clamp(-mu * *normal, mu * *normal) - *friction;
                next += effect * change;
                *friction += change;
            }
        }
        u = next;
        q = middle + u * (0.5 * STEP_S);
        t += STEP_S;
    }
    found
}

#[test]
fn woodpecker_slides_sticks_and_tilts_as_in_time_stepping() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/impacts/woodpecker.toml");
    let model = CompiledModel::load(path, Orders::Declared).expect("a model");
    let run = model.with_declared_parameters().expect("an instance");
    let times: Vec<f64> = (0..=16).map(|k| END_S * f64::from(k) / 16.0).collect();
    let initial = run.initial_state();
    let right = step_through(
        (
            Vector3::from_column_slice(&initial[..3]),
            Vector3::from_column_slice(&initial[3..]),
        ),
        &times,
    );
    for solver in [Solver::Rk, Solver::Radau] {
        let request = Request {
            initial,
            times: &times,
            inputs: &run.default_inputs(),
            solver,
            tolerance: 1e-10,
            max_step: f64::INFINITY,
            audit: true,
        };
        let motion = run
            .simulate_until_stop(&request, &mut |_| {})
            .expect("a motion");
        let states = &motion.trajectory.states;
        assert_eq!(motion.audit.expect("an audit").fault_count, 0, "{solver}");
        for place in 0..6 {
            let entry = |k: usize| match place {
                0..3 => right[k].0[place],
                _ => right[k].1[place - 3],
            };
            let size = (0..times.len()).fold(0.0_f64, |most, k| most.max(entry(k).abs()));
            for (k, state) in states.iter().enumerate() {
                let difference = (state[place] - entry(k)).abs();
                assert!(
                    difference <= MAX_DIFFERENCE * size,
                    "{solver}, t = {}, state {place}: {}, {}",
                    times[k],
                    state[place],
                    entry(k)
                );
            }
        }
    }
}
