//! Inverse dynamics of rigid bodies by recursion along the tree of frames, for models without fields: accelerations
//! outward, forces and moments inward (Luh, Walker and Paul, 1980: J. Dyn. Sys. Meas. Control 102, 69-76), with the
//! fewest inertial parameters and shared products (Khalil and Kleinfinger, 1987: IEEE J. Robotics Automat. 3,
//! 517-526).
//!
//! `vector` and `mass_properties` define the quantities, `links` the frames, `base_parameters` regroups
//! inertial parameters, `outward` and `inward` are the two halves of the recursion, and `bodies` adds the
//! other terms of the model.

mod base_parameters;
pub(crate) mod bodies;
mod inward;
mod links;
mod mass_properties;
mod outward;
mod vector;
