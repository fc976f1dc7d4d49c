//! Description of a unit in version 3.0. Variables refer to each other by value references.

use super::description::{
    Attribute, Written, Xml, format_list, identity, quantity, remove_invalid_characters, role,
    summary, write_default_experiment, write_document, write_element, write_empty_element,
    write_log_categories, write_unit_definitions,
};
use super::variables::{Kind, Unit};
use crate::error::Result;

/// Returns `modelDescription.xml`.
pub fn write_description(unit: &Unit) -> Result<Vec<u8>> {
    let root = [
        ("fmiVersion", "3.0".to_owned()),
        ("modelName", unit.name.clone()),
        ("instantiationToken", unit.token.clone()),
        ("description", summary(unit)),
        (
            "generationTool",
            remove_invalid_characters(super::description::TOOL),
        ),
        ("variableNamingConvention", "structured".to_owned()),
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

/// Adjoint derivatives are implemented but not declared: CasADi 3.8 would compute its Jacobians from them, with rows
/// in the wrong order.
fn write_interface(xml: &mut Xml, unit: &Unit, name: &str, more: &[Attribute]) -> Written {
    let mut attributes = vec![("modelIdentifier", unit.name.clone())];
    attributes.extend_from_slice(more);
    for can in [
        "canGetAndSetFMUState",
        "canSerializeFMUState",
        "providesDirectionalDerivatives",
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
            attributes.extend(quantity(variable));
            if let Kind::Rate(state) = variable.kind {
                attributes.push(("derivative", state.to_string()));
            }
            write_empty_element(xml, "Float64", &attributes)?;
        }
        Ok(())
    })
}

fn write_structure(xml: &mut Xml, unit: &Unit) -> Written {
    write_element(xml, "ModelStructure", &[], |xml| {
        write_listed(xml, unit, "Output", |kind| {
            matches!(kind, Kind::State | Kind::Observable | Kind::ControllerState)
        })?;
        write_listed(xml, unit, "ContinuousStateDerivative", |kind| {
            matches!(kind, Kind::Rate(_))
        })?;
        write_listed(xml, unit, "InitialUnknown", |kind| {
            matches!(
                kind,
                Kind::Rate(_) | Kind::Observable | Kind::ControllerState
            )
        })?;
        write_listed(xml, unit, "EventIndicator", |kind| kind == Kind::Indicator)
    })
}

fn write_listed(xml: &mut Xml, unit: &Unit, name: &str, is: impl Fn(Kind) -> bool) -> Written {
    for (reference, _) in unit.of_kind(is) {
        // Includes tunable parameters, because importers assume independence of variables that are not listed.
        let dependencies = unit.dependencies(reference, true);
        let attributes = [
            ("valueReference", reference.to_string()),
            ("dependencies", format_list(dependencies.into_iter())),
        ];
        write_empty_element(xml, name, &attributes)?;
    }
    Ok(())
}
