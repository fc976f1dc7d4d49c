//! `eomgen verify`: repeats the checks of a certificate on an emitted source as it is.

use std::collections::BTreeSet;
use std::path::Path;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::{Source, sha256};
use eomgen_targets::parse_output;
use eomgen_validate::certificate::{CSourceHashes, CasadiHash, UnitHash, Verdict};
use eomgen_validate::certify::{CCompiler, CasadiSource};
use eomgen_validate::instructions::InstructionBounds;
use eomgen_validate::model_certificate::{Sources, certify_sources};
use serde_json::{Value, json};

use crate::arguments::Verify;
use crate::certification::{has_valid_hash, summary};
use crate::document::SCHEMA;
use crate::emission::{c_source, casadi_source, header_only_source, instructions, unit_source};
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::input_file::read_file;
use crate::progress::Note;

pub fn run(options: &Verify) -> Result {
    let certificate = Certificate::read(&options.certificate)?;
    let contents = read_file(&options.file)?;
    let (sources, expected) = sources(options, &certificate, &contents)?;
    let found = sha256(&contents);
    // In header-only packaging, the header with the functions is the file itself.
    let mut with_header = sources
        .c
        .iter()
        .filter(|source| source.header.as_bytes() != contents);
    let is_header_same = with_header.all(|source| {
        let certified = certificate.c_source(&source.name);
        certified.is_some_and(|certified| certified.header_sha256 == sha256(&source.header))
    });
    let is_same = expected == found && is_header_same;
    let repeated = {
        let _note = Note::new(format!("verifying {}", options.file.display()));
        let orders = vec![certificate.order; certificate.model.fields.len()];
        certify_sources(&certificate.model, &orders, &certificate.outputs, &sources)?
    };
    let mut document =
        serde_json::to_value(&repeated).map_err(|error| Error::input(error.to_string()))?;
    certificate.compare_statements(&document, &options.certificate)?;
    let bounds = certificate.repeat_bounds(&sources, &options.instructions)?;
    certificate.check_content(&options.certificate)?;
    let is_partial = bounds.is_partial && repeated.verdict == Verdict::Passed;
    if options.output.json {
        document["schema"] = json!(SCHEMA);
        document["file"] = json!(options.file.display().to_string());
        document["hash"] = json!({"expected": expected, "found": found, "same": is_same});
        document["instructions"] = json!(bounds.found);
        if is_partial {
            document["verdict"] = json!(Verdict::Partial);
        }
        document["passed"] = json!(repeated.passed && is_same);
        print_json(&document)?;
    } else {
        let hash = match is_same {
            true => format!("hash: as certified, {found}\n"),
            false if !is_header_same => {
                "hash: the header is DIFFERENT from the certified one\n".to_owned()
            }
            false => format!("hash: DIFFERENT, {found} instead of {expected}\n"),
        };
        let summary = summary(&repeated);
        let text = match summary.strip_suffix("passed\n") {
            Some(checks) if is_partial => {
                let text = format!("{checks}{}{hash}", bounds.text);
                text + "PARTIAL: no check failed, but bounds of instructions were not computed again\n"
            }
            _ => summary + &bounds.text + &hash,
        };
        print_text(&text)?;
    }
    if !is_same {
        warn(&format!(
            "error: {} is not the certified source: it was edited or generated again",
            options.file.display()
        ));
    }
    match repeated.passed && is_same {
        true => Ok(()),
        false => Err(Error::Failed),
    }
}

/// Recomputed bounds of instructions and stack.
#[derive(Default)]
struct RepeatedBounds {
    /// Recomputed bounds; they equal the bounds in the certificate.
    found: Vec<InstructionBounds>,
    /// True if bounds of the certificate were not recomputed.
    is_partial: bool,
    /// Text with one line for each compiler.
    text: String,
}

/// Certificate with the model that its checks need.
struct Certificate {
    /// Text of the certificate.
    text: String,
    /// The whole certificate.
    document: Value,
    /// Model with the parameter values of `settings`.
    model: Model,
    order: usize,
    outputs: Vec<Output>,
    source_sha256: String,
    c_sources: Vec<CSourceHashes>,
    casadi: Option<CasadiHash>,
    unit: Option<UnitHash>,
}

