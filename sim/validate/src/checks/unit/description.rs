//! Parser of the file `modelDescription.xml` of a functional mock-up unit.

use std::collections::BTreeMap;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

type Attributes = BTreeMap<String, String>;

/// Content of a model description.
#[derive(Default)]
pub struct Description {
    /// Attributes of the root element.
    pub root: Attributes,
    /// `modelIdentifier` by kind of instances: `ModelExchange`, `CoSimulation`.
    pub identifiers: BTreeMap<String, String>,
    /// Units of measurement by name.
    pub units: BTreeMap<String, Measure>,
    /// Variables with the attributes of their type.
    pub variables: Vec<Attributes>,
}

/// Unit of measurement.
#[derive(Default)]
pub struct Measure {
    /// Exponents of the base units with factor and offset; `None` if the element `BaseUnit` is missing.
    pub base: Option<Attributes>,
    /// Factors of the display units by name.
    pub shown: BTreeMap<String, String>,
}

impl Description {
    /// Parses a model description.
    ///
    /// # Errors
    /// Invalid XML.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut found = Self::default();
        let mut reader = Reader::from_str(text);
        let mut unit = String::new();
        loop {
            let event = reader.read_event().map_err(|error| error.to_string())?;
            let start = match &event {
                Event::Eof => return Ok(found),
                Event::Start(start) | Event::Empty(start) => start,
                _ => continue,
            };
            let mut attributes = read_attributes(start)?;
            match start.name().as_ref() {
                "fmiModelDescription" => found.root = attributes,
                kind @ ("ModelExchange" | "CoSimulation") => {
                    let identifier = attributes.remove("modelIdentifier").unwrap_or_default();
                    let kind = kind.to_owned();
                    found.identifiers.insert(kind, identifier);
                }
                "Unit" => {
                    unit = attributes.remove("name").unwrap_or_default();
                    found.units.insert(unit.clone(), Measure::default());
                }
                "BaseUnit" => {
                    if let Some(measure) = found.units.get_mut(&unit) {
                        measure.base = Some(attributes);
                    }
                }
                "DisplayUnit" => {
                    let name = attributes.remove("name").unwrap_or_default();
                    let factor = attributes.remove("factor").unwrap_or_default();
                    if let Some(measure) = found.units.get_mut(&unit) {
                        measure.shown.insert(name, factor);
                    }
                }
                "ScalarVariable" | "Float64" => found.variables.push(attributes),
                "Real" => {
                    if let Some(variable) = found.variables.last_mut() {
                        variable.extend(attributes);
                    }
                }
                _ => {}
            }
        }
    }

    /// Returns the major version of FMI, 2 or 3.
    pub fn version(&self) -> Option<u8> {
        match self.root.get("fmiVersion").map(String::as_str) {
            Some("2.0") => Some(2),
            Some("3.0") => Some(3),
            _ => None,
        }
    }

    /// Returns the token (GUID) that links the description to its library.
    pub fn token(&self) -> Option<&str> {
        let token = self
            .root
            .get("guid")
            .or(self.root.get("instantiationToken"));
        token.map(String::as_str)
    }

    /// Returns the value reference of a variable.
    pub fn reference(&self, name: &str) -> Option<u32> {
        let mut variables = self.variables.iter();
        let variable =
            variables.find(|variable| variable.get("name").is_some_and(|n| n == name))?;
        variable.get("valueReference")?.parse().ok()
    }
}

fn read_attributes(start: &BytesStart<'_>) -> Result<Attributes, String> {
    let mut found = Attributes::new();
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|error| error.to_string())?;
        let value = attribute.normalized_value(XmlVersion::Explicit1_0);
        let value = value.map_err(|error| error.to_string())?;
        let name = attribute.key.as_ref().to_owned();
        found.insert(name, value.into_owned());
    }
    Ok(found)
}
