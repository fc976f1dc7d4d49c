//! The emitted functions that are called with prepared coefficients, one per stage.

use super::body::{Body, looped};
use super::emit_error::Emitted;
use super::expression::{array, assignment, infix};
use super::file::{File, quantity_line};
use super::functions::Needed;
use super::literals::doc;
use super::roots::mass_roots;
use super::rows::write_row_values;
use super::signature::{ORDER, Signature, stage, stage_with};
use crate::program::{Extent, Op, ValueId};
use eomgen_model_spec::ids::FieldId;

/// Of a mass matrix that varies with the state.
const NOT_DEFINITE: &str = "///\n\
    /// The mass matrix varies with the state. Where it is not positive definite, rates of velocities \
    are\n/// NaN, though [`Coefficients::positive_definite`], which knows the parameters alone, is true.\n";

/// The most numbers whose copy every compiler writes out: one cache line.
const COPIED_AT_ONCE: usize = 8;

/// The rates written to where the caller wants them, and the same returned: what is
/// returned has to be filled with zeros first.
pub(super) fn rates(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let body = file.body(&file.program.accelerations.all(), needed)?;
    let written = stage_with(
        file,
        &format!(
            "/// Rates of the state, written to `rates`.\n///\n/// {ORDER}\n{}\
             #[allow(unused_variables)]\n",
            where_not_definite(file)
        ),
        &Signature {
            arguments: "rates: &mut [T; STATES],\n",
            ..Signature::of("rates_into", "")
        },
        &rates_statements(file, body)?,
    );
    let call = format!(
        "let mut rates = [T::number(0.0); STATES];\n\
         {}rates_into(t, state, inputs, coefficients, &mut rates);\n\
         rates\n",
        file.inlined()
    );
    let head = format!(
        "/// Rates of the state, returned.\n///\n/// {ORDER}\n{}",
        where_not_definite(file)
    );
    Ok(written + &stage(file, &head, "rates", "[T; STATES]", &call))
}