impl Certificate {
    fn read(path: &Path) -> Result<Self> {
        let text = read(path)?;
        let shown = path.display();
        let document: Value = serde_json::from_str(&text).map_err(|error| {
            Error::input(format!(
                "{shown}:{}:{}: this is not a certificate: {error}",
                error.line(),
                error.column()
            ))
        })?;
        let cure = "give a certificate that `eomgen generate --certify` or `eomgen family` wrote";
        let missing =
            |key: &str| Error::input(format!("{shown}: the certificate has no `{key}`; {cure}"));
        let string = |key: &str| {
            document[key]
                .as_str()
                .map(str::to_owned)
                .ok_or_else(|| missing(key))
        };
        let specification = string("specification")?;
        let with = document["with"].as_array().ok_or_else(|| missing("with"))?;
        let outputs = with.iter().map(|name| {
            let name = name.as_str().unwrap_or_default();
            name.parse::<Output>()
                .map_err(|error| Error::input(format!("{shown}: {error}")))
        });
        let outputs = outputs.collect::<Result<Vec<Output>>>()?;
        let order = document["order"]
            .as_u64()
            .and_then(|order| usize::try_from(order).ok());
        let order = order.ok_or_else(|| missing("order"))?;
        let source = Source::new(format!("{shown}, specification"), specification);
        if source.hash() != string("specification_sha256")? && !specification_has_tables(&source) {
            return Err(Error::input(format!(
                "{shown}: the specification in the certificate does not have the hash `specification_sha256`: \
                 the certificate was edited"
            )));
        }
        let checked = eomgen_model_spec::check(source).map_err(Error::Specification)?;
        let settings = document["settings"]
            .as_object()
            .ok_or_else(|| missing("settings"))?;
        let c_sources = document["c_sources"]
            .as_array()
            .ok_or_else(|| missing("c_sources"))?;
        let c_sources = c_sources.iter().map(|source| {
            let of = |key: &str| source[key].as_str().map(str::to_owned);
            Some(CSourceHashes {
                name: of("name")?,
                source_sha256: of("source_sha256")?,
                header_sha256: of("header_sha256")?,
            })
        });
        let c_sources = c_sources.collect::<Option<_>>();
        let c_sources = c_sources.ok_or_else(|| missing("c_sources"))?;
        let casadi = match &document["casadi"] {
            Value::Null => None,
            casadi => Some(casadi_hash(casadi).ok_or_else(|| missing("casadi"))?),
        };
        let unit = match &document["unit"] {
            Value::Null => None,
            unit => Some(unit_hash(unit).ok_or_else(|| missing("unit"))?),
        };
        let settings = settings.iter().map(|(name, value)| match value.as_f64() {
            Some(value) => Ok((name.as_str(), value)),
            None => Err(Error::input(format!(
                "{shown}: the value of `{name}` in `settings` is not a number: the certificate was edited"
            ))),
        });
        let settings = settings.collect::<Result<Vec<_>>>()?;
        let model = checked.model.with_parameters(&settings);
        let model = model.map_err(|error| Error::model(&checked.model.source, error))?;
        model
            .orders((!model.fields.is_empty()).then_some(order))
            .map_err(|error| Error::model(&model.source, error))?;
        Ok(Self {
            model,
            order,
            outputs,
            source_sha256: string("source_sha256")?,
            c_sources,
            casadi,
            unit,
            document,
            text,
        })
    }

    /// Returns the hashes of the emitted C with this prefix.
    fn c_source(&self, name: &str) -> Option<&CSourceHashes> {
        self.c_sources.iter().find(|source| source.name == name)
    }

    /// Compiles the C again with each `allowed` command for which the certificate contains bounds of instructions and
    /// stack, and compares the bounds. Other commands of the certificate are not run, because the file may be from an
    /// untrusted source.
    ///
    /// # Errors
    /// Bounds that differ although the compiler is the same, or a command without bounds in the certificate.
    fn repeat_bounds(&self, sources: &Sources, allowed: &[String]) -> Result<RepeatedBounds> {
        let mut repeated = RepeatedBounds::default();
        let stated = match &self.document["instructions"] {
            Value::Null => Ok(Vec::new()),
            stated => serde_json::from_value::<Vec<InstructionBounds>>(stated.clone()),
        };
        let stated = stated
            .map_err(|error| Error::input(format!("`instructions` of the certificate: {error}")))?;
        let is_same = |one: &str, other: &str| one.split_whitespace().eq(other.split_whitespace());
        for command in allowed {
            if !stated
                .iter()
                .any(|stated| is_same(&stated.command, command))
            {
                return Err(Error::input(format!(
                    "--instructions {command:?}: the certificate contains no bounds for this command"
                )));
            }
        }
        for stated in stated {
            let InstructionBounds {
                source,
                command,
                compiler,
                functions,
                ..
            } = stated;
            let mut given = sources.c.iter();
            let found = match given.find(|given| format!("{}.c", given.name) == source) {
                Some(_) if !allowed.iter().any(|allowed| is_same(allowed, &command)) => {
                    Err("give this command as --instructions".to_owned())
                }
                Some(given) => instructions(given, &command),
                None => Err(format!("the certificate has the bounds of {source}")),
            };
            repeated.is_partial |= !matches!(&found, Ok(found) if found.compiler == compiler);
            let result = match found {
                Err(reason) => format!("NOT RUN ({reason})"),
                Ok(found) if found.compiler != compiler => format!(
                    "NOT RUN (this compiler is {}, but the certificate has bounds for {compiler})",
                    found.compiler
                ),
                Ok(found) if found.functions == functions => {
                    repeated.found.push(found);
                    "as certified".to_owned()
                }
                Ok(_) => {
                    return Err(Error::Stopped(format!(
                        "the bounds of instructions and stack with `{command}` differ from those in the certificate"
                    )));
                }
            };
            repeated.text += &format!("instructions and stack: {result}, {command}\n");
        }
        Ok(repeated)
    }

