//! Reads a family file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use eomgen_codegen::{c, rust};
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::keys::{Key, Keys, Kind};
use eomgen_model_spec::quantity::{Quantity, StringValue};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::table::Entry;
use eomgen_model_spec::toml_file;
use serde_json::{Value, json};

use crate::arguments::{Extra, Packaging, Target};
use crate::error::{Error, Result};

/// Maximum size of a family file, in bytes.
const MAX_SIZE: u64 = 1 << 20;

/// Maximum number of variants.
const MAX_VARIANTS: usize = 2000;

/// Default of the permitted increase of operation counts, as a fraction.
const DEFAULT_GROWTH: f64 = 0.05;

/// Reserved prefixes: the common files declare the C type `eomgen_model` and the Rust trait `Model`.
const FAMILY_NAMES: [&str; 2] = ["eomgen", "Model"];

static FAMILY: Keys = Keys::new(&[
    Key::new("name", "name", "\"slew\"", "name of the family").required(),
    Key::new(
        "operation_growth",
        "fraction",
        "0.05",
        "permitted increase of operation counts in `--check`",
    ),
]);

static VARIANT: Keys = Keys::new(&[
    Key::new(
        "name",
        "name",
        "\"slew_3\"",
        "name of the variant and of its folder",
    )
    .required(),
    Key::new(
        "spec",
        "text",
        "\"slew.toml\"",
        "specification; relative to this file",
    )
    .required(),
    Key::new(
        "prefix",
        "name",
        "\"slew_3\"",
        "prefix of C names and name of the Rust module",
    ),
    Key::new("order", "mode_count", "3", "modal truncation order"),
    Key::new("set", "table", "{ b = 0 }", "values of parameters"),
    Key::new("targets", "list", "[\"rust\", \"c99\"]", "languages"),
    Key::new("with", "list", "[\"jacobians\"]", "additional functions"),
    Key::new(
        "precision",
        "list",
        "[\"f64\", \"f32\"]",
        "number types of the emitted C",
    ),
    Key::new(
        "packaging",
        "text",
        "\"module\"",
        "form of the emitted source",
    ),
]);

static SECTIONS: Keys = Keys::new(&[
    Key::nested("family", Kind::Table(&FAMILY), "", "name of the family"),
    Key::nested("variant", Kind::Table(&VARIANT), "", "variants"),
]);

/// Family of variants.
pub struct Family {
    /// Path of the family file.
    pub path: PathBuf,
    pub name: String,
    /// Permitted increase of operation counts, as a fraction.
    pub growth: f64,
    pub variants: Vec<Variant>,
}

impl Family {
    /// Returns the folder of the family file.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }
}

/// Variant in a family file.
pub struct Variant {
    pub name: String,
    /// Line of the entry in the family file.
    pub line: usize,
    /// Prefix of C names and name of the Rust module.
    pub prefix: String,
    /// Path of the specification, relative to the family file.
    pub spec: String,
    pub order: Option<usize>,
    /// Values of parameters, as `NAME=VALUE`.
    pub settings: Vec<String>,
    pub targets: Vec<Target>,
    pub with: Vec<Extra>,
    with_names: Vec<String>,
    pub precision: Vec<Precision>,
    pub packaging: Packaging,
}

/// Number type of emitted C.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    Double,
    Single,
}

impl Variant {
    /// Returns true if the targets contain `target`.
    pub fn has(&self, target: Target) -> bool {
        self.targets.contains(&target)
    }

    /// Returns true if the emitted Rust is a module, not the root of a crate.
    pub fn is_module(&self) -> bool {
        self.packaging != Packaging::Crate
    }

    /// Returns the prefixes of the emitted C, with their number types.
    pub fn c_prefixes(&self) -> Vec<(String, Precision)> {
        let prefix = |precision: &Precision| match (precision, self.precision.len()) {
            (Precision::Single, 2) => (format!("{}_f32", self.prefix), Precision::Single),
            (precision, _) => (self.prefix.clone(), *precision),
        };
        self.precision.iter().map(prefix).collect()
    }

