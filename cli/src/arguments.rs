//! What can be typed, with an example for every command.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use eomgen_codegen::mechanics::outputs::{Output, UnknownOutput};

/// From a specification of a mechanical system's energies to fast, checked equations of
/// motion in Rust.
#[derive(Parser)]
#[command(name = "eomgen", version, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Subcommand)]
pub enum Command {
    /// Read and check a specification: grammar, names, units, inertia at the initial state,
    /// unused parameters.
    #[command(after_help = "Example:\n  eomgen check model-spec/models/planetary_arm.toml")]
    Check(Check),
    /// Print the equations of motion and what each coefficient is.
    #[command(
        after_help = "Example:\n  eomgen derive model-spec/models/planetary_arm.toml --order 4 --format latex"
    )]
    Derive(Derive),
    /// Emit the equations of motion as source.
    #[command(
        after_help = "Examples:\n  eomgen generate model-spec/models/planetary_arm.toml --order 5 --out arm5\n  eomgen generate model-spec/models/emps.toml --with jacobians,inverse_dynamics --certify --out emps\n  eomgen generate --all --check"
    )]
    Generate(Generate),
    /// Check derived equations against independent ones and write a certificate.
    #[command(
        after_help = "Example:\n  eomgen validate model-spec/models/planetary_arm.toml --order 16 --out certificate.json"
    )]
    Validate(Validate),
    /// Simulate and write a trajectory.
    #[command(
        after_help = "Example:\n  eomgen simulate model-spec/models/planetary_arm.toml --order 4 --until 2 --sample 0.001 --set b_sp=50e-6 --out arm.csv"
    )]
    Simulate(Simulate),
    /// Print the matrices A, B, C, D of a model about a state.
    #[command(
        after_help = "Example:\n  eomgen linearise model-spec/models/furuta_pendulum.toml --at theta=pi --out upright.json"
    )]
    Linearise(Linearise),
    /// Print natural frequencies, damping and shapes of a model about a state.
    #[command(
        after_help = "Example:\n  eomgen modes model-spec/models/hub_beam_tip_mass.toml --order 4"
    )]
    Modes(Modes),
    /// Find the equilibrium nearest to a state: at rest or running steadily.
    #[command(
        after_help = "Examples:\n  eomgen trim model-spec/models/pendulum.toml\n  eomgen trim model-spec/models/furuta_pendulum.toml --fix u=0 --fix phi=0.5\n  eomgen trim model-spec/models/pendulum.toml --state theta=\"20 deg\"\nCoordinates are free, inputs 0. Where coordinates are fixed, inputs that are not are free. A coordinate on\nwhich nothing depends may move at a constant speed: the one that it starts with, or the one that is found."
    )]
    Trim(Trim),
    /// Propose a dataset file for a record: how its numbers stand, which columns are what, how
    /// much noise they hold, with every guess marked.
    #[command(
        after_help = "Example:\n  eomgen dataset train.csv my_machine.toml --out proposed.toml\nWhat it guesses stands beside each key as a comment; docs/discovery.md has all keys."
    )]
    Dataset(Dataset),
    /// Say where a model and its measurements disagree.
    #[command(
        after_help = "Example:\n  eomgen compare my_machine.toml dataset.toml --out compared"
    )]
    Compare(Compare),
    /// Find what a model lacks, name it, add it, and show the gap shrink.
    #[command(
        after_help = "Examples:\n  eomgen discover my_machine.toml dataset.toml --out found --seed 1\n  eomgen discover my_machine.toml dataset.toml --out found --limit 60\nWhere records do not tell effects apart, found/experiment.csv is an input that does: play it, list its record beside the others,\nand run this again; docs/discovery.md has its bounds."
    )]
    Discover(Discover),
    /// Measure the motion over a grid of parameters.
    #[command(
        after_help = "Examples:\n  eomgen sweep model-spec/models/planetary_arm.toml --vary b_sp,b_pr=0:100e-6:50 --vary omega=10:60:50 --measure lyapunov,poincare --out map\n  eomgen sweep SPEC --vary b_sp,b_pr=0:100e-6:200 --vary omega=10:40:200 --measure poincare --out DIR --shard 2/3\n  eomgen sweep SPEC --vary k=10:1e5:50:log --measure max:tip,rms:tip --until 2 --out DIR\n  eomgen sweep SPEC --vary k=1:9:200 --measure poincare:y_dot --section x=0:up --until 500 --out DIR\n  eomgen sweep SPEC --vary omega=10:40:1000 --measure poincare --out DIR --engine slurm --shards 100\n  eomgen sweep SPEC --samples 1000 --seed 1 --measure max:tip --until 2 --out DIR\nA run that was interrupted goes on where it was. Shards may run one after the other or\nat once, in one folder or with their files in `parts` collected in one; then `eomgen merge DIR`."
    )]
    Sweep(Sweep),
    /// Put the shards of a sweep together; refuses where some are missing.
    #[command(after_help = "Example:\n  eomgen merge map")]
    Merge(Merge),
    /// Judge the paper's claims, at the assumed values and over plausible ranges.
    #[command(after_help = "Example:\n  eomgen study-search --sets 5000 --out search")]
    StudySearch(StudySearch),
    /// One of the paper's numerical studies: data, figures as the paper has them, and
    /// `study.json`.
    #[command(after_help = "Example:\n  eomgen study backlash --out studies/backlash")]
    Study(Study),
    /// Write a page on which a model can be played with: one HTML file that needs nothing else.
    #[command(
        after_help = "Example:\n  eomgen page model-spec/models/double_pendulum.toml --out double_pendulum.html"
    )]
    Page(Page),
    /// The newcomer's walk: check, derive, generate, validate and simulate the paper's arm,
    /// find what a stage lacks, and leave one HTML page.
    #[command(after_help = "Example:\n  eomgen tour --out tour")]
    Tour(Tour),
    /// Print the JSON schema of specifications, by which an editor completes and checks them.
    #[command(
        after_help = "Example:\n  eomgen schema > eomgen.schema.json\nA specification beside it then begins with the line\n  #:schema ./eomgen.schema.json"
    )]
    Schema,
    /// Print a shell's completions of commands and options.
    #[command(
        after_help = "Examples:\n  eomgen completions bash > ~/.local/share/bash-completion/completions/eomgen\n  eomgen completions fish > ~/.config/fish/completions/eomgen.fish\n  eomgen completions zsh > ~/.zfunc/_eomgen"
    )]
    Completions(Completions),
    /// Write man pages, one of the program and one of every command.
    #[command(after_help = "Example:\n  eomgen man --out ~/.local/share/man/man1")]
    Man(Man),
}

