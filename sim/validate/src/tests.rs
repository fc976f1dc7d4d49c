//! Mutation tests of the certificate: textbook equations pass, and every fault fails its check.

use super::certificate::{Certificate, Check};
use super::certify::{Emitted, EmittedFunction, Reference, Subject, certify};
use super::compiler::Compiler;
use super::meaning::describe;
use super::oracle::Oracle;
use super::outputs::Outputs;
use super::test_models::{
    BEAM, DOUBLE_PENDULUM, FAR_TERM_TEXT, LOGARITHM, PRELOAD, ROTOR, SPRING, TANK, parse_model,
};
use super::test_outputs::SpringOutputs;
use super::test_variants::{
    Beam, DoublePendulum, EMITTED, FAR_TERM, FREE_ROTOR, Fault, KERNELS, LOGARITHMIC, Preload,
    SingleCoordinate, Spring, TIMED_TANK,
};
use super::variant::Variant;

fn certify_model(
    text: &str,
    order: usize,
    variants: &dyn Fn(usize) -> Result<Box<dyn Variant>, String>,
    references: &[Reference],
    emitted: Result<Emitted, String>,
) -> Certificate {
    let model = parse_model(text);
    let parameters = model.parameter_values().unwrap();
    certify(&Subject {
        model: &model,
        order,
        parameters: &parameters,
        variants,
        references,
        not_applicable: &[],
        outputs: None,
        emitted,
        program: None,
        c_sources: &[],
        casadi: None,
        unit: None,
        regimes: Err("not emitted".into()),
        exact: Err("not linear".into()),
    })
}

fn certify_pendulum(fault: Fault) -> Certificate {
    let variants = move |_| Ok(Box::new(DoublePendulum(fault)) as Box<dyn Variant>);
    certify_model(
        DOUBLE_PENDULUM,
        0,
        &variants,
        &[],
        Err("not emitted".into()),
    )
}

fn certify_spring(fault: Fault, emitted: Result<Emitted, String>) -> Certificate {
    let variants = move |_| Ok(Box::new(Spring(fault)) as Box<dyn Variant>);
    certify_model(SPRING, 0, &variants, &[], emitted)
}

fn certify_single_coordinate(text: &str, make: fn() -> SingleCoordinate) -> Certificate {
    let variants = move |_| Ok(Box::new(make()) as Box<dyn Variant>);
    certify_model(text, 0, &variants, &[], Err("not emitted".into()))
}

fn certify_beam(order: usize, coupled: bool) -> Certificate {
    let model = parse_model(BEAM);
    let parameters = model.parameter_values().unwrap();
    let variants = |order| {
        let oracle = Oracle::new(&model, order, &parameters).map_err(|error| error.to_string())?;
        Ok(Box::new(Beam { oracle, coupled }) as Box<dyn Variant>)
    };
    certify_model(BEAM, order, &variants, &[], Err("not emitted".into()))
}

/// Certifies the preloaded mass with the force `kernel` in the play, or a faulty `derivative`.
fn certify_preload(kernel: &str, derivative: bool) -> Certificate {
    let model = parse_model(PRELOAD);
    let derivative = Preload::derivative(derivative);
    certify(&Subject {
        model: &model,
        order: 0,
        parameters: &model.parameter_values().unwrap(),
        variants: &|_| Ok(Box::new(Preload)),
        references: &[],
        not_applicable: &[],
        outputs: None,
        emitted: Err("not emitted".into()),
        program: None,
        c_sources: &[],
        casadi: None,
        unit: None,
        regimes: Ok(Emitted {
            source: KERNELS.replace("WITHIN", kernel),
            input_fields: Vec::new(),
            functions: Vec::new(),
            outputs: None,
        }),
        exact: Ok(&derivative),
    })
}

fn failures(certificate: &Certificate) -> Vec<&str> {
    certificate
        .failures()
        .map(|check| check.name.as_str())
        .collect()
}

fn find_check<'c>(certificate: &'c Certificate, name: &str) -> &'c Check {
    certificate
        .checks
        .iter()
        .find(|check| check.name == name)
        .unwrap()
}

#[test]
fn every_check_has_a_description() {
    let certificates = [
        certify_pendulum(Fault::None),
        certify_beam(2, false),
        certify_preload("0.0", true),
    ];
    for check in certificates.iter().flat_map(|of| &of.checks) {
        let sentence = describe(&check.name).expect(&check.name);
        assert!(
            sentence.ends_with('.') && !sentence.contains('_'),
            "{sentence}"
        );
    }
    assert_eq!(describe("unknown"), None);
}

