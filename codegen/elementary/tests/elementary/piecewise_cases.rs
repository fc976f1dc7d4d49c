//! Values of the piecewise functions at zeros, infinities, NaN and edges. All numbers are exact in both formats.

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
/// Smallest positive number of single precision.
const TINY: f64 = f32::from_bits(1) as f64;

/// `[p, b, deadzone(p, b), contact(p, b)]`.
pub const DEFLECTION_CASES: [[f64; 4]; 27] = [
    [3.0, 1.0, 2.0, 1.0],
    [-3.0, 1.0, -2.0, 1.0],
    [0.5, 1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0],
    [-1.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
    [-0.0, 0.0, 0.0, 0.0],
    [0.0, -0.0, 0.0, 0.0],
    [-0.0, -0.0, 0.0, 0.0],
    [-0.0, 1.0, 0.0, 0.0],
    [TINY, 0.0, TINY, 1.0],
    [-TINY, 0.0, -TINY, 1.0],
    [INF, 1.0, INF, 1.0],
    [-INF, 1.0, -INF, 1.0],
    [1.0, INF, 0.0, 0.0],
    [INF, INF, NAN, 0.0],
    [-INF, INF, NAN, 0.0],
    [NAN, 1.0, NAN, 0.0],
    [NAN, 0.0, NAN, 0.0],
    [NAN, -1.0, NAN, 0.0],
    [1.0, NAN, 0.0, 0.0],
    [INF, NAN, NAN, 0.0],
    [NAN, NAN, NAN, 0.0],
    // The edges of a negative width are exchanged.
    [0.5, -1.0, -0.5, 1.0],
    [-2.0, -1.0, -3.0, 1.0],
    [0.0, -1.0, -1.0, 1.0],
    [1.0, -INF, -INF, 1.0],
];

/// `[p, above(p), pivot_reciprocal(p)]`.
pub const ONE_NUMBER_CASES: [[f64; 3]; 9] = [
    [2.0, 1.0, 0.5],
    [0.25, 1.0, 4.0],
    [0.0, 0.0, NAN],
    [-0.0, 0.0, NAN],
    [-2.0, 0.0, NAN],
    [-TINY, 0.0, NAN],
    [INF, 1.0, 0.0],
    [-INF, 0.0, NAN],
    [NAN, 0.0, NAN],
];
