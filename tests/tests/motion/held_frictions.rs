//! Tests of machines that stick by dry friction: levers of any length, loads with short peaks, and first-order states
//! whose rate depends on a speed that is zero during sticking.

use eomgen_compiled_model::{Motion, Solver};
use eomgen_tests::motions::{difference, grid, simulate_to_end};

const TOLERANCE: f64 = 1e-9;

fn simulate(text: &str, solver: Solver, times: &[f64], max_step: f64) -> Motion {
    simulate_to_end(text, times, solver, (TOLERANCE, max_step))
}

/// Asserts that the states `places` of two motions differ by at most `error` times their largest magnitudes.
fn assert_equal(found: &Motion, right: &Motion, places: &[usize], error: f64, what: &str) {
    let [found, right] = [found, right].map(|motion| {
        let states = motion.trajectory.states.iter();
        let selected = states.map(|state| places.iter().map(|place| state[*place]).collect());
        selected.collect::<Vec<Vec<f64>>>()
    });
    let worst = difference(&found, &right, 0.0);
    assert!(worst <= error, "{what}: {worst:e}");
}

/// Returns a carriage with friction and an unbalanced rotor with friction. The torque on the rotor is three times its
/// friction.
fn rotor(lever: f64) -> String {
    let inertia = lever * lever;
    format!(
        r#"
[model]
name = "rotor"
[parameters]
m = {{ value = 1, unit = "kg" }}
J = {{ value = {inertia:e}, unit = "kg m^2" }}
s = {{ value = {:e}, unit = "kg m" }}
F = {{ value = {:e}, unit = "N" }}
T = {{ value = {inertia:e}, unit = "N m" }}
w = {{ value = 1, unit = "rad/s" }}
[coordinates]
x = {{ unit = "m" }}
theta = {{ unit = "rad" }}
[kinetic]
all = "1/2*m*dot(x)^2 + 1/2*J*dot(theta)^2 + s*dot(x)*dot(theta)"
[forces]
slide = {{ on = "x", value = "-F*sign(dot(x))" }}
bearing = {{ on = "theta", value = "-T*sign(dot(theta)) + 3*T*sin(w*t)" }}
"#,
        0.5 * lever,
        4.0 * lever
    )
}

#[test]
fn breakaway_does_not_depend_on_the_length_of_a_lever() {
    let times = grid(2.0, 40);
    let release = (1.0_f64 / 3.0).asin();
    for solver in [Solver::Rk, Solver::Radau, Solver::Exact] {
        let right = simulate(&rotor(1.0), solver, &times, f64::INFINITY);
        for (time, state) in times.iter().zip(&right.trajectory.states) {
            let is_released = state[1].abs() > 1e-12;
            assert_eq!(
                is_released,
                *time > release,
                "{solver}, {time} s: {state:?}"
            );
        }
        for lever in [1e-6, 1e-4, 1e-3, 1e-2, 1e3] {
            let found = simulate(&rotor(lever), solver, &times, f64::INFINITY);
            assert_equal(
                &found,
                &right,
                &[1, 3],
                1e-7,
                &format!("{solver}, {lever:e} m"),
            );
        }
    }
}

/// Simulates a mass on a spring with friction and hysteresis, driven by two sines with the angular frequencies `rates`
/// (rad/s). The load can exceed the friction for a short time within a long step.
fn driven(
    [m, k, friction]: [f64; 3],
    drives: [f64; 2],
    rates: [f64; 2],
    stiffness: f64,
    rate: f64,
) -> String {
    format!(
        r#"
[model]
name = "driven"
[parameters]
m = {{ value = {m}, unit = "kg" }}
k = {{ value = {k}, unit = "N/m" }}
F = {{ value = {friction}, unit = "N" }}
A = {{ value = {}, unit = "N" }}
B = {{ value = {}, unit = "N" }}
v = {{ value = {}, unit = "rad/s" }}
w = {{ value = {}, unit = "rad/s" }}
h = {{ value = {stiffness}, unit = "N/m" }}
H = {{ value = 1, unit = "N" }}
[coordinates]
x = {{ unit = "m", initial = 0.02, initial_rate = {rate} }}
[states]
z = {{ unit = "N", rate = "h*dot(x) - h/H*abs(dot(x))*z" }}
[kinetic]
all = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
drive = {{ on = "x", value = "-F*sign(dot(x)) + A*sin(v*t) + B*sin(w*t) - z" }}
"#,
        drives[0], drives[1], rates[0], rates[1]
    )
}