#[test]
fn correct_equations_pass() {
    let pendulum = certify_pendulum(Fault::None);
    assert!(pendulum.passed, "{:?}", failures(&pendulum));
    assert!(find_check(&pendulum, "guards").skipped.is_some());
    assert!(find_check(&pendulum, "nesting_mass").skipped.is_some());
    assert!(find_check(&pendulum, "power_balance").passed);
    let spring = certify_spring(Fault::None, Err("not emitted".into()));
    assert!(spring.passed, "{:?}", failures(&spring));
    for name in [
        "accelerations y-",
        "accelerations y0",
        "accelerations y+",
        "guards",
    ] {
        assert!(find_check(&spring, name).passed);
    }
    assert_eq!(find_check(&spring, "emitted_rust").detail, "not emitted");
}

#[test]
fn every_fault_fails_its_check() {
    for (fault, check) in [
        (Fault::VelocitySign, "accelerations"),
        (Fault::Coupling, "accelerations"),
        (Fault::Coupling, "dense_solve"),
        (Fault::Coupling, "power_balance"),
        (Fault::Asymmetry, "mass_matrix_symmetric"),
        (Fault::Energy, "energy"),
        (Fault::Power, "power"),
        (Fault::Power, "power_balance"),
        (Fault::NotANumber, "accelerations"),
        (Fault::WrongRate, "accelerations"),
        (Fault::Refusal, "accelerations"),
    ] {
        let certificate = certify_pendulum(fault);
        assert!(!certificate.passed);
        assert!(failures(&certificate).contains(&check), "{fault:?} {check}");
    }
    assert_eq!(
        failures(&certify_pendulum(Fault::Asymmetry)),
        ["mass_matrix_symmetric"]
    );
    let spring = certify_spring(Fault::Guard, Err("not emitted".into()));
    assert_eq!(failures(&spring), ["guards"]);
}

#[test]
fn faults_are_found_in_row_with_full_cancellation() {
    let good = certify_single_coordinate(ROTOR, || FREE_ROTOR);
    assert!(good.passed, "{:?}", failures(&good));
    let bad = certify_single_coordinate(ROTOR, || SingleCoordinate {
        acceleration: |_, _, rate| 1e-10 * rate * rate,
        ..FREE_ROTOR
    });
    assert_eq!(
        failures(&bad),
        ["accelerations", "dense_solve", "power_balance"]
    );
    let bad = certify_single_coordinate(ROTOR, || SingleCoordinate {
        power: |_, _, rate| 1e-9 * rate * rate * rate,
        ..FREE_ROTOR
    });
    assert_eq!(failures(&bad), ["power", "power_balance"]);
}

#[test]
fn wrong_power_of_variable_mass_fails_two_checks() {
    let good = certify_single_coordinate(TANK, || TIMED_TANK);
    assert!(good.passed, "{:?}", failures(&good));
    assert!(find_check(&good, "power_balance").passed);
    for power in [(|_, _, _| 0.0) as fn(f64, f64, f64) -> f64, |t, _, rate| {
        -rate * rate * t.cos() * (1.0 + 1e-9)
    }] {
        let variants = move |_| {
            Ok(Box::new(SingleCoordinate {
                power,
                ..TIMED_TANK
            }) as Box<dyn Variant>)
        };
        let bad = certify_model(TANK, 0, &variants, &[], Err("not emitted".into()));
        assert_eq!(failures(&bad), ["power", "power_balance"]);
    }
}

#[test]
fn term_linear_in_rate_counts_far_from_most_states() {
    let good = certify_single_coordinate(FAR_TERM_TEXT, || FAR_TERM);
    assert!(find_check(&good, "accelerations switch_1+").passed);
    assert!(good.passed, "{:?}", failures(&good));
    let bad = certify_single_coordinate(FAR_TERM_TEXT, || SingleCoordinate {
        power: |_, _, _| 0.0,
        ..FAR_TERM
    });
    assert!(failures(&bad).contains(&"power"));
}

#[test]
fn states_outside_the_domain_are_drawn_again_and_counted() {
    let good = certify_single_coordinate(LOGARITHM, || LOGARITHMIC);
    assert!(good.passed, "{:?}", failures(&good));
    let detail = &find_check(&good, "accelerations").detail;
    assert!(
        detail.contains("were outside the model's domain and were drawn again"),
        "{detail}"
    );
    let bad = certify_single_coordinate(LOGARITHM, || SingleCoordinate {
        acceleration: |_, x, _| (3.0 / x - 3.0 * (1.0 + 1e-10)) / 2.0,
        ..LOGARITHMIC
    });
    assert!(failures(&bad).contains(&"accelerations"));
    let bad = certify_single_coordinate(LOGARITHM, || SingleCoordinate {
        acceleration: |_, x, _| if x < 0.1 { 0.0 } else { (3.0 / x - 3.0) / 2.0 },
        energy: |_, x, rate| rate * rate - 3.0 * x.ln() + 3.0 * x * (1.0 + 1e-10),
        ..LOGARITHMIC
    });
    assert!(failures(&bad).contains(&"energy"));
}

