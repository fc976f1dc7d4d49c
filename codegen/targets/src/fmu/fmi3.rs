//! Description of a unit in version 3.0. Variables refer to each other by value references.

use super::description::{
    Attribute, Written, Xml, clean, default_experiment, document, element, empty, identity, list,
    log_categories, quantity, role, summary, unit_definitions,
};
use super::variables::{Kind, Unit};
use crate::error::Result;

/// Returns `modelDescription.xml`.
pub fn description(unit: &Unit) -> Result<Vec<u8>> {
    let root = [
        ("fmiVersion", "3.0".to_owned()),
        ("modelName", unit.name.clone()),
        ("instantiationToken", unit.token.clone()),
        ("description", summary(unit)),
        ("generationTool", clean(super::description::TOOL)),
        ("variableNamingConvention", "structured".to_owned()),
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

/// Adjoint derivatives are implemented but not announced: CasADi 3.8 would compute its Jacobians from them, with rows
/// in the wrong order.
fn interface(xml: &mut Xml, unit: &Unit, name: &str, more: &[Attribute]) -> Written {
    let mut attributes = vec![("modelIdentifier", unit.name.clone())];
    attributes.extend_from_slice(more);
    for can in [
        "canGetAndSetFMUState",
        "canSerializeFMUState",
        "providesDirectionalDerivatives",
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
            attributes.extend(quantity(variable));
            if let Kind::Rate(state) = variable.kind {
                attributes.push(("derivative", state.to_string()));
            }
            empty(xml, "Float64", &attributes)?;
        }
        Ok(())
    })
}

fn structure(xml: &mut Xml, unit: &Unit) -> Written {
    element(xml, "ModelStructure", &[], |xml| {
        listed(xml, unit, "Output", |kind| {
            matches!(kind, Kind::State | Kind::Observable | Kind::ControllerState)
        })?;
        listed(xml, unit, "ContinuousStateDerivative", |kind| {
            matches!(kind, Kind::Rate(_))
        })?;
        listed(xml, unit, "InitialUnknown", |kind| {
            matches!(
                kind,
                Kind::Rate(_) | Kind::Observable | Kind::ControllerState
            )
        })?;
        // Only model exchange uses them.
        listed(xml, unit, "EventIndicator", |kind| {
            kind == Kind::Indicator && !unit.has_controllers
        })
    })
}

fn listed(xml: &mut Xml, unit: &Unit, name: &str, is: impl Fn(Kind) -> bool) -> Written {
    for (reference, _) in unit.of_kind(is) {
        // Includes tunable parameters, because importers assume independence of variables that are not listed.
        let dependencies = unit.dependencies(reference, true);
        let attributes = [
            ("valueReference", reference.to_string()),
            ("dependencies", list(dependencies.into_iter())),
        ];
        empty(xml, name, &attributes)?;
    }
    Ok(())
}
