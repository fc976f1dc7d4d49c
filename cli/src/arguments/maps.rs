//! Options of sweeps over parameters.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::shared::{InputValues, Json, ModelFile, ParameterValues, StateValues, parse_seconds};

/// System that runs the shards of a sweep on many machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// A Slurm array job, and a second job that merges the shards.
    Slurm,
    /// Tasks on the workers of a Dask scheduler; needs the Python package.
    Dask,
}

/// Options of `sweep`.
#[derive(Args)]
pub struct Sweep {
    #[command(flatten)]
    pub model: ModelFile,
    /// Grid axis: parameters that take the same COUNT evenly spaced values, in their declared unit. `:log`
    /// spaces the logarithms evenly. Repeatable: the sweep covers all combinations.
    #[arg(
        long,
        value_name = "NAME[,NAME...]=FROM:TO:COUNT[:log]",
        required_unless_present = "samples",
        conflicts_with = "samples"
    )]
    pub vary: Vec<String>,
    /// Number of random samples of all parameters with a declared uncertainty, instead of a grid (--vary).
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub samples: Option<usize>,
    /// Seed of the random samples.
    #[arg(
        long,
        value_name = "SEED",
        default_value_t = 1,
        requires = "samples",
        conflicts_with = "vary"
    )]
    pub seed: u64,
    /// Quantities to compute. `lyapunov`: the largest Lyapunov exponent. `poincare` or `poincare:NAME`: the
    /// first or another coordinate or rate, once per forcing period or on --section. `max:NAME`, `rms:NAME`,
    /// `final:NAME`: maximum, RMS or final value of an observable, coordinate or rate over the entire motion.
    /// The maximum is signed. The largest magnitude is the maximum of an observable such as `abs(theta)`.
    #[arg(
        long,
        value_name = "NAME[,NAME...]",
        required = true,
        value_delimiter = ','
    )]
    pub measure: Vec<String>,
    /// Output folder. An interrupted run is resumed.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub parameters: ParameterValues,
    #[command(flatten)]
    pub initial: StateValues,
    #[command(flatten)]
    pub inputs: InputValues,
    /// Parameter whose value is the angular frequency of the forcing.
    #[arg(long, value_name = "NAME", default_value = "omega")]
    pub frequency: String,
    /// Number of forcing periods to discard before measuring.
    #[arg(long, value_name = "PERIODS", default_value_t = 60)]
    pub transient: usize,
    /// Number of forcing periods to measure.
    #[arg(long, value_name = "PERIODS", default_value_t = 60)]
    pub periods: usize,
    /// End of the simulation in s, instead of forcing periods. `lyapunov` is measured over the second half of this
    /// time, --section over the whole time. Default with --record: the end of the record.
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = parse_seconds)]
    pub until: Option<f64>,
    /// Poincaré section: a coordinate or a rate crosses a value upwards, or downwards with `:down`. If the
    /// equations are periodic in an angle, the angle crosses the value once per turn. --transient and --periods then count
    /// crossings. Default: once per forcing period.
    #[arg(long, value_name = "NAME=VALUE[:up|:down]")]
    pub section: Option<String>,
    /// Compute only shard I of N; `eomgen merge` combines the shards.
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    pub shard: Option<String>,
    /// Submit all shards to a cluster; all machines must share the output folder.
    #[arg(long, value_enum)]
    pub engine: Option<Engine>,
    /// Number of shards with --engine. Default: 16.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub shards: Option<u16>,
    /// Address of the Dask scheduler. Default: the variable DASK_SCHEDULER_ADDRESS.
    #[arg(long, value_name = "ADDRESS")]
    pub scheduler: Option<String>,
    /// Number of threads; the result does not depend on it. Default: one per core, or one per shard with
    /// --engine.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `merge`.
#[derive(Args)]
pub struct Merge {
    /// Output folder of the sweep.
    pub dir: PathBuf,
    #[command(flatten)]
    pub output: Json,
}
