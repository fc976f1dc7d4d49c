//! `eomgen paper claims`: the paper's claims at the assumed values and over plausible ranges of undisclosed parameters.

use eomgen_paper::studies::StudyError;
use eomgen_paper::studies::arm::{Arm, ArmShapes, UndisclosedParameters};
use eomgen_paper::studies::case::RunLength;
use eomgen_paper::studies::charts::draw_charts;
use eomgen_paper::studies::claims_table::format_markdown;
use eomgen_paper::studies::search::{SearchRequest, judge_all, orders, search};
use eomgen_paper::studies::search_report;
use eomgen_paper::studies::tally::shares;

use crate::arguments::{Claims, ModeShapes};
use crate::error::{Error, Result, print_json, print_text};
use crate::output::{file_place, write_file};
use crate::progress::Bar;

/// Maximum number of best parameter sets that are evaluated again with longer runs.
const CONFIRMED: usize = 60;

/// Maximum number of additional parameter sets near the best ones.
const NEIGHBOURS: usize = 32;

/// Maximum number of parameter sets; such a search takes months.
const MAX_SETS: usize = 1_000_000;

pub fn run(options: &Claims) -> Result {
    let (out, sets) = (options.out.as_path(), options.sets);
    let (document, table) = (out.join("search.json"), out.join("search.csv"));
    file_place(&document)?;
    file_place(&table)?;
    if !(1..=MAX_SETS).contains(&sets) {
        return Err(Error::input(format!(
            "--sets {sets}: expected 1 to {MAX_SETS} parameter sets"
        )));
    }
    let shapes = match options.mode_shapes {
        ModeShapes::Corrected => ArmShapes::Corrected,
        ModeShapes::Printed => ArmShapes::Printed,
    };
    let arm = Arm::with_shapes(shapes, &orders()).map_err(input_error)?;
    let request = SearchRequest {
        sets,
        seed: options.seed,
        confirmed: CONFIRMED.min(sets),
        neighbours: NEIGHBOURS.min(sets),
        screening: RunLength::SCREENING,
        confirming: RunLength::CONFIRMING,
    };
    let bar = Bar::new(
        "judging",
        (sets + request.confirmed + request.neighbours) as f64,
        "sets",
    );
    let found = search(&arm, &request, &out.join("parts"), &mut |done| {
        bar.set(done as f64);
    })
    .map_err(input_error)?;
    drop(bar);
    let (_, assumed) = judge_all(&arm, UndisclosedParameters::ASSUMED, &RunLength::FULL);
    write_file(&table, search_report::csv(&found).as_bytes())?;
    let claims = format_markdown(&assumed, &shares(&found.screened));
    write_file(&out.join("claims.md"), claims.as_bytes())?;
    let report = search_report::document(&request, &assumed, &found);
    for figure in draw_charts(&report).map_err(input_error)? {
        write_file(&out.join(&figure.file), figure.svg.as_bytes())?;
    }
    write_file(&document, format!("{report:#}\n").as_bytes())?;
    if options.output.json {
        return print_json(&report);
    }
    print_text(&format!(
        "{}{}\n",
        search_report::summary(&assumed, &found),
        document.display()
    ))
}

fn input_error(error: StudyError) -> Error {
    Error::input(error.to_string())
}
