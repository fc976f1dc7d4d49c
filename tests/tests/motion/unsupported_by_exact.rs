//! Tests of motions that the exact solver does not support: `auto` selects another solver.

use eomgen_compiled_model::{Motion, Solver, SolverChoice};
use eomgen_tests::motions::simulate_declared;

/// Returns a damped mass at rest on the switching surface of a relay force, and a moving oscillator.
fn relay(mass: f64, force: f64, damping: f64) -> String {
    format!(
        "[model]\nname = \"relay\"\n[parameters]\nm = {{ value = {mass}, unit = \"kg\" }}\n\
         F = {{ value = {force}, unit = \"N\" }}\nc = {{ value = {damping}, unit = \"N s/m\" }}\n\
         k = {{ value = 4, unit = \"N/m\" }}\n[coordinates]\nx = {{ unit = \"m\" }}\n\
         y = {{ unit = \"m\", initial = 0.3 }}\n[kinetic]\nx = \"1/2*m*dot(x)^2\"\ny = \"1/2*m*dot(y)^2\"\n\
         [potential]\nspring = \"1/2*k*y^2\"\n[forces]\n\
         relay = {{ on = \"x\", value = \"-F*sign(x) - c*dot(x)\" }}\n"
    )
}

const MACHINES: [[f64; 3]; 4] = [
    [1.761, 3.045, 3.894],
    [7.672, 3.019, 6.993],
    [0.114, 0.854, 7.704],
    [0.867, 0.311, 1.223],
];

const TIMES: [f64; 4] = [0.0, 0.5, 1.0, 2.0];

fn simulate(text: &str, solver: Solver) -> Motion {
    simulate_declared(text, &TIMES, solver, (1e-9, f64::INFINITY))
}

#[test]
fn auto_simulates_motions_with_too_many_switches_for_exact() {
    for [mass, force, damping] in MACHINES {
        let text = relay(mass, force, damping);
        let name = format!("{mass} kg, {force} N, {damping} N s/m");
        let exact = simulate(&text, Solver::Exact);
        assert!(exact.early_stop.is_some(), "{name}: exact follows it");
        let motion = simulate(&text, Solver::Auto);
        assert_eq!(motion.early_stop, None, "{name}");
        assert_eq!(motion.solver, Solver::Rk, "{name}");
        let choice = &motion.solver_choice;
        assert!(
            matches!(choice, Some(SolverChoice::NotSupportedByExact(_))),
            "{name}: {choice:?}"
        );
        for (t, state) in TIMES.iter().zip(&motion.trajectory.states) {
            let expected = 0.3 * ((4.0 / mass).sqrt() * t).cos();
            assert!((state[1] - expected).abs() < 1e-7, "{name}: {state:?}");
            assert!(state[0].abs() < 1e-9, "{name}: {state:?}");
        }
    }
}
