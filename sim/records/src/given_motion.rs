//! Records that give the motion, with the torques and forces that it takes among the channels: what a
//! dataset file must say of them, and the rates of the motion. What a motion takes is computed elsewhere.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quoted};
use eomgen_model_spec::ids::{CoordinateId, DefinitionId};
use eomgen_model_spec::model::{Expr, ExprKind, Model};
use eomgen_model_spec::span::Span;
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_model_spec::unit::Unit;
use eomgen_sim::cubic_spline::CubicSpline;

use crate::dataset::{Channel, Dataset, Quantity};
use crate::description::Description;
use crate::description::columns::ColumnKey;
use crate::description::motion::InitialState;
use crate::noise;
use crate::record::Record;
use crate::units::unit;

/// A rate of fewer standard deviations of its noise is rest.
const AT_REST: f64 = 4.0;

/// A rate below this part of the record's largest is rest, whatever its noise.
const LEAST_RATE: f64 = 1e-9;

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

/// A coordinate's samples with their rates and second rates, on the cubic spline through those that are
/// known; none if nothing is.
pub(crate) fn with_rates(times: &[f64], column: &[f64]) -> Option<[Vec<f64>; 3]> {
    let samples = times.iter().zip(column);
    let known = samples.filter(|(_, value)| value.is_finite());
    let (at, values) = known.map(|(t, value)| (*t, *value)).unzip();
    let spline = CubicSpline::through(at, values)?;
    let mut found = [const { Vec::new() }; 3];
    for t in times {
        for (column, value) in found.iter_mut().zip(spline.at(*t)) {
            column.push(value);
        }
    }
    Some(found)
}

/// Leaves out of the channels what was measured at rest: friction may hold any load there, and which
/// one it is no model says. An input is left out where a coordinate that it works on rests. Returns
/// what is worth a remark.
pub(crate) fn without_rest(dataset: &mut Dataset, model: &Model) -> Vec<String> {
    let mut notes = Vec::new();
    for place in 0..dataset.channels.len() {
        let Quantity::Input(input) = dataset.channels[place].quantity else {
            continue;
        };
        let coordinates = worked_on(model, input);
        let name = &dataset.channels[place].name;
        for record in dataset.train.iter_mut().chain(&mut dataset.test) {
            let resting = at_rest(record, model, &coordinates);
            let mut count = 0;
            for (value, rests) in record.channels[place].iter_mut().zip(resting) {
                if rests && value.is_finite() {
                    *value = f64::NAN;
                    count += 1;
                }
            }
            if count > 0 {
                notes.push(format!(
                    "{}: {count} of {} samples of `{name}` are left out: at rest and beside it friction may hold any load",
                    record.name,
                    record.times.len()
                ));
            }
        }
    }
    notes
}

/// The coordinates on which an input works.
fn worked_on(model: &Model, input: usize) -> Vec<usize> {
    let mut found = Vec::new();
    for force in &model.forces {
        if !holds(
            model,
            &force.value,
            &|kind| matches!(kind, ExprKind::Input(id) if id.index() == input),
        ) {
            continue;
        }
        for coordinate in 0..model.coordinates.len() {
            let is = |kind: &ExprKind| matches!(kind, ExprKind::Coordinate(id) if *id == CoordinateId::new(coordinate));
            if !found.contains(&coordinate) && holds(model, &force.on, &is) {
                found.push(coordinate);
            }
        }
    }
    found
}

/// Whether an expression holds such a part, through definitions.
fn holds(model: &Model, expr: &Expr, is: &dyn Fn(&ExprKind) -> bool) -> bool {
    let mut found = false;
    let mut definitions: Vec<DefinitionId> = Vec::new();
    let mut look = |expr: &Expr, definitions: &mut Vec<DefinitionId>| {
        expr.visit(&mut |part| {
            found |= is(&part.kind);
            if let ExprKind::Definition(id) = part.kind
                && !definitions.contains(&id)
            {
                definitions.push(id);
            }
        });
    };
    look(expr, &mut definitions);
    let mut next = 0;
    while let Some(id) = definitions.get(next).copied() {
        look(&model.definitions[id].value, &mut definitions);
        next += 1;
    }
    found
}

/// For each sample of a record whether one of these coordinates rests, or turns back beside it: which
/// way friction acts there is not known.
fn at_rest(record: &Record, model: &Model, coordinates: &[usize]) -> Vec<bool> {
    let (inputs, count) = (model.inputs.len(), model.coordinates.len());
    let mut resting = vec![false; record.times.len()];
    for coordinate in coordinates {
        let rates = record.given_rate(*coordinate, count, inputs);
        let largest = rates
            .iter()
            .fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let noise = noise::estimated(&rates).unwrap_or(0.0);
        let least = (AT_REST * noise).max(LEAST_RATE * largest);
        for (sample, rests) in resting.iter_mut().enumerate() {
            let near = sample.saturating_sub(1)..(sample + 2).min(rates.len());
            let turns = rates[near].windows(2).any(|pair| pair[0] * pair[1] <= 0.0);
            *rests |= rates[sample].abs() <= least || turns;
        }
    }
    resting
}
