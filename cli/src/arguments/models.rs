//! Options of commands that read a specification and write its equations or a page.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use eomgen_codegen::mechanics::outputs::{Output, UnknownOutput};

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
