//! Figures of a search: number of claims that hold at once, and share of parameter sets in which each claim holds.

use eomgen_plot::bars::{Histogram, Shares, histogram, shares};
use eomgen_plot::{PlotError, Reference};

use super::claims::CLAIMS;
use super::error::StudyError;
use super::judge::{Judgement, Verdict};
use super::report::Figure;
use super::search::SearchResult;
use super::tally;

/// Draws the figures of a search, with the claims judged at the assumed values.
///
/// # Errors
/// A search without judged sets.
pub fn draw_charts(found: &SearchResult, assumed: &[Judgement]) -> Result<Vec<Figure>, StudyError> {
    let refused = |error: PlotError| StudyError::Request(error.to_string());
    Ok(vec![
        draw_claims_at_once(found, assumed).map_err(refused)?,
        draw_shares_of_claims(found).map_err(refused)?,
    ])
}

/// Draws a histogram of the parameter sets over the number of claims that hold.
fn draw_claims_at_once(found: &SearchResult, assumed: &[Judgement]) -> Result<Figure, PlotError> {
    let holds = |judgement: &&Judgement| judgement.holding == Verdict::Holds;
    let mark = |label: &str, number: usize| Reference {
        label: format!("{label}: {number}"),
        value: number as f64,
    };
    let mut marks = vec![mark("assumed values", assumed.iter().filter(holds).count())];
    if let Some(best) = found.confirmed.first() {
        marks.push(mark("best", best.holding_claims()));
    }
    marks.sort_by(|a, b| a.value.total_cmp(&b.value));
    let caption = format!(
        "How many of the {} claims hold at once, for {} parameter sets",
        CLAIMS.len(),
        found.screened.len()
    );
    let svg = histogram(&Histogram {
        title: caption.clone(),
        horizontal_label: "claims that hold".to_owned(),
        vertical_label: "parameter sets".to_owned(),
        counts: &tally::histogram(&found.screened),
        marks,
    })?;
    Ok(figure("together.svg", caption, svg))
}

/// Draws the share of parameter sets in which each claim holds.
fn draw_shares_of_claims(found: &SearchResult) -> Result<Figure, PlotError> {
    let rows = CLAIMS.iter().zip(tally::shares(&found.screened));
    let rows = rows.map(|(claim, share)| {
        let parts = vec![
            share.holds_strictly,
            share.holds - share.holds_strictly,
            share.undecided_share,
            share.fails,
        ];
        (claim.label(), parts)
    });
    let caption = format!(
        "How often each claim holds, over {} parameter sets",
        found.screened.len()
    );
    let svg = shares(&Shares {
        title: caption.clone(),
        parts: ["holds strictly", "holds", "undecided", "fails"]
            .map(str::to_owned)
            .into(),
        rows: rows.collect(),
    })?;
    Ok(figure("claims.svg", caption, svg))
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
