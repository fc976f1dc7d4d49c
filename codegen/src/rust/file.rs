//! The items of an emitted file and their order: constants, parameters, coefficients,
//! inputs, then one function per stage.

use std::collections::{BTreeSet, HashMap};

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::EmitError;
use super::body::{Access, Body};
use super::functions::{Needed, items};
use super::literals::{count, doc, file_doc, identifier, number};
use super::names::Names;
use crate::describe::describe_value;
use crate::program::{Extent, Op, Program, RowValues, ValueId};

/// What the emitted file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packaging {
    /// The root of a crate of its own.
    Crate,
    /// A module of a crate that is `no_std` already.
    Module,
}

type Emitted<T> = Result<T, EmitError>;

/// The source of a program as Rust.
///
/// # Errors
/// If a name of the program is no Rust identifier.
pub fn emit(program: &Program, packaging: Packaging) -> Result<String, EmitError> {
    let file = File::new(program)?;
    let tokens = file.tokens(packaging)?;
    let parsed: syn::File =
        syn::parse2(tokens).map_err(|error| EmitError::Syntax(error.to_string()))?;
    Ok(spaced(&prettyplease::unparse(&parsed)))
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

struct File<'p> {
    program: &'p Program,
    /// Prepared values that the stages read, in the order of the program, by name.
    fields: Vec<ValueId>,
    field_names: HashMap<ValueId, Ident>,
}

