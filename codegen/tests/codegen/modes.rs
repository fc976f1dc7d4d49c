//! Mode tables compared with published digits, with a reference of 25 digits, and with integrals by an
//! independent rule.

use eomgen_codegen::mechanics::fields::modes::table;
use eomgen_codegen::symbolic::tables::TableKind;
use eomgen_model_spec::model::Basis;

use crate::support::{evaluator, model, observables};

const EXACT: Basis = Basis::CLAMPED_FREE;
const PRINTED: Basis = Basis::ClampedFreePrinted;

fn moment(power: u32, derivative: u8) -> TableKind {
    TableKind::Moment { power, derivative }
}

fn pair(power: u32, left: u8, right: u8) -> TableKind {
    TableKind::PairMoment { power, left, right }
}

fn own(power: u32, left: u8, right: u8) -> TableKind {
    TableKind::OwnMoment { power, left, right }
}

// Eigenvalues and sigma = -1/xi of the clamped-free beam in R. D. Blevins, "Formulas for Natural Frequency
// and Mode Shape" (1979), Table 8-1, case 3.
#[test]
fn eigenvalues_match_published_table() {
    let published = [
        (1.87510407, 0.734095514),
        (4.69409113, 1.018467319),
        (7.85475744, 0.999224497),
        (10.99554073, 1.000033553),
        (14.13716839, 0.999998550),
    ];
    let (beta, xi) = (
        table(&EXACT, 5, TableKind::Wavenumber),
        table(&EXACT, 5, TableKind::Mixing),
    );
    for (r, (eigenvalue, sigma)) in published.into_iter().enumerate() {
        // Slightly more than half a unit of the last printed digit.
        assert!(
            (beta[r] - eigenvalue).abs() < 6e-9,
            "mode {}: {}",
            r + 1,
            beta[r]
        );
        assert!(
            (-1.0 / xi[r] - sigma).abs() < 6e-10,
            "mode {}: {}",
            r + 1,
            -1.0 / xi[r]
        );
    }
}

