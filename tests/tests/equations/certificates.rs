//! Tests of the certificates of all shipped specifications: all checks run and pass, and each seeded fault fails the
//! corresponding check.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::lowering::lower;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_sim::piecewise_linear::PiecewiseLinear;
use eomgen_tests::models::{load, project, shipped_specifications, variant};
use eomgen_validate::certificate::Certificate;
use eomgen_validate::model_certificate::certify_source;

/// Certifies `source` of a model with every field at `order`.
fn certify(model: &Model, order: usize, outputs: &[Output], source: String) -> Certificate {
    let orders = vec![order; model.fields.len().max(1)];
    certify_source(model, &orders, outputs, source).expect("the model can be derived")
}

fn certify_shipped(name: &str, order: usize) -> Certificate {
    let model = load(name);
    let derived = variant(&model, order);
    let values = model
        .parameter_values()
        .expect("the parameters have values");
    let program = lower(&model, &derived.equations, &values);
    let source = emit(&program, Packaging::Crate).expect("the program can be emitted");
    certify(&model, order, &[], source)
}

/// Asserts that the certificate passes and that only the checks in `may_skip` were skipped.
fn assert_passes(certificate: &Certificate, may_skip: &[&str]) {
    let shown = format!("{} at order {}", certificate.model, certificate.order);
    let failures: Vec<_> = certificate.failures().collect();
    assert!(
        certificate.passed && failures.is_empty(),
        "{shown}: {failures:#?}"
    );
    for check in certificate
        .checks
        .iter()
        .filter(|check| check.skipped.is_some())
    {
        let expected = may_skip.iter().any(|name| check.name.starts_with(name));
        assert!(
            expected,
            "{shown}: {} was skipped: {}",
            check.name, check.detail
        );
    }
}

fn count_checks(certificate: &Certificate, beginning: &str) -> usize {
    certificate
        .checks
        .iter()
        .filter(|check| check.name.starts_with(beginning))
        .count()
}

/// Certifies the arm and compares it with the hand-written equations in all nine mesh regimes.
fn certify_arm(order: usize) {
    let certificate = certify_shipped("planetary_arm", order);
    let may_skip: &[&str] = if order == 0 { &["rigid_limit"] } else { &[] };
    assert_passes(&certificate, may_skip);
    assert_eq!(
        count_checks(&certificate, "accelerations"),
        9,
        "each mesh +, free and -"
    );
    assert_eq!(
        count_checks(&certificate, "reference"),
        2,
        "Eq. (10) and (12), or Eq. (22) in SI and dimensionless"
    );
    for name in ["emitted_rust", "regime_kernels", "exact_derivative"] {
        assert_eq!(count_checks(&certificate, name), 1, "{name}");
    }
    if order <= 8 {
        assert_checked_in(&certificate);
    }
}

/// Asserts that the certificate in `generated` has the same checks and that all of them passed.
fn assert_checked_in(certificate: &Certificate) {
    let name = match certificate.order {
        0 => "planetary_arm_rigid".to_owned(),
        order => format!("planetary_arm_order_{order}"),
    };
    let path = project().join(format!("generated/src/variants/{name}/certificate.json"));
    let text = std::fs::read_to_string(&path).expect("the certificate is checked in");
    let found: serde_json::Value = serde_json::from_str(&text).expect("one document");
    let made = |check: &serde_json::Value| {
        let skipped = check["skipped"].is_object();
        assert!(skipped || check["passed"] == true, "{name}: {check}");
        (
            check["name"].as_str().unwrap_or_default().to_owned(),
            skipped,
        )
    };
    // Checks that were added after the last `generate --all` may be missing in the certificate in `generated`.
    for (found, skipped) in found["checks"].as_array().expect("checks").iter().map(made) {
        let mut checks = certificate.checks.iter();
        let known = checks.any(|check| check.name == found && check.skipped.is_some() == skipped);
        assert!(known, "{name}: {found}: run `eomgen generate --all`");
    }
}

#[test]
fn arm_with_zero_to_four_modes_passes() {
    (0..=4).for_each(certify_arm);
}

#[test]
fn arm_with_five_to_eight_modes_passes() {
    (5..=8).for_each(certify_arm);
}

#[test]
fn arm_with_sixteen_modes_passes() {
    certify_arm(16);
}

#[test]
fn arm_with_sixty_four_modes_passes() {
    certify_arm(64);
}

