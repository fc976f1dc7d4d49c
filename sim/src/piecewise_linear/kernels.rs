//! Inner loops over SIMD vectors. These loops and their callers are compiled for several instruction sets, one
//! of which is selected at run time. All sets perform the same operations in the same order without fused
//! multiply-add, so the results are bit-identical.

use fearless_simd::{Simd, SimdBase, SimdFloat, SimdFrom, f64x4};

use super::event_function::{ValueWeights, Weights};
use super::simd_vectors::{SimdVector, SplitComplex, numbers};

/// Results of the evaluation of a function.
pub(super) struct FunctionSums {
    /// Change of the value since the start.
    pub value: f64,
    /// Sum of the magnitudes of the terms of that change.
    pub size: f64,
    /// Derivatives of order 1 to 3, each at the index of its order.
    pub derivatives: SimdVector,
    /// Contribution of the polynomial to the first derivative.
    pub polynomial_rate: f64,
}

/// Adds a product with a matrix whose rows are packed in SIMD vectors, column by column.
#[inline(always)]
pub(super) fn add_product<S: Simd>(
    simd: S,
    entries: &[SimdVector],
    columns: usize,
    vector: &[f64],
    out: &mut [SimdVector],
) {
    let mut pairs = entries.chunks_exact(2 * columns);
    let mut slots = out.chunks_exact_mut(2);
    for (rows, slots) in pairs.by_ref().zip(slots.by_ref()) {
        let (upper, lower) = rows.split_at(columns);
        let (mut a, mut b) = (load(simd, slots[0]), load(simd, slots[1]));
        for ((x, y), value) in upper.iter().zip(lower).zip(vector) {
            let value = f64x4::splat(simd, *value);
            a += load(simd, *x) * value;
            b += load(simd, *y) * value;
        }
        (slots[0], slots[1]) = (store(a), store(b));
    }
    if let (row, [slot, ..]) = (pairs.remainder(), slots.into_remainder()) {
        let mut a = load(simd, *slot);
        for (x, value) in row.iter().zip(vector) {
            a += load(simd, *x) * f64x4::splat(simd, *value);
        }
        *slot = store(a);
    }
}

/// Adds multiples of columns, which may be shorter than `out`.
#[inline(always)]
pub(super) fn add_multiples<'a, S: Simd>(
    simd: S,
    columns: impl Iterator<Item = &'a [SimdVector]>,
    factors: &[f64],
    out: &mut [SimdVector],
) {
    for (column, factor) in columns.zip(factors) {
        for (slot, entry) in out.iter_mut().zip(column) {
            *slot = store(load(simd, *slot) + load(simd, *entry) * *factor);
        }
    }
}

/// Amplitudes of modes in SIMD vectors, first the real parts: at the start, their displacement since then, and
/// at the current time.
pub(super) struct Amplitudes<'a> {
    pub start: &'a [SimdVector],
    pub moved: &'a mut [SimdVector],
    pub now: &'a mut [SimdVector],
}

impl Amplitudes<'_> {
    /// Advances the SIMD vector of real parts at index `re`, and that of the imaginary parts, by its expm1.
    #[inline(always)]
    fn advance<S: Simd>(&mut self, re: usize, vectors: usize, (c, d): (f64x4<S>, f64x4<S>)) {
        let (im, simd) = (vectors + re, c.simd);
        let (a, b) = (load(simd, self.now[re]), load(simd, self.now[im]));
        let moved_re = load(simd, self.moved[re]) + (a * c - b * d);
        let moved_im = load(simd, self.moved[im]) + (a * d + b * c);
        (self.moved[re], self.moved[im]) = (store(moved_re), store(moved_im));
        self.now[re] = store(load(simd, self.start[re]) + moved_re);
        self.now[im] = store(load(simd, self.start[im]) + moved_im);
    }
}

