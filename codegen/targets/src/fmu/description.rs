//! Parts of `modelDescription.xml` that FMI 2.0 and 3.0 share.

use std::io::{Cursor, Error as Failure};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::variables::{Kind, Unit, Variable};
use crate::error::{EmissionError, Result};

pub type Xml = Writer<Cursor<Vec<u8>>>;

pub type Written = std::result::Result<(), Failure>;

pub type Attribute = (&'static str, String);

/// Name of the generation tool.
pub const TOOL: &str = concat!("eomgen ", env!("CARGO_PKG_VERSION"));

/// Description of the solver in the binary.
const SOLVER: &str = "Co-simulation moves the model like eomgen simulate: with the exact solver if the model is piecewise \
    linear, and otherwise with error control and located events.";

/// Writes a document.
pub fn write_document(write: impl FnOnce(&mut Xml) -> Written) -> Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Cursor::new(Vec::new()), b' ', 2);
    let declaration = BytesDecl::new("1.0", Some("UTF-8"), None);
    xml.write_event(Event::Decl(declaration))
        .and_then(|()| write(&mut xml))
        .map_err(|error| EmissionError::request(format!("cannot describe the unit: {error}")))?;
    let mut bytes = xml.into_inner().into_inner();
    bytes.push(b'\n');
    Ok(bytes)
}

/// Writes an element with children.
pub fn write_element(
    xml: &mut Xml,
    name: &str,
    attributes: &[Attribute],
    inner: impl FnOnce(&mut Xml) -> Written,
) -> Written {
    xml.create_element(name)
        .with_attributes(pairs(attributes))
        .write_inner_content(inner)?;
    Ok(())
}

/// Writes an element without children.
pub fn write_empty_element(xml: &mut Xml, name: &str, attributes: &[Attribute]) -> Written {
    xml.create_element(name)
        .with_attributes(pairs(attributes))
        .write_empty()?;
    Ok(())
}

fn pairs(attributes: &[Attribute]) -> impl Iterator<Item = (&str, &str)> {
    attributes
        .iter()
        .map(|(name, value)| (*name, value.as_str()))
}

/// Removes characters that XML does not support.
pub fn remove_invalid_characters(text: &str) -> String {
    let allowed = |c: char| {
        if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') {
            ' '
        } else {
            c
        }
    };
    text.chars().map(allowed).collect()
}

pub fn format_number(value: f64) -> String {
    format!("{value:?}")
}

pub fn format_list(numbers: impl Iterator<Item = usize>) -> String {
    let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
    numbers.join(" ")
}

/// Returns the title and the description of the solver.
pub fn summary(unit: &Unit) -> String {
    let title = remove_invalid_characters(&unit.title);
    format!("{}. {SOLVER}", title.trim_end_matches('.'))
}

pub fn write_unit_definitions(xml: &mut Xml, unit: &Unit) -> Written {
    write_element(xml, "UnitDefinitions", &[], |xml| {
        for (name, definition) in &unit.units.definitions {
            write_element(xml, "Unit", &[("name", name.clone())], |xml| {
                if let Some(base) = &definition.base {
                    let base: Vec<Attribute> = base
                        .iter()
                        .map(|(name, exponent)| (*name, exponent.to_string()))
                        .collect();
                    write_empty_element(xml, "BaseUnit", &base)?;
                }
                for (name, factor) in &definition.shown {
                    let attributes = [("name", name.clone()), ("factor", format_number(*factor))];
                    write_empty_element(xml, "DisplayUnit", &attributes)?;
                }
                Ok(())
            })?;
        }
        Ok(())
    })
}

pub fn write_log_categories(xml: &mut Xml) -> Written {
    write_element(xml, "LogCategories", &[], |xml| {
        let doc = "Reason for a rejected call".to_owned();
        let attributes = [("name", "logStatusError".to_owned()), ("description", doc)];
        write_empty_element(xml, "Category", &attributes)
    })
}

/// Writes the default experiment.
pub fn write_default_experiment(xml: &mut Xml) -> Written {
    let attributes = [
        ("startTime", format_number(0.0)),
        ("stopTime", format_number(1.0)),
        ("tolerance", format_number(eomgen_unit::DEFAULT_TOLERANCE)),
    ];
    write_empty_element(xml, "DefaultExperiment", &attributes)
}

/// Returns the attributes `causality`, `variability` and `initial` of a variable.
pub fn role(kind: Kind) -> Vec<Attribute> {
    let (causality, variability, initial) = match kind {
        Kind::Time => ("independent", "continuous", None),
        Kind::State => ("output", "continuous", Some("exact")),
        Kind::Rate(_) | Kind::Indicator => ("local", "continuous", Some("calculated")),
        Kind::Input => ("input", "continuous", None),
        Kind::Parameter => ("parameter", "tunable", Some("exact")),
        Kind::Observable => ("output", "continuous", Some("calculated")),
        Kind::DrivenInput => ("local", "discrete", Some("calculated")),
        Kind::ControllerState => ("output", "discrete", Some("calculated")),
    };
    let mut attributes = vec![
        ("causality", causality.to_owned()),
        ("variability", variability.to_owned()),
    ];
    attributes.extend(initial.map(|initial| ("initial", initial.to_owned())));
    attributes
}

pub fn identity(reference: usize, variable: &Variable) -> Vec<Attribute> {
    let mut attributes = vec![
        ("name", variable.name.clone()),
        ("valueReference", reference.to_string()),
    ];
    if !variable.doc.is_empty() {
        attributes.push(("description", remove_invalid_characters(&variable.doc)));
    }
    attributes
}

pub fn quantity(variable: &Variable) -> Vec<Attribute> {
    let mut attributes = Vec::new();
    if let Some(measure) = &variable.measure {
        attributes.push(("unit", measure.unit.clone()));
        attributes.extend(measure.shown.clone().map(|shown| ("displayUnit", shown)));
    }
    for (name, value) in [
        ("min", variable.min),
        ("max", variable.max),
        ("nominal", variable.nominal),
        ("start", variable.start),
    ] {
        attributes.extend(value.map(|value| (name, format_number(value))));
    }
    attributes
}
