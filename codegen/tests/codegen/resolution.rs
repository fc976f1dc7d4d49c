//! Integrals over a field: coefficients that the quadrature resolves are accepted, all others are rejected.

use eomgen_codegen::mechanics::fields::resolution::{State, find_largest_error_at_state};
use eomgen_codegen::program::evaluator::Point;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::source::Source;

use crate::support::{evaluator, model};

/// Returns a beam on two supports with this kinetic and potential energy; x from 0 to 2 m.
fn beam(kinetic: &str, potential: &str) -> String {
    format!(
        "[model]\nname = \"beam\"\n[parameters]\nl = {{ value = 2, unit = \"m\" }}\n\
         a = {{ value = 0.74, unit = \"m\" }}\nb = {{ value = 0.75, unit = \"m\" }}\nv = {{ value = 1, unit = \"m/s\" }}\n\
         mu = {{ value = 3, unit = \"kg/m\" }}\nEI = {{ value = 50, unit = \"N m^2\" }}\n\
         [fields.w]\nalong = \"x\"\nfrom = 0\nto = \"l\"\nbasis = \"pinned_pinned\"\ncoordinates = \"q\"\n\
         order = 2\nunit = \"m\"\n[kinetic]\nbeam = \"{kinetic}\"\n[potential]\n\
         bending = \"1/2*integral(EI*diff(w, x, 2)^2, w)\"\n{potential}"
    )
}

/// Returns the kinetic energy of a beam with this coefficient.
fn weighted(coefficient: &str) -> String {
    format!("1/2*integral(mu*({coefficient})*dot(w)^2, w)")
}

fn rejection(text: &str) -> Option<String> {
    match eomgen_model_spec::check(Source::new("beam.toml", text)) {
        Ok(checked) => {
            let orders = checked.model.orders(None).unwrap();
            let derived = Variant::derive(&checked.model, &orders);
            derived.err().map(|found| found.render(false))
        }
        Err(found) => Some(found.render(false)),
    }
}

#[test]
fn coefficients_that_change_between_the_points_are_rejected() {
    for coefficient in [
        "1 + above(x - a)",
        "1 + 200*above(x - a)*above(b - x)",
        "1 + 200*above(x - a)*above(a + 1e-7*l - x)",
        "1 + contact(x - a, b/10)",
        "1 + abs(x - a)/l",
        "1 + max(x - a, 0)/l",
        "1 + tanh((x - a)/(b/75))",
        "1 + 20*exp(-((x - a)/(b/75))^2)",
        "1 + 20*exp(-((x - a)/(b/1e6))^2)",
        "1/(1 - 0.9999*x/l)",
        "-ln(x/l)",
    ] {
        let found = rejection(&beam(&weighted(coefficient), "")).unwrap_or_default();
        assert!(
            found.contains("quadrature points"),
            "{coefficient}: {found}"
        );
        assert!(found.contains("beam.toml:19"), "{coefficient}: {found}");
    }
    for coefficient in [
        "1 - 0.5*x/l",
        "(1 - 0.9*x/l)^3",
        "exp(-60*x/l)",
        "1 + tanh((x - a)/(l/5))",
        "1/(1 + x/l)",
        "sqrt(1 + x/l)",
    ] {
        assert_eq!(
            rejection(&beam(&weighted(coefficient), "")),
            None,
            "{coefficient}"
        );
    }
}

#[test]
fn a_step_at_a_fixed_fraction_of_the_length_has_the_exact_mass() {
    let fraction = 0.37;
    for (step, share) in [
        ("above(x - 0.37*l)", [fraction, 1.0]),
        ("contact(x - 0.685*l, 0.315*l)", [0.0, fraction]),
    ] {
        let model = model(&beam(&weighted(&format!("1 + 9*{step}")), ""));
        let mut mass = [0.0; 4];
        let point = Point {
            t: 0.0,
            state: &[0.0; 4],
            inputs: &[],
        };
        evaluator(&model, 2).mass_matrix(point, &mut mass);
        let pi = std::f64::consts::PI;
        let primitive = |s: f64| 0.5 * s - (2.0 * pi * s).sin() / (4.0 * pi);
        let part = primitive(share[1]) - primitive(share[0]);
        let expected = 3.0 * 2.0 * (0.5 + 9.0 * part);
        // The sum has a hundred rounded summands.
        assert!(
            (mass[0] / expected - 1.0).abs() < 1e-14,
            "{step}: {}",
            mass[0]
        );
    }
}

