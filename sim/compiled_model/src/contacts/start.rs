//! Initial states at contacts: distances that are negative by rounding are set to zero.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::{CORRECTIONS, Contacts, ROUNDING};

/// Start of a motion whose initial state may touch contacts.
pub(crate) struct Start<'s> {
    /// Start, s.
    pub t: f64,
    /// End, s; equal to the start for a single state.
    pub end: f64,
    /// Inputs.
    pub inputs: &'s [f64],
    /// Largest known length of each impact, in the unit of its distance.
    pub lengths: &'s [f64],
}

impl Start<'_> {
    /// Moves coordinates so that no distance of an impact is negative by rounding. The rounding error is relative to
    /// the length of the impact, or to the distance travelled with rate and acceleration at the start.
    ///
    /// # Errors
    /// Index and value of the first distance that is more negative or NaN.
    pub(crate) fn move_onto_contacts(
        &self,
        own: &mut Evaluator,
        state: &mut [f64],
    ) -> Result<(), (usize, f64)> {
        let degrees = own.program().degrees_of_freedom();
        let mut contacts = Contacts::new(vec![String::new(); self.lengths.len()], [&[], &[]]);
        let span = self.end - self.t;
        for correction in 0..CORRECTIONS {
            let (t, inputs) = (self.t, self.inputs);
            own.impacts(Point { t, state, inputs }, &mut contacts.at);
            let mut below = Vec::new();
            for (place, (impact, length)) in contacts.at.iter().zip(self.lengths).enumerate() {
                let covered = impact.rate.abs() * span + impact.acceleration.abs() * span * span;
                let allowed = ROUNDING * length.max(covered);
                let is_outside = impact.distance >= 0.0;
                if !is_outside && (correction > 0 || impact.distance >= -allowed) {
                    below.push(place);
                } else if !is_outside {
                    return Err((place, impact.distance));
                }
            }
            if below.is_empty() {
                break;
            }
            let corrections = contacts.solve_balance(&below, |impact| impact.distance);
            contacts.add_impulses(&below, &corrections, &mut state[..degrees]);
        }
        Ok(())
    }
}
