//! Motions against closed forms, published figures, reference trajectories and other solvers.

mod chains_against_walls;
mod chambers;
mod constraints;
mod contact_friction;
mod continued;
mod continued_controllers;
mod controller_library;
mod controllers;
mod corners;
mod drawn_motion;
mod energy_audit;
mod event_log;
mod exact_properties;
mod exact_reference;
mod exact_survival;
mod fixed_steps;
mod impacts;
mod inputs_of_time;
mod invalid_requests;
mod passed_surfaces;
mod piecewise;
mod redundant_constraints;
mod reference_trajectory;
mod stopped;
mod taylor;
mod woodpecker;
