//! Commands and options of the program, with an example for every command.

mod maps;
mod models;
mod motions;
mod paper;
mod records;
mod setup;
mod shared;

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue};
use clap::{Parser, Subcommand};

pub use maps::{Engine, Merge, Sweep};
pub use models::{
    Check, Derive, Extra, Family, Format, Generate, Identify, Instructions, Packaging, Page,
    Target, Validate, Verify,
};
pub use motions::{Linearise, Modes, Simulate, Trim};
pub use paper::{Claims, ModeShapes, Paper, Study, StudyName, Tour};
pub use records::{Compare, Dataset, Discover};
pub use setup::{Completions, Man};
pub use shared::{ModelFile, ParameterValues, Solver};

/// Generates fast, checked equations of motion in Rust and C from the energies of a mechanical system.
#[derive(Parser)]
#[command(
    name = "eomgen",
    version,
    arg_required_else_help = true,
    after_help = "Example, in a clone of the repository:\n  eomgen simulate model-spec/models/pendulum.toml --until 10 --out swing.csv --plot swing.svg\n`eomgen COMMAND --help` prints the options of a command and examples.\nDocumentation: docs/ in the repository, beginning with docs/first_machine.md; docs/commands.md describes the commands."
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

impl Arguments {
    /// Parses the command line of the process. Earlier names of commands are accepted and not listed.
    ///
    /// # Errors
    /// Wrong arguments, and requests for help or the version.
    pub fn read() -> Result<Self, clap::Error> {
        let arguments = replace_earlier_name(std::env::args_os().collect());
        Self::try_parse_from(&arguments).map_err(|error| add_equivalent(error, &arguments))
    }
}

/// Words of other programs with the equivalent option of this program.
const FOREIGN: [(&[&str], &str); 3] = [
    (&["--latex", "--tex"], "write --format latex"),
    (
        &["matlab", "simulink", "modelica"],
        "Simulink and Modelica tools read functional mock-up units: write --target fmu3, or fmu2",
    ),
    (
        &["c", "c++", "cpp"],
        "write --target c99, which is also C++",
    ),
];

/// Replaces the suggestion in an error about a word of another program by the equivalent option.
fn add_equivalent(mut error: clap::Error, arguments: &[OsString]) -> clap::Error {
    let wrong = [ContextKind::InvalidArg, ContextKind::InvalidValue].map(|kind| error.get(kind));
    let is_wrong = |word: &str| {
        let is_given = |text: &String| text.eq_ignore_ascii_case(word);
        wrong
            .iter()
            .flatten()
            .any(|value| matches!(value, ContextValue::String(text) if is_given(text)))
            && arguments
                .iter()
                .any(|given| given.eq_ignore_ascii_case(word))
    };
    let mut foreign = FOREIGN.iter();
    let found = foreign.find(|(words, _)| words.iter().any(|word| is_wrong(word)));
    if let Some((_, help)) = found {
        error.remove(ContextKind::SuggestedArg);
        error.insert(
            ContextKind::Suggested,
            ContextValue::StyledStrs(vec![(*help).into()]),
        );
    }
    error
}

/// Earlier names of commands with their current names.
const RENAMED: [(&str, [&str; 2]); 2] = [
    ("study", ["paper", "study"]),
    ("study-search", ["paper", "claims"]),
];

/// Replaces an earlier name of a command, also after `help`.
fn replace_earlier_name(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let index = match arguments.get(1) {
        Some(first) if first == "help" => 2,
        _ => 1,
    };
    let name = arguments.get(index);
    let renamed = RENAMED
        .iter()
        .find(|(old, _)| name.is_some_and(|name| name == old));
    if let Some((_, new)) = renamed {
        arguments.splice(index..=index, new.iter().map(OsString::from));
    }
    arguments
}

