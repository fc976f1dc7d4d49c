//! Figures of a search: number of claims that hold at once, and share of parameter sets in which each claim holds. They
//! show the numbers of the search's JSON document.

use eomgen_plot::bars::{Histogram, Shares, histogram, shares};
use eomgen_plot::{PlotError, Reference};
use serde_json::Value;

use super::claims::CLAIMS;
use super::error::StudyError;
use super::judge::Verdict;
use super::report::Figure;

/// Draws the figures of a search from its [document](super::search_report::document).
///
/// # Errors
/// A document without judged sets, or without a number of the figures.
pub fn draw_charts(document: &Value) -> Result<Vec<Figure>, StudyError> {
    Ok(vec![
        draw_claims_at_once(document)?,
        draw_shares_of_claims(document)?,
    ])
}

fn plot_error(error: PlotError) -> StudyError {
    StudyError::Request(error.to_string())
}

/// Returns a number of the document.
fn number(document: &Value, pointer: &str) -> Result<f64, StudyError> {
    let found = document.pointer(pointer).and_then(Value::as_f64);
    found.ok_or_else(|| StudyError::Request(format!("the search has no number {pointer}")))
}

/// Returns a count of the document.
fn count(document: &Value, pointer: &str) -> Result<usize, StudyError> {
    Ok(number(document, pointer)? as usize)
}

/// Draws a histogram of the parameter sets over the number of claims that hold.
fn draw_claims_at_once(document: &Value) -> Result<Figure, StudyError> {
    let mark = |label: &str, number: usize| Reference {
        label: format!("{label}: {number}"),
        value: number as f64,
    };
    let letter = Verdict::Holds.letter().to_string();
    let holds = |index: &usize| {
        let verdict = document.pointer(&format!("/claims/{index}/assumed/verdict"));
        verdict.and_then(Value::as_str) == Some(&letter)
    };
    let mut marks = vec![mark(
        "assumed values",
        (0..CLAIMS.len()).filter(holds).count(),
    )];
    if document.pointer("/confirmed/0").is_some() {
        marks.push(mark("best", count(document, "/confirmed/0/holding")?));
    }
    marks.sort_by(|a, b| a.value.total_cmp(&b.value));
    let caption = format!(
        "How many of the {} claims hold at once, for {} parameter sets",
        CLAIMS.len(),
        count(document, "/sets")?
    );
    let counts = (0..=CLAIMS.len()).map(|index| count(document, &format!("/histogram/{index}")));
    let svg = histogram(&Histogram {
        title: caption.clone(),
        horizontal_label: "claims that hold".to_owned(),
        vertical_label: "parameter sets".to_owned(),
        counts: &counts.collect::<Result<Vec<usize>, StudyError>>()?,
        marks,
    });
    Ok(figure("together.svg", caption, svg.map_err(plot_error)?))
}

/// Draws the share of parameter sets in which each claim holds.
fn draw_shares_of_claims(document: &Value) -> Result<Figure, StudyError> {
    let rows = CLAIMS.iter().enumerate().map(|(index, claim)| {
        let share = |name: &str| number(document, &format!("/claims/{index}/screened/{name}"));
        let strictly = share("holds_strictly")?;
        let parts = vec![
            strictly,
            share("holds")? - strictly,
            share("undecided")?,
            share("fails")?,
        ];
        Ok((claim.label(), parts))
    });
    let caption = format!(
        "How often each claim holds, over {} parameter sets",
        count(document, "/sets")?
    );
    let svg = shares(&Shares {
        title: caption.clone(),
        parts: ["holds strictly", "holds", "undecided", "fails"]
            .map(str::to_owned)
            .into(),
        rows: rows.collect::<Result<_, StudyError>>()?,
    });
    Ok(figure("claims.svg", caption, svg.map_err(plot_error)?))
}

fn figure(file: &str, caption: String, svg: String) -> Figure {
    Figure {
        file: file.to_owned(),
        paper: String::new(),
        caption,
        cases: Vec::new(),
        svg,
    }
}
