//! Emits the planetary arm at the orders that are compared, most of which are not checked in.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use codegen::equations::derive;
use codegen::lower::lower;
use codegen::rust::{Packaging, emit};

/// The orders; the macro in `benches/rates.rs` goes through the same.
const ORDERS: [usize; 9] = [0, 1, 2, 4, 8, 16, 32, 64, 128];

fn main() -> Result<(), Box<dyn Error>> {
    let specification =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
    println!("cargo::rerun-if-changed={}", specification.display());
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let model = model_spec::load(&specification)
        .map_err(|problems| problems.render(false))?
        .model;
    let values = model
        .parameter_values()
        .map_err(|error| error.to_string())?;
    let mut modules = String::new();
    for order in ORDERS {
        let equations = derive(&model, &[order]).map_err(|error| error.message)?;
        let source = emit(&lower(&model, &equations, &values), Packaging::Module)?;
        let path = out.join(format!("order_{order}.rs"));
        std::fs::write(&path, source)?;
        let path = path.display();
        writeln!(
            modules,
            "#[path = {:?}]\npub mod order_{order};",
            path.to_string()
        )?;
    }
    std::fs::write(out.join("variants.rs"), modules)?;
    Ok(())
}
