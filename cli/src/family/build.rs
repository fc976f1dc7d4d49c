//! Emits and certifies one variant of a family.

use std::collections::BTreeMap;
use std::path::PathBuf;

use eomgen_codegen::c::{self, Real};
use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust;
use eomgen_codegen::variant::Variant as Derived;
use eomgen_model_spec::model::Model;
use eomgen_validate::certify::CCompiler;
use eomgen_validate::model_certificate::{Sources, certify_sources, unchecked_certificate};
use serde_json::Value;

use super::description::{Family, Precision, Variant};
use super::hashes::hash_file;
use super::options::Options;
use crate::arguments::{Extra, Packaging, Target};
use crate::certification::document;
use crate::emission::{self, c_source, header_only_source};
use crate::emitted_files::{CERTIFICATE, check_names};
use crate::error::{Error, Result};
use crate::settings::with_settings;
use crate::test_vectors;
use crate::trace_file::{self, TRACE};

/// Emitted files of a variant.
pub struct BuiltVariant {
    pub name: String,
    /// Name of the model.
    pub model: String,
    pub orders: Vec<usize>,
    pub states: usize,
    /// Hashes of the files of the model, by their paths relative to the family file.
    pub inputs: BTreeMap<String, String>,
    /// Contents of the emitted files and the certificate, by paths relative to the output folder.
    pub files: BTreeMap<String, Vec<u8>>,
    /// Number of operations of one call, by function.
    pub operations: BTreeMap<&'static str, usize>,
    /// Verdict of the certificate.
    pub verdict: String,
    pub passed: bool,
    /// Rendered warnings about the specification.
    pub warnings: Vec<String>,
}

/// Derives, emits and certifies a variant. With `check`, no certificate checks are run. If the certificate in the
/// output folder belongs to the emitted sources, its verdict is read.
pub fn build(family: &Family, variant: &Variant, options: &Options<'_>) -> Result<BuiltVariant> {
    let path = family.folder().join(&variant.spec);
    let checked = eomgen_model_spec::load(&path).map_err(Error::Specification)?;
    let warnings = match checked.warnings.is_empty() {
        true => Vec::new(),
        false => vec![checked.warnings.render(false)],
    };
    let model = with_settings(checked.model, &variant.settings)?;
    let orders = model.orders(variant.order);
    let orders = orders.map_err(|error| Error::model(&model.source, error))?;
    let mut emitted = Emitted::new(variant, &model, &orders)?;
    let certificate = certificate(variant, &model, &orders, &emitted, options)?;
    emitted
        .files
        .insert(CERTIFICATE.to_owned(), certificate.text.into_bytes());
    let inside = |(file, contents)| (format!("{}/{file}", variant.name), contents);
    Ok(BuiltVariant {
        name: variant.name.clone(),
        model: model.name.clone(),
        states: emitted.states,
        inputs: hash_input_files(family, &model)?,
        files: emitted.files.into_iter().map(inside).collect(),
        operations: emitted.operations,
        verdict: certificate.verdict,
        passed: certificate.passed,
        warnings,
        orders,
    })
}

/// Emitted sources by file names.
struct Emitted {
    files: BTreeMap<String, Vec<u8>>,
    sources: Sources,
    outputs: Vec<Output>,
    operations: BTreeMap<&'static str, usize>,
    states: usize,
}

impl Emitted {
    fn new(variant: &Variant, model: &Model, orders: &[usize]) -> Result<Self> {
        let hessians = Extra::Output(Output::Hessians);
        let (of_casadi, others): (Vec<Extra>, Vec<Extra>) =
            variant.with.iter().partition(|extra| **extra == hessians);
        let for_optimisers = [Target::Acados, Target::Casadi];
        let for_optimisers = for_optimisers
            .into_iter()
            .find(|target| variant.has(*target));
        if !of_casadi.is_empty() && for_optimisers.is_none() {
            return Err(Error::input(
                "`hessians` needs the target `casadi` or `acados`",
            ));
        }
        let derive = |outputs: &[Output]| {
            let derived = Derived::derive_with_trace(model, orders, outputs);
            let mut derived = derived.map_err(Error::Specification)?;
            derived.program.name.clone_from(&variant.prefix);
            Ok::<Derived, Error>(derived)
        };
        // Only emitted Rust has SIMD lanes.
        let outputs = Extra::select_outputs(&others);
        let derived = derive(&outputs)?;
        let program = &derived.program;
        let mut files: Vec<(String, Vec<u8>)> = Vec::new();
        let mut this = Self {
            files: BTreeMap::new(),
            sources: Sources::default(),
            operations: program.count_operations_by_function().into_iter().collect(),
            states: program.states(),
            outputs,
        };
        if variant.has(Target::Rust) {
            let (packaging, file) = match variant.is_module() {
                true => (rust::Packaging::Module, "mod.rs"),
                false => (rust::Packaging::Crate, "lib.rs"),
            };
            let text = emission::source(program, packaging)?;
            files.push((file.to_owned(), text.clone().into_bytes()));
            this.sources.rust = Some(text);
            files.extend(test_vectors::files(
                model,
                orders,
                program,
                &others,
                Target::Rust,
            )?);
        }
        if variant.has(Target::C99) {
            emission::outputs(Target::C99, &others, false)?;
            for (prefix, precision) in variant.c_prefixes() {
                files.extend(this.emit_c(&derived, (&prefix, variant.packaging), precision)?);
                let mut program = program.clone();
                program.name.clone_from(&prefix);
                let vectors = test_vectors::files(model, orders, &program, &others, Target::C99)?;
                for (name, contents) in vectors {
                    // `vectors.json` contains both precisions. For the variant's own prefix, the header is `vectors.h`;
                    // for the prefix of another precision, it is `PREFIX_vectors.h`.
                    match (prefix == variant.prefix, &*name) {
                        (false, "vectors.json") => {}
                        (false, "vectors.h") => files.push((format!("{prefix}_{name}"), contents)),
                        _ => files.push((name, contents)),
                    }
                }
            }
        }
        if variant.has(Target::Cuda) {
            files.extend(emission::files(model, &derived, (Target::Cuda, None))?);
        }
        if others.contains(&Extra::Trace) {
            let sources = files.iter().map(|(name, text)| (&**name, &**text));
            let trace = trace_file::document(program, sources)?;
            files.push((TRACE.to_owned(), trace.into_bytes()));
        }
        if let Some(target) = for_optimisers {
            let outputs = emission::outputs(target, &of_casadi, false)?;
            let derived = derive(&outputs)?;
            let emitted = emission::files(model, &derived, (target, None))?;
            let sources = emission::sources(&variant.prefix, target, &emitted, &outputs)?;
            this.sources.casadi = sources.casadi;
            files.extend(emitted);
        }
        let contents = files.iter().map(|(name, text)| (&**name, &**text));
        check_names(contents.chain([(CERTIFICATE, &[][..])]))?;
        this.files.extend(files);
        Ok(this)
    }

