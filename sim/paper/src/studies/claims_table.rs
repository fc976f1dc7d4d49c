//! Markdown table of the claims: text, verdicts at the assumed values, and shares of the searched parameter sets.

use super::claims::CLAIMS;
use super::judge::{Judgement, Verdict};
use super::tally::Share;

/// Formats the table from the judgements at the assumed values and the shares of a search.
pub fn format_markdown(assumed: &[Judgement], shares: &[Share]) -> String {
    let mut text = "| claim | source | statement of the paper | verdict | strict verdict | holds in | undecided in | evidence |\n\
                    | --- | --- | --- | --- | --- | --- | --- | --- |\n"
        .to_owned();
    for ((claim, judged), share) in CLAIMS.iter().zip(assumed).zip(shares) {
        text.push_str(&format!(
            "| `{}` | {} | {} | {} | {} | {:.0} % | {:.0} % | {} |\n",
            claim.id,
            claim.place,
            claim.text,
            word(judged.holding),
            word(judged.strict),
            100.0 * share.holds,
            100.0 * share.undecided_share,
            judged.evidence.replace('|', "\\|"),
        ));
    }
    text
}

fn word(holding: Verdict) -> &'static str {
    match holding {
        Verdict::Holds => "holds",
        Verdict::Fails => "fails",
        Verdict::Undecided => "undecided",
    }
}
