//! Tests of trial steps that leave the domain of a function or overflow although the motion does not. They compare with
//! closed forms, and for an orifice with SciPy (LSODA and Radau at 1e-11, which agree to nine digits).

use eomgen_compiled_model::{CompiledModel, Solver};

use super::{GENERAL, compile_text, simulated};

const STEPPING: [Solver; 3] = [Solver::Rk, Solver::Radau, Solver::Adams];

/// Returns a mass on a spring, damped by an orifice with the flow law `law`.
fn orifice(law: &str) -> CompiledModel {
    compile_text(&format!(
        r#"
[model]
name = "orifice"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 40, unit = "N/m" }}
A = {{ value = 1e-3, unit = "m^2" }}
C = {{ value = 2e-12, unit = "m^3/Pa" }}
k_v = {{ value = 1e-6, unit = "m^3/(s Pa^(1/2))" }}
[coordinates]
x = {{ unit = "m", initial = 0.1 }}
[states]
p = {{ unit = "Pa", rate = "(A*dot(x) - k_v*{law})/C" }}
[kinetic]
m = "1/2*m*dot(x)^2"
[potential]
k = "1/2*k*x^2"
[forces]
piston = {{ on = "x", value = "-A*p" }}
"#
    ))
}

/// Times of deflection, rate and pressure of the orifice, s. The mass starts at rest at 0.1 m with a given pressure.
const TIMES: [f64; 5] = [0.0, 0.01, 0.1, 0.5, 1.0];
const ORIFICE: [(f64, [[f64; 3]; 4]); 3] = [
    (
        1000.0,
        [
            [0.09981145981, -0.03550681779, -1233.398709],
            [0.09442999214, -0.06161612933, -3797.153518],
            [0.07138315169, -0.05361774773, -2875.322868],
            [0.04707387787, -0.04361934754, -1902.951915],
        ],
    ),
    (
        0.0,
        [
            [0.0998118292, -0.03547797298, -1231.376387],
            [0.09443063459, -0.06161633738, -3797.179159],
            [0.07138371074, -0.05361795623, -2875.34523],
            [0.04707433268, -0.04361955604, -1902.970107],
        ],
    ),
    (
        -1e5,
        [
            [0.1001530959, -0.004507058787, -19.69038609],
            [0.09512931217, -0.06184197034, -3825.037049],
            [0.0719918611, -0.05384428802, -2899.671244],
            [0.04756931713, -0.04384588783, -1922.769486],
        ],
    ),
];

fn assert_agrees_with_scipy(law: &str, solvers: &[Solver], starts: usize) {
    let model = orifice(law);
    let run = model.with_declared_parameters().unwrap();
    for (pressure, right) in ORIFICE.into_iter().take(starts) {
        for solver in solvers {
            let initial = [0.1, 0.0, pressure];
            let motion = run.simulate(&initial, &TIMES, &run.default_inputs(), *solver);
            let motion =
                motion.unwrap_or_else(|error| panic!("{law}, {solver}, {pressure}: {error}"));
            // Errors are relative to the largest magnitude of a state.
            let sizes = [0.1, 0.1, pressure.abs().max(4000.0)];
            for (state, right) in motion.trajectory.states[1..].iter().zip(right) {
                for ((value, right), size) in state.iter().zip(right).zip(sizes) {
                    let off = (value - right).abs() / size;
                    assert!(off < 2e-8, "{law}, {solver}, {pressure}: {value} {right}");
                }
            }
        }
    }
}

#[test]
fn orifice_flow_reversal_matches_scipy() {
    assert_agrees_with_scipy("sign(p)*sqrt(abs(p))", &STEPPING, 2);
    assert_agrees_with_scipy("sign(p)*sqrt(abs(p))", &GENERAL, 3);
    assert_agrees_with_scipy("sign(p)*abs(p)^0.5", &GENERAL, 3);
}

/// After a pulse of pressure, the flow reverses at each end of the swing. Pressure and speed vanish together there.
#[test]
fn many_flow_reversals_match_scipy() {
    let model = orifice("sign(p)*sqrt(abs(p))");
    let run = model.with_declared_parameters().unwrap();
    let right = [
        [-0.002955238307, -0.04177712003, -1772.652808],
        [-0.004200321087, -0.001746957389, -3.056043997],
        [-0.0007646415664, 0.007098148746, 50.3917004],
        [0.0003171976985, -0.002219041077, -4.923837063],
    ];
    for solver in [Solver::Radau, Solver::Auto] {
        let motion = run.simulate(&[0.0, 0.0, 1e6], &TIMES, &run.default_inputs(), solver);
        let motion = motion.unwrap_or_else(|error| panic!("{solver}: {error}"));
        for (state, right) in motion.trajectory.states[1..].iter().zip(right) {
            for ((value, right), size) in state.iter().zip(right).zip([0.01, 1.0, 1e6]) {
                let off = (value - right).abs() / size;
                assert!(off < 2e-8, "{solver}: {value} {right}");
            }
        }
    }
}

