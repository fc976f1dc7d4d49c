//! Tangent vectors propagated along with an integration: over steps by the matrices of the regime, and through
//! switches by the saltation matrix. Changes of parameters or external accelerations drive them.

use super::kernels::{self, Columns};
use super::prescribed_motions::PrescribedMotions;
use super::regime::{DoubledStep, HeldSurface, Regime};
use super::regime_rates::TERMS;
use super::slopes::Slopes;
use super::surfaces::dot;

/// Smallest rate of a function at a switch, relative to its usual rate. At smaller rates (grazing) the
/// saltation quotient is not formed.
const MIN_RATE_FRACTION: f64 = 1e-9;

/// Number of steps over which drives are held at the mean of both ends.
const MAX_DRIVEN_STEPS: usize = 2;

/// Distance from a holding surface at which a model is evaluated on one side. It is a fraction of the change of
/// the surface's function in one step by the difference of both sides.
const OFFSET_FRACTION: f64 = 1e-6;

/// Relative error of a tangent vector after a part of a step.
const PART_ERROR_FRACTION: f64 = 1e-9;

/// Differences of accelerations that drive tangent vectors.
pub trait DrivingAccelerations {
    /// Writes the difference of each acceleration at a state, consecutively for each driven vector.
    fn write_differences(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]);
}

/// No driven tangent vectors.
pub struct NoDrives;

impl DrivingAccelerations for NoDrives {
    fn write_differences(&mut self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) {}
}

/// Function of a surface that a motion has reached.
pub(super) struct ReachedSurface<'r> {
    /// Derivatives of the function with respect to the state.
    pub gradient: &'r [f64],
    /// Derivatives of the function with respect to the parameters of tangent vectors.
    pub by_parameter: &'r [f64],
    /// Rate of the function, per s.
    pub rate: f64,
}

/// Selection of tangent vectors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Directions {
    /// True to include the tangent vectors of all initial states.
    pub has_state_vectors: bool,
    /// Number of parameters with a tangent vector, from the first.
    pub parameter_count: usize,
    /// Number of tangent vectors driven by accelerations.
    pub driven_count: usize,
}

/// Tangent vectors: by the initial state, then by parameters, then driven by accelerations.
pub struct Tangents<'d> {
    states: usize,
    degrees: usize,
    /// Number of rates that forces act on.
    forced: usize,
    prescribed: PrescribedMotions,
    /// Number of tangent vectors by the initial state.
    free: usize,
    by_parameter: usize,
    driven: usize,
    /// Number of entries from one vector to the next.
    pub stride: usize,
    /// Entries of all vectors, one vector after the other.
    pub vectors: Vec<f64>,
    next: Vec<f64>,
    /// State of the motion at the time of the vectors, and a later state.
    from: Vec<f64>,
    later: Vec<f64>,
    /// Number of steps that the motion has made and the vectors have not.
    pending: usize,
    /// True if the motion is on a surface, where rounding would decide the drives.
    on_surface: bool,
    drives: &'d mut dyn DrivingAccelerations,
    /// Drives at the current state, and a step later.
    here: Vec<f64>,
    there: Vec<f64>,
    /// Derivatives of the nonlinear remainder, if the model has one.
    pub(super) slopes: Option<Slopes>,
    felt: Vec<f64>,
}

impl<'d> Tangents<'d> {
    /// Creates the vectors of a model with these numbers of states, of degrees of freedom and of rates that forces act
    /// on. Vectors of parameters and driven vectors start at 0.
    pub(super) fn new(
        (states, degrees, forced): (usize, usize, usize),
        prescribed: PrescribedMotions,
        directions: Directions,
        drives: &'d mut dyn DrivingAccelerations,
    ) -> Self {
        let Directions {
            has_state_vectors: by_state,
            parameter_count: by_parameter,
            driven_count: driven,
        } = directions;
        Self {
            states,
            degrees,
            forced,
            prescribed,
            free: if by_state { degrees + forced } else { 0 },
            by_parameter,
            driven,
            stride: states.next_multiple_of(kernels::LANES),
            pending: 0,
            on_surface: false,
            vectors: Vec::new(),
            next: Vec::new(),
            from: Vec::new(),
            later: Vec::new(),
            drives,
            here: vec![0.0; driven * forced],
            there: vec![0.0; driven * forced],
            slopes: None,
            felt: vec![0.0; forced],
        }
    }

