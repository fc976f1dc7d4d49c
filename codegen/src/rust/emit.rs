//! Items of an emitted Rust file in their order: constants, parameters, coefficients, inputs, then the
//! functions.

use std::collections::BTreeSet;

use super::constants;
use super::controllers;
use super::expression::{Writer, array};
use super::functions::write_functions;
use super::generics::for_lanes;
use super::jacobians;
use super::literals::{number, write_doc, write_file_doc};
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
    EmitError, EmitResult, File, RequiredFunctions, Stage, build_guards, build_mass_matrix,
    build_observables, build_rates, build_requested_stages, collect_stage_roots,
};

/// Form of the emitted file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packaging {
    /// Root of a crate.
    Crate,
    /// Module of a `no_std` crate.
    Module,
    /// Content of a module for `include!` or a macro, without file-level attributes. The items are re-exported from
    /// an inner module, [`ITEMS_MODULE`], which hides its helpers.
    Items,
}

/// Name of the inner module of [`Packaging::Items`].
pub const ITEMS_MODULE: &str = "eomgen_emitted";

/// Writes a program as Rust.
///
/// # Errors
/// A name of the program is not a Rust identifier, or the program has Hessians, which are available only in C.
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
        constants::write_constants(file),
        types::write_parameters(file)?,
        types::write_inputs(file)?,
        types::write_coefficients(file, &mut needed, &mut writer)?,
    ];
    let mut text = head.concat();
    let function = |stage: Stage, writer: &mut Writer| stages::write_stage(file, &stage, writer);
    text += &stages::write_rates(file, &build_rates(file, &mut needed)?, &mut writer);
    for stage in build_observables(file, &mut needed)? {
        text += &function(stage, &mut writer);
    }
    text += &function(build_guards(file, &mut needed)?, &mut writer);
    text += &function(build_mass_matrix(file, &mut needed)?, &mut writer);
    text += &regimes::write_regimes(file, &mut needed, &mut writer)?;
    for stage in build_requested_stages(file, &mut needed)? {
        text += &function(stage, &mut writer);
    }
    text += &jacobians::write_jacobians(file, &mut needed, &mut writer)?;
    text += &step::write_step(file);
    text += &controllers::write_controllers(file, &mut needed, &mut writer)?;
    text += &write_tables(file)?;
    text += SCALAR;
    if for_lanes(file) {
        text += COEFFICIENT;
    }
    let items = text + &write_functions(&needed, writer.conversions);
    let documentation = describe_file(file);
    let allowed = "#![allow(non_snake_case)]\n#![allow(clippy::all)]\n#![forbid(unsafe_code)]\n";
    Ok(match packaging {
        Packaging::Crate => write_file_doc(&documentation) + "#![no_std]\n" + allowed + &items,
        Packaging::Module => write_file_doc(&documentation) + allowed + &items,
        Packaging::Items => {
            write_doc(&documentation)
                + "#[allow(non_snake_case, dead_code, clippy::all, clippy::pedantic, clippy::nursery)]\n"
                + "#[forbid(unsafe_code)]\n"
                + &block(&format!("mod {ITEMS_MODULE} {{"), &items, "}")
                + "#[allow(unused_imports)]\n"
                + &format!("pub use {ITEMS_MODULE}::*;\n")
        }
    })
}

/// Returns title and origin of the file, one string per line.
fn describe_file(file: &File<'_>) -> Vec<String> {
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

fn write_tables(file: &File<'_>) -> EmitResult<String> {
    let program = file.program;
    let mut roots = collect_stage_roots(program);
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
        items.push_str(&write_doc(std::slice::from_ref(&table.doc)));
        items.push_str(&format!("static {name}: {extent} = {content};\n"));
    }
    Ok(items)
}
