//! Certificate of a checked model: derivation, emitted source and checks.

use std::cell::RefCell;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::mechanics::outputs::derive_outputs;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::program::lowering::{lower_controllers, lower_with_outputs};
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::{Variant as DerivedVariant, derive_equations};
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::variant::ModelError;

use crate::certificate::{Certificate, Check};
use crate::certify::{
    self, CSource, CasadiSource, Emitted, EmittedFunction, ScaledRates, Subject, UnitSource,
    certificate_header, certify,
};
use crate::derived::Derived;
use crate::derived_outputs::DerivedOutputs;
use crate::outputs::Outputs;
use crate::references::reference_equations;
use crate::variant::Variant;
use eomgen_compiled_model::{CompiledModel, Error, Orders};
use eomgen_sim::ode::Names;
use eomgen_sim::piecewise_linear::Propagator;

/// Certifies a model with the requested outputs `outputs`. It is compared with an oracle and with the hand-written
/// equations that apply to it. `orders` must be equal for all fields.
///
/// # Errors
/// A model that cannot be derived or emitted, or fields with different orders.
pub fn certify_model(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
) -> Result<Certificate, Error> {
    common_order(model, orders)?;
    let variant = DerivedVariant::derive_with_trace(model, orders, outputs)?;
    let emitted = emit(&variant.program, Packaging::Crate);
    let emitted = emitted.map_err(|error| Error::Request(error.to_string()))?;
    certify_source(model, orders, outputs, emitted)
}

/// Checks and certifies a specification. Returns `None` if its fields have different orders: a
/// certificate is for one order.
///
/// # Errors
/// An invalid specification or order, and the errors of [`certify_model`].
pub fn certify_specification(
    source: Source,
    order: Option<usize>,
) -> Result<Option<Certificate>, Error> {
    let model = eomgen_model_spec::check(source)?.model;
    let orders = order.map_or(Orders::Declared, Orders::Uniform);
    let orders = orders.resolve(&model)?;
    if orders.windows(2).any(|pair| pair[0] != pair[1]) {
        return Ok(None);
    }
    certify_model(&model, &orders, &[]).map(Some)
}

/// Emitted sources of one variant, at least one.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Rust source; the packaging must be a module or a crate.
    pub rust: Option<String>,
    /// C sources, one for each prefix.
    pub c: Vec<CSource>,
    /// Functions for CasADi. They have separate requested outputs.
    pub casadi: Option<CasadiSource>,
    /// Functional mock-up unit.
    pub unit: Option<UnitSource>,
}

/// Certifies an emitted Rust source of `model` with `outputs`.
///
/// # Errors
/// As [`certify_model`].
pub fn certify_source(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
    emitted: String,
) -> Result<Certificate, Error> {
    let sources = Sources {
        rust: Some(emitted),
        ..Sources::default()
    };
    certify_sources(model, orders, outputs, &sources)
}

/// Certifies emitted sources of `model` with `outputs`.
///
/// # Errors
/// As [`certify_model`].
pub fn certify_sources(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
    sources: &Sources,
) -> Result<Certificate, Error> {
    let order = common_order(model, orders)?;
    let certificate = certificate(model, order, outputs, sources)
        .map_err(|error| Diagnostics::from_one(model.source.clone(), error.diagnostic()))?;
    Ok(certificate)
}

fn common_order(model: &Model, orders: &[usize]) -> Result<usize, Error> {
    let order = orders.first().copied().unwrap_or(0);
    if orders.iter().any(|other| *other != order) {
        return Err(Error::Request(format!(
            "the fields of {} have the orders {orders:?}; a certificate is for one order: \
             give --order",
            model.name
        )));
    }
    Ok(order)
}

fn certificate(
    model: &Model,
    order: usize,
    outputs: &[Output],
    sources: &Sources,
) -> Result<Certificate, ModelError> {
    with_subject(model, order, outputs, sources, certify)
}

/// Runs only those checks of [`certify_sources`] that compile the sources.
///
/// # Errors
/// As [`certify_model`], and a variant that cannot be evaluated.
pub fn check_sources(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
    sources: &Sources,
) -> Result<Vec<Check>, Error> {
    let order = common_order(model, orders)?;
    let checks = with_subject(model, order, outputs, sources, certify::check_sources)
        .map_err(|error| Diagnostics::from_one(model.source.clone(), error.diagnostic()))?;
    checks.map_err(Error::Request)
}

