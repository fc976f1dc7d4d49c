//! Paths of records, never outside the dataset's folder.

use std::path::{Component, Path, PathBuf};

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::quantity::StringValue;

use crate::description::Description;
use crate::description::records::{Records, Stretch};

pub fn find_record<'d>(description: &'d Description, record: &str) -> Result<&'d Stretch, String> {
    let records = &description.records;
    let none = || {
        format!(
            "{}: there is no record `{record}`; the file lists {} as train[..] and {} as test[..], numbered from 0",
            description.source.path,
            records.train.len(),
            records.test.len()
        )
    };
    let (list, rest) = match (record.strip_prefix("train["), record.strip_prefix("test[")) {
        (Some(rest), _) => (&records.train, rest),
        (_, Some(rest)) => (&records.test, rest),
        _ => return Err(none()),
    };
    let index = rest.strip_suffix(']').and_then(|i| i.parse().ok());
    let index: usize = index.ok_or_else(none)?;
    list.get(index).ok_or_else(none)
}

/// Returns the paths of all records of a dataset file.
pub fn list_record_files(dataset: &Path, records: &Records) -> Vec<PathBuf> {
    let records = records.train.iter().chain(&records.test);
    let paths = records.map(|stretch| resolve_record_path(dataset, &stretch.file));
    paths.filter_map(Result::ok).collect()
}

/// Returns the path of an existing record in the dataset's folder or below. Symbolic links are resolved.
pub fn resolve_record_path(dataset: &Path, file: &StringValue) -> Result<PathBuf, Diagnostic> {
    let relative = Path::new(&file.text);
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let folder = match dataset.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let place = folder.join(relative);
    let leads_out = match (place.canonicalize(), folder.canonicalize()) {
        (Ok(place), Ok(folder)) => !place.starts_with(folder),
        _ => false,
    };
    if leads_out || !relative.components().all(inside) {
        let name = &file.text;
        return Err(Diagnostic::error(format!(
            "the record \"{name}\" is outside the dataset's folder"
        ))
        .with_span(
            file.span,
            "expected a file in the folder of the dataset file or in a subfolder",
        ));
    }
    if !place.exists() {
        return Err(
            Diagnostic::error(format!("the record \"{}\" does not exist", file.text))
                .with_span(file.span, "there is no such file")
                .with_help("give its path relative to the folder of the dataset file"),
        );
    }
    Ok(dataset.parent().unwrap_or(Path::new(".")).join(relative))
}
