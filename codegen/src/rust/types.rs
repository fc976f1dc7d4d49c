//! The emitted types: parameters, inputs, and the coefficients with their preparation.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::body::{Access, Body};
use super::file::{Emitted, File, quantity_line};
use super::functions::Needed;
use super::literals::{count, doc, identifier, number};
use crate::describe::describe_value;
use crate::program::{Extent, ValueId};

impl File<'_> {
    pub(super) fn parameters(&self) -> Emitted<TokenStream> {
        let mut fields = Vec::new();
        let mut defaults = Vec::new();
        for parameter in &self.program.parameters {
            let quantity = &parameter.quantity;
            let name = identifier(&quantity.name)?;
            let docs = doc(&[quantity_line(
                &quantity.doc,
                &quantity.unit,
                &parameter.origin,
            )]);
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

    pub(super) fn inputs(&self) -> Emitted<TokenStream> {
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

    pub(super) fn coefficients(&self, needed: &mut Needed) -> Emitted<TokenStream> {
        let mut body = Body::new(
            self.program,
            Access::Prepare,
            &self.prepared_roots(),
            needed,
        )?;
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
        let unused = self
            .program
            .parameters
            .is_empty()
            .then(|| quote!(#[allow(unused_variables)]));
        Ok(quote! {
            #[doc = " What depends on the parameters alone: prepare once, use in every call."]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Coefficients {
                #(#fields,)*
                #[doc = " Whether all prepared pivots of the mass matrix are positive and finite. If not, the mass matrix is not positive definite and the rates are not to be used."]
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
        self.fields
            .iter()
            .chain(&self.program.pivots)
            .copied()
            .collect()
    }

    fn pivot_check(&self, body: &mut Body<'_>) -> Emitted<TokenStream> {
        let mut conditions = Vec::new();
        for (place, id) in self.program.pivots.iter().enumerate() {
            match self.program.value(*id).extent {
                Extent::Scalar => {
                    let pivot = body.scalar(*id)?;
                    conditions.push(quote!(#pivot > 0.0 && #pivot < f64::INFINITY));
                }
                extent => {
                    let name = format_ident!("positive_{}", place + 1);
                    let length = count(extent.length());
                    let test = match extent {
                        Extent::Vector(_) => {
                            let element = body.element(*id)?;
                            quote!(#element > 0.0 && #element < f64::INFINITY)
                        }
                        _ => {
                            let array = body.array(*id)?;
                            quote!(#array[i][i] > 0.0 && #array[i][i] < f64::INFINITY)
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
}
