//! Options of `eomgen family`.

use std::path::Path;

/// Options of `eomgen family`.
pub struct Options<'o> {
    /// Family file.
    pub file: &'o Path,
    /// Output folder.
    pub out: &'o Path,
    /// Compare instead of writing.
    pub check: bool,
    /// Also generate unchanged variants.
    pub force: bool,
    /// Print a JSON document.
    pub json: bool,
}
