//! Runs all checks of a model at one order and writes the certificate.

use super::certificate::{
    CSourceHashes, CasadiHash, Certificate, CertificateHeader, Check, Coverage, SkipKind, UnitHash,
    Worst,
};
use super::checks::outputs::CheckContext;
use super::checks::{
    MASS_TOLERANCE, ROW_TOLERANCE, balance, casadi, emitted, emitted_c, exact, integrals, nesting,
    outputs, regimes, states, unit, zeros,
};
use super::derived_outputs::DerivedOutputs;
use super::oracle::{Oracle, OracleError};
use super::outputs::Outputs;
use super::overflow::name_overflowing_parameter;
use super::variant::Variant;
use eomgen_codegen::identity::find;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::sha256;

pub use super::checks::casadi::CasadiSource;
pub use super::checks::emitted_c::{CCompiler, CSource};
pub use super::checks::exact::{Derivative, ScaledRates};
pub use super::checks::linked_program::{Emitted, EmittedFunction};
pub use super::checks::states::Reference;
pub use super::checks::unit::UnitSource;

/// Reason for a skipped comparison of two orders.
const SMALLER_MISSING: &str =
    "the model refers to single modes that the smaller order does not have";

/// Hand-written equations of a model.
#[derive(Default)]
pub struct ReferenceEquations {
    /// Equations to compare with.
    pub references: Vec<Reference>,
    /// Skipped checks of hand-written equations that do not apply, with the reason.
    pub not_applicable: Vec<Check>,
}

/// Model, variant and emitted source to validate.
pub struct Subject<'s> {
    /// Checked model.
    pub model: &'s Model,
    /// Order of the variant.
    pub order: usize,
    /// Parameters in SI, in the order of the model.
    pub parameters: &'s [f64],
    /// Function that creates the variant with a given order and these parameters.
    pub variants: &'s dyn Fn(usize) -> Result<Box<dyn Variant>, String>,
    /// Hand-written equations of this model.
    pub references: &'s [Reference],
    /// Skipped checks of hand-written equations that do not apply, with the reason.
    pub not_applicable: &'s [Check],
    /// Function that creates the requested outputs of this order; `None` if none were requested.
    pub outputs: Option<&'s dyn Fn() -> Result<Box<dyn Outputs>, String>>,
    /// Emitted source with the parameters of the specification, or the reason for its absence.
    pub emitted: Result<Emitted, String>,
    /// Program from which the sources were emitted; their interfaces are compared with it. `None` skips this
    /// comparison.
    pub program: Option<&'s Program>,
    /// Emitted C sources, one for each prefix.
    pub c_sources: &'s [CSource],
    /// Emitted functions for CasADi with their program, or the reason for its absence.
    pub casadi: Option<(&'s CasadiSource, &'s Result<Program, String>)>,
    /// Functional mock-up unit with its program and the default inputs.
    pub unit: Option<(&'s UnitSource, &'s Result<Program, String>, &'s [f64])>,
    /// Emitted source with kernels of regimes, or the reason for its absence.
    pub regimes: Result<Emitted, String>,
    /// State derivative of the exact solver, or the reason for its absence.
    pub exact: Result<&'s Derivative<'s>, String>,
}

/// Runs all checks and returns the certificate of `subject`. An error that prevents the checks, for
/// example in the derivation of the variant, is reported as a failed check.
pub fn certify(subject: &Subject<'_>) -> Certificate {
    let (mut checks, coverage) = run_checks(subject).unwrap_or_else(|message| {
        let worst = Worst::from_deviation(f64::INFINITY, message);
        let check = Check::from_deviation("accelerations", worst, ROW_TOLERANCE);
        (vec![check], Coverage::default())
    });
    let emitted = subject.emitted.as_ref().ok();
    let casadi = subject.casadi.map(|(source, _)| source);
    let unit = subject.unit.map(|(unit, ..)| unit);
    let sources = (emitted, subject.c_sources, casadi, unit);
    let about = certificate_header(subject.model, subject.order, subject.parameters, sources);
    name_overflowing_parameter(&mut checks, &about.parameters);
    Certificate::new(about, Some(coverage), checks)
}

