//! Options of sweeps over parameters.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// What runs the shards of a sweep on many machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// An array job, and a job that merges after it.
    Slurm,
    /// Tasks on the workers of a scheduler, by the Python package.
    Dask,
}

/// Options of `sweep`.
#[derive(Args)]
pub struct Sweep {
    /// The specification.
    pub spec: PathBuf,
    /// Parameters that take the same evenly spaced values together, in the unit the
    /// specification declares (repeatable; all combinations are measured). With `:log` behind it
    /// their logarithms are evenly spaced.
    #[arg(
        long,
        value_name = "NAME[,NAME...]=FROM:TO:COUNT[:log]",
        required_unless_present = "samples",
        conflicts_with = "samples"
    )]
    pub vary: Vec<String>,
    /// So many random samples of all parameters for which the specification declares an uncertainty, in
    /// place of --vary.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub samples: Option<usize>,
    /// Which sequence of random samples.
    #[arg(
        long,
        value_name = "SEED",
        default_value_t = 1,
        requires = "samples",
        conflicts_with = "vary"
    )]
    pub seed: u64,
    /// What is measured: `lyapunov`, the largest Lyapunov exponent; `poincare` or
    /// `poincare:NAME`, the first or another coordinate or a rate once per forcing period, or
    /// on `--section`; `max:NAME`, `rms:NAME`, `final:NAME`, a number of what an observable, a
    /// coordinate or a rate does over time.
    #[arg(
        long,
        value_name = "NAME[,NAME...]",
        required = true,
        value_delimiter = ','
    )]
    pub measure: Vec<String>,
    /// The folder to write to; a run begun there is continued.
    #[arg(long)]
    pub out: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// Another value for a parameter: a number in the unit the specification declares, an expression of
    /// parameters as `2*l`, or one with a unit as `"30 mm"` (repeatable).
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// The parameter that is the angular frequency of the forcing.
    #[arg(long, value_name = "NAME", default_value = "omega")]
    pub frequency: String,
    /// Forcing periods that pass before anything is measured.
    #[arg(long, value_name = "PERIODS", default_value_t = 60)]
    pub transient: usize,
    /// Forcing periods that are measured.
    #[arg(long, value_name = "PERIODS", default_value_t = 60)]
    pub periods: usize,
    /// Time from the start that is looked at, in s, in place of forcing periods: `lyapunov`
    /// measures its second half, a `--section` is looked for in all of it.
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub until: Option<f64>,
    /// Where `poincare` looks in place of once per forcing period: where a coordinate or a
    /// rate goes up through a value, or down with `:down`; an angle with which the equations
    /// repeat, once per turn. --transient and --periods count crossings then.
    #[arg(long, value_name = "NAME=VALUE[:up|:down]")]
    pub section: Option<String>,
    /// Compute part I of N only; `merge` puts the parts together.
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    pub shard: Option<String>,
    /// Have all shards run by a cluster's engine, in a folder that all of its machines see.
    #[arg(long, value_enum)]
    pub engine: Option<Engine>,
    /// Into how many shards an engine parts the sweep; 16 by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub shards: Option<u16>,
    /// Where Dask's scheduler is, by default what DASK_SCHEDULER_ADDRESS says.
    #[arg(long, value_name = "ADDRESS")]
    pub scheduler: Option<String>,
    /// How many threads compute; the result does not depend on it. One per core by default, and one for
    /// a shard of an engine.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print one JSON document on what was done.
    #[arg(long)]
    pub json: bool,
}

/// Options of `merge`.
#[derive(Args)]
pub struct Merge {
    /// The folder of the sweep.
    pub dir: PathBuf,
    /// Print one JSON document on what was written.
    #[arg(long)]
    pub json: bool,
}
