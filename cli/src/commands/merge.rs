//! `eomgen merge`: the final table and figures of a sweep.

use eomgen_sweep::Folder;

use crate::arguments::Merge;
use crate::error::{Error, Result, print_json, print_text};
use crate::sweep_files::finish;

pub fn run(options: &Merge) -> Result {
    let folder =
        Folder::open_existing(&options.dir).map_err(|error| Error::input(error.to_string()))?;
    let finished = finish(&folder)?;
    if options.output.json {
        print_json(&finished.json())?;
    } else {
        print_text(&finished.text())?;
    }
    finished.check()
}
