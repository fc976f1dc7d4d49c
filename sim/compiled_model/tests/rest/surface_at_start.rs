//! Tests of motions with a fast state that start on a switching surface.

use super::{GENERAL, compile_text, grid, simulated};

/// Motor whose switched voltage is on its surface at time 0; its current settles within 50 us.
const MOTOR: &str = r#"
[model]
name = "motor"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 50, unit = "N/m" }
R = { value = 2, unit = "ohm" }
L = { value = 0.1, unit = "mH" }
K = { value = 5, unit = "N/A" }
tau = { value = 1, unit = "s" }
U = { value = 12, unit = "V" }
[coordinates]
x = { unit = "m" }
[states]
i = { unit = "A", rate = "(VOLTAGE - R*i - K*dot(x))/L" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
coil = { on = "x", value = "K*i" }
"#;

#[test]
fn fast_state_follows_the_side_after_the_start() {
    for (voltage, until) in [
        ("U*sign(sin(30*t/tau))", 0.5),
        ("U*(2*above(sin(30*t/tau)) - 1)", 0.5),
        ("-U*sign(t/tau)", 0.3),
        ("U*sign(t/tau - 1/10)", 0.3),
    ] {
        let model = compile_text(&MOTOR.replace("VOLTAGE", voltage));
        let times = grid(until, 10);
        let [explicit, implicit] =
            GENERAL.map(|solver| simulated(&model, &[], &times, solver).trajectory.states);
        for (found, right) in explicit.iter().flatten().zip(implicit.iter().flatten()) {
            assert!(
                (found - right).abs() < 1e-6 * right.abs().max(1e-2),
                "{voltage}: {found}, {right}"
            );
        }
    }
}
