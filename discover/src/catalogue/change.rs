//! Edits of an effect: additions and substitutions.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::record::Record;
use eomgen_model_spec::table::Entry;

use super::effect::{Change, DAMPER_PLACEHOLDER, SiteKind, SubstitutionScope};
use super::fields::{read_new_name, read_nonempty_list, read_text};
use super::placeholders::{Placeholders, read_expression};

/// Kind of entry that an edit adds.
#[derive(Clone, Copy)]
enum AdditionKind {
    Term(Section),
    Definition,
    Force,
    Coordinate,
    State,
}

const ADDITION_KEYS: [(&str, AdditionKind); 7] = [
    ("force", AdditionKind::Force),
    ("kinetic", AdditionKind::Term(Section::Kinetic)),
    ("potential", AdditionKind::Term(Section::Potential)),
    ("dissipation", AdditionKind::Term(Section::Dissipation)),
    ("definition", AdditionKind::Definition),
    ("coordinate", AdditionKind::Coordinate),
    ("state", AdditionKind::State),
];

/// Scope in which an edit replaces text.
#[derive(Clone, Copy)]
enum ReplacementScope {
    Kinetic,
    /// Terms of a site of the given kind.
    Site(SiteKind),
    /// Dampers parallel to a spring.
    Dampers,
    Measured,
    /// All occurrences of an input.
    Input,
}

impl ReplacementScope {
    /// Returns the kind of site that this scope requires, if any.
    fn required_site(self) -> Option<SiteKind> {
        match self {
            Self::Site(kind) => Some(kind),
            Self::Dampers => Some(SiteKind::Spring),
            Self::Input => Some(SiteKind::Input),
            Self::Kinetic | Self::Measured => None,
        }
    }
}

const REPLACEMENT_SCOPES: [(&str, ReplacementScope); 7] = [
    ("kinetic", ReplacementScope::Kinetic),
    ("mesh", ReplacementScope::Site(SiteKind::Mesh)),
    ("arm", ReplacementScope::Site(SiteKind::Arm)),
    ("spring", ReplacementScope::Site(SiteKind::Spring)),
    ("damper", ReplacementScope::Dampers),
    ("measured", ReplacementScope::Measured),
    ("input", ReplacementScope::Input),
];

/// All keys of an edit.
const KEYS: [&str; 12] = [
    "add",
    "substitute",
    "name",
    "on",
    "value",
    "linear",
    "unit",
    "rate",
    "doc",
    "terms",
    "find",
    "replace",
];

/// Reads an edit.
pub(super) fn read_change(
    entry: &Entry<'_>,
    site: SiteKind,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<Change> {
    let entries = found.push_error(entry.table("{ add = \"force\", ... }"))?;
    let of = |key: &str| entries.iter().find(|entry| entry.name.text == key);
    match (of("add"), of("substitute")) {
        (Some(add), None) => {
            let what = found.push_error(add.keyword(&ADDITION_KEYS))?;
            read_addition(entry, what, placeholders, found)
        }
        (None, Some(substitute)) => {
            let within = found.push_error(substitute.keyword(&REPLACEMENT_SCOPES))?;
            if let Some(kind) = within.required_site()
                && kind != site
            {
                let wrong = Diagnostic::error("this effect has another kind of site");
                let kind = SiteKind::KEYWORDS.iter().find(|(_, known)| *known == kind);
                let expected = kind.map_or("", |(word, _)| word);
                found.push(
                    wrong.with_span(substitute.span(), format!("expected site = \"{expected}\"")),
                );
            }
            read_substitution(entry, within, placeholders, found)
        }
        _ => {
            Record::read_with(entry, &KEYS, "{ add = \"force\", ... }", found);
            found.push(
                Diagnostic::error("an edit needs `add` or `substitute`")
                    .with_span(entry.span(), "expected one of these two keys"),
            );
            None
        }
    }
}

fn read_addition(
    entry: &Entry<'_>,
    what: AdditionKind,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<Change> {
    let known: &[&str] = match what {
        AdditionKind::Term(_) | AdditionKind::Definition => &["add", "name", "value"],
        AdditionKind::Force => &["add", "name", "on", "value", "linear"],
        AdditionKind::Coordinate => &["add", "name", "unit", "doc"],
        AdditionKind::State => &["add", "name", "unit", "rate", "doc"],
    };
    let record = Record::read_with(entry, known, "{ add = \"force\", ... }", found)?;
    let name = read_new_name(&record, found);
    Some(match what {
        AdditionKind::Term(section) => Change::Term {
            section,
            value: read_expression(&record, "value", placeholders, found)?,
            name: name?,
        },
        AdditionKind::Definition => Change::Definition {
            value: read_expression(&record, "value", placeholders, found)?,
            name: name?,
        },
        AdditionKind::Force => Change::Force {
            target: read_expression(&record, "on", placeholders, found)?,
            value: read_expression(&record, "value", placeholders, found)?,
            linear: match record.get("linear") {
                Some(_) => Some(read_expression(&record, "linear", placeholders, found)?),
                None => None,
            },
            name: name?,
        },
        AdditionKind::Coordinate => Change::Coordinate {
            unit: read_unit(&record, placeholders, found)?,
            doc: read_doc(&record, found)?,
            name: name?,
        },
        AdditionKind::State => Change::State {
            unit: read_unit(&record, placeholders, found)?,
            rate: read_expression(&record, "rate", placeholders, found)?,
            doc: read_doc(&record, found)?,
            name: name?,
        },
    })
}

/// Reads the unit of an added quantity.
fn read_unit(
    record: &Record<'_>,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<String> {
    let unit = read_text(record, "unit", "\"rad\"", found)?;
    placeholders.check_placeholders(&unit, found);
    Some(unit.text)
}

/// Reads the description of an added quantity.
fn read_doc(record: &Record<'_>, found: &mut Diagnostics) -> Option<String> {
    Some(read_text(record, "doc", "\"description of the quantity\"", found)?.text)
}

fn read_substitution(
    entry: &Entry<'_>,
    within: ReplacementScope,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<Change> {
    let known: &[&str] = match within {
        ReplacementScope::Kinetic => &["substitute", "terms", "find", "replace"],
        ReplacementScope::Site(_)
        | ReplacementScope::Dampers
        | ReplacementScope::Measured
        | ReplacementScope::Input => &["substitute", "find", "replace"],
    };
    let record = Record::read_with(entry, known, "{ substitute = \"mesh\", ... }", found)?;
    // The placeholder of the damper is defined only in this scope.
    if let ReplacementScope::Dampers = within {
        placeholders.known.push(DAMPER_PLACEHOLDER.to_owned());
    }
    let find = read_expression(&record, "find", placeholders, found);
    let replace = read_expression(&record, "replace", placeholders, found);
    placeholders
        .known
        .retain(|known| known != DAMPER_PLACEHOLDER);
    let within = match within {
        ReplacementScope::Site(_) => SubstitutionScope::Site,
        ReplacementScope::Dampers => SubstitutionScope::Dampers,
        ReplacementScope::Measured => SubstitutionScope::Measured,
        ReplacementScope::Input => SubstitutionScope::Input,
        ReplacementScope::Kinetic => {
            let mut terms = Vec::new();
            for term in read_nonempty_list(&record, "terms", "[\"{term}\"]", found)? {
                let term = found.push_error(term.written())?;
                placeholders.check_placeholders(&term, found);
                terms.push(term.text);
            }
            SubstitutionScope::Kinetic(terms)
        }
    };
    Some(Change::Substitution {
        scope: within,
        pattern: find?,
        replacement: replace?,
    })
}
