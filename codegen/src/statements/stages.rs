//! Stages of every file: rates, observables, guards, mass matrix.

use super::body::Body;
use super::emit_error::EmitResult;
use super::expression::Expression;
use super::file::{File, describe_quantity};
use super::index::Index;
use super::needed::RequiredFunctions;
use super::roots::collect_mass_roots;
use super::rows::write_row_values;
use super::stage::{Outcome, Size, Stage};
use super::statement::{Place, Statement};
use crate::program::{Extent, Op, Program, RowValues, ValueId};
use eomgen_model_spec::ids::FieldId;

/// Documentation of the arguments and results of the rates.
pub const RATES_ORDER_DOC: &str =
    "`t` in s; `state` and the rates in the order of [`STATE_NAMES`].";

const NOT_DEFINITE: &str = "\n\n\
    The mass matrix varies with the state. If it is not positive definite, rates of velocities are\n\
    NaN, even if [`Coefficients::positive_definite`], which depends only on the parameters, is true.";

const BETWEEN_CORNERS: &str = "\n\n\
    These are the rates between corners of the motion. Where the energies of the specification jump,\n\
    rates of coordinates jump, too. Those jumps are not included; `eomgen simulate` applies them.";

const BETWEEN_IMPACTS: &str = "\n\n\
    These are the rates between impacts. Impacts and closed contacts of the specification are not\n\
    included.";

/// Largest copy, in numbers, that every compiler unrolls: one cache line.
const MAX_UNROLLED_COPY: usize = 8;

/// Builds the stage of the rates.
pub fn build_rates(file: &File<'_>, needed: &mut RequiredFunctions) -> EmitResult<Stage> {
    let body = file.body(&file.program.rate_roots(), needed)?;
    let program = file.program;
    build_rates_stage(
        body,
        (&program.accelerations, &program.first_order_rates),
        "rates_into",
        format!(
            "Rates of the state, written to `rates`.\n\n{RATES_ORDER_DOC}{}",
            describe_rate_limits(file)
        ),
    )
}

/// Describes the limits of the rates: an indefinite mass matrix and impacts.
pub fn describe_rate_limits(file: &File<'_>) -> String {
    let mut said = String::new();
    if file.program.may_lose_definiteness() {
        said += NOT_DEFINITE;
    }
    if !file.program.impacts.is_empty() {
        said += BETWEEN_IMPACTS;
    }
    if file.program.guards.iter().any(|guard| guard.is_corner) {
        said += BETWEEN_CORNERS;
    }
    said
}