/// Returns the header of the certificate; `parameters` are in SI.
pub fn certificate_header(
    model: &Model,
    order: usize,
    parameters: &[f64],
    (rust, c, casadi, unit): (
        Option<&Emitted>,
        &[CSource],
        Option<&CasadiSource>,
        Option<&UnitSource>,
    ),
) -> CertificateHeader {
    let rust_hash = rust.map(|emitted| sha256(&emitted.source));
    let c_sources = c.iter().map(|emitted| CSourceHashes {
        name: emitted.name.clone(),
        source_sha256: sha256(&emitted.source),
        header_sha256: sha256(&emitted.header),
    });
    let c_sources: Vec<CSourceHashes> = c_sources.collect();
    let casadi_hash = casadi.map(|emitted| CasadiHash {
        name: emitted.name.clone(),
        source_sha256: sha256(&emitted.source),
        with: (emitted.with.iter())
            .map(|output| output.name().to_owned())
            .collect(),
    });
    let first_c = c_sources.first().map(|c| c.source_sha256.clone());
    let of_casadi = casadi_hash.as_ref().map(|hash| hash.source_sha256.clone());
    let emitted = rust.map(|emitted| &emitted.source).into_iter();
    let emitted = emitted.chain(c.iter().map(|emitted| &emitted.source));
    let emitted = emitted.chain(casadi.map(|emitted| &emitted.source));
    let names = model.parameters.iter().map(|known| known.name.clone());
    CertificateHeader {
        model: model.name.clone(),
        order,
        specification_sha256: model.hash(),
        source_sha256: rust_hash
            .or(first_c)
            .or(of_casadi)
            .or(unit.map(|unit| unit.sha256.clone())),
        c_sources,
        casadi: casadi_hash,
        unit: unit.map(|unit| UnitHash {
            name: unit.name.clone(),
            sha256: unit.sha256.clone(),
        }),
        identities: emitted
            .flat_map(|source| find(source.as_bytes()))
            .map(|identity| identity.source)
            .collect(),
        settings: model.settings.clone(),
        specification: model.source.text.to_string(),
        with: rust
            .and_then(|emitted| emitted.outputs.clone())
            .or(c.first().map(|emitted| emitted.outputs.clone()))
            .unwrap_or_default(),
        parameters: names.zip(parameters.iter().copied()).collect(),
    }
}

/// Runs only the checks that compile the emitted sources.
///
/// # Errors
/// A variant that cannot be evaluated.
pub fn check_sources(subject: &Subject<'_>) -> Result<Vec<Check>, String> {
    let oracle = build_oracle(subject, subject.order)?;
    let mut variant = (subject.variants)(subject.order)?;
    let mut outputs = subject.outputs.map(|make| make()).transpose()?;
    source_checks(subject, &oracle, variant.as_mut(), outputs.as_deref_mut())
}

