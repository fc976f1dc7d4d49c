//! Quantities with sliders, and the ranges of the sliders: declared ranges, or typical ranges for the unit.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::ids::StateId;
use eomgen_model_spec::model::Model;
use eomgen_page::play::{Slider, format_unit};

use crate::error::{Error, Result};

/// Number of modes of a field that have controls; higher modes have small amplitudes.
const MAX_MODES: usize = 4;

/// Maximum number of curves shown initially.
const MAX_INITIAL_CURVES: usize = 4;

/// Quantity that can be shown as a curve; `place` is its index among states and observables.
#[derive(Debug)]
pub(super) struct CurveQuantity {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) place: usize,
    pub(super) at_first: bool,
}

/// Input that the page drives, with its rates.
#[derive(Debug)]
pub(super) struct Signal<'m> {
    /// Constant value of the input, mean value of a sine, or start value of a step.
    pub(super) value: Slider<'m>,
    /// Indices of the input's first and second derivatives, if they are inputs.
    pub(super) rates: Vec<usize>,
}

/// Quantities of a page.
#[derive(Debug)]
pub(super) struct Quantities<'m> {
    pub(super) parameters: Vec<Slider<'m>>,
    pub(super) initial: Vec<Slider<'m>>,
    pub(super) inputs: Vec<Signal<'m>>,
    pub(super) shown: Vec<CurveQuantity>,
    /// Units of the state, in its order.
    pub(super) units: Vec<String>,
}

impl<'m> Quantities<'m> {
    /// Selects the quantities of a model with an initial state.
    pub(super) fn new(compiled: &'m CompiledModel, initial: &[f64]) -> Result<Self> {
        let model = compiled.model();
        let units = state_units(compiled);
        let refused = |error| Error::model(&model.source, error);
        let ranges = model.coordinate_ranges().map_err(refused)?;
        let input_ranges = model.input_ranges().map_err(refused)?;
        let typical = model.typical_inputs(0.0).map_err(refused)?;
        let parameters = compiled.program().parameters.iter().enumerate();
        let parameters = parameters.filter_map(|(place, independent)| {
            let name = &independent.quantity.name;
            let declared = model.parameters.iter().find(|p| p.name == *name)?;
            Some(Slider::from_parameter(declared, place, independent.value))
        });
        let inputs = model
            .inputs
            .iter()
            .zip(input_ranges)
            .zip(typical)
            .enumerate();
        // Rates of inputs are computed from the signals, and outputs of controllers are driven by them, so neither has
        // a control.
        let inputs = inputs.filter(|(place, ((input, _), _))| {
            input.rate_of.is_none() && !model.is_controlled(*place)
        });
        let inputs = inputs.map(|(place, ((input, range), value))| {
            let rates = std::iter::successors(input.rate, |rate| model.inputs[*rate].rate);
            let (low, high) = range.unwrap_or_else(|| match input.rate {
                // The range of a prescribed motion is the size of the machine.
                Some(_) => around_zero(default_half_range(
                    &input.unit.to_string(),
                    machine_size(compiled),
                )),
                None => around_zero(10.0),
            });
            Signal {
                value: Slider {
                    name: input.name.clone(),
                    unit: format_unit(&input.unit.to_string()),
                    doc: &input.doc,
                    place,
                    factor: 1.0,
                    value,
                    low: low.min(value),
                    high: high.max(value),
                },
                rates: rates.map(|rate| rate.index()).collect(),
            }
        });
        Ok(Self {
            parameters: parameters.collect(),
            initial: initial_state(compiled, &units, &ranges, initial),
            inputs: inputs.collect(),
            shown: list_curves(compiled, &units),
            units,
        })
    }
}

/// Returns the units of the state.
fn state_units(compiled: &CompiledModel) -> Vec<String> {
    let program = compiled.program();
    let mut units: Vec<String> = program.coordinates.iter().map(|c| c.unit.clone()).collect();
    for field in &program.fields {
        units.extend((0..field.order).map(|_| field.unit.clone()));
    }
    let rates: Vec<String> = units.iter().map(|unit| per_second(unit)).collect();
    units.extend(rates);
    units.extend(program.first_order.iter().map(|state| state.unit.clone()));
    units
}