    /// Starts at a state in a regime.
    pub fn begin(&mut self, regime: &Regime, at: (f64, &[f64], &[f64])) {
        let stride = self.stride;
        self.vectors = vec![0.0; stride * self.count()];
        for place in 0..self.free {
            self.vectors[place * stride + place] = 1.0;
        }
        self.next = self.vectors.clone();
        self.from = at.1.to_vec();
        self.pending = 0;
        self.update_drives(regime, at);
    }

    /// Computes the driving accelerations at the current state, in a regime.
    pub fn update_drives(&mut self, regime: &Regime, at: (f64, &[f64], &[f64])) {
        if self.driven > 0 {
            let out = (&mut self.here[..], self.forced);
            compute_drives(regime, (&mut *self.drives, &self.prescribed), at, out);
        }
        self.on_surface = false;
    }

    /// Returns the number of vectors.
    pub fn count(&self) -> usize {
        self.free + self.by_parameter + self.driven
    }

    /// Records a whole step of the motion. Returns true if the pending steps of the vectors must be made now.
    pub fn step(&mut self) -> bool {
        self.pending += 1;
        (self.driven > 0 || self.slopes.is_some()) && self.pending >= MAX_DRIVEN_STEPS
    }

    /// Returns true if the motion has made steps that the vectors have not.
    pub fn is_behind(&self) -> bool {
        self.pending > 0
    }

    /// Records that the motion leaves a surface to one of its sides.
    pub fn leave_surface(&mut self) {
        self.on_surface = true;
        self.forget_slopes();
    }

    /// Discards the derivatives of the nonlinear terms at the current state.
    pub fn forget_slopes(&mut self) {
        if let Some(slopes) = &mut self.slopes {
            slopes.forget_here();
        }
    }

    /// Advances the vectors by the pending steps, in a regime, up to a state. `given` is a unit
    /// constant and the inputs.
    pub fn advance_pending(&mut self, regime: &Regime, t: f64, state: &[f64], given: &[f64]) {
        if self.pending == 0 {
            return;
        }
        if self.driven > 0 {
            let there = (&mut self.there[..], self.forced);
            let at = (t, state, &given[1..]);
            compute_drives(regime, (&mut *self.drives, &self.prescribed), at, there);
            for (a, b) in self.here.iter_mut().zip(&self.there) {
                *a = if self.on_surface { *b } else { 0.5 * (*a + b) };
            }
            self.on_surface = false;
        }
        while self.pending > 0 {
            let doubling = (self.pending.ilog2() as usize).min(regime.doubled.len() - 1);
            self.pending -= 1 << doubling;
            self.advance_doubled(regime, doubling, given);
        }
        self.from.copy_from_slice(state);
        std::mem::swap(&mut self.here, &mut self.there);
        if let Some(slopes) = &mut self.slopes {
            slopes.shift_to_end();
        }
    }

    /// Makes several steps at once. The drives are held. The forces that depend on the state are held and
    /// corrected at the end.
    fn advance_doubled(&mut self, regime: &Regime, doubling: usize, given: &[f64]) {
        let forced = self.forced;
        let DoubledStep {
            state,
            given: of_given,
            force,
        } = &regime.doubled[doubling];
        self.next.fill(0.0);
        let parameters = self.next.chunks_exact_mut(self.stride).skip(self.free);
        let by_parameter = parameters.zip(&regime.by_parameter);
        for (out, derivative) in by_parameter.take(self.by_parameter) {
            let (of_state, of_given) = &derivative.doubled[doubling];
            of_state.add_product(&self.from, out);
            of_given.add_product(given, out);
        }
        if self.by_parameter > 0 && self.pending > 0 {
            self.later.clear();
            self.later.resize(self.stride, 0.0);
            state.add_product(&self.from, &mut self.later);
            of_given.add_product(given, &mut self.later);
            self.from.copy_from_slice(&self.later[..self.states]);
        }
        for place in 0..self.driven {
            let first = (self.free + self.by_parameter + place) * self.stride;
            let out = &mut self.next[first..first + self.stride];
            force.add_product(&self.here[place * forced..(place + 1) * forced], out);
        }
        state.add_products(self.states, &self.vectors, &mut self.next);
        if let Some(slopes) = &self.slopes {
            let (old, new) = (&self.vectors, &mut self.next);
            let vectors = old.chunks_exact(self.stride);
            for (vector, next) in vectors.zip(new.chunks_exact_mut(self.stride)) {
                self.felt.fill(0.0);
                slopes.add_start_acceleration(vector, &mut self.felt);
                force.add_product(&self.felt, next);
                self.felt.iter_mut().for_each(|felt| *felt *= -0.5);
                slopes.add_end_acceleration(next, 0.5, &mut self.felt);
                force.add_product(&self.felt, next);
            }
        }
        std::mem::swap(&mut self.vectors, &mut self.next);
    }