#[test]
fn laws_undefined_beyond_their_sign_change_match_scipy() {
    assert_agrees_with_scipy("sign(p)*sqrt(p*sign(p))", &GENERAL, 2);
    assert_agrees_with_scipy("(sqrt(max(p, 0)) - sqrt(max(-p, 0)))", &GENERAL, 3);
}

/// A mass at rest with cubic damping is pushed from the time a = 3 s on: v = sqrt(F/c) tanh(sqrt(F c)(t - a)). The test
/// uses several units of the deflection. Steps are long before the push.
#[test]
fn overflowing_steps_after_a_push_are_shortened() {
    let model = compile_text(
        r#"
[model]
name = "step"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 30, unit = "N" }
a = { value = 3, unit = "s" }
c = { value = 1, unit = "N s^2/m^2" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "F*above(t - a)" }
damper = { on = "x", value = "-c*dot(x)*abs(dot(x))" }
"#,
    );
    let times = [0.0, 2.0, 4.0, 10.0];
    for scale in [1e-6, 1.0, 1e6] {
        for solver in STEPPING {
            let settings = [("F", 30.0 * scale), ("c", 1.0 / scale)];
            let motion = simulated(&model, &settings, &times, solver);
            for (t, state) in times.iter().zip(&motion.trajectory.states) {
                let since = 30.0_f64.sqrt() * (t - 3.0).max(0.0);
                let right = [
                    scale * since.cosh().ln(),
                    scale * 30.0_f64.sqrt() * since.tanh(),
                ];
                for (value, right) in state.iter().zip(right) {
                    let off = (value - right).abs();
                    assert!(off <= 2e-8 * right, "{solver} at {t}: {value:e} {right:e}");
                }
            }
        }
    }
}

/// States start at or near the edge of the domain of their rates. For z' = -z ln z, ln z decays. For z' = -arcsin z
/// from 1, the slope is infinite at the start.
#[test]
fn states_starting_at_edge_of_domain_match_closed_forms() {
    let model = compile_text(
        r#"
[model]
name = "edges"
[coordinates]
x = { unit = "m" }
[states]
l = { unit = "1", rate = "-l*ln(l)/T", initial = 1e-6 }
s = { unit = "1", rate = "-asin(s)/T", initial = 1 }
[parameters]
m = { value = 1, unit = "kg" }
T = { value = 1, unit = "s" }
[kinetic]
m = "1/2*m*dot(x)^2"
"#,
    );
    let times = [0.0, 0.5, 1.0, 2.0];
    // Reference values with s = sin u, by quadrature of cos u/u.
    let right = [
        1.0,
        0.561_217_178_396_959_3,
        0.334_289_066_948_184_83,
        0.121_970_917_335_998_02,
    ];
    for solver in STEPPING {
        let motion = simulated(&model, &[], &times, solver);
        for ((t, state), right) in times.iter().zip(&motion.trajectory.states).zip(right) {
            let decayed = (1e-6_f64.ln() * (-t).exp()).exp();
            assert!(
                (state[2] / decayed - 1.0).abs() < 1e-7,
                "{solver} at {t}: {state:?}"
            );
            assert!(
                (state[3] - right).abs() < 1e-8,
                "{solver} at {t}: {state:?}"
            );
        }
    }
}

/// sqrt(0.5 - t) is undefined after 0.5 s; the message must name the state and the cause.
#[test]
fn leaving_the_domain_stops_with_state_and_cause() {
    let model = compile_text(
        r#"
[model]
name = "out"
[coordinates]
x = { unit = "m" }
[states]
z = { unit = "1", rate = "sqrt(1 - t/T)/T" }
[parameters]
m = { value = 1, unit = "kg" }
T = { value = 0.5, unit = "s" }
[kinetic]
m = "1/2*m*dot(x)^2"
"#,
    );
    let run = model.with_declared_parameters().unwrap();
    for solver in STEPPING {
        let error = run.simulate(
            run.initial_state(),
            &[0.0, 1.0],
            &run.default_inputs(),
            solver,
        );
        let said = error
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default();
        for part in ["at t = 0.", "left its domain", "`z`"] {
            assert!(said.contains(part), "{solver}: {said}");
        }
    }
}

