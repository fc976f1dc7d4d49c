//! Findings on a specification: rendered for people with the text underlined, or as records for
//! programs.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde::Serialize;

use crate::hidden_characters::escape_hidden;
use crate::source::{Source, character_start};
use crate::span::Span;

/// Largest number of findings listed; one bad file can have thousands.
pub const MAX_LISTED: usize = 20;

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The specification cannot be used.
    Error,
    /// The specification is valid, but possibly not as intended.
    Warning,
}

/// Remark on a part of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The part.
    pub span: Span,
    /// The remark; may be empty.
    pub text: String,
}

/// One finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Severity.
    pub severity: Severity,
    /// The cause, in one line.
    pub message: String,
    /// The place; `None` for the file as a whole.
    pub primary: Option<Label>,
    /// Other places that explain it.
    pub secondary: Vec<Label>,
    /// The cure, if known.
    pub help: Option<String>,
    /// Kind of an unused declaration. `render` prints all unused names of a kind in one line.
    pub unused: Option<DeclarationKind>,
}

/// Kind of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeclarationKind {
    /// A parameter.
    Parameter,
    /// An input.
    Input,
    /// A definition.
    Definition,
}

impl DeclarationKind {
    fn name(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Input => "input",
            Self::Definition => "definition",
        }
    }
}

impl Diagnostic {
    /// Returns the message, with the help in parentheses.
    pub fn summary(&self) -> String {
        match &self.help {
            Some(help) => format!("{} ({help})", self.message),
            None => self.message.clone(),
        }
    }

    /// Creates an error without a place.
    pub fn error(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            primary: None,
            secondary: Vec::new(),
            help: None,
            unused: None,
        }
    }

    /// Creates a warning about a declared name that nothing refers to.
    pub fn unused(kind: DeclarationKind, name: &str, span: Span) -> Self {
        Self {
            unused: Some(kind),
            ..Self::warning(format!("the {} `{name}` is not used", kind.name()))
        }
        .with_span(span, "nothing refers to it")
        .with_help("remove it, or use it where it was meant")
    }

    /// Creates a warning without a place.
    pub fn warning(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(message)
        }
    }

    /// Sets the place.
    pub fn with_span(mut self, span: Span, label: impl Into<String>) -> Self {
        self.primary = Some(Label {
            span,
            text: label.into(),
        });
        self
    }

    /// Adds a related place.
    pub fn with_related_span(mut self, span: Span, label: impl Into<String>) -> Self {
        self.secondary.push(Label {
            span,
            text: label.into(),
        });
        self
    }

    /// Sets the cure.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Sets the cure, if there is one.
    pub fn with_optional_help(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }
}

/// Findings on one source.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    source: Source,
    list: Vec<Diagnostic>,
    omitted: usize,
}

/// A finding as written for programs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Record {
    /// The file.
    pub file: String,
    /// Line, from 1, if there is a place.
    pub line: Option<usize>,
    /// Column in characters, from 1, if there is a place.
    pub column: Option<usize>,
    /// Line of the first character after the place.
    pub end_line: Option<usize>,
    /// Column of the first character after the place.
    pub end_column: Option<usize>,
    /// Severity.
    pub severity: Severity,
    /// The cause.
    pub message: String,
    /// The cure, if known.
    pub help: Option<String>,
}

impl Diagnostics {
    /// Returns an empty list for a source.
    pub fn new(source: Source) -> Self {
        Self {
            source,
            list: Vec::new(),
            omitted: 0,
        }
    }

    /// Returns a list of one finding.
    pub fn from_one(source: Source, diagnostic: Diagnostic) -> Self {
        let mut diagnostics = Self::new(source);
        diagnostics.push(diagnostic);
        diagnostics
    }

