//! `eomgen study-search`: the paper's claims at the assumed values and over plausible ranges
//! of what the paper does not disclose.

use std::path::Path;

use eomgen_paper::studies::StudyError;
use eomgen_paper::studies::arm::{Arm, Shapes, Undisclosed};
use eomgen_paper::studies::case::Length;
use eomgen_paper::studies::charts::charts;
use eomgen_paper::studies::claims::CLAIMS;
use eomgen_paper::studies::judge::Judgement;
use eomgen_paper::studies::search::{Found, Judged, Request, judge_all, orders, ranked, search};
use eomgen_paper::studies::sets::RANGES;
use eomgen_paper::studies::tally::{exclusive, histogram, share_with, shares, undecided};
use serde_json::{Value, json};

use crate::arguments::{ModeShapes, StudySearch};
use crate::claims_table::markdown;
use crate::output::{file_place, write_file};
use crate::problem::{Outcome, Problem, say};
use crate::progress::Bar;

/// How many of the best sets are judged again with longer runs, and how many sets around the
/// best of these; no more than there are sets.
const CONFIRMED: usize = 60;
const NEIGHBOURS: usize = 32;

/// A search of more sets would take months.
const MOST_SETS: usize = 1_000_000;

/// How many sets `search.json` names.
const NAMED: usize = 20;

/// Runs the command.
pub fn run(options: &StudySearch) -> Outcome {
    let (out, sets) = (options.out.as_path(), options.sets);
    let (document, table) = (out.join("search.json"), out.join("search.csv"));
    file_place(&document)?;
    file_place(&table)?;
    if !(1..=MOST_SETS).contains(&sets) {
        return Err(Problem::input(format!(
            "--sets {sets}: expected 1 to {MOST_SETS} parameter sets"
        )));
    }
    let shapes = match options.mode_shapes {
        ModeShapes::Corrected => Shapes::Corrected,
        ModeShapes::Printed => Shapes::Printed,
    };
    let arm = Arm::with(shapes, &orders()).map_err(refused)?;
    let request = Request {
        sets,
        seed: options.seed,
        confirmed: CONFIRMED.min(sets),
        neighbours: NEIGHBOURS.min(sets),
        screening: Length::SCREENING,
        confirming: Length::CONFIRMING,
    };
    let bar = Bar::new(
        "judging",
        (sets + request.confirmed + request.neighbours) as f64,
        "sets",
    );
    let found = search(&arm, &request, &out.join("parts"), &mut |done| {
        bar.set(done as f64);
    })
    .map_err(refused)?;
    drop(bar);
    let (_, assumed) = judge_all(&arm, Undisclosed::ASSUMED, &Length::FULL);
    write_file(&table, csv(&found).as_bytes())?;
    let claims = markdown(&assumed, &shares(&found.screened));
    write_file(&out.join("claims.md"), claims.as_bytes())?;
    for figure in charts(&found, &assumed).map_err(refused)? {
        write_file(&out.join(&figure.file), figure.svg.as_bytes())?;
    }
    let report = report(&request, &assumed, &found);
    write_file(&document, format!("{report:#}\n").as_bytes())?;
    if options.json {
        return say(&format!("{report:#}\n"));
    }
    say(&summary(&assumed, &found, out))
}

fn refused(error: StudyError) -> Problem {
    Problem::input(error.to_string())
}

/// Every judged set, one column per claim: H holds, F fails, U undecided.
fn csv(found: &Found) -> String {
    let mut text = "stage,set,I,a_m,b_m,F_w,c,holding,strictly_holding".to_owned();
    for claim in &CLAIMS {
        text.push(',');
        text.push_str(claim.id);
    }
    for claim in &CLAIMS {
        text.push_str(",strict_");
        text.push_str(claim.id);
    }
    text.push('\n');
    let stages = [
        ("screened", &found.screened),
        ("confirmed", &found.confirmed),
        ("neighbours", &found.neighbours),
    ];
    for (stage, sets) in stages {
        for set in sets {
            let u = set.undisclosed;
            text.push_str(&format!(
                "{stage},{},{:?},{:?},{:?},{:?},{:?},{},{}",
                set.index,
                u.second_moment,
                u.a_m,
                u.b_m,
                u.f_w,
                u.c,
                set.holding(),
                set.strictly_holding()
            ));
            for letter in set.verdicts.iter().chain(&set.strict) {
                text.push(',');
                text.push(*letter);
            }
            text.push('\n');
        }
    }
    text
}

