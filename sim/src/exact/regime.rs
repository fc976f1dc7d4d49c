//! One regime: the linear motion between switches, decomposed and prepared for stepping.
//!
//! The state is the sum of a polynomial (the integrals), of exponentials (the modes, and
//! one per sinusoid for the response it forces), of a constant, and in rare cases of
//! clusters: eigenvalues that nearly agree, or that a forcing frequency nearly meets.

use codegen::affine::system::AffineSystem;
use nalgebra::{Complex, DMatrix, DVector};

use super::decomposition::{Decomposition, Failure, Integrals, Part};
use super::flow::SINUSOIDAL_ANGLE;
use super::functional::{Functional, Limits, Linear};
use super::ladder::Ladder;
use super::lanes::Pairs;

/// A forcing frequency closer to an eigenvalue than this part of it is resonant: the forced
/// and the free response grow large against each other and would cancel.
const RESONANT: f64 = 1e-3;

/// A series is used up to where its argument reaches this.
const SERIES: f64 = 0.25;

/// The remainder of a series in powers of the integrals' matrix, relative.
const REMAINDER: f64 = 1e-19;

/// The modes of a regime and its sinusoids, in ascending order of the magnitude of their
/// rates.
#[derive(Clone, Debug, Default)]
pub(super) struct Modes {
    /// Eigenvalue, or i times the frequency of a sinusoid, 1/s.
    pub rate: Vec<Complex<f64>>,
    /// Their magnitudes, 1/s.
    pub magnitude: Vec<f64>,
    /// Which phase a sinusoid belongs to; nothing for a mode.
    pub phase: Vec<Option<usize>>,
    /// The same rates in groups.
    pub rates: Pairs,
    /// Amplitudes of the modes from a state: for each state its factors in all of them.
    pub rows: Vec<Pairs>,
    /// State from an amplitude: real and imaginary columns, one after the other.
    pub columns: [Vec<f64>; 2],
    states: usize,
}

/// The polynomial part of a regime.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    /// size x size, 1/s: what the integrals feel of each other.
    pub matrix: DMatrix<f64>,
    /// states x size.
    pub columns: DMatrix<f64>,
    /// size x states.
    pub rows: DMatrix<f64>,
    /// The same, row by row.
    pub flat_rows: Vec<f64>,
    /// Powers of the matrix that count.
    pub terms: usize,
    /// For each phase the factors of its sine and of its cosine.
    pub sinusoids: Vec<[DVector<f64>; 2]>,
    /// The constant rates, for a unit constant and unit inputs.
    pub constants: Vec<DVector<f64>>,
}

/// A cluster of eigenvalues away from zero.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// What the eigenvalues are near to, 1/s.
    pub centre: Complex<f64>,
    /// size x size, 1/s.
    pub matrix: DMatrix<Complex<f64>>,
    /// states x size, with the weight of the conjugate.
    pub columns: DMatrix<Complex<f64>>,
    /// size x states.
    pub rows: DMatrix<Complex<f64>>,
    /// Powers of the matrix that count.
    pub terms: usize,
    /// For each phase the factors of its sine and of its cosine.
    pub sinusoids: Vec<[DVector<Complex<f64>>; 2]>,
    /// The constant rates, for a unit constant and unit inputs.
    pub constants: Vec<DVector<Complex<f64>>>,
}

/// A regime.
#[derive(Clone, Debug)]
pub(super) struct Regime {
    /// Its equations.
    pub system: AffineSystem,
    pub modes: Modes,
    pub polynomial: Polynomial,
    pub clusters: Vec<Cluster>,
    /// The constant part of the state, for a unit constant and unit inputs.
    pub steady: Vec<DVector<f64>>,
    /// What is watched.
    pub functionals: Vec<Functional>,
    pub ladder: Ladder,
}