#[test]
fn certificate_without_state_in_domain_fails() {
    let text = LOGARITHM.replace("ln(x/L)", "ln(-1 - (x/L)^2)");
    let nowhere = certify_single_coordinate(&text, || LOGARITHMIC);
    assert!(!nowhere.passed);
    assert!(!find_check(&nowhere, "domain").passed);
    assert!(find_check(&nowhere, "accelerations").skipped.is_some());
}

#[test]
fn range_restricts_sampled_states() {
    let text = LOGARITHM.replace("initial = 0.5", "initial = 0.5, range = [0.2, \"2*L\"]");
    let good = certify_single_coordinate(&text, || LOGARITHMIC);
    assert!(good.passed, "{:?}", failures(&good));
    let detail = &find_check(&good, "accelerations").detail;
    assert!(detail.starts_with("200 states, "), "{detail}");
    // An error outside of the range does not count.
    let outside = certify_single_coordinate(&text, || SingleCoordinate {
        acceleration: |_, x, _| if x < 0.2 { 9.0 } else { (3.0 / x - 3.0) / 2.0 },
        ..LOGARITHMIC
    });
    assert!(find_check(&outside, "accelerations").passed);
    let inside = certify_single_coordinate(&text, || SingleCoordinate {
        acceleration: |_, x, _| if x > 1.5 { 9.0 } else { (3.0 / x - 3.0) / 2.0 },
        ..LOGARITHMIC
    });
    assert!(!find_check(&inside, "accelerations").passed);
}

#[test]
fn wrong_side_of_guard_at_rest_fails() {
    let right = certify_preload("0.0", false);
    assert!(right.passed, "{:?}", failures(&right));
    assert!(find_check(&right, "regime_kernels").passed);
    assert!(find_check(&right, "exact_derivative").passed);
    // Below, within and above the play; other combinations of sides are contradictory.
    let regimes = right.checks.iter();
    let regimes = regimes.filter(|check| check.name.starts_with("accelerations") && check.passed);
    assert_eq!(regimes.count(), 3);
    assert_eq!(failures(&certify_preload("7.0", false)), ["regime_kernels"]);
    assert_eq!(
        failures(&certify_preload("0.0", true)),
        ["exact_derivative"]
    );
}

#[test]
fn reference_is_compared_at_every_state() {
    let reference = |factor: f64| Reference {
        name: "textbook".into(),
        deviation: Box::new(move |_, state: &[f64], _: &[f64], found: &[f64]| {
            let mut rates = [0.0; 4];
            let done = DoublePendulum(Fault::None).rates(0.0, state, &[], &mut rates);
            assert_eq!(done, Ok(()));
            (found[1] - factor * rates[3]).abs() / rates[3].abs()
        }),
    };
    let variants = |_| Ok(Box::new(DoublePendulum(Fault::None)) as Box<dyn Variant>);
    for (factor, passes) in [(1.0, true), (1.0 + 1e-9, false)] {
        let references = [reference(factor)];
        let skipped = Err("not emitted".into());
        let certificate = certify_model(DOUBLE_PENDULUM, 0, &variants, &references, skipped);
        assert_eq!(
            find_check(&certificate, "reference textbook").passed,
            passes
        );
    }
}

#[test]
fn decoupled_mode_fails_nesting() {
    let good = certify_beam(3, true);
    assert!(good.passed, "{:?}", failures(&good));
    for name in [
        "nesting_mass",
        "nesting_bias",
        "nesting_forces",
        "rigid_limit_mass",
    ] {
        assert!(find_check(&good, name).passed);
    }
    let bad = certify_beam(3, false);
    assert!(failures(&bad).contains(&"nesting_mass"));
    assert!(!failures(&bad).contains(&"rigid_limit_mass"));
}

#[test]
fn variant_error_is_reported_as_failed_check() {
    let variants = |_| Err("no such order".to_owned());
    let certificate = certify_model(SPRING, 0, &variants, &[], Err("not emitted".into()));
    assert!(!certificate.passed);
    assert_eq!(certificate.checks[0].detail, "no such order");
}

fn emitted_source(source: &str) -> Emitted {
    Emitted {
        source: source.to_owned(),
        input_fields: vec!["u".into()],
        functions: vec![EmittedFunction::Rates, EmittedFunction::Energy],
        outputs: None,
    }
}

