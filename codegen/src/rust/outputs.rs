//! The emitted functions that were requested, but for Jacobians: bias forces, inverse
//! dynamics, rates of the guards, products with the Jacobian.

use super::body::{Access, Body};
use super::emit_error::Emitted;
use super::expression::{assignment, infix};
use super::file::File;
use super::functions::Needed;
use super::literals::identifier;
use super::stages::Signature;
use crate::program::{Products, RowValues, ValueId, Variable};

impl File<'_> {
    /// All of them, Jacobians last.
    pub(super) fn requested(&self, needed: &mut Needed) -> Emitted<String> {
        let requested = &self.program.requested;
        let mut text = String::new();
        if let Some(rows) = &requested.bias_forces {
            let head = "/// Bias forces c - f of M q'' + c = f, in the order of the first half of\n\
                        /// [`STATE_NAMES`]: the forces missing for no acceleration.\n";
            text += &self.rows_function((head, "bias_forces", ""), rows, needed)?;
        }
        if let Some(rows) = &requested.inverse_dynamics {
            let head = "/// Inverse dynamics M a + c - f: the generalised forces that have to act besides\n\
                        /// those of the model for the accelerations a, in the order of the first half of\n\
                        /// [`STATE_NAMES`].\n";
            let argument = "accelerations: &[T; DEGREES_OF_FREEDOM],\n";
            text += &self.rows_function((head, "inverse_dynamics", argument), rows, needed)?;
        }
        if let Some(rates) = &requested.guard_rates {
            let line = "Rates of the switching surfaces along the motion, the inputs held.";
            text += &self.guard_values("guard_rates", line, rates, needed)?;
        }
        if let Some(products) = &requested.products {
            text += &self.jacobian_vector_product(products, needed)?;
            text += &self.vector_jacobian_product(products, needed)?;
            text += &self.product_by_parameters(products, needed)?;
        }
        text += &self.jacobians(needed)?;
        Ok(text)
    }

    /// A stage that reads coefficients and computes `roots`.
    pub(super) fn body<'b>(
        &'b self,
        roots: &[ValueId],
        needed: &'b mut Needed,
    ) -> Emitted<Body<'b>> {
        let access = Access::Coefficients(&self.field_names);
        Body::new(self.program, access, roots, needed)
    }

    /// A function that returns a number per degree of freedom.
    fn rows_function(
        &self,
        (head, name, argument): (&str, &str, &str),
        rows: &RowValues,
        needed: &mut Needed,
    ) -> Emitted<String> {
        let mut body = self.body(&rows.all(), needed)?;
        body.push("let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];");
        self.write_row_values(&mut body, "values", 0, rows)?;
        body.push("values");
        let head = format!("{head}#[allow(unused_variables, unused_mut)]\n");
        let signature = Signature {
            arguments: argument,
            ..Signature::of(name, "[T; DEGREES_OF_FREEDOM]")
        };
        Ok(self.stage_with(&head, &signature, &body.statements()))
    }

    /// Rows into `target` from a place on.
    pub(super) fn write_row_values(
        &self,
        body: &mut Body<'_>,
        target: &str,
        first: usize,
        rows: &RowValues,
    ) -> Emitted<()> {
        for (place, id) in rows.scalars.iter().enumerate() {
            let value = body.scalar(*id)?;
            body.push(&assignment(&format!("{target}[{}]", first + place), value));
        }
        for (field, id) in rows.modal.iter().enumerate() {
            let order = self.program.fields[field].order;
            if order > 0 {
                let value = body.element(*id)?;
                let place = infix("+", first + self.program.mode_offset(field), "i");
                body.push_loop(
                    "i",
                    order,
                    &assignment(&format!("{target}[{place}]"), value),
                );
            }
        }
        Ok(())
    }

    fn jacobian_vector_product(
        &self,
        products: &Products<ValueId, RowValues>,
        needed: &mut Needed,
    ) -> Emitted<String> {
        let degrees = self.program.degrees_of_freedom();
        let mut body = self.body(&products.forward.all(), needed)?;
        body.push("let mut product = [T::number(0.0); STATES];");
        let place = infix("+", degrees, "i");
        body.push_loop("i", degrees, &format!("product[i] = direction[{place}];"));
        self.write_row_values(&mut body, "product", degrees, &products.forward)?;
        body.push("product");
        let argument = format!(
            "direction: &[T; STATES],\ninput_direction: &{},\n",
            self.generic("Inputs")
        );
        Ok(self.stage_with(
            "/// Product of the Jacobian of the rates by state and inputs with a direction: how the\n\
             /// rates change along it.\n\
             #[allow(unused_variables)]\n",
            &Signature {
                arguments: &argument,
                ..Signature::of("jacobian_vector_product", "[T; STATES]")
            },
            &body.statements(),
        ))
    }

    fn vector_jacobian_product(
        &self,
        products: &Products<ValueId, RowValues>,
        needed: &mut Needed,
    ) -> Emitted<String> {
        let program = self.program;
        let degrees = program.degrees_of_freedom();
        let roots: Vec<ValueId> = products.reverse.iter().map(|(_, id)| *id).collect();
        let mut body = self.body(&roots, needed)?;
        body.push("let mut product = [T::number(0.0); STATES];");
        let place = infix("+", degrees, "i");
        body.push_loop("i", degrees, &format!("product[{place}] = weights[i];"));
        let mut inputs = vec!["T::number(0.0)".to_owned(); program.inputs.len()];
        for (variable, id) in &products.reverse {
            let place = program.variable_place(*variable);
            match variable {
                Variable::Input(index) => inputs[*index] = body.scalar(*id)?.to_string(),
                Variable::Coordinate(_) => {
                    let value = body.scalar(*id)?;
                    body.push(&assignment(&format!("product[{place}]"), value));
                }
                Variable::Rate(_) => {
                    let value = body.scalar(*id)?;
                    body.push(&super::blocks::add_to(&format!("product[{place}]"), &value));
                }
                Variable::ModeCoordinates(field) | Variable::ModeRates(field) => {
                    let value = body.element(*id)?;
                    let target = format!("product[{}]", infix("+", place, "i"));
                    let statement = match variable {
                        Variable::ModeRates(_) => super::blocks::add_to(&target, &value),
                        _ => assignment(&target, value),
                    };
                    body.push_loop("i", program.fields[*field].order, &statement);
                }
            }
        }
        let mut fields = Vec::new();
        for (input, value) in program.inputs.iter().zip(inputs) {
            fields.push(format!("{}: {value}", identifier(&input.name)?));
        }
        let literal = super::types::literal("Inputs", &fields);
        body.push(&assignment("let input_product", literal.trim_end()));
        body.push("(product, input_product)");
        let result = format!("([T; STATES], {})", self.generic("Inputs"));
        Ok(self.stage_with(
            "/// Product of weights with the Jacobian of the rates by state and inputs: the gradient of\n\
             /// the weighted sum of the rates.\n\
             #[allow(unused_variables)]\n",
            &Signature {
                arguments: "weights: &[T; STATES],\n",
                ..Signature::of("vector_jacobian_product", &result)
            },
            &body.statements(),
        ))
    }

    fn product_by_parameters(
        &self,
        products: &Products<ValueId, RowValues>,
        needed: &mut Needed,
    ) -> Emitted<String> {
        let entries = &products.by_parameters.entries;
        let roots: Vec<ValueId> = entries.iter().map(|entry| entry.value).collect();
        let mut body = self.body(&roots, needed)?;
        body.push("let mut product = [T::number(0.0); PARAMETERS];");
        for entry in entries {
            let value = body.scalar(entry.value)?;
            body.push(&assignment(&format!("product[{}]", entry.column), value));
        }
        body.push("product");
        Ok(self.stage_with(
            "/// Product of weights with the Jacobian of the rates by the parameters, in the order of\n\
             /// [`PARAMETER_NAMES`]: the gradient of the weighted sum of the rates.\n\
             #[allow(unused_variables, unused_mut)]\n",
            &Signature {
                arguments: "weights: &[T; STATES],\n",
                ..Signature::of("vector_jacobian_product_by_parameters", "[T; PARAMETERS]")
            },
            &body.statements(),
        ))
    }
}