fn per_second(unit: &str) -> String {
    match unit {
        "1" | "" => "1/s".to_owned(),
        unit if unit.contains('/') => format!("{unit} 1/s"),
        unit => format!("{unit}/s"),
    }
}

/// Returns the indices of coordinates and of the first modes of every field.
fn movable_places(model: &Model, orders: &[usize]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..model.coordinates.len()).collect();
    let mut first = places.len();
    for order in orders {
        places.extend(first..first + order.min(&MAX_MODES));
        first += order;
    }
    places
}

/// Returns sliders for coordinates and modes, their rates, and first-order states.
fn initial_state<'m>(
    compiled: &'m CompiledModel,
    units: &[String],
    ranges: &[Option<(f64, f64)>],
    initial: &[f64],
) -> Vec<Slider<'m>> {
    let model = compiled.model();
    let names = compiled.state_names();
    let degrees = compiled.program().degrees_of_freedom();
    let places = movable_places(model, compiled.orders());
    let rates = places.iter().map(|place| place + degrees);
    let first_order = 2 * degrees..names.len();
    let all = places.iter().copied().chain(rates).chain(first_order);
    let size = machine_size(compiled);
    all.map(|place| {
        let value = initial[place];
        let declared = ranges.get(place).copied().flatten();
        let (low, high) = declared.unwrap_or_else(|| {
            around_zero(default_half_range(&units[place], size).max(1.5 * value.abs()))
        });
        let coordinate = model.coordinates.get(place).map(|known| &known.doc);
        let state = place
            .checked_sub(2 * degrees)
            .map(|state| &model.states[StateId::new(state)].doc);
        Slider {
            name: names[place].clone(),
            unit: format_unit(&units[place]),
            doc: coordinate.or(state).map_or("", String::as_str),
            place,
            factor: 1.0,
            value,
            low: low.min(value),
            high: high.max(value),
        }
    })
    .collect()
}

fn around_zero(reach: f64) -> (f64, f64) {
    (-reach, reach)
}

/// Returns the largest length among the parameters, m; 1 if there is none.
pub(super) fn machine_size(compiled: &CompiledModel) -> f64 {
    let lengths = compiled.program().parameters.iter();
    let size = lengths
        .filter(|parameter| parameter.quantity.unit == "m")
        .map(|parameter| parameter.value.abs())
        .fold(0.0, f64::max);
    if size > 0.0 { size } else { 1.0 }
}

/// Returns the default of half the range of a slider for a unit. `size` is the size of the machine, in m.
fn default_half_range(unit: &str, size: f64) -> f64 {
    match unit {
        "rad" => std::f64::consts::PI,
        "rad/s" => 10.0,
        "m" => 0.5 * size,
        "m/s" => 2.0 * size,
        _ => 1.0,
    }
}

/// Largest rounding error, as a fraction of the amplitude of a motion.
const ROUNDING: f64 = 1e-14;

/// Returns the largest value in a unit that is treated as rounding error; 0 for units without a typical size.
pub(super) fn rounding_error(unit: &str, size: f64) -> f64 {
    match unit {
        "rad" | "rad/s" | "m" | "m/s" => ROUNDING * default_half_range(unit, size),
        _ => 0.0,
    }
}

/// Returns states and observables as curves; curves of coordinates and energy are shown initially.
fn list_curves(compiled: &CompiledModel, units: &[String]) -> Vec<CurveQuantity> {
    let states = compiled.state_names().into_iter().zip(units.to_vec());
    let observables = &compiled.program().observables;
    let observables = observables.iter().map(|o| (o.name.clone(), o.unit.clone()));
    let degrees = compiled.program().degrees_of_freedom();
    let all = states.chain(observables).enumerate();
    all.map(|(place, (name, unit))| CurveQuantity {
        at_first: place < degrees.min(MAX_INITIAL_CURVES - 1) || name == "energy",
        name,
        unit: format_unit(&unit),
        place,
    })
    .collect()
}
