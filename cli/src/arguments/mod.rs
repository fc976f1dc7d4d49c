//! What can be typed, with an example for every command.

mod maps;
mod models;
mod motions;
mod paper;
mod records;
mod setup;

use clap::{Parser, Subcommand};

pub use maps::{Engine, Merge, Sweep};
pub use models::{Check, Derive, Extra, Format, Generate, Page, Target, Validate};
pub use motions::{Linearise, Modes, Simulate, Solver, Trim};
pub use paper::{ModeShapes, Study, StudyName, StudySearch, Tour};
pub use records::{Compare, Dataset, Discover};
pub use setup::{Completions, Man};

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
