//! Statements for matrices: products, Gram matrices, assembled blocks and Cholesky factors,
//! as loops in the order that the program defines.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::EmitError;
use super::body::{Body, Emitted};
use super::expression::Expression;
use super::literals::count;
use crate::program::{Extent, Op, ValueId};

impl Body<'_> {
    /// An element of a matrix-vector product or of the diagonal of a Gram matrix.
    pub(super) fn summed_element(&mut self, id: ValueId) -> Emitted<(TokenStream, Ident)> {
        let name = self.names.of(self.program, id, "s")?;
        let (summand, length) = match self.program.value(id).op.clone() {
            Op::Apply {
                matrix,
                transposed,
                vector,
            } => {
                let (rows, columns) = self.matrix_size(matrix);
                let entry = self.array(matrix)?;
                let vector = self.element_at(vector, &format_ident!("k"))?;
                let (entry, length) = if transposed {
                    (quote!(#entry[k][i]), rows)
                } else {
                    (quote!(#entry[i][k]), columns)
                };
                let entry = Expression::atom(entry);
                (Expression::multiply(&entry, &vector).tokens(), length)
            }
            Op::GramDiagonal {
                left,
                weight,
                right,
            } => {
                let (nodes, _) = self.matrix_size(left);
                let (left, right) = (self.array(left)?, self.array(right)?);
                let weight = self.element_at(weight, &format_ident!("k"))?;
                let left = Expression::atom(quote!(#left[k][i]));
                let right = Expression::atom(quote!(#right[k][i]));
                let weighted = Expression::multiply(&left, &weight);
                (Expression::multiply(&weighted, &right).tokens(), nodes)
            }
            _ => (quote!(f64::NAN), 1),
        };
        let length = count(length);
        let statement = quote! {
            for k in 0..#length {
                #name[i] += #summand;
            }
        };
        Ok((statement, name))
    }

    pub(super) fn matrix_size(&self, id: ValueId) -> (usize, usize) {
        match self.program.value(id).extent {
            Extent::Matrix(rows, columns) => (rows, columns),
            other => (other.length(), 1),
        }
    }

    pub(super) fn matrix_step(&mut self, id: ValueId, rows: usize, columns: usize) -> Emitted<()> {
        let name = self.names.of(self.program, id, "s")?;
        let (rows, columns) = (count(rows), count(columns));
        match self.program.value(id).op.clone() {
            Op::Cholesky(matrix) => {
                self.needed.cholesky = true;
                let matrix = self.array(matrix)?;
                self.statements
                    .push(quote!(let #name = cholesky(&#matrix);));
            }
            Op::Gram {
                left,
                weight,
                right,
            } => {
                let nodes = count(self.matrix_size(left).0);
                let (left, right) = (self.array(left)?, self.array(right)?);
                let weight = self.element_at(weight, &format_ident!("k"))?;
                let left = Expression::atom(quote!(#left[k][i]));
                let right = Expression::atom(quote!(#right[k][j]));
                let weighted = Expression::multiply(&left, &weight);
                let summand = Expression::multiply(&weighted, &right).tokens();
                self.statements.push(quote! {
                    let mut #name = [[0.0; #columns]; #rows];
                    for i in 0..#rows {
                        for j in 0..#columns {
                            for k in 0..#nodes {
                                #name[i][j] += #summand;
                            }
                        }
                    }
                });
            }
            Op::CholeskySolve(..) => {
                return Err(EmitError::Syntax(
                    "a solved matrix stands in no emitted stage".to_owned(),
                ));
            }
            block => self.assemble(&name, (&rows, &columns), &block)?,
        }
        self.bound.insert(id, name);
        Ok(())
    }

    fn assemble(
        &mut self,
        name: &Ident,
        (rows, columns): (&Literal, &Literal),
        block: &Op,
    ) -> Emitted<()> {
        self.statements
            .push(quote!(let mut #name = [[0.0; #columns]; #rows];));
        let loops = self.block_loops(block, (rows, columns), &|i, j| quote!(#name[#i][#j]))?;
        self.statements.push(loops);
        Ok(())
    }

    /// Loops that add the parts of an assembled matrix to what stands at `place(i, j)`.
    pub fn block_loops(
        &mut self,
        block: &Op,
        (rows, columns): (&Literal, &Literal),
        place: &dyn Fn(&Ident, &Ident) -> TokenStream,
    ) -> Emitted<TokenStream> {
        let Op::Assemble {
            diagonal,
            outer,
            matrices,
        } = block
        else {
            return Ok(TokenStream::new());
        };
        let (i, j) = (format_ident!("i"), format_ident!("j"));
        let (on_diagonal, entry) = (place(&i, &i), place(&i, &j));
        let mut statements = Vec::new();
        if let Some(diagonal) = diagonal {
            let element = self.element(*diagonal)?;
            statements.push(quote!(#on_diagonal += #element;));
        }
        let mut entries = Vec::new();
        for (u, v) in outer {
            let (u, v) = (self.element_at(*u, &i)?, self.element_at(*v, &j)?);
            let product = Expression::multiply(&u, &v).tokens();
            entries.push(quote!(#entry += #product;));
        }
        for scaled in matrices {
            let matrix = self.array(scaled.matrix)?;
            let (row, column) = (
                self.element_at(scaled.row, &i)?,
                self.element_at(scaled.column, &j)?,
            );
            let element = if scaled.transposed {
                quote!(#matrix[j][i])
            } else {
                quote!(#matrix[i][j])
            };
            let scaled_row = Expression::multiply(&row, &Expression::atom(element));
            let product = Expression::multiply(&scaled_row, &column).tokens();
            entries.push(quote!(#entry += #product;));
        }
        if !entries.is_empty() {
            statements.push(quote! {
                for j in 0..#columns {
                    #(#entries)*
                }
            });
        }
        Ok(quote! {
            for i in 0..#rows {
                #(#statements)*
            }
        })
    }
}