/// Advances modes, given their expm1 over the duration.
#[inline(always)]
pub(super) fn advance<S: Simd>(simd: S, expm1: &SplitComplex, mut amplitudes: Amplitudes<'_>) {
    let vectors = expm1.re.len();
    for simd_vector in 0..vectors {
        let expm1 = (
            load(simd, expm1.re[simd_vector]),
            load(simd, expm1.im[simd_vector]),
        );
        amplitudes.advance(simd_vector, vectors, expm1);
    }
}

/// Reciprocals of 20 to 2.
const RECIPROCALS: [f64; 19] = {
    let (mut reciprocals, mut index) = ([0.0; 19], 0);
    while index < 19 {
        reciprocals[index] = 1.0 / (20 - index) as f64;
        index += 1;
    }
    reciprocals
};

/// Advances modes of these rates by a short time, s. The expm1 is a series with `terms` + 1 terms.
#[inline(always)]
pub(super) fn advance_little<S: Simd>(
    simd: S,
    rates: &SplitComplex,
    time: f64,
    terms: usize,
    mut amplitudes: Amplitudes<'_>,
) {
    let vectors = rates.re.len();
    for simd_vector in 0..vectors {
        let (x, y) = (
            load(simd, rates.re[simd_vector]) * time,
            load(simd, rates.im[simd_vector]) * time,
        );
        let (mut c, mut d) = (f64x4::splat(simd, 1.0), f64x4::splat(simd, 0.0));
        for reciprocal in &RECIPROCALS[RECIPROCALS.len() - terms..] {
            let (u, v) = (x * *reciprocal, y * *reciprocal);
            (c, d) = ((u * c - v * d) + 1.0, u * d + v * c);
        }
        amplitudes.advance(simd_vector, vectors, (x * c - y * d, x * d + y * c));
    }
}

/// Factors of a function.
#[derive(Clone, Copy)]
pub(super) struct Factors<'a> {
    /// Factors of each mode.
    pub weights: &'a [Weights],
    /// Factors of each SIMD vector of modes, in the value.
    pub value_weights: &'a [ValueWeights],
    /// For each power of time its contribution to the value and the derivatives of order 1 to 3.
    pub terms: &'a [SimdVector],
}

/// Evaluates a function, given the amplitudes, their displacements, and the powers of the time. Writes the
/// cumulative sums over the modes to `before`: contributions of the amplitudes to the value and to the
/// derivatives of order 1 to 3.
#[inline(always)]
pub(super) fn evaluate_function<S: Simd>(
    simd: S,
    factors: Factors<'_>,
    (now, moved): (&[SimdVector], &[SimdVector]),
    powers: &[f64],
    before: &mut [SimdVector],
) -> FunctionSums {
    let zero = f64x4::splat(simd, 0.0);
    let vectors = factors.value_weights.len();
    let (re, im) = numbers(now).split_at(4 * vectors);
    let mut sums = zero;
    let modes = factors.weights.iter().zip(re).zip(im);
    let (slots, all) = before.split_at_mut(factors.weights.len());
    for (((weights, re), im), slot) in modes.zip(slots) {
        *slot = store(sums);
        sums += load(simd, weights.re) * *re - load(simd, weights.im) * *im;
    }
    all[0] = store(sums);
    // Even and odd powers have separate sums, so that consecutive additions do not depend on each other.
    let ([mut even, mut odd], mut sizes) = ([zero; 2], zero);
    let count = factors.terms.len().min(powers.len());
    let mut terms = factors.terms[..count].chunks_exact(2);
    let mut pairs = powers[..count].chunks_exact(2);
    for (terms, powers) in terms.by_ref().zip(pairs.by_ref()) {
        let a = load(simd, terms[0]) * powers[0];
        let b = load(simd, terms[1]) * powers[1];
        even += a;
        odd += b;
        sizes += a.abs() + b.abs();
    }
    for (terms, power) in terms.remainder().iter().zip(pairs.remainder()) {
        let a = load(simd, *terms) * *power;
        even += a;
        sizes += a.abs();
    }
    let polynomial = even + odd;
    let (mut value, mut size) = (zero, zero);
    let (re, im) = moved[..2 * vectors].split_at(vectors);
    for ((weights, re), im) in factors.value_weights.iter().zip(re).zip(im) {
        let (re, im) = (load(simd, *re), load(simd, *im));
        value += load(simd, weights.re) * re - load(simd, weights.im) * im;
        size += load(simd, weights.size) * (re.abs() + im.abs());
    }
    let of_polynomial = store(polynomial).to_array();
    FunctionSums {
        value: store(value).total() + of_polynomial[0],
        size: store(size).total() + store(sizes).to_array()[0],
        derivatives: store(sums + polynomial),
        polynomial_rate: of_polynomial[1],
    }
}

