//! From TOML to raw entries: which sections and keys a specification has, and of which
//! kind their values are. Names are not looked up and expressions not parsed here.

use toml_edit::Document as Toml;

use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use crate::model::Basis;
use crate::source::Source;
use crate::span::Span;
use crate::suggest::did_you_mean;
use crate::table::{Entry, Name, Number, Quantity, Record, Written, entries, unknown_key};

/// The most named things a specification may hold.
pub const MAX_ENTRIES: usize = 2000;

/// The sections of a specification.
pub const SECTIONS: [&str; 13] = [
    "model",
    "parameters",
    "coordinates",
    "inputs",
    "fields",
    "definitions",
    "kinetic",
    "potential",
    "dissipation",
    "forces",
    "observables",
    "coefficients",
    "sensors",
];

const PARAMETER_EXAMPLE: &str = "{ value = 0.5, unit = \"m\" }";
const COORDINATE_EXAMPLE: &str = "{ unit = \"rad\", initial = 0 }";
const FORCE_EXAMPLE: &str = "{ on = \"theta\", value = \"-c*dot(theta)\" }";
const FIELD_EXAMPLE: &str = "{ along = \"x\", from = 0, to = \"l\", basis = \"clamped_free\", \
                             coordinates = \"q\", order = 4, unit = \"m\" }";

/// A specification as written.
#[derive(Debug)]
pub struct Document {
    /// `name` of `[model]`, with its quotes' place.
    pub name: Name,
    /// `title` of `[model]`.
    pub title: String,
    /// `[parameters]`
    pub parameters: Vec<RawParameter>,
    /// `[coordinates]`
    pub coordinates: Vec<RawCoordinate>,
    /// `[inputs]`: name, unit, doc.
    pub inputs: Vec<(Name, Option<Written>, String)>,
    /// `[fields.NAME]`
    pub fields: Vec<RawField>,
    /// `[definitions]`
    pub definitions: Vec<RawTerm>,
    /// `[kinetic]`
    pub kinetic: Vec<RawTerm>,
    /// `[potential]`
    pub potential: Vec<RawTerm>,
    /// `[dissipation]`
    pub dissipation: Vec<RawTerm>,
    /// `[forces]`: each with what it works on.
    pub forces: Vec<(RawTerm, Quantity)>,
    /// `[observables]`: each with its declared unit.
    pub observables: Vec<(RawTerm, Option<Written>)>,
    /// `[coefficients]`
    pub coefficients: Vec<RawCoefficient>,
    /// `[sensors.CHANNEL]`
    pub sensors: Vec<RawSensor>,
}

/// An entry of `[parameters]`.
#[derive(Debug)]
pub struct RawParameter {
    /// Its key.
    pub name: Name,
    /// `value`
    pub value: Quantity,
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
    /// `source`
    pub origin: String,
    /// `min`
    pub min: Option<Number>,
    /// `max`
    pub max: Option<Number>,
}

/// An entry of `[coordinates]`.
#[derive(Debug)]
pub struct RawCoordinate {
    /// Its key.
    pub name: Name,
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
    /// `initial`
    pub initial: Option<Quantity>,
    /// `initial_rate`
    pub initial_rate: Option<Quantity>,
}

/// A `[fields.NAME]`.
#[derive(Debug)]
pub struct RawField {
    /// Its key.
    pub name: Name,
    /// `along`
    pub along: Name,
    /// `from`
    pub from: Quantity,
    /// `to`
    pub to: Quantity,
    /// `basis`
    pub basis: Basis,
    /// `coordinates`
    pub coordinates: Name,
    /// `order` and its place.
    pub order: (i64, Span),
    /// `unit`
    pub unit: Option<Written>,
    /// `doc`
    pub doc: String,
}

/// A named expression.
#[derive(Debug)]
pub struct RawTerm {
    /// Its key.
    pub name: Name,
    /// The expression.
    pub value: Quantity,
    /// `doc`
    pub doc: String,
    /// `source`
    pub origin: String,
}

/// An entry of `[coefficients]`.
#[derive(Debug)]
pub struct RawCoefficient {
    /// Its key.
    pub name: Name,
    /// What it names.
    pub kind: RawCoefficientKind,
    /// `each`: the field and index it is given for, as `w[i]`.
    pub each: Option<Written>,
    /// `doc`
    pub doc: String,
}

/// What an entry of `[coefficients]` names.
#[derive(Debug)]
pub enum RawCoefficientKind {
    /// `value`
    Value(Quantity),
    /// `of`, `by` and `times`
    Factor(Quantity, Quantity, Option<Quantity>),
}

