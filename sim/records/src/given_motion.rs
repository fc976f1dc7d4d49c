//! Requirements on dataset files with given motion and measured forces and torques.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_model_spec::unit::Unit;

use crate::dataset::{Channel, Quantity};
use crate::description::Description;
use crate::description::columns::MotionColumn;
use crate::description::motion::InitialState;
use crate::motion_rates::{GivenColumn, GivenKind};
use crate::units::parse_unit;

pub(crate) fn bind_given_columns<'d>(
    description: &'d Description,
    model: &Model,
    found: &mut Diagnostics,
) -> Vec<GivenColumn<'d>> {
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
                Diagnostic::error(format!("the model has no coordinate {}", quote(name)))
                    .with_span(given.name.span, "expected the name of a coordinate")
                    .with_help(did_you_mean(name, own()).unwrap_or(listed)),
            );
        }
    }
    let more = (model.fields.iter().map(|field| field.name.as_str()))
        .chain(model.states.iter().map(|state| state.name.as_str()));
    for name in more {
        found.push(
            Diagnostic::error(format!(
                "[motion] cannot give the motion of {}",
                quote(name)
            ))
            .with_span(
                first.name.span,
                "[motion] requires a model with coordinates only",
            )
            .with_help(
                "remove [motion]; list forces as [inputs] and measured quantities as [channels]",
            ),
        );
    }
    if let Some(constraint) = model.constraints.first() {
        found.push(
            Diagnostic::error(format!(
                "[motion] cannot be used with constraints, such as {}",
                quote(&constraint.name)
            ))
            .with_span(
                first.name.span,
                "the accelerations of all coordinates do not determine the inputs",
            )
            .with_help(
                "use the motion as [channels] and the forces as [inputs], or write the model in independent \
                 coordinates",
            ),
        );
    }
    if !matches!(description.initial, InitialState::Estimate) {
        found.push(
            Diagnostic::error("[initial] is not used if the motion is given")
                .with_span(first.name.span, "the motion is given here")
                .with_help("remove [initial]"),
        );
    }
    let mut columns = Vec::with_capacity(model.coordinates.len());
    for coordinate in &model.coordinates {
        let mut given = description.motion.iter();
        match given.find(|given| given.name.text == coordinate.name) {
            Some(given) => {
                let start = find_initial_position(model, &coordinate.name);
                columns.extend(found.push_error(bind_given_column(given, &coordinate.unit, start)));
            }
            None if found.list().len() == before => found.push(
                Diagnostic::error(format!(
                    "the motion of {} is not given",
                    quote(&coordinate.name)
                ))
                .with_span(first.name.span, "give either all coordinates or none")
                .with_help(format!("write [motion.{}]", coordinate.name)),
            ),
            None => {}
        }
    }
    columns
}

/// Returns the column of a coordinate whose unit is `own`. The unit of the column decides between position and speed.
/// `initial` is the default position at the first sample.
fn bind_given_column<'d>(
    given: &'d MotionColumn,
    own: &Unit,
    initial: f64,
) -> Result<GivenColumn<'d>, Diagnostic> {
    let written = &given.column.unit;
    let of_speed = format!("{own}/s");
    let kind_and_unit = |kind: GivenKind, unit: Unit| GivenColumn {
        name: &given.name.text,
        column: &given.column,
        unit,
        kind,
    };
    if let Ok(unit) = parse_unit(written, &of_speed) {
        if given.column.wrap.is_some() {
            return Err(
                Diagnostic::error("`wrap` is not used: a speed does not wrap around")
                    .with_span(written.span, "this is the unit of a speed")
                    .with_help("remove `wrap`, or give the unit of a position"),
            );
        }
        let initial = given.initial.map_or(initial, |number| number.value);
        return Ok(kind_and_unit(GivenKind::Speed { initial }, unit));
    }
    let unit = parse_unit(written, &own.to_string()).map_err(|wrong| {
        wrong.with_help(format!("a position is in {own}, a speed in {of_speed}"))
    })?;
    match given.initial {
        Some(number) => Err(Diagnostic::error(
            "`initial` is not used: the column contains the position",
        )
        .with_span(number.span, "only for a column of speeds")
        .with_related_span(written.span, "this is the unit of a position")
        .with_help(format!(
            "remove `initial`, or give the unit of a speed, such as {of_speed}"
        ))),
        None => Ok(kind_and_unit(GivenKind::Position, unit)),
    }
}

/// Returns the initial position of a coordinate in the specification, in SI; 0 by default.
fn find_initial_position(model: &Model, coordinate: &str) -> f64 {
    let place = model.coordinates.iter().position(|c| c.name == coordinate);
    let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
    let state = model.initial_state(&orders).unwrap_or_default();
    place
        .and_then(|place| state.get(place).copied())
        .unwrap_or(0.0)
}

pub(crate) fn list_speed_notes(
    columns: &[GivenColumn<'_>],
    description: &Description,
) -> Vec<String> {
    let is_stated = |name: &str| {
        let mut given = description.motion.iter();
        given.any(|given| given.name.text == name && given.initial.is_some())
    };
    let unstated = columns.iter().filter(|column| !is_stated(column.name));
    let note = |column: &GivenColumn<'_>| match column.kind {
        GivenKind::Position => None,
        GivenKind::Speed { initial } => Some(format!(
            "the position of `{name}` is integrated from its speed and starts at {initial} (SI) in every file; if the \
             model depends on the position, set initial in [motion.{name}]",
            name = column.name
        )),
    };
    unstated.filter_map(note).collect()
}

/// Checks that a channel is admissible. With given motion, a channel measures an input or a quantity of the motion.
pub(crate) fn check_channel(
    quantity: Quantity,
    gives_motion: bool,
    asked: &str,
    span: Span,
) -> Result<(), Diagnostic> {
    let wrong = match (quantity, gives_motion) {
        (Quantity::Input(_), false) => Diagnostic::error(format!(
            "{} is an input of the model: it can be a channel only if the motion is given",
            quote(asked)
        ))
        .with_span(span, "the model does not compute this quantity")
        .with_help(
            "give the motion of every coordinate in [motion.NAME], or list the column under [inputs]",
        ),
        (Quantity::State(_), true) => {
            Diagnostic::error(format!("{} does not follow from the motion of the coordinates", quote(asked)))
                .with_span(span, "first-order states are not computed along a given motion")
                .with_help("remove [motion], and list the coordinates as channels")
        }
        (Quantity::Coordinate(_) | Quantity::Rate(_) | Quantity::Acceleration(_), true) => {
            Diagnostic::error(format!("{} is given by [motion]", quote(asked)))
                .with_span(span, "a channel cannot measure a given quantity")
                .with_help("remove the channel; list the torques and forces that drive the machine as channels")
        }
        _ => return Ok(()),
    };
    Err(wrong)
}

/// Checks that one input per coordinate is measured, and that no measured input is also given.
pub(crate) fn check_required_inputs(
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
                    "{} is both an input and a channel",
                    quote(&column.name.text)
                ))
                .with_span(
                    column.name.span,
                    "this input is computed from the given motion",
                )
                .with_help("remove it from [inputs]"),
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
                "measured inputs: {inputs}, coordinates: {coordinates}; a given motion requires one measured \
                 input per coordinate"
            ))
            .with_span(first.name.span, "the motion is given here")
            .with_help("add a channel for each torque or force that drives the machine, with observable = \"INPUT\""),
        );
    }
}
