//! Description of a unit in version 2.0. Variables refer to each other by their index in the list, from 1.

use super::description::{
    Attribute, Written, Xml, clean, default_experiment, document, element, empty, identity, list,
    log_categories, quantity, role, summary, unit_definitions,
};
use super::variables::{Kind, Unit};
use crate::error::Result;

/// Returns `modelDescription.xml`.
pub fn description(unit: &Unit) -> Result<Vec<u8>> {
    let indicators = unit.of_kind(|kind| kind == Kind::Indicator).count();
    let root = [
        ("fmiVersion", "2.0".to_owned()),
        ("modelName", unit.name.clone()),
        ("guid", unit.token.clone()),
        ("description", summary(unit)),
        ("generationTool", clean(super::description::TOOL)),
        ("variableNamingConvention", "structured".to_owned()),
        ("numberOfEventIndicators", indicators.to_string()),
    ];
    document(|xml| {
        element(xml, "fmiModelDescription", &root, |xml| {
            if !unit.has_controllers {
                interface(xml, unit, "ModelExchange", &[])?;
            }
            let steps = ("canHandleVariableCommunicationStepSize", "true".to_owned());
            interface(xml, unit, "CoSimulation", &[steps])?;
            unit_definitions(xml, unit)?;
            log_categories(xml)?;
            default_experiment(xml)?;
            variables(xml, unit)?;
            structure(xml, unit)
        })
    })
}

fn interface(xml: &mut Xml, unit: &Unit, name: &str, more: &[Attribute]) -> Written {
    let mut attributes = vec![("modelIdentifier", unit.name.clone())];
    attributes.extend_from_slice(more);
    for can in [
        "canGetAndSetFMUstate",
        "canSerializeFMUstate",
        "providesDirectionalDerivative",
    ] {
        attributes.push((can, "true".to_owned()));
    }
    empty(xml, name, &attributes)
}

fn variables(xml: &mut Xml, unit: &Unit) -> Written {
    element(xml, "ModelVariables", &[], |xml| {
        for (reference, variable) in unit.variables.iter().enumerate() {
            let mut attributes = identity(reference, variable);
            attributes.extend(role(variable.kind));
            let mut real = quantity(variable);
            if let Kind::Rate(state) = variable.kind {
                real.push(("derivative", (state + 1).to_string()));
            }
            element(xml, "ScalarVariable", &attributes, |xml| {
                empty(xml, "Real", &real)
            })?;
        }
        Ok(())
    })
}

fn structure(xml: &mut Xml, unit: &Unit) -> Written {
    element(xml, "ModelStructure", &[], |xml| {
        let is_output =
            |kind| matches!(kind, Kind::State | Kind::Observable | Kind::ControllerState);
        let is_rate = |kind| matches!(kind, Kind::Rate(_));
        let is_calculated = |kind| {
            matches!(
                kind,
                Kind::Rate(_) | Kind::Observable | Kind::ControllerState
            )
        };
        listed(xml, unit, "Outputs", is_output)?;
        listed(xml, unit, "Derivatives", is_rate)?;
        listed(xml, unit, "InitialUnknowns", is_calculated)
    })
}

fn listed(xml: &mut Xml, unit: &Unit, name: &str, is: impl Fn(Kind) -> bool) -> Written {
    element(xml, name, &[], |xml| {
        for (reference, _) in unit.of_kind(is) {
            let dependencies = unit.dependencies(reference, name == "InitialUnknowns");
            let attributes = [
                ("index", (reference + 1).to_string()),
                (
                    "dependencies",
                    list(dependencies.iter().map(|known| known + 1)),
                ),
            ];
            empty(xml, "Unknown", &attributes)?;
        }
        Ok(())
    })
}
