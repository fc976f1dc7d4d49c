//! Derivatives of the nonlinear remainder's accelerations by each state, kept for neighbouring
//! motions.

use super::remainder::Remainder;

/// Derivatives of the nonlinear remainder's accelerations by each state, at both ends of the
/// neighbours' step.
#[derive(Debug, Default)]
pub struct Slopes {
    /// For each state the accelerations' derivatives, one after the other.
    pub here: Vec<f64>,
    pub there: Vec<f64>,
    /// States by which some are not 0, in the order in which that was seen.
    pub active: Vec<usize>,
    /// True if each is known.
    pub is_known: [bool; 2],
    pub asked: usize,
    pub base: Remainder,
    pub moved: Remainder,
    pub rates: Vec<f64>,
    /// The largest that each acceleration has been.
    pub largest: Vec<f64>,
    pub state: Vec<f64>,
}

impl Slopes {
    /// Of a model with so many states, rates that forces act on, and surfaces.
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

    /// Marks the derivatives at the present state as unknown.
    pub fn forget_here(&mut self) {
        self.is_known = [false; 2];
        self.asked = 0;
    }

    /// Keeps the derivatives unchanged over the step.
    pub fn keep(&mut self) {
        self.there.copy_from_slice(&self.here);
        self.is_known[1] = true;
    }

    /// Moves the derivatives at the end of the step to its beginning, after the neighbours have
    /// made it.
    pub fn shift_to_end(&mut self) {
        std::mem::swap(&mut self.here, &mut self.there);
        self.is_known = [self.is_known[1], false];
    }

    /// Adds what a neighbour feels where it set out, or if that is not known, will feel; nothing
    /// if neither is.
    pub fn add_begin(&self, vector: &[f64], out: &mut [f64]) {
        let derivatives = match self.is_known {
            [true, _] => &self.here,
            [false, true] => &self.there,
            [false, false] => return,
        };
        self.add(derivatives, vector, 1.0, out);
    }

    /// Adds what a neighbour feels where it goes to, times a factor.
    pub fn add_end(&self, vector: &[f64], factor: f64, out: &mut [f64]) {
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
