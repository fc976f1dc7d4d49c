//! Integrals: the part of a regime with eigenvalues near zero, as a Taylor series in time.
//!
//! Its coordinates z obey z' = N z + f(t), where N is nearly nilpotent and f is constant or slowly sinusoidal.
//! The causes c of z' are coordinates, constants and sinusoids, and obey c' = G c. Hence z changes by the sum
//! over k of tau^k / k! H G^(k-1) c. The terms soon vanish, and all factors except c are known before the
//! motion. If a sinusoid has many periods within the range of the series, its response is computed as a
//! sinusoid instead.

use fearless_simd::Simd;
use nalgebra::{Complex, DMatrix, DVector};

use super::decomposition;
use super::forced_integrals::reciprocal;
use super::kernels;
use super::modes::Forcing;
use super::simd_vectors::{SimdVector, numbers, pack, simd_vectors};

/// Smallest angle of a fast sinusoid within the range of the series, rad.
const FAST_TURN_RAD: f64 = 4.0;

/// Largest angle of a slow sinusoid, rad; it limits the range of the series.
const MAX_SLOW_TURN_RAD: f64 = 1.0;

/// Terms of the series below this fraction of the largest are omitted.
const REMAINDER: f64 = 1e-19;

/// Near times, as a fraction of the window. Fewer powers of time are needed there.
const NEAR_FRACTION: f64 = 1.0 / 32.0;

/// Maximum number of terms of a series with an argument below 1.
const MAX_TERMS: usize = 24;

/// Coefficients of a function's polynomial in time per unit of each cause.
#[derive(Clone, Debug, Default)]
pub(super) struct Polynomial {
    /// SIMD vectors of the coefficients of the powers of time, for each cause. The coefficient of the power 0
    /// is zero.
    columns: Vec<Vec<SimdVector>>,
    /// Number of powers needed at near times.
    near_powers: usize,
    /// Magnitudes of the first coefficients.
    rates: Vec<f64>,
    /// For each power k, factors from the coefficients of the powers k to k + 3 to those of the power k in the
    /// derivatives of order 0 to 3.
    factors: Vec<SimdVector>,
    /// For each SIMD vector of coefficients, factors of their magnitudes in a bound of the fourth derivative.
    fourth: Vec<SimdVector>,
}

/// Integrals of a regime.
///
/// Their *causes* are the coordinates that affect others, a unit constant, the inputs, and sine and cosine of
/// each slow sinusoid.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// Number of coordinates.
    pub size: usize,
    /// Number of coordinates that affect no other coordinate; they are the first ones.
    pure: usize,
    /// Rates of all coordinates per unit of each cause, 1/s.
    rates: DMatrix<f64>,
    /// Rates of the causes per unit of each cause, 1/s.
    generator: DMatrix<f64>,
    /// Order of the highest derivative that matters.
    orders: usize,
    /// SIMD vectors of the coordinates' coefficients per unit of each cause, for each power of time from the
    /// first on.
    by_cause: Vec<Vec<SimdVector>>,
    /// Number of powers needed at near times for each cause, and upper bound of near times, s.
    near_powers: Vec<usize>,
    near: f64,
    /// size x states.
    pub rows: DMatrix<f64>,
    /// states x size.
    pub columns: DMatrix<f64>,
    /// Phases of the slow sinusoids.
    sinusoids: Vec<usize>,
    /// Response of the coordinates per unit sine and per unit cosine of each phase, if its sinusoid is fast.
    pub forced: Vec<[DVector<f64>; 2]>,
}