    /// Returns all entries of the variant in the family file that the emitted files depend on.
    pub fn definition(&self) -> Value {
        let target = |target: &Target| {
            target
                .to_possible_value()
                .map(|value| value.get_name().to_owned())
        };
        let precision = |precision: &Precision| match precision {
            Precision::Double => "f64",
            Precision::Single => "f32",
        };
        json!({
            "prefix": self.prefix,
            "spec": self.spec,
            "order": self.order,
            "set": self.settings,
            "targets": self.targets.iter().filter_map(target).collect::<Vec<_>>(),
            "with": self.with_names,
            "precision": self.precision.iter().map(precision).collect::<Vec<_>>(),
            "packaging": self.packaging.to_possible_value().map(|value| value.get_name().to_owned()),
        })
    }
}

/// Reads and checks a family file.
pub fn read(path: &Path) -> Result<Family> {
    let source = toml_file::source(path, MAX_SIZE).map_err(Error::Specification)?;
    if is_specification(&source.text) {
        return Err(Error::input(format!(
            "{} is a specification; a family file begins with [family] and lists variants of specifications",
            path.display()
        )));
    }
    let family = toml_file::read(&source, |top, found| {
        let mut reader = Reader {
            path,
            source: &source,
            found,
        };
        reader.family(top)
    });
    family.map_err(Error::Specification)
}

/// Returns true if a text contains the table `[model]` of a specification and no table of a family file.
fn is_specification(text: &str) -> bool {
    let has = |table: &str| text.lines().any(|line| line.trim_end().starts_with(table));
    has("[model]") && !has("[family]") && !has("[[variant]]")
}

struct Reader<'r> {
    path: &'r Path,
    source: &'r Source,
    found: &'r mut Diagnostics,
}

