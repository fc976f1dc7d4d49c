//! Preparation of the coefficients, which depend only on the parameters.

use std::collections::HashMap;

use super::body::{Access, Body};
use super::emit_error::EmitResult;
use super::expression::{Array, Expression};
use super::file::File;
use super::index::Index;
use super::needed::RequiredFunctions;
use super::sides::Switches;
use super::stage::Notes;
use super::statement::{Place, Statement};
use crate::program::describe::describe_value;
use crate::program::{Extent, ValueId};

/// Coefficient.
#[derive(Clone, Debug, PartialEq)]
pub enum PreparedValue {
    /// Scalar.
    Number(Expression),
    /// Vector or matrix.
    Numbers(Array),
}

/// Statements and results of the preparation.
#[derive(Clone, Debug)]
pub struct Preparation {
    /// Statements that compute the coefficients.
    pub computed: Vec<Statement>,
    /// Coefficients, in the order of [`File::fields`].
    pub coefficients: Vec<PreparedValue>,
    /// Condition that all pivots of prepared factorisations are positive and finite.
    pub positive_definite: Expression,
    /// Names of the intermediate values.
    pub names: HashMap<ValueId, String>,
    /// Units and terms of the intermediate values.
    pub notes: Notes,
}

/// Builds the preparation of the coefficients of a file.
pub fn build_preparation(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Preparation> {
    let roots = file.fields.iter().chain(&file.program.pivots);
    let roots: Vec<ValueId> = roots.copied().collect();
    let access = Access::Prepare;
    let none = Switches::new();
    let mut body = Body::new(file.program, file.names(), access, &roots, needed, none)?;
    let mut coefficients = Vec::new();
    for id in &file.fields {
        coefficients.push(match file.program.value(*id).extent {
            Extent::Scalar => PreparedValue::Number(body.scalar(*id)?),
            _ => PreparedValue::Numbers(body.numbers(*id)?),
        });
    }
    let positive_definite = build_pivot_check(file, &mut body)?;
    Ok(Preparation {
        computed: body.take_statements(),
        coefficients,
        positive_definite,
        names: body.take_names(),
        notes: body.take_notes(),
    })
}

fn build_pivot_check(file: &File<'_>, body: &mut Body<'_>) -> EmitResult<Expression> {
    let mut check: Option<Expression> = None;
    for (place, id) in file.program.pivots.iter().enumerate() {
        let conditions = match file.program.value(*id).extent {
            Extent::Scalar => is_positive(&body.scalar(*id)?).to_vec(),
            extent => {
                let name = format!("positive_{}", place + 1);
                let (element, length) = match extent {
                    Extent::Matrix(rows, _) => {
                        let diagonal = ["i", "i"].map(Index::Variable).to_vec();
                        (Expression::Element(body.numbers(*id)?, diagonal), rows)
                    }
                    other => (body.element(*id)?, other.length()),
                };
                let [above, below] = is_positive(&element);
                let flag = Expression::Flag(name.clone());
                let all = Expression::and(Expression::and(flag.clone(), above), below);
                body.push(Statement::Flag(name.clone()));
                body.assign_each(length, Place::new(name, []), all);
                vec![flag]
            }
        };
        for condition in conditions {
            check = Some(match check {
                Some(check) => Expression::and(check, condition),
                None => condition,
            });
        }
    }
    Ok(check.unwrap_or(Expression::True))
}

/// Returns the conditions that a pivot is positive and finite.
fn is_positive(pivot: &Expression) -> [Expression; 2] {
    [
        Expression::greater(pivot.clone(), Expression::Number(0.0)),
        Expression::greater(Expression::Number(f64::INFINITY), pivot.clone()),
    ]
}

/// Returns formula, unit and terms of a coefficient on one line.
pub fn describe_coefficient(file: &File<'_>, prepared: &Preparation, id: ValueId) -> String {
    let formula = describe_value(file.program, id, &|part| {
        prepared.names.get(&part).map(String::as_str)
    });
    match file.program.trace.note(id) {
        Some(note) => format!("{formula} {note}"),
        None => formula,
    }
}