#[test]
fn emitted_source_is_compared_bit_for_bit() {
    let check = |source: &str| {
        let certificate = certify_spring(Fault::None, Ok(emitted_source(source)));
        find_check(&certificate, "emitted_rust").clone()
    };
    let good = check(EMITTED);
    if good.skipped.is_some() {
        skips::skip(&good.detail);
        return;
    }
    assert!(good.passed, "{good:?}");
    assert_eq!(good.detail, "300 numbers at 100 states");
    let rounded =
        check(&EMITTED.replace("150.0 * stretch * stretch", "150.0 * (stretch * stretch)"));
    assert!(
        !rounded.passed && rounded.detail.starts_with("first in energy"),
        "{rounded:?}"
    );
    let broken = check(&EMITTED.replace("Self { m: 2.0 }", "Self { m: two }"));
    assert!(
        !broken.passed && broken.detail.contains("emitted source failed"),
        "{broken:?}"
    );
    let panicking = check(&EMITTED.replace("[state[1], (", "[state[2 * STATES], ("));
    assert!(!panicking.passed, "{panicking:?}");
}

#[test]
fn missing_compiler_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let found = Compiler::from_program("no-such-rustc".into(), folder.path());
    assert!(found.unwrap_err().contains("no-such-rustc"));
}

fn certify_faulty_outputs(wrong: &'static str) -> Certificate {
    let model = parse_model(SPRING);
    let parameters = model.parameter_values().unwrap();
    let variants = |_| Ok(Box::new(Spring(Fault::None)) as Box<dyn Variant>);
    let outputs = || Ok(Box::new(SpringOutputs(wrong)) as Box<dyn Outputs>);
    certify(&Subject {
        model: &model,
        order: 0,
        parameters: &parameters,
        variants: &variants,
        references: &[],
        not_applicable: &[],
        outputs: Some(&outputs),
        emitted: Err("not emitted".into()),
        program: None,
        c_sources: &[],
        casadi: None,
        unit: None,
        regimes: Err("not emitted".into()),
        exact: Err("not linear".into()),
    })
}

const REQUESTED: [&str; 12] = [
    "bias_forces",
    "inverse_dynamics",
    "guard_rates",
    "rates_by_state",
    "rates_by_inputs",
    "rates_by_parameters",
    "observables_by_state",
    "observables_by_inputs",
    "observables_by_parameters",
    "jacobian_vector_product",
    "vector_jacobian_product",
    "vector_jacobian_product_by_parameters",
];

#[test]
fn output_with_error_of_one_thousandth_fails() {
    let right = certify_faulty_outputs("");
    assert!(right.passed, "{:?}", failures(&right));
    for name in REQUESTED {
        let check = find_check(&right, name);
        assert!(check.passed && check.skipped.is_none(), "{check:?}");
        assert_eq!(failures(&certify_faulty_outputs(name)), [name]);
    }
}

#[test]
fn nan_only_at_rest_is_found() {
    let rotor = certify_single_coordinate(ROTOR, || SingleCoordinate {
        // The acceleration is 0, but NaN (0/0) at zero rate.
        acceleration: |_, _, rate| rate / rate - 1.0,
        ..FREE_ROTOR
    });
    assert_eq!(failures(&rotor), ["rates_at_zeros"]);
    let detail = &find_check(&rotor, "rates_at_zeros").detail;
    assert!(detail.contains("theta_dot = 0"), "{detail}");
    let jacobian = certify_faulty_outputs("not a number at rest");
    assert_eq!(failures(&jacobian), ["jacobians_at_zeros"]);
    let right = certify_faulty_outputs("");
    for name in ["rates_at_zeros", "jacobians_at_zeros"] {
        assert!(
            find_check(&right, name).passed,
            "{:?}",
            find_check(&right, name)
        );
    }
}

#[test]
fn certificate_contains_hashes_and_parameters() {
    let certificate = certify_spring(Fault::None, Ok(emitted_source(EMITTED)));
    assert_eq!(
        certificate.specification_sha256,
        parse_model(SPRING).source.hash()
    );
    let source = eomgen_model_spec::source::sha256(EMITTED);
    assert_eq!(certificate.source_sha256, Some(source));
    let values = [("m", 2.0), ("k", 300.0), ("b", 0.01), ("c", 5.0)];
    let values = values.map(|(name, value)| (name.to_owned(), value));
    assert_eq!(certificate.parameters, values);
    let without = certify_spring(Fault::None, Err("not emitted".into()));
    assert_eq!(without.source_sha256, None);
}
