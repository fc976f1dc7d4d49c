//! Test of a box that tips about an edge. Corrections onto the contact are below the rounding error of its height.

use eomgen_compiled_model::Request;

use super::{GENERAL, compile_text};

/// Box on a slope whose lower edge sticks. Heights are measured from a floor at the height `f`.
const BOX: &str = r#"
[model]
name = "tipping"
[parameters]
m = { value = 2, unit = "kg" }
b = { value = 0.1, unit = "m" }
h = { value = 0.5, unit = "m" }
f = { value = 0, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
alpha = { value = 0.3, unit = "rad" }
mu = { value = 0.8, unit = "1" }
[coordinates]
x = { unit = "m" }
y = { unit = "m", initial = "f + h" }
phi = { unit = "rad" }
[definitions]
left_x = "x + h*sin(phi) - b*cos(phi)"
right_x = "x + h*sin(phi) + b*cos(phi)"
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/6*m*(b^2 + h^2)*dot(phi)^2"
[potential]
p = "m*g*(y*cos(alpha) - x*sin(alpha))"
[impacts]
left = { when = "y - f - h*cos(phi) - b*sin(phi)", restitution = 0, friction = "mu", slip = "dot(left_x)" }
right = { when = "y - f - h*cos(phi) + b*sin(phi)", restitution = 0, friction = "mu", slip = "dot(right_x)" }
"#;

#[test]
fn box_tips_about_its_lower_edge_in_few_steps() {
    let model = compile_text(BOX);
    let (b, h, t) = (0.1, 0.5, 1e-2_f64);
    let (s, c) = 0.3_f64.sin_cos();
    let acceleration = 9.81 * (h * s - b * c) / (4.0 / 3.0 * (b * b + h * h));
    let expected = -0.5 * acceleration * t * t;
    for floor in [0.0, 1.0, -30.0] {
        let run = model.with_parameters(&[("f", floor)]).expect("an instance");
        for solver in GENERAL {
            let request = Request {
                initial: run.initial_state(),
                times: &[0.0, t],
                inputs: &run.default_inputs(),
                solver,
                tolerance: 1e-10,
                max_step: f64::INFINITY,
                audit: false,
            };
            let motion = run
                .simulate_until_stop(&request, &mut |_| {})
                .expect("a motion");
            assert!(motion.early_stop.is_none(), "{solver} at {floor}");
            let found = motion.trajectory.final_state[2];
            assert!(
                (found - expected).abs() < 1e-3 * expected.abs(),
                "{solver} at {floor}: {found} instead of {expected}"
            );
            let work = &motion.trajectory.statistics;
            let steps = work.steps + work.rejected_steps + work.trial_steps;
            assert!(steps < 500, "{solver} at {floor}: {steps} steps");
        }
    }
}
