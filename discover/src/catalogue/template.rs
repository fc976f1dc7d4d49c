//! Conversion of the edits of an effect at a site to edits of a specification.

use std::collections::BTreeMap;

use eomgen_model_spec::edit::{
    Edit, NewCoordinate, NewForce, NewState, NewTerm, Section, Substitution,
};
use eomgen_model_spec::model::{Expr, Model};

use crate::catalogue::effect::{Change, DAMPER_PLACEHOLDER, SiteKind, SubstitutionScope};
use crate::catalogue::site::{Damper, Site};
use crate::model::input_occurrences::find_occurrences;

/// Returns the edits of a change with given placeholder values; `None` if a value or the replaced
/// expression is missing.
pub(crate) fn instantiate_change(
    model: &Model,
    change: &Change,
    site: &Site,
    arguments: &BTreeMap<String, String>,
) -> Option<Vec<Edit>> {
    let fill = |text: &String| fill_placeholders(text, arguments);
    let new = |name: &String| arguments.get(name).unwrap_or(name).clone();
    let free = |name: &String| reserve_name(name, &site.name, &mut list_term_names(model));
    let term = |section: Section, name: String, value: &String| {
        Some(Edit::AddTerm(NewTerm {
            section,
            name,
            value: fill(value)?,
            doc: String::new(),
            source: String::new(),
        }))
    };
    Some(vec![match change {
        Change::Term {
            section,
            name,
            value,
        } => term(*section, free(name), value)?,
        Change::Definition { name, value } => term(Section::Definitions, new(name), value)?,
        Change::Force {
            name,
            target,
            value,
            ..
        } => Edit::AddForce(NewForce {
            name: free(name),
            on: fill(target)?,
            value: fill(value)?,
            doc: String::new(),
            source: String::new(),
        }),
        Change::Coordinate { name, unit, doc } => Edit::AddCoordinate(NewCoordinate {
            name: new(name),
            unit: fill(unit)?,
            doc: doc.clone(),
            initial: None,
        }),
        Change::State {
            name,
            unit,
            rate,
            doc,
        } => Edit::AddState(NewState {
            name: new(name),
            unit: fill(unit)?,
            rate: fill(rate)?,
            doc: doc.clone(),
        }),
        Change::Substitution {
            scope,
            pattern,
            replacement,
        } => {
            return list_substitutions(model, scope, site, (pattern, replacement), arguments);
        }
    }])
}

/// Returns the replacements by section, or `None` if the text does not occur.
fn list_substitutions(
    model: &Model,
    within: &SubstitutionScope,
    site: &Site,
    (find, replace): (&str, &str),
    arguments: &BTreeMap<String, String>,
) -> Option<Vec<Edit>> {
    let found = fill_placeholders(find, arguments);
    let places: Vec<(Section, Vec<String>)> = match within {
        SubstitutionScope::Kinetic(terms) => {
            let terms: Option<Vec<String>> = terms
                .iter()
                .map(|term| fill_placeholders(term, arguments))
                .collect();
            vec![(Section::Kinetic, terms?)]
        }
        SubstitutionScope::Input => find_occurrences(model, found.as_deref()?),
        SubstitutionScope::Site => find_terms_with(model, site, found.as_deref()?),
        // Each damper is replaced separately.
        SubstitutionScope::Dampers => return replace_dampers(site, (find, replace), arguments),
        SubstitutionScope::Measured => replace_measured(model, found.as_deref()?),
    };
    let (find, replace) = (found?, fill_placeholders(replace, arguments)?);
    let substitutions: Vec<Edit> = (places.into_iter())
        .filter(|(_, terms)| !terms.is_empty())
        .map(|(section, terms)| {
            Edit::Substitute(Substitution {
                section,
                terms,
                find: find.clone(),
                replace: replace.clone(),
            })
        })
        .collect();
    (!substitutions.is_empty()).then_some(substitutions)
}