    /// Returns true if the certificate covers a Rust file, because its source hash is not the hash of another file.
    fn covers_rust(&self) -> bool {
        let c = self.c_sources.iter().map(|c| &c.source_sha256);
        let casadi = self.casadi.iter().map(|c| &c.source_sha256);
        let unit = self.unit.iter().map(|unit| &unit.sha256);
        !c.chain(casadi)
            .chain(unit)
            .any(|hash| *hash == self.source_sha256)
    }

    /// Returns the names of the emitted C files.
    fn c_files(&self) -> String {
        let files = self.c_sources.iter().map(|c| format!("{}.c", c.name));
        let casadi = self.casadi.iter().map(|c| format!("{}_casadi.c", c.name));
        let files: Vec<String> = files.chain(casadi).collect();
        match files.is_empty() {
            true => "no C".to_owned(),
            false => files.join(" and "),
        }
    }

    /// Compares the statements of the certificate with the repeated certificate.
    ///
    /// # Errors
    /// The first statement that differs.
    fn compare_statements(&self, repeated: &Value, path: &Path) -> Result {
        let shown = path.display();
        let stated = ["model", "order", "parameters"];
        let different = stated
            .iter()
            .find(|key| self.document[**key] != repeated[**key]);
        if let Some(key) = different {
            return Err(Error::input(format!(
                "{shown}: `{key}` is {} and not that of the specification, {}: the certificate was edited",
                self.document[*key], repeated[*key]
            )));
        }
        let names = |document: &Value| -> BTreeSet<String> {
            let checks = document["checks"].as_array().into_iter().flatten();
            let names = checks.filter_map(|check| check["name"].as_str().map(str::to_owned));
            names.collect()
        };
        if let Some(missing) = names(repeated).difference(&names(&self.document)).next() {
            return Err(Error::input(format!(
                "{shown}: the certificate has no check `{missing}`: it was edited"
            )));
        }
        let verdict = self.document["verdict"].as_str().unwrap_or_default();
        if !matches!(verdict, "passed" | "partial") {
            return Err(Error::input(format!(
                "{shown}: the certificate states that checks failed: generate the file again"
            )));
        }
        if self.document["passed"] != json!(verdict == "passed") {
            return Err(Error::input(format!(
                "{shown}: `passed` is {}, but `verdict` is \"{verdict}\": the certificate was edited",
                self.document["passed"]
            )));
        }
        self.compare_checks(repeated, &shown)
    }

    /// Compares the stated results of checks with the repeated checks.
    ///
    /// # Errors
    /// A check that did not pass, or with another tolerance.
    fn compare_checks(&self, repeated: &Value, shown: &impl std::fmt::Display) -> Result {
        let all = |document: &'_ Value| document["checks"].as_array().cloned().unwrap_or_default();
        let repeated = all(repeated);
        for stated in all(&self.document) {
            let name = &stated["name"];
            let was_run = |check: &Value| check["skipped"] == json!(false);
            if was_run(&stated) && stated["passed"] != json!(true) {
                return Err(Error::input(format!(
                    "{shown}: the certificate states that the check {name} failed, but not its `verdict`: it was edited"
                )));
            }
            let mut again = repeated.iter().filter(|check| check["name"] == *name);
            let tolerance = again
                .next()
                .filter(|check| was_run(check) && was_run(&stated))
                .map(|check| &check["tolerance"]);
            if let Some(tolerance) = tolerance.filter(|of| **of != stated["tolerance"]) {
                return Err(Error::input(format!(
                    "{shown}: the tolerance of the check {name} is {} instead of {tolerance}: the certificate was edited",
                    stated["tolerance"]
                )));
            }
        }
        Ok(())
    }

    /// Compares the hash at the end of the certificate with its content.
    ///
    /// # Errors
    /// A different hash, or none.
    fn check_content(&self, path: &Path) -> Result {
        let shown = path.display();
        match has_valid_hash(&self.text) {
            Some(true) => Ok(()),
            Some(false) => Err(Error::input(format!(
                "{shown}: the content does not have the hash `content_sha256`: the certificate was edited"
            ))),
            None => Err(Error::input(format!(
                "{shown}: the certificate does not end with `content_sha256`: generate the file and its certificate again"
            ))),
        }
    }
}