#[test]
fn short_load_peaks_release_a_sticking_mass() {
    let machines = [
        driven(
            [1.3221785807175488, 82.24972820084987, 2.658672394846581],
            [1.5771948708106864, 0.6082760210469997],
            [5.406699953603807, 18.309878560699843],
            979.0870370408538,
            -0.7925346218433929,
        ),
        driven(
            [1.967532287556495, 29.814077901882328, 2.396455786583515],
            [1.9677234866488849, 0.9533785961331258],
            [5.847981417465044, 28.384859880845333],
            327.31823910712797,
            0.9895603626777179,
        ),
        driven(
            [0.6252807817303785, 51.02737541609534, 2.304385410940349],
            [1.3227193415500247, 0.9593672183691331],
            [8.910296153094414, 24.847330814617575],
            572.3565188531504,
            0.654012639158295,
        ),
    ];
    let times = grid(10.0, 40);
    for text in machines {
        let right = simulate(&text, Solver::Rk, &times, 0.01);
        let found = simulate(&text, Solver::Rk, &times, f64::INFINITY);
        assert_equal(&found, &right, &[0, 2], 1e-6, &text);
    }
}

#[test]
fn hysteresis_between_two_sticking_masses_ends() {
    for (drive, rate) in [(4.1, 3.3), (3.6, 2.1), (5.2, 4.7)] {
        let text = format!(
            r#"
[model]
name = "pair"
[parameters]
m = {{ value = 0.7, unit = "kg" }}
n = {{ value = 1.77, unit = "kg" }}
k = {{ value = 164.6, unit = "N/m" }}
c = {{ value = 88.3, unit = "N/m" }}
F = {{ value = 1.74, unit = "N" }}
G = {{ value = 1.62, unit = "N" }}
h = {{ value = 1373, unit = "N/m" }}
H = {{ value = 1.64, unit = "N" }}
A = {{ value = {drive}, unit = "N" }}
w = {{ value = {rate}, unit = "rad/s" }}
[coordinates]
x = {{ unit = "m", initial = -0.02, initial_rate = 0.67 }}
y = {{ unit = "m", initial_rate = -0.13 }}
[states]
z = {{ unit = "N", rate = "h*(dot(y) - dot(x))*(1 - z/H*sign(dot(y) - dot(x)))" }}
[kinetic]
all = "1/2*m*dot(x)^2 + 1/2*n*dot(y)^2"
[potential]
all = "1/2*k*x^2 + 1/2*c*(y - x)^2"
[forces]
x = {{ on = "x", value = "-F*sign(dot(x))" }}
y = {{ on = "y", value = "-G*sign(dot(y)) + A*sin(w*t)" }}
z = {{ on = "y - x", value = "-z" }}
"#
        );
        let times = grid(5.0, 50);
        let found = simulate(&text, Solver::Rk, &times, f64::INFINITY);
        let right = simulate(&text, Solver::Radau, &times, f64::INFINITY);
        assert_equal(&found, &right, &[0, 1, 4], 1e-6, &text);
    }
}

#[test]
fn carried_block_at_its_friction_bound_stops_with_the_block_below() {
    for case in 0..12 {
        let (lower, upper) = (0.8 + 0.37 * f64::from(case), 2.7 - 0.19 * f64::from(case));
        let (friction, speed) = (0.3 + 0.06 * f64::from(case % 5), 0.75);
        let text = format!(
            r#"
[model]
name = "stack"
[parameters]
g = {{ value = 9.81, unit = "m/s^2" }}
mu = {{ value = {friction} }}
m = {{ value = {lower}, unit = "kg" }}
n = {{ value = {upper}, unit = "kg" }}
[coordinates]
x = {{ unit = "m", initial_rate = {speed} }}
y = {{ unit = "m", initial_rate = {speed} }}
[kinetic]
k = "1/2*m*dot(x)^2 + 1/2*n*dot(y)^2"
[forces]
floor = {{ on = "x", value = "-mu*g*(m + n)*sign(dot(x))" }}
between = {{ on = "y - x", value = "-mu*g*n*sign(dot(y) - dot(x))" }}
"#
        );
        let right = speed * speed / (2.0 * friction * 9.81);
        for solver in [Solver::Rk, Solver::Radau, Solver::Exact] {
            let motion = simulate(&text, solver, &[0.0, 0.5], f64::INFINITY);
            let found = motion.trajectory.states.last().expect("a sample");
            let places = (found[0] - right).abs().max((found[1] - right).abs());
            let rates = found[2].abs().max(found[3].abs());
            assert!(places < 1e-9 && rates < 1e-9, "{solver}: {found:?}\n{text}");
        }
    }
}