/// A `[sensors.CHANNEL]`.
#[derive(Debug)]
pub struct RawSensor {
    /// The channel.
    pub channel: Name,
    /// `gain`, 1 if absent.
    pub gain: f64,
    /// `bias` in the channel's unit, 0 if absent.
    pub bias: f64,
    /// `delay` in s, 0 if absent.
    pub delay: f64,
}

/// Reads the sections of a specification.
///
/// # Errors
/// All that is wrong with its grammar, sections and keys.
pub fn read(source: &Source) -> Result<Document, Diagnostics> {
    let text: &str = &source.text;
    if text.trim().is_empty() {
        return Err(Diagnostics::one(source.clone(), empty()));
    }
    let toml = Toml::parse(text)
        .map_err(|error| Diagnostics::one(source.clone(), grammar_error(text, &error)))?;
    let mut reader = Reader {
        top: entries(toml.as_table(), text),
        found: Diagnostics::new(source.clone()),
    };
    let document = reader.document();
    match document {
        Some(document) if reader.found.is_empty() => Ok(document),
        _ => Err(reader.found),
    }
}

fn empty() -> Diagnostic {
    Diagnostic::error("the specification is empty")
        .at(Span::new(0, 0), "expected sections")
        .help("needed are [model] with a name, [coordinates] (or [fields.NAME]) and [kinetic]")
}

fn grammar_error(text: &str, error: &toml_edit::TomlError) -> Diagnostic {
    let range = error.span().unwrap_or(text.len()..text.len());
    let mut lines = error.message().lines();
    let message = lines.next().unwrap_or("this is not TOML").trim();
    let advice: Vec<&str> = lines.map(str::trim).filter(|line| !line.is_empty()).collect();
    let diagnostic = Diagnostic::error(format!("not valid TOML: {message}"))
        .at(Span::new(range.start, range.end), "here");
    diagnostic.help_if((!advice.is_empty()).then(|| advice.join("; ")))
}

struct Reader<'d> {
    top: Vec<Entry<'d>>,
    found: Diagnostics,
}

impl<'d> Reader<'d> {
    fn document(&mut self) -> Option<Document> {
        self.refuse_unknown_sections();
        let model = self.model();
        let document = Document {
            parameters: self.collect("parameters", parameter),
            coordinates: self.collect("coordinates", coordinate),
            inputs: self.collect("inputs", input),
            fields: self.collect("fields", field),
            definitions: self.collect("definitions", term),
            kinetic: self.collect("kinetic", term),
            potential: self.collect("potential", term),
            dissipation: self.collect("dissipation", term),
            forces: self.collect("forces", force),
            observables: self.collect("observables", observable),
            coefficients: self.collect("coefficients", coefficient),
            sensors: self.collect("sensors", sensor),
            name: model.as_ref().map(|(name, _)| name.clone())?,
            title: model.map(|(_, title)| title).unwrap_or_default(),
        };
        self.refuse_missing_sections(&document);
        Some(document)
    }

