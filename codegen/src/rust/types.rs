//! The emitted types: parameters, inputs, and the coefficients with their preparation.

use super::body::{Access, Body};
use super::emit_error::Emitted;
use super::expression::{Expression, assignment};
use super::file::{File, quantity_line};
use super::functions::Needed;
use super::layout::{CLOSE, FLOW_EVEN, SPACE};
use super::literals::{block, doc, identifier, number};
use crate::program::describe::describe_value;
use crate::program::{Extent, Quantity, ValueId};

/// The most characters of a struct's literal that is written on one line.
const LITERAL_WIDTH: usize = 34;

pub(super) fn parameters(file: &File<'_>) -> Emitted<String> {
    let mut fields = String::new();
    let (mut defaults, mut casts) = (Vec::new(), Vec::new());
    for parameter in &file.program.parameters {
        fields.push_str(&field(&parameter.quantity, &parameter.origin)?);
        let name = &parameter.quantity.name;
        defaults.push(format!("{name}: {}", number(parameter.value)));
        casts.push(format!("{name}: T::number(self.{name})"));
    }
    let head = format!(
        "/// Parameters of the model. `Default` gives the specification's values.\n\
         #[derive(Clone, Copy, Debug, PartialEq)]\n\
         pub struct Parameters{} {{",
        declared(!casts.is_empty())
    );
    let default = block("fn default() -> Self {", &literal("Self", &defaults), "}");
    Ok(block(&head, &fields, "}")
        + &block("impl Default for Parameters {", &default, "}")
        + &cast("Parameters", "these parameters", &casts)
        + &array_conversion(file, "Parameters", "PARAMETERS"))
}

pub(super) fn inputs(file: &File<'_>) -> Emitted<String> {
    let mut fields = String::new();
    let mut zeros = Vec::new();
    for input in &file.program.inputs {
        fields.push_str(&field(input, "")?);
        zeros.push(format!("{}: T::number(0.0)", input.name));
    }
    let derived = if zeros.is_empty() { "Default, " } else { "" };
    let head = format!(
        "/// Signals supplied at run time. `Default` gives zeros.\n\
         #[derive(Clone, Copy, Debug, {derived}PartialEq)]\n\
         pub struct Inputs{} {{",
        declared(!zeros.is_empty())
    );
    let mut text = block(&head, &fields, "}");
    if !zeros.is_empty() {
        let default = block("fn default() -> Self {", &literal("Self", &zeros), "}");
        text += &block("impl<T: Scalar> Default for Inputs<T> {", &default, "}");
    }
    Ok(text + &array_conversion(file, "Inputs", "INPUTS"))
}

/// The conversion from an array of numbers in the order of the names.
fn array_conversion(file: &File<'_>, name: &str, count: &str) -> String {
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
    let body = block(&opening, &literal("Self", &values), "}");
    let whole = file.generic(name);
    let head = format!("impl<T: Copy> From<[T; {count}]> for {whole} {{");
    block(&head, &body, "}")
}

pub(super) fn coefficients(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let mut body = Body::new(
        file.program,
        Access::Prepare,
        &preparation_roots(file),
        needed,
    )?;
    let mut fields = String::new();
    let (mut values, mut casts) = (Vec::new(), Vec::new());
    for id in &file.fields {
        let name = &file.field_names[id];
        fields.push_str(&doc(&[describe_value(file.program, *id)]));
        let (field_type, value, converted) = match file.program.value(*id).extent {
            Extent::Scalar => {
                let value = body.scalar(*id)?.to_string();
                ("T".to_owned(), value, format!("T::number(self.{name})"))
            }
            Extent::Vector(n) => {
                body.needed.converted = true;
                let converted = format!("converted(&self.{name})");
                (format!("[T; {n}]"), body.numbers(*id)?, converted)
            }
            Extent::Matrix(rows, columns) => {
                body.needed.converted_matrix = true;
                let converted = format!("converted_matrix(&self.{name})");
                let matrix = format!("[[T; {columns}]; {rows}]");
                (matrix, body.numbers(*id)?, converted)
            }
        };
        casts.push(format!("{name}: {converted}"));
        fields.push_str(&format!("pub {name}: {field_type},\n"));
        values.push(format!("{name}: {FLOW_EVEN}{value}{CLOSE}"));
    }
    fields.push_str(
        "/// Whether all prepared pivots of the mass matrix are positive and finite. If not, \
         the mass matrix is not positive definite and the rates are not to be used.\n",
    );
    if file.program.may_lose_definiteness() {
        fields.push_str(
            "/// The mass matrix varies with the state too, of which this says nothing: where it \
             is not positive definite, rates are NaN.\n",
        );
    }
    fields.push_str("pub positive_definite: bool,\n");
    let check = pivot_check(file, &mut body)?;
    values.push(format!("positive_definite: {FLOW_EVEN}{check}{CLOSE}"));
    let numbers = !casts.is_empty();
    let head = format!(
        "/// What depends on the parameters alone: prepare once, use in every call.\n\
         #[derive(Clone, Copy, Debug, PartialEq)]\n\
         pub struct Coefficients{} {{",
        declared(numbers)
    );
    casts.push("positive_definite: self.positive_definite".to_owned());
    let prepare = preparation(file, &(body.statements() + &literal("Self", &values)));
    let generic = if numbers {
        "impl<T: Scalar> Coefficients<T> {"
    } else {
        "impl Coefficients {"
    };
    let cast = if numbers {
        cast("Coefficients", "these coefficients", &casts)
    } else {
        String::new()
    };
    Ok(block(&head, &fields, "}") + &block(generic, &prepare, "}") + &cast)
}

