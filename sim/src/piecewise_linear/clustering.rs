//! Clusters of eigenvalues that share an invariant subspace: eigenvalues near zero, and eigenvalues close to
//! each other.

use std::ops::Range;

use nalgebra::Complex;

/// Largest magnitude of an eigenvalue near zero, as a fraction of the fastest rate or of 1 1/s. As a separate
/// mode it would respond to a constant force with a large amplitude that cancels.
const NEAR_ZERO: f64 = 1e-5;

/// Relative distance below which eigenvalues always share a subspace.
const MIN_RELATIVE_DISTANCE: f64 = 1e-9;

/// Imaginary parts below this fraction of the largest eigenvalue count as zero.
pub(super) const REAL_FRACTION: f64 = 1e-11;

/// Returns true for each eigenvalue near zero, which includes those with magnitudes up to `undetermined`, 1/s,
/// and real ones up to `slow`, 1/s.
pub(super) fn find_near_zero(
    eigenvalues: &[Complex<f64>],
    forcing: f64,
    [slow, undetermined]: [f64; 2],
) -> Vec<bool> {
    let fastest = forcing.abs().max(1.0);
    let largest = eigenvalues.iter().map(|e| e.norm()).fold(fastest, f64::max);
    // The magnitudes of a conjugate pair differ because of rounding; both must be on the same side of the bound.
    let mut bound = (NEAR_ZERO * largest).max(undetermined);
    for value in eigenvalues {
        if (value.norm() - bound).abs() < 1e-3 * bound {
            bound *= 1.01;
        }
    }
    let is_slow = |e: &Complex<f64>| e.im.abs() <= REAL_FRACTION * largest && e.re.abs() <= slow;
    eigenvalues
        .iter()
        .map(|e| e.norm() <= bound || is_slow(e))
        .collect()
}

/// Returns the cluster number of each eigenvalue, 0 for those near zero. `share` decides for two eigenvalues,
/// given their indices and relative distance.
pub(super) fn clusters(
    eigenvalues: &[Complex<f64>],
    zeros: usize,
    share: impl Fn(usize, usize, f64) -> bool,
) -> Vec<usize> {
    let mut cluster: Vec<usize> = (0..eigenvalues.len())
        .map(|place| if place < zeros { 0 } else { place + 1 })
        .collect();
    for a in zeros..eigenvalues.len() {
        for b in a + 1..eigenvalues.len() {
            let (x, y) = (eigenvalues[a], eigenvalues[b]);
            let distance = 2.0 * (x - y).norm() / (x.norm() + y.norm());
            if (distance <= MIN_RELATIVE_DISTANCE || share(a, b, distance))
                && cluster[a] != cluster[b]
            {
                let (kept, gone) = (cluster[a], cluster[b]);
                for place in &mut cluster {
                    if *place == gone {
                        *place = kept;
                    }
                }
            }
        }
    }
    cluster
}

/// Returns the index ranges of equal consecutive numbers.
pub(super) fn runs(cluster: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (place, number) in cluster.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if cluster[run.start] == *number => run.end = place + 1,
            _ => runs.push(place..place + 1),
        }
    }
    runs
}