    fn section(&self, name: &str) -> Option<&Entry<'d>> {
        self.top.iter().find(|entry| entry.name.text == name)
    }

    fn refuse_unknown_sections(&mut self) {
        for entry in &self.top {
            let name = entry.name.text.as_str();
            if name == "order" {
                self.found.push(misplaced_order(&entry.name, self.section("fields").is_some()));
            } else if !SECTIONS.contains(&name) {
                let listed = format!("the sections are {}", SECTIONS.join(", "));
                self.found.push(
                    Diagnostic::error(format!("unknown section {}", quoted(name)))
                        .at(entry.name.span, "not known")
                        .help(did_you_mean(name, SECTIONS).unwrap_or(listed)),
                );
            }
        }
    }

    fn refuse_missing_sections(&mut self, document: &Document) {
        let mut missing = Vec::new();
        if document.coordinates.is_empty() && document.fields.is_empty() {
            missing.push("[coordinates] (or [fields.NAME])");
        }
        if document.kinetic.is_empty() {
            missing.push("[kinetic]");
        }
        if self.found.is_empty() && !missing.is_empty() {
            let missing = missing.join(" and ");
            self.found.push(
                Diagnostic::error(format!("a model needs {missing} with at least one entry"))
                    .at(document.name.span, "this model has none")
                    .help("for example [coordinates] theta = { unit = \"rad\" } and \
                           [kinetic] arm = \"1/2*J*dot(theta)^2\""),
            );
        }
    }

    /// The model's name and title.
    fn model(&mut self) -> Option<(Name, String)> {
        let Some(entry) = self.section("model").cloned() else {
            let help = "begin with [model] and name = \"my_machine\"";
            self.found.push(
                Diagnostic::error("the section [model] is missing")
                    .at(Span::new(0, 1), "expected [model] in this file")
                    .help(help),
            );
            return None;
        };
        let known = ["name", "title", "order"];
        let has_fields = self.section("fields").is_some();
        let record = entry.record(&known, "{ name = \"my_machine\" }", &mut self.found)?;
        if let Some(order) = record.get("order") {
            self.found.push(misplaced_order(&order.name, has_fields));
        }
        let named = record.require("name", "write name = \"my_machine\"", &mut self.found)?;
        let name = name_of(self.found.keep(named.written())?);
        let title = record.text("title", &mut self.found);
        Some((name, title))
    }

    /// All entries of a section.
    fn collect<T>(
        &mut self,
        section: &str,
        read: impl Fn(&Entry<'d>, &mut Diagnostics) -> Option<T>,
    ) -> Vec<T> {
        let Some(table) = self.section(section).cloned() else {
            return Vec::new();
        };
        let example = format!("{{ }} or [{section}]");
        let entries = self.found.keep(table.table(&example)).unwrap_or_default();
        if let Some(excess) = entries.get(MAX_ENTRIES) {
            self.found.push(
                Diagnostic::error(format!("[{section}] has more than {MAX_ENTRIES} entries"))
                    .at(excess.name.span, "one too many"),
            );
            return Vec::new();
        }
        let mut list = Vec::with_capacity(entries.len());
        for entry in &entries {
            list.extend(read(entry, &mut self.found));
        }
        list
    }
}

fn misplaced_order(name: &Name, has_fields: bool) -> Diagnostic {
    let diagnostic = if has_fields {
        Diagnostic::error("`order` does not belong here").help("it stands under [fields.NAME]")
    } else {
        Diagnostic::error("`order` is given, but the model has no field")
            .help("leave it out: only a field has a modal truncation order")
    };
    diagnostic.at(name.span, "the order of what?")
}

fn name_of(written: Written) -> Name {
    Name {
        text: written.text,
        span: written.span,
    }
}

