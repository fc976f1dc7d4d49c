//! Tests of derived formulas as MathML: well-formed and formatted correctly.

use std::path::{Path, PathBuf};

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::report::Report;
use eomgen_codegen::symbolic::formula::Formula;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;
use eomgen_page::{formula, name_letters, quantity_symbol};

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

/// Returns every shipped specification, and one specification per feature of the language.
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
fn names_are_letters_with_subscripts_or_words() {
    let set = |name: &str| quantity_symbol(name).into_string();
    assert_eq!(
        set("eps_0"),
        "<math><msub><mi>ε</mi><mi>0</mi></msub></math>"
    );
    assert_eq!(
        set("load_x"),
        "<math><msub><mi>load</mi><mi>x</mi></msub></math>"
    );
    let words = "stabilisation\u{a0}rate";
    assert_eq!(
        set("stabilisation_rate"),
        format!("<math><mi>{words}</mi></math>")
    );
    assert_eq!(
        name_letters("stabilisation_rate"),
        (words.to_owned(), String::new())
    );
    assert_eq!(name_letters("eps_0"), ("ε".to_owned(), "0".to_owned()));
}

#[test]
fn closing_sentences_scroll_in_narrow_windows() {
    let page = eomgen_page::equations(&report(models::DOUBLE_PENDULUM.text)).into_string();
    let sentence = "<div class=\"wide\"><p>The model is not linear because of <math>";
    assert!(page.contains(sentence), "{page}");
}

#[test]
fn markup_in_names_is_escaped() {
    let named = formula(&Formula::from_name("<b>&\"'")).into_string();
    assert_eq!(named, "<math><mi>&lt;b&gt;&amp;&quot;'</mi></math>");
}

/// Returns the formula of a line of the planetary arm with its name as plain text.
fn find_formula<'a>(lines: &'a [eomgen_codegen::report::Line], name: &str) -> &'a Formula {
    let mut lines = lines.iter();
    &lines
        .find(|line| line.name.to_string() == name)
        .expect(name)
        .formula
}

#[test]
fn entry_of_mass_matrix_has_one_spelling() {
    let report = report(models::PLANETARY_ARM.text);
    let page = eomgen_page::equations(&report).into_string();
    let entry = "<msub><mi>M</mi><mrow><msub><mi>x</mi><mi>sp</mi></msub><mo>,</mo><msub><mi>x</mi><mi>sp</mi></msub></mrow></msub>";
    // The entry occurs in its own line, in the entries that contain it, and in the pivot.
    assert!(page.matches(entry).count() > 4, "{page}");
    let pivot = "<msub><mi>pivot</mi><mrow><msub><mi>x</mi><mi>c</mi></msub></mrow></msub>";
    assert!(page.matches(pivot).count() > 4, "{page}");
    let term = "<msub><mi>V</mi><mrow><msub><mi>mesh</mi><mi>sp</mi></msub></mrow></msub>";
    assert_eq!(page.matches(term).count(), 2, "{page}");
    for wrong in ["x,sp", "x,c", "mesh,sp", "<i>M</i>"] {
        assert!(!page.contains(wrong), "{wrong}");
    }
}

#[test]
fn numbers_and_integrals_are_at_their_places() {
    let report = report(models::PLANETARY_ARM.text);
    let carrier = formula(find_formula(&report.terms, "T_carrier")).into_string();
    // 1/2 is part of the fraction, and the exponent follows the name of the cosine.
    assert!(carrier.starts_with("<math><mfrac><mrow>"), "{carrier}");
    assert!(carrier.contains("<mrow><mn>2</mn>"), "{carrier}");
    assert!(
        carrier.contains("<msup><mi>cos</mi><mrow><mn>2</mn></mrow></msup>"),
        "{carrier}"
    );
    let bending = formula(find_formula(&report.terms, "V_bending")).into_string();
    assert_eq!(bending.matches("<mi>φ</mi>").count(), 1, "{bending}");
    for line in &report.coefficients {
        let text = formula(&line.formula).into_string();
        let differential = "<mi mathvariant=\"normal\">d</mi><mi>s</mi></mrow>";
        for after in text.split(differential).skip(1) {
            let product = "<mo lspace=\"0.17em\" rspace=\"0\">\u{2062}</mo>";
            let next = after
                .strip_prefix(product)
                .unwrap_or("<mrow><msubsup><mo>∫");
            assert!(
                next.starts_with("<mrow><msubsup><mo>∫"),
                "a factor after ds: {text}"
            );
        }
    }
}

#[test]
fn multiples_of_pi_are_not_decimal_numbers() {
    let text = "[model]\nname = \"a\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                f_d = { value = 2, unit = \"1/s\" }\n[coordinates]\nx = { unit = \"m\" }\n\
                [kinetic]\nmass = \"1/2*m*dot(x)^2\"\n\
                [potential]\nspring = \"1/2*m*(2*pi*f_d)^2*x^2\"\n";
    let report = report(text);
    let page = eomgen_page::equations(&report).into_string();
    assert!(page.contains("<msup><mi>π</mi><mn>2</mn></msup>"), "{page}");
    assert!(!page.contains("39.47") && !page.contains("19.73"), "{page}");
}

#[test]
fn modes_are_mentioned_only_with_modes() {
    let of = |text: &str| eomgen_page::equations(&report(text)).into_string();
    assert!(!of(models::DOUBLE_PENDULUM.text).contains("modes"));
    assert!(of(models::PLANETARY_ARM.text).contains("Sums run over the modes"));
}

#[test]
fn values_by_mode_have_labelled_rows_and_columns() {
    let page = eomgen_page::equations(&report(models::PLANETARY_ARM.text)).into_string();
    let matrix = page
        .split("<table class=\"modes\"><thead>")
        .nth(1)
        .expect("a matrix");
    let matrix = matrix.split("</table>").next().expect("its end");
    assert_eq!(
        matrix.matches("<th scope=\"col\"><i>j</i>").count(),
        4,
        "{matrix}"
    );
    assert_eq!(
        matrix.matches("<th scope=\"row\"><i>i</i>").count(),
        4,
        "{matrix}"
    );
    assert_eq!(matrix.matches("<td>").count(), 16, "{matrix}");
}
