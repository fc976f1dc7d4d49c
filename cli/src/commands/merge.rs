//! `eomgen merge`: the parts of a sweep to the final table and figures.

use eomgen_sweep::Folder;

use crate::arguments::Merge;
use crate::problem::{Outcome, Problem, say};
use crate::sweep_files::finish;

/// Runs the command.
pub fn run(options: &Merge) -> Outcome {
    let folder =
        Folder::existing(&options.dir).map_err(|error| Problem::input(error.to_string()))?;
    let finished = finish(&folder)?;
    if options.json {
        return say(&format!("{:#}\n", finished.json()));
    }
    say(&finished.text())
}
