//! Emits the planetary arm at the compared orders.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;

/// Emitted orders; equal to the orders in the macro of `benches/rates.rs`.
const ORDERS: [usize; 9] = [0, 1, 2, 4, 8, 16, 32, 64, 128];

/// Orders with additional functions; equal to the orders in the macros of `benches/jacobian.rs` and `lanes.rs`.
const FULL_ORDERS: [usize; 3] = [4, 16, 64];

/// Additional functions.
const OUTPUTS: &[Output] = &[Output::Jacobians, Output::Products, Output::Lanes];

fn main() -> Result<(), Box<dyn Error>> {
    let specification =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
    println!("cargo::rerun-if-changed={}", specification.display());
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let model = eomgen_model_spec::load(&specification)
        .map_err(|problems| problems.render(false))?
        .model;
    let mut modules = String::new();
    let plain = ORDERS.map(|order| (format!("order_{order}"), order, [].as_slice()));
    let full = FULL_ORDERS.map(|order| (format!("full_order_{order}"), order, OUTPUTS));
    for (name, order, outputs) in plain.into_iter().chain(full) {
        let variant = Variant::derive_with(&model, &[order], outputs)
            .map_err(|problems| problems.render(false))?;
        let path = out.join(format!("{name}.rs"));
        std::fs::write(&path, emit(&variant.program, Packaging::Module)?)?;
        let path = path.display().to_string();
        writeln!(modules, "#[path = {path:?}]\npub mod {name};")?;
    }
    std::fs::write(out.join("variants.rs"), modules)?;
    Ok(())
}
