//! `eomgen family`: all variants of a family file.

use crate::arguments::Family;
use crate::error::Result;
use crate::family::{self, Options};

pub fn run(options: &Family) -> Result {
    family::run(&Options {
        file: &options.file,
        out: &options.out,
        check: options.check,
        force: options.force,
        json: options.output.json,
    })
}
