//! Options of the paper's studies and of the tour.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Which mode shapes the paper's arm is derived with.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModeShapes {
    /// Those of a clamped-free beam.
    Corrected,
    /// Those that the paper prints, Eq. (18) and (19).
    Printed,
}

/// Options of `study-search`.
#[derive(Args)]
pub struct StudySearch {
    /// The folder to write to; a search begun there goes on.
    #[arg(long)]
    pub out: PathBuf,
    /// How many parameter sets.
    #[arg(long, default_value_t = 5000)]
    pub sets: usize,
    /// Which sequence of sets.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Which mode shapes the arm has.
    #[arg(long, value_enum, default_value_t = ModeShapes::Corrected)]
    pub mode_shapes: ModeShapes,
    /// Print one JSON document on what was found.
    #[arg(long)]
    pub json: bool,
}

/// Options of `tour`.
#[derive(Args)]
pub struct Tour {
    /// The folder to write to.
    #[arg(long)]
    pub out: PathBuf,
    /// Print one JSON document on what was left.
    #[arg(long)]
    pub json: bool,
}

/// The paper's studies.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StudyName {
    /// Fig. 4: modal truncation, S = 4 against S = 5, and convergence over S = 1 to 16.
    Order,
    /// Fig. 5-10: omega = 5 pi, b = 0, 10, 25, 50, 100 um.
    Backlash,
    /// Fig. 11-15: omega = 10 pi, the same b.
    Frequency,
    /// Fig. 16-19: the rigid arm against the flexible one.
    Flexibility,
}

/// Options of `study`.
#[derive(Args)]
pub struct Study {
    /// Which study.
    #[arg(value_enum)]
    pub name: StudyName,
    /// The folder to write to.
    #[arg(long)]
    pub out: PathBuf,
    /// Print `study.json` on stdout instead of the summary.
    #[arg(long)]
    pub json: bool,
}
