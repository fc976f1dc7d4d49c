//! Errors and warnings of a specification. They are rendered as text with the location underlined, or returned as
//! records for programs.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde::Serialize;

use crate::hidden_characters::escape_hidden;
use crate::source::{Source, character_start};
use crate::span::Span;

/// Largest number of listed errors and warnings. A single invalid file can have thousands.
pub const MAX_LISTED: usize = 20;

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The specification is invalid.
    Error,
    /// The specification is valid, but possibly not as intended.
    Warning,
}

/// Remark on a location in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Location.
    pub span: Span,
    /// Text of the remark; may be empty.
    pub text: String,
}

/// One error or warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Severity.
    pub severity: Severity,
    /// Cause, in one line.
    pub message: String,
    /// Location; `None` if the diagnostic concerns the whole file.
    pub primary: Option<Label>,
    /// Other locations that explain the cause.
    pub secondary: Vec<Label>,
    /// Proposed correction, if known.
    pub help: Option<String>,
    /// Kind of the declaration, if the warning is about an unused name. `render` prints all unused names of a kind in
    /// one line.
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
    /// Returns the message, with the proposed correction in parentheses.
    pub fn summary(&self) -> String {
        match &self.help {
            Some(help) => format!("{} ({help})", self.message),
            None => self.message.clone(),
        }
    }

    /// Creates an error without a location.
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

    /// Creates a warning about an unused declaration.
    pub fn unused(kind: DeclarationKind, name: &str, span: Span) -> Self {
        Self {
            unused: Some(kind),
            ..Self::warning(format!(
                "the specification does not use the {} `{name}`",
                kind.name()
            ))
        }
        .with_span(span, "nothing refers to it")
        .with_help("remove it, or use it in an expression")
    }

    /// Creates a warning without a location.
    pub fn warning(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(message)
        }
    }

    /// Sets the location.
    pub fn with_span(mut self, span: Span, label: impl Into<String>) -> Self {
        self.primary = Some(Label {
            span,
            text: label.into(),
        });
        self
    }

    /// Adds a related location.
    pub fn with_related_span(mut self, span: Span, label: impl Into<String>) -> Self {
        self.secondary.push(Label {
            span,
            text: label.into(),
        });
        self
    }

    /// Sets the proposed correction.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Sets the proposed correction, if there is one.
    pub fn with_optional_help(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }
}

/// Errors and warnings of one source.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    source: Source,
    list: Vec<Diagnostic>,
    omitted: usize,
}

/// Diagnostic as a record for programs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Record {
    /// Path of the file.
    pub file: String,
    /// Line, from 1, if there is a location.
    pub line: Option<usize>,
    /// Column in characters, from 1, if there is a location.
    pub column: Option<usize>,
    /// Line of the first character after the location.
    pub end_line: Option<usize>,
    /// Column of the first character after the location.
    pub end_column: Option<usize>,
    /// Severity.
    pub severity: Severity,
    /// Cause.
    pub message: String,
    /// Proposed correction, if known.
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

    /// Returns a list with one diagnostic.
    pub fn from_one(source: Source, diagnostic: Diagnostic) -> Self {
        let mut diagnostics = Self::new(source);
        diagnostics.push(diagnostic);
        diagnostics
    }

    /// Adds a diagnostic. Beyond [`MAX_LISTED`] it is only counted.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.is_full() {
            self.omitted += 1;
        // An error in a vector occurs once for each component.
        } else if !self.list.contains(&diagnostic) {
            self.list.push(diagnostic);
        }
    }

    /// Adds a diagnostic that is expensive to build. Beyond [`MAX_LISTED`] it is counted but not built.
    pub fn push_with(&mut self, make: impl FnOnce() -> Diagnostic) {
        if self.is_full() {
            self.omitted += 1;
        } else {
            self.list.push(make());
        }
    }

    /// Returns the value of a result, or adds its error.
    pub fn push_error<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.push(diagnostic)).ok()
    }

    /// Returns true if further diagnostics are only counted.
    pub fn is_full(&self) -> bool {
        self.list.len() >= MAX_LISTED
    }

    /// Returns true if there are no diagnostics.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the diagnostics, in the order in which they were added.
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Returns the number of diagnostics that were only counted.
    pub fn omitted_count(&self) -> usize {
        self.omitted
    }

    /// Returns the source of the diagnostics.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Renders all diagnostics as text: file, line and column, underlined text, cause and proposed correction. The
    /// unused names of a kind share one line. `colour` adds terminal escapes.
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
        // If colour is used, the renderer escapes the text and adds terminal escapes.
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
        let ending = match spans.len() {
            0 => return None,
            1 => "",
            _ => "s",
        };
        let name = |span: &Span| {
            self.source.text[clamp(&self.source.text, *span)].trim_matches(['"', '\''])
        };
        let names: Vec<&str> = spans.iter().map(name).collect();
        Some(format!(
            "the specification does not use the {}{ending} `{}` ({})",
            kind.name(),
            names.join("`, `"),
            self.places(&spans)
        ))
    }

    /// Returns the lines and columns of spans. Consecutive spans in one file name the file once.
    fn places(&self, spans: &[Span]) -> String {
        let mut text = String::new();
        let mut named = None;
        for span in spans {
            let (file, inside) = self.source.locate(*span);
            let place = file.place(inside.start);
            text.push_str(if text.is_empty() { "" } else { ", " });
            if named != Some(&file.path) {
                text.push_str(&format!("{}:", file.path));
                named = Some(&file.path);
            }
            text.push_str(&format!("{}:{}", place.line, place.column));
        }
        text
    }

    /// Returns all diagnostics as records for programs.
    pub fn records(&self) -> Vec<Record> {
        self.list.iter().map(|d| self.record(d)).collect()
    }

    fn record(&self, diagnostic: &Diagnostic) -> Record {
        let span = diagnostic.primary.as_ref().map(|label| label.span);
        let located = span.map(|span| self.source.locate(span));
        let start = located.map(|(file, span)| file.place(span.start));
        let end = located.map(|(file, span)| file.place(span.end));
        Record {
            file: located.map_or(&self.source, |(file, _)| file).path.clone(),
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
            Some(primary) => self
                .snippets(primary, &diagnostic.secondary)
                .fold(Group::with_title(title), |group, snippet| {
                    group.element(snippet)
                }),
            None => title.element(Origin::path(self.source.path.as_str())),
        };
        match &diagnostic.help {
            Some(help) => group.element(Level::HELP.message(help.as_str())),
            None => group,
        }
    }

    /// Returns one snippet with all labels in the file of the primary label, and one snippet for each label in
    /// another file.
    fn snippets<'a>(
        &'a self,
        primary: &'a Label,
        secondary: &'a [Label],
    ) -> impl Iterator<Item = Snippet<'a, annotate_snippets::Annotation<'a>>> {
        let mark = |kind: AnnotationKind| {
            move |label: &'a Label| {
                let (file, span) = self.source.locate(label.span);
                let text = label.text.as_str();
                Mark {
                    kind,
                    file,
                    span,
                    text,
                }
            }
        };
        let first = mark(AnnotationKind::Primary)(primary);
        let others = secondary.iter().map(mark(AnnotationKind::Context));
        let (here, elsewhere): (Vec<_>, Vec<_>) =
            others.partition(|mark| std::ptr::eq(mark.file, first.file));
        let here = std::iter::once(first).chain(here).collect();
        std::iter::once(here)
            .chain(elsewhere.into_iter().map(|mark| vec![mark]))
            .map(snippet)
    }
}

