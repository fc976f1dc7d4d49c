//! Batches of states compared with single states: regimes and throughput.

mod regimes;
mod throughput;
