//! Result of a search as table, JSON document and summary.

use serde_json::{Value, json};

use super::claims::CLAIMS;
use super::judge::Judgement;
use super::search::{JudgedSet, SearchRequest, SearchResult, rank};
use super::sets::RANGES;
use super::tally::{find_exclusive_pairs, histogram, share_with, shares, undecided};

/// Number of sets listed in the document.
const LISTED_SETS: usize = 20;

/// Formats every judged set as a CSV line, with one column per claim: H holds, F fails, U undecided.
pub fn csv(found: &SearchResult) -> String {
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
                set.holding_claims(),
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

/// Returns request and result as JSON.
pub fn document(request: &SearchRequest, assumed: &[Judgement], found: &SearchResult) -> Value {
    let best = found.confirmed.first();
    let most = best.map_or(0, JudgedSet::holding_claims);
    let claims: Vec<Value> = CLAIMS
        .iter()
        .zip(assumed)
        .zip(shares(&found.screened))
        .map(|((claim, judged), share)| {
            json!({
                "id": claim.id, "source": claim.place, "statement": claim.text,
                "rule": format!("{:?}", claim.rule),
                "assumed": {
                    "verdict": judged.holding.letter().to_string(),
                    "strict": judged.strict.letter().to_string(),
                    "evidence": judged.evidence,
                },
                "screened": {
                    "holds": share.holds, "fails": share.fails, "undecided": share.undecided_share,
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
    let pairs = find_exclusive_pairs(&found.screened);
    json!({
        "schema": 2,
        "sets": request.sets,
        "seed": request.seed,
        "ranges": ranges.collect::<Vec<_>>(),
        "claims": claims,
        "histogram": histogram(&found.screened),
        "undecided": undecided(&found.screened),
        "best_screened": rank(&found.screened).into_iter().take(LISTED_SETS).map(set_json).collect::<Vec<_>>(),
        "confirmed": found.confirmed.iter().take(LISTED_SETS).map(set_json).collect::<Vec<_>>(),
        "neighbourhood": {
            "sets": found.neighbours.len(),
            "within": 0.1,
            "keep_all": share_with(&found.neighbours, most),
            "lose_at_most_one": share_with(&found.neighbours, most.saturating_sub(1)),
            "lose_at_most_two": share_with(&found.neighbours, most.saturating_sub(2)),
        },
        "incompatible": pairs.iter()
            .map(|(one, other)| [CLAIMS[*one].id, CLAIMS[*other].id])
            .collect::<Vec<_>>(),
    })
}

fn set_json(set: &JudgedSet) -> Value {
    let u = set.undisclosed;
    let with = |letter: char| -> Vec<&str> {
        let verdicts = CLAIMS.iter().zip(&set.verdicts);
        let found = verdicts.filter(|(_, verdict)| **verdict == letter);
        found.map(|(claim, _)| claim.id).collect()
    };
    json!({
        "set": set.index,
        "I": u.second_moment, "a_m": u.a_m, "b_m": u.b_m, "F_w": u.f_w, "c": u.c,
        "holding": set.holding_claims(), "strictly_holding": set.strictly_holding(),
        "fail": with('F'), "undecided": with('U'),
    })
}

/// Formats the verdicts at the assumed values, and the number of claims that hold at once.
pub fn summary(assumed: &[Judgement], found: &SearchResult) -> String {
    let mut text = String::new();
    for (claim, judged) in CLAIMS.iter().zip(assumed) {
        let letter = judged.holding.letter();
        text.push_str(&format!("{letter}  {:18} {}\n", claim.id, claim.text));
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
        text.push_str(&format_best_set(best, found));
    }
    text
}

/// Formats the best set, its number of claims, and the verdicts of its neighbours.
fn format_best_set(best: &JudgedSet, found: &SearchResult) -> String {
    let u = best.undisclosed;
    let sets = found.screened.len();
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let counts = histogram(&found.screened);
    let as_many: usize = counts.iter().skip(best.holding_claims()).sum();
    let within = |fewer: usize| {
        let least = best.holding_claims().saturating_sub(fewer);
        percent(share_with(&found.neighbours, least))
    };
    format!(
        "of {sets} sets, {} of all verdicts undecided, {as_many} have {} or more claims that hold\n\
         at best, with longer runs, {} hold at once ({} strictly): I = {:.3e} m^4, a_m = {:.3} N m, \
         b_m = {:.4} N m s, F_w = {:.3} N m, c = {:.0} N s/m\n\
         around it, within 10 %: {} of the sets keep them all, {} lose one at most, {} two\n\
         {} pairs of claims that hold somewhere never hold together\n",
        percent(undecided(&found.screened)),
        best.holding_claims(),
        best.holding_claims(),
        best.strictly_holding(),
        u.second_moment,
        u.a_m,
        u.b_m,
        u.f_w,
        u.c,
        within(0),
        within(1),
        within(2),
        find_exclusive_pairs(&found.screened).len(),
    )
}