fn unit_hash(document: &Value) -> Option<UnitHash> {
    let of = |key: &str| document[key].as_str().map(str::to_owned);
    Some(UnitHash {
        name: of("name")?,
        sha256: of("sha256")?,
    })
}

fn casadi_hash(document: &Value) -> Option<CasadiHash> {
    let of = |key: &str| document[key].as_str().map(str::to_owned);
    let with = document["with"].as_array()?.iter();
    Some(CasadiHash {
        name: of("name")?,
        source_sha256: of("source_sha256")?,
        with: with
            .map(|name| name.as_str().map(str::to_owned))
            .collect::<Option<_>>()?,
    })
}

/// Returns true if the specification reads tables. In that case its hash includes the hashes of the tables.
fn specification_has_tables(source: &Source) -> bool {
    source.text.contains("table")
}

/// Returns the source to check and the hash that the certificate contains for this language.
fn sources(
    options: &Verify,
    certificate: &Certificate,
    contents: &[u8],
) -> Result<(Sources, String)> {
    let path = &options.file;
    let shown = path.display();
    let extension = path.extension().and_then(|ending| ending.to_str());
    let compiler = match &options.cc {
        None => CCompiler::default(),
        Some(command) => CCompiler::from_command(command)
            .ok_or_else(|| Error::input("--cc is blank: give a command such as \"gcc -O2\""))?,
    };
    if extension == Some("fmu") {
        let unit = certificate.unit.as_ref().ok_or_else(|| {
            Error::input(format!(
                "{shown}: the certificate covers no functional mock-up unit (FMU); give the certificate that was \
                 written with the file"
            ))
        })?;
        let sources = Sources {
            unit: Some(unit_source(&unit.name, contents, compiler)?),
            ..Sources::default()
        };
        return Ok((sources, unit.sha256.clone()));
    }
    let text = String::from_utf8(contents.to_vec())
        .map_err(|error| Error::input(format!("cannot read {shown}: {error}")))?;
    match extension {
        Some("rs") if options.cc.is_some() => Err(Error::input(format!(
            "--cc applies only to C; {shown} is Rust, which `rustc` or the program in RUSTC compiles"
        ))),
        Some("rs") if !certificate.covers_rust() => Err(Error::input(format!(
            "{shown}: the certificate covers {}, not Rust; give the certificate that was written with the file",
            certificate.c_files()
        ))),
        Some("rs") => Ok((
            Sources {
                rust: Some(text),
                ..Sources::default()
            },
            certificate.source_sha256.clone(),
        )),
        Some("c" | "h") => {
            let name = path
                .file_stem()
                .and_then(|name| name.to_str())
                .unwrap_or_default();
            let casadi = certificate.casadi.as_ref();
            if let Some(certified) = casadi.filter(|c| name == format!("{}_casadi", c.name)) {
                let sources = Sources {
                    casadi: Some(certified_casadi(certified, text, compiler)?),
                    ..Sources::default()
                };
                return Ok((sources, certified.source_sha256.clone()));
            }
            let is_header = extension == Some("h");
            if is_header && !text.contains(&format!("{name}_IMPLEMENTATION")) {
                return Err(Error::input(format!(
                    "{shown} contains declarations only: give the source next to it, {name}.c"
                )));
            }
            let expected = certificate.c_source(name).ok_or_else(|| {
                let covered = certificate.c_files();
                Error::input(format!(
                    "{shown}: the certificate covers {covered}; give the certificate that was written with the file"
                ))
            })?;
            let outputs = &certificate.outputs;
            let (source, expected) = match is_header {
                true => (
                    header_only_source(name, text, outputs, compiler),
                    expected.header_sha256.clone(),
                ),
                false => {
                    let header = read(&path.with_extension("h"))?;
                    (
                        c_source(name, (text, header), outputs, compiler),
                        expected.source_sha256.clone(),
                    )
                }
            };
            let sources = Sources {
                c: vec![source],
                ..Sources::default()
            };
            Ok((sources, expected))
        }
        _ => Err(Error::input(format!(
            "{shown} is neither Rust nor C nor an FMU: give a file that ends in .rs, .c, .h or .fmu"
        ))),
    }
}

/// Returns the emitted functions for CasADi with the outputs that their certificate lists.
fn certified_casadi(
    certified: &CasadiHash,
    text: String,
    compiler: CCompiler,
) -> Result<CasadiSource> {
    let with = certified.with.iter().map(|name| parse_output(name));
    let with = with.collect::<std::result::Result<Vec<Output>, String>>();
    let with = with.map_err(Error::input)?;
    Ok(casadi_source(&certified.name, text, &with, compiler))
}

fn read(path: &Path) -> Result<String> {
    String::from_utf8(read_file(path)?).map_err(|error| Error::file("read", path, &error))
}