    /// Advances the vectors by a part of a step, `tau` s, to a state.
    pub fn advance_part(&mut self, regime: &Regime, tau: f64, end: (f64, &[f64], &[f64])) {
        let (n, degrees, forced) = (self.states, self.degrees, self.forced);
        if self.on_surface {
            self.update_drives(regime, end);
        }
        self.advance_parameter_vectors(regime, tau, end.2);
        let driven = self.free + self.by_parameter;
        let mut rates = vec![0.0; regime.matrix.rows];
        for place in (0..self.free).chain(driven..self.count()) {
            let vector = &mut self.vectors[place * self.stride..place * self.stride + n];
            rates.fill(0.0);
            regime.matrix.add_product(vector, &mut rates);
            if let Some(slopes) = &self.slopes {
                slopes.add_start_acceleration(vector, &mut rates[degrees..degrees + forced]);
            }
            if place >= driven {
                let first = (place - driven) * forced;
                let drives = &self.here[first..first + forced];
                rates[degrees..]
                    .iter_mut()
                    .zip(drives)
                    .for_each(|(r, d)| *r += d);
            }
            add_exponential_series(&regime.matrix, vector, &mut rates, tau, PART_ERROR_FRACTION);
        }
        self.update_drives(regime, end);
        self.from.copy_from_slice(end.1);
        if let Some(slopes) = &mut self.slopes {
            slopes.shift_to_end();
        }
    }

    /// Advances the vectors of parameters by a part of a step, s, with the exponential series of the motion and
    /// of its derivative.
    fn advance_parameter_vectors(&mut self, regime: &Regime, tau: f64, inputs: &[f64]) {
        if self.by_parameter == 0 {
            return;
        }
        let (n, rows) = (self.states, regime.matrix.rows);
        let given: Vec<f64> = [1.0].iter().chain(inputs).copied().collect();
        // Term k of the series of the motion is tau/k times the matrix times term k-1.
        let mut motion: Vec<Vec<f64>> = Vec::with_capacity(TERMS);
        for k in 1..TERMS {
            let mut term = vec![0.0; rows];
            match motion.last() {
                None => regime.rates(&self.from, &given, &mut term),
                Some(before) => regime.matrix.add_product(&before[..n], &mut term),
            }
            term.iter_mut().for_each(|slot| *slot *= tau / k as f64);
            motion.push(term);
        }
        let parameters = self.vectors.chunks_exact_mut(self.stride).skip(self.free);
        for (vector, derivative) in parameters.zip(&regime.by_parameter).take(self.by_parameter) {
            let mut term = vec![0.0; rows];
            regime.matrix.add_product(&vector[..n], &mut term);
            derivative.state.add_product(&self.from, &mut term);
            derivative.given.add_product(&given, &mut term);
            for k in 1..=TERMS {
                let sums = vector[..n].iter_mut().zip(&mut term);
                sums.for_each(|(x, slot)| {
                    *slot *= tau / k as f64;
                    *x += *slot;
                });
                let Some(of_motion) = motion.get(k - 1) else {
                    break;
                };
                let mut next = vec![0.0; rows];
                regime.matrix.add_product(&term[..n], &mut next);
                derivative.state.add_product(&of_motion[..n], &mut next);
                term = next;
            }
        }
    }