impl Regime {
    /// Prepares the motion of `system` while the functions stay between their limits. Decays
    /// up to `slow`, 1/s, are carried as polynomials.
    pub fn new(
        system: AffineSystem,
        watched: Vec<(Linear, Limits)>,
        slow: f64,
    ) -> Result<Self, Failure> {
        let states = system.states;
        let matrix = DMatrix::from_row_slice(states, states, &system.rates.state);
        let frequencies: Vec<f64> = system.phases.iter().map(|phase| phase[0]).collect();
        let highest = frequencies.iter().map(|f| f.abs()).fold(0.0, f64::max);
        let decomposition = Decomposition::of(&matrix, highest, slow)?;
        let forcing = Forcing::of(&system);
        if !forcing.is_finite() || frequencies.iter().any(|f| !f.is_finite()) {
            return Err(Failure::NotFinite);
        }
        let (simple, clustered) = divide(decomposition.parts, &frequencies);
        let modes = Modes::new(&simple, &forcing, &frequencies, states);
        let fastest = modes.magnitude.last().copied().unwrap_or(0.0);
        let fastest = clustered
            .iter()
            .map(|p| p.centre.norm())
            .fold(fastest, f64::max);
        let mut window = Ladder::longest(fastest);
        let radii = clustered
            .iter()
            .map(radius)
            .chain([decomposition.integrals.radius]);
        for radius in radii {
            if radius * window > SERIES {
                window = SERIES / radius;
            }
        }
        for part in &clustered {
            // Keeps exp(-centre tau) far from overflow.
            window = window.min(100.0 / part.centre.norm());
        }
        let steady = steady(&simple, &forcing);
        let polynomial = Polynomial::new(decomposition.integrals, &forcing, window);
        let clusters: Vec<Cluster> = clustered
            .into_iter()
            .map(|part| Cluster::new(part, &forcing, window))
            .collect();
        let functionals: Vec<Functional> = watched
            .into_iter()
            .map(|(linear, limits)| {
                Functional::new(linear, limits, &modes, &polynomial, &clusters, &steady)
            })
            .collect();
        let angle = SINUSOIDAL_ANGLE;
        if functionals.iter().any(Functional::has_integrals) && highest * window > angle {
            window = angle / highest;
        }
        let ladder = Ladder::new(&modes, window, fastest);
        Ok(Self {
            system,
            modes,
            polynomial,
            clusters,
            steady,
            functionals,
            ladder,
        })
    }

    /// The rates of the state.
    pub fn rates(&self, state: &[f64], inputs: &[f64], phases: &[Complex<f64>], out: &mut [f64]) {
        let rates = &self.system.rates;
        let states = self.system.states;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for (row, slot) in out.iter_mut().enumerate() {
            let of = |block: &[f64], width: usize, values: &[f64]| {
                dot(&block[row * width..(row + 1) * width], values)
            };
            *slot = of(&rates.state, states, state)
                + of(&rates.inputs, inputs.len(), inputs)
                + rates.constant[row];
            for (place, phase) in phases.iter().enumerate() {
                let index = row * phases.len() + place;
                *slot += rates.sines[index] * phase.im + rates.cosines[index] * phase.re;
            }
        }
    }
}

/// What acts on the rates of the state.
struct Forcing {
    /// For each phase the factors of its sine and of its cosine.
    sinusoids: Vec<[DVector<f64>; 2]>,
    /// Constant, then per unit of each input.
    constants: Vec<DVector<f64>>,
}

impl Forcing {
    fn of(system: &AffineSystem) -> Self {
        let rates = &system.rates;
        let column = |block: &[f64], width: usize, place: usize| {
            DVector::from_fn(system.states, |row, _| block[row * width + place])
        };
        let phases = system.phases.len();
        let inputs = rates.inputs.len().checked_div(system.states).unwrap_or(0);
        let mut constants = vec![DVector::from_column_slice(&rates.constant)];
        constants.extend((0..inputs).map(|input| column(&rates.inputs, inputs, input)));
        Self {
            sinusoids: (0..phases)
                .map(|p| {
                    [
                        column(&rates.sines, phases, p),
                        column(&rates.cosines, phases, p),
                    ]
                })
                .collect(),
            constants,
        }
    }

    fn is_finite(&self) -> bool {
        let all = self.sinusoids.iter().flatten().chain(&self.constants);
        all.flat_map(|vector| vector.iter())
            .all(|entry| entry.is_finite())
    }
}

