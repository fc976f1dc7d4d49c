//! Records that give the motion, with the torques and forces that it takes among the channels: what a
//! dataset file must say of them. What a motion takes is computed elsewhere.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quoted};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_model_spec::unit::Unit;

use crate::dataset::{Channel, Quantity};
use crate::description::Description;
use crate::description::columns::ColumnKey;
use crate::description::motion::InitialState;
use crate::units::unit;

/// For each coordinate of the model its column and the column's unit; none where no motion is given.
pub(crate) fn columns<'d>(
    description: &'d Description,
    model: &Model,
    found: &mut Diagnostics,
) -> Vec<(&'d ColumnKey, Unit)> {
    let Some(first) = description.motion.first() else {
        return Vec::new();
    };
    let before = found.list().len();
    let own = || model.coordinates.iter().map(|c| c.name.as_str());
    for given in &description.motion {
        let name = given.name.text.as_str();
        if own().all(|coordinate| coordinate != name) {
            let listed = format!("it has {}", own().collect::<Vec<&str>>().join(", "));
            found.push(
                Diagnostic::error(format!("the model has no coordinate {}", quoted(name)))
                    .at(given.name.span, "this motion is nothing's")
                    .help(did_you_mean(name, own()).unwrap_or(listed)),
            );
        }
    }
    let more = (model.fields.iter().map(|field| field.name.as_str()))
        .chain(model.states.iter().map(|state| state.name.as_str()));
    for name in more {
        found.push(
            Diagnostic::error(format!(
                "the motion of {} is not given by coordinates",
                quoted(name)
            ))
            .at(
                first.name.span,
                "[motion] gives the whole motion of a model of coordinates",
            )
            .help("leave [motion] out, with the torques as [inputs] and what moves as [channels]"),
        );
    }
    if !matches!(description.initial, InitialState::Estimate) {
        found.push(
            Diagnostic::error("[initial] says nothing where the motion is given")
                .at(first.name.span, "here it is")
                .help("leave [initial] out"),
        );
    }
    let mut columns = Vec::with_capacity(model.coordinates.len());
    for coordinate in &model.coordinates {
        let mut given = description.motion.iter();
        match given.find(|given| given.name.text == coordinate.name) {
            Some(given) => {
                let unit = found.keep(unit(&given.column.unit, &coordinate.unit.text));
                columns.extend(unit.map(|unit| (&given.column.column, unit)));
            }
            None if found.list().len() == before => found.push(
                Diagnostic::error(format!(
                    "the motion of {} is not given",
                    quoted(&coordinate.name)
                ))
                .at(first.name.span, "this one is, and so must be all")
                .help(format!("write [motion.{}]", coordinate.name)),
            ),
            None => {}
        }
    }
    columns
}

/// Where the motion is given channels measure what it takes, or what a model shows along it.
///
/// # Errors
/// A channel of what is given, and one of an input that is not sought.
pub(crate) fn admitted(
    quantity: Quantity,
    gives_motion: bool,
    asked: &str,
    span: Span,
) -> Result<(), Diagnostic> {
    let wrong = match (quantity, gives_motion) {
        (Quantity::Input(_), false) => Diagnostic::error(format!(
            "{} is an input of the model: it is measured where the motion is given",
            quoted(asked)
        ))
        .at(span, "this channel measures nothing that the model computes")
        .help(
            "give the motion of every coordinate, [motion.NAME], or list the column under [inputs]",
        ),
        (Quantity::State(_), true) => {
            Diagnostic::error(format!("{} follows from the motion of no coordinate", quoted(asked)))
                .at(span, "states of first order are not followed where the motion is given")
                .help("leave [motion] out, and take the coordinates as channels")
        }
        (Quantity::Coordinate(_) | Quantity::Rate(_) | Quantity::Acceleration(_), true) => {
            Diagnostic::error(format!("{} is given by [motion]", quoted(asked)))
                .at(span, "a channel measures what is not given")
                .help("leave the channel out; the torques and forces that move the machine are channels")
        }
        _ => return Ok(()),
    };
    Err(wrong)
}

/// As many inputs are measured as there are coordinates, none of them is given as well.
pub(crate) fn required_inputs(
    description: &Description,
    channels: &[Channel],
    model: &Model,
    found: &mut Diagnostics,
) {
    let mut measured: Vec<usize> = Vec::new();
    for channel in channels {
        if let Quantity::Input(place) = channel.quantity
            && !measured.contains(&place)
        {
            measured.push(place);
        }
    }
    for column in &description.inputs {
        let is_measured = |place: &usize| model.inputs[*place].name == column.name.text;
        if measured.iter().any(is_measured) {
            found.push(
                Diagnostic::error(format!(
                    "{} is an input here and a channel as well",
                    quoted(&column.name.text)
                ))
                .at(
                    column.name.span,
                    "the motion is given: what it takes is computed",
                )
                .help("leave it out here"),
            );
        }
    }
    let (inputs, coordinates) = (measured.len(), model.coordinates.len());
    if inputs != coordinates
        && let Some(first) = description.motion.first()
        && found.is_empty()
    {
        found.push(
            Diagnostic::error(format!(
                "inputs that are measured: {inputs}, coordinates: {coordinates}; what a motion takes is known where \
                 there are as many"
            ))
            .at(first.name.span, "the motion is given here")
            .help("list a channel for each torque or force that moves the machine, with observable = its input"),
        );
    }
}
