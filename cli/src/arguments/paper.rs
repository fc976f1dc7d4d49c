//! Options of the commands for the paper, and of the tour.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::shared::Json;

/// Commands for the paper.
#[derive(Subcommand)]
pub enum Paper {
    /// Run one of the paper's numerical studies; write its data, its figures and `study.json`.
    #[command(after_help = "Example:\n  eomgen paper study backlash --out studies/backlash")]
    Study(Study),
    /// Evaluate the paper's claims at the assumed values and over plausible ranges of undisclosed parameters.
    #[command(after_help = "Example:\n  eomgen paper claims --sets 5000 --out search")]
    Claims(Claims),
}

/// Mode shapes of the paper's arm.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModeShapes {
    /// Mode shapes of a clamped-free beam.
    Corrected,
    /// Mode shapes as printed in the paper, Eq. (18) and (19).
    Printed,
}

/// Options of `paper claims`.
#[derive(Args)]
pub struct Claims {
    /// Output folder. An interrupted search is resumed.
    #[arg(long)]
    pub out: PathBuf,
    /// Number of parameter sets.
    #[arg(long, value_name = "N", default_value_t = 5000)]
    pub sets: usize,
    /// Seed of the parameter sets.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Mode shapes of the arm.
    #[arg(long, value_enum, default_value_t = ModeShapes::Corrected)]
    pub mode_shapes: ModeShapes,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `tour`.
#[derive(Args)]
pub struct Tour {
    /// Output folder.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub output: Json,
}

/// The paper's studies.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StudyName {
    /// Fig. 4: modal truncation, S = 4 against S = 5, and convergence over S = 1 to 16.
    Order,
    /// Fig. 5-10: omega = 5 pi, b = 0, 10, 25, 50, 100 um.
    Backlash,
    /// Fig. 11-15: omega = 10 pi, b as for `backlash`.
    Frequency,
    /// Fig. 16-19: comparison of the rigid and the flexible arm.
    Flexibility,
}

/// Options of `paper study`.
#[derive(Args)]
pub struct Study {
    /// Name of the study.
    #[arg(value_enum)]
    pub name: StudyName,
    /// Output folder.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub output: Json,
}
