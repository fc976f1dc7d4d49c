//! Options of commands that simulate a model or analyse it at a state.

use std::path::PathBuf;

use clap::Args;

use super::shared::{
    InputValues, Integration, Json, ModelFile, OutputInterval, ParameterValues, StateValues,
    parse_seconds,
};

/// Options of `simulate`.
#[derive(Args)]
pub struct Simulate {
    #[command(flatten)]
    pub model: ModelFile,
    /// Simulated time, in s, or with a unit such as `"10 min"`. Default with --record: the end of the record.
    #[arg(
        long,
        value_name = "T",
        allow_negative_numbers = true,
        value_parser = parse_seconds,
        required_unless_present = "record"
    )]
    pub until: Option<f64>,
    /// Output file: CSV, or Parquet if the name ends in `.parquet`; `-` for stdout.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub parameters: ParameterValues,
    #[command(flatten)]
    pub initial: StateValues,
    #[command(flatten)]
    pub inputs: InputValues,
    /// Shared library with a sampled controller, with the C interface of examples/controllers/eomgen_controller.h. Its
    /// outputs drive inputs of the model, in addition to the controllers of the specification.
    #[arg(long, value_name = "LIBRARY")]
    pub controller: Option<PathBuf>,
    #[command(flatten)]
    pub rows: OutputInterval,
    #[command(flatten)]
    pub integration: Integration,
    /// Figure (SVG) of the coordinates and observables.
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Event log (CSV): time, surface, kind, mode before and after, and jumps of the rates.
    #[arg(long, value_name = "FILE.csv")]
    pub events: Option<PathBuf>,
    /// Exit with status 1 if the energy changes without work, or if bodies overlap.
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `linearise`.
#[derive(Args)]
pub struct Linearise {
    #[command(flatten)]
    pub model: ModelFile,
    #[command(flatten)]
    pub parameters: ParameterValues,
    #[command(flatten)]
    pub point: StateValues,
    /// Sample period, in s. Adds the matrices A_d and B_d of x_(k+1) = A_d x_k + B_d u_k, for inputs held over each
    /// period.
    #[arg(long, value_name = "PERIOD", allow_negative_numbers = true, value_parser = parse_seconds)]
    pub discrete: Option<f64>,
    /// Output file: JSON, or NumPy arrays if the name ends in `.npz`. Default: JSON on stdout.
    #[arg(long)]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `modes`.
#[derive(Args)]
pub struct Modes {
    #[command(flatten)]
    pub model: ModelFile,
    #[command(flatten)]
    pub parameters: ParameterValues,
    #[command(flatten)]
    pub point: StateValues,
    /// Figure (SVG) of the lowest modes: shapes of fields over their length, and coordinates as bars.
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `trim`.
#[derive(Args)]
pub struct Trim {
    #[command(flatten)]
    pub model: ModelFile,
    #[command(flatten)]
    pub parameters: ParameterValues,
    #[command(flatten)]
    pub start: StateValues,
    /// Fixed value of a coordinate, an input, or the speed (NAME_dot) of a cyclic coordinate. Write it as for --state.
    /// Repeatable.
    #[arg(long, value_name = "NAME=VALUE")]
    pub fix: Vec<String>,
    /// Print a table with units instead of JSON.
    #[arg(long, conflicts_with = "json")]
    pub table: bool,
    #[command(flatten)]
    pub output: Json,
}
