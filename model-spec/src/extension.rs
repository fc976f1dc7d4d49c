//! Specifications that extend others: the key `extends` of `[model]`. All files are merged to one text with one line
//! per entry. The source records the file and position of every part.

use std::path::{Component, Path, PathBuf};

use toml_edit::{Document, Item, TableLike, Value};

use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::source::{CopiedPart, Source};
use crate::span::Span;
use crate::specification_file::read_text;
use crate::suggest::did_you_mean;
use crate::table::{Entry, entries};
use crate::toml_file::grammar_error;

/// Largest number of files in a chain of extensions.
const MAX_FILES: usize = 16;

/// Piece of the merged text.
#[derive(Clone)]
enum Piece {
    /// Bytes of a file, by its index.
    CopiedPart(usize, Span),
    /// Text that replaces bytes of a file.
    Rewritten(usize, Span, String),
    /// Punctuation between pieces.
    Glue(&'static str),
}

/// Section, or a value at the top level.
struct Section {
    name: String,
    heading: Piece,
    content: Content,
}

enum Content {
    Entries(Vec<NamedEntry>),
    /// Value that is not a table: `false`, or an error that the reader reports.
    Value(EntryValue),
}

struct NamedEntry {
    name: String,
    key: Piece,
    value: EntryValue,
}

struct EntryValue {
    pieces: Vec<Piece>,
    /// Position of `false`.
    removal: Option<Span>,
}

/// Merges a source with all files that it extends. A source without the key `extends` is returned unchanged.
///
/// # Errors
/// The source has no file, a file cannot be read or is not TOML, the chain of extensions is too long or cyclic, or a
/// removed entry does not exist.
pub fn merge(source: Source) -> Result<Source, Diagnostics> {
    if !source.text.contains("extends") {
        return Ok(source);
    }
    let Ok(document) = Document::parse(&*source.text) else {
        // The reader reports syntax errors.
        return Ok(source);
    };
    let Some(extends) = extends_entry(&document, &source.text) else {
        return Ok(source);
    };
    let Some(folder) = source.folder.clone() else {
        let message =
            "`extends` needs a file: this specification was given as text, without a folder";
        let found = Diagnostic::error(message)
            .with_span(extends.name.span, "its file cannot be found")
            .with_help(
                "give the specification as a file, or copy the entries of the other file into the text",
            );
        return Err(Diagnostics::from_one(source.clone(), found));
    };
    let mut chain = Chain::default();
    let file_name = Path::new(&source.path).file_name().unwrap_or_default();
    chain.paths.extend(folder.join(file_name).canonicalize());
    let sections = chain.sections(source.clone(), &document, Path::new(""))?;
    Ok(chain.write(&source, sections))
}

fn extends_entry<'d>(document: &'d Document<&str>, text: &'d str) -> Option<Entry<'d>> {
    let top = entries(document.as_table(), text);
    let model = top.into_iter().find(|entry| entry.name.text == "model")?;
    let mut keys = model.table("{ }").ok()?.into_iter();
    keys.find(|entry| entry.name.text == "extends")
}

/// Files read so far; the first file is the specification that extends the others.
#[derive(Default)]
struct Chain {
    files: Vec<Source>,
    /// Resolved paths, for the detection of cycles.
    paths: Vec<PathBuf>,
}

impl Chain {
    /// Returns the sections of a file, merged with the sections of the files that it extends. `folder` is the folder
    /// of the file, relative to the first file.
    fn sections(
        &mut self,
        source: Source,
        document: &Document<&str>,
        folder: &Path,
    ) -> Result<Vec<Section>, Diagnostics> {
        let file = self.files.len();
        self.files.push(source.clone());
        let wrong = |diagnostic| Diagnostics::from_one(source.clone(), diagnostic);
        let own = FileReader { file, folder }.sections(document);
        let Some(extends) = extends_entry(document, &source.text) else {
            return Ok(own);
        };
        let written = extends.written().map_err(wrong)?;
        let base = self
            .read_base(&source, &written.text)
            .map_err(|found| wrong(found.with_span(written.span, "this file")))?;
        let text = base.text.clone();
        let parsed = Document::parse(&*text)
            .map_err(|error| Diagnostics::from_one(base.clone(), grammar_error(&text, &error)))?;
        let parent = Path::new(&written.text).parent().unwrap_or(Path::new(""));
        let mut sections = self.sections(base, &parsed, &folder.join(parent))?;
        overlay(&mut sections, own, &written.text).map_err(wrong)?;
        Ok(sections)
    }

