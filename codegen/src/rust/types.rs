//! Emitted types: parameters, inputs, and the coefficients with their preparation.

use super::expression::Writer;
use super::generics::type_with_generics;
use super::literals::{number, write_doc};
use crate::program::{Extent, Quantity};
use crate::statements::layout::block;
use crate::statements::layout::{CLOSE, FLOW_EVEN, SPACE};
use crate::statements::{
    EmitResult, File, PreparedValue, RequiredFunctions, build_preparation, describe_coefficient,
    describe_quantity,
};

/// Largest length of a struct literal on one line, in characters.
const MAX_LITERAL_WIDTH: usize = 34;

pub(super) fn write_parameters(file: &File<'_>) -> EmitResult<String> {
    let mut fields = String::new();
    let (mut defaults, mut casts) = (Vec::new(), Vec::new());
    for parameter in &file.program.parameters {
        fields.push_str(&write_field(file, &parameter.quantity, &parameter.origin)?);
        let name = &parameter.quantity.name;
        defaults.push(format!("{name}: {}", number(parameter.value)));
        casts.push(format!("{name}: T::number(self.{name})"));
    }
    let head = format!(
        "/// Parameters of the model. `Default` has the values of the specification.\n\
         #[derive(Clone, Copy, Debug, PartialEq)]\n\
         pub struct Parameters{} {{",
        declared_type(!casts.is_empty())
    );
    let default = block(
        "fn default() -> Self {",
        &write_literal("Self", &defaults),
        "}",
    );
    Ok(block(&head, &fields, "}")
        + &block("impl Default for Parameters {", &default, "}")
        + &write_cast("Parameters", "these parameters", &casts)
        + &write_array_conversion(file, "Parameters", "PARAMETERS"))
}

pub(super) fn write_inputs(file: &File<'_>) -> EmitResult<String> {
    let mut fields = String::new();
    let mut zeros = Vec::new();
    for input in &file.program.inputs {
        fields.push_str(&write_field(file, input, "")?);
        zeros.push(format!("{}: T::number(0.0)", input.name));
    }
    let derived = if zeros.is_empty() { "Default, " } else { "" };
    let head = format!(
        "/// Inputs at run time. `Default` is zero.\n\
         #[derive(Clone, Copy, Debug, {derived}PartialEq)]\n\
         pub struct Inputs{} {{",
        declared_type(!zeros.is_empty())
    );
    let mut text = block(&head, &fields, "}");
    if !zeros.is_empty() {
        let default = block(
            "fn default() -> Self {",
            &write_literal("Self", &zeros),
            "}",
        );
        text += &block("impl<T: Scalar> Default for Inputs<T> {", &default, "}");
    }
    Ok(text + &write_array_conversion(file, "Inputs", "INPUTS"))
}

fn write_array_conversion(file: &File<'_>, name: &str, count: &str) -> String {
    let program = file.program;
    let quantities: Vec<&Quantity> = match name {
        "Parameters" => program.parameters.iter().map(|p| &p.quantity).collect(),
        _ => program.inputs.iter().collect(),
    };
    let values: Vec<String> = quantities
        .iter()
        .enumerate()
        .map(|(place, quantity)| format!("{}: numbers[{place}]", quantity.name))
        .collect();
    let argument = if values.is_empty() { "_" } else { "numbers" };
    let opening = format!("fn from({argument}: [T; {count}]) -> Self {{");
    let body = block(&opening, &write_literal("Self", &values), "}");
    let whole = type_with_generics(file, name);
    let head = format!("impl<T: Copy> From<[T; {count}]> for {whole} {{");
    block(&head, &body, "}")
}

