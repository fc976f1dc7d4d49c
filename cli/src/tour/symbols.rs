//! Symbols of the equations: their meanings, values and units.

use eomgen_compiled_model::Instance;
use eomgen_model_spec::model::{ExprKind, Function, Model, Parameter};
use eomgen_model_spec::unit::Unit;
use eomgen_page::play::format_unit;

use crate::page;

/// Returns the parameters, coordinates, fields, inputs and states of a model, then the observables with a description.
pub fn symbols(run: &Instance<'_>) -> Vec<page::SymbolRow> {
    let model = run.model().model();
    let parameters = model.parameters.iter();
    let parameters = parameters.map(|parameter| parameter_row(run, parameter));
    let coordinates = model.coordinates.iter();
    let coordinates = coordinates.map(|known| varying_row(&known.name, &known.doc, &known.unit));
    let fields = model.fields.iter().flat_map(|field| {
        let modes = format!("amplitudes of the modes of {}", field.name);
        [
            varying_row(&field.name, &field.doc, &field.unit),
            varying_row(&field.coordinates, &modes, &field.unit),
        ]
    });
    let inputs = model.inputs.iter();
    let inputs = inputs.map(|known| varying_row(&known.name, &known.doc, &known.unit));
    let states = model.states.iter();
    let states = states.map(|known| varying_row(&known.name, &known.doc, &known.unit));
    let observables = model.observables.iter();
    let observables = observables.filter(|known| !known.doc.is_empty());
    let observables = observables.map(|known| varying_row(&known.name, &known.doc, &known.unit));
    let moving = coordinates.chain(fields).chain(inputs).chain(states);
    parameters.chain(moving).chain(observables).collect()
}

fn parameter_row(run: &Instance<'_>, parameter: &Parameter) -> page::SymbolRow {
    let value = run.value(&parameter.name);
    page::SymbolRow {
        value: value.map(|value| parameter.unit.from_si(value)),
        ..varying_row(&parameter.name, &parameter.doc, &parameter.unit)
    }
}

/// Returns the row of a quantity without a fixed value.
fn varying_row(name: &str, doc: &str, unit: &Unit) -> page::SymbolRow {
    page::SymbolRow {
        name: name.to_owned(),
        meaning: doc.to_owned(),
        value: None,
        unit: format_unit(&unit.to_string()),
    }
}

/// Piecewise functions with a definition on the page.
const PIECEWISE: [(Function, &str); 2] = [
    (
        Function::Deadzone,
        "is p − b if p > b, p + b if p < −b, else 0. It is the deflection beyond a play of 2b.",
    ),
    (
        Function::Contact,
        "is 1 if |p| > b, else 0. It is 1 while the flanks touch.",
    ),
];

/// Returns the definitions of the piecewise functions that occur in a model.
pub fn piecewise_functions(model: &Model) -> Vec<page::FunctionNote> {
    let occurring = PIECEWISE.into_iter();
    let occurring = occurring.filter(|(function, _)| contains_function(model, *function));
    let notes = occurring.map(|(function, definition)| page::FunctionNote {
        call: format!("{}({})", function.name(), function.arguments().join(", ")),
        definition,
    });
    notes.collect()
}

/// Returns true if a definition, an energy, the dissipation or a force contains the function.
fn contains_function(model: &Model, function: Function) -> bool {
    let definitions = model.definitions.iter().map(|known| &known.value);
    let terms = [&model.kinetic, &model.potential, &model.dissipation];
    let terms = terms.into_iter().flatten().map(|term| &term.value);
    let forces = model.forces.iter().map(|force| &force.value);
    definitions.chain(terms).chain(forces).any(|expression| {
        let mut found = false;
        expression.visit(&mut |part| {
            found |= matches!(&part.kind, ExprKind::Call(called, _) if *called == function);
        });
        found
    })
}

#[cfg(test)]
mod tests {
    use eomgen_compiled_model::{CompiledModel, Orders};
    use eomgen_model_spec::models;
    use eomgen_model_spec::source::Source;

    use super::*;

    fn derive(text: &str) -> CompiledModel {
        let checked = eomgen_model_spec::check(Source::new("model.toml", text)).expect("a model");
        CompiledModel::derive(checked.model, Orders::Declared).expect("equations")
    }

    #[test]
    fn symbols_have_meaning_value_and_declared_unit() {
        let arm = derive(models::PLANETARY_ARM.text);
        let run = arm.with_declared_parameters().expect("parameters");
        let rows = symbols(&run);
        let row = |name: &str| rows.iter().find(|row| row.name == name).expect("a row");
        let angle = row("alpha");
        assert_eq!((&*angle.meaning, &*angle.unit), ("pressure angle", "deg"));
        assert!((angle.value.unwrap_or(0.0) - 24.6).abs() < 1e-12);
        let coordinate = row("x_c");
        assert!(coordinate.meaning.contains("displacement of the carrier"));
        assert_eq!(coordinate.value, None);
        assert_eq!(row("q").meaning, "amplitudes of the modes of w");
    }

    #[test]
    fn only_occurring_functions_are_defined() {
        let calls = |text: &str| -> Vec<String> {
            let notes = piecewise_functions(derive(text).model()).into_iter();
            notes.map(|note| note.call).collect()
        };
        let both = ["deadzone(p, b)", "contact(p, b)"];
        assert_eq!(calls(models::PLANETARY_ARM.text), both);
        assert!(calls(models::EMPS.text).is_empty());
    }
}
