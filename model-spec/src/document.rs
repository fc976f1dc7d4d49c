//! Reads the sections of a specification from TOML to raw entries; `entries` reads one entry. Names and expressions
//! are resolved later.

use toml_edit::Document as Toml;

use crate::control::read_controller;
use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::entries::{
    read_body, read_coefficient, read_constraint, read_coordinate, read_definition,
    read_energy_term, read_field, read_force, read_frame, read_impact, read_input, read_line,
    read_observable, read_parameter, read_point, read_sensor, read_state, to_name,
};
use crate::quantity::{Name, Quantity};
use crate::raw::{Document, RawDrawing, RawInput};
use crate::record::Record;
use crate::sections;
use crate::source::Source;
use crate::span::Span;
use crate::suggest::did_you_mean;
use crate::table::{Entry, entries};
use crate::toml_file::grammar_error;

/// Largest number of entries in a section.
pub const MAX_ENTRIES: usize = 2000;

pub fn read(source: &Source) -> Result<Document, Diagnostics> {
    let text: &str = &source.text;
    let toml = Toml::parse(text)
        .map_err(|error| Diagnostics::from_one(source.clone(), grammar_error(text, &error)))?;
    if toml.as_table().is_empty() {
        return Err(Diagnostics::from_one(source.clone(), empty_error()));
    }
    let mut reader = Reader {
        top: entries(toml.as_table(), text),
        found: Diagnostics::new(source.clone()),
    };
    let document = reader.read_document();
    match document {
        Some(document) if reader.found.is_empty() => Ok(document),
        _ => Err(reader.found),
    }
}

fn empty_error() -> Diagnostic {
    Diagnostic::error("the specification is empty")
        .with_span(Span::new(0, 0), "expected sections")
        .with_help("write [model] with a name, [coordinates] (or [fields.NAME]) and [kinetic]")
}

struct Reader<'d> {
    top: Vec<Entry<'d>>,
    found: Diagnostics,
}

impl<'d> Reader<'d> {
    fn read_document(&mut self) -> Option<Document> {
        self.reject_unknown_sections();
        let model = self.read_model();
        let mut document = Document {
            parameters: self.collect("parameters", read_parameter),
            coordinates: self.collect("coordinates", read_coordinate),
            inputs: (self.collect("inputs", read_input).into_iter())
                .flat_map(RawInput::with_rates)
                .collect(),
            states: self.collect("states", read_state),
            fields: self.collect("fields", read_field),
            definitions: self.collect("definitions", read_definition),
            vectors: Vec::new(),
            frames: self.collect("frames", read_frame),
            bodies: self.collect("bodies", read_body),
            gravity: self.read_gravity(),
            kinetic: self.collect("kinetic", read_energy_term),
            potential: self.collect("potential", read_energy_term),
            dissipation: self.collect("dissipation", read_energy_term),
            forces: self.collect("forces", read_force),
            constraints: self.collect("constraints", read_constraint),
            impacts: self.collect("impacts", read_impact),
            observables: self.collect("observables", read_observable),
            coefficients: self.collect("coefficients", read_coefficient),
            sensors: self.collect("sensors", read_sensor),
            controllers: self.collect("controllers", read_controller),
            drawing: self.read_drawing(),
            name: model.as_ref().map(|(name, _)| name.clone())?,
            title: model.map(|(_, title)| title).unwrap_or_default(),
        };
        self.reject_missing_sections(&document);
        document.declare_stabilisation_rate();
        Some(document)
    }

