//! The items of an emitted file and their order: constants, parameters, coefficients,
//! inputs, then one function per stage.

use std::collections::{BTreeSet, HashMap};

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::EmitError;

use super::functions::{Needed, items};
use super::literals::{count, doc, file_doc, identifier, number};
use super::names::Names;
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

pub(super) type Emitted<T> = Result<T, EmitError>;

/// The source of a program as Rust.
///
/// # Errors
/// If a name of the program is no Rust identifier.
pub fn emit(program: &Program, packaging: Packaging) -> Result<String, EmitError> {
    let tokens = tokens(program, packaging)?;
    let parsed: syn::File =
        syn::parse2(tokens).map_err(|error| EmitError::Syntax(error.to_string()))?;
    Ok(spaced(&prettyplease::unparse(&parsed)))
}

/// The same as [`emit`] as tokens, for a macro.
///
/// # Errors
/// As [`emit`].
pub fn tokens(program: &Program, packaging: Packaging) -> Emitted<TokenStream> {
    let file = File::new(program)?;
    let items = file.items()?;
    let lines = file.documentation();
    if packaging == Packaging::Items {
        let docs = doc(&lines);
        let module = identifier(ITEMS_MODULE)?;
        return Ok(quote! {
            #docs
            #[allow(non_snake_case, dead_code, clippy::all, clippy::pedantic, clippy::nursery)]
            #[forbid(unsafe_code)]
            mod #module { #items }
            #[allow(unused_imports)]
            pub use #module::*;
        });
    }
    let docs = file_doc(&lines);
    let no_std = (packaging == Packaging::Crate).then(|| quote!(#![no_std]));
    Ok(quote! {
        #docs
        #no_std
        #![allow(non_snake_case)]
        #![allow(clippy::all)]
        #![forbid(unsafe_code)]
        #items
    })
}

/// With an empty line before every documented item, as a person would set it.
fn spaced(source: &str) -> String {
    let mut text = String::with_capacity(source.len() + 512);
    let mut previous = "";
    for line in source.lines() {
        let starts_item = line.starts_with("///") && !previous.starts_with("///");
        let after_header = previous.starts_with("#![") && !line.starts_with("#![");
        if (starts_item || after_header) && !previous.is_empty() {
            text.push('\n');
        }
        text.push_str(line);
        text.push('\n');
        previous = line;
    }
    text
}

/// What a file is written from.
pub(super) struct File<'p> {
    pub(super) program: &'p Program,
    /// Prepared values that the stages read, in the order of the program, by name.
    pub(super) fields: Vec<ValueId>,
    pub(super) field_names: HashMap<ValueId, Ident>,
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

    fn items(&self) -> Emitted<TokenStream> {
        let mut needed = Needed::default();
        let constants = self.constants();
        let tables = self.tables()?;
        let parameters = self.parameters()?;
        let inputs = self.inputs()?;
        let coefficients = self.coefficients(&mut needed)?;
        let rates = self.rates(&mut needed)?;
        let observables = self.observables(&mut needed)?;
        let guards = self.guards(&mut needed)?;
        let mass = self.mass_matrix(&mut needed)?;
        let functions = items(&needed);
        Ok(quote! {
            #constants
            #parameters
            #inputs
            #coefficients
            #rates
            #observables
            #guards
            #mass
            #tables
            #functions
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

    fn constants(&self) -> TokenStream {
        let program = self.program;
        let degrees = count(program.degrees_of_freedom());
        let states = count(program.states());
        let state_names = program.state_names();
        let observables = count(program.observables.len());
        let observable_names = program.observables.iter().map(|o| &o.name);
        let guards = count(self.guard_count());
        let hash = &program.spec_hash;
        let version = env!("CARGO_PKG_VERSION");
        let order_lines = ["Modal truncation order of each field.".to_owned()];
        let order_doc = doc(&order_lines);
        let orders = program.fields.iter().map(|f| count(f.order));
        let fields = count(program.fields.len());
        quote! {
            #order_doc
            pub const ORDERS: [usize; #fields] = [#(#orders),*];
            #[doc = " Degrees of freedom: coordinates and modes."]
            pub const DEGREES_OF_FREEDOM: usize = #degrees;
            #[doc = " Numbers in the state: coordinates, modes, and the rates of both."]
            pub const STATES: usize = #states;
            #[doc = " Names of the state, in its order."]
            pub const STATE_NAMES: [&'static str; STATES] = [#(#state_names),*];
            #[doc = " Numbers that [`observables`] returns."]
            pub const OBSERVABLES: usize = #observables;
            #[doc = " Names of the observables, in their order."]
            pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = [#(#observable_names),*];
            #[doc = " Switching surfaces."]
            pub const GUARDS: usize = #guards;
            #[doc = " SHA-256 of the specification."]
            pub const SPECIFICATION_SHA256: &'static str = #hash;
            #[doc = " Version of the generator."]
            pub const GENERATOR_VERSION: &'static str = #version;
        }
    }

    pub(super) fn guard_count(&self) -> usize {
        self.program
            .guards
            .iter()
            .map(|guard| self.program.value(guard.value).extent.length())
            .sum()
    }

    /// The tables that some stage reads.
    fn tables(&self) -> Emitted<TokenStream> {
        let program = self.program;
        let mut roots = stage_roots(program);
        roots.extend(&program.pivots);
        let reached = program.reachable(&roots);
        let mut items = Vec::new();
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
            let lines = [table.doc.clone()];
            let docs = doc(&lines);
            let values: Vec<TokenStream> = table.values.iter().map(|v| number(*v)).collect();
            items.push(match table.extent {
                Extent::Matrix(rows, columns) => {
                    let lines = values.chunks(columns.max(1)).map(|row| quote!([#(#row),*]));
                    let (rows, columns) = (count(rows), count(columns));
                    quote!(#docs static #name: [[f64; #columns]; #rows] = [#(#lines),*];)
                }
                other => {
                    let length = count(other.length());
                    quote!(#docs static #name: [f64; #length] = [#(#values),*];)
                }
            });
        }
        Ok(quote!(#(#items)*))
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

/// The values that the mass matrix is written from.
pub(super) fn mass_roots(program: &Program) -> Vec<ValueId> {
    let mass = &program.mass;
    let mut roots: Vec<ValueId> = mass.scalars.iter().flatten().copied().collect();
    roots.extend(mass.coupling.iter().flatten());
    // Modal blocks are written from their parts: as a whole they would be prepared.
    for block in mass.modal.iter().flatten().flatten() {
        roots.extend(program.value(*block).op.operands());
    }
    roots
}

/// What the stages that are called with coefficients return.
fn stage_roots(program: &Program) -> Vec<ValueId> {
    let mut roots = program.accelerations.all();
    roots.extend(&program.observable_values);
    roots.extend(program.guards.iter().map(|g| g.value));
    roots.extend(mass_roots(program));
    roots
}

/// The prepared values that stages read directly, constants and tables aside.
fn coefficient_values(program: &Program) -> Vec<ValueId> {
    let roots = stage_roots(program);
    let mut read: BTreeSet<ValueId> = program
        .reachable(&roots)
        .into_iter()
        .filter(|id| !program.value(*id).prepared)
        .flat_map(|id| program.value(id).op.operands())
        .collect();
    read.extend(roots);
    read.retain(|id| {
        let value = program.value(*id);
        value.prepared && !matches!(value.op, Op::Constant(_) | Op::Table(_))
    });
    read.into_iter()
        .filter(|id| program.value(*id).extent.length() > 0)
        .collect()
}
