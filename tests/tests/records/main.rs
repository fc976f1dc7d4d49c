//! Tests of measured records: reading, rejection, comparison with simulations.

mod constraints;
mod discovery_runs;
mod driven_simulations;
mod free_decays;
mod measured_quantities;
mod moving_base;
mod parquet;
mod rejected_records;
mod sensor_errors;
mod several_records;
mod time_origins;