impl Integrals {
    /// Prepares the integrals, with a series that is valid up to `window`, s, or less. Returns this time as
    /// well.
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
            let acts = force.iter().flat_map(|f| f.iter()).any(|f| *f != 0.0);
            if size > 0 && frequency.abs() * longest > FAST_TURN_RAD {
                answer = solve_forced_coordinates(&matrix, &force, frequency);
            } else if acts {
                if frequency.abs() * window > MAX_SLOW_TURN_RAD {
                    window = MAX_SLOW_TURN_RAD / frequency.abs();
                }
                sinusoids.push(phase);
                felt.extend(force);
            }
            forced.push(answer);
        }
        let slow: Vec<f64> = sinusoids.iter().map(|phase| frequencies[*phase]).collect();
        let fastest = slow.iter().map(|f| f.abs()).fold(radius, f64::max);
        let inner = size - pure;
        let constants = forcing.constants.iter().map(|force| &rows * force);
        let driven: Vec<DVector<f64>> = matrix
            .columns(pure, inner)
            .column_iter()
            .map(|column| column.clone_owned())
            .chain(constants)
            .chain(felt)
            .collect();
        let rates = DMatrix::from_fn(size, driven.len(), |row, cause| driven[cause][row]);
        let mut integrals = Self {
            generator: generator(&rates, pure, &slow),
            rates,
            size,
            pure,
            // The matrix is nilpotent up to `radius`.
            orders: 1 + inner + terms(fastest * window),
            by_cause: Vec::new(),
            near_powers: Vec::new(),
            near: NEAR_FRACTION * window,
            columns,
            rows,
            sinusoids,
            forced,
        };
        integrals.find_factors(window);
        (integrals, window)
    }

    /// Returns the number of SIMD vectors that hold the coordinates.
    pub fn simd_vectors(&self) -> usize {
        simd_vectors(self.size)
    }

    /// Returns true if a time since the start, s, is near, so that fewer powers are needed.
    pub fn is_near(&self, tau: f64) -> bool {
        tau <= self.near
    }

    /// Writes the causes of a motion with the coordinates `zeta`, given a unit constant and the inputs, and
    /// exp(i theta) of the phases.
    pub fn causes(
        &self,
        zeta: &[SimdVector],
        units: &[f64],
        phases: &[Complex<f64>],
        causes: &mut Vec<f64>,
    ) {
        causes.clear();
        causes.extend_from_slice(&numbers(zeta)[self.pure..self.size]);
        causes.extend_from_slice(units);
        for phase in &self.sinusoids {
            let e = phases[*phase];
            causes.extend([e.im, e.re]);
        }
    }

    /// Returns the number of coordinates that affect others, which is the number of causes in a
    /// free motion.
    pub fn cause_count(&self) -> usize {
        self.size - self.pure
    }

    /// Returns the causes of a free motion with the coordinates `zeta`.
    pub fn free_causes<'z>(&self, zeta: &'z [SimdVector]) -> &'z [f64] {
        &numbers(zeta)[self.pure..self.size]
    }

    /// Writes the motion of the coordinates, given their causes: SIMD vectors of coefficients for each power of
    /// time from the first on.
    #[inline(always)]
    pub fn motion<S: Simd>(&self, simd: S, causes: &[f64], out: &mut Vec<SimdVector>) {
        let longest = self.by_cause.iter().map(Vec::len).max().unwrap_or(0);
        out.clear();
        out.resize(longest, SimdVector::ZERO);
        kernels::add_multiples(simd, self.by_cause.iter().map(Vec::as_slice), causes, out);
    }

    /// Writes the displacement of the coordinates after `tau` s, given the coefficients of their motion.
    #[inline(always)]
    pub fn moved_by<S: Simd>(
        &self,
        simd: S,
        motion: &[SimdVector],
        tau: f64,
        out: &mut [SimdVector],
    ) {
        let width = self.simd_vectors();
        if width == 0 {
            return;
        }
        let powers = if self.is_near(tau) {
            self.near_powers.iter().copied().max().unwrap_or(0)
        } else {
            motion.len() / width
        };
        let column = std::iter::once(&motion[..powers * width]);
        kernels::sum_powers(simd, column, width, tau, out);
    }

    /// Writes the displacement of the coordinates after `tau` s per unit of each of the first `causes` causes:
    /// one column in SIMD vectors each.
    #[inline(always)]
    pub fn transition<S: Simd>(&self, simd: S, tau: f64, causes: usize, out: &mut Vec<SimdVector>) {
        let width = self.simd_vectors();
        out.clear();
        out.resize(causes * width, SimdVector::ZERO);
        if width > 0 {
            let columns = self.by_cause.iter().zip(&self.near_powers);
            let columns = columns.map(|(factors, near)| match self.is_near(tau) {
                true => &factors[..near * width],
                false => factors,
            });
            kernels::sum_powers(simd, columns, width, tau, out);
        }
    }

    /// Writes the displacement of the coordinates, given their causes and the transition.
    #[inline(always)]
    pub fn moved<S: Simd>(
        &self,
        simd: S,
        causes: &[f64],
        transition: &[SimdVector],
        out: &mut [SimdVector],
    ) {
        out.fill(SimdVector::ZERO);
        let columns = transition.chunks_exact(self.simd_vectors().max(1));
        kernels::add_multiples(simd, columns, causes, out);
    }

    /// Returns the polynomial of a function with these weights of the coordinates, valid within `window` s.
    pub fn polynomial(&self, weights: &[f64], window: f64) -> Polynomial {
        let mut row = DVector::from_column_slice(weights).transpose() * &self.rates;
        let rates = row.iter().map(|entry| entry.abs()).collect();
        let mut coefficients = vec![vec![0.0]; row.len()];
        let mut factor = 1.0;
        for order in 1..=self.orders {
            factor *= reciprocal(order);
            for (cause, entry) in row.iter().enumerate() {
                coefficients[cause].push(entry * factor);
            }
            row *= &self.generator;
        }
        let mut near_powers = 0;
        for column in &mut coefficients {
            let sizes: Vec<f64> = column[1..].iter().map(|c| c.abs()).collect();
            column.truncate(1 + count_terms_needed(&sizes, window));
            near_powers = near_powers.max(1 + count_terms_needed(&sizes, NEAR_FRACTION * window));
        }
        let powers = coefficients.iter().map(Vec::len).max().unwrap_or(0);
        let factors = (0..powers).map(|k| {
            let of = |order: usize| falling_factorial(k + order, order);
            SimdVector::new([0, 1, 2, 3].map(of))
        });
        let fourth: Vec<f64> = (0..powers)
            .map(|k| match k {
                // Fourth derivative of tau^k.
                4.. => falling_factorial(k, 4) * window.powi(k as i32 - 4),
                _ => 0.0,
            })
            .collect();
        Polynomial {
            columns: coefficients.iter().map(|column| pack(column)).collect(),
            near_powers,
            rates,
            factors: factors.collect(),
            fourth: pack(&fourth),
        }
    }

    /// Returns for each cause the weighted sum of the magnitudes of its contributions to the coordinates'
    /// rates.
    fn rate_sizes(&self, weights: &[f64]) -> Vec<f64> {
        let size = |column: usize| {
            let terms = self.rates.column(column);
            let terms = terms.iter().zip(weights).map(|(rate, w)| (rate * w).abs());
            terms.sum()
        };
        (0..self.rates.ncols()).map(size).collect()
    }

    /// Returns the weighted sums of [`Integrals::rate_sizes`] for each initial value: the state, a unit
    /// constant and the inputs (`units`), and sine and cosine of each phase.
    pub fn rate_sizes_by_start(&self, weights: &[f64], units: usize) -> Vec<f64> {
        let (states, felt) = (self.rows.ncols(), self.cause_count());
        let by_cause = self.rate_sizes(weights);
        let mut sizes = vec![0.0; states + units + 2 * self.forced.len()];
        for (index, size) in by_cause[..felt].iter().enumerate() {
            let coordinate = self.pure + index;
            for (slot, entry) in sizes.iter_mut().zip(self.rows.row(coordinate).iter()) {
                *slot += size * entry.abs();
            }
            let forced = self.forced.iter().flatten();
            for (slot, forced) in sizes[states + units..].iter_mut().zip(forced) {
                *slot += size * forced[coordinate].abs();
            }
        }
        let (held, turning) = by_cause[felt..].split_at(units);
        for (slot, size) in sizes[states..].iter_mut().zip(held) {
            *slot += size;
        }
        for (pair, phase) in turning.chunks_exact(2).zip(&self.sinusoids) {
            let slots = sizes[states + units + 2 * phase..].iter_mut();
            slots.zip(pair).for_each(|(slot, size)| *slot += size);
        }
        sizes
    }

    /// Returns the factors of the coordinates in a linear function of the state.
    pub fn weights(&self, row: &DVector<f64>) -> Vec<f64> {
        (self.columns.transpose() * row).as_slice().to_vec()
    }

    fn find_factors(&mut self, window: f64) {
        let mut by_order = Vec::new();
        let (mut rates, mut factor) = (self.rates.clone(), 1.0);
        for order in 1..=self.orders {
            factor *= reciprocal(order);
            by_order.push(&rates * factor);
            rates *= &self.generator;
        }
        for cause in 0..self.rates.ncols() {
            let sizes: Vec<f64> = by_order.iter().map(|b| b.column(cause).amax()).collect();
            let orders = by_order[..count_terms_needed(&sizes, window)].iter();
            let factors = orders.flat_map(|b| pack(b.column(cause).clone_owned().as_slice()));
            self.by_cause.push(factors.collect());
            self.near_powers
                .push(count_terms_needed(&sizes, NEAR_FRACTION * window));
        }
    }
}

