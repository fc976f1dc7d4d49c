//! Description of the keys of a table. The reader checks files with it; messages, the JSON schema and the reference
//! page are generated from it.

/// Keys of a table.
#[derive(Debug)]
pub struct Keys {
    /// Keys, in the order of the reference page.
    pub list: &'static [Key],
    /// Sets of keys that exclude each other. An entry has the keys of exactly one set.
    pub one_of: &'static [&'static [&'static str]],
    /// Keys; an entry has at least one of them.
    pub any_of: &'static [&'static str],
    /// Kind of a value that replaces the table, if permitted.
    pub shorthand: Option<&'static str>,
}

/// Key of a table.
#[derive(Debug)]
pub struct Key {
    /// Name in the file.
    pub name: &'static str,
    /// Kind of its value.
    pub kind: Kind,
    /// Value, as written in the file.
    pub example: &'static str,
    /// Meaning, as a noun phrase; a condition follows a semicolon.
    pub doc: &'static str,
    /// True if the key is required.
    pub is_required: bool,
    /// Heading of the reference page with the details; empty if there is none.
    pub heading: &'static str,
}

/// Kind of a value.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Number, text or list, given by its name in the schema.
    Value(&'static str),
    /// Table with these keys.
    Table(&'static Keys),
    /// Table of named entries with these keys.
    Entries(&'static Keys),
}

impl Keys {
    /// Creates keys that are independent of each other.
    pub const fn new(list: &'static [Key]) -> Self {
        Self {
            list,
            one_of: &[],
            any_of: &[],
            shorthand: None,
        }
    }

    /// Permits a value of this kind instead of the table.
    pub const fn or_value(mut self, kind: &'static str) -> Self {
        self.shorthand = Some(kind);
        self
    }

    /// Returns the names of the keys.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.list.iter().map(|key| key.name)
    }

    /// Returns an example of a table: the required keys, or the first key if none is required.
    pub fn example(&self) -> String {
        self.example_with(&[])
    }

    /// Returns the example of a table in which the keys `given` have these texts.
    pub fn example_with(&self, given: &[(&str, String)]) -> String {
        let chosen = self.one_of.first().copied().unwrap_or(self.any_of);
        let text = |key: &Key| given.iter().find(|(name, _)| *name == key.name);
        let is_shown =
            |key: &&Key| key.is_required || chosen.contains(&key.name) || text(key).is_some();
        let shown: Vec<&Key> = self.list.iter().filter(is_shown).collect();
        let shown = match shown.is_empty() {
            true => self.list.iter().take(1).collect(),
            false => shown,
        };
        let shown = shown.iter().map(|key| match text(key) {
            Some((name, text)) => format!("{name} = {text}"),
            None => key.assignment(),
        });
        format!("{{ {} }}", shown.collect::<Vec<_>>().join(", "))
    }
}

impl Key {
    /// Creates an optional key with a value of this kind.
    pub const fn new(
        name: &'static str,
        kind: &'static str,
        example: &'static str,
        doc: &'static str,
    ) -> Self {
        Self {
            name,
            kind: Kind::Value(kind),
            example,
            doc,
            is_required: false,
            heading: "",
        }
    }

    /// Creates an optional key with a table.
    pub const fn nested(
        name: &'static str,
        kind: Kind,
        heading: &'static str,
        doc: &'static str,
    ) -> Self {
        Self {
            kind,
            heading,
            ..Self::new(name, "", "", doc)
        }
    }

    /// Returns the key as a required one.
    pub const fn required(mut self) -> Self {
        self.is_required = true;
        self
    }

    /// Adds the heading of the reference page with the details.
    pub const fn explained(mut self, heading: &'static str) -> Self {
        self.heading = heading;
        self
    }

    /// Returns the help of a message for a missing key.
    pub fn help(&self) -> String {
        let meaning = self.doc.split(';').next().unwrap_or_default();
        format!("give the {meaning}: {}", self.assignment())
    }

    /// Returns `name = example`.
    pub fn assignment(&self) -> String {
        match self.kind {
            Kind::Value(_) => format!("{} = {}", self.name, self.example),
            Kind::Table(keys) => format!("{} = {}", self.name, keys.example()),
            Kind::Entries(keys) => format!("{} = {{ NAME = {} }}", self.name, keys.example()),
        }
    }
}
