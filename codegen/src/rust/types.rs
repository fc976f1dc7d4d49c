//! The emitted types: parameters, inputs, and the coefficients with their preparation.

use super::body::{Access, Body};
use super::expression::{Expression, assignment};
use super::file::{Emitted, File, quantity_line};
use super::functions::Needed;
use super::layout::{CLOSE, FLOW_EVEN, SPACE};
use super::literals::{block, doc, identifier, number};
use crate::describe::describe_value;
use crate::program::{Extent, Quantity};

/// The most characters of a struct's literal that is written on one line.
const LITERAL_WIDTH: usize = 34;

impl File<'_> {
    pub(super) fn parameters(&self) -> Emitted<String> {
        let mut fields = String::new();
        let mut defaults = Vec::new();
        for parameter in &self.program.parameters {
            fields.push_str(&field(&parameter.quantity, &parameter.origin)?);
            let value = number(parameter.value);
            defaults.push(format!("{}: {value}", parameter.quantity.name));
        }
        let head = "/// Parameters of the model. `Default` gives the specification's values.\n\
                    #[derive(Clone, Copy, Debug, PartialEq)]\n\
                    pub struct Parameters {";
        let default = block("fn default() -> Self {", &literal("Self", &defaults), "}");
        Ok(block(head, &fields, "}") + &block("impl Default for Parameters {", &default, "}"))
    }

    pub(super) fn inputs(&self) -> Emitted<String> {
        let mut fields = String::new();
        for input in &self.program.inputs {
            fields.push_str(&field(input, "")?);
        }
        let head = "/// Signals supplied at run time. `Default` gives zeros.\n\
                    #[derive(Clone, Copy, Debug, Default, PartialEq)]\n\
                    pub struct Inputs {";
        Ok(block(head, &fields, "}"))
    }

    pub(super) fn coefficients(&self, needed: &mut Needed) -> Emitted<String> {
        let mut body = Body::new(
            self.program,
            Access::Prepare,
            &self.prepared_roots(),
            needed,
        )?;
        let mut fields = String::new();
        let mut values = Vec::new();
        for id in &self.fields {
            let name = &self.field_names[id];
            fields.push_str(&doc(&[describe_value(self.program, *id)]));
            let (field_type, value) = match self.program.value(*id).extent {
                Extent::Scalar => ("f64".to_owned(), body.scalar(*id)?.to_string()),
                Extent::Vector(n) => (format!("[f64; {n}]"), body.array(*id)?),
                Extent::Matrix(rows, columns) => {
                    (format!("[[f64; {columns}]; {rows}]"), body.array(*id)?)
                }
            };
            fields.push_str(&format!("pub {name}: {field_type},\n"));
            values.push(format!("{name}: {FLOW_EVEN}{value}{CLOSE}"));
        }
        fields.push_str(
            "/// Whether all prepared pivots of the mass matrix are positive and finite. If not, \
             the mass matrix is not positive definite and the rates are not to be used.\n\
             pub positive_definite: bool,\n",
        );
        let check = self.pivot_check(&mut body)?;
        values.push(format!("positive_definite: {FLOW_EVEN}{check}{CLOSE}"));
        let head = "/// What depends on the parameters alone: prepare once, use in every call.\n\
                    #[derive(Clone, Copy, Debug, PartialEq)]\n\
                    pub struct Coefficients {";
        let unused = if self.program.parameters.is_empty() {
            "#[allow(unused_variables)]\n"
        } else {
            ""
        };
        let opening = format!(
            "/// The coefficients of these parameters.\n{unused}\
             pub fn prepare(parameters: &Parameters) -> Self {{"
        );
        let statements = body.statements() + &literal("Self", &values);
        let prepare = block(&opening, &statements, "}");
        Ok(block(head, &fields, "}") + &block("impl Coefficients {", &prepare, "}"))
    }

    fn prepared_roots(&self) -> Vec<crate::program::ValueId> {
        self.fields
            .iter()
            .chain(&self.program.pivots)
            .copied()
            .collect()
    }

    fn pivot_check(&self, body: &mut Body<'_>) -> Emitted<Expression> {
        let mut check: Option<Expression> = None;
        for (place, id) in self.program.pivots.iter().enumerate() {
            let conditions = match self.program.value(*id).extent {
                Extent::Scalar => is_positive(&body.scalar(*id)?).to_vec(),
                extent => {
                    let name = format!("positive_{}", place + 1);
                    let (element, length) = match extent {
                        Extent::Matrix(rows, _) => {
                            (Expression::element(&body.array(*id)?, "i][i"), rows)
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
}

/// A documented field of a struct.
fn field(quantity: &Quantity, origin: &str) -> Emitted<String> {
    let name = identifier(&quantity.name)?;
    let docs = doc(&[quantity_line(&quantity.doc, &quantity.unit, origin)]);
    Ok(format!("{docs}pub {name}: f64,\n"))
}

/// Whether a pivot is positive and finite.
fn is_positive(pivot: &Expression) -> [Expression; 2] {
    [(">", "0.0"), ("<", "f64::INFINITY")]
        .map(|(operator, bound)| Expression::compare(operator, pivot, &Expression::atom(bound)))
}

/// A struct's literal: on one line if it is short.
fn literal(name: &str, values: &[String]) -> String {
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
