//! Derivatives of the nonlinear remainder's accelerations by each state, stored for tangent vectors.

use super::remainder::Remainder;

/// Derivatives of the nonlinear remainder's accelerations by each state, at both ends of a step of the tangent
/// vectors.
#[derive(Debug, Default)]
pub struct Slopes {
    /// Derivatives at the start: all accelerations by the first state, then by the second, and so on.
    pub here: Vec<f64>,
    pub there: Vec<f64>,
    /// Indices of states with a nonzero derivative, in the order in which they were found.
    pub active: Vec<usize>,
    /// True for `here` and `there` if they have been computed.
    pub is_known: [bool; 2],
    pub call_count: usize,
    pub base: Remainder,
    pub moved: Remainder,
    pub rates: Vec<f64>,
    /// Largest magnitude of each acceleration so far.
    pub largest: Vec<f64>,
    pub state: Vec<f64>,
}

impl Slopes {
    /// Creates derivatives of 0 for these numbers of states, of rates that forces act on, and of surfaces.
    pub fn new(states: usize, forced: usize, surfaces: usize) -> Self {
        Self {
            here: vec![0.0; states * forced],
            there: vec![0.0; states * forced],
            largest: vec![0.0; forced],
            base: Remainder::zero(forced, surfaces),
            moved: Remainder::zero(forced, surfaces),
            ..Self::default()
        }
    }

    /// Marks the derivatives at the current state as unknown.
    pub fn forget_here(&mut self) {
        self.is_known = [false; 2];
        self.call_count = 0;
    }

    /// Uses the derivatives at the start of the step also at its end.
    pub fn keep(&mut self) {
        self.there.copy_from_slice(&self.here);
        self.is_known[1] = true;
    }

    /// Moves the derivatives at the end of the step to the start of the next step.
    pub fn shift_to_end(&mut self) {
        std::mem::swap(&mut self.here, &mut self.there);
        self.is_known = [self.is_known[1], false];
    }

    /// Adds the acceleration of a tangent vector at the start of a step. If the derivatives there are unknown,
    /// those at the end are used; if both are unknown, nothing is added.
    pub fn add_start_acceleration(&self, vector: &[f64], out: &mut [f64]) {
        let derivatives = match self.is_known {
            [true, _] => &self.here,
            [false, true] => &self.there,
            [false, false] => return,
        };
        self.add(derivatives, vector, 1.0, out);
    }

    /// Adds the acceleration of a tangent vector at the end of a step, times a factor.
    pub fn add_end_acceleration(&self, vector: &[f64], factor: f64, out: &mut [f64]) {
        self.add(&self.there, vector, factor, out);
    }

    fn add(&self, derivatives: &[f64], vector: &[f64], factor: f64, out: &mut [f64]) {
        let forced = out.len();
        for state in &self.active {
            let column = &derivatives[state * forced..(state + 1) * forced];
            let size = factor * vector[*state];
            out.iter_mut().zip(column).for_each(|(o, d)| *o += size * d);
        }
    }
}