/// Options of `check`.
#[derive(Args)]
pub struct Check {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// Print one JSON document.
    #[arg(long)]
    pub json: bool,
}

/// How equations are printed.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Plain text.
    Text,
    /// A LaTeX document.
    Latex,
    /// One JSON document.
    Json,
}

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

/// Options of `derive`.
#[derive(Args)]
pub struct Derive {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// How to print.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// The same as `--format json`.
    #[arg(long)]
    pub json: bool,
}

/// What source is emitted.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// Rust, `no_std`, without dependencies: `lib.rs`.
    Rust,
    /// C99 that is C++ as well, without allocation or library: `NAME.h` and `NAME.c`, by the
    /// model's name.
    C99,
    /// The functions `rates` and `jac_rates` of (t, x, u, p) for CasADi's `external`:
    /// `NAME_casadi.c`, for one `cc -shared -fPIC`.
    Casadi,
    /// A functional mock-up unit by FMI 2.0, for model exchange and co-simulation: `NAME.fmu`, with
    /// sources and, where there is a C compiler `cc`, a binary for this machine.
    Fmu2,
    /// The same by FMI 3.0.
    Fmu3,
}

/// What `generate` leaves besides.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Extra {
    /// Functions in the source.
    Output(Output),
    /// A benchmark beside it.
    Bench,
}

impl Extra {
    /// The functions among what was asked for.
    pub fn outputs(all: &[Self]) -> Vec<Output> {
        let request = |extra: &Self| match extra {
            Self::Output(output) => Some(*output),
            Self::Bench => None,
        };
        all.iter().filter_map(request).collect()
    }
}

impl std::str::FromStr for Extra {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "bench" => return Ok(Self::Bench),
            "hessians" => return Ok(Self::Output(Output::Hessians)),
            _ => {}
        }
        let output = name.parse().map(Self::Output);
        output.map_err(|error: UnknownOutput| format!("{error}, hessians, bench"))
    }
}

/// Options of `generate`.
#[derive(Args)]
pub struct Generate {
    /// The specification.
    #[arg(required_unless_present = "all")]
    pub spec: Option<PathBuf>,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// What to emit besides rates, observables, energy, power, guards and mass matrix:
    /// bias_forces, inverse_dynamics, guard_rates, jacobians, products (of the Jacobian with
    /// vectors), linearisation, regimes (rates with every contact
    /// decided), lanes (every function inlined once more), hessians (of the weighted rates, for
    /// CasADi), bench (a benchmark beside the source).
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub with: Vec<Extra>,
    /// The language.
    #[arg(long, value_enum, default_value = "rust")]
    pub target: Target,
    /// The folder to write to.
    #[arg(long, required_unless_present = "all")]
    pub out: Option<PathBuf>,
    /// Leave `certificate.json` beside the source, as `validate` writes it; exit status 1 if
    /// any check fails.
    #[arg(long)]
    pub certify: bool,
    /// Regenerate the checked-in variants in `generated/src` and their certificates (from the
    /// project's folder).
    #[arg(long, conflicts_with_all = ["spec", "out", "order", "with", "target", "certify"])]
    pub all: bool,
    /// With --all: compare instead of writing; exit status 1 on a difference.
    #[arg(long)]
    pub check: bool,
    /// Print one JSON document on what was written.
    #[arg(long)]
    pub json: bool,
}

/// Options of `validate`.
#[derive(Args)]
pub struct Validate {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// What is emitted besides, as for `generate`, and judged with it: the certificate is of
    /// one emitted source, and says nothing of what is not in it.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub with: Vec<Extra>,
    /// The file to write the certificate to, `-` for stdout; without it only the summary is
    /// printed.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Print the certificate on stdout instead of the summary.
    #[arg(long)]
    pub json: bool,
}

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
    /// rate goes up through a value, or down with `:down`. --transient and --periods count
    /// crossings then.
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

/// Options of `page`.
#[derive(Args)]
pub struct Page {
    /// The specification.
    pub spec: PathBuf,
    /// Modal truncation order of every field, instead of the specification's.
    #[arg(long, allow_negative_numbers = true)]
    pub order: Option<String>,
    /// The file to write, or `-` for stdout.
    #[arg(long)]
    pub out: PathBuf,
    /// Print one JSON document on the page instead of the summary.
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

/// Options of `completions`.
#[derive(Args)]
pub struct Completions {
    /// The shell.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Options of `man`.
#[derive(Args)]
pub struct Man {
    /// The folder to write to.
    #[arg(long)]
    pub out: PathBuf,
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
