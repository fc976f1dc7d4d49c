//! Reference: functions in 128 bits, errors in units in the last place, and deterministic arguments.

use dashu_float::{FBig, round::mode::HalfEven};

/// Floating-point number with 128 bits of significand.
pub type Exact = FBig<HalfEven, 2>;

const PRECISION: usize = 128;

/// Number of arguments in each group. The arguments are equal in every run, so that an asserted maximum is reproduced
/// exactly.
pub const ARGUMENTS_PER_GROUP: usize = 1000;

/// Converts `x` to 128 bits; `None` for infinities and NaN.
pub fn exact(x: f64) -> Option<Exact> {
    let value = Exact::try_from(x).ok()?;
    x.is_finite()
        .then(|| value.with_precision(PRECISION).value())
}

/// Returns `|result - expected|` in units in the last place of a double of `expected`'s magnitude (the
/// subnormal spacing below the normal range). An infinite result counts as 2^1024; NaN gives infinity.
pub fn ulps(result: f64, expected: &Exact) -> f64 {
    let Some(result) = exact_or_overflowed(result) else {
        return f64::INFINITY;
    };
    let difference = result - expected;
    let last_place = (leading_exponent(expected) - 52).max(-1074);
    (difference >> last_place).to_f64().value().abs()
}

fn exact_or_overflowed(x: f64) -> Option<Exact> {
    if x.is_infinite() {
        let beyond = exact(x.signum())? << 1024;
        return Some(beyond);
    }
    exact(x)
}

/// Returns the exponent of the leading bit; for zero, the exponent of the smallest subnormal.
fn leading_exponent(x: &Exact) -> isize {
    let repr = x.repr();
    match repr.digits() {
        0 => -1074,
        digits => repr.exponent() + digits as isize - 1,
    }
}

/// Asserts that the largest error of `function` over the arguments is at most `bound`.
#[track_caller]
pub fn assert_within(
    bound: f64,
    arguments: impl IntoIterator<Item = f64>,
    function: impl Fn(f64) -> f64,
    oracle: impl Fn(&Exact) -> Exact,
) {
    let (mut worst, mut at, mut count) = (-1.0, f64::NAN, 0);
    for x in arguments {
        let expected = oracle(&exact(x).expect("finite arguments"));
        let error = ulps(function(x), &expected);
        count += 1;
        if error > worst {
            (worst, at) = (error, x);
        }
    }
    println!("{count} arguments: at most {worst:.4} ulp, at {at:e}");
    assert!(count > 0, "no arguments");
    assert!(worst <= bound, "{worst} ulp at {at:e}, more than {bound}");
}

/// Applies [`assert_within`] to functions of two arguments.
#[track_caller]
pub fn assert_pairs_within(
    bound: f64,
    arguments: impl IntoIterator<Item = (f64, f64)>,
    function: impl Fn(f64, f64) -> f64,
    oracle: impl Fn(&Exact, &Exact) -> Exact,
) {
    let (mut worst, mut at, mut count) = (-1.0, (f64::NAN, f64::NAN), 0);
    for (x, y) in arguments {
        let (x_exact, y_exact) = (exact(x).expect("finite"), exact(y).expect("finite"));
        let error = ulps(function(x, y), &oracle(&x_exact, &y_exact));
        count += 1;
        if error > worst {
            (worst, at) = (error, (x, y));
        }
    }
    println!("{count} arguments: at most {worst:.4} ulp, at {at:?}");
    assert!(count > 0, "no arguments");
    assert!(worst <= bound, "{worst} ulp at {at:?}, more than {bound}");
}

/// Deterministic pseudo-random numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number uniformly distributed in `[low, high)`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// Returns a random mantissa and sign with an exponent uniform in `low..=high` (at least -1074).
    pub fn magnitude(&mut self, low: i32, high: i32) -> f64 {
        let span = (high - low + 1) as u64;
        let exponent = low + (self.bits() % span) as i32;
        let significand = f64::from_bits((self.bits() >> 12) | 1f64.to_bits());
        let sign = if self.bits() & 1 == 0 { 1.0 } else { -1.0 };
        // Two factors, because a single power cannot represent 2^-1074 with the largest exponents.
        let half = exponent / 2;
        sign * significand * 2f64.powi(half) * 2f64.powi(exponent - half)
    }
}

/// Draws [`ARGUMENTS_PER_GROUP`] arguments.
pub fn sample<T>(mut draw: impl FnMut(&mut Random) -> T) -> Vec<T> {
    let mut random = Random(1);
    (0..ARGUMENTS_PER_GROUP)
        .map(|_| draw(&mut random))
        .collect()
}

/// Draws arguments uniformly from `[low, high)`.
pub fn uniform(low: f64, high: f64) -> Vec<f64> {
    sample(|random| random.uniform(low, high))
}

/// Draws arguments of either sign with exponents uniform in `low..=high`.
pub fn magnitudes(low: i32, high: i32) -> Vec<f64> {
    sample(|random| random.magnitude(low, high))
}
