//! Binding of a dataset file to a model: looks up names, and checks units and numbers.

use crate::computed_observables::COMPUTED_OBSERVABLES;
use crate::description::Description;
use crate::description::columns::{ChannelColumn, Column, InputColumn, Prior};
use crate::description::motion::InitialState;
use crate::experiment::{self, ExperimentBounds, ExperimentUnits};
use crate::given_motion;
use crate::motion_rates::GivenColumn;
use crate::units::parse_unit;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::foreign::read_rate;
use eomgen_model_spec::model::{Input, Model, ObservedRate, ParameterValue};
use eomgen_model_spec::quantity::{Name, Number};
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_model_spec::unit::Unit;

use crate::dataset::{
    Channel, Initial, InputPriors, PriorInSi, Quantity, TransducerPriors, Uncertain,
};

/// Admissible relative standard deviations. Below this range a parameter counts as exact, above it as unknown.
const RELATIVE_SD_RANGE: (f64, f64) = (1e-9, 1e6);

pub struct BoundDescription<'d> {
    pub time: Unit,
    pub inputs: Vec<Option<(&'d Column, Unit)>>,
    pub input_priors: Vec<InputPriors>,
    /// Column of each coordinate of the model, if `[motion]` gives the motion.
    pub(crate) motion: Vec<GivenColumn<'d>>,
    pub channels: Vec<Channel>,
    pub channel_units: Vec<Unit>,
    pub initial: Initial,
    pub uncertain: Vec<Uncertain>,
    pub experiment: ExperimentBounds,
    pub experiment_units: ExperimentUnits,
}

pub fn bind_description<'d>(
    description: &'d Description,
    model: &Model,
) -> Result<BoundDescription<'d>, Diagnostics> {
    let mut found = Diagnostics::new(description.source.clone());
    check_lists(description, &mut found);
    let time = found.push_error(time_unit(description));
    let inputs = bind_inputs(description, model, &mut found);
    let input_priors = bind_input_priors(description, model, &mut found);
    let motion = given_motion::bind_given_columns(description, model, &mut found);
    let (mut channels, mut channel_units) = (Vec::new(), Vec::new());
    for entry in &description.channels {
        if let Some((channel, unit)) = found.push_error(bind_channel(entry, description, model)) {
            channels.push(channel);
            channel_units.push(unit);
        }
    }
    if !description.motion.is_empty() {
        given_motion::check_required_inputs(description, &channels, model, &mut found);
    }
    let initial = bind_initial(&description.initial, model, &mut found);
    let mut uncertain = Vec::new();
    for (name, relative) in &description.uncertain {
        uncertain.extend(found.push_error(bind_uncertain(name, *relative, model)));
    }
    let input_units: Vec<Option<Unit>> = (inputs.iter())
        .map(|fed| fed.as_ref().map(|(_, unit)| unit.clone()))
        .collect();
    let units = (&input_units[..], &channel_units[..]);
    let experiment = experiment::bind_experiment(description, model, units, &mut found);
    match time {
        Some(time) if found.is_empty() => Ok(BoundDescription {
            experiment_units: ExperimentUnits {
                time: time.clone(),
                inputs: input_units,
            },
            time,
            inputs,
            input_priors,
            motion,
            channels,
            channel_units,
            initial,
            uncertain,
            experiment,
        }),
        _ => Err(found),
    }
}

pub fn time_unit(description: &Description) -> Result<Unit, Diagnostic> {
    parse_unit(&description.time.column.unit, "s")
}

/// Returns the column and the unit of each input of the model.
pub fn bind_inputs<'d>(
    description: &'d Description,
    model: &Model,
    found: &mut Diagnostics,
) -> Vec<Option<(&'d Column, Unit)>> {
    let of = |input: &eomgen_model_spec::model::Input| {
        let mut columns = description.inputs.iter();
        // Rates of prescribed motion are computed from the spline through its samples.
        if input.rate_of.is_some() {
            return None;
        }
        let column = columns.find(|column| column.name.text == input.name)?;
        let unit = found.push_error(parse_unit(&column.column.unit, &input.unit.text))?;
        Some((&column.column, unit))
    };
    model.inputs.iter().map(of).collect()
}