fn parameter(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawParameter> {
    let known = ["value", "unit", "doc", "source", "min", "max"];
    let record = entry.record(&known, PARAMETER_EXAMPLE, found)?;
    let help = "give a number in the declared unit, or an expression of other parameters";
    let value = record.require("value", help, found)?.quantity();
    Some(RawParameter {
        name: entry.name.clone(),
        unit: record.written("unit", found),
        doc: record.text("doc", found),
        origin: record.text("source", found),
        min: record.number("min", found),
        max: record.number("max", found),
        value: found.keep(value)?,
    })
}

fn coordinate(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawCoordinate> {
    let known = ["unit", "doc", "initial", "initial_rate"];
    let record = entry.record(&known, COORDINATE_EXAMPLE, found)?;
    Some(RawCoordinate {
        name: entry.name.clone(),
        unit: required_unit(&record, found),
        doc: record.text("doc", found),
        initial: record.quantity("initial", found),
        initial_rate: record.quantity("initial_rate", found),
    })
}

fn required_unit(record: &Record<'_>, found: &mut Diagnostics) -> Option<Written> {
    let help = "give the SI unit, such as unit = \"m\" or unit = \"rad\"";
    let unit = record.require("unit", help, found)?.written();
    found.keep(unit)
}

fn input(
    entry: &Entry<'_>,
    found: &mut Diagnostics,
) -> Option<(Name, Option<Written>, String)> {
    let record = entry.record(&["unit", "doc"], "{ unit = \"N m\" }", found)?;
    let unit = required_unit(&record, found);
    Some((entry.name.clone(), unit, record.text("doc", found)))
}

fn field(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawField> {
    let known = ["along", "from", "to", "basis", "coordinates", "order", "unit", "doc"];
    let record = entry.record(&known, FIELD_EXAMPLE, found)?;
    let along = record.require("along", "name the position: along = \"x\"", found).cloned();
    let from = record.require("from", "give the start of the domain: from = 0", found).cloned();
    let to = record.require("to", "give the end of the domain: to = \"l\"", found).cloned();
    let help = "the mode shapes: basis = \"clamped_free\"";
    let basis = record.require("basis", help, found).cloned();
    let help = "name the mode coordinates: coordinates = \"q\"";
    let coordinates = record.require("coordinates", help, found).cloned();
    let order = record.require("order", "how many modes: order = 4", found).cloned();
    Some(RawField {
        name: entry.name.clone(),
        unit: required_unit(&record, found),
        doc: record.text("doc", found),
        along: name_of(found.keep(along?.written())?),
        from: found.keep(from?.quantity())?,
        to: found.keep(to?.quantity())?,
        basis: found.keep(basis?.written().and_then(|written| basis_named(&written)))?,
        coordinates: name_of(found.keep(coordinates?.written())?),
        order: found.keep(order?.whole())?,
    })
}

fn basis_named(written: &Written) -> Result<Basis, Diagnostic> {
    match written.text.as_str() {
        "clamped_free" => Ok(Basis::ClampedFree),
        "clamped_free_printed" => Ok(Basis::ClampedFreePrinted),
        other => Err(Diagnostic::error(format!("unknown basis {}", quoted(other)))
            .at(written.span, "not known")
            .help("known are clamped_free and clamped_free_printed")),
    }
}

fn term(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawTerm> {
    if !entry.is_table() {
        return Some(RawTerm {
            name: entry.name.clone(),
            value: found.keep(entry.quantity())?,
            doc: String::new(),
            origin: String::new(),
        });
    }
    let record = entry.record(&["value", "doc", "source"], "\"1/2*m*dot(x)^2\"", found)?;
    term_of(&record, found)
}

/// The named expression of a table with at least `value`.
fn term_of(record: &Record<'_>, found: &mut Diagnostics) -> Option<RawTerm> {
    let help = "give an expression: value = \"...\"";
    let value = record.require("value", help, found)?.quantity();
    Some(RawTerm {
        name: record.owner().clone(),
        value: found.keep(value)?,
        doc: record.text("doc", found),
        origin: record.text("source", found),
    })
}

fn force(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<(RawTerm, Quantity)> {
    let record = entry.record(&["on", "value", "doc", "source"], FORCE_EXAMPLE, found)?;
    let help = "say what the force does work on: on = \"theta\"";
    let on = record.require("on", help, found).map(Entry::quantity);
    let term = term_of(&record, found);
    Some((term?, found.keep(on?)?))
}

fn observable(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<(RawTerm, Option<Written>)> {
    if !entry.is_table() {
        return Some((term(entry, found)?, None));
    }
    let known = ["value", "unit", "doc", "source"];
    let record = entry.record(&known, "\"at(w, l)\"", found)?;
    let unit = record.written("unit", found);
    Some((term_of(&record, found)?, unit))
}

fn coefficient(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawCoefficient> {
    let name = entry.name.clone();
    if !entry.is_table() {
        let value = found.keep(entry.quantity())?;
        return Some(RawCoefficient {
            name,
            kind: RawCoefficientKind::Value(value),
            each: None,
            doc: String::new(),
        });
    }
    let known = ["value", "of", "by", "times", "each", "doc"];
    let example = "{ of = \"x_c\", by = \"dot(x_c)\" }";
    let record = entry.record(&known, example, found)?;
    Some(RawCoefficient {
        name,
        kind: coefficient_kind(&record, found)?,
        each: record.written("each", found),
        doc: record.text("doc", found),
    })
}

fn coefficient_kind(record: &Record<'_>, found: &mut Diagnostics) -> Option<RawCoefficientKind> {
    if let Some(value) = record.get("value") {
        let others = ["of", "by", "times"];
        if let Some(other) = others.iter().find_map(|key| record.get(key)) {
            let known = ["value", "each", "doc"];
            found.push(unknown_key(&other.name, &known).help("give either value, or of and by"));
            return None;
        }
        return found.keep(value.quantity()).map(RawCoefficientKind::Value);
    }
    let help = "give `of` (whose acceleration) and `by` (the quantity multiplied), or `value`";
    let of = record.require("of", help, found)?.quantity();
    let by = record.require("by", help, found)?.quantity();
    let times = record.quantity("times", found);
    Some(RawCoefficientKind::Factor(found.keep(of)?, found.keep(by)?, times))
}

fn sensor(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawSensor> {
    let record = entry.record(&["gain", "bias", "delay"], "{ gain = 1, bias = 0 }", found)?;
    let mut number = |key, absent| record.number(key, found).map_or(absent, |n| n.value);
    Some(RawSensor {
        channel: entry.name.clone(),
        gain: number("gain", 1.0),
        bias: number("bias", 0.0),
        delay: number("delay", 0.0),
    })
}
