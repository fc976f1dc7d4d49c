//! Tests of correct models that are difficult to check. Terms of a row cancel, functions have a domain, a force
//! increases the energy, the motion stops, or switches cancel. The certificates pass and report the coverage.

use eomgen_tests::certified::{certify, check_model};
use eomgen_validate::certificate::{Certificate, Check, Coverage, SkipKind, Verdict};

fn assert_passes(text: &str) -> Certificate {
    let model = check_model(text);
    let certificate = certify(&model, &model);
    let failures: Vec<_> = certificate.failures().collect();
    assert!(certificate.passed, "{failures:#?}\n{text}");
    certificate
}

/// Asserts that the certificate of `text` fails if `part` is replaced by `changed` in the derived model.
fn assert_change_fails(text: &str, part: &str, changed: &str) {
    assert!(text.contains(part), "{part} in\n{text}");
    let (model, subject) = (check_model(text), check_model(&text.replace(part, changed)));
    let certificate = certify(&model, &subject);
    assert!(!certificate.passed, "{changed} in\n{text}");
}

fn find<'c>(certificate: &'c Certificate, name: &str) -> &'c Check {
    let mut checks = certificate.checks.iter();
    checks.find(|check| check.name == name).expect(name)
}

const ROTOR: &str = r#"
[model]
name = "rotor"
[parameters]
m = { value = 1.2, unit = "kg" }
l = { value = 0.3, unit = "m" }
k = { value = 2, unit = "N m" }
[coordinates]
theta = { unit = "rad", initial_rate = 1 }
[definitions]
x = "l*sin(theta)"
y = "-l*cos(theta)"
[kinetic]
point = "1/2*m*(dot(x)^2 + dot(y)^2)"
"#;

#[test]
fn free_rotor_defined_by_a_point_passes() {
    assert_passes(ROTOR);
    assert_change_fails(ROTOR, "sin(theta)", "sin(1.0000001*theta)");
}

#[test]
fn rotor_with_deadzone_passes_inside_and_outside() {
    let text = ROTOR.to_owned() + "[potential]\nstops = \"1/2*k*deadzone(theta, 0.5)^2\"\n";
    let certificate = assert_passes(&text);
    for side in ["-", "0", "+"] {
        assert!(find(&certificate, &format!("accelerations theta{side}")).passed);
    }
    assert_change_fails(&text, "deadzone(theta, 0.5)", "deadzone(theta, 0.5000001)");
}

#[test]
fn one_sided_springs_pass() {
    let text = ROTOR.to_owned()
        + "[potential]\nupper = \"1/2*k*max(theta - 0.1, 0)^2\"\n\
           lower = \"1/2*k*min(x/l + 0.2, 0)^2\"\n";
    assert_passes(&text);
    assert_change_fails(&text, "theta - 0.1", "theta - 0.1000001");
}

fn masses(potential: &str) -> String {
    format!(
        r#"
[model]
name = "masses"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 3, unit = "N/m" }}
L = {{ value = 0.7, unit = "m" }}
[coordinates]
x = {{ unit = "m", initial = 0.3, initial_rate = 0.1 }}
y = {{ unit = "m", initial = 0.2 }}
[kinetic]
masses = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
of_x = "{potential}"
of_y = "1/2*k*(y - x)^2"
"#
    )
}

#[test]
fn functions_are_checked_inside_their_domain() {
    for potential in [
        "k*L^2*ln(x/L)",
        "k*L^2*(x/L)^1.5",
        "k*L^2*sqrt(0.5 - x/L)",
        // The domain is a twentieth of the interval in which states are sampled.
        "k*L^2*asin(20*(x/L - 0.42))",
    ] {
        let text = masses(potential);
        let certificate = assert_passes(&text);
        let detail = &find(&certificate, "accelerations").detail;
        assert!(detail.starts_with("200 states ("), "{detail}");
        assert!(detail.contains("drawn again"), "{detail}");
        assert_change_fails(&text, "k*L^2*", "1.0000001*k*L^2*");
    }
}