    /// Adds a finding, or only counts it beyond [`MAX_LISTED`].
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.is_full() {
            self.omitted += 1;
        // Each component of a vector repeats the same finding.
        } else if !self.list.contains(&diagnostic) {
            self.list.push(diagnostic);
        }
    }

    /// Adds a finding that is costly to build; beyond [`MAX_LISTED`] it is counted and not built.
    pub fn push_with(&mut self, make: impl FnOnce() -> Diagnostic) {
        if self.is_full() {
            self.omitted += 1;
        } else {
            self.list.push(make());
        }
    }

    /// Adds the error, or returns the value.
    pub fn push_error<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.push(diagnostic)).ok()
    }

    /// Returns true if further findings are only counted.
    pub fn is_full(&self) -> bool {
        self.list.len() >= MAX_LISTED
    }

    /// Returns true if there are no findings.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the findings, in the order in which they were added.
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Returns the number of findings that are only counted.
    pub fn omitted_count(&self) -> usize {
        self.omitted
    }

    /// Returns the source of the findings.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Renders all findings for people: file, line and column, underlined text, cause and cure.
    /// Unused names take one line per kind. `colour` adds terminal escapes.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let mut parts: Vec<String> = self
            .list
            .iter()
            .filter(|diagnostic| diagnostic.unused.is_none())
            .map(|diagnostic| renderer.render(&[self.group(diagnostic)]))
            .collect();
        let unused = self.unused_lines();
        let lines = unused.iter().map(|line| {
            renderer.render(&[Group::with_title(
                Level::WARNING.primary_title(line.as_str()),
            )])
        });
        parts.extend(lines);
        if self.omitted > 0 {
            parts.push(format!("and {} more", self.omitted));
        }
        let text = parts.join("\n\n");
        // With colour, the renderer escapes the text itself and adds its own escapes.
        match colour {
            true => text,
            false => escape_hidden(&text).into_owned(),
        }
    }

    fn unused_lines(&self) -> Vec<String> {
        let kinds = [
            DeclarationKind::Parameter,
            DeclarationKind::Input,
            DeclarationKind::Definition,
        ];
        let kinds = kinds.into_iter();
        kinds.filter_map(|kind| self.unused_line(kind)).collect()
    }

    fn unused_line(&self, kind: DeclarationKind) -> Option<String> {
        let unused = self.list.iter().filter(|found| found.unused == Some(kind));
        let spans: Vec<Span> = unused
            .filter_map(|found| found.primary.as_ref().map(|label| label.span))
            .collect();
        let (ending, verb) = match spans.len() {
            0 => return None,
            1 => ("", "is"),
            _ => ("s", "are"),
        };
        let name =
            |span: &Span| self.source.text[self.clamp_to_text(*span)].trim_matches(['"', '\'']);
        let names: Vec<&str> = spans.iter().map(name).collect();
        let places = spans.iter().map(|span| self.source.place(span.start));
        let places: Vec<String> = places
            .map(|place| format!("{}:{}", place.line, place.column))
            .collect();
        Some(format!(
            "the {}{ending} `{}` {verb} not used ({}:{})",
            kind.name(),
            names.join("`, `"),
            self.source.path,
            places.join(", ")
        ))
    }

    /// Returns all findings for programs.
    pub fn records(&self) -> Vec<Record> {
        self.list.iter().map(|d| self.record(d)).collect()
    }

    fn record(&self, diagnostic: &Diagnostic) -> Record {
        let span = diagnostic.primary.as_ref().map(|label| label.span);
        let start = span.map(|span| self.source.place(span.start));
        let end = span.map(|span| self.source.place(span.end));
        Record {
            file: self.source.path.clone(),
            line: start.map(|place| place.line),
            column: start.map(|place| place.column),
            end_line: end.map(|place| place.line),
            end_column: end.map(|place| place.column),
            severity: diagnostic.severity,
            message: diagnostic.message.clone(),
            help: diagnostic.help.clone(),
        }
    }

    fn group<'a>(&'a self, diagnostic: &'a Diagnostic) -> Group<'a> {
        let level = match diagnostic.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level.primary_title(diagnostic.message.as_str());
        let group = match &diagnostic.primary {
            Some(primary) => title.element(self.snippet(primary, &diagnostic.secondary)),
            None => title.element(Origin::path(self.source.path.as_str())),
        };
        match &diagnostic.help {
            Some(help) => group.element(Level::HELP.message(help.as_str())),
            None => group,
        }
    }

    fn snippet<'a>(
        &'a self,
        primary: &'a Label,
        secondary: &'a [Label],
    ) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        let (excerpt, line) = self.excerpt(primary, secondary);
        let annotation = |kind: AnnotationKind, label: &'a Label| {
            let inside = self.clamp_to_text(label.span);
            let annotation = kind.span(inside.start - excerpt.start..inside.end - excerpt.start);
            if label.text.is_empty() {
                annotation
            } else {
                annotation.label(label.text.as_str())
            }
        };
        let others = secondary
            .iter()
            .map(|label| annotation(AnnotationKind::Context, label));
        Snippet::source(&self.source.text[excerpt.clone()])
            .line_start(line)
            .path(self.source.path.as_str())
            .annotation(annotation(AnnotationKind::Primary, primary))
            .annotations(others)
    }

    /// Returns the lines that contain all labels, and the number of the first line. Rendering time
    /// grows with the lines given.
    fn excerpt(&self, primary: &Label, others: &[Label]) -> (std::ops::Range<usize>, usize) {
        let span = |whole: Span, label: &Label| whole.join(label.span);
        let whole = self.clamp_to_text(others.iter().fold(primary.span, span));
        let text = &self.source.text;
        let start = text[..whole.start]
            .rfind('\n')
            .map_or(0, |newline| newline + 1);
        let end = text[whole.end..]
            .find('\n')
            .map_or(text.len(), |newline| whole.end + newline);
        (start..end, self.source.place(start).line)
    }

    /// Clamps a span to whole characters of the text.
    fn clamp_to_text(&self, span: Span) -> std::ops::Range<usize> {
        let text = &self.source.text;
        let start = character_start(text, span.start);
        let end = character_start(text, span.end);
        start..end.max(start)
    }
}

