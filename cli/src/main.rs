//! The program `eomgen`: arguments, messages and files. The libraries contain the physics and the numerics.
//!
//! `arguments` defines the command line, `commands` has one file per command, `model` loads and derives a
//! specification, `motion` simulates it, `output` writes files, `error` defines errors and exit statuses.

mod arguments;
mod audit;
mod bench_files;
mod bounds;
mod certification;
mod commands;
mod count;
mod discovery;
mod document;
mod emission;
mod emitted_files;
mod engines;
mod error;
mod event_log;
mod family;
mod field_shapes;
mod figures;
mod history;
mod input_file;
mod instruction_table;
mod linearisation;
mod mode_figure;
mod model;
mod motion;
mod npz;
mod operating_point;
mod output;
mod page;
mod parquet_file;
mod progress;
mod ranges;
mod regime;
mod sample_statistics;
mod samples;
mod settings;
mod significant;
mod sweep_files;
mod table;
mod test_vectors;
mod tour;
mod trace_file;

use std::process::ExitCode;

use arguments::{Arguments, Command, Paper};
use error::{Error, Result, print_json};

fn main() -> ExitCode {
    // If parsing of the command line fails, there are no parsed options, so the arguments are searched for `--json`.
    let is_json = std::env::args_os().any(|argument| argument == "--json");
    let arguments = match Arguments::read() {
        Ok(arguments) => arguments,
        Err(error) => {
            if is_json && error.use_stderr() {
                print_error(&Error::input(error.render().to_string().trim_end()));
            }
            error.exit()
        }
    };
    input_file::register_arguments();
    let is_check = matches!(arguments.command, Command::Check(_));
    let result: Result = match arguments.command {
        Command::Check(options) => commands::check::run(&options),
        Command::Derive(options) => commands::derive::run(&options),
        Command::Generate(options) => commands::generate::run(&options),
        Command::Family(options) => commands::family::run(&options),
        Command::Verify(options) => commands::verify::run(&options),
        Command::Identify(options) => commands::identify::run(&options),
        Command::Instructions(options) => commands::instructions::run(&options),
        Command::Validate(options) => commands::validate::run(&options),
        Command::Simulate(options) => commands::simulate::run(&options),
        Command::Linearise(options) => commands::linearise::run(&options),
        Command::Modes(options) => commands::modes::run(&options),
        Command::Trim(options) => commands::trim::run(&options),
        Command::Dataset(options) => commands::dataset::run(&options),
        Command::Compare(options) => commands::discover::compare(&options),
        Command::Discover(options) => commands::discover::discover(&options),
        Command::Sweep(options) => commands::sweep::run(&options),
        Command::Merge(options) => commands::merge::run(&options),
        Command::Paper(Paper::Study(options)) => commands::study::run(&options),
        Command::Paper(Paper::Claims(options)) => commands::claims::run(&options),
        Command::Page(options) => commands::page::run(&options),
        Command::Tour(options) => commands::tour::run(&options),
        Command::Schema => commands::schema::run(),
        Command::Completions(options) => commands::completions::run(&options),
        Command::Man(options) => commands::man::run(&options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // `check` prints its own document.
            if is_json && !is_check {
                print_error(&error);
            }
            error.report()
        }
    }
}

/// Prints an error as a JSON document on stdout. Write errors are ignored because the message is on stderr too.
fn print_error(error: &Error) {
    if let Some(document) = error.to_json() {
        let _ = print_json(&document);
    }
}