/// Sums the magnitudes of a function's modes, given the magnitudes of their amplitudes. Writes the cumulative
/// sums over the modes to `before`.
#[inline(always)]
pub(super) fn sum_sizes<S: Simd>(
    simd: S,
    weights: &[Weights],
    sizes: &[SimdVector],
    before: &mut [SimdVector],
) {
    let mut sums = f64x4::splat(simd, 0.0);
    let (slots, all) = before.split_at_mut(weights.len());
    for ((weights, size), slot) in weights.iter().zip(numbers(sizes)).zip(slots) {
        *slot = store(sums);
        sums += load(simd, weights.size) * *size;
    }
    all[0] = store(sums);
}

/// Writes for each power k the coefficients of the powers k to k + 3, times its factors.
#[inline(always)]
pub(super) fn shift_powers<S: Simd>(
    simd: S,
    coefficients: &[SimdVector],
    factors: &[SimdVector],
    out: &mut [SimdVector],
) {
    let shifted = numbers(coefficients).windows(4);
    for ((coefficients, factors), slot) in shifted.zip(factors).zip(out) {
        let coefficients = f64x4::from_slice(simd, coefficients);
        *slot = store(coefficients * load(simd, *factors));
    }
}

/// Returns the sum of the magnitudes of numbers in SIMD vectors, each times its factor.
#[inline(always)]
pub(super) fn sum_magnitudes<S: Simd>(simd: S, of: &[SimdVector], factors: &[SimdVector]) -> f64 {
    let mut sum = f64x4::splat(simd, 0.0);
    for (of, factors) in of.iter().zip(factors) {
        sum += load(simd, *of).abs() * load(simd, *factors);
    }
    store(sum).total()
}

/// Writes the magnitudes of amplitudes in SIMD vectors.
#[inline(always)]
pub(super) fn magnitudes<S: Simd>(
    simd: S,
    re: &[SimdVector],
    im: &[SimdVector],
    out: &mut [SimdVector],
) {
    for ((re, im), slot) in re.iter().zip(im).zip(out) {
        let (re, im) = (load(simd, *re), load(simd, *im));
        *slot = store((re * re + im * im).sqrt());
    }
}

/// Adds the power series in time of each column, from the first power on. A column has one SIMD-packed
/// coefficient vector per power.
#[inline(always)]
pub(super) fn sum_powers<'a, S: Simd>(
    simd: S,
    columns: impl Iterator<Item = &'a [SimdVector]>,
    width: usize,
    time: f64,
    out: &mut [SimdVector],
) {
    for (slots, column) in out.chunks_exact_mut(width).zip(columns) {
        for (simd_vector, slot) in slots.iter_mut().enumerate() {
            let mut sum = f64x4::splat(simd, 0.0);
            for factors in column.chunks_exact(width).rev() {
                sum = (sum + load(simd, factors[simd_vector])) * time;
            }
            *slot = store(sum);
        }
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, vector: SimdVector) -> f64x4<S> {
    f64x4::simd_from(simd, vector.to_array())
}

#[inline(always)]
fn store<S: Simd>(numbers: f64x4<S>) -> SimdVector {
    SimdVector::new(numbers.into())
}
