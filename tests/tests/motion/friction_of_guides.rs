//! Tests of friction proportional to the force of a guide, compared with closed forms. Two contacts without play
//! replace the constraint of the guide.

use eomgen_compiled_model::Solver;
use eomgen_tests::motions::simulate_to_end;

/// Returns the final states of the motions computed by `rk` and `radau`.
fn simulate(text: &str, until: f64) -> [Vec<f64>; 2] {
    [Solver::Rk, Solver::Radau].map(|solver| {
        let motion = simulate_to_end(text, &[0.0, until], solver, (1e-10, f64::INFINITY));
        motion.trajectory.states[1].clone()
    })
}

#[test]
fn bead_on_a_wire_loses_speed_by_the_angle_it_passes() {
    for (friction, speed) in [(0.1, 2.0_f64), (0.4, -3.0), (1.5, 5.0)] {
        let text = format!(
            r#"
[model]
name = "bead"
[parameters]
m = {{ value = 0.1, unit = "kg" }}
R = {{ value = 0.5, unit = "m" }}
mu = {{ value = {friction}, unit = "1" }}
[coordinates]
x = {{ unit = "m", initial_rate = {speed:?} }}
y = {{ unit = "m", initial = "-R" }}
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2)"
[impacts]
outer = {{ when = "R - sqrt(x^2 + y^2)", restitution = 0, friction = "mu", slip = "(x*dot(y) - y*dot(x))/R" }}
inner = {{ when = "sqrt(x^2 + y^2) - R", restitution = 0, friction = "mu", slip = "(x*dot(y) - y*dot(x))/R" }}
"#
        );
        let (until, radius) = (1.5_f64, 0.5_f64);
        // v' = -mu v^2/R.
        let passed = (1.0 + friction * speed.abs() * until / radius).ln() / friction;
        let angle = passed * speed.signum();
        let rate = speed / (1.0 + friction * speed.abs() * until / radius);
        let expected = [
            radius * angle.sin(),
            -radius * angle.cos(),
            rate * angle.cos(),
            rate * angle.sin(),
        ];
        for found in simulate(&text, until) {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-7, "{found} {expected}");
            }
        }
    }
}

/// A drawer slides on two pads at the distance `a` on both sides; a force F pulls it at the distance `e` from the
/// guide. The normal force of each pad is F e/(2 a), so the friction is mu F e/a.
#[test]
fn drawer_on_two_pads_jams_if_the_force_acts_far_outside() {
    let (mass, half, force, friction) = (2.0_f64, 0.2_f64, 3.0_f64, 0.5_f64);
    for offset in [0.0_f64, 0.1, 0.3, 0.6] {
        for speed in [0.0_f64, 1.0, -1.0] {
            let pads = ["l", "r"].map(|side| {
                let sign = if side == "l" { "+" } else { "-" };
                let friction = "restitution = 0, friction = \"mu\", slip = \"dot(x)\"";
                format!(
                    "{side}_low = {{ when = \"y {sign} a*phi\", {friction} }}\n\
                     {side}_high = {{ when = \"-(y {sign} a*phi)\", {friction} }}\n"
                )
            });
            let text = format!(
                r#"
[model]
name = "drawer"
[parameters]
m = {{ value = {mass:?}, unit = "kg" }}
J = {{ value = 0.05, unit = "kg*m^2" }}
a = {{ value = {half:?}, unit = "m" }}
e = {{ value = {offset:?}, unit = "m" }}
F = {{ value = {force:?}, unit = "N" }}
mu = {{ value = {friction:?}, unit = "1" }}
[coordinates]
x = {{ unit = "m", initial_rate = {speed:?} }}
y = {{ unit = "m" }}
phi = {{ unit = "rad" }}
[kinetic]
drawer = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*J*dot(phi)^2"
[forces]
pull = {{ on = "x - e*phi", value = "F" }}
[impacts]
{}"#,
                pads.concat()
            );
            let lost = friction * force * offset / half;
            // If the drawer moves against the pull, both forces decelerate it.
            let braking = if speed < 0.0 {
                force + lost
            } else {
                lost - force
            };
            let stop = match speed != 0.0 && braking > 0.0 {
                true => (speed.abs() * mass / braking).min(1.0),
                false => 0.0,
            };
            let driven = (force - lost).max(0.0) / mass * (1.0 - stop);
            let expected = match stop > 0.0 || speed == 0.0 {
                true => driven + (speed.abs() - braking / mass * stop) * speed.signum(),
                false => speed + driven,
            };
            for found in simulate(&text, 1.0) {
                assert!(
                    (found[3] - expected).abs() < 1e-7,
                    "offset {offset} speed {speed}: {} {expected}",
                    found[3]
                );
                assert!(found[1].abs() + found[2].abs() < 1e-12, "{found:?}");
            }
        }
    }
}