/// Returns a replacement for each damper parallel to a spring, or `None` if there is no damper.
fn replace_dampers(
    site: &Site,
    (find, replace): (&str, &str),
    arguments: &BTreeMap<String, String>,
) -> Option<Vec<Edit>> {
    let substitution = |damper: &Damper| {
        let mut arguments = arguments.clone();
        arguments.insert(DAMPER_PLACEHOLDER.to_owned(), damper.part.clone());
        Some(Edit::Substitute(Substitution {
            section: damper.section,
            terms: vec![damper.term.clone()],
            find: fill_placeholders(find, &arguments)?,
            replace: fill_placeholders(replace, &arguments)?,
        }))
    };
    let all: Option<Vec<Edit>> = site.dampers.iter().map(substitution).collect();
    all.filter(|edits| !edits.is_empty())
}

/// Returns the definitions and observables that contain an expression, compared without spaces.
fn replace_measured(model: &Model, find: &str) -> Vec<(Section, Vec<String>)> {
    let plain = |text: &str| text.split_whitespace().collect::<String>();
    let find = plain(find);
    let holds = |value: &Expr| {
        let text = model.source.text.get(value.span.start..value.span.end);
        text.is_some_and(|text| plain(text).contains(&find))
    };
    let definitions = model.definitions.iter().filter(|d| holds(&d.value));
    let observables = model.observables.iter().filter(|o| holds(&o.value));
    vec![
        (
            Section::Definitions,
            definitions.map(|d| d.name.clone()).collect(),
        ),
        (
            Section::Observables,
            observables.map(|o| o.name.clone()).collect(),
        ),
    ]
}

/// Returns the terms of a site that contain a name.
fn find_terms_with(model: &Model, site: &Site, name: &str) -> Vec<(Section, Vec<String>)> {
    // The deflection of a spring may be any expression, and its term contains the deflection.
    if site.kind == SiteKind::Spring {
        return site.terms.clone();
    }
    let text = |section: Section, term: &str| {
        let span = match section {
            Section::Definitions => {
                model
                    .definitions
                    .iter()
                    .find(|d| d.name == term)?
                    .value
                    .span
            }
            Section::Forces => model.forces.iter().find(|f| f.name == term)?.value.span,
            Section::Potential => model.potential.iter().find(|t| t.name == term)?.value.span,
            Section::Dissipation => {
                model
                    .dissipation
                    .iter()
                    .find(|t| t.name == term)?
                    .value
                    .span
            }
            Section::Kinetic => model.kinetic.iter().find(|t| t.name == term)?.value.span,
            Section::Observables | Section::States => return None,
        };
        model.source.text.get(span.start..span.end)
    };
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    let plain = |text: &str| text.split_whitespace().collect::<String>();
    let holds = |section: Section, term: &str| {
        let value = text(section, term).unwrap_or_default();
        match name.chars().all(is_letter) {
            true => value.split(|c| !is_letter(c)).any(|word| word == name),
            false => plain(value).contains(&plain(name)),
        }
    };
    let places = site.terms.iter();
    places
        .map(|(section, terms)| {
            let terms = terms
                .iter()
                .filter(|term| holds(*section, term))
                .cloned()
                .collect();
            (*section, terms)
        })
        .collect()
}

/// Replaces the placeholders of a text by their values; `None` if a value is missing.
pub(crate) fn fill_placeholders(
    text: &str,
    arguments: &BTreeMap<String, String>,
) -> Option<String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (key, behind) = after.split_once('}')?;
        out.push_str(before);
        out.push_str(arguments.get(key)?);
        rest = behind;
    }
    out.push_str(rest);
    Some(out)
}

/// Returns an unused name based on the wanted one and adds it to the names in use.
pub(crate) fn reserve_name(wanted: &str, site: &str, taken: &mut Vec<String>) -> String {
    let mut name = wanted.to_owned();
    if taken.contains(&name) {
        name = format!("{wanted}_{site}");
    }
    let mut number = 2;
    while taken.contains(&name) {
        name = format!("{wanted}_{site}_{number}");
        number += 1;
    }
    taken.push(name.clone());
    name
}

/// Returns the names of the terms and forces of a model.
pub(crate) fn list_term_names(model: &Model) -> Vec<String> {
    let energies = model
        .kinetic
        .iter()
        .chain(&model.potential)
        .chain(&model.dissipation);
    let names = energies.map(|term| term.name.clone());
    names
        .chain(model.forces.iter().map(|force| force.name.clone()))
        .collect()
}
