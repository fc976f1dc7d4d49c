//! Tests of derived formulas as MathML: well-formed and formatted correctly.

use std::path::{Path, PathBuf};

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::report::Report;
use eomgen_codegen::symbolic::formula::Formula;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;
use eomgen_page::formula;

fn report(text: &str) -> Report {
    let checked = eomgen_model_spec::check(Source::new("test.toml", text))
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    let orders = checked.model.orders(None).unwrap();
    let variant = Variant::derive_for_report(&checked.model, &orders, &[])
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    Report::new(
        &checked.model,
        &variant.equations,
        &Evaluator::new(variant.program),
    )
}

/// Returns every shipped specification, and one per feature of the language.
fn specifications() -> Vec<(String, String)> {
    let features = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/features");
    let entries = std::fs::read_dir(features).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    assert!(paths.len() > 5, "{paths:?}");
    let read = |path: &PathBuf| {
        let name = path.display().to_string();
        (name, std::fs::read_to_string(path).unwrap())
    };
    let shipped = models::ALL.map(|of| (of.name.to_owned(), of.text.to_owned()));
    shipped.into_iter().chain(paths.iter().map(read)).collect()
}

/// Returns all formulas of a report.
fn formulas(report: &Report) -> Vec<&Formula> {
    let lines = [
        &report.definitions,
        &report.terms,
        &report.shared,
        &report.pivots,
        &report.velocity_terms,
        &report.forces,
        &report.accelerations,
    ];
    let lines = lines.into_iter().flatten();
    let mut all: Vec<&Formula> = lines.flat_map(|line| [&line.name, &line.formula]).collect();
    all.extend(report.mass_matrix.iter().map(|entry| &entry.formula));
    all.extend(report.coefficients.iter().map(|line| &line.formula));
    all.extend(&report.guards);
    all.extend([&report.kinetic, &report.potential]);
    all.extend(&report.linearity.formula);
    all
}

#[test]
fn mathml_is_well_formed_for_every_specification() {
    for (name, text) in specifications() {
        for of in formulas(&report(&text)) {
            let mathml = format!("<p>{}</p>", formula(of).into_string());
            if let Err(error) = roxmltree::Document::parse(&mathml) {
                panic!("{name}: {error} in {mathml}");
            }
        }
    }
}

#[test]
fn fractions_dots_and_indices_are_formatted() {
    let report = report(models::PLANETARY_ARM.text);
    let acceleration = formula(&report.accelerations[0].name).into_string();
    assert_eq!(
        acceleration,
        "<math><msub><mover accent=\"true\"><mi>x</mi><mo>¨</mo></mover><mi>sp</mi></msub></math>"
    );
    let inertia = formula(&report.mass_matrix[0].formula).into_string();
    assert_eq!(
        inertia,
        "<math><mfrac><mrow><msub><mi>I</mi><mi>s</mi></msub></mrow><mrow><msup><mrow><msub><mi>r</mi><mi>s</mi></msub></mrow>\
         <mrow><mn>2</mn></mrow></msup></mrow></mfrac></math>"
    );
}

#[test]
fn markup_in_names_is_escaped() {
    let named = formula(&Formula::from_name("<b>&\"'")).into_string();
    assert_eq!(named, "<math><mi>&lt;b&gt;&amp;&quot;'</mi></math>");
}
