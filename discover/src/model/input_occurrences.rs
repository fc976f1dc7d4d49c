//! Occurrences of inputs in a specification and their replacement.

use eomgen_model_spec::edit::{Edit, Section, Substitution};
use eomgen_model_spec::model::{Expr, ExprKind, Input, Model, Term, written_name};
use eomgen_model_spec::span::Span;

/// Returns the inputs that may be replaced. Prescribed motions are excluded because their rates
/// would have to be replaced too.
pub fn list_replaceable(model: &Model) -> impl Iterator<Item = &Input> {
    let inputs = model.inputs.iter();
    inputs.filter(|input| input.rate.is_none() && input.rate_of.is_none())
}

/// Returns the only input of a model, not counting its rates; `None` if there are several.
pub fn find_only_input(model: &Model) -> Option<&Input> {
    let mut inputs = model.inputs.iter().filter(|input| input.rate_of.is_none());
    let first = inputs.next();
    first.filter(|_| inputs.next().is_none())
}

/// Entry of a specification.
struct SpecificationEntry<'m> {
    section: Section,
    name: &'m str,
    span: Span,
    value: &'m Expr,
}

/// Returns the entries that may contain an input.
fn list_entries(model: &Model) -> Vec<SpecificationEntry<'_>> {
    let of = |section: Section| {
        move |(name, span, value)| SpecificationEntry {
            section,
            name: written_name(name, span, &model.source),
            span,
            value,
        }
    };
    let forces = model
        .forces
        .iter()
        .map(|f| (f.name.as_str(), f.span, &f.value));
    let observables = model
        .observables
        .iter()
        .map(|o| (o.name.as_str(), o.span, &o.value));
    let states = model
        .states
        .iter()
        .map(|s| (s.name.as_str(), s.span, &s.rate));
    let mut found: Vec<SpecificationEntry<'_>> = Vec::new();
    found.extend(model.kinetic.iter().map(term).map(of(Section::Kinetic)));
    found.extend(model.potential.iter().map(term).map(of(Section::Potential)));
    found.extend(
        model
            .dissipation
            .iter()
            .map(term)
            .map(of(Section::Dissipation)),
    );
    found.extend(forces.map(of(Section::Forces)));
    found.extend(observables.map(of(Section::Observables)));
    found.extend(states.map(of(Section::States)));
    for definition in &model.definitions {
        // A vector in another section is expanded to definitions that are not in the file.
        let owner = found.iter().find(|entry| entry.span == definition.span);
        let section = owner.map_or(Section::Definitions, |owner| owner.section);
        let entry = (definition.name.as_str(), definition.span, &definition.value);
        found.push(of(section)(entry));
    }
    found
}

fn term(term: &Term) -> (&str, Span, &Expr) {
    (&term.name, term.span, &term.value)
}

/// Returns the entries of each section that contain an input.
pub fn find_occurrences(model: &Model, input: &str) -> Vec<(Section, Vec<String>)> {
    let holds = |expr: &Expr| {
        let mut found = false;
        expr.visit(&mut |part| {
            if let ExprKind::Input(id) = part.kind {
                found |= model.inputs[id].name == input;
            }
        });
        found
    };
    let mut found: Vec<(Section, Vec<String>)> = Vec::new();
    for entry in list_entries(model)
        .iter()
        .filter(|entry| holds(entry.value))
    {
        let at = match found
            .iter()
            .position(|(section, _)| *section == entry.section)
        {
            Some(at) => at,
            None => {
                found.push((entry.section, Vec::new()));
                found.len() - 1
            }
        };
        let names = &mut found[at].1;
        // All components of a vector have the same name.
        if !names.iter().any(|name| name == entry.name) {
            names.push(entry.name.to_owned());
        }
    }
    found
}

/// Returns the edits that replace an input by an expression everywhere.
pub fn replace_input(model: &Model, input: &str, acting: &str) -> Vec<Edit> {
    let edits = find_occurrences(model, input)
        .into_iter()
        .map(|(section, terms)| {
            Edit::Substitute(Substitution {
                section,
                terms,
                find: input.to_owned(),
                replace: acting.to_owned(),
            })
        });
    edits.collect()
}
