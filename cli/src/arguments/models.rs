//! Options of commands that read a specification and write its equations or a page.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use eomgen_codegen::mechanics::outputs::Output;
use eomgen_targets::parse_output;

use super::shared::{Json, ModelFile, Order, ParameterValues, StateValues};

/// Options of `check`.
#[derive(Args)]
pub struct Check {
    #[command(flatten)]
    pub model: ModelFile,
    #[command(flatten)]
    pub output: Json,
}

/// Format of printed equations.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Plain text.
    Text,
    /// A LaTeX document.
    Latex,
    /// One JSON document.
    Json,
}

/// Options of `derive`.
#[derive(Args)]
pub struct Derive {
    #[command(flatten)]
    pub model: ModelFile,
    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    #[command(flatten)]
    pub output: Json,
}

/// Language or interface of the emitted code.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// Rust, `no_std`, without dependencies: `lib.rs`.
    Rust,
    /// C99, also valid C++, without allocation or libraries: `NAME.h` and `NAME.c`, named after the model.
    C99,
    /// Device functions of CUDA C++ (nvcc, NVRTC, clang), bit-identical to the C code: `NAME.cuh`.
    Cuda,
    /// The functions `rates` and `jac_rates` of (t, x, u, p) for CasADi's `external`:
    /// `NAME_casadi.c`. Compile it with `cc -shared -fPIC`.
    Casadi,
    /// The functions for CasADi, and the Python module `NAME_acados.py`, which builds the model for acados.
    Acados,
    /// A functional mock-up unit (FMI 2.0) for model exchange and co-simulation: `NAME.fmu` with the specification and a
    /// library that simulates it, for the operating system and processor of this computer.
    Fmu2,
    /// A functional mock-up unit (FMI 3.0) with the content of `fmu2`.
    Fmu3,
}

impl From<Target> for eomgen_targets::Target {
    fn from(target: Target) -> Self {
        match target {
            Target::Rust => Self::Rust,
            Target::C99 => Self::C99,
            Target::Cuda => Self::Cuda,
            Target::Casadi => Self::Casadi,
            Target::Acados => Self::Acados,
            Target::Fmu2 => Self::Fmu2,
            Target::Fmu3 => Self::Fmu3,
        }
    }
}

/// Form of the emitted source.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Packaging {
    /// Rust as the root of a crate: `lib.rs`.
    Crate,
    /// Rust as a module: `mod.rs`.
    Module,
    /// C as one header with the functions, `NAME.h`; one file of the program compiles the functions.
    HeaderOnly,
}

/// Additional output of `generate`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Extra {
    /// Functions in the source.
    Output(Output),
    /// A benchmark.
    Bench,
    /// Coefficients as constants.
    Baked,
    /// Test vectors and the function that compares them.
    SelfTest,
    /// Lines of the source with the terms of the specification.
    Trace,
}

impl Extra {
    /// Returns the requested functions of the emitted code.
    pub fn select_outputs(all: &[Self]) -> Vec<Output> {
        let request = |extra: &Self| match extra {
            Self::Output(output) => Some(*output),
            Self::Bench | Self::Baked | Self::SelfTest | Self::Trace => None,
        };
        all.iter().filter_map(request).collect()
    }
}

impl std::str::FromStr for Extra {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "bench" => return Ok(Self::Bench),
            "baked" => return Ok(Self::Baked),
            "self_test" => return Ok(Self::SelfTest),
            "trace" => return Ok(Self::Trace),
            _ => {}
        }
        let output = parse_output(name).map(Self::Output);
        output.map_err(|error| format!("{error}, bench, baked, self_test, trace"))
    }
}

/// Options of `generate`.
#[derive(Args)]
pub struct Generate {
    /// Specification file (TOML).
    #[arg(required_unless_present = "all")]
    pub spec: Option<PathBuf>,
    #[command(flatten)]
    pub order: Order,
    #[command(flatten)]
    pub parameters: ParameterValues,
    /// Functions to emit in addition to rates, observables, energy, power, guards and mass matrix:
    /// bias_forces, inverse_dynamics, guard_rates, jacobians (jacobians:states, jacobians:inputs or
    /// jacobians:parameters: with respect to one kind of variables), products (Jacobian times vector), linearisation,
    /// regimes (rates in a given regime), step (a step of the solver `fixed`), lanes (an inlined copy of every function, for SIMD), hessians
    /// (of the weighted rates, for CasADi), bench (a benchmark), baked (the coefficients of the default parameters as
    /// constants), self_test (test vectors and a function that compares a target with them), trace (`trace.json`: unit
    /// and terms of the specification of each value, by line of the source).
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub with: Vec<Extra>,
    /// Language or interface of the emitted code.
    #[arg(long, value_enum, default_value = "rust")]
    pub target: Target,
    /// Form of the emitted source. Default: a crate in Rust, `NAME.h` and `NAME.c` in C.
    #[arg(long, value_enum)]
    pub packaging: Option<Packaging>,
    /// Output folder.
    #[arg(long, required_unless_present = "all")]
    pub out: Option<PathBuf>,
    /// Write `certificate.json` (see `eomgen validate`) to the same folder; exit with status 1 if a check fails.
    #[arg(long)]
    pub certify: bool,
    /// Also write bounds of the instructions and the stack of each function to the certificate. COMMAND is a cross compiler
    /// with its options (see `eomgen instructions`). Repeatable.
    #[arg(
        long,
        value_name = "COMMAND",
        requires = "certify",
        allow_hyphen_values = true
    )]
    pub instructions: Vec<String>,
    /// Regenerate the variants of `generated/family.toml` and their certificates, as `eomgen family`; run it in the
    /// project's folder.
    #[arg(long, conflicts_with_all = ["spec", "out", "order", "set", "with", "target", "packaging", "certify"])]
    pub all: bool,
    /// With --all: compare instead of writing; exit with status 1 on a difference.
    #[arg(long)]
    pub check: bool,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `family`.
