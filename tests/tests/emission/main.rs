//! Tests of emitted code: bit-for-bit comparison with the interpreter, single precision, microcontrollers, build
//! scripts.

mod bare_metal;
mod bare_metal_gain;
mod bench_of_a_model;
mod casadi;
mod checked_in_variants;
mod closed_loop;
mod contact_steps;
mod controllers;
mod families;
mod family_interface;
mod file_names;
mod header_only;
mod instruction_bounds;
mod machine_code;
mod misra;
mod regimes;
mod reserved_names;
mod routes;
mod seeded_faults;
mod settings;
mod single_precision;
mod trace_file;
mod units;
