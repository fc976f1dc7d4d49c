//! The certificates of all shipped specifications: every check that a certificate can hold
//! is made and passes. What each check means and its tolerance stand in the certificate.

use codegen::lower::lower;
use codegen::rust::{Packaging, emit};
use eomgen_tests::models::{load, shipped, variant};
use sim::certificates::certificate;
use sim::validate::certificate::Certificate;

/// The certificate of a shipped specification with every field at `order`.
fn of(name: &str, order: usize) -> Certificate {
    let model = load(name);
    let derived = variant(&model, order);
    let values = model
        .parameter_values()
        .expect("the parameters have values");
    let program = lower(&model, &derived.equations, &values);
    let source = emit(&program, Packaging::Crate).expect("the program can be emitted");
    certificate(&model, order, source).expect("the parameters have values")
}

/// Asserts that a certificate passes and that nothing was skipped but what `may_skip` names.
fn passes(certificate: &Certificate, may_skip: &[&str]) {
    let shown = format!("{} at order {}", certificate.model, certificate.order);
    let failures: Vec<_> = certificate.failures().collect();
    assert!(
        certificate.passed && failures.is_empty(),
        "{shown}: {failures:#?}"
    );
    for check in certificate.checks.iter().filter(|check| check.skipped) {
        let expected = may_skip.iter().any(|name| check.name.starts_with(name));
        assert!(
            expected,
            "{shown}: {} was skipped: {}",
            check.name, check.detail
        );
    }
}

/// How many checks have a name that begins so.
fn count(certificate: &Certificate, beginning: &str) -> usize {
    certificate
        .checks
        .iter()
        .filter(|check| check.name.starts_with(beginning))
        .count()
}

/// The arm at one order, against the hand-written equations in all nine mesh regimes.
fn arm(order: usize) {
    let certificate = of("planetary_arm", order);
    let may_skip: &[&str] = if order == 0 { &["rigid_limit"] } else { &[] };
    passes(&certificate, may_skip);
    assert_eq!(
        count(&certificate, "accelerations"),
        9,
        "each mesh +, free and -"
    );
    assert_eq!(
        count(&certificate, "reference"),
        2,
        "Eq. (10) and (12), or Eq. (22) in SI and dimensionless"
    );
    assert_eq!(count(&certificate, "emitted_rust"), 1);
}

#[test]
fn the_arm_passes_rigid_and_with_one_to_four_modes() {
    (0..=4).for_each(arm);
}

#[test]
fn the_arm_passes_with_five_to_eight_modes() {
    (5..=8).for_each(arm);
}

#[test]
fn the_arm_passes_with_sixteen_modes() {
    arm(16);
}

#[test]
fn the_arm_passes_with_sixty_four_modes() {
    arm(64);
}

#[test]
fn every_shipped_specification_passes_at_its_own_order() {
    for path in shipped() {
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
            may_skip.push("guards");
        }
        let certificate = of(&name, order);
        passes(&certificate, &may_skip);
        let by_hand = count(&certificate, "reference");
        assert_eq!(
            by_hand == 0,
            // The flexible links of the other are compared by hand where they are rigid.
            ["planetary_arm_rig", "two_link_arm"].contains(&name.as_str()),
            "{name}: {by_hand} by hand"
        );
    }
}

#[test]
fn the_beam_with_a_tip_mass_passes_at_other_orders() {
    for order in [1, 8, 16] {
        passes(&of("hub_beam_tip_mass", order), &["guards"]);
    }
}

#[test]
fn the_arm_of_two_links_passes_at_every_kind_of_order() {
    let rigid = of("two_link_arm", 0);
    passes(&rigid, &["guards", "rigid_limit"]);
    assert_eq!(count(&rigid, "reference"), 1);
    for order in [1, 4, 16] {
        passes(&of("two_link_arm", order), &["guards"]);
    }
}

#[test]
fn a_certificate_of_the_wrong_source_fails() {
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
    let found = certificate(&model, 1, falsified).expect("the parameters have values");
    let failed: Vec<&str> = found.failures().map(|check| check.name.as_str()).collect();
    assert_eq!(failed, ["emitted_rust"]);
}
