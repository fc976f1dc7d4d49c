//! The emitted outputs on request, but for Jacobians: bias forces, inverse
//! dynamics, rates of the guards, products with the Jacobian.

use super::blocks::add_to;
use super::emit_error::Emitted;
use super::expression::{assignment, infix};
use super::file::File;
use super::functions::Needed;
use super::jacobians::jacobians;
use super::literals::identifier;
use super::rows::write_row_values;
use super::signature::{Signature, stage_with};
use super::stages::guard_values;
use super::types::literal;
use crate::program::{Products, RowValues, ValueId, Variable};

/// All of them, Jacobians last.
pub(super) fn outputs(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let outputs = &file.program.outputs;
    let mut text = String::new();
    if let Some(rows) = &outputs.bias_forces {
        let head = "/// Bias forces c - f of M q'' + c = f, in the order of the first half of\n\
                    /// [`STATE_NAMES`]: the forces missing for no acceleration.\n";
        text += &rows_function(file, (head, "bias_forces", ""), rows, needed)?;
    }
    if let Some(rows) = &outputs.inverse_dynamics {
        let head = "/// Inverse dynamics M a + c - f: the generalised forces that have to act besides\n\
                    /// those of the model for the accelerations a, in the order of the first half of\n\
                    /// [`STATE_NAMES`].\n";
        let argument = "accelerations: &[T; DEGREES_OF_FREEDOM],\n";
        text += &rows_function(file, (head, "inverse_dynamics", argument), rows, needed)?;
    }
    if let Some(rates) = &outputs.guard_rates {
        let line = "Rates of the switching surfaces along the motion, the inputs held.";
        text += &guard_values(file, "guard_rates", line, rates, needed)?;
    }
    if let Some(products) = &outputs.products {
        text += &jacobian_vector_product(file, products, needed)?;
        text += &vector_jacobian_product(file, products, needed)?;
        text += &product_by_parameters(file, products, needed)?;
    }
    text += &jacobians(file, needed)?;
    Ok(text)
}

/// A function that returns a number per degree of freedom.
fn rows_function(
    file: &File<'_>,
    (head, name, argument): (&str, &str, &str),
    rows: &RowValues,
    needed: &mut Needed,
) -> Emitted<String> {
    let mut body = file.body(&rows.all(), needed)?;
    body.push("let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];");
    write_row_values(file, &mut body, "values", 0, rows)?;
    body.push("values");
    let head = format!("{head}#[allow(unused_variables, unused_mut)]\n");
    let signature = Signature {
        arguments: argument,
        ..Signature::of(name, "[T; DEGREES_OF_FREEDOM]")
    };
    Ok(stage_with(file, &head, &signature, &body.statements()))
}

fn jacobian_vector_product(
    file: &File<'_>,
    products: &Products<ValueId, RowValues>,
    needed: &mut Needed,
) -> Emitted<String> {
    let degrees = file.program.degrees_of_freedom();
    let mut body = file.body(&products.forward.all(), needed)?;
    body.push("let mut product = [T::number(0.0); STATES];");
    let place = infix("+", degrees, "i");
    body.push_loop("i", degrees, &format!("product[i] = direction[{place}];"));
    write_row_values(file, &mut body, "product", degrees, &products.forward)?;
    body.push("product");
    let argument = format!(
        "direction: &[T; STATES],\ninput_direction: &{},\n",
        file.generic("Inputs")
    );
    Ok(stage_with(
        file,
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
    file: &File<'_>,
    products: &Products<ValueId, RowValues>,
    needed: &mut Needed,
) -> Emitted<String> {
    let program = file.program;
    let degrees = program.degrees_of_freedom();
    let roots: Vec<ValueId> = products.reverse.iter().map(|(_, id)| *id).collect();
    let mut body = file.body(&roots, needed)?;
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
                body.push(&add_to(&format!("product[{place}]"), &value));
            }
            Variable::ModeCoordinates(field) | Variable::ModeRates(field) => {
                let value = body.element(*id)?;
                let target = format!("product[{}]", infix("+", place, "i"));
                let statement = match variable {
                    Variable::ModeRates(_) => add_to(&target, &value),
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
    let literal = literal("Inputs", &fields);
    body.push(&assignment("let input_product", literal.trim_end()));
    body.push("(product, input_product)");
    let result = format!("([T; STATES], {})", file.generic("Inputs"));
    Ok(stage_with(
        file,
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
    file: &File<'_>,
    products: &Products<ValueId, RowValues>,
    needed: &mut Needed,
) -> Emitted<String> {
    let entries = &products.by_parameters.entries;
    let roots: Vec<ValueId> = entries.iter().map(|entry| entry.value).collect();
    let mut body = file.body(&roots, needed)?;
    body.push("let mut product = [T::number(0.0); PARAMETERS];");
    for entry in entries {
        let value = body.scalar(entry.value)?;
        body.push(&assignment(&format!("product[{}]", entry.column), value));
    }
    body.push("product");
    Ok(stage_with(
        file,
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