    fn find_section(&self, name: &str) -> Option<&Entry<'d>> {
        self.top.iter().find(|entry| entry.name.text == name)
    }

    fn reject_unknown_sections(&mut self) {
        for entry in &self.top {
            let name = entry.name.text.as_str();
            if name == "order" {
                self.found.push(misplaced_order_error(
                    &entry.name,
                    self.find_section("fields").is_some(),
                ));
            } else if sections::SECTIONS.names().all(|known| known != name) {
                self.found.push_with(|| unknown_section_error(&entry.name));
            }
        }
    }

    fn reject_missing_sections(&mut self, document: &Document) {
        let mut missing = Vec::new();
        if document.coordinates.is_empty() && document.fields.is_empty() {
            missing.push("[coordinates] (or [fields.NAME])");
        }
        if document.kinetic.is_empty() && document.bodies.is_empty() {
            missing.push("[kinetic]");
        }
        if self.found.is_empty() && !missing.is_empty() {
            let missing = missing.join(" and ");
            self.found.push(
                Diagnostic::error(format!("a model needs {missing} with at least one entry"))
                    .with_span(document.name.span, "the model has none")
                    .with_help(
                        "for example [coordinates] theta = { unit = \"rad\" } and \
                           [kinetic] arm = \"1/2*J*dot(theta)^2\"",
                    ),
            );
        }
    }

    fn read_model(&mut self) -> Option<(Name, String)> {
        let Some(entry) = self.find_section("model").cloned() else {
            let help = "begin with [model] and name = \"my_machine\"";
            self.found.push(
                Diagnostic::error("the section [model] is missing")
                    .with_span(Span::new(0, 1), "expected [model] in this file")
                    .with_help(help),
            );
            return None;
        };
        let entries = entry.table(&sections::MODEL.example());
        let entries = self.found.push_error(entries)?;
        let is_order = |entry: &Entry<'d>| entry.name.text == "order";
        let (orders, entries): (Vec<_>, Vec<_>) = entries.into_iter().partition(is_order);
        for order in orders {
            let has_fields = self.find_section("fields").is_some();
            self.found
                .push(misplaced_order_error(&order.name, has_fields));
        }
        let record = Record::new(entry.name, entries, &sections::MODEL, &mut self.found);
        let name = record.required("name", Entry::written, &mut self.found)?;
        let name = to_name(name);
        let title = record.text("title", &mut self.found);
        Some((name, title))
    }

    fn read_gravity(&mut self) -> Option<Vec<Quantity>> {
        let model = self.find_section("model")?.table("{ }").ok()?;
        let entry = model
            .into_iter()
            .find(|entry| entry.name.text == "gravity")?;
        // If the model has no energy, a more general error is reported.
        if self.find_section("bodies").is_none() && self.find_section("kinetic").is_some() {
            self.found.push(
                Diagnostic::error("`gravity` has no effect, because the model has no [bodies]")
                    .with_span(entry.name.span, "it acts only on bodies")
                    .with_help("without bodies, write the energy m*g*height in [potential]"),
            );
            return None;
        }
        let components = entry.quantities(&[3], "[0, 0, \"-g\"]");
        self.found.push_error(components)
    }

    fn collect<T>(
        &mut self,
        section: &str,
        read: impl Fn(&Entry<'d>, &mut Diagnostics) -> Option<T>,
    ) -> Vec<T> {
        match self.find_section(section).cloned() {
            Some(table) => self.read_entries(&table, section, read),
            None => Vec::new(),
        }
    }

    fn read_drawing(&mut self) -> Option<RawDrawing> {
        let entry = self.find_section("drawing").cloned()?;
        let record = Record::read(&entry, &sections::DRAWING, &mut self.found)?;
        let mut drawing = RawDrawing {
            points: Vec::new(),
            lines: Vec::new(),
        };
        if let Some(table) = record.get("points") {
            drawing.points = self.read_entries(table, "drawing.points", read_point);
        }
        if let Some(table) = record.get("lines") {
            drawing.lines = self.read_entries(table, "drawing.lines", read_line);
        }
        Some(drawing)
    }

    fn read_entries<T>(
        &mut self,
        table: &Entry<'d>,
        section: &str,
        read: impl Fn(&Entry<'d>, &mut Diagnostics) -> Option<T>,
    ) -> Vec<T> {
        let example = format!("{{ }} or [{section}]");
        let entries = self
            .found
            .push_error(table.table(&example))
            .unwrap_or_default();
        if let Some(excess) = entries.get(MAX_ENTRIES) {
            self.found.push(
                Diagnostic::error(format!("[{section}] has more than {MAX_ENTRIES} entries"))
                    .with_span(excess.name.span, "one too many"),
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

fn unknown_section_error(name: &Name) -> Diagnostic {
    let known: Vec<&str> = sections::SECTIONS.names().collect();
    let listed = format!("the sections are {}", known.join(", "));
    Diagnostic::error(format!("unknown section {}", quote(&name.text)))
        .with_span(name.span, "not known")
        .with_help(did_you_mean(&name.text, known).unwrap_or(listed))
}

fn misplaced_order_error(name: &Name, has_fields: bool) -> Diagnostic {
    let diagnostic = if has_fields {
        Diagnostic::error("`order` cannot be given here").with_help("move it to [fields.NAME]")
    } else {
        Diagnostic::error("`order` is given, but the model has no field")
            .with_help("remove it: only a field has a modal truncation order")
    };
    diagnostic.with_span(name.span, "this section is not a field")
}
