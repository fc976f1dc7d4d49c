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

    /// Number `place`.
    pub fn get(&self, place: usize) -> Complex<f64> {
        let (group, lane) = (place / 4, place % 4);
        Complex::new(
            self.re[group].as_array()[lane],
            self.im[group].as_array()[lane],
        )
    }

    /// Replaces number `place`.
    pub fn set(&mut self, place: usize, value: Complex<f64>) {
        let (group, lane) = (place / 4, place % 4);
        self.re[group].as_mut_array()[lane] = value.re;
        self.im[group].as_mut_array()[lane] = value.im;
    }

    /// Multiplies number by number.
    pub fn multiply(&mut self, factors: &Self) {
        let parts = self.re.iter_mut().zip(&mut self.im);
        for ((a, b), (c, d)) in parts.zip(factors.re.iter().zip(&factors.im)) {
            (*a, *b) = (*a * *c - *b * *d, *a * *d + *b * *c);
        }
    }

    /// Multiplies every number by exp(rate time), for small arguments: seven terms.
    pub fn turn_little(&mut self, rates: &Self, time: f64) {
        let time = Lane::splat(time);
        let parts = self.re.iter_mut().zip(&mut self.im);
        for ((a, b), (p, q)) in parts.zip(rates.re.iter().zip(&rates.im)) {
            let (x, y) = (*p * time, *q * time);
            let (mut c, mut d) = (Lane::ONE, Lane::ZERO);
            for reciprocal in RECIPROCALS {
                let reciprocal = Lane::splat(reciprocal);
                let (u, v) = (x * reciprocal, y * reciprocal);
                (c, d) = (Lane::ONE + (u * c - v * d), u * d + v * c);
            }
            (*a, *b) = (*a * c - *b * d, *a * d + *b * c);
        }
    }
}

/// Of 7 to 1.
const RECIPROCALS: [f64; 7] = [1.0 / 7.0, 1.0 / 6.0, 0.2, 0.25, 1.0 / 3.0, 0.5, 1.0];

/// The largest argument of [`Pairs::turn_little`]: the first term left out is below 1e-18.
pub(super) const LITTLE: f64 = 1.0 / 64.0;

/// The sum of products, four side by side.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = [0.0; 4];
    let (left, right) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = left
        .remainder()
        .iter()
        .zip(right.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in left.zip(right) {
        for lane in 0..4 {
            sum[lane] += x[lane] * y[lane];
        }
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_turns_are_exponentials() {
        let rates = [
            Complex::new(-3.0, 40.0),
            Complex::new(0.0, 63.0),
            Complex::new(-9.0, 0.0),
        ];
        let start = [
            Complex::new(1.0, 0.0),
            Complex::new(0.3, -2.0),
            Complex::new(5.0, 0.1),
        ];
        for time in [1e-3 * LITTLE, LITTLE / 64.0, -LITTLE / 70.0] {
            let mut pairs = Pairs::of(&start);
            pairs.turn_little(&Pairs::of(&rates), time);
            for place in 0..3 {
                let wanted = start[place] * (rates[place] * time).exp();
                // A few roundings.
                assert!((pairs.get(place) - wanted).norm() < 1e-15 * wanted.norm());
            }
        }
    }
}
