//! Tests of sticking in the general solvers. They compare with closed forms, with the exact solver if it supports the
//! motion, and with set-valued time stepping. The time stepping has no surfaces, regimes and events: its friction
//! impulses stay within their bounds and bring the speeds as near to zero as possible.

mod collapse;
mod constrained;
mod discs;
mod domain;
mod external_motion;
mod gradients;
mod late_times;
mod lifted_brakes;
mod rows;
mod seldom;
mod surface_at_start;
mod time_stepping;
mod tipping;

use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Motion, Orders, Request, Solver};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::SurfaceMode;
use time_stepping::{DryFriction, Machine};

/// Solvers with time steps that support sticking.
const GENERAL: [Solver; 2] = [Solver::Rk, Solver::Radau];

fn example(name: &str) -> CompiledModel {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/friction");
    CompiledModel::load(folder.join(format!("{name}.toml")), Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn compile_text(text: &str) -> CompiledModel {
    CompiledModel::from_text("rest.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn grid(until: f64, count: usize) -> Vec<f64> {
    (0..=count)
        .map(|k| until * k as f64 / count as f64)
        .collect()
}

fn simulated(
    model: &CompiledModel,
    settings: &[(&str, f64)],
    times: &[f64],
    solver: Solver,
) -> Motion {
    let run = model.with_parameters(settings).unwrap();
    let motion = run.simulate(run.initial_state(), times, &run.default_inputs(), solver);
    motion.unwrap_or_else(|error| panic!("{settings:?} {solver}: {error}"))
}

#[test]
fn pendulum_sticks_off_the_vertical_with_friction_equal_to_weight() {
    let model = example("stopped_pendulum");
    let (m, l, g, t_c) = (0.15, 0.3, 9.81, 0.02);
    let machine = Machine {
        inverse_mass: &|_| [[1.0 / (m * l * l)]],
        forces: &|_, [theta], _| [-m * g * l * f64::sin(theta)],
        rubbing: &|_, _| {
            vec![DryFriction {
                along: [1.0],
                drift: 0.0,
                level: t_c,
            }]
        },
    };
    let times = grid(10.0, 100);
    for solver in GENERAL {
        let motion = simulated(&model, &[], &times, solver);
        let states = &motion.trajectory.states;
        machine.assert_converges_to(([1.0], [0.0]), 10.0, &states[100], 2e-4);
        // During sticking nothing moves, not even by accumulated rounding.
        assert!(states[100][0].abs() > 1e-3, "{:?}", states[100]);
        assert!((states[100][0] - states[60][0]).abs() < 1e-13);
        assert!(states[60..].iter().all(|state| state[1].abs() < 1e-14));
        let run = model.with_declared_parameters().unwrap();
        let observables = run.observables(&motion).unwrap();
        for (row, state) in observables[60..].iter().zip(&states[60..]) {
            // The observable `rubs`, energy and power during sticking.
            assert!(
                (row[0] - m * g * l * state[0].sin()).abs() < 1e-12,
                "{row:?}"
            );
            assert!(row[2].abs() < 1e-15, "{row:?}");
        }
        assert!(row_of_sliding(&observables, states));
    }
}

/// Returns true if the observables show the friction level of sliding.
fn row_of_sliding(observables: &[Vec<f64>], states: &[Vec<f64>]) -> bool {
    let mut pairs = observables.iter().zip(states);
    pairs.all(|(row, state)| state[1].abs() < 1e-6 || row[0] == -0.02 * state[1].signum())
}

#[test]
fn motor_releases_pendulum_until_it_sticks_again() {
    let model = example("stopped_pendulum");
    let (m, l, g, t_c) = (0.15, 0.3, 9.81, 0.02);
    for (torque, omega) in [(0.1, 3.0), (0.03, 2.0), (0.0201, 1.0)] {
        let machine = Machine {
            inverse_mass: &|_| [[1.0 / (m * l * l)]],
            forces: &|t, [theta], _| [torque * f64::sin(omega * t) - m * g * l * f64::sin(theta)],
            rubbing: &|_, _| {
                vec![DryFriction {
                    along: [1.0],
                    drift: 0.0,
                    level: t_c,
                }]
            },
        };
        let settings = [("T_0", torque), ("omega", omega)];
        for solver in GENERAL {
            let motion = simulated(&model, &settings, &[0.0, 6.0], solver);
            machine.assert_converges_to(([1.0], [0.0]), 6.0, &motion.trajectory.final_state, 5e-5);
        }
    }
}

#[test]
fn turning_points_and_rest_of_pendulum_match_energy() {
    let text = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/friction/stopped_pendulum.toml"),
    );
    let text = text.unwrap();
    let (m, l, g) = (0.15, 0.3, 9.81);
    let (inertia, weight) = (m * l * l, m * g * l);
    for (level, speed) in [(0.25, 5.0), (0.02, 5.0), (0.1, -9.0), (0.03, 14.0)] {
        // Turning points follow from the energy minus the work of weight and friction.
        let (mut from, mut energy, mut sense) =
            (0.0, 0.5 * inertia * speed * speed, f64::signum(speed));
        let turns: Vec<f64> = std::iter::from_fn(|| {
            let moves = energy > 0.0 || weight * f64::sin(from).abs() > level;
            let left = |way: f64| {
                let place: f64 = from + sense * way;
                energy - weight * (f64::cos(from) - place.cos()) - level * way
            };
            let mut far = 1e-6;
            while moves && left(far) > 0.0 {
                far += 1e-3;
            }
            let mut near = (far - 1e-3_f64).max(0.0);
            for _ in 0..100 {
                let middle = 0.5 * (near + far);
                match left(middle) > 0.0 {
                    true => near = middle,
                    false => far = middle,
                }
            }
            (from, energy, sense) = (from + sense * near, 0.0, -sense);
            moves.then_some(from)
        })
        .collect();
        let initial = format!("initial_rate = {speed}");
        let model = compile_text(&text.replace("initial = 1,", &format!("{initial},")));
        for solver in GENERAL {
            let motion = simulated(&model, &[("T_c", level)], &[0.0, 30.0], solver);
            let (last, switches) = (&motion.trajectory.final_state, &motion.trajectory.events);
            let stop = turns.last().copied().unwrap_or(0.0);
            assert!(
                (last[0] - stop).abs() < 1e-7,
                "{solver} {level} {speed}: {last:?} {stop}"
            );
            // A state drifts from its surface by at most 1e-12 of the largest speed.
            assert!(
                last[1].abs() < 1e-12 * speed.abs() && switches.len() == turns.len(),
                "{solver} {level} {speed}"
            );
        }
        // The time stepping converges to the same state. Its error is between 0 and a h^2/8 (step h, deceleration a),
        // depending on the time of the stop within a step, so it has no fixed order.
        let machine = Machine {
            inverse_mass: &|_| [[1.0 / inertia]],
            forces: &|_, [theta], _| [-weight * f64::sin(theta)],
            rubbing: &|_, _| {
                vec![DryFriction {
                    along: [1.0],
                    drift: 0.0,
                    level,
                }]
            },
        };
        let stop = turns.last().copied().unwrap_or(0.0);
        for (steps, most) in [(30_000, 1e-4), (240_000, 2e-6)] {
            let found = machine.simulate_by_time_stepping(([0.0], [speed]), 30.0, steps)[0];
            println!("{level} {speed}: {:.2e}", found - stop);
            assert!(
                (found - stop).abs() < most,
                "{level} {speed}: {found} {stop}"
            );
        }
    }
}

#[test]
fn belt_with_falling_friction_sticks_and_slips() {
    let model = example("stribeck_belt");
    let machine = Machine {
        inverse_mass: &|_| [[1.0]],
        forces: &|_, [x], _| [-100.0 * x],
        rubbing: &|_, [v]| {
            let slip = (v - 0.1) / 0.05;
            vec![DryFriction {
                along: [1.0],
                drift: 0.1,
                level: 3.0 + 2.0 * f64::exp(-slip * slip),
            }]
        },
    };
    for solver in GENERAL {
        let motion = simulated(&model, &[], &[0.0, 2.0], solver);
        machine.assert_converges_to(([0.0], [0.0]), 2.0, &motion.trajectory.final_state, 2e-5);
    }
    let motion = simulated(&model, &[], &grid(20.0, 20), Solver::Auto);
    assert_eq!(motion.solver, Solver::Rk);
    // The mass sticks and is released once per period of 0.907 s.
    let switches = &motion.trajectory.events;
    assert!(switches.len() > 40, "{}", switches.len());
}

#[test]
fn cart_and_pole_with_friction_match_time_stepping() {
    let model = example("cart_pole");
    let (big, m, l, g) = (1.0, 0.3, 0.5, 9.81);
    for (rails, pivot, push, omega) in [
        (1.5, 0.1, 3.0, 4.0),
        (0.5, 0.3, 2.0, 7.0),
        (2.5, 0.02, 3.0, 3.0),
        (3.5, 1.0, 3.0, 4.0),
    ] {
        let machine = Machine {
            inverse_mass: &|[_, phi]| {
                let [a, b, c] = [big + m, m * l * f64::cos(phi), m * l * l];
                let det = a * c - b * b;
                [[c / det, -b / det], [-b / det, a / det]]
            },
            forces: &|t, [_, phi], [_, rate]| {
                [
                    push * f64::sin(omega * t) + m * l * f64::sin(phi) * rate * rate,
                    -m * g * l * f64::sin(phi),
                ]
            },
            rubbing: &|_, _| {
                let rub = |along, level| DryFriction {
                    along,
                    drift: 0.0,
                    level,
                };
                vec![rub([1.0, 0.0], rails), rub([0.0, 1.0], pivot)]
            },
        };
        let settings = [
            ("F_c", rails),
            ("T_c", pivot),
            ("F_0", push),
            ("omega", omega),
        ];
        for solver in GENERAL {
            let motion = simulated(&model, &settings, &[0.0, 3.0], solver);
            machine.assert_converges_to(
                ([0.0, 0.6], [0.0; 2]),
                3.0,
                &motion.trajectory.final_state,
                1e-4,
            );
        }
    }
}

const SLED: &str = r#"
[model]
name = "sled"
[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
A = { value = 4, unit = "N" }
omega = { value = 5, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
sled = "1/2*m*dot(x)^2"
[forces]
rubs = { on = "x", value = "-F*sign(dot(x))" }
drive = { on = "x", value = "A*sin(omega*t)" }
"#;

#[test]
fn drive_breaks_away_a_thousand_times_at_known_times() {
    let (f, a, omega) = (3.0_f64, 4.0_f64, 5.0_f64);
    // The mass breaks away when A |sin(omega t)| = F, once per half period, and sticks in between.
    let half = std::f64::consts::PI / omega;
    let away = |turn: usize| (f / a).asin() / omega + half * turn as f64;
    let until = 1000.0 * half;
    let model = compile_text(SLED);
    for solver in [Solver::Rk, Solver::Radau, Solver::Exact] {
        let motion = simulated(&model, &[], &grid(until, 1000), solver);
        let switches = &motion.trajectory.events;
        assert_eq!(switches.len(), 2000, "{solver}");
        for (turn, pair) in switches.chunks(2).enumerate() {
            let late = pair[0].t - away(turn);
            assert!(
                late.abs() < 1e-8 * (1.0 + away(turn)),
                "{solver} {turn}: {late:e}"
            );
            assert!(pair[1].t > pair[0].t && pair[1].t < away(turn + 1));
            let to = match turn % 2 {
                0 => SurfaceMode::Positive,
                _ => SurfaceMode::Negative,
            };
            assert_eq!(
                (pair[0].from, pair[0].to),
                (SurfaceMode::Held, to),
                "{solver} {turn}"
            );
            assert_eq!(
                (pair[1].from, pair[1].to),
                (to, SurfaceMode::Held),
                "{solver} {turn}"
            );
        }
        // After every period the mass rests at the same position.
        let states = &motion.trajectory.states;
        for turn in (2..1000).step_by(2) {
            let moved = states[turn][0] - states[2][0];
            assert!(moved.abs() < 1e-7, "{solver} {turn}: {moved:e}");
            assert!(states[turn][1].abs() < 1e-12, "{solver} {turn}");
        }
    }
}

#[test]
fn two_frictions_on_one_motion_add_their_levels() {
    let text = r#"
[model]
name = "block"
[parameters]
m = { value = 1, unit = "kg" }
a = { value = 1, unit = "N" }
F = { value = 1, unit = "N" }
G = { value = 2, unit = "N" }
r = { value = 1, unit = "N/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
one = { on = "x", value = "-F*sign(dot(x))" }
other = { on = "x", value = "-G*sign(3*dot(x))" }
pull = { on = "x", value = "r*t" }
[observables]
both = { value = "-F*sign(dot(x)) - G*sign(3*dot(x))", unit = "N" }
"#
    .replace("a = { value = 1, unit = \"N\" }\n", "");
    let model = compile_text(&text);
    let run = model.with_declared_parameters().unwrap();
    for solver in GENERAL {
        let motion = simulated(&model, &[], &grid(4.0, 40), solver);
        let rows = run.observables(&motion).unwrap();
        for (t, (row, state)) in motion
            .trajectory
            .times
            .iter()
            .zip(rows.iter().zip(&motion.trajectory.states))
        {
            // The mass breaks away when r t = F + G.
            let gone = (t - 3.0).max(0.0);
            assert!(
                (state[0] - gone.powi(3) / 6.0).abs() < 1e-8,
                "{solver} {t}: {state:?}"
            );
            assert!((row[0] + t.min(3.0)).abs() < 1e-9, "{solver} {t}: {row:?}");
        }
    }
}

#[test]
fn jumps_of_force_and_belt_speed_release_the_block() {
    let text = r#"
[model]
name = "block"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 2, unit = "N" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
w = { unit = "m/s" }
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
rub = { on = "x", value = "-F*sign(dot(x) - w)" }
pull = { on = "x", value = "u" }
"#;
    let model = compile_text(text);
    let run = model.with_declared_parameters().unwrap();
    // The block sticks for 1 s, accelerates with 1 m/s^2 for 1 s, then decelerates with 2 m/s^2 to rest at 2.5 s. At 3
    // s the belt starts with 1 m/s; the block reaches this speed after 0.5 s.
    let times = vec![0.0, 1.0, 2.0, 3.0];
    let values = vec![1.5, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let inputs = HeldInputs::new(times, values, 2).unwrap();
    let samples = grid(5.0, 10);
    let wanted = [0.0, 0.0, 0.0, 0.125, 0.5, 0.75, 0.75, 1.0, 1.5, 2.0, 2.5];
    for solver in GENERAL {
        let motion = run
            .simulate(run.initial_state(), &samples, &inputs, solver)
            .unwrap();
        for (state, wanted) in motion.trajectory.states.iter().zip(wanted) {
            assert!(
                (state[0] - wanted).abs() < 1e-9,
                "{solver}: {state:?} {wanted}"
            );
        }
        let changes = motion.trajectory.events.len();
        assert!(changes >= 4, "{solver}: {changes}");
    }
}

#[test]
fn relay_holds_first_order_state_and_weighted_rate() {
    let text = r#"
[model]
name = "servo"
[parameters]
m = { value = 1, unit = "kg" }
K = { value = 4, unit = "N" }
s = { value = 0.5, unit = "s" }
T = { value = 1, unit = "s" }
U = { value = 3, unit = "V" }
g = { value = 1, unit = "V/s" }
[coordinates]
x = { unit = "m", initial = 1 }
[states]
y = { unit = "V", initial = 0.5, rate = "(-y - U*sign(y - g*t*0.2))/T" }
[kinetic]
block = "1/2*m*dot(x)^2"
[forces]
relay = { on = "x", value = "-K*sign(x + s*dot(x))" }
swing = { on = "x", value = "K*sin(x*0.3/l)" }
"#
    .replace(
        "[coordinates]",
        "l = { value = 1, unit = \"m\" }\n[coordinates]",
    );
    let model = compile_text(&text);
    for solver in GENERAL {
        let motion = simulated(&model, &[], &grid(4.0, 40), solver);
        let states = &motion.trajectory.states;
        // On the surface x + s x' = 0 the motion decays with the time constant s, and y = 0.2 t.
        for (t, pair) in motion
            .trajectory
            .times
            .iter()
            .zip(states.windows(2))
            .skip(15)
        {
            let decayed = pair[0][0] * (-0.1_f64 / 0.5).exp();
            assert!(
                (pair[1][0] - decayed).abs() < 1e-8,
                "{solver} {t}: {pair:?}"
            );
            assert!(
                (pair[0][2] - 0.2 * t).abs() < 1e-9,
                "{solver} {t}: {pair:?}"
            );
        }
    }
}

#[test]
fn friction_sticks_with_constraints_and_with_modes() {
    // A bead on a circle, by a constraint, with friction along the horizontal. The bead sticks if the weight along the
    // circle is less than the friction along the circle.
    let text = r#"
[model]
name = "bead"
[parameters]
m = { value = 1, unit = "kg" }
r = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
F = { value = 2, unit = "N" }
[coordinates]
x = { unit = "m", initial = 0.8 }
y = { unit = "m", initial = -0.6 }
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
circle = { zero = "x^2 + y^2 - r^2" }
[forces]
rub = { on = "x", value = "-F*sign(dot(x))" }
"#;
    let model = compile_text(text);
    let machine = Machine {
        inverse_mass: &|_| [[1.0]],
        forces: &|_, [a], _| [-9.81 * f64::sin(a)],
        rubbing: &|[a], _| {
            vec![DryFriction {
                along: [f64::cos(a)],
                drift: 0.0,
                level: 2.0,
            }]
        },
    };
    for solver in [Solver::Rk, Solver::Radau] {
        let motion = simulated(&model, &[], &[0.0, 6.0], solver);
        let [x, y] = [
            motion.trajectory.final_state[0],
            motion.trajectory.final_state[1],
        ];
        let angle = x.atan2(-y);
        let start = 0.8_f64.atan2(0.6);
        machine.assert_converges_to(([start], [0.0]), 6.0, &[angle, 0.0], 1e-4);
        assert!(motion.trajectory.final_state[2].abs() < 1e-10);
    }
    // A disc with a brake on an elastic shaft; the modes of the shaft continue to vibrate during sticking.
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../model-spec/models");
    let text = std::fs::read_to_string(folder.join("shaft_and_disc.toml")).unwrap();
    let brake = "brake = { on = \"theta_d\", value = \"-T_b*sign(dot(theta_d))\" }";
    let text = text
        .replace(
            "[coordinates]",
            "T_b = { value = 3, unit = \"N m\" }\n[coordinates]",
        )
        .replace("motor = {", &format!("{brake}\nmotor = {{"));
    let model = compile_text(&text);
    let run = model.with_declared_parameters().unwrap();
    let inputs = HeldInputs::new(vec![0.0, 0.05, 0.1], vec![4.0, -2.0, 1.0], 1).unwrap();
    let samples = grid(0.2, 20);
    let exact = run
        .simulate(run.initial_state(), &samples, &inputs, Solver::Exact)
        .unwrap();
    assert!(exact.trajectory.events.len() >= 3);
    for solver in [Solver::Rk, Solver::Radau] {
        let motion = run
            .simulate(run.initial_state(), &samples, &inputs, solver)
            .unwrap();
        for (a, b) in motion
            .trajectory
            .states
            .iter()
            .zip(&exact.trajectory.states)
        {
            let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-5, "{solver}: {a:?} {b:?}");
        }
    }
}

#[test]
fn adams_stops_with_message_at_sticking() {
    let model = compile_text(SLED);
    let run = model.with_declared_parameters().unwrap();
    let none = run.default_inputs();
    let error = run.simulate(run.initial_state(), &[0.0, 1.0], &none, Solver::Adams);
    let said = error
        .err()
        .map(|error| error.to_string())
        .unwrap_or_default();
    assert!(
        said.contains("it sticks, as a body at rest under dry friction"),
        "{said}"
    );
}

#[test]
fn sticking_costs_few_steps_at_tight_tolerances() {
    let model = example("cart_pole");
    let run = model.with_declared_parameters().unwrap();
    for solver in GENERAL {
        let evaluations = [1e-9, 1e-12].map(|tolerance| {
            let request = Request {
                initial: run.initial_state(),
                times: &[0.0, 10.0],
                inputs: &run.default_inputs(),
                solver,
                tolerance,
                max_step: f64::INFINITY,
                audit: false,
            };
            let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
            assert!(motion.early_stop.is_none(), "{solver}");
            motion.trajectory.statistics.evaluations
        });
        // Without rounding errors, methods of order 8 and 5 need 2.4 and 4 times as many evaluations.
        let [coarse, tight] = evaluations;
        assert!(tight < 8 * coarse, "{solver}: {evaluations:?}");
    }
}