impl<'p> File<'p> {
    fn new(program: &'p Program) -> Emitted<Self> {
        let mut names = Names::new();
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

    fn tokens(&self, packaging: Packaging) -> Emitted<TokenStream> {
        let mut needed = Needed::default();
        let header = self.header(packaging);
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
            #header
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

    fn header(&self, packaging: Packaging) -> TokenStream {
        let program = self.program;
        let orders: Vec<String> = program.fields.iter().map(|f| f.order.to_string()).collect();
        let order = if orders.is_empty() {
            "rigid".to_owned()
        } else {
            format!("modal truncation order {}", orders.join(", "))
        };
        let lines = [
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
        ];
        let docs = file_doc(&lines);
        let no_std = (packaging == Packaging::Crate).then(|| quote!(#![no_std]));
        quote! {
            #docs
            #no_std
            #![allow(non_snake_case)]
            #![allow(clippy::all)]
            #![forbid(unsafe_code)]
        }
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

    fn guard_count(&self) -> usize {
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

    fn parameters(&self) -> Emitted<TokenStream> {
        let mut fields = Vec::new();
        let mut defaults = Vec::new();
        for parameter in &self.program.parameters {
            let quantity = &parameter.quantity;
            let name = identifier(&quantity.name)?;
            let docs = doc(&[quantity_line(&quantity.doc, &quantity.unit, &parameter.origin)]);
            let value = number(parameter.value);
            fields.push(quote!(#docs pub #name: f64));
            defaults.push(quote!(#name: #value));
        }
        Ok(quote! {
            #[doc = " Parameters of the model. `Default` gives the specification's values."]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Parameters { #(#fields),* }

            impl Default for Parameters {
                fn default() -> Self {
                    Self { #(#defaults),* }
                }
            }
        })
    }

    fn inputs(&self) -> Emitted<TokenStream> {
        let mut fields = Vec::new();
        for input in &self.program.inputs {
            let name = identifier(&input.name)?;
            let docs = doc(&[quantity_line(&input.doc, &input.unit, "")]);
            fields.push(quote!(#docs pub #name: f64));
        }
        Ok(quote! {
            #[doc = " Signals supplied at run time. `Default` gives zeros."]
            #[derive(Clone, Copy, Debug, Default, PartialEq)]
            pub struct Inputs { #(#fields),* }
        })
    }

    fn coefficients(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let mut body = Body::new(self.program, Access::Prepare, &self.prepared_roots(), needed)?;
        let mut fields = Vec::new();
        let mut values = Vec::new();
        for id in &self.fields {
            let name = &self.field_names[id];
            let docs = doc(&[describe_value(self.program, *id)]);
            let extent = self.program.value(*id).extent;
            let field_type = match extent {
                Extent::Scalar => quote!(f64),
                Extent::Vector(n) => {
                    let n = count(n);
                    quote!([f64; #n])
                }
                Extent::Matrix(rows, columns) => {
                    let (rows, columns) = (count(rows), count(columns));
                    quote!([[f64; #columns]; #rows])
                }
            };
            fields.push(quote!(#docs pub #name: #field_type));
            let value = match extent {
                Extent::Scalar => body.scalar(*id)?,
                _ => body.array(*id)?,
            };
            values.push(quote!(#name: #value));
        }
        let check = self.pivot_check(&mut body)?;
        let statements = body.statements();
        let unused = self.program.parameters.is_empty().then(|| quote!(#[allow(unused_variables)]));
        Ok(quote! {
            #[doc = " What depends on the parameters alone: prepare once, use in every call."]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Coefficients {
                #(#fields,)*
                #[doc = " Whether all prepared pivots of the mass matrix are positive. If not, the mass matrix is not positive definite and the rates are not to be used."]
                pub positive_definite: bool,
            }

            impl Coefficients {
                #[doc = " The coefficients of these parameters."]
                #unused
                pub fn prepare(parameters: &Parameters) -> Self {
                    #(#statements)*
                    Self {
                        #(#values,)*
                        positive_definite: #check,
                    }
                }
            }
        })
    }

    fn prepared_roots(&self) -> Vec<ValueId> {
        self.fields.iter().chain(&self.program.pivots).copied().collect()
    }

    fn pivot_check(&self, body: &mut Body<'_>) -> Emitted<TokenStream> {
        let mut conditions = Vec::new();
        for (place, id) in self.program.pivots.iter().enumerate() {
            match self.program.value(*id).extent {
                Extent::Scalar => {
                    let pivot = body.scalar(*id)?;
                    conditions.push(quote!(#pivot > 0.0));
                }
                extent => {
                    let name = format_ident!("positive_{}", place + 1);
                    let length = count(extent.length());
                    let test = match extent {
                        Extent::Vector(_) => {
                            let element = body.element(*id)?;
                            quote!(#element > 0.0)
                        }
                        _ => {
                            let array = body.array(*id)?;
                            quote!(#array[i][i] > 0.0)
                        }
                    };
                    let length = match extent {
                        Extent::Matrix(rows, _) => count(rows),
                        _ => length,
                    };
                    body.push(quote! {
                        let mut #name = true;
                        for i in 0..#length {
                            #name = #name && #test;
                        }
                    });
                    conditions.push(quote!(#name));
                }
            }
        }
        if conditions.is_empty() {
            return Ok(quote!(true));
        }
        Ok(quote!(#(#conditions)&&*))
    }

    fn rates(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let rows = &program.accelerations;
        let mut body = Body::new(program, Access::Coefficients(&self.field_names), &rows.all(), needed)?;
        let degrees = count(program.degrees_of_freedom());
        body.push(quote! {
            let mut rates = [0.0; STATES];
            for i in 0..#degrees {
                rates[i] = state[#degrees + i];
            }
        });
        self.write_rows(&mut body, rows, &format_ident!("rates"), program.degrees_of_freedom())?;
        let statements = body.statements();
        Ok(quote! {
            #[doc = " Rates of the state."]
            #[doc = ""]
            #[doc = " `t` in s; `state` and the result in the order of [`STATE_NAMES`]."]
            #[allow(unused_variables)]
            pub fn rates(t: f64, state: &[f64; STATES], inputs: &Inputs, coefficients: &Coefficients) -> [f64; STATES] {
                #(#statements)*
                rates
            }
        })
    }

    fn write_rows(&self, body: &mut Body<'_>, rows: &RowValues, target: &Ident, offset: usize) -> Emitted<()> {
        for (place, id) in rows.scalars.iter().enumerate() {
            let place = count(offset + place);
            let value = body.scalar(*id)?;
            body.push(quote!(#target[#place] = #value;));
        }
        for (field, id) in rows.modal.iter().enumerate() {
            let order = self.program.fields[field].order;
            if order == 0 {
                continue;
            }
            let first = count(offset + self.program.mode_offset(field));
            let order = count(order);
            let value = body.element(*id)?;
            body.push(quote! {
                for i in 0..#order {
                    #target[#first + i] = #value;
                }
            });
        }
        Ok(())
    }

    fn observables(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let ids = &program.observable_values;
        let mut body = Body::new(program, Access::Coefficients(&self.field_names), ids, needed)?;
        let values = ids.iter().map(|id| body.scalar(*id)).collect::<Emitted<Vec<_>>>()?;
        let statements = body.statements();
        let (mut functions, mut lines) = (Vec::new(), Vec::new());
        for observable in &program.observables {
            lines.push(format!(
                "- `{}`: {}",
                observable.name,
                quantity_line(&observable.doc, &observable.unit, "")
            ));
        }
        let docs = doc(&lines);
        for (name, id, line) in [
            ("energy", ids.len() - 2, " Kinetic plus potential energy, in J."),
            ("power", ids.len() - 1, " Power of all non-conservative forces, in W: the rate of the energy."),
        ] {
            functions.push(self.scalar_function(name, line, ids[id], needed)?);
        }
        Ok(quote! {
            #[doc = " The observables, in the order of [`OBSERVABLE_NAMES`]:"]
            #[doc = ""]
            #docs
            #[allow(unused_variables)]
            pub fn observables(t: f64, state: &[f64; STATES], inputs: &Inputs, coefficients: &Coefficients) -> [f64; OBSERVABLES] {
                #(#statements)*
                [#(#values),*]
            }
            #(#functions)*
        })
    }

    fn scalar_function(
        &self,
        name: &str,
        line: &str,
        id: ValueId,
        needed: &mut Needed,
    ) -> Emitted<TokenStream> {
        let access = Access::Coefficients(&self.field_names);
        let mut body = Body::new(self.program, access, &[id], needed)?;
        let value = body.scalar(id)?;
        let statements = body.statements();
        let name = identifier(name)?;
        Ok(quote! {
            #[doc = #line]
            #[allow(unused_variables)]
            pub fn #name(t: f64, state: &[f64; STATES], inputs: &Inputs, coefficients: &Coefficients) -> f64 {
                #(#statements)*
                #value
            }
        })
    }

    fn guards(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let ids: Vec<ValueId> = program.guards.iter().map(|g| g.value).collect();
        let mut body = Body::new(program, Access::Coefficients(&self.field_names), &ids, needed)?;
        body.push(quote!(let mut values = [0.0; GUARDS];));
        let mut place = 0;
        let mut lines = Vec::new();
        for guard in &program.guards {
            let at = count(place);
            match program.value(guard.value).extent {
                Extent::Vector(length) => {
                    let value = body.element(guard.value)?;
                    let n = count(length);
                    body.push(quote! {
                        for i in 0..#n {
                            values[#at + i] = #value;
                        }
                    });
                    place += length;
                }
                _ => {
                    let value = body.scalar(guard.value)?;
                    body.push(quote!(values[#at] = #value;));
                    place += 1;
                }
            }
            lines.push(format!("- `{}`", guard.formula));
        }
        let statements = body.statements();
        let docs = doc(&lines);
        Ok(quote! {
            #[doc = " Switching surfaces: the equations change where one of these changes sign."]
            #[doc = ""]
            #docs
            #[allow(unused_variables, unused_mut)]
            pub fn guards(t: f64, state: &[f64; STATES], inputs: &Inputs, coefficients: &Coefficients) -> [f64; GUARDS] {
                #(#statements)*
                values
            }
        })
    }

    fn mass_matrix(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let roots = mass_roots(program);
        let mut body = Body::new(program, Access::Coefficients(&self.field_names), &roots, needed)?;
        body.push(quote!(let mut values = [[0.0; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];));
        for (row, entries) in program.mass.scalars.iter().enumerate() {
            for (column, id) in entries.iter().enumerate() {
                if matches!(program.value(*id).op, Op::Constant(0.0)) {
                    continue;
                }
                let value = body.scalar(*id)?;
                let (row, column) = (count(row), count(column));
                body.push(quote!(values[#row][#column] = #value;));
            }
        }
        self.write_coupling(&mut body)?;
        self.write_modal_blocks(&mut body)?;
        let statements = body.statements();
        Ok(quote! {
            #[doc = " The mass matrix, in the order of the first half of [`STATE_NAMES`]."]
            #[allow(unused_variables, unused_mut)]
            pub fn mass_matrix(t: f64, state: &[f64; STATES], inputs: &Inputs, coefficients: &Coefficients) -> [[f64; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
                #(#statements)*
                values
            }
        })
    }

    fn write_coupling(&self, body: &mut Body<'_>) -> Emitted<()> {
        let program = self.program;
        for (row, entries) in program.mass.coupling.iter().enumerate() {
            for (field, id) in entries.iter().enumerate() {
                let order = program.fields[field].order;
                if order == 0 || matches!(program.value(*id).op, Op::Constant(0.0)) {
                    continue;
                }
                let value = body.element(*id)?;
                let (row, order) = (count(row), count(order));
                let first = count(program.mode_offset(field));
                body.push(quote! {
                    for i in 0..#order {
                        values[#row][#first + i] = #value;
                        values[#first + i][#row] = values[#row][#first + i];
                    }
                });
            }
        }
        Ok(())
    }

    fn write_modal_blocks(&self, body: &mut Body<'_>) -> Emitted<()> {
        let program = self.program;
        for (row, blocks) in program.mass.modal.iter().enumerate() {
            for (column, block) in blocks.iter().enumerate() {
                let Some(id) = block else { continue };
                let (rows, columns) = (program.fields[row].order, program.fields[column].order);
                if rows == 0 || columns == 0 {
                    continue;
                }
                let first_row = count(program.mode_offset(row));
                let first_column = count(program.mode_offset(column));
                let loops = body.block_loops(
                    &program.value(*id).op,
                    (&count(rows), &count(columns)),
                    &|i, j| quote!(values[#first_row + #i][#first_column + #j]),
                )?;
                body.push(loops);
            }
        }
        Ok(())
    }
}

fn quantity_line(text: &str, unit: &str, origin: &str) -> String {
    let mut line = if text.is_empty() { String::new() } else { format!("{text} ") };
    line.push_str(&format!("[{unit}]"));
    if !origin.is_empty() {
        line.push_str(&format!(" ({origin})"));
    }
    line
}

fn mass_roots(program: &Program) -> Vec<ValueId> {
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
    read.into_iter().filter(|id| program.value(*id).extent.length() > 0).collect()
}
