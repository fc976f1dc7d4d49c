//! Modes of a regime: separate eigenvalues, and one mode per sinusoid for its forced response. The modes
//! respond to constant and sinusoidal forces.

use nalgebra::{Complex, DMatrix, DVector};

use super::decomposition::Part;
use super::integrals::Integrals;
use super::simd_vectors::{SplitComplex, simd_vectors};

/// Forces on the rates of the state.
pub(super) struct Forcing {
    /// Factors of sine and cosine of each phase.
    pub sinusoids: Vec<[DVector<f64>; 2]>,
    /// Constant rates, then rates per unit of each input.
    pub constants: Vec<DVector<f64>>,
}

/// Modes of a regime and of its sinusoids, in ascending order of the magnitude of their eigenvalues.
#[derive(Clone, Debug, Default)]
pub(super) struct Modes {
    /// Eigenvalue, or i times the frequency of a sinusoid, 1/s.
    pub rate: Vec<Complex<f64>>,
    /// Magnitude of `rate`, 1/s.
    pub magnitude: Vec<f64>,
    /// Rate of the fastest decay, 1/s; infinite if any mode grows.
    pub damping: f64,
    /// Index of the sinusoid's phase; `None` for a mode of the matrix.
    pub phase: Vec<Option<usize>>,
    /// `rate`, packed in SIMD vectors.
    pub rates: SplitComplex,
    /// Map from the state to the amplitudes without forces, modes x states.
    pub rows: DMatrix<Complex<f64>>,
    /// Map from the amplitudes to the state, states x modes; complex pairs count twice.
    pub columns: DMatrix<Complex<f64>>,
    /// Steady-state amplitudes per unit constant force and per unit of each input.
    pub rest: Vec<DVector<Complex<f64>>>,
    /// Amplitudes of the response per unit sine and per unit cosine of each phase.
    pub forced: Vec<[DVector<Complex<f64>>; 2]>,
}

impl Modes {
    /// Returns the sum of the magnitudes of the terms of the rate of a function with these weights of the
    /// modes. The result has an entry for each initial value: the state, a unit constant and the inputs, and
    /// sine and cosine of each phase.
    pub fn rate_sizes_by_start(&self, weights: &[Complex<f64>]) -> Vec<f64> {
        let own = |mode: usize, phase: usize| f64::from(self.phase[mode] == Some(phase));
        let of = |amplitude: &dyn Fn(usize) -> f64| -> f64 {
            let modes = weights.iter().zip(&self.magnitude).enumerate();
            let terms = modes.map(|(mode, (w, rate))| w.norm() * rate * amplitude(mode));
            terms.sum()
        };
        let states = (0..self.rows.ncols()).map(|s| of(&|mode| self.rows[(mode, s)].norm()));
        let units = self.rest.iter().map(|rest| of(&|mode| rest[mode].norm()));
        let pairs = self.forced.iter().enumerate();
        let phases = pairs.flat_map(|(phase, pair)| {
            let size =
                |kind: &DVector<Complex<f64>>| of(&|mode| kind[mode].norm() + own(mode, phase));
            [size(&pair[0]), size(&pair[1])]
        });
        states.chain(units).chain(phases).collect()
    }