impl Reader<'_> {
    fn family(&mut self, top: &[Entry<'_>]) -> Option<Family> {
        let whole = eomgen_model_spec::quantity::Name {
            text: "the family file".to_owned(),
            span: eomgen_model_spec::span::Span::new(0, 0),
        };
        let sections = Record::new(whole, top.to_vec(), &SECTIONS, self.found).as_file();
        let help =
            "begin with [family] and name = \"my_family\", then one [[variant]] for each variant";
        let head = sections.require_with("family", help, self.found)?;
        let head = Record::read(head, &FAMILY, self.found)?;
        let name = head.required("name", Entry::written, self.found)?.text;
        let growth = head.number("operation_growth", self.found);
        if let Some(growth) = growth.filter(|growth| growth.value < 0.0) {
            let error = Diagnostic::error("`operation_growth` is negative");
            self.found
                .push(error.with_span(growth.span, "expected a fraction such as 0.05"));
        }
        let help = "add [[variant]] with name = \"NAME\" and spec = \"FILE.toml\"";
        let list = sections.require_with("variant", help, self.found)?;
        let entries = self.found.push_error(list.list("[[variant]]"))?;
        if let Some(excess) = entries.get(MAX_VARIANTS) {
            let error = Diagnostic::error(format!("more than {MAX_VARIANTS} variants"));
            self.found
                .push(error.with_span(excess.span(), "one too many"));
            return None;
        }
        let mut variants = Vec::with_capacity(entries.len());
        let mut used = UsedNames::default();
        for entry in &entries {
            variants.extend(self.variant(entry, &mut used));
        }
        Some(Family {
            path: self.path.to_owned(),
            name,
            growth: growth.map_or(DEFAULT_GROWTH, |growth| growth.value),
            variants,
        })
    }

    fn variant(&mut self, entry: &Entry<'_>, used: &mut UsedNames) -> Option<Variant> {
        let record = Record::read(entry, &VARIANT, self.found)?;
        let name = record.required("name", Entry::written, self.found)?;
        self.check_name(&name)?;
        let given = record.written("prefix", self.found);
        let prefix = given.as_ref().unwrap_or(&name);
        self.check_prefix(prefix)?;
        let spec = record.required("spec", Entry::written, self.found)?;
        self.check_spec(&spec)?;
        let order = record.optional("order", Entry::integer, self.found);
        let order = order.and_then(|(order, span)| match usize::try_from(order) {
            Ok(order) => Some(order),
            Err(_) => {
                let error = Diagnostic::error(format!("`order` cannot be {order}"));
                self.found
                    .push(error.with_span(span, "expected a whole number from 0"));
                None
            }
        });
        let words = |record: &Record<'_>, key: &str, found: &mut Diagnostics| {
            let list = record.get(key).map(|entry| entry.list("[\"...\"]"));
            let list = found.push_error(list.transpose())?;
            let words = list.map(|list| {
                let words = list.iter().map(|word| found.push_error(word.written()));
                words.collect::<Option<Vec<StringValue>>>()
            });
            Some(words.flatten())
        };
        let targets = words(&record, "targets", self.found)?;
        let targets = targets.map_or(Some(vec![Target::Rust]), |words| self.targets(&words));
        let with_names = words(&record, "with", self.found)?.unwrap_or_default();
        let with = self.extras(&with_names)?;
        let precision = words(&record, "precision", self.found)?;
        let precision = precision.map_or(Some(vec![Precision::Double]), |words| {
            self.precision(&words)
        });
        let packaging = record.optional(
            "packaging",
            |entry| {
                entry.keyword(&[
                    ("module", Packaging::Module),
                    ("crate", Packaging::Crate),
                    ("header-only", Packaging::HeaderOnly),
                ])
            },
            self.found,
        );
        let targets = targets?;
        if packaging == Some(Packaging::HeaderOnly) && !targets.contains(&Target::C99) {
            let message = "`packaging = \"header-only\"` needs the target \"c99\", which this variant does not have";
            let span = record.get("packaging").map_or(name.span, Entry::span);
            let error = Diagnostic::error(message).with_span(span, "expected `module` or `crate`");
            self.found
                .push(error.with_help("add \"c99\" to `targets`, or remove `packaging`"));
            return None;
        }
        let precision = precision?;
        if precision.contains(&Precision::Single) && !targets.contains(&Target::C99) {
            let message = "`precision = [\"f32\"]` needs the target \"c99\", which this variant does not have";
            let span = record.get("precision").map_or(name.span, Entry::span);
            let error = Diagnostic::error(message).with_span(span, "no target has this precision");
            self.found.push(error.with_help(
                "add \"c99\" to `targets`, or remove `precision`: emitted Rust is generic over `f64` and `f32`",
            ));
            return None;
        }
        let variant = Variant {
            line: self.source.place(name.span.start).line,
            prefix: prefix.text.clone(),
            spec: spec.text,
            order,
            settings: self.settings(&record)?,
            targets,
            with,
            with_names: with_names.into_iter().map(|word| word.text).collect(),
            precision,
            packaging: packaging.unwrap_or(Packaging::Module),
            name: name.text.clone(),
        };
        let is_new = used.add_name(&name, self.found)
            & used.add_prefixes(
                &variant.c_prefixes(),
                given.as_ref().unwrap_or(&name),
                self.found,
            );
        is_new.then_some(variant)
    }

    /// Reports a name that is invalid as the name of a folder.
    fn check_name(&mut self, name: &StringValue) -> Option<()> {
        if is_identifier(&name.text) {
            return Some(());
        }
        let message = format!("a variant cannot have the name {}", quote(&name.text));
        let error = Diagnostic::error(message).with_span(
            name.span,
            "expected letters, digits and _, beginning with a letter",
        );
        self.found.push(error.with_help("write name = \"slew_3\""));
        None
    }

    fn check_prefix(&mut self, prefix: &StringValue) -> Option<()> {
        let language = match &*prefix.text {
            name if !is_identifier(name) || name.len() > 64 => "name of letters, digits and _",
            name if !c::is_identifier(name) => "reserved word of C or C++",
            name if !rust::is_identifier(name) => "reserved word of Rust",
            name if FAMILY_NAMES.contains(&name) => "name of the common files of the family",
            _ => return Some(()),
        };
        let message = match language != "name of letters, digits and _" {
            true => format!("the prefix {} is a {language}", quote(&prefix.text)),
            false => format!("the prefix {} is no {language}", quote(&prefix.text)),
        };
        let error = Diagnostic::error(message).with_span(
            prefix.span,
            "emitted C names begin with the prefix, and the Rust module has its name",
        );
        self.found
            .push(error.with_help("give another one with prefix = \"my_model\""));
        None
    }

    fn check_spec(&mut self, spec: &StringValue) -> Option<()> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let place = folder.join(&spec.text);
        let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
            (Ok(a), Ok(b)) => a == b,
            _ => false,
        };
        if !same(&place, self.path) {
            return Some(());
        }
        let error = Diagnostic::error("the family file is given as a specification")
            .with_span(spec.span, "this is the family file");
        self.found
            .push(error.with_help("give the file of the model"));
        None
    }

    fn targets(&mut self, words: &[StringValue]) -> Option<Vec<Target>> {
        let known = "expected \"rust\", \"c99\", \"cuda\", \"casadi\" or \"acados\"";
        let mut targets = Vec::new();
        for word in words {
            let target = Target::from_str(&word.text, false).ok();
            match target {
                Some(Target::Fmu2 | Target::Fmu3) => {
                    let message = "a functional mock-up unit (FMU) contains machine code for this computer, so its \
                                   bytes are not reproducible";
                    let error = Diagnostic::error(message).with_span(word.span, known);
                    self.found
                        .push(error.with_help("use `eomgen generate --target fmu2`"));
                    return None;
                }
                Some(target) => targets.push(target),
                None => {
                    let error = Diagnostic::error(format!("unknown target {}", quote(&word.text)));
                    self.found.push(error.with_span(word.span, known));
                    return None;
                }
            }
        }
        if targets.is_empty() {
            let message = "the variant has no targets";
            self.found.push(Diagnostic::error(message).with_help(known));
            return None;
        }
        Some(targets)
    }

    fn extras(&mut self, words: &[StringValue]) -> Option<Vec<Extra>> {
        let mut extras = Vec::new();
        for word in words {
            let extra = word.text.parse::<Extra>().and_then(|extra| match extra {
                Extra::Bench => {
                    Err("a family has no benchmarks; use `eomgen generate --with bench`".to_owned())
                }
                extra => Ok(extra),
            });
            match extra {
                Ok(extra) => extras.push(extra),
                Err(message) => {
                    let error = Diagnostic::error(message).with_span(word.span, "not available");
                    self.found.push(error);
                    return None;
                }
            }
        }
        Some(extras)
    }

    fn precision(&mut self, words: &[StringValue]) -> Option<Vec<Precision>> {
        let mut all = Vec::new();
        for word in words {
            let precision = match &*word.text {
                "f64" => Precision::Double,
                "f32" => Precision::Single,
                other => {
                    let error = Diagnostic::error(format!("unknown precision {}", quote(other)));
                    self.found
                        .push(error.with_span(word.span, "expected \"f64\" or \"f32\""));
                    return None;
                }
            };
            if !all.contains(&precision) {
                all.push(precision);
            }
        }
        if all.is_empty() {
            all.push(Precision::Double);
        }
        Some(all)
    }

    fn settings(&mut self, record: &Record<'_>) -> Option<Vec<String>> {
        let Some(entry) = record.get("set") else {
            return Some(Vec::new());
        };
        let entries = self.found.push_error(entry.table("{ b = 0 }"))?;
        let mut settings = Vec::new();
        for entry in entries {
            let value = match self.found.push_error(entry.quantity())? {
                Quantity::Number(number) => format!("{}", number.value),
                Quantity::Expression(text) => text.text,
                _ => continue,
            };
            settings.push(format!("{}={value}", entry.name.text));
        }
        Some(settings)
    }
}

