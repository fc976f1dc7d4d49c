//! Program `studies`: runs one study with many random machines or records and prints a line for each failure and a
//! summary. The exit status is 1 if a run fails.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use eomgen_studies::sample::Sample;
use eomgen_studies::{
    alarms, bounds, contacts, coverage, gradients, grazing, hosts, mutations, solvers,
};

/// Studies of the program with many random machines and records.
#[derive(Parser)]
#[command(after_help = "Example:\n  studies grazing --count 200 --seed 1")]
struct Options {
    #[command(subcommand)]
    study: Study,
}

#[derive(Subcommand)]
enum Study {
    /// Gaps that `compare` reports for correct models and for models that lack a friction
    Alarms {
        #[command(flatten)]
        sample: Sample,
        /// Size of the friction, relative to a friction with a residual of about three noise floors
        #[arg(long, default_value_t = 1.0)]
        friction: f64,
    },
    /// Comparison of rounding errors of the shipped machines at random points with their bounds
    Bounds(Sample),
    /// Energy and agreement of the solvers for passive machines that graze a stop
    Grazing(Sample),
    /// Stacks of balls and boxes that fall on a floor
    Contacts(Sample),
    /// Faults in emitted code, which the checks of `eomgen verify` must detect
    Mutations(Sample),
    /// Coverage of the 90 % intervals of fitted parameters
    Coverage {
        #[command(flatten)]
        sample: Sample,
        /// Only machines whose name contains this text
        #[arg(long, default_value = "")]
        machine: String,
    },
    /// Comparison of gradients of motions with differences
    Gradients(Sample),
    /// Agreement of all hosts on every shipped machine and on random ones
    Hosts(Sample),
    /// Agreement of the solvers on random machines
    Solvers(Sample),
}

fn main() -> ExitCode {
    eomgen_discover::prepare_threads();
    let report = match Options::parse().study {
        Study::Alarms { sample, friction } => alarms::run(&sample, friction),
        Study::Bounds(sample) => bounds::run(&sample),
        Study::Grazing(sample) => grazing::run(&sample),
        Study::Contacts(sample) => contacts::run(&sample),
        Study::Mutations(sample) => mutations::run(&sample),
        Study::Coverage { sample, machine } => coverage::run(&sample, &machine),
        Study::Gradients(sample) => gradients::run(&sample),
        Study::Hosts(sample) => hosts::run(&sample),
        Study::Solvers(sample) => solvers::run(&sample),
    };
    match report {
        Ok(summary) => {
            println!("{summary}");
            ExitCode::SUCCESS
        }
        Err(failures) => {
            eprintln!("{failures}");
            ExitCode::FAILURE
        }
    }
}