/// Builds the [`Subject`] of the checks and calls `work` with it.
fn with_subject<R>(
    model: &Model,
    order: usize,
    outputs: &[Output],
    sources: &Sources,
    work: impl FnOnce(&Subject<'_>) -> R,
) -> Result<R, ModelError> {
    let parameters = model.parameter_values()?;
    let reference_equations = reference_equations(model, order, &parameters);
    let variants = |order: usize| build_variant(model, order, &parameters);
    let output_functions = || build_outputs(model, order, &parameters, outputs);
    let propagator = build_propagator(model, order).map(RefCell::new);
    let derivative = |time: f64, state: &[f64], inputs: &[f64]| match &propagator {
        Ok(propagator) => scaled_rates(&mut propagator.borrow_mut(), time, state, inputs),
        Err(reason) => Err(reason.clone()),
    };
    let emitted = emitted_source(model, outputs, sources);
    let program = build_program(model, order, &parameters, outputs);
    let program = program.map(|program| with_controllers(model, program));
    let casadi_program = match &sources.casadi {
        Some(casadi) => build_program(model, order, &parameters, &casadi.outputs())
            .map(|program| with_controllers(model, program)),
        None => Err("no functions for CasADi were emitted".to_owned()),
    };
    let unit_program = build_program(model, order, &parameters, &[]);
    let default_inputs = model.typical_inputs(0.0);
    let default_inputs = default_inputs.unwrap_or_else(|_| vec![0.0; model.inputs.len()]);
    let inputs: Vec<String> = model
        .inputs
        .iter()
        .map(|input| input.name.clone())
        .collect();
    Ok(work(&Subject {
        model,
        order,
        parameters: &parameters,
        variants: &variants,
        references: &reference_equations.references,
        not_applicable: &reference_equations.not_applicable,
        outputs: (!outputs.is_empty()).then_some(&output_functions),
        regimes: generate_kernels(model, order, &parameters, &inputs),
        emitted: emitted.ok_or_else(|| "no Rust was emitted".to_owned()),
        program: program.as_ref().ok(),
        c_sources: &sources.c,
        casadi: (sources.casadi.as_ref()).map(|casadi| (casadi, &casadi_program)),
        unit: (sources.unit.as_ref()).map(|unit| (unit, &unit_program, &*default_inputs)),
        exact: match &propagator {
            Ok(_) => Ok(&derivative),
            Err(reason) => Err(reason.clone()),
        },
    }))
}

/// Returns the certificate without running its checks. Its verdict is "failed".
pub fn unchecked_certificate(
    model: &Model,
    order: usize,
    outputs: &[Output],
    sources: &Sources,
) -> Result<Certificate, ModelError> {
    let parameters = model.parameter_values()?;
    let emitted = emitted_source(model, outputs, sources);
    let (casadi, unit) = (sources.casadi.as_ref(), sources.unit.as_ref());
    let sources = (emitted.as_ref(), &*sources.c, casadi, unit);
    let about = certificate_header(model, order, &parameters, sources);
    Ok(Certificate::new(about, None, Vec::new()))
}

fn emitted_source(model: &Model, outputs: &[Output], sources: &Sources) -> Option<Emitted> {
    let inputs = model.inputs.iter();
    let names = outputs.iter().map(|output| output.name().to_owned());
    Some(Emitted {
        source: sources.rust.clone()?,
        input_fields: inputs.map(|input| input.name.clone()).collect(),
        functions: vec![
            EmittedFunction::Rates,
            EmittedFunction::Observables,
            EmittedFunction::Energy,
            EmittedFunction::Power,
            EmittedFunction::Guards,
            EmittedFunction::MassMatrix,
        ],
        outputs: Some(names.collect()),
    })
}

fn generate_kernels(
    model: &Model,
    order: usize,
    parameters: &[f64],
    input_fields: &[String],
) -> Result<Emitted, String> {
    let program = build_program(model, order, parameters, &[Output::Regimes])?;
    if program.guards.is_empty() {
        return Err("the model has no piecewise function".to_owned());
    }
    let source = emit(&program, Packaging::Crate).map_err(|error| error.to_string())?;
    Ok(Emitted {
        source,
        input_fields: input_fields.to_vec(),
        functions: Vec::new(),
        outputs: None,
    })
}

fn build_propagator(model: &Model, order: usize) -> Result<Propagator, String> {
    let orders = vec![order; model.fields.len()];
    let compiled =
        CompiledModel::derive_without_inertia_check(model.clone(), Orders::PerField(&orders));
    let compiled = compiled.map_err(|error| error.to_string())?;
    let instance = compiled
        .with_declared_parameters()
        .map_err(|error| error.to_string())?;
    let propagator = instance.propagator();
    propagator.map_err(|error| error.format_cause(&Names::default()))
}

fn scaled_rates(
    propagator: &mut Propagator,
    time: f64,
    state: &[f64],
    inputs: &[f64],
) -> Result<ScaledRates, String> {
    let found = propagator.evaluate_rates(time, state, inputs);
    let found = found.map_err(|error| error.to_string())?;
    Ok(ScaledRates {
        rates: found.values,
        magnitudes: found.sizes,
    })
}

fn build_variant(
    model: &Model,
    order: usize,
    parameters: &[f64],
) -> Result<Box<dyn Variant>, String> {
    let evaluator = Evaluator::new(build_program(model, order, parameters, &[])?);
    Ok(Box::new(Derived::new(evaluator)))
}

fn build_outputs(
    model: &Model,
    order: usize,
    parameters: &[f64],
    outputs: &[Output],
) -> Result<Box<dyn Outputs>, String> {
    let evaluator = Evaluator::new(build_program(model, order, parameters, outputs)?);
    Ok(Box::new(DerivedOutputs::new(evaluator)))
}

fn build_program(
    model: &Model,
    order: usize,
    parameters: &[f64],
    outputs: &[Output],
) -> Result<Program, String> {
    let orders = vec![order; model.fields.len()];
    let mut equations = derive_equations(model, &orders).map_err(|error| error.message)?;
    let formed = derive_outputs(&mut equations, outputs).map_err(|error| error.to_string())?;
    Ok(lower_with_outputs(model, &equations, parameters, &formed))
}

/// Adds the controllers of a model to its program. If a controller measures a mode that the order does not have, no
/// controller is emitted.
fn with_controllers(model: &Model, mut program: Program) -> Program {
    program.controllers = lower_controllers(model, &program).unwrap_or_default();
    program
}
