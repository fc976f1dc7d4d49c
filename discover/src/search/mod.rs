//! The search for what a model lacks.

pub mod acceptance;
mod alternatives;
pub mod backward_elimination;
pub mod fitted;
pub mod found;
mod hypothesis;
mod joint;
mod pairs;
pub mod parameter_offsets;
pub mod perturbed_response;
pub mod response;
mod round;
pub mod screening;
pub mod selected;
mod shape_restarts;
pub mod variational_response;
