//! The part of a regime with eigenvalues near zero, as a Taylor series in time.
//!
//! Its coordinates obey z' = N z + f(t), where N is nearly nilpotent and f constant or
//! slowly sinusoidal; the derivatives follow one from the other and soon vanish. A sinusoid
//! that turns many times within the series' reach is answered by a sinusoid instead.

use nalgebra::{Complex, DMatrix, DVector};

use super::decomposition;
use super::forced::reciprocal;
use super::lanes::{Lane, Packed, groups, numbers, pack};
use super::modes::Forcing;

/// A sinusoid that turns by more than this within the series' reach is a fast one, rad.
const FAST: f64 = 4.0;

/// A slow one turns by no more than this: the reach is cut accordingly, rad.
const SLOW: f64 = 0.25;

/// Terms of the series that are below this part of the first are left out.
const REMAINDER: f64 = 1e-18;

/// More are never needed: arguments are below 1.
const MOST_TERMS: usize = 24;

/// A sinusoidal force on the integrals, which the series follows.
#[derive(Clone, Copy, Debug)]
struct Sinusoid {
    phase: usize,
    /// rad/s.
    frequency: f64,
}

/// The magnitudes of the factors that drive a function's rate.
#[derive(Clone, Debug, Default)]
pub(super) struct RateTerms {
    /// Of coordinates that are felt, sines and cosines.
    driving: Vec<f64>,
    /// Of a unit constant and unit inputs.
    constants: Vec<f64>,
}

/// The derivatives of a motion's integrals at its start.
#[derive(Clone, Debug, Default)]
pub(super) struct Series {
    /// Order by order, from the first on.
    pub derivatives: Vec<Lane>,
    /// What drives the next order: coordinates that are felt, sines and cosines.
    driving: Vec<f64>,
}

/// The integrals of a regime.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// How many coordinates there are.
    pub size: usize,
    /// How many of them no other one feels, the first ones.
    pure: usize,
    /// What they feel of those beyond the first `pure` ones, 1/s, and of the sine and the
    /// cosine of each slow sinusoid.
    matrix: Packed,
    /// The order of the last derivative that counts.
    orders: usize,
    /// size x states.
    pub rows: DMatrix<f64>,
    /// states x size.
    pub columns: DMatrix<f64>,
    /// Constant rates, for a unit constant and unit inputs.
    constants: Vec<Vec<Lane>>,
    sinusoids: Vec<Sinusoid>,
    /// For each phase the coordinates per sine and per cosine that it forces, if it is fast.
    pub forced: Vec<[DVector<f64>; 2]>,
}

impl Integrals {
    /// The integrals with a series that reaches as far as `window`, s, or less: returns how
    /// far.
    pub fn new(
        found: decomposition::Integrals,
        forcing: &Forcing,
        frequencies: &[f64],
        mut window: f64,
    ) -> (Self, f64) {
        let decomposition::Integrals {
            matrix,
            columns,
            rows,
            radius,
            pure,
        } = found;
        let size = matrix.nrows();
        let (mut sinusoids, mut felt, mut forced) = (Vec::new(), Vec::new(), Vec::new());
        let longest = window;
        for (phase, (pair, &frequency)) in forcing.sinusoids.iter().zip(frequencies).enumerate() {
            let force = [&rows * &pair[0], &rows * &pair[1]];
            let mut answer = [DVector::zeros(size), DVector::zeros(size)];
            if size > 0 && frequency.abs() * longest > FAST {
                answer = forced_coordinates(&matrix, &force, frequency);
            } else if force
                .iter()
                .flat_map(|f| f.iter())
                .any(|entry| *entry != 0.0)
            {
                if frequency.abs() * window > SLOW {
                    window = SLOW / frequency.abs();
                }
                sinusoids.push(Sinusoid { phase, frequency });
                felt.extend(force);
            }
            forced.push(answer);
        }
        let fastest = sinusoids.iter().map(|s| s.frequency.abs());
        let fastest = fastest.fold(radius, f64::max);
        let inner = size - pure;
        let integrals = Self {
            size,
            pure,
            matrix: Packed::of(size, inner + felt.len(), |i, j| {
                match j.checked_sub(inner) {
                    None => matrix[(i, pure + j)],
                    Some(place) => felt[place][i],
                }
            }),
            // The matrix is nilpotent but for its radius.
            orders: 1 + inner + terms(fastest * window),
            constants: forcing
                .constants
                .iter()
                .map(|force| pack((&rows * force).as_slice()))
                .collect(),
            columns,
            rows,
            sinusoids,
            forced,
        };
        (integrals, window)
    }

    /// How many groups the coordinates fill.
    pub fn groups(&self) -> usize {
        groups(self.size)
    }

