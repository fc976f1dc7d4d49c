//! Tables of a file whose keys are checked.

use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::keys::{Key, Keys};
use crate::quantity::{Name, Number, Quantity, StringValue};
use crate::suggest::did_you_mean;
use crate::table::Entry;

/// Table whose keys were checked.
pub struct Record<'d> {
    owner: Name,
    entries: Vec<Entry<'d>>,
    keys: Option<&'static Keys>,
    /// True for the top level of a file.
    is_file: bool,
}

impl<'d> Record<'d> {
    /// Marks the record as the top level of a file. Messages write its name without quotes.
    pub fn as_file(self) -> Self {
        Self {
            is_file: true,
            ..self
        }
    }

    /// Reads the table of an entry, and reports keys that are not in `keys`.
    pub fn read(entry: &Entry<'d>, keys: &'static Keys, found: &mut Diagnostics) -> Option<Self> {
        let entries = found.push_error(entry.table_of(keys))?;
        Some(Self::new(entry.name.clone(), entries, keys, found))
    }

    /// Reads the table of an entry, and reports keys that are not in `known`.
    pub fn read_with(
        entry: &Entry<'d>,
        known: &[&str],
        example: &str,
        found: &mut Diagnostics,
    ) -> Option<Self> {
        let entries = found.push_error(entry.table(example))?;
        Some(Self::with_keys(entry.name.clone(), entries, known, found))
    }

    /// Creates a record, and reports keys that are not in `keys`.
    pub fn new(
        owner: Name,
        entries: Vec<Entry<'d>>,
        keys: &'static Keys,
        found: &mut Diagnostics,
    ) -> Self {
        let known: Vec<&str> = keys.names().collect();
        Self {
            keys: Some(keys),
            ..Self::with_keys(owner, entries, &known, found)
        }
    }

    /// Creates a record, and reports keys that are not in `known`.
    pub fn with_keys(
        owner: Name,
        entries: Vec<Entry<'d>>,
        known: &[&str],
        found: &mut Diagnostics,
    ) -> Self {
        let (entries, others): (Vec<_>, Vec<_>) = entries
            .into_iter()
            .partition(|entry| known.contains(&entry.name.text.as_str()));
        for other in others {
            found.push_with(|| match other.is_section() {
                true => unknown_entry_error(("table", "tables"), &other.name, known),
                false => unknown_key_error(&other.name, known),
            });
        }
        Self {
            owner,
            entries,
            keys: None,
            is_file: false,
        }
    }

    /// Returns the key of the table.
    pub fn owner(&self) -> &Name {
        &self.owner
    }

    /// Returns the entry of a key, if present.
    pub fn get(&self, key: &str) -> Option<&Entry<'d>> {
        self.entries.iter().find(|entry| entry.name.text == key)
    }

    /// Returns the entry of a key. If it is missing, reports an error with the meaning and the example from the
    /// description of the keys.
    pub fn require(&self, key: &str, found: &mut Diagnostics) -> Option<&Entry<'d>> {
        let keys = self.keys.map_or(&[][..], |keys| keys.list);
        let described = keys.iter().find(|described| described.name == key);
        self.require_with(key, &described.map(Key::help).unwrap_or_default(), found)
    }

    /// Returns the entry of a key. If it is missing, reports an error with this help.
    pub fn require_with(
        &self,
        key: &str,
        help: &str,
        found: &mut Diagnostics,
    ) -> Option<&Entry<'d>> {
        let entry = self.get(key);
        if entry.is_none() {
            let owner = match self.is_file {
                true => self.owner.text.clone(),
                false => quote(&self.owner.text),
            };
            found.push(
                Diagnostic::error(format!("{owner} has no `{key}`"))
                    .with_span(self.owner.span, format!("`{key}` is missing"))
                    .with_help(help),
            );
        }
        entry
    }

    /// Returns the value of a required key, or reports that it is missing or of another kind.
    pub fn required<T>(
        &self,
        key: &str,
        read: impl Fn(&Entry<'d>) -> Result<T, Diagnostic>,
        found: &mut Diagnostics,
    ) -> Option<T> {
        let value = read(self.require(key, found)?);
        found.push_error(value)
    }

    /// Returns the value of a key, if present, or reports that it is of another kind.
    pub fn optional<T>(
        &self,
        key: &str,
        read: impl Fn(&Entry<'d>) -> Result<T, Diagnostic>,
        found: &mut Diagnostics,
    ) -> Option<T> {
        found.push_error(read(self.get(key)?))
    }

    /// Returns the string value of a key, "" if absent.
    pub fn text(&self, key: &str, found: &mut Diagnostics) -> String {
        self.written(key, found)
            .map_or_else(String::new, |w| w.text)
    }

    /// Returns the string value of a key with its position, if present.
    pub fn written(&self, key: &str, found: &mut Diagnostics) -> Option<StringValue> {
        self.optional(key, Entry::written, found)
    }

    /// Returns the numeric value of a key, if present.
    pub fn number(&self, key: &str, found: &mut Diagnostics) -> Option<Number> {
        self.optional(key, Entry::number, found)
    }

    /// Returns the value of a key, a number or an expression, if present.
    pub fn quantity(&self, key: &str, found: &mut Diagnostics) -> Option<Quantity> {
        self.optional(key, Entry::quantity, found)
    }
}

/// Returns the error for an unknown key, with the nearest known key.
pub fn unknown_key_error(name: &Name, known: &[&str]) -> Diagnostic {
    unknown_entry_error(("key", "keys"), name, known)
}

/// Returns the error for an unknown entry, with the nearest known entry. `one` and `all` are the kind of entry in the
/// singular and in the plural.
fn unknown_entry_error((one, all): (&str, &str), name: &Name, known: &[&str]) -> Diagnostic {
    let listed = format!("the {all} are {}", known.join(", "));
    Diagnostic::error(format!("unknown {one} {}", quote(&name.text)))
        .with_span(name.span, "unknown here")
        .with_help(did_you_mean(&name.text, known.iter().copied()).unwrap_or(listed))
}
