//! Tests of the tour's page: sections, self-containedness, escaping.

use eomgen_codegen::report::{CoefficientLine, Line, MassMatrixEntry, Report, Sentence, Solution};
use eomgen_codegen::symbolic::formula::{Formula, Index};
use maud::html;

use super::*;

fn line(name: &str, formula: &str) -> Line {
    Line {
        name: Formula::from_name(name),
        formula: Formula::from_name(formula),
    }
}

/// Returns a report with `text` in every field that a specification can set.
fn report(text: &str) -> Report {
    Report {
        schema: 2,
        model: text.to_owned(),
        title: text.to_owned(),
        orders: vec![4],
        state: vec![text.to_owned()],
        definitions: vec![line(text, text)],
        terms: vec![line(text, text)],
        kinetic: Formula::from_name(text),
        potential: Formula::from_name(text),
        shared: vec![line(text, text)],
        mass_matrix: vec![MassMatrixEntry {
            row: Formula::from_name(text),
            column: Formula::from_name(text),
            formula: Formula::from_name(text),
        }],
        pivots: vec![line(text, text)],
        velocity_terms: vec![line(text, text)],
        forces: vec![line(text, text)],
        state_rates: vec![line(text, text)],
        constraints: vec![line(text, text)],
        multipliers: vec![line(text, text)],
        coefficients: vec![CoefficientLine {
            name: Formula::from_name(text),
            formula: Formula::from_name(text),
            indices: vec![Index::I],
            columns: 1,
            unit: None,
            values: vec![0.25; 10],
        }],
        accelerations: vec![line(text, text)],
        guards: vec![Formula::from_name(text)],
        linearity: Sentence {
            text: "The model is not linear because of",
            formula: Some(Formula::from_name(text)),
        },
        solution: Solution {
            dense_modes: false,
            order: vec![Formula::from_name(text)],
            interfaces: 1,
            operations: 101,
            dearest: 202,
        },
    }
}

fn check(sentence: &str, passed: bool, skipped: bool) -> CheckRow {
    CheckRow {
        sentence: sentence.to_owned(),
        value: passed.then_some(3e-15),
        tolerance: 1e-12,
        passed,
        skipped,
        detail: sentence.to_owned(),
    }
}

fn arm() -> &'static InteractivePart {
    static ARM: std::sync::OnceLock<InteractivePart> = std::sync::OnceLock::new();
    ARM.get_or_init(|| InteractivePart {
        body: html! { canvas #drawing {} },
        data: "{}".to_owned(),
    })
}

fn tour<'a>(text: &'a str, equations: &'a Report) -> Tour<'a> {
    Tour {
        title: text,
        found: text,
        arm: arm(),
        generated_by: text,
        specification: Specification {
            path: text,
            reference: text,
            text,
            warnings: vec![text],
        },
        symbols: vec![SymbolRow {
            name: text.to_owned(),
            meaning: text.to_owned(),
            value: Some(0.375),
            unit: text.to_owned(),
        }],
        functions: vec![FunctionNote {
            call: text.to_owned(),
            definition: "is 0 within the play.",
        }],
        equations,
        source: Source { path: text, text },
        checks: vec![check(text, true, false), check(text, false, true)],
        simulation: Simulation {
            summary: text,
            path: text,
            figures: vec![Figure {
                svg: "<svg><path d=\"M0,0\"/></svg>",
                narrow: "",
                caption: text,
            }],
        },
        hidden: Hidden {
            facts: vec![(text, text.to_owned())],
            path: text,
            extended: text,
            reports: [text, text],
        },
        durations: vec![StepDuration {
            step: text,
            seconds: 0.5,
        }],
        next: vec![NextCommand {
            command: text.to_owned(),
            purpose: text,
        }],
    }
}

/// Returns the page without its scripts.
fn without_scripts(page: &str) -> &str {
    page.split("<script").next().unwrap_or_default()
}

/// Returns the names of opened elements, in order.
fn elements(page: &str) -> Vec<&str> {
    page.split('<')
        .skip(1)
        .map(|piece| {
            piece
                .split(|c: char| !c.is_ascii_alphanumeric())
                .next()
                .unwrap_or_default()
        })
        .filter(|name| !name.is_empty())
        .collect()
}

