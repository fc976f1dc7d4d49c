//! docs/claims.md says what docs/claims.json holds, the document that the command on the page
//! leaves. That the program still says so of the assumed values, `study_search` tests.

use eomgen_tests::models::project;
use serde_json::Value;

fn page() -> String {
    std::fs::read_to_string(project().join("docs/claims.md")).expect("the page")
}

fn found() -> Value {
    let text = std::fs::read_to_string(project().join("docs/claims.json")).expect("the document");
    serde_json::from_str(&text).expect("JSON")
}

fn list<'a>(document: &'a Value, name: &str) -> &'a [Value] {
    document[name].as_array().expect(name)
}

fn word(letter: &Value) -> &'static str {
    match letter.as_str() {
        Some("H") => "holds",
        Some("F") => "fails",
        Some("U") => "undecided",
        _ => panic!("no verdict: {letter}"),
    }
}

fn says(text: &str) {
    let page = page();
    // Lines of the page may break anywhere.
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat(&page).contains(&flat(text)),
        "docs/claims.md does not say: {text}"
    );
}

#[test]
fn the_page_has_a_row_for_every_claim() {
    let document = found();
    let claims = list(&document, "claims");
    assert_eq!(claims.len(), 30);
    for claim in claims {
        let text = |name: &str| claim[name].as_str().expect(name);
        let assumed = &claim["assumed"];
        let evidence = assumed["evidence"].as_str().expect("evidence");
        says(&format!(
            "| `{}` | {} | {} | {} | {} | {} |",
            text("id"),
            text("place"),
            text("statement"),
            word(&assumed["verdict"]),
            word(&assumed["strict"]),
            evidence.replace('|', "\\|"),
        ));
    }
}

#[test]
fn the_page_counts_the_verdicts() {
    let document = found();
    let count = |name: &str, letter: &str| {
        let claims = list(&document, "claims").iter();
        claims
            .filter(|claim| claim["assumed"][name] == letter)
            .count()
    };
    says(&format!(
        "{} of 30 claims hold, {} fail, {} are undecided; strictly {} hold.",
        count("verdict", "H"),
        count("verdict", "F"),
        count("verdict", "U"),
        count("strict", "H"),
    ));
}

#[test]
fn the_page_names_the_command_that_leaves_the_document() {
    let document = found();
    says(&format!(
        "paper claims --sets {} --seed {} --out assumed",
        document["sets"], document["seed"]
    ));
}
