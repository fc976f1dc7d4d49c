//! One regime: the linear motion between switches, decomposed and prepared for stepping.
//!
//! The displacement since the start is a sum of a polynomial (the integrals), exponentials (the modes, and one
//! per sinusoid for its response), and in rare cases clusters: eigenvalues that nearly coincide with each other
//! or with a forcing frequency.

use eomgen_codegen::program::affine::AffineSystem;
use nalgebra::{Complex, DMatrix, DVector};

use super::decomposition::{Decomposition, DecompositionError, Part};
use super::event_function::{EventFunction, Limits, Linear};
use super::integrals::Integrals;
use super::modes::{Forcing, Modes, project};
use super::simd_vectors::PackedMatrix;
use super::step_table::StepTable;

/// Relative distance of a forcing frequency from an eigenvalue below which it is resonant. The forced and the
/// free response would then be large and cancel each other.
const RESONANCE_FRACTION: f64 = 1e-3;

/// Largest argument of a series.
const MAX_SERIES_ARGUMENT: f64 = 0.25;

/// Relative remainder of a series in powers of a cluster's matrix.
const REMAINDER: f64 = 1e-19;

/// Cluster of eigenvalues that are not near zero.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// Centre of the eigenvalues, 1/s.
    pub centre: Complex<f64>,
    /// Matrix relative to the centre, size x size, 1/s.
    pub matrix: DMatrix<Complex<f64>>,
    /// Map from the coordinates to the state, states x size; complex pairs count twice.
    pub columns: DMatrix<Complex<f64>>,
    /// Map from the state to the coordinates, size x states.
    pub rows: DMatrix<Complex<f64>>,
    /// Number of powers of the matrix that are needed.
    pub terms: usize,
    /// Factors of sine and cosine of each phase.
    pub sinusoids: Vec<[DVector<Complex<f64>>; 2]>,
    /// Constant rates per unit constant, then per unit of each input.
    pub constants: Vec<DVector<Complex<f64>>>,
}

/// A regime.
///
/// All coordinates are in one array of SIMD vectors: real parts of the modes' amplitudes, imaginary parts,
/// integrals.
#[derive(Clone, Debug)]
pub(super) struct Regime {
    /// Equations of the regime.
    pub system: AffineSystem,
    pub modes: Modes,
    pub integrals: Integrals,
    pub clusters: Vec<Cluster>,
    /// Map from the initial values (state, unit constant, inputs, and sine and cosine of each phase) to
    /// coordinates. For a free motion only the columns of the state are used.
    pub coordinates: PackedMatrix,
    /// Map from coordinates to states, with zero rows for constant states.
    pub states: PackedMatrix,
    /// Event functions.
    pub event_functions: Vec<EventFunction>,
    pub step_table: StepTable,
}

impl Regime {
    /// Prepares the motion of `system` while the functions stay between their limits. Decays up to `slow`, 1/s,
    /// are treated as polynomials.
    pub fn new(
        system: AffineSystem,
        events: Vec<(Linear, Limits)>,
        slow: f64,
    ) -> Result<Self, DecompositionError> {
        let states = system.states;
        let matrix = DMatrix::from_row_slice(states, states, &system.rates.state);
        let frequencies: Vec<f64> = system.phases.iter().map(|phase| phase[0]).collect();
        let highest = frequencies.iter().map(|f| f.abs()).fold(0.0, f64::max);
        let decomposition = Decomposition::decompose(&matrix, system.degrees, highest, slow)?;
        let forcing = Forcing::new(&system);
        if !forcing.is_finite() || frequencies.iter().any(|f| !f.is_finite()) {
            return Err(DecompositionError::NotFinite);
        }
        let (simple, clustered) = separate_simple_parts(decomposition.parts, &frequencies);
        let mut modes = Modes::new(&simple, &forcing, &frequencies, states);
        let fastest = modes.magnitude.last().copied().unwrap_or(0.0);
        let fastest = clustered
            .iter()
            .map(|p| p.centre.norm())
            .fold(fastest, f64::max);
        let mut window = StepTable::longest(fastest);
        let radii = clustered
            .iter()
            .map(radius)
            .chain([decomposition.integrals.radius]);
        for radius in radii {
            if radius * window > MAX_SERIES_ARGUMENT {
                window = MAX_SERIES_ARGUMENT / radius;
            }
        }
        for part in &clustered {
            // Prevents overflow of exp(-centre tau).
            window = window.min(100.0 / part.centre.norm());
        }
        let (integrals, window) =
            Integrals::new(decomposition.integrals, &forcing, &frequencies, window);
        modes.add_forced_response(&integrals);
        let clusters: Vec<Cluster> = clustered
            .into_iter()
            .map(|part| Cluster::new(part, &forcing, window))
            .collect();
        let event_functions: Vec<EventFunction> = events
            .into_iter()
            .map(|(linear, limits)| {
                let integrals = (&integrals, window);
                EventFunction::new(linear, limits, &modes, integrals, &clusters)
            })
            .collect();
        let layout = Layout::new(&modes, &integrals);
        Ok(Self {
            coordinates: layout.coordinates(&modes, &integrals),
            states: layout.states(&modes, &integrals, &find_constant_states(&system)),
            step_table: StepTable::new(&modes, window, fastest),
            system,
            modes,
            integrals,
            clusters,
            event_functions,
        })
    }

    /// Writes the rates of the state.
    pub fn rates(&self, state: &[f64], inputs: &[f64], phases: &[Complex<f64>], out: &mut [f64]) {
        rates(&self.system, state, inputs, phases, out);
    }
}