/// Names and prefixes of earlier variants, in lower case because some file systems ignore the case.
#[derive(Default)]
struct UsedNames {
    names: HashMap<String, StringValue>,
    prefixes: HashMap<String, StringValue>,
}

impl UsedNames {
    fn add_name(&mut self, name: &StringValue, found: &mut Diagnostics) -> bool {
        Self::add(&mut self.names, &name.text, name, "name", found)
    }

    fn add_prefixes(
        &mut self,
        prefixes: &[(String, Precision)],
        place: &StringValue,
        found: &mut Diagnostics,
    ) -> bool {
        let mut is_new = true;
        for (prefix, _) in prefixes {
            is_new &= Self::add(&mut self.prefixes, prefix, place, "prefix", found);
        }
        is_new
    }

    fn add(
        used: &mut HashMap<String, StringValue>,
        text: &str,
        place: &StringValue,
        what: &str,
        found: &mut Diagnostics,
    ) -> bool {
        match used.insert(text.to_lowercase(), place.clone()) {
            None => true,
            Some(first) => {
                let message = format!("two variants have the {what} {}", quote(text));
                let error = Diagnostic::error(message)
                    .with_span(place.span, "used again here")
                    .with_related_span(first.span, "first used here");
                found.push(error.with_help(format!("give each variant its own {what}")));
                false
            }
        }
    }
}

fn is_identifier(name: &str) -> bool {
    name.starts_with(|letter: char| letter.is_ascii_alphabetic())
        && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
}
