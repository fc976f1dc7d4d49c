//! `eomgen man`: man pages of the program and of every command.

use clap::CommandFactory;
use clap_mangen::Man as Page;

use crate::arguments::{Arguments, Man};
use crate::error::{Error, Result, print_text};
use crate::output::write_file;

pub fn run(options: &Man) -> Result {
    let mut program = Arguments::command().disable_help_subcommand(true);
    // Sets the full name of every command, such as `eomgen-check`.
    program.build();
    let commands: Vec<_> = program.get_subcommands().cloned().collect();
    let mut written = 0;
    for command in std::iter::once(program).chain(commands) {
        let page = Page::new(command.disable_help_subcommand(true));
        let path = options.out.join(page.get_filename());
        let mut text = Vec::new();
        page.render(&mut text)
            .map_err(|error| Error::file("write", &path, &error))?;
        write_file(&path, &text)?;
        written += 1;
    }
    print_text(&format!("{}: {written} pages\n", options.out.display()))
}