    /// Creates the modes of parts with one eigenvalue, and of sinusoids with these frequencies, rad/s.
    pub fn new(simple: &[Part], forcing: &Forcing, frequencies: &[f64], states: usize) -> Self {
        let mut all: Vec<(Complex<f64>, Option<usize>)> = Vec::new();
        all.extend(simple.iter().map(|part| (part.centre, None)));
        let sinusoids = frequencies.iter().enumerate();
        all.extend(sinusoids.map(|(phase, f)| (Complex::new(0.0, *f), Some(phase))));
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|a, b| all[*a].0.norm().total_cmp(&all[*b].0.norm()));
        let count = order.len();
        let nothing = DVector::zeros(count);
        let mut modes = Self {
            rows: DMatrix::zeros(count, states),
            columns: DMatrix::zeros(states, count),
            rest: vec![nothing.clone(); forcing.constants.len()],
            forced: vec![[nothing.clone(), nothing]; frequencies.len()],
            ..Self::default()
        };
        for (mode, index) in order.into_iter().enumerate() {
            let (rate, phase) = all[index];
            modes.rate.push(rate);
            modes.magnitude.push(rate.norm());
            modes.phase.push(phase);
            match phase {
                None => modes.add_part(mode, &simple[index], forcing, frequencies),
                Some(phase) => {
                    let response = forced_response(simple, &forcing.sinusoids[phase], rate.im);
                    modes.columns.set_column(mode, &response);
                }
            }
        }
        modes.rates = SplitComplex::new(&modes.rate);
        let damping = |rate: &Complex<f64>| {
            if rate.re > 0.0 {
                f64::INFINITY
            } else {
                -rate.re
            }
        };
        modes.damping = modes.rate.iter().map(damping).fold(0.0, f64::max);
        modes
    }

    fn add_part(&mut self, mode: usize, part: &Part, forcing: &Forcing, frequencies: &[f64]) {
        let weighted = part.columns.column(0) * Complex::new(part.weight, 0.0);
        self.columns.set_column(mode, &weighted);
        self.rows.set_row(mode, &part.rows.row(0));
        for (rest, force) in self.rest.iter_mut().zip(&forcing.constants) {
            rest[mode] = -project(&part.rows, force)[0] / part.centre;
        }
        let sinusoids = forcing.sinusoids.iter().zip(frequencies);
        for (forced, (sinusoid, omega)) in self.forced.iter_mut().zip(sinusoids) {
            let [sine, cosine] = compute_response(part, sinusoid, *omega);
            forced[0][mode] = sine;
            forced[1][mode] = cosine;
        }
    }

    /// Adds the response of the integrals to fast sinusoids.
    pub fn add_forced_response(&mut self, integrals: &Integrals) {
        for (mode, phase) in self.phase.iter().enumerate() {
            let Some(phase) = phase else { continue };
            let [sine, cosine] = &integrals.forced[*phase];
            // Z.re sin + Z.im cos = Re((Z.im - i Z.re) exp(i theta)).
            let turned = cosine.zip_map(sine, |c, s| Complex::new(c, -s));
            let columns = integrals.columns.map(|entry| Complex::new(entry, 0.0));
            let added = self.columns.column(mode) + columns * turned;
            self.columns.set_column(mode, &added);
        }
    }

    /// Returns the number of modes.
    pub fn count(&self) -> usize {
        self.rate.len()
    }

    /// Returns the number of SIMD vectors that hold the modes.
    pub fn simd_vectors(&self) -> usize {
        simd_vectors(self.count())
    }
}

/// Returns a vector in the coordinates of a part.
pub(super) fn project(
    rows: &DMatrix<Complex<f64>>,
    vector: &DVector<f64>,
) -> DVector<Complex<f64>> {
    rows * vector.map(|entry| Complex::new(entry, 0.0))
}

/// Returns the amplitudes of a mode's response per unit sine and per unit cosine, for the force
/// beta sin theta + gamma cos theta: -(beta (rate sin + omega cos) + gamma (rate cos - omega sin)) / (rate^2 + omega^2).
fn compute_response(part: &Part, sinusoid: &[DVector<f64>; 2], omega: f64) -> [Complex<f64>; 2] {
    let rate = part.centre;
    let [beta, gamma] = [0, 1].map(|kind| project(&part.rows, &sinusoid[kind])[0]);
    let determinant = rate * rate + omega * omega;
    [
        -(beta * rate - gamma * omega) / determinant,
        -(beta * omega + gamma * rate) / determinant,
    ]
}

/// Returns the factor of exp(i theta) in the response of the modes to a sinusoid.
fn forced_response(
    simple: &[Part],
    sinusoid: &[DVector<f64>; 2],
    omega: f64,
) -> DVector<Complex<f64>> {
    let mut response = DVector::zeros(sinusoid[0].len());
    for part in simple {
        let [sine, cosine] = compute_response(part, sinusoid, omega);
        for (slot, entry) in response.iter_mut().zip(part.columns.column(0).iter()) {
            let real = |factor: Complex<f64>| part.weight * (entry * factor).re;
            *slot += Complex::new(real(cosine), -real(sine));
        }
    }
    response
}
