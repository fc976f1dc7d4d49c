//! Options of commands that simulate a model or look at it about a state.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// How to integrate.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// `exact` where the model is linear between its switches, else `rk`, and `radau` where the
    /// motion is stiff.
    Auto,
    /// From switch to switch without any error but rounding; for models that are linear
    /// between their switches.
    Exact,
    /// Runge-Kutta of order 8 with location of the switching surfaces.
    Rk,
    /// Adams' multistep method of variable order, the paper's, with the same location.
    Adams,
    /// Radau's implicit method of order 5 with exact Jacobians, for stiff models.
    Radau,
}

impl From<Solver> for eomgen_compiled_model::Solver {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Auto => Self::Auto,
            Solver::Exact => Self::Exact,
            Solver::Rk => Self::Rk,
            Solver::Adams => Self::Adams,
            Solver::Radau => Self::Radau,
        }
    }
}

/// Options of `simulate`.
#[derive(Args)]
pub struct Simulate {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// Simulated time, in s. With --record the record's by default.
    #[arg(
        long,
        allow_negative_numbers = true,
        required_unless_present = "record"
    )]
    pub until: Option<f64>,
    /// The file to write: CSV, or Parquet if its name ends in `.parquet`; `-` for stdout.
    #[arg(long)]
    pub out: PathBuf,
    /// Another value for a parameter: a number in the unit the specification declares, an expression of
    /// parameters as `2*l`, or one with a unit as `"30 mm"` (repeatable).
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// A dataset file whose record feeds the inputs.
    #[arg(long, value_name = "DATASET.toml")]
    pub record: Option<PathBuf>,
    /// Which record of the dataset.
    #[arg(long, default_value = "train[0]", requires = "record")]
    pub record_name: String,
    /// Time from one row to the next, in s: a thousandth of the whole by default, with
    /// --record the record's times.
    #[arg(long, allow_negative_numbers = true)]
    pub sample: Option<f64>,
    /// How to integrate.
    #[arg(long, value_enum, default_value = "auto")]
    pub solver: Solver,
    /// What drives an input: an expression of `t` and of parameters. Numbers and `t` alone give it in its
    /// unit, with t in s; `5*above(t - 1)` is a step (repeatable).
    #[arg(long, value_name = "NAME=EXPRESSION")]
    pub input: Vec<String>,
    /// Where a coordinate, a mode or a rate (NAME_dot) begins, instead of where the specification says: a
    /// number in SI, an expression of parameters, or one with a unit (repeatable).
    #[arg(long, value_name = "NAME=VALUE")]
    pub initial: Vec<String>,
    /// An SVG file to draw coordinates and observables in.
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Relative tolerance of every state variable, 1e-9 by default; no effect on the exact
    /// solver.
    #[arg(long, allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
    /// Longest step of the solver, in s: give it if an input has pulses that are short beside the
    /// whole, which longer steps may miss; no effect on the exact solver.
    #[arg(long, allow_negative_numbers = true)]
    pub max_step: Option<f64>,
    /// End with exit status 1 if the energy changes without work, or if bodies overlap.
    #[arg(long)]
    pub strict: bool,
    /// Print one JSON document on the work done and the energy balance.
    #[arg(long)]
    pub json: bool,
}

/// Options of `linearise`.
#[derive(Args)]
pub struct Linearise {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// Another value for a parameter: a number in the unit the specification declares, an expression of
    /// parameters as `2*l`, or one with a unit as `"30 mm"` (repeatable).
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// A coordinate, a rate (NAME_dot), an input or `t` of the point: a number in SI, an expression of
    /// parameters as `pi/3`, or one with a unit as `"30 deg"`; the initial state, inputs of 0 and t = 0 by
    /// default. The word `trim` for the equilibrium nearest to that (repeatable).
    #[arg(long, value_name = "NAME=VALUE|trim")]
    pub at: Vec<String>,
    /// The file to write, in place of stdout: JSON, or arrays of NumPy if its name ends in `.npz`.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Print one JSON document, which is what is printed in any case.
    #[arg(long)]
    pub json: bool,
}

/// Options of `modes`.
#[derive(Args)]
pub struct Modes {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// Another value for a parameter: a number in the unit the specification declares, an expression of
    /// parameters as `2*l`, or one with a unit as `"30 mm"` (repeatable).
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// A coordinate, a rate (NAME_dot), an input or `t` of the point: a number in SI, an expression of
    /// parameters as `pi/3`, or one with a unit as `"30 deg"`; the initial state, inputs of 0 and t = 0 by
    /// default. The word `trim` for the equilibrium nearest to that (repeatable).
    #[arg(long, value_name = "NAME=VALUE|trim")]
    pub at: Vec<String>,
    /// An SVG file to draw the lowest modes in: shapes of fields over their lengths, coordinates as
    /// bars.
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    pub json: bool,
}

/// Options of `trim`.
#[derive(Args)]
pub struct Trim {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// Another value for a parameter: a number in the unit the specification declares, an expression of
    /// parameters as `2*l`, or one with a unit as `"30 mm"` (repeatable).
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// A coordinate, an input or the speed (NAME_dot) of a coordinate on which nothing depends that keeps this
    /// value: a number in SI, an expression of parameters, or one with a unit (repeatable).
    #[arg(long, value_name = "NAME=VALUE")]
    pub fix: Vec<String>,
    /// Where the search begins, in place of the initial state; given as with --fix (repeatable).
    #[arg(long, value_name = "NAME=VALUE")]
    pub state: Vec<String>,
    /// Print one JSON document, which is what is printed in any case.
    #[arg(long)]
    pub json: bool,
}