/// h' = -k sign(h) |h|^a from h = b has the solution b (1 - t/T)^(1/(1 - a)). It ends at T = b^(1 - a)/(k (1 - a)) at
/// rest at 0, where the slope of the rate is infinite.
#[test]
fn states_that_end_at_zero_of_root_stay_there() {
    let laws = [
        ("sign(h)*sqrt(abs(h))", "m^(1/2)", 0.5),
        ("sign(h)*abs(h)^0.3", "m^(7/10)", 0.3),
        ("sqrt(max(h, 0))", "m^(1/2)", 0.5),
        ("h/sqrt(abs(h) + 1e-300*b)", "m^(1/2)", 0.5),
    ];
    for (law, unit, power) in laws {
        let model = compile_text(&format!(
            r#"
[model]
name = "tank"
[coordinates]
x = {{ unit = "m" }}
[states]
h = {{ unit = "m", rate = "-k*{law}", initial = "b" }}
[parameters]
m = {{ value = 1, unit = "kg" }}
b = {{ value = 1, unit = "m" }}
k = {{ value = 1, unit = "{unit}/s" }}
[kinetic]
m = "1/2*m*dot(x)^2"
"#
        ));
        for size in [1e-6, 1.0, 1e6] {
            let k = f64::powf(size, 1.0 - power);
            let duration = 1.0 / (1.0 - power);
            let times = [0.0, 0.5, 1.0, 0.99 * duration, 2.0 * duration];
            for solver in [Solver::Radau, Solver::Auto] {
                let motion = simulated(&model, &[("b", size), ("k", k)], &times, solver);
                for (t, state) in times.iter().zip(&motion.trajectory.states) {
                    let right = size * (1.0 - t / duration).max(0.0).powf(duration);
                    assert!(
                        (state[2] - right).abs() < 3e-8 * size,
                        "{law}, {solver}, {size:e} at {t}: {:e} {right:e}",
                        state[2]
                    );
                }
            }
        }
    }
}

/// The force -c sign(v) sqrt(|v|) stops a mass after the distance 2 v0^(3/2)/(3 c).
#[test]
fn root_drag_stops_mass() {
    let model = compile_text(
        r#"
[model]
name = "drag"
[parameters]
m = { value = 1, unit = "kg" }
c = { value = 1, unit = "N s^(1/2)/m^(1/2)" }
[coordinates]
x = { unit = "m", initial_rate = 1 }
[kinetic]
m = "1/2*m*dot(x)^2"
[forces]
drag = { on = "x", value = "-c*sign(dot(x))*sqrt(abs(dot(x)))" }
"#,
    );
    for solver in GENERAL {
        let motion = simulated(&model, &[], &[0.0, 1.9, 2.1], solver);
        let [_, moving, stopped] = &motion.trajectory.states[..] else {
            panic!("three states");
        };
        assert!(
            (moving[1] - 0.05_f64.powi(2)).abs() < 1e-8,
            "{solver}: {moving:?}"
        );
        assert!(
            (stopped[0] - 2.0 / 3.0).abs() < 1e-8,
            "{solver}: {stopped:?}"
        );
        assert!(stopped[1].abs() < 2e-9, "{solver}: {stopped:?}");
    }
}

/// Three chambers exchange their contents through roots of the differences. Their contents become equal at the same
/// time, so several surfaces are reached at once.
#[test]
fn chambers_joined_by_orifices_come_to_rest_together() {
    let model = compile_text(
        r#"
[model]
name = "joined"
[coordinates]
x = { unit = "m" }
[states]
a = { unit = "m", rate = "-k*sign(a - b)*sqrt(abs(a - b))", initial = 1 }
b = { unit = "m", rate = "k*sign(a - b)*sqrt(abs(a - b)) - k*sign(b - c)*sqrt(abs(b - c))" }
c = { unit = "m", rate = "k*sign(b - c)*sqrt(abs(b - c))" }
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "m^(1/2)/s" }
[kinetic]
m = "1/2*m*dot(x)^2"
"#,
    );
    let times = [0.0, 0.5, 1.0, 3.0, 20.0];
    // Reference: SciPy, LSODA at 1e-12; at the end, the mean of the contents.
    let right = [
        [1.0, 0.0, 0.0],
        [0.60552625754, 0.25120973860, 0.14326400387],
        [0.39341686114, 0.32439824635, 0.28218489251],
        [1.0 / 3.0; 3],
        [1.0 / 3.0; 3],
    ];
    for solver in [Solver::Radau, Solver::Auto] {
        let motion = simulated(&model, &[], &times, solver);
        for ((t, state), right) in times.iter().zip(&motion.trajectory.states).zip(right) {
            for (value, right) in state[2..].iter().zip(right) {
                assert!((value - right).abs() < 3e-8, "{solver} at {t}: {state:?}");
            }
        }
    }
}
