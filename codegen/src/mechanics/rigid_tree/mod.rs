//! Inverse dynamics of rigid bodies from frame to frame, for models without fields: accelerations
//! outward, forces and moments inward (Luh, Walker and Paul, 1980: J. Dyn. Sys. Meas. Control 102,
//! 69-76), with the fewest inertial parameters and what products of them share (Khalil and
//! Kleinfinger, 1987: IEEE J. Robotics Automat. 3, 517-526).
//!
//! `vector` has the components along a frame's axes, `mass_properties` what a body weighs, `links`
//! the frames one by one, `base_parameters` which inertial parameters pass from link to link,
//! `outward` and `inward` the two halves of the recursion, `bodies` what of a model is not in it.

mod base_parameters;
pub(crate) mod bodies;
mod inward;
mod links;
mod mass_properties;
mod outward;
mod vector;
