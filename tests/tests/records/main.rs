//! Measured records: reading, rejection, comparison with simulations.

mod discovery_runs;
mod driven_simulations;
mod measured_quantities;
mod parquet;
mod refused_records;
mod several_records;