/// Returns the priors of the inputs. Other functions check their columns.
fn bind_input_priors(
    description: &Description,
    model: &Model,
    found: &mut Diagnostics,
) -> Vec<InputPriors> {
    let says = |column: &&InputColumn| {
        column.gain.is_some() || column.bias.is_some() || column.delay.is_some()
    };
    for column in &description.inputs {
        let own = model.inputs.iter().filter(|input| input.rate_of.is_none());
        // With several inputs, a delay of one input is not equivalent to a delay of the sensors.
        if let (Some(delay), true) = (column.delay, own.count() > 1) {
            found.push(
                Diagnostic::error("a delay of a single input is only estimated if the model has one input".to_owned())
                    .with_span(delay.sd.span, "the model has several inputs")
                    .with_help("write an equal delay of all inputs as a delay of each channel, or shift the late column in \
                                the record"),
            );
        }
    }
    let find = |column: &InputColumn| {
        let mut inputs = model.inputs.iter();
        inputs.find(|input| input.name == column.name.text)
    };
    for column in &description.inputs {
        let faults = [(column.gain, "gain"), (column.bias, "bias")];
        let fault = faults
            .into_iter()
            .find_map(|(prior, name)| Some((prior?, name)));
        if let Some((prior, fault)) = fault
            && find(column).is_some_and(Input::is_prescribed)
        {
            found.push(
                Diagnostic::error(format!(
                    "the {fault} of `{}`, a prescribed motion, cannot be estimated",
                    column.name.text
                ))
                .with_span(prior.sd.span, "its rates would have this error too")
                .with_help("correct the column in the record"),
            );
        }
    }
    let of = |column: &InputColumn| {
        let input = find(column)?;
        let own = parse_unit(&column.column.unit, &input.unit.text).ok()?;
        let one = Unit::coherent(Dimension::DIMENSIONLESS);
        Some(InputPriors {
            name: input.name.clone(),
            gain: column.gain.map(|gain| convert_prior_to_si(gain, &one)),
            bias: column.bias.map(|bias| convert_prior_to_si(bias, &own)),
            delay: column.delay.map(|delay| convert_prior_to_si(delay, &one)),
        })
    };
    description
        .inputs
        .iter()
        .filter(says)
        .filter_map(of)
        .collect()
}

fn check_lists(description: &Description, found: &mut Diagnostics) {
    let records = &description.records;
    for (kind, files) in [("train", &records.train), ("test", &records.test)] {
        if files.is_empty() {
            found.push(
                Diagnostic::error(format!("[records] lists no {kind} record"))
                    .with_span(records.span, "train and test are both required")
                    .with_help(format!("write {kind} = [\"{kind}.csv\"]")),
            );
        }
    }
    if description.channels.is_empty() {
        found.push(
            Diagnostic::error("there is no [channels.NAME], so nothing can be compared")
                .with_span(records.span, "no channel of these records")
                .with_help("describe at least one measured quantity, with column, unit and noise"),
        );
    }
}

fn bind_channel(
    entry: &ChannelColumn,
    description: &Description,
    model: &Model,
) -> Result<(Channel, Unit), Diagnostic> {
    let (asked, span) = match &entry.observable {
        Some(written) => (&written.text, written.span),
        None => (&entry.name.text, entry.name.span),
    };
    let (quantity, expected) = find_quantity(model, asked).ok_or_else(|| {
        let known = || {
            let observables = model.observables.iter().map(|o| o.name.as_str());
            let inputs = model.inputs.iter().map(|input| input.name.as_str());
            let inputs = inputs.filter(|_| !description.motion.is_empty());
            let coordinates = model.coordinates.iter().map(|c| c.name.as_str());
            let states = model.states.iter().map(|state| state.name.as_str());
            let moving = (coordinates.chain(states)).filter(|_| description.motion.is_empty());
            observables.chain(moving).chain(inputs)
        };
        let listed: Vec<&str> = known().collect();
        let computed = (COMPUTED_OBSERVABLES.contains(&asked.as_str())).then(|| {
            format!(
                "`{asked}` is an output of `simulate`, not a channel; declare an observable for the measured quantity, \
                 such as motor_power = \"u*dot(x)\""
            )
        });
        let listed = format!("it has {}", listed.join(", "));
        Diagnostic::error(format!(
            "the model has no {} {}",
            match description.motion.is_empty() {
                true => "observable, coordinate or state",
                false => "observable or input",
            },
            quote(asked)
        ))
        .with_span(span, "not a quantity of the model")
        .with_help(
            computed
                .or_else(|| suggest_rate(asked, model))
                .or_else(|| did_you_mean(asked, known()))
                .unwrap_or(listed),
        )
    })?;
    given_motion::check_channel(quantity, !description.motion.is_empty(), asked, span)?;
    let unit = parse_unit(&entry.column.unit, &expected)?;
    let noise = unit.to_si(entry.noise.value);
    if !(noise.is_finite() && noise > 0.0) {
        return Err(
            Diagnostic::error(format!("noise cannot be {}", entry.noise.value)).with_span(
                entry.noise.span,
                "expected a standard deviation greater than 0",
            ),
        );
    }
    let one = Unit::coherent(Dimension::DIMENSIONLESS);
    let channel = Channel {
        name: entry.name.text.clone(),
        observable: match quantity {
            Quantity::Observable(_) | Quantity::Coordinate(_) | Quantity::State(_) => asked.clone(),
            Quantity::Rate(place) => format!("{}_dot", model.coordinates[place].name),
            Quantity::Acceleration(place) => format!("{}_ddot", model.coordinates[place].name),
            Quantity::Input(place) => model.inputs[place].name.clone(),
            Quantity::ObservedRate(rate) => rate.name(model),
        },
        quantity,
        unit: expected,
        noise,
        priors: TransducerPriors {
            gain: entry.gain.map(|gain| convert_prior_to_si(gain, &one)),
            bias: entry.bias.map(|bias| convert_prior_to_si(bias, &unit)),
            delay: entry.delay.map(|delay| convert_prior_to_si(delay, &one)),
        },
    };
    Ok((channel, unit))
}

