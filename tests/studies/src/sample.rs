//! Options common to all studies.

use clap::Args;

/// Number of runs of a study and their seed.
#[derive(Args, Clone, Debug)]
pub struct Sample {
    /// Number of runs
    #[arg(long, default_value_t = 20)]
    pub count: usize,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}