/// Writes the rates of the state by a system's equations.
pub(super) fn rates(
    system: &AffineSystem,
    state: &[f64],
    inputs: &[f64],
    phases: &[Complex<f64>],
    out: &mut [f64],
) {
    let rates = &system.rates;
    let states = system.states;
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

/// Positions of the coordinates in their array.
struct Layout {
    /// Number of SIMD vectors of the real parts of the modes' amplitudes.
    modes: usize,
    /// Number of SIMD vectors of the array.
    vectors: usize,
}

impl Layout {
    fn new(modes: &Modes, integrals: &Integrals) -> Self {
        Self {
            modes: 4 * modes.simd_vectors(),
            vectors: 2 * modes.simd_vectors() + integrals.simd_vectors(),
        }
    }

    /// Returns amplitudes and integrals in one vector.
    fn pack(
        &self,
        amplitudes: &DVector<Complex<f64>>,
        integrals: Option<&DVector<f64>>,
    ) -> Vec<f64> {
        let mut packed = vec![0.0; 4 * self.vectors];
        for (mode, amplitude) in amplitudes.iter().enumerate() {
            packed[mode] = amplitude.re;
            packed[self.modes + mode] = amplitude.im;
        }
        for (place, value) in integrals.into_iter().flat_map(|v| v.iter()).enumerate() {
            packed[2 * self.modes + place] = *value;
        }
        packed
    }

    /// Returns the map from the initial values (state, unit constant, inputs, and sines and cosines) to
    /// coordinates. The amplitude of a mode excludes its response to constant and sinusoidal forces.
    fn coordinates(&self, modes: &Modes, integrals: &Integrals) -> PackedMatrix {
        let column = |matrix: &DMatrix<f64>, state: usize| matrix.column(state).clone_owned();
        let mut columns: Vec<Vec<f64>> = (0..modes.rows.ncols())
            .map(|state| {
                let amplitudes = modes.rows.column(state).clone_owned();
                self.pack(&amplitudes, Some(&column(&integrals.rows, state)))
            })
            .collect();
        columns.extend(modes.rest.iter().map(|rest| self.pack(&-rest, None)));
        for (phase, (of_modes, of_integrals)) in
            modes.forced.iter().zip(&integrals.forced).enumerate()
        {
            for kind in [0, 1] {
                let mut column = self.pack(&-&of_modes[kind], Some(&-&of_integrals[kind]));
                for (mode, of) in modes.phase.iter().enumerate() {
                    if *of == Some(phase) {
                        // The amplitude of a sinusoid is exp(i theta).
                        column[mode] = if kind == 0 { 0.0 } else { 1.0 };
                        column[self.modes + mode] = if kind == 0 { 1.0 } else { 0.0 };
                    }
                }
                columns.push(column);
            }
        }
        PackedMatrix::new(4 * self.vectors, columns.len(), |row, column| {
            columns[column][row]
        })
    }

    /// Returns the map from coordinates to states. States that are `still` are exactly constant.
    fn states(&self, modes: &Modes, integrals: &Integrals, still: &[bool]) -> PackedMatrix {
        let states = modes.columns.nrows();
        let width = 2 * self.modes + integrals.size;
        PackedMatrix::new(states, width, |state, column| {
            let (kind, place) = (column / self.modes.max(1), column % self.modes.max(1));
            match kind {
                _ if still[state] => 0.0,
                _ if column >= 2 * self.modes => {
                    integrals.columns[(state, column - 2 * self.modes)]
                }
                0 => modes.columns.get((state, place)).map_or(0.0, |z| z.re),
                _ => modes.columns.get((state, place)).map_or(0.0, |z| -z.im),
            }
        })
    }
}

/// Returns true for each state whose rate is identically zero.
fn find_constant_states(system: &AffineSystem) -> Vec<bool> {
    let rates = &system.rates;
    let blocks = [
        &rates.state,
        &rates.inputs,
        &rates.sines,
        &rates.cosines,
        &rates.constant,
    ];
    let is_still = |state: usize| {
        blocks.iter().all(|block| {
            let width = block.len() / system.states;
            let row = &block[state * width..(state + 1) * width];
            row.iter().all(|entry| *entry == 0.0)
        })
    };
    (0..system.states).map(is_still).collect()
}

impl Forcing {
    fn new(system: &AffineSystem) -> Self {
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

/// Separates parts with one eigenvalue away from resonance from all other parts.
fn separate_simple_parts(parts: Vec<Part>, frequencies: &[f64]) -> (Vec<Part>, Vec<Part>) {
    parts.into_iter().partition(|part| {
        let rate = part.centre;
        let distance = |frequency: f64| {
            let upper = (rate - Complex::new(0.0, frequency)).norm();
            let lower = (rate + Complex::new(0.0, frequency)).norm();
            upper.min(lower)
        };
        let near = |f: &f64| distance(*f) < RESONANCE_FRACTION * rate.norm().max(f.abs());
        part.matrix.nrows() == 1 && !frequencies.iter().any(near)
    })
}

/// Returns the largest magnitude of a part's eigenvalues relative to its centre, 1/s.
fn radius(part: &Part) -> f64 {
    part.matrix
        .diagonal()
        .iter()
        .map(|e| e.norm())
        .fold(0.0, f64::max)
}

/// Returns the number of powers of a matrix of this size and radius that are needed within a time.
fn terms(size: usize, radius: f64, window: f64) -> usize {
    let argument = radius * window;
    let (mut terms, mut term) = (size, argument);
    while term > REMAINDER && terms < size + 24 {
        terms += 1;
        term *= argument / (terms - size + 1) as f64;
    }
    terms
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

    /// Returns row columns N^k for every power k.
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