    /// Reads the file with this path, relative to the folder of `source`.
    fn read_base(&mut self, source: &Source, written: &str) -> Result<Source, Diagnostic> {
        let help = "give the path of a specification, relative to this file";
        let relative = Path::new(written);
        if written.is_empty() || !relative.components().all(is_relative) {
            let message = format!("`extends` needs a relative path, not \"{written}\"");
            return Err(Diagnostic::error(message).with_help(help));
        }
        if self.files.len() == MAX_FILES {
            let message = format!("more than {MAX_FILES} files extend each other");
            return Err(Diagnostic::error(message).with_help("merge some of these files"));
        }
        let folder = source.folder.as_deref().unwrap_or(Path::new(""));
        let path = folder.join(relative);
        let resolved = path.canonicalize().map_err(|error| {
            Diagnostic::error(format!("the file \"{written}\" cannot be read: {error}"))
                .with_help(help)
        })?;
        if self.paths.contains(&resolved) {
            let message = match self.paths.last() == Some(&resolved) {
                true => format!("\"{written}\" extends itself"),
                false => format!("\"{written}\" extends this file, directly or through others"),
            };
            let cure = "remove `extends` from one of the files";
            return Err(Diagnostic::error(message).with_help(cure));
        }
        self.paths.push(resolved);
        let beside = Path::new(&source.path).parent().unwrap_or(Path::new(""));
        let shown = beside.join(relative).display().to_string();
        let text = read_text(&path, &shown).map_err(|found| {
            let cause = found.list().first().map(|first| first.message.clone());
            let cause = cause.unwrap_or_default();
            Diagnostic::error(format!("\"{written}\" cannot be extended: {cause}")).with_help(help)
        })?;
        Ok(Source::new(shown, text).in_folder(path.parent().unwrap_or(Path::new(""))))
    }

    /// Writes the merged text.
    fn write(self, source: &Source, sections: Vec<Section>) -> Source {
        let mut writer = Writer::default();
        let is_value = |section: &Section| matches!(section.content, Content::Value(_));
        let (values, tables): (Vec<_>, Vec<_>) = sections.into_iter().partition(is_value);
        for section in values.into_iter().chain(tables) {
            match section.content {
                Content::Value(value) => {
                    writer.assignment(&self.files, &section.heading, &value);
                }
                Content::Entries(list) => {
                    writer.piece(&self.files, &Piece::Glue("["));
                    writer.piece(&self.files, &section.heading);
                    writer.piece(&self.files, &Piece::Glue("]\n"));
                    for entry in &list {
                        writer.assignment(&self.files, &entry.key, &entry.value);
                    }
                    writer.piece(&self.files, &Piece::Glue("\n"));
                }
            }
        }
        source.merged(writer.text, self.files, writer.parts)
    }
}

fn is_relative(part: Component<'_>) -> bool {
    matches!(
        part,
        Component::Normal(_) | Component::CurDir | Component::ParentDir
    )
}

/// Replaces, adds and removes entries of `base`, the sections of the file named `base_name`.
fn overlay(base: &mut Vec<Section>, own: Vec<Section>, base_name: &str) -> Result<(), Diagnostic> {
    for section in own {
        let present = base.iter().position(|known| known.name == section.name);
        let list = match section.content {
            Content::Value(EntryValue {
                removal: Some(span),
                ..
            }) => {
                let names = || base.iter().map(|known| known.name.as_str());
                let removed = present.ok_or_else(|| {
                    nothing_to_remove(&section.name, base_name, span, names().collect())
                })?;
                base.remove(removed);
                continue;
            }
            Content::Value(_) => {
                base.push(section);
                continue;
            }
            Content::Entries(list) => list,
        };
        let mut old = match present.map(|index| base.remove(index)) {
            Some(Section {
                content: Content::Entries(old),
                ..
            }) => old,
            _ => Vec::new(),
        };
        let place = format!("[{}] of {base_name}", section.name);
        for entry in list {
            let known = old.iter().position(|known| known.name == entry.name);
            match (entry.value.removal, known) {
                (Some(_), Some(index)) => drop(old.remove(index)),
                (Some(span), None) => {
                    let names = old.iter().map(|known| known.name.as_str()).collect();
                    return Err(nothing_to_remove(&entry.name, &place, span, names));
                }
                (None, Some(index)) => old[index] = entry,
                (None, None) => old.push(entry),
            }
        }
        base.insert(
            present.unwrap_or(base.len()),
            Section {
                content: Content::Entries(old),
                ..section
            },
        );
    }
    Ok(())
}

fn nothing_to_remove(name: &str, place: &str, span: Span, known: Vec<&str>) -> Diagnostic {
    let help = did_you_mean(name, known.iter().copied())
        .unwrap_or_else(|| format!("remove this line; {place} has {}", known.join(", ")));
    Diagnostic::error(format!("{} is not in {place}", quote(name)))
        .with_span(span, "nothing to remove")
        .with_help(help)
}

/// Reads the sections of one file.
struct FileReader<'p> {
    file: usize,
    folder: &'p Path,
}

