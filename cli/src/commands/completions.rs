//! `eomgen completions`: shell completions of commands and options.

use clap::CommandFactory;

use crate::arguments::{Arguments, Completions};
use crate::error::{Result, print_bytes};

pub fn run(options: &Completions) -> Result {
    let mut script = Vec::new();
    let mut program = Arguments::command();
    clap_complete::generate(options.shell, &mut program, "eomgen", &mut script);
    print_bytes(&script)
}