#[test]
fn other_values_of_parameters_are_checked() {
    let declared = model(&beam(&weighted("1 + tanh((x - a)/b)"), ""));
    assert!(Variant::derive(&declared, &[2]).is_ok());
    let narrow = declared.with_parameter("b", 0.01).unwrap();
    assert!(Variant::derive(&narrow, &[2]).is_err());
    let point = "point = \"1/2*EI/l^3*at(w, a)^2\"";
    let declared = model(&beam(&weighted("1"), point));
    let outside = declared.with_parameter("a", 2.5).unwrap_err();
    assert!(
        outside.message.contains("2.5 m is outside the field `w`"),
        "{outside:?}"
    );
    assert!(declared.with_parameter("a", 2.0).is_ok());
    assert!(declared.with_parameter("a", -1e-9).is_err());
}

#[test]
fn loads_that_move_along_the_field_are_smooth_or_rejected() {
    let jump = "load = \"-integral(EI/l^3*above(v*t - x)*w, w)\"";
    let found = rejection(&beam(&weighted("1"), jump)).unwrap_or_default();
    assert!(found.contains("moves along the field"), "{found}");
    let narrow = "load = \"-integral(EI/l^3*exp(-((x - v*t)/(0.01*l))^2)*w, w)\"";
    let found = rejection(&beam(&weighted("1"), narrow)).unwrap_or_default();
    assert!(found.contains("at t ="), "{found}");
    let wide = "load = \"-integral(EI/l^3*exp(-((x - v*t)/(0.3*l))^2)*w, w)\"";
    assert_eq!(rejection(&beam(&weighted("1"), wide)), None);
}

#[test]
fn polynomials_of_the_field_are_integrated_exactly_up_to_order_32() {
    for (energy, degree) in [("w^4", 4), ("w^6", 6)] {
        let order = 32;
        let term = format!("bed = \"integral(EI/l^{}*{energy}, w)\"", degree + 2);
        let machine =
            model(&beam(&weighted("1"), &term).replace("EI = { value = 50", "EI = { value = 1"));
        let without =
            model(&beam(&weighted("1"), "").replace("EI = { value = 50", "EI = { value = 1"));
        let amplitudes = (1..=order).map(|r| if r % 3 == 0 { -1.0 } else { 1.0 } / f64::from(r));
        let mut state: Vec<f64> = amplitudes.collect();
        state.resize(2 * order as usize, 0.0);
        let energy = |model| {
            let point = Point {
                t: 0.0,
                state: &state,
                inputs: &[],
            };
            let mut evaluator = evaluator(model, order as usize);
            let mut observables = vec![0.0; evaluator.program().observables.len()];
            evaluator.observables(point, &mut observables);
            // The power is the last observable.
            observables[observables.len() - 2]
        };
        let found = energy(&machine) - energy(&without);
        let field = |s: f64| -> f64 {
            let modes = (1..=order).zip(&state);
            modes
                .map(|(r, q)| q * (f64::from(r) * std::f64::consts::PI * s).sin())
                .sum()
        };
        // The trapezoidal rule is exact for trigonometric polynomials over their period, which is twice the domain.
        let nodes = 4000;
        let values = (0..nodes).map(|k| field(f64::from(k) / f64::from(nodes)).powi(degree));
        let expected = 2.0 * values.sum::<f64>() / f64::from(nodes) / 2.0_f64.powi(degree + 2);
        // The tolerance covers the rounding of the bending energy, which is 1e6 times larger.
        assert!(
            (found / expected - 1.0).abs() < 1e-8,
            "{degree}: {found} {expected}"
        );
    }
}

#[test]
fn the_error_of_an_integrand_that_is_no_polynomial_is_found_at_a_state() {
    let arc = "arc = \"integral(EI/l^2*(sqrt(1 + diff(w, x)^2) - 1), w)\"";
    let model = model(&beam(&weighted("1"), arc));
    let parameters = model.parameter_values().unwrap();
    let error = |amplitude: f64| {
        let state = [amplitude, 0.2 * amplitude, 0.0, 0.0];
        let at = State {
            parameters: &parameters,
            t: 0.0,
            state: &state,
            inputs: &[],
        };
        find_largest_error_at_state(&model, &[2], at).unwrap().error
    };
    assert!(error(0.1) < 1e-12, "{}", error(0.1));
    assert!(error(10.0) > 1e-6, "{}", error(10.0));
}