impl FileReader<'_> {
    fn sections(&self, document: &Document<&str>) -> Vec<Section> {
        let table = document.as_table();
        let section = |(name, item): (&str, &Item)| Section {
            name: name.to_owned(),
            heading: self.key(table, name),
            content: match item.as_table_like() {
                Some(table) => Content::Entries(self.entries(name, table)),
                None => Content::Value(self.value(item, "")),
            },
        };
        table.iter().map(section).collect()
    }

    fn entries(&self, section: &str, table: &dyn TableLike) -> Vec<NamedEntry> {
        let is_kept = |name: &str| section != "model" || name != "extends";
        let named = |(name, item): (&str, &Item)| NamedEntry {
            name: name.to_owned(),
            key: self.key(table, name),
            value: self.value(item, section),
        };
        let list = table.iter().filter(|(name, _)| is_kept(name));
        list.map(named).collect()
    }

    fn key(&self, table: &dyn TableLike, name: &str) -> Piece {
        let span = table.key(name).and_then(|key| key.span());
        let span = span.map_or_else(Span::default, |range| Span::new(range.start, range.end));
        Piece::CopiedPart(self.file, span)
    }

    fn value(&self, item: &Item, section: &str) -> EntryValue {
        let is_removal = item.as_bool() == Some(false);
        let span = item.span().map(|range| Span::new(range.start, range.end));
        EntryValue {
            pieces: self.pieces(item, section),
            removal: is_removal.then(|| span.unwrap_or_default()),
        }
    }

    fn pieces(&self, item: &Item, section: &str) -> Vec<Piece> {
        // The path of a table of mode shapes is rewritten, relative to the first file.
        let has_table = section == "fields" && self.folder != Path::new("");
        match item {
            Item::Value(Value::InlineTable(table)) if has_table => self.table(table, section),
            Item::Value(value) => match value.span() {
                Some(range) => vec![Piece::CopiedPart(
                    self.file,
                    Span::new(range.start, range.end),
                )],
                None => vec![Piece::Rewritten(
                    self.file,
                    Span::default(),
                    value.to_string(),
                )],
            },
            Item::Table(table) => self.table(table, section),
            Item::ArrayOfTables(tables) => {
                let mut pieces = vec![Piece::Glue("[")];
                for table in tables {
                    pieces.extend(self.table(table, section));
                    pieces.push(Piece::Glue(", "));
                }
                pieces.push(Piece::Glue("]"));
                pieces
            }
            Item::None => Vec::new(),
        }
    }

    fn table(&self, table: &dyn TableLike, section: &str) -> Vec<Piece> {
        let mut pieces = vec![Piece::Glue("{ ")];
        for (index, (name, item)) in table.iter().enumerate() {
            if index > 0 {
                pieces.push(Piece::Glue(", "));
            }
            pieces.extend([self.key(table, name), Piece::Glue(" = ")]);
            match (section, name, item.as_str(), item.span()) {
                ("fields", "table", Some(path), Some(range)) => {
                    let moved = self.folder.join(path).display().to_string();
                    pieces.push(Piece::Rewritten(
                        self.file,
                        Span::new(range.start, range.end),
                        Value::from(moved).to_string(),
                    ));
                }
                _ => pieces.extend(self.pieces(item, "")),
            }
        }
        pieces.push(Piece::Glue(" }"));
        pieces
    }
}

#[derive(Default)]
struct Writer {
    text: String,
    parts: Vec<CopiedPart>,
}

impl Writer {
    fn assignment(&mut self, files: &[Source], key: &Piece, value: &EntryValue) {
        self.piece(files, key);
        self.piece(files, &Piece::Glue(" = "));
        for piece in &value.pieces {
            self.piece(files, piece);
        }
        self.piece(files, &Piece::Glue("\n"));
    }

    fn piece(&mut self, files: &[Source], piece: &Piece) {
        let start = self.text.len();
        let (file, from) = match piece {
            Piece::Glue(text) => return self.text.push_str(text),
            Piece::CopiedPart(file, span) => {
                let text = files[*file].text.get(span.start..span.end);
                self.text.push_str(text.unwrap_or_default());
                (*file, *span)
            }
            Piece::Rewritten(file, span, text) => {
                self.text.push_str(text);
                (*file, *span)
            }
        };
        let place = Span::new(start, self.text.len());
        self.parts.push(CopiedPart { place, file, from });
    }
}