    /// Writes the derivatives of order 1 to `orders` at coordinates `zeta`, order by order.
    /// Without `forces` (inputs and exp(i theta) of the phases) those of a free motion.
    pub fn derivatives(
        &self,
        zeta: &[Lane],
        forces: Option<(&[f64], &[Complex<f64>])>,
        series: &mut Series,
    ) {
        let width = zeta.len();
        let inner = self.size - self.pure;
        let Series {
            derivatives,
            driving,
        } = series;
        derivatives.clear();
        derivatives.resize(self.orders * width, Lane::ZERO);
        driving.clear();
        driving.extend_from_slice(&numbers(zeta)[self.pure..self.size]);
        for sinusoid in &self.sinusoids {
            let e = forces.map_or(Complex::new(0.0, 0.0), |(_, phases)| phases[sinusoid.phase]);
            driving.extend([e.im, e.re]);
        }
        for (order, slots) in derivatives.chunks_exact_mut(width.max(1)).enumerate() {
            self.matrix.add_product(driving, slots);
            if let (0, Some((inputs, _))) = (order, forces) {
                let factors = std::iter::once(&1.0).chain(inputs);
                for (column, factor) in self.constants.iter().zip(factors) {
                    add_multiple(column, *factor, slots);
                }
            }
            let (coordinates, waves) = driving.split_at_mut(inner);
            let found = &numbers(slots)[self.pure..self.size];
            for (slot, value) in coordinates.iter_mut().zip(found) {
                *slot = *value;
            }
            for (pair, sinusoid) in waves.chunks_exact_mut(2).zip(&self.sinusoids) {
                let omega = sinusoid.frequency;
                (pair[0], pair[1]) = (omega * pair[1], -omega * pair[0]);
            }
        }
    }

    /// Writes how far the coordinates have moved after `tau` s, given their derivatives.
    pub fn moved(&self, series: &Series, tau: f64, out: &mut [Lane]) {
        out.fill(Lane::ZERO);
        let width = out.len().max(1);
        let orders = series.derivatives.chunks_exact(width).enumerate();
        for (order, derivatives) in orders.rev() {
            let factor = Lane::splat(tau * reciprocal(order + 1));
            for (slot, derivative) in out.iter_mut().zip(derivatives) {
                *slot = (*slot + *derivative) * factor;
            }
        }
    }

    /// The terms that make up the rate of a function with these weights of the coordinates.
    pub fn rate_terms(&self, weights: &[f64]) -> RateTerms {
        let of = |entry: &dyn Fn(usize) -> f64| -> f64 {
            let terms = weights.iter().enumerate();
            terms
                .map(|(place, weight)| weight * entry(place))
                .sum::<f64>()
                .abs()
        };
        RateTerms {
            driving: (0..self.matrix.columns())
                .map(|column| of(&|row| self.matrix.entry(row, column)))
                .collect(),
            constants: self
                .constants
                .iter()
                .map(|constant| of(&|row| numbers(constant)[row]))
                .collect(),
        }
    }

    /// The sum of the magnitudes of such terms, which may cancel.
    pub fn rate_size(
        &self,
        terms: &RateTerms,
        zeta: &[Lane],
        (inputs, phases): (&[f64], &[Complex<f64>]),
    ) -> f64 {
        let inner = numbers(zeta)[self.pure..self.size].iter().copied();
        let waves = self.sinusoids.iter().flat_map(|sinusoid| {
            let e = phases[sinusoid.phase];
            [e.im, e.re]
        });
        let units = std::iter::once(1.0).chain(inputs.iter().copied());
        let driving = terms.driving.iter().zip(inner.chain(waves));
        let constants = terms.constants.iter().zip(units);
        driving
            .chain(constants)
            .map(|(size, value)| size * value.abs())
            .sum()
    }

    /// The factors of the coordinates in a linear function of the state.
    pub fn weights(&self, row: &DVector<f64>) -> Vec<f64> {
        (self.columns.transpose() * row).as_slice().to_vec()
    }
}

/// Z of the answer Im(Z exp(i theta)) to a force beta sin + gamma cos: its real and its
/// imaginary part.
fn forced_coordinates(
    matrix: &DMatrix<f64>,
    [beta, gamma]: &[DVector<f64>; 2],
    omega: f64,
) -> [DVector<f64>; 2] {
    let size = matrix.nrows();
    let mut system = matrix.map(|entry| Complex::new(-entry, 0.0));
    for place in 0..size {
        system[(place, place)] += Complex::new(0.0, omega);
    }
    let force = beta.zip_map(gamma, Complex::new);
    // Regular: the frequency is far above every eigenvalue of the matrix.
    let answer = system.lu().solve(&force);
    let answer = answer.unwrap_or_else(|| DVector::from_element(size, Complex::new(f64::NAN, 0.0)));
    [answer.map(|z| z.re), answer.map(|z| z.im)]
}

/// How many terms of an exponential series count at this argument.
fn terms(argument: f64) -> usize {
    let (mut terms, mut term) = (0, 1.0);
    while term > REMAINDER && terms < MOST_TERMS {
        terms += 1;
        term *= argument / terms as f64;
    }
    terms
}

/// out + factor column.
fn add_multiple(column: &[Lane], factor: f64, out: &mut [Lane]) {
    let factor = Lane::splat(factor);
    for (slot, entry) in out.iter_mut().zip(column) {
        *slot += *entry * factor;
    }
}