#[test]
fn model_with_empty_domain_fails() {
    let text = masses("k*L^2*ln(-1 - (x/L)^2)");
    let model = check_model(&text);
    let certificate = certify(&model, &model);
    assert!(!certificate.passed);
    let domain = find(&certificate, "domain");
    assert!(!domain.passed && domain.skipped.is_none());
    assert!(
        domain
            .detail
            .contains("no state in the model's domain was found")
    );
}

const SPEAKER: &str = r#"
[model]
name = "speaker"
[parameters]
R = { value = 6, unit = "ohm" }
L_0 = { value = 0.5, unit = "mH" }
L_1 = { value = -20, unit = "mH/m" }
Bl = { value = 7, unit = "N/A" }
Bl_2 = { value = -5e4, unit = "N/(A m^2)" }
m = { value = 12, unit = "g" }
k = { value = 1500, unit = "N/m" }
k_3 = { value = 2e7, unit = "N/m^3" }
r = { value = 1.2, unit = "N s/m" }
U = { value = 8, unit = "V" }
omega = { value = 377, unit = "rad/s" }
[coordinates]
q = { unit = "C" }
x = { unit = "m" }
[definitions]
flux = "Bl*x + 1/3*Bl_2*x^3"
[kinetic]
coil = "1/2*(L_0 + L_1*x)*dot(q)^2 + flux*dot(q)"
cone = "1/2*m*dot(x)^2"
[potential]
suspension = "1/2*k*x^2 + 1/4*k_3*x^4"
[dissipation]
losses = "1/2*R*dot(q)^2 + 1/2*r*dot(x)^2"
[forces]
amplifier = { on = "q", value = "U*sin(omega*t)" }
"#;

#[test]
fn loudspeaker_passes_with_and_without_range() {
    assert_passes(SPEAKER);
    assert_change_fails(SPEAKER, "L_1*x)", "1.000001*L_1*x)");
    let ranged = SPEAKER.replace(
        "x = { unit = \"m\" }",
        "x = { unit = \"m\", range = [-0.005, 0.005] }",
    );
    let certificate = assert_passes(&ranged);
    let detail = &find(&certificate, "accelerations").detail;
    assert!(
        detail.starts_with("200 states, "),
        "none drawn again: {detail}"
    );
    assert_change_fails(&ranged, "L_1*x)", "1.000001*L_1*x)");
}

#[test]
fn slider_crank_with_gas_force_passes() {
    let text = r#"
[model]
name = "slider"
[parameters]
r = { value = 40, unit = "mm" }
l = { value = 140, unit = "mm" }
J = { value = 0.01, unit = "kg m^2" }
m = { value = 0.5, unit = "kg" }
p_0 = { value = 100, unit = "kPa" }
A = { value = 50, unit = "cm^2" }
V_0 = { value = 40, unit = "cm^3" }
[coordinates]
phi = { unit = "rad", initial_rate = 100 }
[definitions]
beta = "asin(r*sin(phi)/l)"
x = "r*cos(phi) + l*cos(beta)"
volume = "V_0 + A*(r + l - x)"
[kinetic]
crank = "1/2*J*dot(phi)^2"
piston = "1/2*m*dot(x)^2"
[forces]
gas = { on = "x", value = "-p_0*(((V_0 + 2*A*r)/volume)^1.35 - 1)*A" }
"#;
    assert_passes(text);
    assert_change_fails(text, "^1.35", "^1.3500001");
}

#[test]
fn damped_model_at_rest_passes() {
    let text = r#"
[model]
name = "damped"
[parameters]
m = { value = 1.4, unit = "kg" }
L = { value = 0.8, unit = "m" }
E = { value = 1.2, unit = "J" }
tau = { value = 0.3, unit = "s" }
[coordinates]
x = { unit = "rad", initial = -0.4 }
y = { unit = "rad", initial = 0.6, initial_rate = -0.4 }
[kinetic]
both = "1/2*m*(L*dot(x))^2 + 1/2*m*(L*dot(y))^2 + 0.2*m*L^2*dot(x)*dot(y)"
[potential]
spring = "E*asin(0.7*tanh(asin(0.7*tanh(pi*x))))"
[dissipation]
y = "90*E/tau*(1.1 + sin(y))*(dot(y)*tau)^2"
x = "0.2*E/tau*(dot(x)*tau)^2"
"#;
    let certificate = assert_passes(text);
    let detail = &find(&certificate, "power_balance").detail;
    assert!(detail.starts_with("200 steps"), "{detail}");
    assert_change_fails(text, "0.2*E/tau", "0.2000001*E/tau");
}

