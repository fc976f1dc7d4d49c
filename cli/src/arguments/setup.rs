//! Options of commands that set up a shell.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

/// Options of `completions`.
#[derive(Args)]
pub struct Completions {
    /// Shell for which completions are printed.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Options of `man`.
#[derive(Args)]
pub struct Man {
    /// Output folder.
    #[arg(long)]
    pub out: PathBuf,
}
