//! Sticking and release under dry friction in the exact solver, compared with a time-stepping scheme with
//! set-valued friction, without surfaces, regimes and events. The friction impulses of every step stay within
//! their bounds and bring the speeds as close to zero as possible.

use eomgen_model_spec::source::Source;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::PiecewiseLinear;

/// Returns the specification of a motor that drives a load through a shaft with play, with dry friction at one
/// end or both.
fn drive(more: &str) -> String {
    format!(
        r#"
[model]
name = "rubbed_drive"
[parameters]
J_m = {{ value = 1e-3, unit = "kg m^2" }}
J_l = {{ value = 5e-3, unit = "kg m^2" }}
k = {{ value = 500, unit = "N m/rad" }}
d = {{ value = 0.05, unit = "N m s/rad" }}
b = {{ value = 9e-3, unit = "rad" }}
T_l = {{ value = 0.4, unit = "N m" }}
T_m = {{ value = 0, unit = "N m" }}
T_s = {{ value = 0, unit = "N m" }}
b_m = {{ value = 2e-3, unit = "N m s" }}
T_0 = {{ value = 1, unit = "N m" }}
omega = {{ value = 20, unit = "rad/s" }}
[coordinates]
m = {{ unit = "rad" }}
l = {{ unit = "rad" }}
[definitions]
twist = "m - l"
[kinetic]
rotors = "1/2*J_m*dot(m)^2 + 1/2*J_l*dot(l)^2"
[potential]
shaft = "1/2*k*deadzone(twist, b)^2"
[dissipation]
bearing = "1/2*b_m*dot(m)^2"
[forces]
shaft_damping = {{ on = "twist", value = "-d*contact(twist, b)*dot(twist)" }}
motor = {{ on = "m", value = "T_0*sin(omega*t)" }}
load_rubs = {{ on = "l", value = "-T_l*sign(dot(l))" }}
{more}
"#
    )
}

/// Additional friction at the motor and in the shaft.
const MORE_FRICTION: &str = r#"
motor_rubs = { on = "m", value = "-T_m*sign(dot(m))" }
shaft_rubs = { on = "twist", value = "-T_s*sign(dot(m) - dot(l))" }
"#;

/// Parameters of the drive in the specification.
#[derive(Clone, Copy, Debug)]
struct Drive {
    b: f64,
    b_m: f64,
    load: f64,
    motor: f64,
    shaft: f64,
    torque: f64,
    omega: f64,
}

const PLAIN: Drive = Drive {
    b: 9e-3,
    b_m: 2e-3,
    load: 0.4,
    motor: 0.0,
    shaft: 0.0,
    torque: 1.0,
    omega: 20.0,
};

const J_M: f64 = 1e-3;
const J_L: f64 = 5e-3;
const K: f64 = 500.0;
const D: f64 = 0.05;

impl Drive {
    /// Returns the smooth torques, including the torque of the shaft.
    fn torques(&self, t: f64, [m, l]: [f64; 2], [m_dot, l_dot]: [f64; 2]) -> [f64; 2] {
        let twist = m - l;
        let beyond = (twist.abs() - self.b).max(0.0).copysign(twist);
        let touching = twist.abs() > self.b;
        let damping = if touching { D * (m_dot - l_dot) } else { 0.0 };
        let shaft = K * beyond + damping;
        let motor = self.torque * (self.omega * t).sin() - self.b_m * m_dot;
        [motor - shaft, shaft]
    }

    /// Returns the state after a number of steps: coordinates, then rates.
    fn simulate_by_steps(&self, until: f64, steps: u32) -> [f64; 4] {
        let h = until / f64::from(steps);
        let rubbed = [
            ([0.0, 1.0], self.load),
            ([1.0, 0.0], self.motor),
            ([1.0, -1.0], self.shaft),
        ];
        let rubbed: Vec<_> = rubbed
            .into_iter()
            .filter(|(_, level)| *level > 0.0)
            .collect();
        let mut impulses = vec![0.0; rubbed.len()];
        let (mut q, mut v) = ([0.0; 2], [0.0; 2]);
        for step in 0..steps {
            let middle = [q[0] + 0.5 * h * v[0], q[1] + 0.5 * h * v[1]];
            let t = (f64::from(step) + 0.25) * h;
            let mut next = v;
            // Damping uses the mean speed of the step, so it is iterated.
            for _ in 0..3 {
                let mean = [0.5 * (v[0] + next[0]), 0.5 * (v[1] + next[1])];
                let torques = self.torques(t, middle, mean);
                let free = [v[0] + h * torques[0] / J_M, v[1] + h * torques[1] / J_L];
                next = apply_friction(free, h, &rubbed, &mut impulses);
            }
            for index in 0..2 {
                q[index] += 0.5 * h * (v[index] + next[index]);
            }
            v = next;
        }
        [q[0], q[1], v[0], v[1]]
    }

    fn values(&self) -> [f64; 11] {
        let own = [
            self.load,
            self.motor,
            self.shaft,
            self.b_m,
            self.torque,
            self.omega,
        ];
        let [load, motor, shaft, b_m, torque, omega] = own;
        [
            J_M, J_L, K, D, self.b, load, motor, shaft, b_m, torque, omega,
        ]
    }
}

