//! Options of a run.

use std::path::Path;

/// Options of a run.
pub struct Options<'o> {
    /// Family file.
    pub file: &'o Path,
    /// Output folder.
    pub out: &'o Path,
    /// Compare instead of writing.
    pub check: bool,
    /// Also generate variants without a change.
    pub force: bool,
    /// Print a JSON document.
    pub json: bool,
}
