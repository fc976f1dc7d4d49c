//! Closed contacts at a jump of the rates: contacts that push act, contacts that would pull open.

use nalgebra::DVector;

use super::sided_point::{Jump, SidedPoint, TouchingContact};

/// Maximum number of changes of the active contacts, for each contact. If contacts are linearly dependent, the changes
/// may cycle.
const MAX_CHANGES_PER_CONTACT: usize = 4;

/// Maximum number of contacts for which all combinations are tried after a cycle.
const MAX_COMBINED_CONTACTS: usize = 10;

/// Largest pull of a contact, and approach speed, that count as zero, relative to the motion.
const CONTACT_ROUNDING: f64 = 1e-9;

/// Applies a jump with the contacts that push. A contact that pulls becomes inactive, and a contact that bodies
/// approach becomes active, one at a time, lowest index first. This method for complementarity problems (K. G. Murty)
/// ends if the contacts are independent. Otherwise the combinations of independent contacts are tried.
pub(super) fn apply_with_contacts(
    point: &mut SidedPoint<'_>,
    mut apply: impl FnMut(&mut SidedPoint<'_>) -> Option<Jump>,
) -> Option<Jump> {
    let (state, inputs, before) = (point.state.clone(), point.inputs.clone(), point.rates());
    let count = point.acts.len();
    for _ in 0..=MAX_CHANGES_PER_CONTACT * count {
        let jump = apply(point)?;
        let Some(place) = find_contradiction(point, &before, &jump)? else {
            return Some(jump);
        };
        point.acts[place] = !point.acts[place];
        point.state.clone_from(&state);
        point.inputs.clone_from(&inputs);
    }
    if count > MAX_COMBINED_CONTACTS {
        return None;
    }
    for combination in 0..1_u32 << count {
        for (place, acts) in point.acts.iter_mut().enumerate() {
            *acts = combination >> place & 1 == 1;
        }
        let jump = apply(point)?;
        let is_independent =
            jump.contacts.iter().flatten().count() == combination.count_ones() as usize;
        if is_independent && find_contradiction(point, &before, &jump)?.is_none() {
            return Some(jump);
        }
        point.state.clone_from(&state);
        point.inputs.clone_from(&inputs);
    }
    None
}

/// Returns a contact that pulls, or that bodies approach, after a jump from the rates `before`.
fn find_contradiction(
    point: &SidedPoint<'_>,
    before: &DVector<f64>,
    jump: &Jump,
) -> Option<Option<usize>> {
    let after = point.rates();
    let measure = ContactMeasure::new(jump, &[before, &after], point.contacts)?;
    let contradicts = |place: &usize| {
        let contact = &point.contacts[*place];
        match point.acts[*place] {
            true => measure.impulse(contact, jump.impulse_at(*place)) < -CONTACT_ROUNDING,
            false => measure.rate(contact, &after) < -CONTACT_ROUNDING,
        }
    };
    Some((0..point.contacts.len()).find(contradicts))
}

/// Rates and impulses of contacts, relative to the motion in the norm of the kinetic energy.
struct ContactMeasure {
    inverse: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    /// Largest norm of the rates, of the rates at zero momenta, and of the surface speeds of contacts.
    size: f64,
}

impl ContactMeasure {
    fn new(jump: &Jump, rates: &[&DVector<f64>], contacts: &[TouchingContact]) -> Option<Self> {
        let inverse = jump.mass.clone().cholesky()?;
        let free = inverse.solve(&jump.constant_momenta);
        let rates = rates.iter().copied().chain([&free]);
        let lengths = rates.map(|rates| rates.dot(&(&jump.mass * rates)).sqrt());
        let size = lengths.fold(f64::MIN_POSITIVE, f64::max);
        let own = Self { inverse, size };
        let speeds = contacts.iter();
        let speeds = speeds.map(|contact| contact.drift.abs() / own.length(contact));
        let size = speeds.fold(size, f64::max);
        Some(Self { size, ..own })
    }

    /// Returns the norm of the row of a contact.
    fn length(&self, contact: &TouchingContact) -> f64 {
        contact.row.dot(&self.inverse.solve(&contact.row)).sqrt()
    }

    fn rate(&self, contact: &TouchingContact, rates: &DVector<f64>) -> f64 {
        (contact.drift + contact.row.dot(rates)) / (self.length(contact) * self.size)
    }

    fn impulse(&self, contact: &TouchingContact, impulse: f64) -> f64 {
        impulse * self.length(contact) / self.size
    }
}