/// Command with its options.
#[derive(Subcommand)]
pub enum Command {
    /// Check a specification: grammar, names, units, inertia at the initial state, unused parameters.
    #[command(after_help = "Example:\n  eomgen check model-spec/models/planetary_arm.toml")]
    Check(Check),
    /// Print the equations of motion and the meaning of each coefficient.
    #[command(
        after_help = "Example:\n  eomgen derive model-spec/models/planetary_arm.toml --order 4 --format latex"
    )]
    Derive(Derive),
    /// Emit the equations of motion as source code.
    #[command(
        after_help = "Examples:\n  eomgen generate model-spec/models/planetary_arm.toml --order 5 --out arm5\n  eomgen generate model-spec/models/emps.toml \\\n      --with jacobians,inverse_dynamics --certify --out emps\n  eomgen generate --all --check"
    )]
    Generate(Generate),
    /// Emit and certify all variants of a family file, and write a manifest.
    #[command(
        after_help = "Examples:\n  eomgen family generated/family.toml --out models\n  eomgen family generated/family.toml --out models --check\ndocs/families.md describes the family file."
    )]
    Family(Family),
    /// Compile an emitted source without changes and repeat the checks of its certificate.
    #[command(
        after_help = "Examples:\n  eomgen verify generated/src/variants/planetary_arm_rigid/mod.rs \\\n      generated/src/variants/planetary_arm_rigid/certificate.json\n  eomgen generate model-spec/models/pendulum.toml --target c99 --certify --out pendulum\n  eomgen verify pendulum/pendulum.c pendulum/certificate.json \\\n      --cc \"gcc -O2 -ffp-contract=off\""
    )]
    Verify(Verify),
    /// List the emitted variants in an object file, a library or a firmware image.
    #[command(
        after_help = "Example:\n  eomgen generate model-spec/models/pendulum.toml --target c99 --certify --out pendulum\n  cc -c pendulum/pendulum.c -o pendulum.o\n  eomgen identify pendulum.o --certificates pendulum"
    )]
    Identify(Identify),
    /// Bound the executed instructions and the stack of each function of a C file, compiled for a Cortex-M4F or Cortex-M7.
    #[command(
        after_help = "Example:\n  eomgen generate model-spec/models/planetary_arm.toml --order 4 --target c99 --out arm4\n  eomgen instructions arm4/planetary_arm.c \\\n      --cc \"arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 \\\n      -mfloat-abi=hard -std=c99 -O2 -Dplanetary_arm_REAL=float\"\nIf the number of iterations of a loop cannot be proven, the function has no bound. The command then prints the reason and exits with status 1."
    )]
    Instructions(Instructions),
    /// Compare the equations with independently derived equations and write a certificate.
    #[command(
        after_help = "Example:\n  eomgen validate model-spec/models/planetary_arm.toml --order 16 \\\n      --out certificate.json\n  eomgen validate model-spec/models/pendulum.toml --bounds \\\n      --range theta=-pi:pi --range theta_dot=-10:10"
    )]
    Validate(Validate),
    /// Simulate a model and write the trajectory.
    #[command(
        after_help = "Examples:\n  eomgen simulate model-spec/models/planetary_arm.toml --order 4 --until 2 \\\n      --interval 0.001 --set b_sp=50e-6 --out arm.csv\n  eomgen simulate model-spec/models/pendulum.toml --until 10 \\\n      --state theta=\"20 deg\" --out swing.csv --plot swing.svg"
    )]
    Simulate(Simulate),
    /// Linearise a model at a state and print the matrices A, B, C, D.
    #[command(
        after_help = "Examples:\n  eomgen linearise model-spec/models/furuta_pendulum.toml --state theta=pi \\\n      --out upright.json\n  eomgen linearise model-spec/models/furuta_pendulum.toml --state trim\n  eomgen linearise model-spec/models/furuta_pendulum.toml --state theta=pi \\\n      --discrete 0.001"
    )]
    Linearise(Linearise),
    /// Print natural frequencies, damping ratios and mode shapes at a state.
    #[command(
        after_help = "Example:\n  eomgen modes model-spec/models/hub_beam_tip_mass.toml --order 4"
    )]
    Modes(Modes),
    /// Find an equilibrium near a state, at rest or in steady motion.
    #[command(
        after_help = "Examples:\n  eomgen trim model-spec/models/pendulum.toml\n  eomgen trim model-spec/models/furuta_pendulum.toml --fix u=0 --fix phi=0.5\n  eomgen trim model-spec/models/pendulum.toml --state theta=\"20 deg\"\nThe search varies the coordinates and keeps inputs at 0. If coordinates are fixed, it also varies the inputs that are not fixed.\nA cyclic coordinate, whose value appears in no equation, may move at a constant speed: its initial speed, or a speed that the search finds."
    )]
    Trim(Trim),
    /// Propose a dataset file for a record: number format, columns and noise; guesses are marked.
    #[command(
        after_help = "Example:\n  eomgen dataset examples/measured/first.csv examples/measured/stage.toml \\\n      --out proposed.toml\nA comment after each key explains its guess; docs/discovery.md describes all keys."
    )]
    Dataset(Dataset),
    /// Report when and in which channels a model disagrees with its records.
    #[command(
        after_help = "Example:\n  eomgen compare examples/measured/stage.toml examples/measured/dataset.toml --out compared"
    )]
    Compare(Compare),
    /// Find the effects that a model lacks, add them, and report the remaining residual.
    #[command(
        after_help = "Example:\n  eomgen discover examples/measured/stage.toml examples/measured/dataset.toml \\\n      --out found --limit 60\nIf the records cannot separate two effects, the command writes found/experiment.csv, an input whose record would separate them. Apply the input to the machine, add the new record to the dataset file, and run the command again. docs/discovery.md describes the bounds of the input."
    )]
    Discover(Discover),
    /// Measure the motion over a grid or over random samples of parameters.
    #[command(
        after_help = "Examples:\n  eomgen sweep model-spec/models/planetary_arm.toml \\\n      --vary b_sp,b_pr=0:100e-6:50 --vary omega=10:60:50 \\\n      --measure lyapunov,poincare --out map\n  eomgen sweep model-spec/models/hub_beam_tip_mass.toml --vary M_t=0.01:1:50:log \\\n      --state theta_dot=1 --measure max:tip,rms:tip --until 2 --out tip\n  eomgen sweep model-spec/models/double_pendulum.toml --vary l_1=0.5:1:20 \\\n      --measure poincare:theta_2_dot --section theta_1=0:up \\\n      --transient 5 --periods 10 --until 60 --out section\n  eomgen sweep model-spec/models/planetary_arm.toml --vary omega=10:40:100 \\\n      --measure poincare --out shards --shard 2/3\n  eomgen sweep model-spec/models/planetary_arm.toml --vary omega=10:40:1000 \\\n      --measure poincare --out cluster --engine slurm --shards 100\nShards may run one after another or at the same time, into one folder, or into several folders whose `parts` are collected in one folder afterwards. Then run `eomgen merge DIR`."
    )]
    Sweep(Sweep),
    /// Combine the shards of a sweep; fails if shards are missing.
    #[command(
        after_help = "Example:\n  eomgen sweep model-spec/models/pendulum.toml --vary k=1e-4:1e-3:20 \\\n      --measure rms:theta --until 5 --out friction --shard 1/2\n  eomgen sweep model-spec/models/pendulum.toml --vary k=1e-4:1e-3:20 \\\n      --measure rms:theta --until 5 --out friction --shard 2/2\n  eomgen merge friction"
    )]
    Merge(Merge),
    /// Reproduce the paper: its numerical studies and its claims.
    #[command(
        subcommand,
        arg_required_else_help = true,
        after_help = "Examples:\n  eomgen paper study backlash --out studies/backlash\n  eomgen paper claims --sets 5000 --out search"
    )]
    Paper(Paper),
    /// Write an interactive simulation of a model as one self-contained HTML file.
    #[command(
        after_help = "Example:\n  eomgen page model-spec/models/double_pendulum.toml \\\n      --state theta_1=\"120 deg\" --out double_pendulum.html"
    )]
    Page(Page),
    /// Run all steps on the paper's arm, from check to discover, and write one HTML page about them.
    #[command(after_help = "Example:\n  eomgen tour --out tour")]
    Tour(Tour),
    /// Print the JSON schema of specifications, for completion and checks in an editor.
    #[command(
        after_help = "Example:\n  eomgen schema > eomgen.schema.json\nBegin each specification in the same folder with the line\n  #:schema ./eomgen.schema.json"
    )]
    Schema,
    /// Print shell completions of commands and options.
    #[command(
        after_help = "Examples:\n  eomgen completions bash > ~/.local/share/bash-completion/completions/eomgen\n  eomgen completions fish > ~/.config/fish/completions/eomgen.fish\n  eomgen completions zsh > ~/.zfunc/_eomgen"
    )]
    Completions(Completions),
    /// Write man pages of the program and of every command.
    #[command(after_help = "Example:\n  eomgen man --out ~/.local/share/man/man1")]
    Man(Man),
}

#[cfg(test)]
mod tests {
    use std::ffi::OsString;

    use super::replace_earlier_name;

    #[test]
    fn earlier_names_of_commands_become_current_ones() {
        for (given, expected) in [
            ("eomgen study order", "eomgen paper study order"),
            ("eomgen study-search --json", "eomgen paper claims --json"),
            ("eomgen help study", "eomgen help paper study"),
            ("eomgen paper study order", "eomgen paper study order"),
            ("eomgen check study", "eomgen check study"),
            ("eomgen", "eomgen"),
        ] {
            let words = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
            assert_eq!(
                replace_earlier_name(words(given)),
                words(expected),
                "{given}"
            );
        }
    }
}
