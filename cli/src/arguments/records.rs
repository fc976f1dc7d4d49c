//! Options of commands that compare a model with records.

use std::path::PathBuf;

use clap::Args;

/// Options of `dataset`.
#[derive(Args)]
pub struct Dataset {
    /// The record: text or Parquet.
    pub record: PathBuf,
    /// The specification of the machine.
    pub spec: PathBuf,
    /// The dataset file, in the record's folder or above it; on stdout if absent.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    pub json: bool,
}

/// Options of `compare`.
#[derive(Args)]
pub struct Compare {
    /// The specification.
    pub spec: PathBuf,
    /// The dataset's description.
    pub dataset: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// The folder for `comparison.json` and `report.html`.
    #[arg(long)]
    pub out: PathBuf,
    /// Draws the noise of the twin that gives the floor.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Print one JSON document.
    #[arg(long)]
    pub json: bool,
}

/// Options of `discover`.
#[derive(Args)]
pub struct Discover {
    /// The specification.
    pub spec: PathBuf,
    /// The dataset's description.
    pub dataset: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// The folder for `discovery.json`, `extended.toml`, `report.html`, and `experiment.csv` where one would tell more.
    #[arg(long)]
    pub out: PathBuf,
    /// Draws the noise of the twin that gives the floor.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// End the search after so many seconds, with what is known by then. The model as it is, is
    /// fitted in any case, and what is found is written back and run again.
    #[arg(long, allow_negative_numbers = true)]
    pub limit: Option<f64>,
    /// Effects of your own, beside those of the catalogue.
    #[arg(long)]
    pub effects: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    pub json: bool,
}
