//! Classical Runge-Kutta method for hand-written equations in tests.

/// Integrates over a time with short steps of order 4; inputs are constant.
pub fn integrate<const N: usize>(
    state: &mut [f64; N],
    length: f64,
    parts: usize,
    rates: impl Fn(&[f64; N]) -> [f64; N],
) {
    let h = length / parts as f64;
    for _ in 0..parts {
        let along = |k: &[f64; N], part: f64| std::array::from_fn(|i| state[i] + part * h * k[i]);
        let a = rates(state);
        let b = rates(&along(&a, 0.5));
        let c = rates(&along(&b, 0.5));
        let d = rates(&along(&c, 1.0));
        *state =
            std::array::from_fn(|i| state[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
}