impl std::fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

/// Quotes user text for a message: at most 48 characters in backquotes, control characters
/// replaced by spaces.
pub fn quote(text: &str) -> String {
    let clean = |letter: char| if letter.is_control() { ' ' } else { letter };
    let mut shown: String = text.chars().take(48).map(clean).collect();
    if text.chars().nth(48).is_some() {
        shown.push_str("...");
    }
    format!("`{shown}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finding_shows_place_text_and_help() {
        let source = Source::new("arm.toml", "[a]\nb = \"k_s*x\"\n");
        let diagnostic = Diagnostic::error("unknown name `k_s`")
            .with_span(Span::new(9, 12), "not declared")
            .with_help("did you mean `k_sp`?");
        let shown = Diagnostics::from_one(source.clone(), diagnostic.clone()).render(false);
        for part in [
            "error: unknown name `k_s`",
            "arm.toml:2:6",
            "^^^ not declared",
            "k_sp",
        ] {
            assert!(shown.contains(part), "{part} is missing in\n{shown}");
        }
        let coloured = Diagnostics::from_one(source, diagnostic).render(true);
        assert!(coloured.contains('\u{1b}') && !shown.contains('\u{1b}'));
    }

    #[test]
    fn findings_without_a_place_name_the_file() {
        let source = Source::new("arm.toml", "");
        let diagnostics = Diagnostics::from_one(source, Diagnostic::error("no such file"));
        assert!(diagnostics.render(false).contains("arm.toml"));
        assert_eq!(diagnostics.records()[0].line, None);
    }

    #[test]
    fn records_hold_lines_and_columns() {
        let source = Source::new("arm.toml", "ab\ncd\n");
        let diagnostic = Diagnostic::warning("odd").with_span(Span::new(4, 5), "");
        let record = Diagnostics::from_one(source, diagnostic)
            .records()
            .remove(0);
        assert_eq!((record.line, record.column), (Some(2), Some(2)));
        assert_eq!((record.end_line, record.end_column), (Some(2), Some(3)));
        assert_eq!(record.severity, Severity::Warning);
    }

    #[test]
    fn findings_beyond_the_limit_are_counted() {
        let mut diagnostics = Diagnostics::new(Source::new("arm.toml", "a"));
        for number in 0..1000 {
            let message = format!("wrong {number}");
            diagnostics.push(Diagnostic::error(message).with_span(Span::new(0, 1), ""));
        }
        assert_eq!(diagnostics.list().len(), MAX_LISTED);
        assert!(diagnostics.render(false).ends_with("and 980 more"));
    }

    #[test]
    fn repeated_finding_is_listed_once() {
        let mut diagnostics = Diagnostics::new(Source::new("arm.toml", "a"));
        for place in [0, 1, 0] {
            diagnostics.push(Diagnostic::error("wrong").with_span(Span::new(place, 1), ""));
        }
        assert_eq!(diagnostics.list().len(), 2);
    }

    #[test]
    fn places_outside_the_text_are_shown_at_its_end() {
        let diagnostic = Diagnostic::error("odd").with_span(Span::new(900, 7), "");
        let shown = Diagnostics::from_one(Source::new("a.toml", "µ"), diagnostic).render(false);
        assert!(shown.contains("a.toml:1:2"), "{shown}");
    }
}
