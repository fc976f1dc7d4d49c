//! `eomgen paper study`: the paper's numerical studies, each a folder of data and figures, described in `study.json`.

use std::path::Path;
use std::sync::Mutex;

use eomgen_paper::studies::{StudyError, order, report, responses};
use serde_json::Value;

use crate::arguments::{Study, StudyName};
use crate::error::{Error, Result, print_bytes, print_text};
use crate::output::{file_place, write_file};
use crate::progress::Bar;
use crate::table::Table;

pub fn run(options: &Study) -> Result {
    let document_path = options.out.join("study.json");
    file_place(&document_path)?;
    let (name, make): (_, fn(responses::Progress<'_>) -> _) = match options.name {
        StudyName::Order => ("order", order::order),
        StudyName::Backlash => ("backlash", responses::backlash),
        StudyName::Frequency => ("frequency", responses::frequency),
        StudyName::Flexibility => ("flexibility", responses::flexibility),
    };
    let bar = Mutex::new(Bar::new("simulating and measuring", 100.0, "%"));
    let found = make(&|share| {
        // If the lock is poisoned, only the progress bar stops.
        if let Ok(bar) = bar.lock() {
            bar.set(100.0 * share);
        }
    });
    drop(bar);
    let (study, arm) = found.map_err(|error: StudyError| Error::input(error.to_string()))?;
    let document = study.document(name, arm.model());
    write(&study, &options.out)?;
    // `study.json` is written last, so a folder that contains it is complete.
    let text = format!("{document:#}\n");
    write_file(&document_path, text.as_bytes())?;
    match options.output.json {
        true => print_bytes(text.as_bytes()),
        false => print_text(&summary(&study, &options.out)),
    }
}

fn write(study: &report::Study, out: &Path) -> Result {
    for table in &study.tables {
        let path = out.join(&table.file);
        write_file(&path, &Table::from_columns(&table.columns).encode(&path)?)?;
    }
    for figure in &study.figures {
        write_file(&out.join(&figure.file), figure.svg.as_bytes())?;
    }
    Ok(())
}

/// Returns one line for each case, then the names of the files.
fn summary(study: &report::Study, out: &Path) -> String {
    let text = |case: &Value, name: &str| case[name].as_str().unwrap_or_default().to_owned();
    let mut lines: Vec<String> = study
        .cases
        .iter()
        .map(|case| format!("{}  {}", text(case, "case"), text(case, "verdict")))
        .collect();
    let figures = study.figures.iter().map(|figure| figure.file.as_str());
    let figures: Vec<&str> = figures.collect();
    lines.push(format!(
        "{}: {}, {} tables and study.json\n",
        out.display(),
        figures.join(", "),
        study.tables.len()
    ));
    lines.join("\n")
}
