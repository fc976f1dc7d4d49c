//! Description of a unit in version 2.0. Variables refer to each other by their index in the list, from 1.

use super::description::{
    Attribute, Written, Xml, format_list, identity, quantity, remove_invalid_characters, role,
    summary, write_default_experiment, write_document, write_element, write_empty_element,
    write_log_categories, write_unit_definitions,
};
use super::variables::{Kind, Unit};
use crate::error::Result;

/// Returns `modelDescription.xml`.
pub fn write_description(unit: &Unit) -> Result<Vec<u8>> {
    let indicators = unit.of_kind(|kind| kind == Kind::Indicator).count();
    let root = [
        ("fmiVersion", "2.0".to_owned()),
        ("modelName", unit.name.clone()),
        ("guid", unit.token.clone()),
        ("description", summary(unit)),
        (
            "generationTool",
            remove_invalid_characters(super::description::TOOL),
        ),
        ("variableNamingConvention", "structured".to_owned()),
        ("numberOfEventIndicators", indicators.to_string()),
    ];
    write_document(|xml| {
        write_element(xml, "fmiModelDescription", &root, |xml| {
            write_interface(xml, unit, "ModelExchange", &[])?;
            let steps = ("canHandleVariableCommunicationStepSize", "true".to_owned());
            write_interface(xml, unit, "CoSimulation", &[steps])?;
            write_unit_definitions(xml, unit)?;
            write_log_categories(xml)?;
            write_default_experiment(xml)?;
            write_variables(xml, unit)?;
            write_structure(xml, unit)
        })
    })
}

fn write_interface(xml: &mut Xml, unit: &Unit, name: &str, more: &[Attribute]) -> Written {
    let mut attributes = vec![("modelIdentifier", unit.name.clone())];
    attributes.extend_from_slice(more);
    for can in [
        "canGetAndSetFMUstate",
        "canSerializeFMUstate",
        "providesDirectionalDerivative",
    ] {
        attributes.push((can, "true".to_owned()));
    }
    write_empty_element(xml, name, &attributes)
}

fn write_variables(xml: &mut Xml, unit: &Unit) -> Written {
    write_element(xml, "ModelVariables", &[], |xml| {
        for (reference, variable) in unit.variables.iter().enumerate() {
            let mut attributes = identity(reference, variable);
            attributes.extend(role(variable.kind));
            let mut real = quantity(variable);
            if let Kind::Rate(state) = variable.kind {
                real.push(("derivative", (state + 1).to_string()));
            }
            write_element(xml, "ScalarVariable", &attributes, |xml| {
                write_empty_element(xml, "Real", &real)
            })?;
        }
        Ok(())
    })
}

fn write_structure(xml: &mut Xml, unit: &Unit) -> Written {
    write_element(xml, "ModelStructure", &[], |xml| {
        let is_output =
            |kind| matches!(kind, Kind::State | Kind::Observable | Kind::ControllerState);
        let is_rate = |kind| matches!(kind, Kind::Rate(_));
        let is_calculated = |kind| {
            matches!(
                kind,
                Kind::Rate(_) | Kind::Observable | Kind::ControllerState
            )
        };
        write_listed(xml, unit, "Outputs", is_output)?;
        write_listed(xml, unit, "Derivatives", is_rate)?;
        write_listed(xml, unit, "InitialUnknowns", is_calculated)
    })
}

fn write_listed(xml: &mut Xml, unit: &Unit, name: &str, is: impl Fn(Kind) -> bool) -> Written {
    write_element(xml, name, &[], |xml| {
        for (reference, _) in unit.of_kind(is) {
            let dependencies = unit.dependencies(reference, name == "InitialUnknowns");
            let attributes = [
                ("index", (reference + 1).to_string()),
                (
                    "dependencies",
                    format_list(dependencies.iter().map(|known| known + 1)),
                ),
            ];
            write_empty_element(xml, "Unknown", &attributes)?;
        }
        Ok(())
    })
}
