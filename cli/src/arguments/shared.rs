//! Options that several commands share.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;

/// Parses a time: a number in s, or a number with a unit such as `10 ms`.
pub fn parse_seconds(text: &str) -> Result<f64, String> {
    if let Ok(number) = text.trim().parse() {
        return Ok(number);
    }
    match Unit::parse_quantity(text) {
        Some((number, unit)) if unit.dimension == Dimension::TIME => Ok(unit.to_si(number)),
        Some((_, unit)) => Err(format!("a time is in s, not in {unit}")),
        None => Err("expected a number in s, or a number with a unit such as \"10 ms\"".to_owned()),
    }
}

/// Modal truncation order.
#[derive(Args)]
pub struct Order {
    /// Number of modes of every field (modal truncation order), a whole number from 0 to 128. Default: the orders in the
    /// specification.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    order: Option<String>,
}

impl Order {
    /// Text of the option, if present.
    pub fn text(&self) -> Option<&str> {
        self.order.as_deref()
    }
}

/// A specification and its truncation order.
#[derive(Args)]
pub struct ModelFile {
    /// Specification file (TOML).
    pub spec: PathBuf,
    #[command(flatten)]
    pub order: Order,
}

/// Values of parameters.
#[derive(Args)]
pub struct ParameterValues {
    /// Value of a parameter: a number in its declared unit, an expression of parameters such as `2*l`, or a
    /// value with a unit such as `"30 mm"`. Repeatable.
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
}

/// Values of states.
#[derive(Args)]
pub struct StateValues {
    /// Value of a coordinate, a rate (NAME_dot) or another state: a number in SI, an expression of parameters
    /// such as `pi/3`, or a value with a unit such as `"30 deg"`. `linearise`, `modes` and `trim` also accept
    /// inputs and `t`. The word `trim` selects the equilibrium that `trim` finds (except in the command `trim`).
    /// Repeatable. Default: the initial state of the specification, inputs 0, t = 0.
    #[arg(long, value_name = "NAME=EXPR|trim", alias = "at", alias = "initial")]
    pub state: Vec<String>,
}

/// Inputs over time.
#[derive(Args)]
pub struct InputValues {
    /// Expression of `t` (in s) and parameters that drives an input. The value is in the unit of the input. An expression
    /// without parameters may end with another unit: `F="5*above(t - 1) kN"` is a step. Repeatable.
    #[arg(long, value_name = "NAME=EXPR")]
    pub input: Vec<String>,
    /// Dataset file with a record that drives the inputs.
    #[arg(long, value_name = "DATASET.toml")]
    pub record: Option<PathBuf>,
    /// Name of the record in the dataset file.
    #[arg(
        long,
        value_name = "NAME",
        default_value = "train[0]",
        requires = "record"
    )]
    pub record_name: String,
}

/// Output interval.
#[derive(Args)]
pub struct OutputInterval {
    /// Output interval: the time between two rows, in s. Default: a thousandth of the simulated time; with
    /// --record, the times of the record.
    #[arg(
        long,
        value_name = "DT",
        allow_negative_numbers = true,
        value_parser = parse_seconds,
        alias = "sample"
    )]
    pub interval: Option<f64>,
}

/// Method of integration.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// `exact` if the model is linear between its switches, else `rk`, or `radau` if the motion is stiff.
    Auto,
    /// Matrix exponentials from switch to switch, with rounding errors only; for models that are linear
    /// between their switches.
    Exact,
    /// Explicit Runge-Kutta method of order 8 with event location.
    Rk,
    /// Adams multistep method of variable order (the paper's method) with event location.
    Adams,
    /// Implicit Radau IIA method of order 5 with exact Jacobians, for stiff models.
    Radau,
    /// Classical Runge-Kutta method of order 4 with the step size --step, bit-identical to the emitted `step`. Friction
    /// and impacts act at the ends of steps. Inputs are held during a step.
    Fixed,
}

impl From<Solver> for eomgen_compiled_model::Solver {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Auto => Self::Auto,
            Solver::Exact => Self::Exact,
            Solver::Rk => Self::Rk,
            Solver::Adams => Self::Adams,
            Solver::Radau => Self::Radau,
            Solver::Fixed => Self::Fixed,
        }
    }
}

/// Solver and its accuracy.
#[derive(Args)]
pub struct Integration {
    /// Method of integration.
    #[arg(long, value_enum, default_value = "auto")]
    pub solver: Solver,
    /// Relative tolerance of every state. Default: 1e-9. No effect on the exact solver.
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
    /// Longest step, in s. Default: no limit. Set it if an input has short pulses that longer steps may miss.
    /// No effect on the exact solver. For the solver `fixed`, the step size.
    #[arg(
        long,
        value_name = "DT",
        allow_negative_numbers = true,
        value_parser = parse_seconds,
        visible_alias = "step"
    )]
    pub max_step: Option<f64>,
}

/// Seed of the noise of the replica.
#[derive(Args)]
pub struct NoiseSeed {
    /// Seed of the random noise of the replica, the simulated records that give the noise floor.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Output for programs.
#[derive(Args)]
pub struct Json {
    /// Print one JSON document to stdout instead of text.
    #[arg(long)]
    pub json: bool,
}
