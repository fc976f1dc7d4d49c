//! The emitted functions that are called with prepared coefficients, one per stage.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::body::{Access, Body};
use super::file::{Emitted, File, mass_roots, quantity_line};
use super::functions::Needed;
use super::literals::{count, doc, identifier};
use crate::program::{Extent, Op, RowValues, ValueId};

impl File<'_> {
    pub(super) fn rates(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let rows = &program.accelerations;
        let mut body = Body::new(
            program,
            Access::Coefficients(&self.field_names),
            &rows.all(),
            needed,
        )?;
        let degrees = count(program.degrees_of_freedom());
        body.push(quote! {
            let mut rates = [0.0; STATES];
            for i in 0..#degrees {
                rates[i] = state[#degrees + i];
            }
        });
        self.write_rows(
            &mut body,
            rows,
            &format_ident!("rates"),
            program.degrees_of_freedom(),
        )?;
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

    fn write_rows(
        &self,
        body: &mut Body<'_>,
        rows: &RowValues,
        target: &Ident,
        offset: usize,
    ) -> Emitted<()> {
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

    pub(super) fn observables(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let ids = &program.observable_values;
        let mut body = Body::new(
            program,
            Access::Coefficients(&self.field_names),
            ids,
            needed,
        )?;
        let values = ids
            .iter()
            .map(|id| body.scalar(*id))
            .collect::<Emitted<Vec<_>>>()?;
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
            (
                "energy",
                ids.len() - 2,
                " Kinetic plus potential energy, in J.",
            ),
            (
                "power",
                ids.len() - 1,
                " Power of all non-conservative forces, in W: the rate of the energy.",
            ),
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

    pub(super) fn guards(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let ids: Vec<ValueId> = program.guards.iter().map(|g| g.value).collect();
        let mut body = Body::new(
            program,
            Access::Coefficients(&self.field_names),
            &ids,
            needed,
        )?;
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

    pub(super) fn mass_matrix(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let program = self.program;
        let roots = mass_roots(program);
        let mut body = Body::new(
            program,
            Access::Coefficients(&self.field_names),
            &roots,
            needed,
        )?;
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