    /// Applies the saltation matrix of a switch, given the function of the reached surface and the rates before
    /// and after the switch.
    pub(super) fn apply_saltation(
        &mut self,
        reached: &ReachedSurface<'_>,
        before: &[f64],
        after: &[f64],
    ) {
        self.leave_surface();
        let n = self.states;
        let ReachedSurface { gradient, rate, .. } = *reached;
        let terms = gradient.iter().zip(before);
        let size: f64 = terms.map(|(a, b)| (a * b).abs()).sum();
        if rate.abs() <= MIN_RATE_FRACTION * size {
            return;
        }
        let free = std::iter::repeat_n(0.0, self.free);
        let moved = free.chain(reached.by_parameter.iter().copied());
        let moved = moved.chain(std::iter::repeat(0.0));
        for (vector, moved) in self.vectors.chunks_exact_mut(self.stride.max(1)).zip(moved) {
            let delay = (dot(gradient, &vector[..n]) + moved) / rate;
            for ((slot, a), b) in vector[..n].iter_mut().zip(after).zip(before) {
                *slot += (a - b) * delay;
            }
        }
    }
}

/// Computes the drives in a regime. On a holding surface, the accelerations are a convex combination of those
/// on both sides, minus the reaction of the surface.
fn compute_drives(
    regime: &Regime,
    (drives, prescribed): (&mut dyn DrivingAccelerations, &PrescribedMotions),
    (t, state, inputs): (f64, &[f64], &[f64]),
    (out, forced): (&mut [f64], usize),
) {
    let model_inputs = prescribed.model_inputs(state, inputs);
    let mut differences = |state: &[f64], out: &mut [f64]| {
        drives.write_differences(t, prescribed.model_state(state), &model_inputs, out);
    };
    if regime.held.is_empty() {
        differences(state, out);
        return;
    }
    let mut below = state.to_vec();
    let shares: Vec<(&HeldSurface, f64, f64)> = (regime.held.iter())
        .map(|held| {
            let (difference, share) = held.compute_difference_and_share(state, inputs);
            (
                held,
                OFFSET_FRACTION * regime.length * difference.abs(),
                share,
            )
        })
        .collect();
    for (held, distance, _) in &shares {
        let function = regime.functions[held.surface].evaluate_with_inputs(&below, inputs);
        move_across(&mut below, held, -distance - function);
    }
    differences(&below, out);
    let (all_below, mut above) = (out.to_vec(), out.to_vec());
    for (held, distance, share) in &shares {
        let mut beyond = below.clone();
        move_across(&mut beyond, held, 2.0 * distance);
        differences(&beyond, &mut above);
        for ((slot, above), below) in out.iter_mut().zip(&above).zip(&all_below) {
            *slot += share * (above - below);
        }
    }
    let mut forces = Vec::new();
    for drive in out.chunks_exact_mut(forced.max(1)) {
        regime.subtract_held(drive, &mut forces);
    }
}

/// Changes a state so that the function of a surface changes by `distance`.
fn move_across(state: &mut [f64], held: &HeldSurface, distance: f64) {
    let sums = state.iter_mut().zip(&held.across);
    sums.for_each(|(x, across)| *x += distance * across);
}

/// Adds to a vector its change over `tau` s by the exponential series, until a term adds less than
/// the fraction `error` to each entry.
pub fn add_exponential_series(
    matrix: &Columns,
    vector: &mut [f64],
    rates: &mut [f64],
    tau: f64,
    error: f64,
) {
    let n = vector.len();
    let mut next = [0.0; 64];
    let mut large = Vec::new();
    let next: &mut [f64] = if rates.len() <= 64 {
        &mut next[..rates.len()]
    } else {
        large.resize(rates.len(), 0.0);
        &mut large
    };
    // Magnitudes of the initial entries plus those of the terms so far.
    let mut sizes: Vec<f64> = vector.iter().map(|value| value.abs()).collect();
    for (slot, rate) in rates.iter_mut().enumerate() {
        *rate *= tau;
        if let Some(value) = vector.get_mut(slot) {
            *value += *rate;
            sizes[slot] += rate.abs();
        }
    }
    for term in 2..=TERMS {
        next.fill(0.0);
        matrix.add_product(&rates[..n], next);
        let factor = tau / term as f64;
        let mut is_small = true;
        for (place, (slot, value)) in rates.iter_mut().zip(&*next).enumerate() {
            *slot = value * factor;
            if let Some(sum) = vector.get_mut(place) {
                *sum += *slot;
                sizes[place] += slot.abs();
                is_small &= slot.abs() <= error * sizes[place];
            }
        }
        if is_small {
            break;
        }
    }
}