fn source_checks(
    subject: &Subject<'_>,
    oracle: &Oracle,
    variant: &mut dyn Variant,
    outputs: Option<&mut (dyn Outputs + 'static)>,
) -> Result<Vec<Check>, String> {
    let mut checks = match &subject.emitted {
        Ok(emitted) => {
            let source = (emitted, subject.program);
            emitted::check(oracle, variant, outputs, source).map_err(describe_error)?
        }
        Err(reason) => emitted::skipped_checks(None, SkipKind::NotApplicable, reason),
    };
    if !subject.c_sources.is_empty() {
        let judged = (variant, subject.program);
        let check = emitted_c::check(oracle, judged, subject.c_sources);
        checks.push(check.map_err(describe_error)?);
    }
    if let Some(emitted) = subject.casadi {
        checks.extend(casadi::check(oracle, emitted).map_err(describe_error)?);
    }
    if let Some((emitted, program, inputs)) = subject.unit {
        let judged = (subject.model, program, inputs);
        checks.extend(unit::check(oracle, judged, emitted).map_err(describe_error)?);
    }
    Ok(checks)
}

/// Compares the requested outputs with the oracle, then the further outputs of the functions for CasADi.
fn output_checks(
    subject: &Subject<'_>,
    oracle: &Oracle,
    variant: &mut dyn Variant,
    requested: [Option<&mut (dyn Outputs + 'static)>; 2],
) -> Result<Vec<Check>, String> {
    let judged = CheckContext {
        oracle,
        model: subject.model,
        order: subject.order,
        parameters: subject.parameters,
    };
    let mut checks: Vec<Check> = Vec::new();
    for outputs in requested.into_iter().flatten() {
        let found = outputs::check(&judged, variant, outputs).map_err(describe_error)?;
        let is_new = |check: &Check| checks.iter().all(|known| known.name != check.name);
        let new: Vec<Check> = found.into_iter().filter(is_new).collect();
        checks.extend(new);
    }
    Ok(checks)
}

fn run_checks(subject: &Subject<'_>) -> Result<(Vec<Check>, Coverage), String> {
    let oracle = build_oracle(subject, subject.order)?;
    let mut variant = (subject.variants)(subject.order)?;
    let variant = variant.as_mut();
    let found = states::check(&oracle, variant, subject.references);
    let (mut checks, coverage) = found.map_err(describe_error)?;
    checks.extend_from_slice(subject.not_applicable);
    checks.push(balance::check(&oracle, variant).map_err(describe_error)?);
    let judged = (subject.model, subject.order, subject.parameters);
    checks.extend(integrals::check(&oracle, judged).map_err(describe_error)?);
    checks.extend(check_nesting(subject, &oracle, variant)?);
    checks.extend(check_rigid_limit(subject, variant)?);
    let mut outputs = subject.outputs.map(|make| make()).transpose()?;
    let of_casadi = subject
        .casadi
        .and_then(|(_, program)| program.as_ref().ok());
    let mut of_casadi =
        of_casadi.map(|program| DerivedOutputs::new(Evaluator::new(program.clone())));
    let casadi_outputs = of_casadi
        .as_mut()
        .map(|outputs| outputs as &mut dyn Outputs);
    let requested = [outputs.as_deref_mut(), casadi_outputs];
    checks.extend(output_checks(subject, &oracle, variant, requested)?);
    let casadi_outputs = of_casadi
        .as_mut()
        .map(|outputs| outputs as &mut dyn Outputs);
    let jacobians = outputs.as_deref_mut().or(casadi_outputs);
    checks.extend(zeros::check(&oracle, variant, jacobians).map_err(describe_error)?);
    let of_sources = outputs.as_deref_mut();
    checks.extend(source_checks(subject, &oracle, variant, of_sources)?);
    checks.push(match &subject.regimes {
        Ok(emitted) => regimes::check(&oracle, variant, emitted).map_err(describe_error)?,
        Err(reason) => regimes::skipped_check(reason),
    });
    checks.push(match &subject.exact {
        Ok(derivative) => exact::check(&oracle, variant, *derivative).map_err(describe_error)?,
        Err(reason) => exact::skipped_check(reason),
    });
    checks.extend(variant.corner().map(|surface| {
        let reason = format!(
            "the energies jump where `{surface}` is zero; the checks cover the equations beside that surface, \
             not the jump of the rates"
        );
        Check::with_skip("corners".to_owned(), 0.0, SkipKind::NotRun, reason)
    }));
    Ok((checks, coverage))
}

fn build_oracle(subject: &Subject<'_>, order: usize) -> Result<Oracle, String> {
    Oracle::new(subject.model, order, subject.parameters).map_err(describe_error)
}

fn describe_error(error: OracleError) -> String {
    format!("the oracle cannot evaluate this model: {error}")
}

fn check_nesting(
    subject: &Subject<'_>,
    oracle: &Oracle,
    variant: &mut dyn Variant,
) -> Result<Vec<Check>, String> {
    if subject.model.fields.is_empty() {
        return Ok(skipped_checks("nesting", "the model has no field"));
    }
    let found = if subject.order < subject.model.highest_order() {
        let mut larger = (subject.variants)(subject.order + 1)?;
        nesting::check("nesting", oracle, variant, larger.as_mut())
    } else {
        let order = subject.order.saturating_sub(1);
        if order < subject.model.lowest_order() {
            return Ok(skipped_checks("nesting", SMALLER_MISSING));
        }
        let smaller = self::build_oracle(subject, order)?;
        let mut small = (subject.variants)(order)?;
        nesting::check("nesting", &smaller, small.as_mut(), variant)
    };
    Ok(found.map_err(describe_error)?.into())
}

fn check_rigid_limit(
    subject: &Subject<'_>,
    variant: &mut dyn Variant,
) -> Result<Vec<Check>, String> {
    const NAME: &str = "rigid_limit";
    if subject.model.fields.is_empty() {
        return Ok(skipped_checks(NAME, "the model has no field"));
    }
    if subject.order == 0 {
        return Ok(skipped_checks(NAME, "order 0 is the rigid model itself"));
    }
    if subject.model.lowest_order() > 0 {
        return Ok(skipped_checks(NAME, SMALLER_MISSING));
    }
    let oracle = build_oracle(subject, 0)?;
    if oracle.size() == 0 {
        return Ok(skipped_checks(NAME, "the rigid model has no coordinate"));
    }
    let mut rigid = (subject.variants)(0)?;
    let found = nesting::check(NAME, &oracle, rigid.as_mut(), variant).map_err(describe_error)?;
    Ok(found.into())
}

fn skipped_checks(name: &str, reason: &str) -> Vec<Check> {
    [
        ("mass", MASS_TOLERANCE),
        ("bias", ROW_TOLERANCE),
        ("forces", ROW_TOLERANCE),
    ]
    .map(|(part, tolerance)| Check::not_applicable(format!("{name}_{part}"), tolerance, reason))
    .into()
}
