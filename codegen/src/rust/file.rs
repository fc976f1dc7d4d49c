//! The items of an emitted file and their order: constants, parameters, coefficients,
//! inputs, then one function per stage.

use std::collections::{BTreeSet, HashMap};

use super::emit_error::{EmitError, Emitted};
use super::expression::array;
use super::functions::{Needed, items};
use super::layout;
use super::literals::{block, doc, file_doc, identifier, number};
use super::names::Names;
use super::roots::{coefficient_values, stage_roots};
use super::scalar::{COEFFICIENT, SCALAR};
use crate::program::{Extent, Op, Program, ValueId};

/// What the emitted file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packaging {
    /// The root of a crate of its own.
    Crate,
    /// A module of a crate that is `no_std` already.
    Module,
    /// What a module is filled with, by `include!` or by a macro, where the attributes of
    /// a file may not stand: the items come out of an inner module, [`ITEMS_MODULE`], that
    /// keeps its helpers to itself.
    Items,
}

/// The inner module of [`Packaging::Items`].
pub const ITEMS_MODULE: &str = "eomgen_emitted";

/// The source of a program as Rust.
///
/// # Errors
/// If a name of the program is no Rust identifier.
pub fn emit(program: &Program, packaging: Packaging) -> Result<String, EmitError> {
    let file = File::new(program)?;
    Ok(layout::source(&file.marked(packaging)?))
}

/// What a file is written from.
pub(super) struct File<'p> {
    pub(super) program: &'p Program,
    /// Prepared values that the stages read, in the order of the program, by name.
    pub(super) fields: Vec<ValueId>,
    pub(super) field_names: HashMap<ValueId, String>,
}

impl<'p> File<'p> {
    fn new(program: &'p Program) -> Emitted<Self> {
        let mut names = Names::new(program);
        let fields = coefficient_values(program);
        let mut field_names = HashMap::new();
        for id in &fields {
            field_names.insert(*id, names.of(program, *id, "c")?);
        }
        Ok(Self {
            program,
            fields,
            field_names,
        })
    }

    /// The file as marked text.
    fn marked(&self, packaging: Packaging) -> Emitted<String> {
        let mut needed = Needed::default();
        let items = [
            self.constants(),
            self.jacobian_constants(),
            self.parameters()?,
            self.inputs()?,
            self.coefficients(&mut needed)?,
            self.rates(&mut needed)?,
            self.observables(&mut needed)?,
            self.guards(&mut needed)?,
            self.mass_matrix(&mut needed)?,
            self.regimes(&mut needed)?,
            self.requested(&mut needed)?,
            self.tables()?,
            SCALAR.to_owned(),
            if self.for_lanes() { COEFFICIENT } else { "" }.to_owned(),
            items(&needed),
        ]
        .concat();
        let documentation = self.documentation();
        let allowed =
            "#![allow(non_snake_case)]\n#![allow(clippy::all)]\n#![forbid(unsafe_code)]\n";
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

    /// What the file is and where it comes from, by lines.
    fn documentation(&self) -> Vec<String> {
        let program = self.program;
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
                program.name,
                program.spec_hash
            ),
            "Do not edit: change the specification and generate again.".to_owned(),
            String::new(),
            format!("State: {}.", program.state_names().join(", ")),
            "All quantities are in SI units. Nothing here allocates, panics or needs the standard library."
                .to_owned(),
        ]
    }

    fn constants(&self) -> String {
        let program = self.program;
        let quoted = |names: Vec<&str>| {
            let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
            array(&quoted)
        };
        let orders: Vec<String> = program.fields.iter().map(|f| f.order.to_string()).collect();
        let states = program.state_names();
        let state_names = quoted(states.iter().map(String::as_str).collect());
        let observables = program.observables.iter().map(|o| o.name.as_str());
        format!(
            "/// Modal truncation order of each field.\n\
             pub const ORDERS: [usize; {}] = {};\n\
             /// Degrees of freedom: coordinates and modes.\n\
             pub const DEGREES_OF_FREEDOM: usize = {};\n\
             /// Numbers in the state: coordinates, modes, and the rates of both.\n\
             pub const STATES: usize = {};\n\
             /// Names of the state, in its order.\n\
             pub const STATE_NAMES: [&'static str; STATES] = {state_names};\n\
             /// Numbers that [`observables`] returns.\n\
             pub const OBSERVABLES: usize = {};\n\
             /// Names of the observables, in their order.\n\
             pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = {};\n\
             /// Switching surfaces.\n\
             pub const GUARDS: usize = {};\n\
             /// SHA-256 of the specification.\n\
             pub const SPECIFICATION_SHA256: &'static str = \"{}\";\n\
             /// Version of the generator.\n\
             pub const GENERATOR_VERSION: &'static str = \"{}\";\n",
            orders.len(),
            array(&orders),
            program.degrees_of_freedom(),
            program.states(),
            program.observables.len(),
            quoted(observables.collect()),
            self.guard_count(),
            program.spec_hash,
            env!("CARGO_PKG_VERSION"),
        )
    }

    pub(super) fn guard_count(&self) -> usize {
        self.program
            .guards
            .iter()
            .map(|guard| self.program.value(guard.value).extent.length())
            .sum()
    }

    /// The tables that some stage reads.
    fn tables(&self) -> Emitted<String> {
        let program = self.program;
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
            let name = identifier(&table.name)?;
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
}

/// Meaning, unit and origin of a quantity.
pub(super) fn quantity_line(text: &str, unit: &str, origin: &str) -> String {
    let mut line = if text.is_empty() {
        String::new()
    } else {
        format!("{text} ")
    };
    line.push_str(&format!("[{unit}]"));
    if !origin.is_empty() {
        line.push_str(&format!(" ({origin})"));
    }
    line
}
