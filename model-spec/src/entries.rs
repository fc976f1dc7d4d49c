//! Reads one entry of each section: the required keys and the kinds of their values.

use crate::bases;
use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::model::Basis;
use crate::quantity::{Name, Quantity, StringValue};
use crate::raw::{
    RawBasis, RawBody, RawCoefficient, RawCoefficientKind, RawContactFriction, RawCoordinate,
    RawField, RawFrame, RawImpact, RawInput, RawLine, RawParameter, RawPoint, RawRange, RawSensor,
    RawState, RawTerm, RawUncertainty,
};
use crate::record::{Record, unknown_key_error};
use crate::sections;
use crate::suggest::did_you_mean;
use crate::table::Entry;

const SLIP_HELP: &str =
    "give the tangential velocity of the contact: slip = \"dot(x) - r*dot(phi)\"";

pub fn to_name(written: StringValue) -> Name {
    Name {
        text: written.text,
        span: written.span,
    }
}

pub fn read_parameter(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawParameter> {
    let record = Record::read(entry, &sections::PARAMETER, found)?;
    let value = record.required("value", Entry::quantity, found)?;
    Some(RawParameter {
        name: entry.name.clone(),
        unit: record.written("unit", found),
        doc: record.text("doc", found),
        origin: record.text("source", found),
        min: record.number("min", found),
        max: record.number("max", found),
        uncertainty: read_uncertainty(&record, found),
        value,
    })
}

fn read_uncertainty(record: &Record<'_>, found: &mut Diagnostics) -> Option<RawUncertainty> {
    let entry = record.get("uncertainty")?;
    let record = Record::read(entry, &sections::UNCERTAINTY, found)?;
    let given: Vec<&Entry<'_>> = sections::UNCERTAINTY
        .names()
        .filter_map(|key| record.get(key))
        .collect();
    let [one] = given[..] else {
        let message = format!("`uncertainty` needs one key, not {}", given.len());
        found.push(
            Diagnostic::error(message)
                .with_span(entry.span(), "expected one of relative, sd, between")
                .with_help(format!(
                    "write uncertainty = {}",
                    sections::UNCERTAINTY.example()
                )),
        );
        return None;
    };
    let raw = match &*one.name.text {
        "relative" => one.number().map(RawUncertainty::Relative),
        "sd" => one.number().map(RawUncertainty::StandardDeviation),
        _ => one.pair().and_then(|[low, high]| match (low, high) {
            (Quantity::Number(low), Quantity::Number(high)) => {
                Ok(RawUncertainty::Between([low, high]))
            }
            _ => Err(Diagnostic::error("the bounds of `between` must be numbers")
                .with_span(one.span(), "expected two numbers")
                .with_help("write them in the parameter's unit, for example { between = [1, 2] }")),
        }),
    };
    found.push_error(raw)
}

pub fn read_coordinate(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawCoordinate> {
    let record = Record::read(entry, &sections::COORDINATE, found)?;
    Some(RawCoordinate {
        name: entry.name.clone(),
        unit: read_required_unit(&record, found),
        doc: record.text("doc", found),
        initial: record.quantity("initial", found),
        initial_rate: record.quantity("initial_rate", found),
        range: read_range(&record, found),
    })
}

/// Reads the `range` of a coordinate, an input or a state, if it has one.
fn read_range(record: &Record<'_>, found: &mut Diagnostics) -> Option<RawRange> {
    let [low, high] = record.optional("range", Entry::pair, found)?;
    let span = record.get("range")?.span();
    Some(RawRange { low, high, span })
}

fn read_required_unit(record: &Record<'_>, found: &mut Diagnostics) -> Option<StringValue> {
    record.required("unit", Entry::written, found)
}

pub fn read_input(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawInput> {
    let record = Record::read(entry, &sections::INPUT, found)?;
    Some(RawInput {
        name: entry.name.clone(),
        unit: read_required_unit(&record, found),
        doc: record.text("doc", found),
        range: read_range(&record, found),
        rate_order: 0,
        rates: read_given_rates(&record, found),
    })
}

/// Reads the number of given rates of an input: 0 or 2, because an energy needs both.
fn read_given_rates(record: &Record<'_>, found: &mut Diagnostics) -> u8 {
    let Some((number, span)) = record.optional("rates", Entry::integer, found) else {
        return 0;
    };
    if number != 2 {
        let diagnostic = Diagnostic::error(format!("`rates` of an input cannot be {number}"))
            .with_span(span, "expected 2")
            .with_help(
                "with rates = 2 the first and second derivatives are inputs too: `s_dot` and `s_ddot`",
            );
        found.push(diagnostic);
        return 0;
    }
    2
}

pub fn read_state(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawState> {
    let record = Record::read(entry, &sections::STATE, found)?;
    let unit = read_required_unit(&record, found);
    let rate = record.required("rate", Entry::quantity, found)?;
    Some(RawState {
        name: entry.name.clone(),
        unit,
        rate,
        initial: record.quantity("initial", found),
        range: read_range(&record, found),
        doc: record.text("doc", found),
    })
}

pub fn read_constraint(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawTerm> {
    let record = Record::read(entry, &sections::CONSTRAINT, found)?;
    let value = record.required("zero", Entry::scalar_or_vector, found)?;
    Some(RawTerm {
        name: entry.name.clone(),
        value,
        doc: record.text("doc", found),
        origin: record.text("source", found),
    })
}

pub fn read_impact(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawImpact> {
    let record = Record::read(entry, &sections::IMPACT, found)?;
    let when = record.required("when", Entry::quantity, found);
    let restitution = record.required("restitution", Entry::quantity, found);
    let friction = read_contact_friction(&record, found);
    let distance = RawTerm {
        name: entry.name.clone(),
        value: when?,
        doc: record.text("doc", found),
        origin: record.text("source", found),
    };
    Some(RawImpact {
        distance,
        restitution: restitution?,
        friction: friction?,
    })
}

/// Reads `friction` and `slip` of an impact. Each requires the other. Returns `None` after an error.
fn read_contact_friction(
    record: &Record<'_>,
    found: &mut Diagnostics,
) -> Option<Option<RawContactFriction>> {
    let name = quote(&record.owner().text);
    let (friction, slip) = match (record.get("friction"), record.get("slip")) {
        (None, None) => return Some(None),
        (Some(friction), Some(slip)) => (friction, slip),
        (Some(friction), None) => {
            found.push(
                Diagnostic::error(format!("{name} has `friction`, but no `slip`"))
                    .with_span(friction.name.span, "`slip` is missing")
                    .with_help(SLIP_HELP),
            );
            return None;
        }
        (None, Some(slip)) => {
            found.push(
                Diagnostic::error(format!("{name} has `slip`, but no `friction`"))
                    .with_span(slip.name.span, "`friction` is missing")
                    .with_help("give the coefficient of friction: friction = \"mu\""),
            );
            return None;
        }
    };
    let coefficient = found.push_error(friction.quantity());
    let given = found.push_error(slip.scalar_or_vector())?;
    if matches!(given, Quantity::Vector(..)) {
        found.push(
            Diagnostic::error(format!("the slip of {name} has several components"))
                .with_span(slip.span(), "expected one expression")
                .with_help(
                    "contact friction acts along one direction; friction in two directions is not supported",
                ),
        );
        return None;
    }
    Some(Some(RawContactFriction {
        coefficient: coefficient?,
        slip: given,
    }))
}

pub fn read_field(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawField> {
    let record = Record::read(entry, &sections::FIELD, found)?;
    let along = record.required("along", Entry::written, found);
    let from = record.required("from", Entry::quantity, found);
    let to = record.required("to", Entry::quantity, found);
    let basis = record.required("basis", Entry::written, found);
    let coordinates = record.required("coordinates", Entry::written, found);
    let order = record.required("order", Entry::integer, found);
    Some(RawField {
        name: entry.name.clone(),
        unit: read_required_unit(&record, found),
        doc: record.text("doc", found),
        along: to_name(along?),
        from: from?,
        to: to?,
        basis: read_basis(&record, &basis?, found)?,
        coordinates: to_name(coordinates?),
        order: order?,
    })
}

fn read_basis(
    record: &Record<'_>,
    written: &StringValue,
    found: &mut Diagnostics,
) -> Option<RawBasis> {
    if written.text == bases::TABLE {
        let table = record.required("table", Entry::written, found);
        return table.map(RawBasis::Table);
    }
    let named = found.push_error(parse_basis(written))?;
    if let Some(table) = record.get("table") {
        found.push(
            Diagnostic::error("`table` is given, but the basis is not \"table\"")
                .with_span(table.name.span, "this file is not read")
                .with_help("write basis = \"table\", or remove `table`"),
        );
        return None;
    }
    Some(RawBasis::Named(named))
}

fn parse_basis(written: &StringValue) -> Result<Basis, Diagnostic> {
    let meant = bases::BASES.iter().find(|(name, _)| *name == written.text);
    meant.map(|(_, basis)| basis.clone()).ok_or_else(|| {
        let unknown = Diagnostic::error(format!("unknown basis {}", quote(&written.text)))
            .with_span(written.span, "not known");
        let names = bases::BASES
            .iter()
            .map(|(name, _)| *name)
            .chain([bases::TABLE]);
        unknown.with_help(did_you_mean(&written.text, names).unwrap_or_else(|| {
            "a beam is named by its ends at `from` and `to`: clamped, pinned, free or guided, as \
             pinned_clamped; the others are rod_fixed_free, rod_fixed_fixed, rod_free_free, string, \
             table (shapes from a file) and clamped_free_printed"
                .to_owned()
        }))
    })
}

type Read<'d> = fn(&Entry<'d>) -> Result<Quantity, Diagnostic>;

/// Reads an entry of an energy or of the dissipation.
pub fn read_energy_term(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawTerm> {
    read_named_expression(entry, Entry::quantity, found)
}

pub fn read_definition(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawTerm> {
    read_named_expression(entry, Entry::scalar_or_vector, found)
}

fn read_named_expression<'d>(
    entry: &Entry<'d>,
    read: Read<'d>,
    found: &mut Diagnostics,
) -> Option<RawTerm> {
    if !entry.is_table() {
        return Some(RawTerm {
            name: entry.name.clone(),
            value: found.push_error(read(entry))?,
            doc: String::new(),
            origin: String::new(),
        });
    }
    let record = Record::read(entry, &sections::TERM, found)?;
    read_term(&record, read, found)
}

/// Reads a named expression from a table with at least `value`.
fn read_term<'d>(record: &Record<'d>, read: Read<'d>, found: &mut Diagnostics) -> Option<RawTerm> {
    let value = record.required("value", read, found)?;
    Some(RawTerm {
        name: record.owner().clone(),
        value,
        doc: record.text("doc", found),
        origin: record.text("source", found),
    })
}

/// Reads an entry of `[forces]` and the quantity it acts on.
pub fn read_force(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<(RawTerm, Quantity)> {
    let record = Record::read(entry, &sections::FORCE, found)?;
    let on = record.required("on", Entry::scalar_or_vector, found);
    let term = read_term(&record, Entry::scalar_or_vector, found);
    Some((term?, on?))
}

/// Reads an entry of `[observables]` and its declared unit.
pub fn read_observable(
    entry: &Entry<'_>,
    found: &mut Diagnostics,
) -> Option<(RawTerm, Option<StringValue>)> {
    if !entry.is_table() {
        return Some((read_definition(entry, found)?, None));
    }
    let record = Record::read(entry, &sections::OBSERVABLE, found)?;
    let unit = record.written("unit", found);
    Some((read_term(&record, Entry::scalar_or_vector, found)?, unit))
}

pub fn read_frame(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawFrame> {
    let record = Record::read(entry, &sections::FRAME, found)?;
    let origin = |entry: &Entry<'_>| entry.vector("[0, 0, \"d\"]");
    Some(RawFrame {
        name: entry.name.clone(),
        parent: record.written("in", found),
        origin: record.optional("origin", origin, found),
        rotation: record.written("rotation", found),
        doc: record.text("doc", found),
    })
}

pub fn read_body(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawBody> {
    let record = Record::read(entry, &sections::BODY, found)?;
    let moments = |entry: &Entry<'_>| entry.quantities(&[3, 6], "[\"I_x\", \"I_y\", \"I_z\"]");
    let inertia = record.optional("inertia", moments, found);
    let centre = |entry: &Entry<'_>| entry.vector("[0, 0, \"c\"]");
    let centre = record.optional("centre", centre, found);
    let frame = record.required("frame", Entry::written, found);
    let mass = match (record.get("mass"), record.get("inertia")) {
        (None, None) => {
            let name = quote(&entry.name.text);
            found.push(
                Diagnostic::error(format!("the body {name} has no `mass` and no `inertia`"))
                    .with_span(entry.name.span, "the body would have no kinetic energy")
                    .with_help("give its mass: mass = \"m\""),
            );
            return None;
        }
        (None, Some(_)) => None,
        (Some(mass), _) => Some(found.push_error(mass.quantity())?),
    };
    Some(RawBody {
        name: entry.name.clone(),
        frame: frame?,
        mass,
        centre,
        inertia,
        doc: record.text("doc", found),
        origin: record.text("source", found),
    })
}

pub fn read_coefficient(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawCoefficient> {
    let name = entry.name.clone();
    if !entry.is_table() {
        let value = found.push_error(entry.quantity())?;
        return Some(RawCoefficient {
            name,
            kind: RawCoefficientKind::Value(value),
            each: None,
            doc: String::new(),
        });
    }
    let record = Record::read(entry, &sections::COEFFICIENT, found)?;
    Some(RawCoefficient {
        name,
        kind: read_coefficient_kind(&record, found)?,
        each: record.written("each", found),
        doc: record.text("doc", found),
    })
}

fn read_coefficient_kind(
    record: &Record<'_>,
    found: &mut Diagnostics,
) -> Option<RawCoefficientKind> {
    if let Some(value) = record.get("value") {
        let others = ["of", "by", "times"];
        if let Some(other) = others.iter().find_map(|key| record.get(key)) {
            let known = ["value", "each", "doc"];
            found.push(
                unknown_key_error(&other.name, &known)
                    .with_help("give either `value`, or `of` and `by`"),
            );
            return None;
        }
        return found
            .push_error(value.quantity())
            .map(RawCoefficientKind::Value);
    }
    record.require("of", found)?;
    record.require("by", found)?;
    let times = record.quantity("times", found);
    let of = record.quantity("of", found)?;
    let by = record.quantity("by", found)?;
    Some(RawCoefficientKind::Factor(of, by, times))
}

pub fn read_sensor(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawSensor> {
    let record = Record::read(entry, &sections::SENSOR, found)?;
    let observable = record.written("observable", found);
    let mut number = |key, absent| record.number(key, found).map_or(absent, |n| n.value);
    Some(RawSensor {
        observable,
        channel: entry.name.clone(),
        gain: number("gain", 1.0),
        bias: number("bias", 0.0),
        delay: number("delay", 0.0),
    })
}

pub fn read_point(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawPoint> {
    let record = Record::read(entry, &sections::POINT, found)?;
    let x = record.required("x", Entry::quantity, found);
    let y = record.required("y", Entry::quantity, found);
    Some(RawPoint {
        name: entry.name.clone(),
        x: x?,
        y: y?,
    })
}

pub fn read_line(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawLine> {
    let points = found.push_error(entry.list("[\"origin\", \"tip\"]"))?;
    let count = points.len();
    let points: Vec<StringValue> = points
        .iter()
        .filter_map(|point| found.push_error(point.written()))
        .collect();
    if count < 2 {
        let name = quote(&entry.name.text);
        found.push(
            Diagnostic::error(format!("the line {name} has fewer than two points"))
                .with_span(entry.span(), "a line joins at least two points")
                .with_help("for example [\"origin\", \"tip\"]"),
        );
    }
    Some(RawLine {
        name: entry.name.clone(),
        points,
    })
}
