//! `eomgen instructions`: bounds of the instructions and the stack of compiled C.

use eomgen_validate::instructions::InstructionBounds;
use serde_json::json;

use crate::arguments::Instructions;
use crate::count::count;
use crate::document::SCHEMA;
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::instruction_table::table;

pub fn run(options: &Instructions) -> Result {
    let bounds = InstructionBounds::of_file(&options.file, &options.cc).map_err(Error::Input)?;
    if options.output.json {
        let mut document = json!(bounds);
        document["schema"] = json!(SCHEMA);
        print_json(&document)?;
    } else {
        print_text(&table(&bounds))?;
    }
    let functions = bounds.functions.iter();
    let without = functions.filter(|function| function.instructions.is_none());
    match without.count() {
        0 => Ok(()),
        number => {
            let functions = count(number, "function");
            warn(&format!("error: no bound was found for {functions}"));
            Err(Error::Failed)
        }
    }
}
