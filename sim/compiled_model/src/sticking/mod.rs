//! Sticking on switching surfaces, as under dry friction. On a surface v = 0, sign(v) is replaced
//! by the number between -1 and 1 that keeps v at zero, if there is one (A. F. Filippov; for
//! friction, J. J. Moreau).
//!
//! [`eomgen_sim::sliding_modes`] decides which of several surfaces hold. `surface_states` follows them along a
//! motion: a surface holds the motion from its arrival until the force reaches the limit of the surface
//! (`transitions`), with the sides that keep its function at zero (`sides`). At the release, the function and its
//! rate are zero up to rounding, which must not determine the side; so the surface is displaced by that rounding
//! until the motion has left it (`surface_state`). `discs` does the same for friction in several directions,
//! `contact_balance` with closed contacts. `implied_guards` finds functions that vanish with the held ones. `sided_model` is the model with given sides of its surfaces, and
//! `observed_motion` computes observables and rates during sticking.

mod contact_balance;
mod discs;
mod implied_guards;
mod observed_motion;
mod sided_model;
mod sides;
mod surface_state;
mod surface_states;
mod transitions;

pub(crate) use observed_motion::ObservedMotion;
pub use observed_motion::StickingMotion;
pub use sided_model::SidedModel;
pub(crate) use sided_model::{MAX_SETTLED_CHANGE, MAX_SIDE_ITERATIONS, side_of};
pub(crate) use surface_states::SurfaceStates;