/// Builds a stage that writes the rates from a body that already contains the values of the accelerations and of the
/// rates of first-order states.
pub(super) fn build_rates_stage(
    mut body: Body<'_>,
    (accelerations, first_order_rates): (&RowValues, &[ValueId]),
    name: &'static str,
    doc: String,
) -> EmitResult<Stage> {
    let degrees = body.program.degrees_of_freedom();
    let computed = body.take_statements();
    write_rates_of_positions(&mut body, degrees);
    write_row_values(&mut body, "rates", degrees, accelerations)?;
    for (place, id) in first_order_rates.iter().enumerate() {
        let value = body.scalar(*id)?;
        body.assign(Place::new("rates", [(2 * degrees + place).into()]), value);
    }
    Ok(Stage {
        name,
        doc,
        list: Vec::new(),
        arguments: Vec::new(),
        outcome: Outcome::Rates,
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

/// Copies the first half of the rates from the state. More than [`MAX_UNROLLED_COPY`] numbers are copied in
/// pairs: from a plain loop the compiler makes a call of `memcpy`, which costs more than the copy.
fn write_rates_of_positions(body: &mut Body<'_>, degrees: usize) {
    let copy = |to: Index, from: Index| {
        let rate = Expression::element("state", [from]);
        Statement::Assign(Place::new("rates", [to]), rate)
    };
    if degrees <= MAX_UNROLLED_COPY {
        let line = copy("i".into(), Index::from_first(degrees, "i"));
        body.push(Statement::loop_over_elements(degrees, line));
        return;
    }
    let twice = || Index::from_multiple(2, "k");
    let lines = vec![
        copy(twice(), Index::from_first(degrees, twice())),
        copy(
            twice().offset_by(1),
            Index::from_first(degrees + 1, twice()),
        ),
    ];
    body.push(Statement::loop_over("k", degrees / 2, lines));
    if degrees % 2 == 1 {
        let last = degrees - 1;
        body.push(copy(last.into(), (degrees + last).into()));
    }
}

/// Builds the stages of the observables, of the energy and of the power.
pub fn build_observables(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Vec<Stage>> {
    let program = file.program;
    let ids = &program.observable_values;
    let mut body = file.body(ids, needed)?;
    let values = ids.iter().map(|id| body.scalar(*id));
    let values = values.collect::<EmitResult<Vec<_>>>()?;
    let lines = program.observables.iter().map(|observable| {
        let line = describe_quantity(&observable.doc, &observable.unit, "");
        format!("- `{}`: {line}", observable.name)
    });
    let all = Stage {
        name: "observables",
        doc: "Observables in the order of [`OBSERVABLE_NAMES`]:\n".to_owned(),
        list: lines.collect(),
        arguments: Vec::new(),
        outcome: Outcome::Observables(values),
        computed: body.take_statements(),
        written: Vec::new(),
        notes: body.take_notes(),
    };
    let (energy, power) = (ids[ids.len() - 2], ids[ids.len() - 1]);
    let energy_line = "Kinetic plus potential energy, in J.";
    let power_line = "Power of all non-conservative forces, in W: the rate of the energy.";
    Ok(vec![
        all,
        number(file, "energy", energy_line, energy, needed)?,
        number(file, "power", power_line, power, needed)?,
    ])
}

fn number(
    file: &File<'_>,
    name: &'static str,
    line: &str,
    id: ValueId,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let mut body = file.body(&[id], needed)?;
    let value = body.scalar(id)?;
    Ok(Stage {
        name,
        doc: line.to_owned(),
        list: Vec::new(),
        arguments: Vec::new(),
        outcome: Outcome::Number(value),
        computed: body.take_statements(),
        written: Vec::new(),
        notes: body.take_notes(),
    })
}

/// Builds the stage of the switching functions.
pub fn build_guards(file: &File<'_>, needed: &mut RequiredFunctions) -> EmitResult<Stage> {
    let ids: Vec<ValueId> = file.program.guards.iter().map(|g| g.value).collect();
    let line = "Switching surfaces: the equations change when one of these changes sign.";
    build_guard_values(file, "guards", line, &ids, needed)
}

/// Builds a stage that writes a value for each guard.
pub(super) fn build_guard_values(
    file: &File<'_>,
    name: &'static str,
    line: &str,
    ids: &[ValueId],
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let program = file.program;
    let mut body = file.body(ids, needed)?;
    let computed = body.take_statements();
    let mut place = 0;
    let mut list = Vec::new();
    for (guard, id) in program.guards.iter().zip(ids) {
        match program.value(guard.value).extent {
            Extent::Vector(length) => {
                let value = body.element(*id)?;
                let at = Place::new("values", [Index::from_first(place, "i")]);
                body.assign_each(length, at, value);
                place += length;
            }
            _ => {
                let value = body.scalar(*id)?;
                body.assign(Place::new("values", [Index::Number(place)]), value);
                place += 1;
            }
        }
        list.push(format!("- `{}`", guard.formula));
    }
    Ok(Stage {
        name,
        doc: format!("{line}\n"),
        list,
        arguments: Vec::new(),
        outcome: Outcome::Array("values", Size::Guards),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

/// Builds the stage of the mass matrix.
pub fn build_mass_matrix(file: &File<'_>, needed: &mut RequiredFunctions) -> EmitResult<Stage> {
    let program = file.program;
    let mut body = file.body(&collect_mass_roots(program), needed)?;
    let computed = body.take_statements();
    for (row, entries) in program.mass.scalars.iter().enumerate() {
        for (column, id) in entries.iter().enumerate() {
            if matches!(program.value(*id).op, Op::Constant(0.0)) {
                continue;
            }
            let value = body.scalar(*id)?;
            body.assign(entry(row, column), value);
        }
    }
    write_coupling(file, &mut body)?;
    write_modal_blocks(file, &mut body)?;
    Ok(Stage {
        name: "mass_matrix",
        doc: describe_by_positions(
            program,
            "Mass matrix in the order of the first half of [`STATE_NAMES`].",
        ),
        list: Vec::new(),
        arguments: Vec::new(),
        outcome: Outcome::MassMatrix,
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

fn entry(row: impl Into<Index>, column: impl Into<Index>) -> Place {
    Place::new("values", [row.into(), column.into()])
}

fn write_coupling(file: &File<'_>, body: &mut Body<'_>) -> EmitResult<()> {
    let program = file.program;
    for (row, entries) in program.mass.coupling.iter().enumerate() {
        for (field, id) in FieldId::first(entries.len()).zip(entries) {
            let order = program.fields[field].order;
            if order == 0 || matches!(program.value(*id).op, Op::Constant(0.0)) {
                continue;
            }
            let value = body.element(*id)?;
            let place = || Index::from_first(program.mode_offset(field), "i");
            let upper = entry(row, place());
            let lower = Statement::Assign(entry(place(), row), upper.value());
            let lines = vec![Statement::Assign(upper, value), lower];
            body.push(Statement::loop_over("i", order, lines));
        }
    }
    Ok(())
}

fn write_modal_blocks(file: &File<'_>, body: &mut Body<'_>) -> EmitResult<()> {
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
            let place = |i: &'static str, j: &'static str| {
                entry(
                    Index::from_first(first_row, i),
                    Index::from_first(first_column, j),
                )
            };
            let loops = body.block_loops(&program.value(*id).op, (rows, columns), &place)?;
            body.push(loops);
        }
    }
    Ok(())
}

/// Adapts a description that refers to the first half of the state. If there are first-order states, coordinates and
/// modes are less than half of the state.
pub(super) fn describe_by_positions(program: &Program, doc: &str) -> String {
    match program.first_order.is_empty() {
        true => doc.to_owned(),
        false => doc.replace("the first half of", "the coordinates and modes in"),
    }
}