/// Label at its position in a file.
struct Mark<'a> {
    kind: AnnotationKind,
    file: &'a Source,
    span: Span,
    text: &'a str,
}

/// Returns a snippet of the lines that contain all marks. The marks are in one file.
fn snippet(marks: Vec<Mark<'_>>) -> Snippet<'_, annotate_snippets::Annotation<'_>> {
    let file = marks[0].file;
    let whole = marks
        .iter()
        .skip(1)
        .fold(marks[0].span, |whole, mark| whole.join(mark.span));
    let (excerpt, line) = excerpt(file, whole);
    let annotations = marks.into_iter().map(|mark| {
        let inside = clamp(&file.text, mark.span);
        let span = inside.start - excerpt.start..inside.end - excerpt.start;
        let annotation = mark.kind.span(span);
        match mark.text {
            "" => annotation,
            text => annotation.label(text),
        }
    });
    Snippet::source(&file.text[excerpt.clone()])
        .line_start(line)
        .path(file.path.as_str())
        .annotations(annotations)
}

/// Returns the lines that contain a span, and the number of the first line. Only these lines are passed to the
/// renderer, because its time grows with their number.
fn excerpt(file: &Source, span: Span) -> (std::ops::Range<usize>, usize) {
    let text = &file.text;
    let whole = clamp(text, span);
    let start = text[..whole.start]
        .rfind('\n')
        .map_or(0, |newline| newline + 1);
    let end = text[whole.end..]
        .find('\n')
        .map_or(text.len(), |newline| whole.end + newline);
    (start..end, file.place(start).line)
}

/// Clamps a span to whole characters of a text.
fn clamp(text: &str, span: Span) -> std::ops::Range<usize> {
    let start = character_start(text, span.start);
    let end = character_start(text, span.end);
    start..end.max(start)
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
    fn error_shows_location_text_and_help() {
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
    fn errors_without_a_location_name_the_file() {
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
    fn diagnostics_beyond_the_limit_are_counted() {
        let mut diagnostics = Diagnostics::new(Source::new("arm.toml", "a"));
        for number in 0..1000 {
            let message = format!("wrong {number}");
            diagnostics.push(Diagnostic::error(message).with_span(Span::new(0, 1), ""));
        }
        assert_eq!(diagnostics.list().len(), MAX_LISTED);
        assert!(diagnostics.render(false).ends_with("and 980 more"));
    }

    #[test]
    fn repeated_error_is_listed_once() {
        let mut diagnostics = Diagnostics::new(Source::new("arm.toml", "a"));
        for place in [0, 1, 0] {
            diagnostics.push(Diagnostic::error("wrong").with_span(Span::new(place, 1), ""));
        }
        assert_eq!(diagnostics.list().len(), 2);
    }

    #[test]
    fn locations_outside_the_text_are_shown_at_its_end() {
        let diagnostic = Diagnostic::error("odd").with_span(Span::new(900, 7), "");
        let shown = Diagnostics::from_one(Source::new("a.toml", "µ"), diagnostic).render(false);
        assert!(shown.contains("a.toml:1:2"), "{shown}");
    }
}
