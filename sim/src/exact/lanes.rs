//! Numbers in groups of four, so that sums over modes run side by side: the order of the
//! additions is fixed, and with it every bit of the result, whatever the processor.

use nalgebra::Complex;
use wide::f64x4;

/// Four numbers.
pub(super) type Lane = f64x4;

/// How many groups hold so many numbers.
pub(super) fn groups(count: usize) -> usize {
    count.div_ceil(4)
}

/// Numbers in groups, the last one filled with zeros.
pub(super) fn pack(values: &[f64]) -> Vec<Lane> {
    let group = |chunk: &[f64]| {
        let mut group = [0.0; 4];
        group[..chunk.len()].copy_from_slice(chunk);
        Lane::from(group)
    };
    values.chunks(4).map(group).collect()
}

/// The numbers of groups, one after the other.
pub(super) fn numbers(groups: &[Lane]) -> &[f64] {
    bytemuck::cast_slice(groups)
}

/// The same, to be written.
pub(super) fn numbers_mut(groups: &mut [Lane]) -> &mut [f64] {
    bytemuck::cast_slice_mut(groups)
}

/// A real matrix whose rows stand in groups, for products with vectors.
#[derive(Clone, Debug, Default)]
pub(super) struct Packed {
    columns: usize,
    /// Group of rows by group of rows, in each the columns one after the other.
    entries: Vec<Lane>,
}

impl Packed {
    /// A matrix from its entries.
    pub fn of(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let entries = (0..groups(rows)).flat_map(|group| {
            let entry = &entry;
            (0..columns).map(move |column| {
                let value = |lane: usize| {
                    let row = 4 * group + lane;
                    if row < rows { entry(row, column) } else { 0.0 }
                };
                Lane::from([0, 1, 2, 3].map(value))
            })
        });
        let entries = entries.collect();
        Self { columns, entries }
    }

    /// How many columns there are.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// An entry.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        self.entries[(row / 4) * self.columns + column].as_array()[row % 4]
    }

    /// Adds the product with a vector.
    pub fn add_product(&self, vector: &[f64], out: &mut [Lane]) {
        let columns = self.columns;
        if columns == 0 {
            return;
        }
        let vector = &vector[..columns];
        let mut pairs = self.entries.chunks_exact(2 * columns);
        let mut slots = out.chunks_exact_mut(2);
        for (rows, slots) in pairs.by_ref().zip(slots.by_ref()) {
            let (upper, lower) = rows.split_at(columns);
            let (mut a, mut b) = (slots[0], slots[1]);
            for ((x, y), value) in upper.iter().zip(lower).zip(vector) {
                let value = Lane::splat(*value);
                a += *x * value;
                b += *y * value;
            }
            (slots[0], slots[1]) = (a, b);
        }
        if let (row, [slot, ..]) = (pairs.remainder(), slots.into_remainder()) {
            for (x, value) in row.iter().zip(vector) {
                *slot += *x * Lane::splat(*value);
            }
        }
    }
}

/// Complex numbers in groups, real and imaginary parts apart.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    pub re: Vec<Lane>,
    pub im: Vec<Lane>,
}

impl Pairs {
    /// Complex numbers in groups.
    pub fn of(values: &[Complex<f64>]) -> Self {
        let part = |of: fn(&Complex<f64>) -> f64| {
            let parts: Vec<f64> = values.iter().map(of).collect();
            pack(&parts)
        };
        Self {
            re: part(|value| value.re),
            im: part(|value| value.im),
        }
    }

    /// exp(rate time) - 1 of each rate.
    pub fn gains(rates: &[Complex<f64>], time: f64) -> Self {
        let gains: Vec<Complex<f64>> = rates.iter().map(|rate| gain(rate * time)).collect();
        Self::of(&gains)
    }

    /// exp(rate time) - 1 of a group of these rates by one more than so many terms of the
    /// series.
    #[inline(always)]
    pub fn little_gain(&self, group: usize, time: Lane, terms: usize) -> (Lane, Lane) {
        let (x, y) = (self.re[group] * time, self.im[group] * time);
        let (mut c, mut d) = (Lane::ONE, Lane::ZERO);
        for reciprocal in &RECIPROCALS[7 - terms..] {
            let reciprocal = Lane::splat(*reciprocal);
            let (u, v) = (x * reciprocal, y * reciprocal);
            (c, d) = (Lane::ONE + (u * c - v * d), u * d + v * c);
        }
        (x * c - y * d, x * d + y * c)
    }
}

/// exp(z) - 1, as accurate for small z as for large ones.
pub(super) fn gain(z: Complex<f64>) -> Complex<f64> {
    let (sine, cosine) = z.im.sin_cos();
    let grown = z.re.exp_m1();
    let half = (0.5 * z.im).sin();
    Complex::new(grown * cosine - 2.0 * half * half, (grown + 1.0) * sine)
}

/// Of 8 to 2.
const RECIPROCALS: [f64; 7] = [0.125, 1.0 / 7.0, 1.0 / 6.0, 0.2, 0.25, 1.0 / 3.0, 0.5];

/// The largest argument of [`Pairs::little_gain`] with seven terms: the first term left out is below 1e-19.
pub(super) const LITTLE: f64 = 1.0 / 64.0;

/// The same with three terms.
pub(super) const TINY: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_gains_are_exponentials_less_one() {
        let rates = [
            Complex::new(-3.0, 40.0),
            Complex::new(0.0, 63.0),
            Complex::new(-9.0, 0.0),
        ];
        let pairs = Pairs::of(&rates);
        for time in [1e-3 * LITTLE, LITTLE / 64.0, -LITTLE / 70.0] {
            let (re, im) = pairs.little_gain(0, Lane::splat(time), 7);
            for (place, rate) in rates.iter().enumerate() {
                let found = Complex::new(re.as_array()[place], im.as_array()[place]);
                let wanted = gain(rate * time);
                // A few roundings of either.
                assert!((found - wanted).norm() < 1e-15 * wanted.norm());
            }
        }
    }

    #[test]
    fn gains_of_large_arguments_are_exponentials_less_one() {
        for z in [Complex::new(-2.0, 7.0), Complex::new(1.5, -300.0)] {
            assert!((gain(z) - (z.exp() - 1.0)).norm() < 1e-15 * z.exp().norm());
        }
    }

    #[test]
    fn packed_matrices_multiply() {
        for (rows, columns) in [(1, 3), (4, 2), (7, 5), (9, 1), (12, 4), (3, 0)] {
            let entry = |i: usize, j: usize| (3 * i + j * j) as f64 - 4.0;
            let packed = Packed::of(rows, columns, entry);
            let vector: Vec<f64> = (0..columns).map(|j| j as f64 + 0.5).collect();
            let mut out = vec![Lane::ONE; groups(rows)];
            packed.add_product(&vector, &mut out);
            for row in 0..rows {
                let wanted: f64 = (0..columns).map(|j| entry(row, j) * vector[j]).sum();
                // Small integers and halves: no rounding.
                assert_eq!(numbers(&out)[row], 1.0 + wanted);
            }
        }
    }
}