pub(super) fn write_coefficients(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
    writer: &mut Writer,
) -> EmitResult<String> {
    let prepared = build_preparation(file, needed)?;
    writer.notes.clone_from(&prepared.notes);
    let statements = writer.statements(&prepared.computed);
    let mut fields = String::new();
    let (mut values, mut casts) = (Vec::new(), Vec::new());
    for (id, coefficient) in file.fields.iter().zip(&prepared.coefficients) {
        let name = &file.field_names[id];
        fields.push_str(&write_doc(&[describe_coefficient(file, &prepared, *id)]));
        let value = match coefficient {
            PreparedValue::Number(value) => writer.expression(value),
            PreparedValue::Numbers(array) => writer.array(array),
        };
        let (field_type, converted) = match file.program.value(*id).extent {
            Extent::Scalar => ("T".to_owned(), format!("T::number(self.{name})")),
            Extent::Vector(n) => {
                writer.conversions.converted = true;
                (format!("[T; {n}]"), format!("converted(&self.{name})"))
            }
            Extent::Matrix(rows, columns) => {
                writer.conversions.converted_matrix = true;
                let matrix = format!("[[T; {columns}]; {rows}]");
                (matrix, format!("converted_matrix(&self.{name})"))
            }
        };
        casts.push(format!("{name}: {converted}"));
        fields.push_str(&format!("pub {name}: {field_type},\n"));
        values.push(format!("{name}: {FLOW_EVEN}{value}{CLOSE}"));
    }
    fields.push_str(
        "/// True if all prepared pivots of the mass matrix are positive and finite. If false, \
         the mass matrix is not positive definite and the rates are invalid.\n",
    );
    if file.program.may_lose_definiteness() {
        fields.push_str(
            "/// The mass matrix also varies with the state, which this flag does not include: if it \
             is not positive definite, rates are NaN.\n",
        );
    }
    fields.push_str("pub positive_definite: bool,\n");
    let check = writer.expression(&prepared.positive_definite);
    values.push(format!("positive_definite: {FLOW_EVEN}{check}{CLOSE}"));
    let numbers = !casts.is_empty();
    let head = format!(
        "/// Values that depend only on the parameters: prepare once, use in every call.\n\
         #[derive(Clone, Copy, Debug, PartialEq)]\n\
         pub struct Coefficients{} {{",
        declared_type(numbers)
    );
    casts.push("positive_definite: self.positive_definite".to_owned());
    let prepare = write_prepare(file, &(statements + &write_literal("Self", &values)));
    let generic = if numbers {
        "impl<T: Scalar> Coefficients<T> {"
    } else {
        "impl Coefficients {"
    };
    let cast = if numbers {
        write_cast("Coefficients", "these coefficients", &casts)
    } else {
        String::new()
    };
    Ok(block(&head, &fields, "}") + &block(generic, &prepare, "}") + &cast)
}

/// Writes the function that prepares the coefficients. If no coefficient is a number, the parameters determine the
/// number type; without parameters it is `f64`.
fn write_prepare(file: &File<'_>, statements: &str) -> String {
    let parameters = type_with_generics(file, "Parameters");
    let (with_coefficients, with_parameters) =
        (!file.fields.is_empty(), !file.program.parameters.is_empty());
    let unused = if statements.contains("parameters") {
        ""
    } else {
        "#[allow(unused_variables)]\n"
    };
    let own = if with_parameters && !with_coefficients {
        "<T: Scalar>"
    } else {
        ""
    };
    let opening = format!(
        "/// Prepares the coefficients of these parameters.\n{unused}\
         pub fn prepare{own}(parameters: &{parameters}) -> Self {{"
    );
    let nobody = !with_coefficients && !with_parameters && statements.contains("T::");
    let declared = if nobody { "type T = f64;\n" } else { "" };
    // This reference keeps the identity in the image if the linker removes unused items.
    let kept = "let _ = core::hint::black_box(&IDENTITY);\n";
    block(&opening, &format!("{kept}{declared}{statements}"), "}")
}

fn write_field(file: &File<'_>, quantity: &Quantity, origin: &str) -> EmitResult<String> {
    let name = file.words.identifier(&quantity.name)?;
    let docs = write_doc(&[describe_quantity(&quantity.doc, &quantity.unit, origin)]);
    Ok(format!("{docs}pub {name}: T,\n"))
}

/// Returns the type parameter of a struct that contains numbers.
fn declared_type(numbers: bool) -> &'static str {
    if numbers { "<T = f64>" } else { "" }
}

/// Writes the conversion of a struct from `f64` to another scalar type.
fn write_cast(name: &str, what: &str, fields: &[String]) -> String {
    if fields.is_empty() {
        return String::new();
    }
    let opening = format!(
        "/// Converts {what} to another number type, without derivatives.\n\
         #[inline(always)]\n\
         pub fn cast<T: Scalar>(&self) -> {name}<T> {{"
    );
    let body = block(&opening, &write_literal(name, fields), "}");
    block(&format!("impl {name} {{"), &body, "}")
}

/// Writes a struct literal, on one line if it is short.
pub(super) fn write_literal(name: &str, values: &[String]) -> String {
    let line = format!("{name} {{ {} }}\n", values.join(", "));
    let width = line
        .chars()
        .filter(|c| !c.is_control() || *c == SPACE)
        .count();
    if values.is_empty() {
        return format!("{name} {{}}\n");
    }
    if width <= MAX_LITERAL_WIDTH + 2 {
        return line;
    }
    let lines: String = values.iter().map(|value| format!("{value},\n")).collect();
    block(&format!("{name} {{"), &lines, "}")
}
