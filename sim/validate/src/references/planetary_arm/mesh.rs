//! Piecewise laws of a gear mesh with backlash: Eq. (7) and Eq. (8).
//!
//! `p` is the deflection along the line of action and `b` half of the backlash, in the same unit.

/// Computes f_k of Eq. (7), the deflection `p` beyond the dead band.
#[inline]
pub fn f_k(p: f64, b: f64) -> f64 {
    if p > b {
        p - b
    } else if p < -b {
        p + b
    } else {
        0.0
    }
}

/// Computes f_c of Eq. (8): the rate `p_dot` in contact, 0 inside the dead band.
#[inline]
pub fn f_c(p: f64, p_dot: f64, b: f64) -> f64 {
    if p.abs() > b { p_dot } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_band_includes_its_ends() {
        for p in [-1.0, -0.5, 0.0, 1.0] {
            assert_eq!((f_k(p, 1.0), f_c(p, 3.0, 1.0)), (0.0, 0.0));
        }
        assert_eq!((f_k(1.5, 1.0), f_c(1.5, 3.0, 1.0)), (0.5, 3.0));
        assert_eq!((f_k(-1.5, 1.0), f_c(-1.5, 3.0, 1.0)), (-0.5, 3.0));
    }
}