#[test]
fn shipped_specifications_pass_at_declared_order() {
    for path in shipped_specifications() {
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let model = load(&name);
        let order = model.fields.first().map_or(0, |field| field.order);
        let mut may_skip = Vec::new();
        if model.fields.is_empty() {
            may_skip.extend(["nesting", "rigid_limit"]);
        }
        if variant(&model, order).evaluator.guard_count() == 0 {
            may_skip.extend(["guards", "regime_kernels"]);
        }
        let orders = vec![order; model.fields.len()];
        if PiecewiseLinear::derive(&model, &orders).is_err() {
            may_skip.push("exact_derivative");
        }
        // The references of `two_link_arm` cover the rigid links only.
        if ["planetary_arm_rig", "two_link_arm"].contains(&name.as_str()) {
            may_skip.push("reference");
        }
        let certificate = certify_shipped(&name, order);
        assert_passes(&certificate, &may_skip);
        let reference_equations = count_checks(&certificate, "reference");
        assert!(
            reference_equations > 0,
            "{name}: no `reference` check, not even a skipped one"
        );
    }
}

#[test]
fn hub_beam_with_tip_mass_passes_at_other_orders() {
    for order in [1, 8, 16] {
        let may_skip = ["guards", "regime_kernels", "exact_derivative"];
        assert_passes(&certify_shipped("hub_beam_tip_mass", order), &may_skip);
    }
}

#[test]
fn two_link_arm_passes_rigid_and_flexible() {
    let rigid = certify_shipped("two_link_arm", 0);
    let may_skip = [
        "guards",
        "regime_kernels",
        "exact_derivative",
        "rigid_limit",
    ];
    assert_passes(&rigid, &may_skip);
    assert_eq!(count_checks(&rigid, "reference"), 1);
    // Order 16 takes half a minute and has the same loops as order 8, so it is omitted.
    for order in [1, 4, 8] {
        let may_skip = ["guards", "regime_kernels", "exact_derivative", "reference"];
        assert_passes(&certify_shipped("two_link_arm", order), &may_skip);
    }
}

/// Seeded faults in emitted source: text, replacement, names of the checks that must fail.
const FAULTS: [(&str, &str, &[&str]); 4] = [
    (
        "        F::single(self)\n",
        "        1.001 * F::single(self)\n",
        &["emitted_rust", "f32"],
    ),
    (
        "let v2 = T::select_greater(p, b, b, p);",
        "let v2 = if T::all_greater(p, b) { b } else { p };",
        &["lanes"],
    ),
    (
        "A: RATES_BY_STATE.dense(&rates_by_state)",
        "A: RATES_BY_STATE.dense(&rates_by_state).map(|row| row.map(|x| x + x))",
        &["linearisation"],
    ),
    (
        "product[i] = direction[",
        "product[i] = -direction[",
        &["emitted_requests"],
    ),
];

#[test]
fn each_fault_in_requested_output_fails_its_own_checks() {
    let model = load("planetary_arm");
    let outputs = [Output::Products, Output::Linearisation, Output::Lanes];
    let Ok(variant) = Variant::derive_with(&model, &[1], &outputs) else {
        panic!("the arm can be derived");
    };
    let source = emit(&variant.program, Packaging::Crate).expect("the program can be emitted");
    let certify_arm = |source: String| certify(&model, 1, &outputs, source);
    let right = certify_arm(source.clone());
    assert_passes(&right, &["rates_by_inputs", "observables_by_inputs"]);
    for (text, fault, checks) in FAULTS {
        assert!(source.contains(text), "{text}");
        let wrong = certify_arm(source.replacen(text, fault, 1));
        let failed: Vec<&str> = wrong.failures().map(|check| check.name.as_str()).collect();
        assert_eq!(failed, checks, "{fault}");
    }
}

#[test]
fn falsified_source_fails_emitted_rust_check() {
    let model = load("planetary_arm");
    let source = |order: usize| {
        let values = model
            .parameter_values()
            .expect("the parameters have values");
        let program = lower(&model, &variant(&model, order).equations, &values);
        emit(&program, Packaging::Crate).expect("the program can be emitted")
    };
    let falsified = source(1).replacen("(2.0) * x_c_dot", "(3.0) * x_c_dot", 1);
    assert_ne!(falsified, source(1));
    let found = certify(&model, 1, &[], falsified);
    let failed: Vec<&str> = found.failures().map(|check| check.name.as_str()).collect();
    assert_eq!(failed, ["emitted_rust"]);
}