fn report(request: &Request, assumed: &[Judgement], found: &Found) -> Value {
    let best = found.confirmed.first();
    let most = best.map_or(0, Judged::holding);
    let claims: Vec<Value> = CLAIMS
        .iter()
        .zip(assumed)
        .zip(shares(&found.screened))
        .map(|((claim, judged), share)| {
            json!({
                "id": claim.id, "place": claim.place, "says": claim.says,
                "rule": format!("{:?}", claim.rule),
                "assumed": {
                    "verdict": judged.holding.letter().to_string(),
                    "strict": judged.strict.letter().to_string(),
                    "evidence": judged.evidence,
                },
                "screened": {
                    "holds": share.holds, "fails": share.fails, "undecided": share.undecided,
                    "holds_strictly": share.holds_strictly,
                },
            })
        })
        .collect();
    let ranges = RANGES.iter().map(|range| {
        json!({
            "name": range.name, "unit": range.unit, "from": range.bounds.0,
            "to": range.bounds.1, "reason": range.reason,
        })
    });
    let pairs = exclusive(&found.screened);
    json!({
        "schema": "eomgen-search-1",
        "sets": request.sets,
        "seed": request.seed,
        "ranges": ranges.collect::<Vec<_>>(),
        "claims": claims,
        "histogram": histogram(&found.screened),
        "undecided": undecided(&found.screened),
        "best_screened": ranked(&found.screened).into_iter().take(NAMED).map(named).collect::<Vec<_>>(),
        "confirmed": found.confirmed.iter().take(NAMED).map(named).collect::<Vec<_>>(),
        "neighbourhood": {
            "sets": found.neighbours.len(),
            "within": 0.1,
            "keep_all": share_with(&found.neighbours, most),
            "lose_at_most_one": share_with(&found.neighbours, most.saturating_sub(1)),
            "lose_at_most_two": share_with(&found.neighbours, most.saturating_sub(2)),
        },
        "never_together": pairs.iter()
            .map(|(one, other)| [CLAIMS[*one].id, CLAIMS[*other].id])
            .collect::<Vec<_>>(),
    })
}

fn named(set: &Judged) -> Value {
    let u = set.undisclosed;
    let with = |letter: char| -> Vec<&str> {
        let verdicts = CLAIMS.iter().zip(&set.verdicts);
        let found = verdicts.filter(|(_, verdict)| **verdict == letter);
        found.map(|(claim, _)| claim.id).collect()
    };
    json!({
        "set": set.index,
        "I": u.second_moment, "a_m": u.a_m, "b_m": u.b_m, "F_w": u.f_w, "c": u.c,
        "holding": set.holding(), "strictly_holding": set.strictly_holding(),
        "fail": with('F'), "undecided": with('U'),
    })
}

fn summary(assumed: &[Judgement], found: &Found, out: &Path) -> String {
    let mut text = String::new();
    for (claim, judged) in CLAIMS.iter().zip(assumed) {
        let letter = judged.holding.letter();
        text.push_str(&format!("{letter}  {:18} {}\n", claim.id, claim.says));
    }
    let count = |letter| {
        assumed
            .iter()
            .filter(|j| j.holding.letter() == letter)
            .count()
    };
    text.push_str(&format!(
        "with the assumed values {} of {} claims hold, {} fail, {} are undecided\n",
        count('H'),
        CLAIMS.len(),
        count('F'),
        count('U')
    ));
    if let Some(best) = found.confirmed.first() {
        text.push_str(&together(best, found));
    }
    text.push_str(&format!("{}\n", out.join("search.json").display()));
    text
}

/// How many claims hold at once, where, and how robustly.
fn together(best: &Judged, found: &Found) -> String {
    let u = best.undisclosed;
    let sets = found.screened.len();
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let counts = histogram(&found.screened);
    let as_many: usize = counts.iter().skip(best.holding()).sum();
    let within = |fewer: usize| {
        let least = best.holding().saturating_sub(fewer);
        percent(share_with(&found.neighbours, least))
    };
    format!(
        "of {sets} sets, {} of all verdicts undecided, {as_many} have {} or more claims that hold\n\
         at best, with longer runs, {} hold at once ({} strictly): I = {:.3e} m^4, a_m = {:.3} N m, \
         b_m = {:.4} N m s, F_w = {:.3} N m, c = {:.0} N s/m\n\
         around it, within 10 %: {} of the sets keep them all, {} lose one at most, {} two\n\
         {} pairs of claims that hold somewhere never hold together\n",
        percent(undecided(&found.screened)),
        best.holding(),
        best.holding(),
        best.strictly_holding(),
        u.second_moment,
        u.a_m,
        u.b_m,
        u.f_w,
        u.c,
        within(0),
        within(1),
        within(2),
        exclusive(&found.screened).len(),
    )
}
