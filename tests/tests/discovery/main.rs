//! Inputs and results of `compare` and `discover`.

mod arm;
mod blind;
mod documented_example;
mod effects_files;
mod effects_found;
mod effects_placed;
mod empirical;
mod feedback;
mod friction_that_stops;
mod friction_under_load;
mod input_faults;
mod joint_acceptance;
mod kinds_of_channels;
mod laws_with_shape;
mod machines;
mod measured_current;
mod motion_that_is_given;
mod next_experiment;
mod nothing_compared;
mod off_the_list;
mod play_in_a_drive;
mod residual_force;
mod specifications;
mod split_sample;
mod undeclared;
mod units;