/// What is said of rates where the mass matrix may lose its definiteness.
pub(super) fn where_not_definite(file: &File<'_>) -> &'static str {
    if file.program.may_lose_definiteness() {
        NOT_DEFINITE
    } else {
        ""
    }
}

/// The statements that write the rates out of a body that has their values.
pub(super) fn rates_statements(file: &File<'_>, mut body: Body<'_>) -> Emitted<String> {
    let degrees = file.program.degrees_of_freedom();
    write_rates_of_positions(file, &mut body);
    write_row_values(
        file,
        &mut body,
        "rates",
        degrees,
        &file.program.accelerations,
    )?;
    Ok(body.statements())
}

/// The first half of the rates stands in the state. Many numbers are copied two in a turn:
/// one by one the compiler takes the loop for a copy of memory and calls a function for
/// it, which costs more than the copy. For few it writes the copy out.
fn write_rates_of_positions(file: &File<'_>, body: &mut Body<'_>) {
    let degrees = file.program.degrees_of_freedom();
    if degrees <= COPIED_AT_ONCE {
        let from = infix("+", degrees, "i");
        body.push_loop("i", degrees, &format!("rates[i] = state[{from}];"));
        return;
    }
    let from = |first: usize| infix("+", first, "2 * k");
    let pair = format!(
        "rates[2 * k] = state[{}];\nrates[2 * k + 1] = state[{}];",
        from(degrees),
        from(degrees + 1)
    );
    body.push_loop("k", degrees / 2, &pair);
    if degrees % 2 == 1 {
        let last = degrees - 1;
        body.push(&format!("rates[{last}] = state[{}];", degrees + last));
    }
}

pub(super) fn observables(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let program = file.program;
    let ids = &program.observable_values;
    let mut body = file.body(ids, needed)?;
    let values = ids
        .iter()
        .map(|id| body.scalar(*id))
        .collect::<Emitted<Vec<_>>>()?;
    body.push(&array(&values));
    let mut lines = Vec::new();
    for observable in &program.observables {
        lines.push(format!(
            "- `{}`: {}",
            observable.name,
            quantity_line(&observable.doc, &observable.unit, "")
        ));
    }
    let mut text = stage(
        file,
        &format!(
            "/// The observables, in the order of [`OBSERVABLE_NAMES`]:\n///\n\
             {}#[allow(unused_variables)]\n",
            doc(&lines)
        ),
        "observables",
        "[T; OBSERVABLES]",
        &body.statements(),
    );
    for (name, id, line) in [
        (
            "energy",
            ids.len() - 2,
            "Kinetic plus potential energy, in J.",
        ),
        (
            "power",
            ids.len() - 1,
            "Power of all non-conservative forces, in W: the rate of the energy.",
        ),
    ] {
        text.push_str(&scalar_function(file, name, line, ids[id], needed)?);
    }
    Ok(text)
}

fn scalar_function(
    file: &File<'_>,
    name: &str,
    line: &str,
    id: ValueId,
    needed: &mut Needed,
) -> Emitted<String> {
    let mut body = file.body(&[id], needed)?;
    let value = body.scalar(id)?;
    body.push(&value.to_string());
    let head = format!("/// {line}\n#[allow(unused_variables)]\n");
    Ok(stage(file, &head, name, "T", &body.statements()))
}

pub(super) fn guards(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let ids: Vec<ValueId> = file.program.guards.iter().map(|g| g.value).collect();
    let line = "Switching surfaces: the equations change where one of these changes sign.";
    guard_values(file, "guards", line, &ids, needed)
}

/// A function that returns a value for each guard.
pub(super) fn guard_values(
    file: &File<'_>,
    name: &str,
    line: &str,
    ids: &[ValueId],
    needed: &mut Needed,
) -> Emitted<String> {
    let program = file.program;
    let mut body = file.body(ids, needed)?;
    body.push("let mut values = [T::number(0.0); GUARDS];");
    let mut place = 0;
    let mut lines = vec![line.to_owned(), String::new()];
    for (guard, id) in program.guards.iter().zip(ids) {
        match program.value(guard.value).extent {
            Extent::Vector(length) => {
                let value = body.element(*id)?;
                let at = infix("+", place, "i");
                body.push_loop("i", length, &assignment(&format!("values[{at}]"), value));
                place += length;
            }
            _ => {
                let value = body.scalar(*id)?;
                body.push(&assignment(&format!("values[{place}]"), value));
                place += 1;
            }
        }
        lines.push(format!("- `{}`", guard.formula));
    }
    body.push("values");
    Ok(stage(
        file,
        &format!("{}#[allow(unused_variables, unused_mut)]\n", doc(&lines)),
        name,
        "[T; GUARDS]",
        &body.statements(),
    ))
}

pub(super) fn mass_matrix(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let program = file.program;
    let roots = mass_roots(program);
    let mut body = file.body(&roots, needed)?;
    body.push("let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];");
    for (row, entries) in program.mass.scalars.iter().enumerate() {
        for (column, id) in entries.iter().enumerate() {
            if matches!(program.value(*id).op, Op::Constant(0.0)) {
                continue;
            }
            let value = body.scalar(*id)?;
            body.push(&assignment(&format!("values[{row}][{column}]"), value));
        }
    }
    write_coupling(file, &mut body)?;
    write_modal_blocks(file, &mut body)?;
    body.push("values");
    Ok(stage(
        file,
        "/// The mass matrix, in the order of the first half of [`STATE_NAMES`].\n\
         #[allow(unused_variables, unused_mut)]\n",
        "mass_matrix",
        "[[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM]",
        &body.statements(),
    ))
}

fn write_coupling(file: &File<'_>, body: &mut Body<'_>) -> Emitted<()> {
    let program = file.program;
    for (row, entries) in program.mass.coupling.iter().enumerate() {
        for (field, id) in FieldId::first(entries.len()).zip(entries) {
            let order = program.fields[field].order;
            if order == 0 || matches!(program.value(*id).op, Op::Constant(0.0)) {
                continue;
            }
            let value = body.element(*id)?;
            let place = infix("+", program.mode_offset(field), "i");
            let entry = format!("values[{row}][{place}]");
            let upper = assignment(&entry, value);
            let lower = assignment(&format!("values[{place}][{row}]"), entry);
            body.push(looped("i", order, &format!("{upper}\n{lower}\n")).trim_end());
        }
    }
    Ok(())
}

fn write_modal_blocks(file: &File<'_>, body: &mut Body<'_>) -> Emitted<()> {
    let program = file.program;
    let fields = FieldId::first(program.fields.len());
    for (row, blocks) in fields.clone().zip(&program.mass.modal) {
        for (column, block) in fields.clone().zip(blocks) {
            let Some(id) = block else { continue };
            let (rows, columns) = (program.fields[row].order, program.fields[column].order);
            if rows == 0 || columns == 0 {
                continue;
            }
            let first_row = program.mode_offset(row);
            let first_column = program.mode_offset(column);
            let place = |i: &str, j: &str| {
                let (row, column) = (infix("+", first_row, i), infix("+", first_column, j));
                format!("values[{row}][{column}]")
            };
            let loops = body.block_loops(&program.value(*id).op, (rows, columns), &place)?;
            body.push(loops.trim_end());
        }
    }
    Ok(())
}