fn convert_prior_to_si(prior: Prior, unit: &Unit) -> PriorInSi {
    PriorInSi {
        mean: prior.mean.map(|mean| unit.to_si(mean.value)),
        sd: unit.to_si(prior.sd.value),
    }
}

/// Suggests the name of a rate for a name in another common notation, such as `thetadot`.
fn suggest_rate(asked: &str, model: &Model) -> Option<String> {
    let rate = read_rate(asked, |of| model.coordinates.iter().any(|c| c.name == of))?;
    let (of, order, kind) = match rate.is_second {
        true => (rate.of, "ddot", "acceleration"),
        false => (rate.of, "dot", "rate"),
    };
    Some(format!("write `{of}_{order}` for the {kind}"))
}

fn find_quantity(model: &Model, name: &str) -> Option<(Quantity, String)> {
    if let Some(place) = model.observables.iter().position(|o| o.name == name) {
        let unit = model.observables[place].unit.text.clone();
        return Some((Quantity::Observable(place), unit));
    }
    if let Some(place) = model.coordinates.iter().position(|c| c.name == name) {
        let unit = model.coordinates[place].unit.text.clone();
        return Some((Quantity::Coordinate(place), unit));
    }
    if let Some(place) = model.states.iter().position(|state| state.name == name) {
        let unit = model.states[place].unit.text.clone();
        return Some((Quantity::State(place), unit));
    }
    if let Some(place) = model.inputs.iter().position(|input| input.name == name) {
        let unit = model.inputs[place].unit.text.clone();
        return Some((Quantity::Input(place), unit));
    }
    let of = |name: &str| model.coordinates.iter().position(|c| c.name == name);
    let unit = |place: usize| &model.coordinates[place].unit.text;
    let within = |before: &str, after: &str| of(name.strip_prefix(before)?.strip_suffix(after)?);
    if let Some(place) = within("", "_ddot").or_else(|| within("dot(dot(", "))")) {
        return Some((
            Quantity::Acceleration(place),
            format!("{}/s^2", unit(place)),
        ));
    }
    if let Some(place) = within("", "_dot").or_else(|| within("dot(", ")")) {
        return Some((Quantity::Rate(place), format!("{}/s", unit(place))));
    }
    let rate = ObservedRate::from_name(model, name)?;
    Some((Quantity::ObservedRate(rate), rate.unit(model).text))
}

fn bind_initial(written: &InitialState, model: &Model, found: &mut Diagnostics) -> Initial {
    let values = match written {
        InitialState::Rest => return Initial::Rest,
        InitialState::Estimate => return Initial::Estimate,
        InitialState::Values(values) => values,
    };
    let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
    let names = model.state_names(&orders);
    for (name, _) in values {
        if !names.contains(&name.text) {
            let known = names.iter().map(String::as_str);
            let listed = format!("its states are {}", names.join(", "));
            found.push(
                Diagnostic::error(format!("the model has no state {}", quote(&name.text)))
                    .with_span(name.span, "not a state of the model")
                    .with_help(did_you_mean(&name.text, known).unwrap_or(listed)),
            );
        }
    }
    let values = values.iter();
    Initial::Values(
        values
            .map(|(name, value)| (name.text.clone(), value.value))
            .collect(),
    )
}

fn bind_uncertain(name: &Name, relative: Number, model: &Model) -> Result<Uncertain, Diagnostic> {
    let parameter = model.parameters.iter().find(|p| p.name == name.text);
    let wrong = |message: &str| Diagnostic::error(format!("{} {message}", quote(&name.text)));
    match parameter.map(|parameter| &parameter.value) {
        None => {
            let known = model.parameters.iter().map(|p| p.name.as_str());
            Err(wrong("is not a parameter of the model")
                .with_span(name.span, "not in the model")
                .with_optional_help(did_you_mean(&name.text, known)))
        }
        Some(ParameterValue::Expression(_)) => Err(wrong("is defined by an expression")
            .with_span(name.span, "computed from other parameters")
            .with_help("list the parameters in the expression")),
        Some(ParameterValue::Number(0.0)) => Err(wrong("is 0 in the specification")
            .with_span(
                name.span,
                "a standard deviation relative to 0 is 0, so the parameter cannot be refitted",
            )
            .with_help("set its expected value in the specification, or remove it here")),
        Some(ParameterValue::Number(_)) => {
            if !(RELATIVE_SD_RANGE.0..=RELATIVE_SD_RANGE.1).contains(&relative.value) {
                let (least, most) = RELATIVE_SD_RANGE;
                return Err(wrong("has an invalid standard deviation").with_span(
                    relative.span,
                    format!("expected a fraction of its value, from {least:e} to {most:e}"),
                ));
            }
            Ok(Uncertain {
                name: name.text.clone(),
                relative: relative.value,
            })
        }
    }
}
