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
enum Added {
    Term(Section),
    Definition,
    Force,
    Coordinate,
    State,
}

const ADDED: [(&str, Added); 7] = [
    ("force", Added::Force),
    ("kinetic", Added::Term(Section::Kinetic)),
    ("potential", Added::Term(Section::Potential)),
    ("dissipation", Added::Term(Section::Dissipation)),
    ("definition", Added::Definition),
    ("coordinate", Added::Coordinate),
    ("state", Added::State),
];

/// Scope in which an edit replaces text.
#[derive(Clone, Copy)]
enum Replaced {
    Kinetic,
    /// Terms of a site of the given kind.
    Site(SiteKind),
    /// Dampers parallel to a spring.
    Dampers,
    Measured,
    /// All occurrences of an input.
    Input,
}

impl Replaced {
    /// Returns the kind of site that this scope requires, if any.
    fn site(self) -> Option<SiteKind> {
        match self {
            Self::Site(kind) => Some(kind),
            Self::Dampers => Some(SiteKind::Spring),
            Self::Input => Some(SiteKind::Input),
            Self::Kinetic | Self::Measured => None,
        }
    }
}

const REPLACED: [(&str, Replaced); 7] = [
    ("kinetic", Replaced::Kinetic),
    ("mesh", Replaced::Site(SiteKind::Mesh)),
    ("arm", Replaced::Site(SiteKind::Arm)),
    ("spring", Replaced::Site(SiteKind::Spring)),
    ("damper", Replaced::Dampers),
    ("measured", Replaced::Measured),
    ("input", Replaced::Input),
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
            let what = found.push_error(add.keyword(&ADDED))?;
            addition(entry, what, placeholders, found)
        }
        (None, Some(substitute)) => {
            let within = found.push_error(substitute.keyword(&REPLACED))?;
            if let Some(kind) = within.site()
                && kind != site
            {
                let wrong = Diagnostic::error("this effect has another kind of site");
                let kind = SiteKind::KEYWORDS.iter().find(|(_, known)| *known == kind);
                let expected = kind.map_or("", |(word, _)| word);
                found.push(
                    wrong.with_span(substitute.span(), format!("expected site = \"{expected}\"")),
                );
            }
            substitution(entry, within, placeholders, found)
        }
        _ => {
            Record::read_with(entry, &KEYS, "{ add = \"force\", ... }", found);
            found.push(
                Diagnostic::error("an edit needs `add` or `substitute`")
                    .with_span(entry.span(), "expected one of both keys"),
            );
            None
        }
    }
}

fn addition(
    entry: &Entry<'_>,
    what: Added,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<Change> {
    let known: &[&str] = match what {
        Added::Term(_) | Added::Definition => &["add", "name", "value"],
        Added::Force => &["add", "name", "on", "value", "linear"],
        Added::Coordinate => &["add", "name", "unit", "doc"],
        Added::State => &["add", "name", "unit", "rate", "doc"],
    };
    let record = Record::read_with(entry, known, "{ add = \"force\", ... }", found)?;
    let name = read_new_name(&record, found);
    Some(match what {
        Added::Term(section) => Change::Term {
            section,
            value: read_expression(&record, "value", placeholders, found)?,
            name: name?,
        },
        Added::Definition => Change::Definition {
            value: read_expression(&record, "value", placeholders, found)?,
            name: name?,
        },
        Added::Force => Change::Force {
            target: read_expression(&record, "on", placeholders, found)?,
            value: read_expression(&record, "value", placeholders, found)?,
            linear: match record.get("linear") {
                Some(_) => Some(read_expression(&record, "linear", placeholders, found)?),
                None => None,
            },
            name: name?,
        },
        Added::Coordinate => Change::Coordinate {
            unit: unit(&record, placeholders, found)?,
            doc: doc(&record, found)?,
            name: name?,
        },
        Added::State => Change::State {
            unit: unit(&record, placeholders, found)?,
            rate: read_expression(&record, "rate", placeholders, found)?,
            doc: doc(&record, found)?,
            name: name?,
        },
    })
}

/// Reads the unit of an added quantity.
fn unit(
    record: &Record<'_>,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<String> {
    let unit = read_text(record, "unit", "\"rad\"", found)?;
    placeholders.check_placeholders(&unit, found);
    Some(unit.text)
}

/// Reads the description of an added quantity.
fn doc(record: &Record<'_>, found: &mut Diagnostics) -> Option<String> {
    Some(read_text(record, "doc", "\"description of the quantity\"", found)?.text)
}

fn substitution(
    entry: &Entry<'_>,
    within: Replaced,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<Change> {
    let known: &[&str] = match within {
        Replaced::Kinetic => &["substitute", "terms", "find", "replace"],
        Replaced::Site(_) | Replaced::Dampers | Replaced::Measured | Replaced::Input => {
            &["substitute", "find", "replace"]
        }
    };
    let record = Record::read_with(entry, known, "{ substitute = \"mesh\", ... }", found)?;
    // The placeholder of the damper is defined only in this scope.
    if let Replaced::Dampers = within {
        placeholders.known.push(DAMPER_PLACEHOLDER.to_owned());
    }
    let find = read_expression(&record, "find", placeholders, found);
    let replace = read_expression(&record, "replace", placeholders, found);
    placeholders
        .known
        .retain(|known| known != DAMPER_PLACEHOLDER);
    let within = match within {
        Replaced::Site(_) => SubstitutionScope::Site,
        Replaced::Dampers => SubstitutionScope::Dampers,
        Replaced::Measured => SubstitutionScope::Measured,
        Replaced::Input => SubstitutionScope::Input,
        Replaced::Kinetic => {
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
