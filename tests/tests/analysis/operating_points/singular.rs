//! Tests of equilibria at which a derivative has no limit.

use eomgen_tests::program::run_rejected;

use super::{run_json, write_model};

/// Returns a piston in a cylinder that a valve connects to a reservoir with the pressure `reservoir`.
fn piston(flow: &str, reservoir: &str, start: &str) -> String {
    format!(
        r#"
[model]
name = "piston"
[parameters]
m = {{ value = 50, unit = "kg" }}
c = {{ value = 200, unit = "N s/m" }}
k = {{ value = 1e5, unit = "N/m" }}
A = {{ value = 10, unit = "cm^2" }}
B = {{ value = 1.4e12, unit = "Pa/m^3" }}
C = {{ value = 1e-4, unit = "m^3/s" }}
p_0 = {{ value = 1, unit = "MPa" }}
p_s = {{ value = {reservoir}, unit = "MPa" }}
[coordinates]
x = {{ unit = "m", initial = 0.01 }}
[states]
p = {{ unit = "Pa", rate = "B*(-C*{flow} - A*dot(x))", initial = "{start}" }}
[kinetic]
piston = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
pressure = {{ on = "x", value = "p*A" }}
"#
    )
}

#[test]
fn equilibrium_at_the_zero_of_a_valve_flow_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    for (reservoir, starts) in [
        ("0", ["0*p_0", "1e-9*p_0", "0.3*p_0", "-2*p_0"]),
        ("3", ["p_s", "1.01*p_s", "0*p_0", "-2*p_s"]),
        ("0.1", ["p_s", "1.01*p_s", "p_0", "-2*p_0"]),
    ] {
        for start in starts {
            let flow = "sign(p - p_s)*sqrt(abs(p - p_s)/p_0)";
            let model = write_model(folder.path(), &piston(flow, reservoir, start));
            for arguments in [
                &["trim", &model][..],
                &["modes", &model, "--state", "trim"],
                &["linearise", &model, "--state", "trim"],
            ] {
                let message = run_rejected(arguments);
                assert!(
                    message.contains("the rate of `p` has no derivative with respect to `p`"),
                    "{reservoir}, {start}, {arguments:?}: {message}"
                );
            }
        }
    }
}

#[test]
fn equilibrium_at_the_zero_of_a_smooth_flow_has_modes() {
    let folder = tempfile::tempdir().expect("a folder");
    for flow in [
        "(p - p_s)/p_0",
        "(p - p_s)/p_0/sqrt(abs(p - p_s)/p_0 + 1)",
        "(sign(p - p_s)*(abs(p - p_s)/p_0)^1.5 + (p - p_s)/p_0)",
    ] {
        let model = write_model(folder.path(), &piston(flow, "3", "2.9*p_0"));
        let found = run_json(&["modes", &model, "--state", "trim", "--json"]);
        let pressure = found["at"]["p"].as_f64().expect("a pressure");
        assert!((pressure / 3e6 - 1.0).abs() < 1e-6, "{flow}: {found}");
    }
}