/// Returns the speeds after the friction impulses of a step. Each impulse is within its bounds. If it is not at
/// a bound, its speed is zero.
fn apply_friction(
    free: [f64; 2],
    h: f64,
    rubbed: &[([f64; 2], f64)],
    impulses: &mut [f64],
) -> [f64; 2] {
    let yields = [1.0 / J_M, 1.0 / J_L];
    let mut v = free;
    for ((along, _), impulse) in rubbed.iter().zip(impulses.iter()) {
        for index in 0..2 {
            v[index] += yields[index] * along[index] * impulse;
        }
    }
    for _ in 0..if rubbed.len() > 1 { 200 } else { 1 } {
        let mut changed: f64 = 0.0;
        for ((along, level), impulse) in rubbed.iter().zip(impulses.iter_mut()) {
            let speed = along[0] * v[0] + along[1] * v[1];
            let yielding = along[0] * along[0] * yields[0] + along[1] * along[1] * yields[1];
            let bound = level * h;
            let wanted = (*impulse - speed / yielding).clamp(-bound, bound);
            for index in 0..2 {
                v[index] += yields[index] * along[index] * (wanted - *impulse);
            }
            changed = changed.max((wanted - *impulse).abs() / bound);
            *impulse = wanted;
        }
        if changed < 1e-13 {
            break;
        }
    }
    v
}

fn equations(more: &str) -> PiecewiseLinear {
    let source = Source::new("drive.toml", drive(more));
    let checked =
        eomgen_model_spec::check(source).unwrap_or_else(|e| panic!("{}", e.render(false)));
    PiecewiseLinear::derive(&checked.model, &[]).expect("a piecewise-linear model")
}

/// Returns the state at the end and the number of events.
fn simulate_exactly(equations: &PiecewiseLinear, drive: &Drive, until: f64) -> (Vec<f64>, usize) {
    let mut propagator = equations
        .propagator_at(&drive.values())
        .expect("a propagator");
    let none = HeldInputs::zero(0);
    let found = propagator.simulate(&[0.0; 4], (0.0, until), &[], &none, &mut |_| {});
    let found = found.unwrap_or_else(|error| panic!("{drive:?}: {error}"));
    (found.final_state, found.events.len())
}

/// Asserts that the time stepping converges to the exact motion. The largest difference, relative to the
/// largest angles and speeds, is of first order: it falls below a third for steps of an eighth, and is small
/// for the shortest steps.
fn assert_agreement(drive: &Drive, until: f64) {
    let (wanted, _) = simulate_exactly(&equations(MORE_FRICTION), drive, until);
    let sizes = [0.1, 0.1, 10.0, 10.0];
    let difference = |steps: u32| {
        let found = drive.simulate_by_steps(until, steps);
        let pairs = found.iter().zip(&wanted).zip(sizes);
        pairs.fold(0.0_f64, |worst, ((a, b), size)| {
            worst.max((a - b).abs() / size)
        })
    };
    let coarse = (until / 2e-6) as u32;
    let (before, after) = (difference(coarse), difference(8 * coarse));
    println!("{drive:?}: {before:.2e} {after:.2e}");
    assert!(after < 1e-4, "{drive:?}: {before:e} {after:e}");
    assert!(
        after < 0.3 * before || after < 1e-7,
        "{drive:?}: {before:e} {after:e}"
    );
}

#[test]
fn drives_of_a_parameter_grid_match_time_stepping() {
    let equations = equations("");
    for torque in 0..17 {
        for omega in 0..10 {
            let drive = Drive {
                torque: 0.4 + 0.1 * f64::from(torque),
                omega: 5.0 * f64::from(omega + 1),
                b: 0.5_f64.to_radians(),
                ..PLAIN
            };
            let (_, switches) = simulate_exactly(&equations, &drive, 10.0);
            // A few events occur per turn of the motor, and more if the shaft bounces in its play.
            assert!(switches < 10 * 500, "{drive:?}: {switches} switches");
        }
    }
}

#[test]
fn load_breaking_away_matches_time_stepping() {
    for (torque, omega) in [
        (0.6, 15.0),
        (0.6, 20.0),
        (0.5, 35.0),
        (1.0, 50.0),
        (2.0, 5.0),
    ] {
        assert_agreement(
            &Drive {
                torque,
                omega,
                ..PLAIN
            },
            0.25,
        );
    }
}

#[test]
fn torque_near_friction_level_matches_time_stepping() {
    for part in [0.0, 1e-15, 1e-9, 1e-3, -1e-15, -1e-9] {
        let torque = 0.4 * (1.0 + part);
        // Without play the shaft transmits the torque at once.
        for b in [0.0, 1e-5] {
            assert_agreement(
                &Drive {
                    torque,
                    b,
                    omega: 30.0,
                    ..PLAIN
                },
                0.2,
            );
        }
    }
}

#[test]
fn drives_without_play_or_damping_match_time_stepping() {
    assert_agreement(&Drive { b: 0.0, ..PLAIN }, 0.25);
    for b_m in [0.0, 1e-12, 1e-7] {
        assert_agreement(
            &Drive {
                b_m,
                torque: 0.7,
                ..PLAIN
            },
            0.25,
        );
    }
}

#[test]
fn two_and_three_frictions_match_time_stepping() {
    for (motor, shaft) in [(0.2, 0.0), (0.4, 0.0), (0.0, 0.1), (0.3, 0.2)] {
        for omega in [12.0, 40.0] {
            assert_agreement(
                &Drive {
                    motor,
                    shaft,
                    omega,
                    torque: 1.3,
                    ..PLAIN
                },
                0.2,
            );
        }
    }
}
