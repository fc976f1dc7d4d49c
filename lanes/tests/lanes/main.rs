//! Batches of states against single states: regimes, throughput.

mod regimes;
mod throughput;
