//! Options of commands that compare a model with records.

use std::path::PathBuf;

use clap::Args;

use super::shared::{Json, ModelFile, NoiseSeed, parse_seconds};

/// Options of `dataset`.
#[derive(Args)]
pub struct Dataset {
    /// Record: text or Parquet.
    pub record: PathBuf,
    /// Specification file (TOML) of the machine.
    pub spec: PathBuf,
    /// Dataset file to write, in the record's folder or above it. Default: stdout.
    #[arg(long)]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `compare`.
#[derive(Args)]
pub struct Compare {
    #[command(flatten)]
    pub model: ModelFile,
    /// Dataset file (TOML) that describes the records.
    pub dataset: PathBuf,
    /// Output folder for `comparison.json` and `report.html`.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub noise: NoiseSeed,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `discover`.
#[derive(Args)]
pub struct Discover {
    #[command(flatten)]
    pub model: ModelFile,
    /// Dataset file (TOML) that describes the records.
    pub dataset: PathBuf,
    /// Output folder for `discovery.json`, `extended.toml` and `report.html`, and for `experiment.csv` if an
    /// experiment would separate effects.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub noise: NoiseSeed,
    /// Time limit of the search, in s. Default: no limit. The fit of the given model and the final check are always
    /// completed.
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = parse_seconds)]
    pub limit: Option<f64>,
    /// File (TOML) with additional effects for the catalogue.
    #[arg(long, value_name = "EFFECTS.toml")]
    pub effects: Option<PathBuf>,
    #[command(flatten)]
    pub output: Json,
}
