//! Tangential motion and forces of contacts with friction.

use eomgen_sim::contact_friction::ContactMode;

/// Tangential motion of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    /// Index of the impact.
    pub place: usize,
    /// Mode while the contact is closed.
    pub mode: ContactMode,
    /// True if the tangential force is at its limit while other contacts keep the slip at zero.
    pub bears: bool,
    /// Largest magnitude so far of the slip and of its terms.
    pub slip_size: f64,
    /// Offset of the slip in its direction, so that it is positive if it begins at zero.
    pub slip_offset: f64,
    /// Allowance added to the margin of friction, so that rounding of forces does not end sticking.
    pub force_allowance: f64,
}

impl Tangent {
    pub fn new(place: usize) -> Self {
        Self {
            place,
            mode: ContactMode::Open,
            bears: false,
            slip_size: 0.0,
            slip_offset: 0.0,
            force_allowance: 0.0,
        }
    }
}

/// Normal and tangential impulses, or forces, of some contacts. Tangential ones exist only with friction.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactForces {
    pub normal: Vec<f64>,
    pub tangential: Vec<f64>,
}

impl ContactForces {
    /// Splits the solution of a contact problem into normal and tangential impulses.
    pub fn from_directions(mut impulses: Vec<f64>) -> Self {
        let tangential = impulses.split_off(impulses.len() / 2);
        Self {
            normal: impulses,
            tangential,
        }
    }

    /// Returns the impulses times a factor.
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |values: &[f64]| values.iter().map(|value| value * factor).collect();
        Self {
            normal: scale(&self.normal),
            tangential: scale(&self.tangential),
        }
    }
}
