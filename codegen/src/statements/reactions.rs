//! Stages of fixed-length steps with dry friction that can stick, and with contacts.

use super::body::Body;
use super::emit_error::EmitResult;
use super::file::File;
use super::index::Index;
use super::needed::RequiredFunctions;
use super::rows::write_row_values;
use super::stage::{Argument, Outcome, Size, Stage};
use super::stages::{RATES_ORDER_DOC, build_rates_stage};
use super::statement::Place;
use crate::program::{ProgramReactions, ValueId};

/// Builds the stages: rates with given sides of the frictions, and the functions and effects of the reactions.
pub(super) fn build_reaction_stages(
    file: &File<'_>,
    known: &ProgramReactions,
    needed: &mut RequiredFunctions,
) -> EmitResult<Vec<Stage>> {
    let mut stages = Vec::new();
    if known.sides() > 0 {
        stages.push(build_rates_with_sides(file, known, needed)?);
    }
    stages.push(functions(file, known, needed)?);
    stages.push(effects(file, known, needed)?);
    Ok(stages)
}

fn build_rates_with_sides(
    file: &File<'_>,
    known: &ProgramReactions,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let body = file.body(&known.rate_roots(), needed)?;
    let rates = (&known.accelerations, &known.first_order_rates[..]);
    let doc = format!(
        "Rates of the state with given sides of the frictions that can hold the motion, written to\n\
         `rates`. A side is 1 for the friction of a positive velocity, 0 for that of a negative one,\n\
         and between them while the friction holds the motion.\n\n{RATES_ORDER_DOC}"
    );
    Ok(Stage {
        arguments: vec![Argument::Sides],
        ..build_rates_stage(body, rates, "rates_with_sides", doc)?
    })
}

fn functions(
    file: &File<'_>,
    known: &ProgramReactions,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let roots = known.function_roots();
    let mut body = file.body(&roots, needed)?;
    let computed = body.take_statements();
    write_scalars(&mut body, 0, &roots)?;
    let doc = "Functions that the reactions of a step keep at zero: velocities of the frictions that can\n\
               hold the motion, rates of the distances of the contacts, and their slips. Then the\n\
               distances.";
    array(
        body,
        ("reaction_functions", doc),
        Size::ReactionFunctions,
        computed,
    )
}

fn effects(
    file: &File<'_>,
    known: &ProgramReactions,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let mut body = file.body(&known.effect_roots(), needed)?;
    let computed = body.take_statements();
    let coefficients = known
        .coefficients
        .iter()
        .map(|(_, coefficient)| *coefficient);
    let scalars = known.effects.iter().chain(&known.restitutions).copied();
    let scalars: Vec<ValueId> = scalars.chain(coefficients).collect();
    write_scalars(&mut body, 0, &scalars)?;
    let degrees = file.program.degrees_of_freedom();
    let mut first = scalars.len();
    for (rates, first_order) in &known.columns {
        write_row_values(&mut body, "values", first, rates)?;
        write_scalars(&mut body, first + degrees, first_order)?;
        first += degrees + first_order.len();
    }
    let doc = "Effects of the reactions of a step: the change of each function by a unit of each reaction,\n\
               row by row; the coefficients of restitution and of friction of the contacts; for each\n\
               reaction the change of the rates of the state by a unit.";
    array(
        body,
        ("reaction_effects", doc),
        Size::ReactionEffects,
        computed,
    )
}

fn write_scalars(body: &mut Body<'_>, first: usize, ids: &[ValueId]) -> EmitResult<()> {
    for (place, id) in ids.iter().enumerate() {
        let value = body.scalar(*id)?;
        body.assign(Place::new("values", [Index::Number(first + place)]), value);
    }
    Ok(())
}

fn array(
    mut body: Body<'_>,
    (name, doc): (&'static str, &str),
    size: Size,
    computed: Vec<super::statement::Statement>,
) -> EmitResult<Stage> {
    Ok(Stage {
        name,
        doc: doc.to_owned(),
        list: Vec::new(),
        arguments: Vec::new(),
        outcome: Outcome::Array("values", size),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}
