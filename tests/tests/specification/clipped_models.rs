//! Tests of certificates of models with powers of clipped expressions, in energies and in forces.

use eomgen_tests::certified::{certify, check_model};
use eomgen_validate::certificate::{Coverage, Verdict};

const BODY: &str = r#"
[model]
name = "body"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 10, unit = "N/m" }
c = { value = 2, unit = "N s/m" }
l = { value = 1, unit = "m" }
v = { value = 1, unit = "m/s" }
n = { value = 1.5 }
[coordinates]
x = { unit = "m", initial = 0.5 }
y = { unit = "m", initial = 0.5 }
[definitions]
s = "S"
[kinetic]
body = "1/2*m*(dot(x)^2 + dot(y)^2) + T"
[potential]
spring = "1/2*k*(x^2 + y^2)"
[dissipation]
damper = "1/2*c*l^2*dot(s)^2"
[forces]
contact = { on = "x", value = "F" }
"#;

fn coverage(kinetic: &str, clipped: &str, force: &str) -> Option<Coverage> {
    let text = BODY
        .replace("\"S\"", &format!("\"{clipped}\""))
        .replace("+ T", kinetic)
        .replace("\"F\"", &format!("\"{force}\""));
    let model = check_model(&text);
    let certificate = certify(&model, &model);
    let failures: Vec<_> = certificate.failures().collect();
    assert_eq!(
        certificate.verdict,
        Verdict::Passed,
        "{clipped}, {force}: {failures:#?}, {:?}",
        certificate.coverage
    );
    certificate.coverage
}

#[test]
fn inertia_and_damping_along_clipped_powers_pass() {
    for (clipped, regimes) in [
        ("max(x/l, 0)^1.5", 2),
        ("sqrt(max(x/l, 0))^3", 2),
        ("max(x/l, 0)^2", 2),
        ("abs(x/l)^1.5", 2),
        ("((x^2 + y^2)/l^2)^0.75", 1),
    ] {
        let found = coverage("+ 1/2*m*l^2*dot(s)^2", clipped, "-c*dot(x)");
        let found = found.map(|coverage| (coverage.regimes, coverage.sampled));
        assert_eq!(found, Some((regimes, regimes)), "{clipped}");
    }
}

/// A product that is zero only on a surface is not constantly zero near it.
#[test]
fn contacts_that_never_pull_pass_in_every_regime() {
    for (force, regimes) in [
        ("max(k*l*max(-x/l, 0)^n*(1 - dot(x)/v), 0)", 3),
        ("max(k*l*max(-x/l, 0)*(1 - dot(x)/v), 0)", 3),
        ("max(k*l*sqrt(max(-x/l, 0))*(1 - dot(x)/v), 0)", 3),
    ] {
        let found = coverage("", "x/l", force);
        let found = found.map(|coverage| (coverage.regimes, coverage.sampled));
        assert_eq!(found, Some((regimes, regimes)), "{force}");
    }
}
