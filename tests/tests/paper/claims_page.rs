//! Comparison of docs/claims.md and its figures with docs/claims.json and docs/claims_search.json, which contain numbers
//! of the documents that the commands on the page write. `study_search` checks that the program still gives these
//! verdicts for the assumed values.

use eomgen_paper::studies::charts::draw_charts;
use eomgen_tests::models::project;
use serde_json::Value;

fn page() -> String {
    std::fs::read_to_string(project().join("docs/claims.md")).expect("the page")
}

fn read_document(name: &str) -> Value {
    let text = std::fs::read_to_string(project().join("docs").join(name)).expect("the document");
    serde_json::from_str(&text).expect("JSON")
}

fn claims_document() -> Value {
    read_document("claims.json")
}

fn list<'a>(document: &'a Value, name: &str) -> &'a [Value] {
    document[name].as_array().expect(name)
}

fn verdict_word(letter: &Value) -> &'static str {
    match letter.as_str() {
        Some("H") => "holds",
        Some("F") => "fails",
        Some("U") => "undecided",
        _ => panic!("no verdict: {letter}"),
    }
}

fn assert_page_contains(text: &str) {
    let page = page();
    // The page may break lines anywhere.
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat(&page).contains(&flat(text)),
        "docs/claims.md does not contain: {text}"
    );
}

#[test]
fn page_has_a_row_for_every_claim() {
    let document = claims_document();
    let claims = list(&document, "claims");
    assert_eq!(claims.len(), 30);
    for claim in claims {
        let text = |name: &str| claim[name].as_str().expect(name);
        let assumed = &claim["assumed"];
        let evidence = assumed["evidence"].as_str().expect("evidence");
        assert_page_contains(&format!(
            "| `{}` | {} | {} | {} | {} | {} |",
            text("id"),
            text("source"),
            text("statement"),
            verdict_word(&assumed["verdict"]),
            verdict_word(&assumed["strict"]),
            evidence.replace('|', "\\|"),
        ));
    }
}

#[test]
fn page_counts_the_verdicts() {
    let document = claims_document();
    let count = |name: &str, letter: &str| {
        let claims = list(&document, "claims").iter();
        claims
            .filter(|claim| claim["assumed"][name] == letter)
            .count()
    };
    assert_page_contains(&format!(
        "{} of 30 claims hold, {} fail, {} are undecided; strictly {} hold.",
        count("verdict", "H"),
        count("verdict", "F"),
        count("verdict", "U"),
        count("strict", "H"),
    ));
}

#[test]
fn page_names_the_command_of_the_document() {
    let document = claims_document();
    assert_page_contains(&format!(
        "paper claims --sets {} --seed {} --out assumed",
        document["sets"], document["seed"]
    ));
}

#[test]
fn figures_and_table_show_the_numbers_of_the_search() {
    let document = read_document("claims_search.json");
    for figure in draw_charts(&document).expect("figures") {
        let kept = std::fs::read_to_string(project().join("docs").join(&figure.file));
        assert!(
            kept.expect("a figure") == figure.svg,
            "docs/{} differs from the figure of docs/claims_search.json",
            figure.file
        );
    }
    let claims = list(&document, "claims");
    assert_eq!(claims.len(), 30);
    for claim in claims {
        let share = |name: &str| 100.0 * claim["screened"][name].as_f64().expect(name);
        assert_page_contains(&format!(
            "| `{}` | {:.0} % | {:.0} % |",
            claim["id"].as_str().expect("a name"),
            share("holds"),
            share("undecided"),
        ));
    }
}
