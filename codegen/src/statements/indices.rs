//! Names of indices: constants for the positions of states, inputs, parameters and observables.

use std::collections::HashMap;

use crate::program::Program;

/// Indices of one kind.
pub struct Indices {
    /// Kind, in lower case.
    pub kind: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Quantities in their order, with the names of their constants.
    pub entries: Vec<(String, String)>,
}

/// Returns all kinds with at least one quantity.
pub fn list_indices(program: &Program) -> Vec<Indices> {
    let inputs = program.inputs.iter().map(|input| input.name.clone());
    let parameters = program
        .parameters
        .iter()
        .map(|parameter| parameter.quantity.name.clone());
    let observables = program
        .observables
        .iter()
        .map(|observable| observable.name.clone());
    let all = [
        (
            "state",
            "Indices of the states, and of their time derivatives in the rates.",
            program.state_names(),
        ),
        ("input", "Indices of the inputs.", inputs.collect()),
        (
            "parameter",
            "Indices of the parameters.",
            parameters.collect(),
        ),
        (
            "observable",
            "Indices of the observables.",
            observables.collect(),
        ),
    ];
    let all = all.into_iter().filter(|(_, _, names)| !names.is_empty());
    all.map(|(kind, doc, names)| Indices {
        kind,
        doc,
        entries: name_constants(names),
    })
    .collect()
}

/// Pairs each name with the name of its constant: the name in capitals, or the unchanged name if another name differs
/// only in its capitals.
fn name_constants(names: Vec<String>) -> Vec<(String, String)> {
    let mut uses: HashMap<String, usize> = HashMap::new();
    for name in &names {
        *uses.entry(name.to_uppercase()).or_default() += 1;
    }
    let constant = |name: &String| match name.to_uppercase() {
        capitals if uses.get(&capitals) == Some(&1) => capitals,
        _ => name.clone(),
    };
    names
        .iter()
        .map(|name| (name.clone(), constant(name)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_differ_in_capitals_keep_them() {
        let names = ["x_sp_dot", "k", "K", "I_p"].map(str::to_owned).to_vec();
        let constants: Vec<String> = name_constants(names)
            .into_iter()
            .map(|(_, constant)| constant)
            .collect();
        assert_eq!(constants, ["X_SP_DOT", "k", "K", "I_P"]);
    }
}