impl Polynomial {
    /// Returns the number of powers of time needed, from the power 0 on: at near times and at all times.
    pub fn powers(&self) -> [usize; 2] {
        [self.near_powers, self.factors.len()]
    }

    /// Writes the contribution of some causes to the value and the derivatives of order 1 to 3, for each power
    /// of time. Returns a bound of the fourth derivative.
    #[inline(always)]
    pub fn terms<S: Simd>(
        &self,
        simd: S,
        causes: &[f64],
        coefficients: &mut Vec<SimdVector>,
        terms: &mut Vec<SimdVector>,
    ) -> f64 {
        // One zero vector follows the last coefficient, because `shift_powers` reads four coefficients from
        // each power on.
        coefficients.clear();
        coefficients.resize(self.fourth.len() + 1, SimdVector::ZERO);
        let columns = self.columns.iter().map(Vec::as_slice);
        kernels::add_multiples(simd, columns, causes, coefficients);
        terms.resize(self.factors.len(), SimdVector::ZERO);
        kernels::shift_powers(simd, coefficients, &self.factors, terms);
        kernels::sum_magnitudes(simd, coefficients, &self.fourth)
    }

    /// Returns the sum of the magnitudes of the first coefficient's terms, which may cancel.
    pub fn rate_size(&self, causes: &[f64]) -> f64 {
        let terms = self.rates.iter().zip(causes);
        terms.fold(0.0, |sum, (size, cause)| sum + size * cause.abs())
    }
}

