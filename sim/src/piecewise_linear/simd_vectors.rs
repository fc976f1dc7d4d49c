//! Numbers in SIMD vectors of four, so that sums over modes are computed in parallel. The order of the
//! additions is fixed, so results are bit-identical on all processors. The loops over SIMD vectors are in
//! `kernels`.

use std::ops::{Add, AddAssign, Mul, MulAssign, Sub, SubAssign};

use bytemuck::{Pod, Zeroable};
use fearless_simd::Simd;
use nalgebra::Complex;

use super::kernels;

/// Four numbers. This is an array instead of a register type because each kernel is compiled for several
/// instruction sets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(32))]
pub(super) struct SimdVector([f64; 4]);

impl SimdVector {
    pub const ZERO: Self = Self([0.0; 4]);

    #[inline(always)]
    pub const fn new(numbers: [f64; 4]) -> Self {
        Self(numbers)
    }

    #[inline(always)]
    pub fn to_array(self) -> [f64; 4] {
        self.0
    }

    /// Returns the sum of the four numbers.
    #[inline(always)]
    pub fn total(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + c) + (b + d)
    }
}

impl Add for SimdVector {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a + e, b + f, c + g, d + h])
    }
}

impl Sub for SimdVector {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a - e, b - f, c - g, d - h])
    }
}

impl Mul for SimdVector {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a * e, b * f, c * g, d * h])
    }
}

impl AddAssign for SimdVector {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for SimdVector {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for SimdVector {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

/// Returns the number of SIMD vectors that hold `count` numbers.
pub(super) fn simd_vectors(count: usize) -> usize {
    count.div_ceil(4)
}

/// Returns numbers packed in SIMD vectors, the last one padded with zeros.
pub(super) fn pack(values: &[f64]) -> Vec<SimdVector> {
    let simd_vector = |chunk: &[f64]| {
        let mut simd_vector = [0.0; 4];
        simd_vector[..chunk.len()].copy_from_slice(chunk);
        SimdVector::new(simd_vector)
    };
    values.chunks(4).map(simd_vector).collect()
}

/// Returns the numbers of SIMD vectors in order.
pub(super) fn numbers(vectors: &[SimdVector]) -> &[f64] {
    bytemuck::cast_slice(vectors)
}

/// Returns the numbers of SIMD vectors in order, mutably.
pub(super) fn numbers_mut(vectors: &mut [SimdVector]) -> &mut [f64] {
    bytemuck::cast_slice_mut(vectors)
}

/// Real matrix with rows packed in SIMD vectors, for products with vectors.
#[derive(Clone, Debug, Default)]
pub(super) struct PackedMatrix {
    columns: usize,
    /// Entries: for each SIMD vector of rows, all columns in order.
    entries: Vec<SimdVector>,
}

impl PackedMatrix {
    /// Creates a matrix from its entries.
    pub fn new(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let entries = (0..simd_vectors(rows)).flat_map(|simd_vector| {
            let entry = &entry;
            (0..columns).map(move |column| {
                let value = |lane: usize| {
                    let row = 4 * simd_vector + lane;
                    if row < rows { entry(row, column) } else { 0.0 }
                };
                SimdVector::new([0, 1, 2, 3].map(value))
            })
        });
        let entries = entries.collect();
        Self { columns, entries }
    }

    /// Adds the product of the first columns with a vector.
    #[inline(always)]
    pub fn add_product<S: Simd>(&self, simd: S, vector: &[f64], out: &mut [SimdVector]) {
        if self.columns > 0 {
            kernels::add_product(simd, &self.entries, self.columns, vector, out);
        }
    }
}

/// Complex numbers in SIMD vectors, with separate real and imaginary parts.
#[derive(Clone, Debug, Default)]
pub(super) struct SplitComplex {
    pub re: Vec<SimdVector>,
    pub im: Vec<SimdVector>,
}

impl SplitComplex {
    /// Packs complex numbers.
    pub fn new(values: &[Complex<f64>]) -> Self {
        let part = |of: fn(&Complex<f64>) -> f64| {
            let parts: Vec<f64> = values.iter().map(of).collect();
            pack(&parts)
        };
        Self {
            re: part(|value| value.re),
            im: part(|value| value.im),
        }
    }