#[test]
fn switches_that_cancel_in_the_equations_need_no_guard() {
    let text = masses("k*L^2*contact(x, L/2)*sin(sqrt(k/m)*t)");
    let model = check_model(&text);
    let certificate = certify(&model, &model);
    // The energy jumps at the switch, and no check covers the jump of the rates.
    let kind = |check: &Check| check.skipped.as_ref().map(|skip| skip.kind);
    let not_passed = certificate.checks.iter().filter(|check| !check.passed);
    let applicable = not_passed.filter(|check| kind(check) != Some(SkipKind::NotApplicable));
    let names: Vec<&str> = applicable.map(|check| check.name.as_str()).collect();
    assert_eq!(names, ["corners"], "{text}");
    assert_eq!(kind(find(&certificate, "corners")), Some(SkipKind::NotRun));
    assert_eq!(certificate.verdict, Verdict::Partial);
    // A force with the same switch appears in the equations and needs a guard.
    let force =
        masses("k*x^2") + "[forces]\nstep = { on = \"x\", value = \"k*L*contact(x, L/2)\" }\n";
    assert_passes(&force);
    assert_change_fails(&force, "contact(x, L/2)", "1");
}

#[test]
fn power_balance_holds_for_time_dependent_and_gyroscopic_energies() {
    let gyroscopic = masses("k*x^2*(1 + m/(m + m))").replace(
        "[potential]",
        "gyro = \"m*L*sqrt(k/m)*dot(y)*max(0.5, x/L)\"\nfar = \"m*L*sqrt(k/m)*dot(x)*exp(tanh(y/L))\"\n[potential]",
    );
    let certificate = assert_passes(&gyroscopic);
    assert!(find(&certificate, "power_balance").passed);
    // At small x the term is negligible, but its derivative is not.
    let steep = masses("k*x^2").replace(
        "[potential]",
        "gyro = \"m*L*sqrt(k/m)*dot(y)*(x/L)^21\"\n[potential]",
    );
    assert_passes(&steep);
    let timed = masses("k*x^2*(2 + sin(sqrt(k/m)*t))").replace(
        "(dot(x)^2 + dot(y)^2)",
        "(dot(x)^2 + dot(y)^2)*(2 + sin(sqrt(k/m)*t))",
    );
    let certificate = assert_passes(&timed);
    assert!(find(&certificate, "power_balance").passed);
    assert!(find(&certificate, "power").passed);
}

/// Cylinder with a valve. For u > u_0 the valve connects it to the supply p_s, for u < -u_0 to the tank p_t; between
/// these values it is closed.
const VALVE: &str = r#"
[model]
name = "valve"
[parameters]
m = { value = 60, unit = "kg" }
A = { value = 8e-4, unit = "m^2" }
V = { value = 1e-4, unit = "m^3" }
E = { value = 1.4e9, unit = "Pa" }
p_s = { value = 2e7, unit = "Pa" }
p_t = { value = 1e5, unit = "Pa" }
k_v = { value = 2e-8, unit = "m^3/(s V Pa^(1/2))" }
F_c = { value = 40, unit = "N" }
u_0 = { value = 0.2, unit = "V" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "V" }
[states]
p = { unit = "Pa", initial = 1e5, rate = "E/V*(k_v*(above(u - u_0)*(u - u_0)*sign(p_s - p)*sqrt(abs(p_s - p)) - above(-u - u_0)*(-u - u_0)*sign(p - p_t)*sqrt(abs(p - p_t))) - A*dot(x))" }
[kinetic]
load = "1/2*m*dot(x)^2"
[forces]
cylinder = { on = "x", value = "A*p - F_c*sign(dot(x))" }
"#;

fn coverage(regimes: u64, sampled: u64, unreachable: u64) -> Option<Coverage> {
    Some(Coverage {
        regimes,
        sampled,
        unreachable,
    })
}