    /// Adds the C source to `sources` for certification and returns its files.
    fn emit_c(
        &mut self,
        derived: &Derived,
        (prefix, packaging): (&str, Packaging),
        precision: Precision,
    ) -> Result<Vec<(String, Vec<u8>)>> {
        let real = match precision {
            Precision::Double => Real::Double,
            Precision::Single => Real::Single,
        };
        let mut program = derived.program.clone();
        prefix.clone_into(&mut program.name);
        let compiler = CCompiler::default();
        let (source, files) = match packaging {
            Packaging::HeaderOnly => {
                let header = c::emit_header_only(&program, real)?;
                let files = vec![("h", header.clone())];
                let source = header_only_source(prefix, header, &self.outputs, compiler);
                (source, files)
            }
            Packaging::Module | Packaging::Crate => {
                let c::Files { source, header } = c::emit_with(&program, real)?;
                let files = vec![("c", source.clone()), ("h", header.clone())];
                let source = c_source(prefix, (source, header), &self.outputs, compiler);
                (source, files)
            }
        };
        self.sources.c.push(source);
        let named =
            |(ending, text): (&str, String)| (format!("{prefix}.{ending}"), text.into_bytes());
        Ok(files.into_iter().map(named).collect())
    }
}

struct CertificateText {
    text: String,
    verdict: String,
    passed: bool,
}

fn certificate(
    variant: &Variant,
    model: &Model,
    orders: &[usize],
    emitted: &Emitted,
    options: &Options<'_>,
) -> Result<CertificateText> {
    let Emitted {
        sources, outputs, ..
    } = emitted;
    if !options.check {
        let certificate = certify_sources(model, orders, outputs, sources)?;
        return Ok(CertificateText {
            text: document(&certificate)?,
            verdict: certificate.verdict.name().to_owned(),
            passed: certificate.passed,
        });
    }
    let order = orders.first().copied().unwrap_or(0);
    let expected = unchecked_certificate(model, order, outputs, sources);
    let expected = expected.map_err(|error| Error::model(&model.source, error))?;
    let expected =
        serde_json::to_value(expected).map_err(|error| Error::input(error.to_string()))?;
    let path = options.out.join(&variant.name).join(CERTIFICATE);
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let found: Value = serde_json::from_str(&text).unwrap_or_default();
    let of_checks = ["passed", "verdict", "coverage", "checks"];
    let is_same =
        |(key, value): (&String, &Value)| of_checks.contains(&key.as_str()) || found[key] == *value;
    let belongs = expected
        .as_object()
        .is_some_and(|fields| fields.iter().all(is_same));
    let verdict = found["verdict"].as_str().filter(|_| belongs);
    Ok(CertificateText {
        verdict: verdict.unwrap_or("stale").to_owned(),
        text,
        // A comparison reports the verdict separately and writes nothing.
        passed: true,
    })
}

fn hash_input_files(family: &Family, model: &Model) -> Result<BTreeMap<String, String>> {
    let folder = family.folder();
    let hash = |path: PathBuf| {
        let name = path.strip_prefix(folder).unwrap_or(&path);
        let name = name.to_string_lossy().replace('\\', "/");
        let hash = hash_file(&path)
            .ok_or_else(|| Error::input(format!("cannot read {}", path.display())))?;
        Ok((name, hash))
    };
    model.files().into_iter().map(hash).collect()
}