// The first root of the printed Eq. (18) is 16 % too small.
#[test]
fn printed_eigenvalues_are_not_the_roots() {
    let (exact, printed) = (
        table(&EXACT, 2, TableKind::Wavenumber),
        table(&PRINTED, 2, TableKind::Wavenumber),
    );
    assert!((printed[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!((printed[0] / exact[0] - 0.8377).abs() < 1e-4);
    assert!((exact[0].cos() * exact[0].cosh() + 1.0).abs() < 1e-14);
    assert!((printed[0].cos() * printed[0].cosh() + 1.0).abs() > 0.9);
}

#[test]
fn tables_match_reference_of_25_digits() {
    let text = include_str!("../../../tests/reference/clamped_free_modes.json");
    let rows: Vec<serde_json::Value> = serde_json::from_str(text).unwrap();
    assert_eq!(rows.len(), 128);
    let tables = [
        ("beta_l", TableKind::Wavenumber),
        ("xi", TableKind::Mixing),
        ("int_phi2", own(0, 0, 0)),
        ("int_s_phi", moment(1, 0)),
        ("int_phi_ss2", own(0, 2, 2)),
        ("phi_tip", TableKind::ShapeAtEnd(0)),
    ];
    for (name, kind) in tables {
        for (row, found) in rows.iter().zip(table(&EXACT, 128, kind)) {
            let expected: f64 = row[name].as_str().unwrap().parse().unwrap();
            let deviation = (found / expected - 1.0).abs();
            assert!(
                deviation < 1e-13,
                "{name} of mode {}: {found}, {deviation:e}",
                row["r"]
            );
        }
    }
    let middle = shapes_in_the_middle(128);
    for (row, found) in rows.iter().zip(middle) {
        let expected: f64 = row["phi_mid"].as_str().unwrap().parse().unwrap();
        // The phase beta l/2, up to 201, has a rounding error of 3e-14; shapes are of size 1.
        assert!(
            (found - expected).abs() < 1e-13,
            "phi_mid of mode {}: {found}",
            row["r"]
        );
    }
}

/// Returns phi_r(1/2), computed by at(w, l/2).
fn shapes_in_the_middle(order: usize) -> Vec<f64> {
    let model = model(&beam(
        "clamped_free",
        "middle = { value = \"at(w, l/2)\", unit = \"m\" }",
    ));
    let mut evaluator = evaluator(&model, order);
    (0..order)
        .map(|r| {
            let mut state = vec![0.0; 2 * order];
            state[r] = 1.0;
            observables(&mut evaluator, 0.0, &state)[0]
        })
        .collect()
}

fn beam(basis: &str, observables: &str) -> String {
    format!(
        r#"
[model]
name = "beam"
title = "A beam"

[parameters]
mu = {{ value = 2.0, unit = "kg/m" }}
B  = {{ value = 3.0, unit = "N m^2" }}
l  = {{ value = 0.7, unit = "m" }}

[fields.w]
along = "x"
from = 0
to = "l"
basis = "{basis}"
coordinates = "q"
order = 2
unit = "m"

[kinetic]
beam = "1/2*integral(mu*dot(w)^2, w)"

[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"

[observables]
{observables}
"#
    )
}

/// Computes phi_r^(a)(s) by hyperbolic functions, accurate to at least six digits for the first modes.
fn shape(beta: f64, xi: f64, derivative: u8, s: f64) -> f64 {
    let z = beta * s;
    let value = match derivative {
        0 => z.sin() - z.sinh() + xi * (z.cos() - z.cosh()),
        1 => z.cos() - z.cosh() + xi * (-z.sin() - z.sinh()),
        _ => -z.sin() - z.sinh() + xi * (-z.cos() - z.cosh()),
    };
    value * beta.powi(i32::from(derivative))
}

/// Integrates by the composite Simpson rule with 4000 intervals.
fn integral(function: impl Fn(f64) -> f64) -> f64 {
    let n = 4000;
    let h = 1.0 / f64::from(n);
    let weight = |k: i32| {
        if k == 0 || k == n {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    (0..=n)
        .map(|k| weight(k) * function(f64::from(k) * h))
        .sum::<f64>()
        * h
        / 3.0
}

// Every kind of moment, in both bases, with and without a closed form. The relative error of Simpson's rule is (beta
// h)^4/180 = 1e-12. The hyperbolic functions have errors of cosh(11) = 3e4 units in the last place.
#[test]
fn moments_match_composite_rule() {
    for basis in [&EXACT, &PRINTED] {
        for power in 0..4 {
            for a in 0..3 {
                moments_of(basis, power, a);
                (0..3).for_each(|b| moments_of_pairs(basis, power, a, b));
            }
        }
    }
}

const ORDER: usize = 4;

/// Compares a number with the integral of s^power times `function`.
fn compare(found: f64, power: u32, function: impl Fn(f64) -> f64, what: &str) {
    let weighted = |s: f64| s.powi(power as i32) * function(s);
    let (expected, scale) = (integral(weighted), integral(|s| weighted(s).abs()));
    assert!(
        (found - expected).abs() < 1e-10 * scale,
        "{what}: {found} {expected}"
    );
}

fn shapes(basis: &Basis) -> impl Fn(usize, u8, f64) -> f64 {
    let beta = table(basis, ORDER, TableKind::Wavenumber);
    let xi = table(basis, ORDER, TableKind::Mixing);
    move |r, derivative, s| shape(beta[r], xi[r], derivative, s)
}

fn moments_of(basis: &Basis, power: u32, a: u8) {
    let phi = shapes(basis);
    for (r, found) in table(basis, ORDER, moment(power, a))
        .into_iter()
        .enumerate()
    {
        let what = format!("{basis:?}, s^{power} phi_{r}^({a})");
        compare(found, power, |s| phi(r, a, s), &what);
    }
}

fn moments_of_pairs(basis: &Basis, power: u32, a: u8, b: u8) {
    let phi = shapes(basis);
    let owns = table(basis, ORDER, own(power, a, b));
    for (place, found) in table(basis, ORDER, pair(power, a, b))
        .into_iter()
        .enumerate()
    {
        let (r, p) = (place / ORDER, place % ORDER);
        let what = format!("{basis:?}, s^{power} phi_{r}^({a}) phi_{p}^({b})");
        compare(found, power, |s| phi(r, a, s) * phi(p, b, s), &what);
        if r == p {
            compare(owns[r], power, |s| phi(r, a, s) * phi(r, b, s), &what);
        }
    }
}

// Shapes and curvatures of different modes are orthogonal up to rounding of the largest product of two modes.
#[test]
fn exact_modes_are_orthogonal_and_printed_ones_are_not() {
    let order = 64;
    let beta = table(&EXACT, order, TableKind::Wavenumber);
    for derivative in [0, 2] {
        let pairs = table(&EXACT, order, pair(0, derivative, derivative));
        for r in 0..order {
            for p in (0..order).filter(|p| *p != r) {
                let scale = (beta[r] * beta[p]).powi(derivative.into());
                let product = pairs[r * order + p];
                assert!(
                    product.abs() < 1e-12 * scale,
                    "{derivative}: modes {r}, {p}: {product:e}"
                );
            }
        }
    }
    let pairs = table(&PRINTED, 2, pair(0, 0, 0));
    assert!(
        pairs[1].abs() > 0.1,
        "the printed modes are orthogonal: {}",
        pairs[1]
    );
}

// A free end has no moment and no shear; the printed Eq. (19) has both.
#[test]
fn only_exact_modes_satisfy_free_end_conditions() {
    let fourth = |basis: &Basis, order: usize, a: u8| {
        let beta = table(basis, order, TableKind::Wavenumber);
        let at_end = table(basis, order, TableKind::ShapeAtEnd(a));
        at_end
            .iter()
            .zip(&beta)
            .map(|(value, beta)| value / beta.powi(a.into()))
            .collect::<Vec<_>>()
    };
    for derivative in [2, 3] {
        assert!(
            fourth(&EXACT, 128, derivative)
                .iter()
                .all(|value| *value == 0.0)
        );
        assert!(
            fourth(&PRINTED, 3, derivative)
                .iter()
                .all(|value| value.abs() > 0.5)
        );
    }
    for basis in [&EXACT, &PRINTED] {
        for derivative in [0, 1] {
            let root = table(basis, 128, TableKind::ShapeAtStart(derivative));
            assert!(root.iter().all(|value| *value == 0.0));
        }
    }
}

// All tables without a closed form are computed from shapes at quadrature nodes. These shapes satisfy phi'''' =
// beta^4 phi. The test compares the integral of phi''^2 with that of phi^2.
#[test]
fn shapes_at_nodes_keep_their_digits_at_high_orders() {
    let order = 128;
    let nodes = table(&EXACT, order, TableKind::NodeWeight);
    let xi = table(&EXACT, order, TableKind::Mixing);
    let beta = table(&EXACT, order, TableKind::Wavenumber);
    for derivative in [0, 2] {
        let shapes = table(&EXACT, order, TableKind::ShapeAtNodes(derivative));
        for r in 0..order {
            let square: f64 = nodes
                .iter()
                .enumerate()
                .map(|(g, w)| w * shapes[g * order + r].powi(2))
                .sum();
            let expected = (xi[r] * beta[r].powi(derivative.into())).powi(2);
            assert!(
                (square / expected - 1.0).abs() < 1e-12,
                "mode {}: {square}",
                r + 1
            );
        }
    }
}