#[test]
fn all_reachable_regimes_of_valve_are_sampled() {
    // Two directions, three ranges of the input and three ranges of the pressure give 18 of 32 regimes.
    assert_eq!(assert_passes(VALVE).coverage, coverage(18, 18, 14));
    let in_kilopascal = VALVE.replace("2e7, unit = \"Pa\"", "2e4, unit = \"kPa\"");
    assert_eq!(assert_passes(&in_kilopascal).coverage, coverage(18, 18, 14));
    let moved = VALVE.replace("2e7, unit = \"Pa\"", "3e12, unit = \"Pa\"");
    assert_eq!(assert_passes(&moved).coverage, coverage(18, 18, 14));
    assert_change_fails(
        VALVE,
        "- p)*sqrt(abs(p_s - p))",
        "- p)*sqrt(abs(1.0000001*p_s - p))",
    );
}

#[test]
fn ranges_of_states_and_inputs_exclude_regimes() {
    let below_supply = VALVE.replace("initial = 1e5", "initial = 1e5, range = [0, 1e7]");
    assert_eq!(assert_passes(&below_supply).coverage, coverage(12, 12, 20));
    let one_way = VALVE.replace(
        "u = { unit = \"V\" }",
        "u = { unit = \"V\", range = [0, 10] }",
    );
    assert_eq!(assert_passes(&one_way).coverage, coverage(12, 12, 20));
}

#[test]
fn jointly_contradictory_switches_are_excluded() {
    // x > b and y > b exclude x + y < b, although no two of the three contradict each other.
    let text = ROTOR.to_owned()
        + "[forces]\nf = { on = \"theta\", value = \"k*(above(theta - 0.5) + above(theta_2 - 0.5) + \\\nabove(0.5 - theta - theta_2))\" }\n";
    let text = text
        .replace("\\\n", "")
        .replace(
            "[definitions]",
            "theta_2 = { unit = \"rad\" }\n[definitions]",
        )
        .replace(
            "[kinetic]",
            "[kinetic]\nother = \"1/2*m*l^2*dot(theta_2)^2\"",
        );
    assert_eq!(assert_passes(&text).coverage, coverage(7, 7, 1));
}

#[test]
fn late_or_small_regime_is_reached() {
    let text = ROTOR.to_owned()
        + "[forces]\npush = { on = \"theta\", value = \"k*above(t - 300*t_0)\" }\n";
    let text = text.replace(
        "[coordinates]",
        "t_0 = { value = 1, unit = \"s\" }\n[coordinates]",
    );
    assert_eq!(assert_passes(&text).coverage, coverage(2, 2, 0));
    let text = ROTOR.to_owned()
        + "[potential]\npost = \"k*min(sqrt((theta - 4)^2 + (theta_2 - 9)^2 + 1e-12) - 0.02, 0)^2\"\n";
    let text = text
        .replace(
            "[definitions]",
            "theta_2 = { unit = \"rad\" }\n[definitions]",
        )
        .replace(
            "[kinetic]",
            "[kinetic]\nother = \"1/2*m*l^2*dot(theta_2)^2\"",
        );
    assert_eq!(assert_passes(&text).coverage, coverage(2, 2, 0));
}

#[test]
fn regime_neither_reached_nor_excluded_makes_certificate_partial() {
    // theta exp(-theta^2) < 0.43, but bounds of the separate factors do not prove it.
    let text = ROTOR.to_owned()
        + "[forces]\nf = { on = \"theta\", value = \"k*above(theta*exp(-theta^2) - 0.5)\" }\n";
    let model = check_model(&text);
    let certificate = certify(&model, &model);
    assert_eq!(certificate.verdict, Verdict::Partial);
    assert!(!certificate.passed);
    assert_eq!(certificate.coverage, coverage(2, 1, 0));
    for name in ["coverage", "accelerations switch_1+"] {
        let skipped = find(&certificate, name).skipped.as_ref();
        assert_eq!(skipped.expect(name).kind, SkipKind::NotRun);
    }
    assert_eq!(certificate.failures().count(), 0);
}