/// Returns the rates of the causes per unit of each cause. The rates of coordinates are rows of `rates`, inputs
/// and constant are constant, and sine and cosine are the derivatives of each other.
fn generator(rates: &DMatrix<f64>, pure: usize, frequencies: &[f64]) -> DMatrix<f64> {
    let count = rates.ncols();
    let inner = rates.nrows() - pure;
    let mut generator = DMatrix::zeros(count, count);
    generator
        .rows_mut(0, inner)
        .copy_from(&rates.rows(pure, inner));
    let first = count - 2 * frequencies.len();
    for (index, omega) in frequencies.iter().enumerate() {
        let sine = first + 2 * index;
        generator[(sine, sine + 1)] = *omega;
        generator[(sine + 1, sine)] = -omega;
    }
    generator
}

/// Returns the falling factorial k (k - 1) ... with `factors` factors.
fn falling_factorial(k: usize, factors: usize) -> f64 {
    (0..factors)
        .map(|factor| k as f64 - factor as f64)
        .product()
}

/// Returns the number of coefficients of these magnitudes needed within a window, from the first power of time
/// on.
fn count_terms_needed(sizes: &[f64], window: f64) -> usize {
    let (mut power, mut largest, mut needed) = (1.0, 0.0_f64, 0);
    for (order, size) in sizes.iter().enumerate() {
        power *= window;
        let term = size * power;
        if term > REMAINDER * largest || term.is_nan() {
            needed = order + 1;
        }
        largest = largest.max(term);
    }
    needed
}

/// Returns real and imaginary part of Z, for the response Im(Z exp(i theta)) to a force beta sin + gamma cos.
fn solve_forced_coordinates(
    matrix: &DMatrix<f64>,
    [beta, gamma]: &[DVector<f64>; 2],
    omega: f64,
) -> [DVector<f64>; 2] {
    let size = matrix.nrows();
    let mut system = matrix.map(|entry| Complex::new(-entry, 0.0));
    for index in 0..size {
        system[(index, index)] += Complex::new(0.0, omega);
    }
    let force = beta.zip_map(gamma, Complex::new);
    // The matrix is nonsingular, because the frequency is far above every eigenvalue.
    let answer = system.lu().solve(&force);
    let answer = answer.unwrap_or_else(|| DVector::from_element(size, Complex::new(f64::NAN, 0.0)));
    [answer.map(|z| z.re), answer.map(|z| z.im)]
}

/// Returns the number of terms of an exponential series needed at this argument.
fn terms(argument: f64) -> usize {
    let (mut terms, mut term) = (0, 1.0);
    while term > REMAINDER && terms < MAX_TERMS {
        terms += 1;
        term *= argument / terms as f64;
    }
    terms
}