#[test]
fn text_of_a_specification_is_escaped() {
    let hostile =
        "</pre></code></title><script>alert(\"1\")</script><img src=x onerror='a'>\" onload=\"b";
    let (harmless, injected) = (report("plain"), report(hostile));
    let page = tour(hostile, &injected).render();
    for forbidden in ["<img", "alert(\"", "\" onload"] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    assert_eq!(page.matches("<script").count(), 2);
    let outside_formulas = |page: &str| -> Vec<String> {
        let elements = elements(page)
            .into_iter()
            .filter(|name| !["i", "sub", "sup", "span"].contains(name));
        elements.map(str::to_owned).collect()
    };
    assert_eq!(
        outside_formulas(&page),
        outside_formulas(&tour("plain", &harmless).render())
    );
}

#[test]
fn page_is_self_contained() {
    let report = report("x_sp");
    let page = tour("x_sp", &report).render();
    for forbidden in [
        "http:",
        "https:",
        "<link",
        "src=",
        "url(",
        "@import",
        "javascript",
    ] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    let links: Vec<&str> = page.split("href=\"").skip(1).collect();
    let sections = links.iter().filter(|link| link.starts_with('#'));
    let files = links.iter().filter(|link| link.starts_with("x_sp\""));
    assert_eq!((sections.count(), files.count(), links.len()), (8, 3, 11));
}

#[test]
fn page_has_every_section() {
    let report = report("x_sp");
    let page = tour("the text", &report).render();
    for anchor in [
        "specification",
        "equations",
        "source",
        "certificate",
        "simulation",
        "hidden",
        "durations",
        "next",
    ] {
        assert!(
            page.contains(&format!("<section id=\"{anchor}\">")),
            "{anchor}"
        );
        assert!(page.contains(&format!("href=\"#{anchor}\"")), "{anchor}");
    }
    let parts = [
        "Definitions",
        "Terms of",
        "Kinetic and potential",
        "Mass matrix",
        "Pivots",
        "Velocity terms",
        "Generalised forces",
        "Coefficients",
        "Accelerations",
        "Switching surfaces",
        "101 operations",
        "most expensive order takes 202",
        "one warning",
        "Checks passed: 1; failed: 0; not run: 1",
        "·10<sup>−12</sup>",
        "·10<sup>−15</sup>",
        "<svg>",
        "500.0 ms",
        "the first 8 of 10 modes",
        "<msub><mi>x</mi><mi>sp</mi></msub>",
        "Shared subexpressions",
        "<summary>Symbols</summary>",
        "0.375",
        "is 0 within the play.",
        "The model is not linear because of <math>",
    ];
    for part in parts {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn headline_states_the_verdict_of_the_checks() {
    let report = report("x");
    let mut tour = tour("x", &report);
    let partial = "Partial: no check failed, but some were not run.";
    assert!(tour.render().contains(partial));
    tour.checks.pop();
    assert!(tour.render().contains("The model passes."));
    tour.checks.push(check("bad", false, false));
    assert!(tour.render().contains("The model fails 1 of its checks."));
    tour.checks = vec![check("none", false, true)];
    assert!(tour.render().contains("No check was run."));
}

#[test]
fn elements_are_closed_in_order() {
    let report = report("dot(x_sp)^2*sum_i(q_i^(2)");
    let page = tour("a < b", &report).render();
    let mut open: Vec<&str> = Vec::new();
    for piece in without_scripts(&page).split('<').skip(1) {
        let tag = piece.split('>').next().unwrap_or_default();
        let is_void =
            tag.ends_with('/') || tag == "br" || tag.starts_with('!') || tag.starts_with("meta ");
        match tag.strip_prefix('/') {
            Some(closed) => assert_eq!(open.pop(), Some(closed), "near {piece}"),
            None if is_void => {}
            None => open.extend(tag.split(' ').next()),
        }
    }
    assert_eq!(open, ["html", "body"]);
}
