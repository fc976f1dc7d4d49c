//! Modes of beams, compared with published eigenvalues, boundary conditions, quadrature and mirrored shapes.

use eomgen_model_spec::model::End;

use super::compute_mode;
use crate::mechanics::fields::quadrature::gauss_legendre;

const ENDS: [End; 4] = [End::Clamped, End::Pinned, End::Free, End::Guided];
const MODE_NUMBERS: [usize; 6] = [1, 2, 3, 12, 64, 128];

fn all_cases() -> impl Iterator<Item = (End, End, usize)> {
    ENDS.into_iter().flat_map(|from| {
        ENDS.into_iter()
            .flat_map(move |to| MODE_NUMBERS.map(|number| (from, to, number)))
    })
}

fn vanishing_derivatives(end: End) -> [u8; 2] {
    match end {
        End::Clamped => [0, 1],
        End::Pinned => [0, 2],
        End::Free => [2, 3],
        End::Guided => [1, 3],
    }
}

// Blevins, Table 8-1; exchanged ends have equal eigenvalues.
#[test]
fn eigenvalues_match_published_table() {
    use End::{Clamped, Free, Guided, Pinned};
    let pi = std::f64::consts::PI;
    let published = [
        (Free, Free, [4.73004074, 7.85320462, 10.9956078]),
        (Free, Guided, [2.36502037, 5.49780392, 8.63937983]),
        (Clamped, Free, [1.87510407, 4.69409113, 7.85475744]),
        (Free, Pinned, [3.92660231, 7.06858275, 10.21017612]),
        (Pinned, Pinned, [pi, 2.0 * pi, 3.0 * pi]),
        (Clamped, Pinned, [3.92660231, 7.06858275, 10.21017612]),
        (Clamped, Clamped, [4.73004074, 7.85320462, 10.9956079]),
        (Clamped, Guided, [2.36502037, 5.49780392, 8.63937983]),
        (Guided, Pinned, [0.5 * pi, 1.5 * pi, 2.5 * pi]),
        (Guided, Guided, [pi, 2.0 * pi, 3.0 * pi]),
    ];
    for (from, to, eigenvalues) in published {
        for (number, eigenvalue) in (1..).zip(eigenvalues) {
            for mode in [
                compute_mode(from, to, number),
                compute_mode(to, from, number),
            ] {
                let found = mode.wavenumber;
                // The tolerance is one unit of the last printed digit.
                assert!(
                    (found - eigenvalue).abs() < 1e-7,
                    "{from:?}, {to:?}: {found}"
                );
            }
        }
    }
}

// The phase at the end is up to 403; its rounding error is 3e-14.
#[test]
fn shapes_satisfy_the_conditions_at_both_ends() {
    for (from, to, number) in all_cases() {
        let mode = compute_mode(from, to, number);
        for (end, s, values) in [(from, 0.0, mode.at_start), (to, 1.0, mode.at_end)] {
            for derivative in 0..4 {
                let k = mode.wavenumber.powi(derivative.into());
                let value = mode.shape(derivative, s) / k;
                let expected = values[usize::from(derivative)];
                let what = format!("{from:?}, {to:?}, mode {number} at {s}: {value}");
                assert!((value - expected).abs() < 1e-13, "{what}, {expected}");
                if vanishing_derivatives(end).contains(&derivative) {
                    assert!(expected == 0.0, "{what}");
                } else {
                    assert!(expected.abs() > 0.7, "{what}");
                }
            }
        }
    }
}

// Compares the closed forms of the integrals of phi^2, phi and s phi with quadrature. The tolerance allows for
// rounded nodes and phases.
#[test]
fn closed_integrals_match_quadrature() {
    for (from, to, number) in all_cases() {
        let mode = compute_mode(from, to, number);
        let rule = gauss_legendre(2 * number + 40);
        let integral = |function: &dyn Fn(f64) -> f64| -> f64 {
            let nodes = rule.nodes.iter().zip(&rule.weights);
            nodes.map(|(s, weight)| weight * function(*s)).sum()
        };
        let [one, other] = mode.mean_square;
        let square = integral(&|s| mode.shape(0, s).powi(2));
        let what = format!("{from:?}, {to:?}, mode {number}");
        assert!(
            (square / (one * other) - 1.0).abs() < 1e-13,
            "{what}: {square}"
        );
        for power in [0, 1] {
            let expected = integral(&|s| s.powi(power) * mode.shape(0, s));
            let found = mode.compute_moment(power as u32);
            let difference = (found - expected).abs();
            assert!(difference < 1e-14, "{what}: s^{power}: {found} {expected}");
        }
    }
}

#[test]
fn exchanged_ends_have_mirrored_shapes() {
    for (from, to, number) in all_cases() {
        let (one, other) = (
            compute_mode(from, to, number),
            compute_mode(to, from, number),
        );
        let mirrored = |s: f64| other.shape(0, 1.0 - s);
        let position = 0.3712;
        let factor = one.shape(0, position) / mirrored(position);
        for s in [0.05, 0.25, 0.5, 0.8, 0.97] {
            let (found, expected) = (one.shape(0, s), factor * mirrored(s));
            assert!(
                (found - expected).abs() < 1e-12 * (1.0 + factor.abs()),
                "{from:?}, {to:?}, mode {number} at {s}: {found} {expected}"
            );
        }
    }
}