/// Parts of one eigenvalue away from resonance, and all others.
fn divide(parts: Vec<Part>, frequencies: &[f64]) -> (Vec<Part>, Vec<Part>) {
    parts.into_iter().partition(|part| {
        let rate = part.centre;
        let distance = |frequency: f64| {
            let upper = (rate - Complex::new(0.0, frequency)).norm();
            let lower = (rate + Complex::new(0.0, frequency)).norm();
            upper.min(lower)
        };
        let near = |f: &f64| distance(*f) < RESONANT * rate.norm().max(f.abs());
        part.matrix.nrows() == 1 && !frequencies.iter().any(near)
    })
}

/// The largest magnitude of a part's eigenvalues relative to its centre, 1/s.
fn radius(part: &Part) -> f64 {
    part.matrix
        .diagonal()
        .iter()
        .map(|e| e.norm())
        .fold(0.0, f64::max)
}

/// How many powers of a matrix of this size and radius count within a time.
fn terms(size: usize, radius: f64, window: f64) -> usize {
    let argument = radius * window;
    let (mut terms, mut term) = (size, argument);
    while term > REMAINDER && terms < size + 24 {
        terms += 1;
        term *= argument / (terms - size + 1) as f64;
    }
    terms
}

/// The constant response of the modes to unit constant and inputs.
fn steady(simple: &[Part], forcing: &Forcing) -> Vec<DVector<f64>> {
    let response = |force: &DVector<f64>| {
        let mut sum = DVector::zeros(force.len());
        for part in simple {
            let amplitude = -project(&part.rows, force)[0] / part.centre;
            for (slot, entry) in sum.iter_mut().zip(part.columns.column(0).iter()) {
                *slot += part.weight * (entry * amplitude).re;
            }
        }
        sum
    };
    forcing.constants.iter().map(response).collect()
}

fn project(rows: &DMatrix<Complex<f64>>, vector: &DVector<f64>) -> DVector<Complex<f64>> {
    rows * vector.map(|entry| Complex::new(entry, 0.0))
}

impl Modes {
    fn new(simple: &[Part], forcing: &Forcing, frequencies: &[f64], states: usize) -> Self {
        let mut all: Vec<(Complex<f64>, Option<usize>)> = Vec::new();
        all.extend(simple.iter().map(|part| (part.centre, None)));
        let sinusoids = frequencies.iter().enumerate();
        all.extend(sinusoids.map(|(phase, f)| (Complex::new(0.0, *f), Some(phase))));
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|a, b| all[*a].0.norm().total_cmp(&all[*b].0.norm()));
        let mut modes = Self {
            states,
            ..Self::default()
        };
        let mut rows = Vec::with_capacity(all.len());
        for place in order {
            let (rate, phase) = all[place];
            modes.rate.push(rate);
            modes.magnitude.push(rate.norm());
            modes.phase.push(phase);
            let (row, column) = match phase {
                None => {
                    let part = &simple[place];
                    let column = part.columns.column(0) * Complex::new(part.weight, 0.0);
                    (part.rows.row(0).transpose(), column)
                }
                Some(phase) => (
                    DVector::zeros(states),
                    forced_response(simple, &forcing.sinusoids[phase], rate.im),
                ),
            };
            rows.push(row);
            modes.columns[0].extend(column.iter().map(|entry| entry.re));
            modes.columns[1].extend(column.iter().map(|entry| entry.im));
        }
        modes.rates = Pairs::of(&modes.rate);
        modes.rows = (0..states)
            .map(|state| {
                let factors: Vec<Complex<f64>> = rows.iter().map(|row| row[state]).collect();
                Pairs::of(&factors)
            })
            .collect();
        modes
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.rate.len()
    }

    /// The factor of a mode's amplitude in a linear function of the state.
    pub fn projection(&self, mode: usize, row: &DVector<f64>) -> Complex<f64> {
        let place = mode * self.states..(mode + 1) * self.states;
        let part = |columns: &[f64]| -> f64 {
            columns[place.clone()]
                .iter()
                .zip(row.iter())
                .map(|(a, b)| a * b)
                .sum()
        };
        Complex::new(part(&self.columns[0]), part(&self.columns[1]))
    }
}