#[derive(Args)]
pub struct Family {
    /// Family file (TOML).
    pub file: PathBuf,
    /// Output folder. It contains one folder for each variant, `mod.rs` and `manifest.json`.
    #[arg(long)]
    pub out: PathBuf,
    /// Compare instead of writing; exit with status 1 on a missing, edited, stale or different file, a certificate
    /// that did not pass, or operation counts above those of the manifest.
    #[arg(long)]
    pub check: bool,
    /// Generate all variants, also the unchanged ones.
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `verify`.
#[derive(Args)]
pub struct Verify {
    /// Emitted source: Rust (`.rs`), C (`.c`) with its header in the same folder, a header with the functions (`.h`),
    /// functions for CasADi (`NAME_casadi.c`), or a functional mock-up unit (`.fmu`).
    pub file: PathBuf,
    /// Certificate of the source.
    pub certificate: PathBuf,
    /// C compiler with its options, as in your build. Default: `cc` or the program in CC, with
    /// `-std=c99 -O2 -ffp-contract=off`.
    #[arg(long, value_name = "COMMAND", allow_hyphen_values = true)]
    pub cc: Option<String>,
    /// Cross compiler with its options, to compute the bounds of instructions and stack in the certificate again. Commands
    /// that are only in the certificate are never run. Repeatable.
    #[arg(long, value_name = "COMMAND", allow_hyphen_values = true)]
    pub instructions: Vec<String>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `identify`.
#[derive(Args)]
pub struct Identify {
    /// Object file, library, program or firmware image.
    pub image: PathBuf,
    /// Folder with certificates. The command prints the certificate of each variant, and exits with status 1 if a
    /// certificate is missing.
    #[arg(long, value_name = "DIR")]
    pub certificates: Option<PathBuf>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `instructions`.
#[derive(Args)]
pub struct Instructions {
    /// C file, with its headers in the same folder.
    pub file: PathBuf,
    /// Cross compiler (GCC) with its options, as in your build.
    #[arg(long, value_name = "COMMAND", allow_hyphen_values = true)]
    pub cc: String,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `validate`.
#[derive(Args)]
pub struct Validate {
    #[command(flatten)]
    pub model: ModelFile,
    #[command(flatten)]
    pub parameters: ParameterValues,
    /// Additional functions, as in `generate`. The certificate covers only an emitted source with exactly these
    /// functions.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub with: Vec<Extra>,
    /// Also bound the rounding errors of mass matrix, velocity terms, forces and rates in both precisions, over the
    /// ranges of the specification and of --range, or at a state.
    #[arg(long)]
    pub bounds: bool,
    /// Range of a coordinate, a rate (NAME_dot), another state, all modes of a field, an input, a parameter or `t`
    /// for --bounds, or a single value. Write numbers as for --state and --set. Repeatable.
    #[arg(long, value_name = "NAME=LOW:HIGH", requires = "bounds")]
    pub range: Vec<String>,
    /// State for --bounds: variables without --range have the values of this state. Write it as for `linearise`;
    /// `--state t=0` selects the initial state.
    #[arg(long, value_name = "NAME=EXPR|trim", requires = "bounds", alias = "at")]
    pub state: Vec<String>,
    /// Output file for the certificate, `-` for stdout. Default: only a summary is printed.
    #[arg(long)]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub output: Json,
}

/// Options of `page`.
#[derive(Args)]
pub struct Page {
    #[command(flatten)]
    pub model: ModelFile,
    #[command(flatten)]
    pub parameters: ParameterValues,
    #[command(flatten)]
    pub initial: StateValues,
    /// Output file (HTML), `-` for stdout.
    #[arg(long)]
    pub out: PathBuf,
    #[command(flatten)]
    pub output: Json,
}
