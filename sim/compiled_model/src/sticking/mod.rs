//! Sticking on switching surfaces, as under dry friction. On a surface v = 0, sign(v) is replaced by the number between
//! -1 and 1 that keeps v at zero, if there is one (A. F. Filippov; for friction, J. J. Moreau).
//!
//! [`eomgen_sim::sliding_modes`] determines which of several surfaces hold the motion. `surface_states` follows the
//! surfaces along a motion. A surface holds the motion from its arrival until the force reaches the limit of the
//! surface (`transitions`). `sides` computes the sides that keep its function at zero.
//!
//! At the release, the function and its rate are zero up to rounding, which must not determine the side. Therefore the
//! surface is displaced by this rounding error until the motion has left it (`surface_state`).
//!
//! - `discs`: friction in several directions
//! - `contact_balance`: sticking with closed contacts
//! - `implied_guards`: functions that vanish with the held ones
//! - `sided_model`: model with given sides of its surfaces
//! - `observed_motion`: observables and rates during sticking

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
