//! Options of commands that set up a shell.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

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
