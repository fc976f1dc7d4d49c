//! Resolves the entries of `[controllers]`.

use super::names::ControlResolver;
use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::dimension::Dimension;
use crate::expression::{Resolver, Scope};
use crate::ids::InputId;
use crate::model::{Controller, ControllerOutput, ControllerState, Expr, SampleTime};
use crate::names::{Names, Symbol};
use crate::quantity::{Name, Quantity, StringValue};
use crate::raw::{RawController, RawTime};
use crate::suggest::did_you_mean;
use crate::unit::Unit;

/// Builds a controller. `driven` are the inputs that earlier controllers drive, with the positions of these outputs.
pub(crate) fn resolve_controller(
    raw: RawController,
    names: &Names,
    inputs: &[Name],
    driven: &[ControllerOutput],
    found: &mut Diagnostics,
) -> Option<Controller> {
    let mut resolver = ControlResolver {
        names,
        own: raw
            .states
            .iter()
            .map(|state| state.name.text.clone())
            .collect(),
        measured: Vec::new(),
    };
    let mut time = |raw: &RawTime| resolve_sample_time(raw, names, found);
    let (period, offset, delay) = (time(&raw.period), time(&raw.offset), time(&raw.delay));
    let mut states = Vec::with_capacity(raw.states.len());
    for state in raw.states {
        let unit = found.push_error(parse_unit(state.unit.as_ref()));
        let next = state
            .next
            .syntax()
            .and_then(|syntax| resolver.resolve(&syntax));
        let next = found.push_error(next);
        let initial = state
            .initial
            .map(|value| resolve_constant(&value, names, found));
        let (Some(unit), Some(next)) = (unit, next) else {
            continue;
        };
        states.push(ControllerState {
            name: state.name.text,
            unit,
            next,
            initial: initial.flatten(),
            doc: state.doc,
            span: state.name.span,
        });
    }
    let mut outputs: Vec<ControllerOutput> = Vec::with_capacity(raw.outputs.len());
    for (name, value) in raw.outputs {
        let input = find_input(&name, names, inputs);
        let input = input.and_then(|input| reject_second_controller(&name, input, driven));
        let value = value.syntax().and_then(|syntax| resolver.resolve(&syntax));
        let (input, value) = (found.push_error(input), found.push_error(value));
        if let (Some(input), Some(value)) = (input, value) {
            let span = name.span;
            outputs.push(ControllerOutput { input, value, span });
        }
    }
    Some(Controller {
        name: raw.name.text,
        doc: raw.doc,
        period: period?,
        offset: offset?,
        delay: delay?,
        measured: resolver.measured,
        states,
        outputs,
        span: raw.name.span,
    })
}

fn resolve_sample_time(
    raw: &RawTime,
    names: &Names,
    found: &mut Diagnostics,
) -> Option<SampleTime> {
    let span = raw.value.span();
    let unit = match &raw.unit {
        None => Unit::coherent(Dimension::TIME),
        Some(written) => {
            let unit = found.push_error(parse_unit(Some(written)))?;
            if unit.dimension != Dimension::TIME {
                found.push(
                    Diagnostic::error(format!("the unit `{unit}` is not a unit of time"))
                        .with_span(written.span, "expected s, or s with a prefix")
                        .with_help("write unit = \"ms\""),
                );
                return None;
            }
            unit
        }
    };
    let value = resolve_constant(&raw.value, names, found)?;
    // The value of an expression of parameters is in SI.
    let unit = match raw.value {
        Quantity::Number(_) => unit,
        _ => Unit::coherent(Dimension::TIME),
    };
    Some(SampleTime { value, unit, span })
}

fn resolve_constant(value: &Quantity, names: &Names, found: &mut Diagnostics) -> Option<Expr> {
    let resolved = value
        .syntax()
        .and_then(|syntax| Resolver::new(names, Scope::Parameters).resolve(&syntax));
    found.push_error(resolved)
}

fn parse_unit(written: Option<&StringValue>) -> Result<Unit, Diagnostic> {
    let Some(written) = written else {
        return Ok(Unit::coherent(Dimension::DIMENSIONLESS));
    };
    Unit::parse(&written.text).map_err(|error| {
        Diagnostic::error(error.message)
            .with_span(written.span, "not a unit")
            .with_optional_help(error.help)
    })
}

/// Returns the input that an output drives.
fn find_input(name: &Name, names: &Names, inputs: &[Name]) -> Result<InputId, Diagnostic> {
    let shown = quote(&name.text);
    let listed = || match inputs.is_empty() {
        true => "the model has no inputs: declare it in [inputs]".to_owned(),
        false => {
            let inputs: Vec<&str> = inputs.iter().map(|input| &*input.text).collect();
            format!("the inputs are {}", inputs.join(", "))
        }
    };
    match names.get(&name.text) {
        Some(Symbol::Input(input)) if names.is_prescribed(input) => Err(Diagnostic::error(
            format!("{shown} is prescribed motion, which a controller cannot drive"),
        )
        .with_span(
            name.span,
            "outputs of controllers are held between samples: they jump and have no rates",
        )
        .with_help("drive a force, or remove `rates` from the input")),
        Some(Symbol::Input(input)) => Ok(input),
        Some(symbol) => Err(
            Diagnostic::error(format!("a controller cannot write {shown}"))
                .with_span(
                    name.span,
                    format!("this is {}, not an input", symbol.kind()),
                )
                .with_help(listed()),
        ),
        None => {
            let known = inputs.iter().map(|input| &*input.text);
            let help = did_you_mean(&name.text, known);
            Err(Diagnostic::error(format!("the model has no input {shown}"))
                .with_span(name.span, "not declared")
                .with_help(help.unwrap_or_else(listed)))
        }
    }
}

fn reject_second_controller(
    name: &Name,
    input: InputId,
    driven: &[ControllerOutput],
) -> Result<InputId, Diagnostic> {
    match driven.iter().find(|output| output.input == input) {
        None => Ok(input),
        Some(first) => Err(Diagnostic::error(format!(
            "two controllers drive the input {}",
            quote(&name.text)
        ))
        .with_span(name.span, "the second one")
        .with_related_span(first.span, "the first one")
        .with_help("let one controller compute the sum of both")),
    }
}