/// The factor of exp(i theta) in the response of the modes to a force beta sin theta +
/// gamma cos theta: a mode answers -(beta (rate sin + omega cos) + gamma (rate cos - omega
/// sin)) / (rate^2 + omega^2).
fn forced_response(
    simple: &[Part],
    sinusoid: &[DVector<f64>; 2],
    omega: f64,
) -> DVector<Complex<f64>> {
    let mut response = DVector::zeros(sinusoid[0].len());
    for part in simple {
        let rate = part.centre;
        let [beta, gamma] = [0, 1].map(|kind| project(&part.rows, &sinusoid[kind])[0]);
        let determinant = rate * rate + omega * omega;
        let sine = -(beta * rate - gamma * omega) / determinant;
        let cosine = -(beta * omega + gamma * rate) / determinant;
        for (slot, entry) in response.iter_mut().zip(part.columns.column(0).iter()) {
            let real = |factor: Complex<f64>| part.weight * (entry * factor).re;
            *slot += Complex::new(real(cosine), -real(sine));
        }
    }
    response
}

impl Polynomial {
    fn new(integrals: Integrals, forcing: &Forcing, window: f64) -> Self {
        let size = integrals.matrix.nrows();
        let rows = integrals.rows;
        Self {
            terms: terms(size, integrals.radius, window),
            sinusoids: forcing
                .sinusoids
                .iter()
                .map(|pair| [&rows * &pair[0], &rows * &pair[1]])
                .collect(),
            constants: forcing
                .constants
                .iter()
                .map(|force| &rows * force)
                .collect(),
            matrix: integrals.matrix,
            columns: integrals.columns,
            flat_rows: rows.transpose().iter().copied().collect(),
            rows,
        }
    }

    /// row columns N^k for every power; nothing if the row does not feel the integrals.
    pub fn projections(&self, row: &DVector<f64>) -> Vec<DVector<f64>> {
        let mut power = self.columns.transpose() * row;
        if power.iter().all(|entry| *entry == 0.0) {
            return Vec::new();
        }
        let transposed = self.matrix.transpose();
        let mut powers = Vec::with_capacity(self.terms);
        for _ in 0..self.terms {
            let next = &transposed * &power;
            powers.push(std::mem::replace(&mut power, next));
        }
        powers
    }

    /// For each phase and power the factor beta + i gamma of I_k.
    pub fn forced(&self, powers: &[DVector<f64>]) -> Vec<Vec<Complex<f64>>> {
        let factor = |power: &DVector<f64>, pair: &[DVector<f64>; 2]| {
            Complex::new(power.dot(&pair[0]), power.dot(&pair[1]))
        };
        self.sinusoids
            .iter()
            .map(|pair| powers.iter().map(|power| factor(power, pair)).collect())
            .collect()
    }
}

impl Cluster {
    fn new(part: Part, forcing: &Forcing, window: f64) -> Self {
        let rows = &part.rows;
        let project = |force: &DVector<f64>| project(rows, force);
        Self {
            terms: terms(part.matrix.nrows(), radius(&part), window),
            sinusoids: forcing
                .sinusoids
                .iter()
                .map(|pair| [project(&pair[0]), project(&pair[1])])
                .collect(),
            constants: forcing.constants.iter().map(project).collect(),
            centre: part.centre,
            columns: part.columns * Complex::new(part.weight, 0.0),
            matrix: part.matrix,
            rows: part.rows,
        }
    }

    /// row columns N^k for every power.
    pub fn projections(&self, row: &DVector<f64>) -> Vec<DVector<Complex<f64>>> {
        let mut power = self.columns.transpose() * row.map(|entry| Complex::new(entry, 0.0));
        let transposed = self.matrix.transpose();
        (0..self.terms)
            .map(|_| {
                let next = &transposed * &power;
                std::mem::replace(&mut power, next)
            })
            .collect()
    }
}