/// The function that prepares the coefficients by these statements. Where no coefficient is a
/// number, the parameters alone say of which type the numbers are, or nobody does.
fn preparation(file: &File<'_>, statements: &str) -> String {
    let parameters = file.generic("Parameters");
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
        "/// The coefficients of these parameters.\n{unused}\
         pub fn prepare{own}(parameters: &{parameters}) -> Self {{"
    );
    let nobody = !with_coefficients && !with_parameters && statements.contains("T::");
    let declared = if nobody { "type T = f64;\n" } else { "" };
    block(&opening, &format!("{declared}{statements}"), "}")
}

fn preparation_roots(file: &File<'_>) -> Vec<ValueId> {
    file.fields
        .iter()
        .chain(&file.program.pivots)
        .copied()
        .collect()
}

fn pivot_check(file: &File<'_>, body: &mut Body<'_>) -> Emitted<Expression> {
    let mut check: Option<Expression> = None;
    for (place, id) in file.program.pivots.iter().enumerate() {
        let conditions = match file.program.value(*id).extent {
            Extent::Scalar => is_positive(&body.scalar(*id)?).to_vec(),
            extent => {
                let name = format!("positive_{}", place + 1);
                let (element, length) = match extent {
                    Extent::Matrix(rows, _) => {
                        (Expression::element(&body.numbers(*id)?, "i][i"), rows)
                    }
                    other => (body.element(*id)?, other.length()),
                };
                let [above, below] = is_positive(&element);
                let flag = Expression::atom(name.as_str());
                let all = Expression::and(&Expression::and(&flag, &above), &below);
                body.push(&format!("let mut {name} = true;"));
                body.push_loop("i", length, &assignment(&name, all));
                vec![flag]
            }
        };
        for condition in conditions {
            check = Some(match check {
                Some(check) => Expression::and(&check, &condition),
                None => condition,
            });
        }
    }
    Ok(check.unwrap_or_else(|| Expression::atom("true")))
}

/// A documented field of a struct.
fn field(quantity: &Quantity, origin: &str) -> Emitted<String> {
    let name = identifier(&quantity.name)?;
    let docs = doc(&[quantity_line(&quantity.doc, &quantity.unit, origin)]);
    Ok(format!("{docs}pub {name}: T,\n"))
}

/// Whether a pivot is positive and finite.
fn is_positive(pivot: &Expression) -> [Expression; 2] {
    let greater = |a: &Expression, b: &Expression| {
        Expression::call("T::all_greater", &[a.clone(), b.clone()])
    };
    [
        greater(pivot, &Expression::number(0.0)),
        greater(&Expression::number(f64::INFINITY), pivot),
    ]
}

/// The type parameter of a struct that holds numbers.
fn declared(numbers: bool) -> &'static str {
    if numbers { "<T = f64>" } else { "" }
}

/// The conversion of a struct of `f64` to one of another scalar type, field by field.
fn cast(name: &str, what: &str, fields: &[String]) -> String {
    if fields.is_empty() {
        return String::new();
    }
    let opening = format!(
        "/// The numbers of {what} in another type, without derivatives.\n\
         #[inline(always)]\n\
         pub fn cast<T: Scalar>(&self) -> {name}<T> {{"
    );
    let body = block(&opening, &literal(name, fields), "}");
    block(&format!("impl {name} {{"), &body, "}")
}

/// A struct's literal: on one line if it is short.
pub(super) fn literal(name: &str, values: &[String]) -> String {
    let line = format!("{name} {{ {} }}\n", values.join(", "));
    let width = line
        .chars()
        .filter(|c| !c.is_control() || *c == SPACE)
        .count();
    if values.is_empty() {
        return format!("{name} {{}}\n");
    }
    if width <= LITERAL_WIDTH + 2 {
        return line;
    }
    let lines: String = values.iter().map(|value| format!("{value},\n")).collect();
    block(&format!("{name} {{"), &lines, "}")
}
