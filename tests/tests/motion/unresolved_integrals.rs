//! Tests of the warnings about integrals along a field that the quadrature does not resolve.

use eomgen_compiled_model::{CompiledModel, Orders, Request, Solver};

/// Hinged beam under a constant axial force; the work of the force is not a polynomial of the deflection.
const ARC: &str = r#"
[model]
name = "arc"
[parameters]
mu = { value = 2, unit = "kg/m" }
F = { value = 40, unit = "N" }
l = { value = 1.5, unit = "m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "pinned_pinned"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
beam = "1/2*integral(mu*dot(w)^2, w)"
[potential]
arc = "integral(F*(sqrt(1 + diff(w, x)^2) - 1), w)"
"#;

#[test]
fn unresolved_integral_gives_a_warning_with_integrand_error_and_remedy() {
    let model = CompiledModel::from_text("arc.toml", ARC, Orders::Declared).expect("a model");
    let run = model.with_declared_parameters().expect("an instance");
    for (deflection, is_resolved) in [(0.0, true), (0.05, true), (15.0, false)] {
        let request = Request {
            initial: &[deflection, 0.2 * deflection, 0.0, 0.0],
            times: &[0.0, 0.01],
            inputs: &run.default_inputs(),
            solver: Solver::Rk,
            tolerance: 1e-9,
            max_step: f64::INFINITY,
            audit: false,
        };
        let motion = run.simulate_until_stop(&request, &mut |_| {});
        let motion = motion
            .and_then(|motion| motion.into_complete())
            .expect("a motion");
        let found = run.find_unresolved_integral(&motion).expect("a check");
        let message = found.map(|found| found.warning_message());
        assert_eq!(message.is_none(), is_resolved, "{deflection}: {message:?}");
        if let Some(message) = message {
            for part in [
                "integral(F*(sqrt(1 + diff(w, x)^2) - 1))",
                "relative error of",
                "raise the order",
            ] {
                assert!(message.contains(part), "{message}");
            }
        }
    }
}
