//! Items of an emitted Rust file in their order: constants, parameters, coefficients, inputs, then the
//! functions.

use std::collections::BTreeSet;

use super::constants;
use super::controllers;
use super::expression::{Writer, array};
use super::functions::items;
use super::generics::for_lanes;
use super::jacobians;
use super::literals::{doc, file_doc, number};
use super::regimes;
use super::scalar::{COEFFICIENT, SCALAR};
use super::stages;
use super::step;
use super::types;
use super::words::WORDS;
use crate::identity;
use crate::program::{Extent, Op, Program};
use crate::statements::layout;
use crate::statements::layout::block;
use crate::statements::{
    EmitError, EmitResult, File, RequiredFunctions, Stage, guards, mass_matrix, observables, rates,
    requested_stages, stage_roots,
};

/// Form of the emitted file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packaging {
    /// Root of a crate.
    Crate,
    /// Module of a `no_std` crate.
    Module,
    /// Content of a module for `include!` or a macro, without attributes of a file. The items are re-exported
    /// from an inner module, [`ITEMS_MODULE`], which hides its helpers.
    Items,
}

/// Name of the inner module of [`Packaging::Items`].
pub const ITEMS_MODULE: &str = "eomgen_emitted";

/// Writes a program as Rust.
///
/// # Errors
/// A name of the program that is not a Rust identifier, and a program with Hessians, which are available only
/// in C.
pub fn emit(program: &Program, packaging: Packaging) -> Result<String, EmitError> {
    if program.outputs.gradient_derivative.is_some() {
        return Err(EmitError::Value(
            "Hessians are available only in C".to_owned(),
        ));
    }
    let file = File::new(program, &WORDS)?;
    Ok(identity::seal(&layout::source(&write_marked_source(
        &file, packaging,
    )?)))
}

fn write_marked_source(file: &File<'_>, packaging: Packaging) -> EmitResult<String> {
    let mut needed = RequiredFunctions::default();
    let mut writer = Writer {
        lanes: for_lanes(file),
        ..Writer::default()
    };
    let head = [
        constants::constants(file),
        types::parameters(file)?,
        types::inputs(file)?,
        types::coefficients(file, &mut needed, &mut writer)?,
    ];
    let mut text = head.concat();
    let function = |stage: Stage, writer: &mut Writer| stages::function(file, &stage, writer);
    text += &stages::rates(file, &rates(file, &mut needed)?, &mut writer);
    for stage in observables(file, &mut needed)? {
        text += &function(stage, &mut writer);
    }
    text += &function(guards(file, &mut needed)?, &mut writer);
    text += &function(mass_matrix(file, &mut needed)?, &mut writer);
    text += &regimes::regimes(file, &mut needed, &mut writer)?;
    for stage in requested_stages(file, &mut needed)? {
        text += &function(stage, &mut writer);
    }
    text += &jacobians::jacobians(file, &mut needed, &mut writer)?;
    text += &step::step(file);
    text += &controllers::controllers(file, &mut needed, &mut writer)?;
    text += &tables(file)?;
    text += SCALAR;
    if for_lanes(file) {
        text += COEFFICIENT;
    }
    let items = text + &items(&needed, writer.conversions);
    let documentation = documentation(file);
    let allowed = "#![allow(non_snake_case)]\n#![allow(clippy::all)]\n#![forbid(unsafe_code)]\n";
    Ok(match packaging {
        Packaging::Crate => file_doc(&documentation) + "#![no_std]\n" + allowed + &items,
        Packaging::Module => file_doc(&documentation) + allowed + &items,
        Packaging::Items => {
            doc(&documentation)
                + "#[allow(non_snake_case, dead_code, clippy::all, clippy::pedantic, clippy::nursery)]\n"
                + "#[forbid(unsafe_code)]\n"
                + &block(&format!("mod {ITEMS_MODULE} {{"), &items, "}")
                + "#[allow(unused_imports)]\n"
                + &format!("pub use {ITEMS_MODULE}::*;\n")
        }
    })
}

/// Returns title and origin of the file, by lines.
fn documentation(file: &File<'_>) -> Vec<String> {
    let program = file.program;
    let orders: Vec<String> = program.fields.iter().map(|f| f.order.to_string()).collect();
    let order = if orders.is_empty() {
        "rigid".to_owned()
    } else {
        format!("modal truncation order {}", orders.join(", "))
    };
    vec![
        format!("{}: equations of motion, {order}.", program.title.trim_end_matches('.')),
        String::new(),
        format!(
            "Emitted by eomgen {} from the specification `{}` (SHA-256 {}).",
            env!("CARGO_PKG_VERSION"),
            program.specification,
            program.spec_hash
        ),
        "Do not edit: change the specification and generate again.".to_owned(),
        String::new(),
        format!("State: {}.", program.state_names().join(", ")),
        "All quantities are in SI units. The code does not allocate, panic or use the standard library."
            .to_owned(),
    ]
}

fn tables(file: &File<'_>) -> EmitResult<String> {
    let program = file.program;
    let mut roots = stage_roots(program);
    roots.extend(&program.pivots);
    let reached = program.reachable(&roots);
    let mut items = String::new();
    let used: BTreeSet<usize> = reached
        .iter()
        .filter_map(|id| match program.value(*id).op {
            Op::Table(place) => Some(place),
            _ => None,
        })
        .collect();
    for place in used {
        let table = &program.tables[place];
        let name = file.words.identifier(&table.name)?;
        let values: Vec<String> = table.values.iter().map(|v| number(*v)).collect();
        let (extent, content) = match table.extent {
            Extent::Matrix(rows, columns) => {
                let lines: Vec<String> = values.chunks(columns.max(1)).map(array).collect();
                (format!("[[f64; {columns}]; {rows}]"), array(&lines))
            }
            other => (format!("[f64; {}]", other.length()), array(&values)),
        };
        items.push_str(&doc(std::slice::from_ref(&table.doc)));
        items.push_str(&format!("static {name}: {extent} = {content};\n"));
    }
    Ok(items)
}