    /// Returns exp(rate time) - 1 of each rate.
    pub fn expm1(rates: &[Complex<f64>], time: f64) -> Self {
        let expm1: Vec<Complex<f64>> = rates.iter().map(|rate| expm1(rate * time)).collect();
        Self::new(&expm1)
    }
}

/// Returns exp(z) - 1, which is accurate for small and for large z.
pub(super) fn expm1(z: Complex<f64>) -> Complex<f64> {
    let (sine, cosine) = z.im.sin_cos();
    let grown = z.re.exp_m1();
    let half = (0.5 * z.im).sin();
    Complex::new(grown * cosine - 2.0 * half * half, (grown + 1.0) * sine)
}

/// Largest argument of [`kernels::advance_little`].
pub(super) const MAX_SMALL_ARGUMENT: f64 = 1.0;

/// Returns the number of terms of the series of expm1 for arguments up to this one: the first omitted term is
/// below 5e-19 of the sum.
pub(super) fn terms_of_expm1(argument: f64) -> usize {
    match argument {
        _ if argument <= 1e-4 => 3,
        _ if argument <= 1.0 / 64.0 => 7,
        _ if argument <= 0.25 => 12,
        _ => 19,
    }
}

#[cfg(test)]
mod tests {
    use crate::registers::dispatch_registers;

    use super::*;

    #[test]
    fn expm1_of_small_arguments_matches_exponentials() {
        let rates = [
            Complex::new(-3.0, 40.0),
            Complex::new(0.0, 63.0),
            Complex::new(-9.0, 0.0),
        ];
        let pairs = SplitComplex::new(&rates);
        for argument in [
            1e-5,
            1e-4,
            -1e-3,
            1.0 / 64.0,
            -0.1,
            0.25,
            -MAX_SMALL_ARGUMENT,
        ] {
            let time = argument / 63.0;
            // The change of a unit amplitude is its expm1.
            let start = [SimdVector::new([1.0; 4]), SimdVector::ZERO];
            let (mut moved, mut now) = ([SimdVector::ZERO; 2], start);
            let amplitudes = kernels::Amplitudes {
                start: &start,
                moved: &mut moved,
                now: &mut now,
            };
            let terms = terms_of_expm1(argument.abs());
            dispatch_registers!(simd => kernels::advance_little(simd, &pairs, time, terms, amplitudes));
            let [re, im] = moved;
            for (index, rate) in rates.iter().enumerate() {
                let found = Complex::new(re.to_array()[index], im.to_array()[index]);
                let wanted = expm1(rate * time);
                assert!((found - wanted).norm() < 1e-15 * wanted.norm());
            }
        }
    }

    #[test]
    fn expm1_of_large_arguments_matches_exponentials() {
        for z in [Complex::new(-2.0, 7.0), Complex::new(1.5, -300.0)] {
            assert!((expm1(z) - (z.exp() - 1.0)).norm() < 1e-15 * z.exp().norm());
        }
    }

    #[test]
    fn packed_matrices_multiply() {
        for (rows, columns) in [(1, 3), (4, 2), (7, 5), (9, 1), (12, 4), (3, 0)] {
            let entry = |i: usize, j: usize| (3 * i + j * j) as f64 - 4.0;
            let packed = PackedMatrix::new(rows, columns, entry);
            let vector: Vec<f64> = (0..columns).map(|j| j as f64 + 0.5).collect();
            let mut out = vec![SimdVector::new([1.0; 4]); simd_vectors(rows)];
            dispatch_registers!(simd => packed.add_product(simd, &vector, &mut out));
            for row in 0..rows {
                let wanted: f64 = (0..columns).map(|j| entry(row, j) * vector[j]).sum();
                // Small integers and halves have no rounding.
                assert_eq!(numbers(&out)[row], 1.0 + wanted);
            }
        }
    }
}
