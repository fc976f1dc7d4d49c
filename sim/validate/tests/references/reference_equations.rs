//! Tests of the assignment of hand-written equations to models. Models match if their equations are equal. Parameter
//! values, names of terms, comments and observables may differ.

use eomgen_model_spec::model::Model;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;
use eomgen_validate::references::reference_equations;

const EMPS: &str = models::EMPS.text;
const ARM: &str = models::PLANETARY_ARM.text;
const TWO_LINKS: &str = models::TWO_LINK_ARM.text;

fn model(text: &str) -> Model {
    eomgen_model_spec::check(Source::new("a.toml", text))
        .unwrap_or_else(|found| panic!("{}", found.render(false)))
        .model
}

/// Returns the text with one part replaced.
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replace(from, to)
}

/// Returns the names of the references that apply, and the names and reasons of the others.
fn list_references(text: &str, order: usize) -> (Vec<String>, Vec<(String, String)>) {
    let model = model(text);
    let values = model.parameter_values().expect("values");
    let found = reference_equations(&model, order, &values);
    let names = found.references.into_iter().map(|known| known.name);
    let absent = found
        .not_applicable
        .into_iter()
        .map(|line| (line.name, line.detail));
    (names.collect(), absent.collect())
}

#[test]
fn comments_numbers_and_observables_keep_the_reference() {
    let closed = (vec!["closed_form".to_owned()], Vec::new());
    assert_eq!(list_references(EMPS, 0), closed);
    let commented = format!("# mine\n{EMPS}");
    assert_eq!(list_references(&commented, 0), closed);
    let observed =
        format!("{EMPS}\n[observables]\nmomentum = {{ value = \"M*dot(q)\", unit = \"N s\" }}\n");
    assert_eq!(list_references(&observed, 0), closed);
    let unused = with(
        EMPS,
        "[coordinates]",
        "offset = { value = 3, unit = \"N\" }\n[coordinates]",
    );
    assert_eq!(list_references(&unused, 0), closed);
    let renamed = with(EMPS, "name  = \"emps\"", "name = \"axis_3\"");
    assert_eq!(list_references(&renamed, 0), closed);
}

#[test]
fn references_use_the_values_of_the_model() {
    let heavier = model(&with(EMPS, "value = 95,", "value = 50,"));
    let mut values = heavier.parameter_values().expect("values");
    let place = |name: &str| {
        let parameters = heavier.parameters.iter();
        parameters
            .map(|p| &p.name)
            .position(|own| own == name)
            .expect(name)
    };
    values[place("F_v")] = 20.0;
    let found = reference_equations(&heavier, 0, &values);
    let deviation = |acceleration: f64| {
        let expected = (7.0 - 20.0 * 0.5) / 50.0;
        (found.references[0].deviation)(0.0, &[0.1, 0.5], &[7.0], &[acceleration * expected])
    };
    assert!(deviation(1.0) < 1e-15);
    assert!(deviation(1.001) > 1e-6);
}

#[test]
fn other_equations_have_no_reference_but_a_reason() {
    let (names, absent) = list_references(&with(EMPS, "1/2*M*dot(q)^2", "3/2*M*dot(q)^2"), 0);
    assert!(names.is_empty());
    let [(name, reason)] = &absent[..] else {
        panic!("{absent:?}");
    };
    assert_eq!(name, "reference");
    let expected =
        "the equations differ from the hand-written ones of emps: `carriage` of [kinetic] differs";
    assert_eq!(reason, expected);
    let spring = "[model]\nname = \"spring\"\ntitle = \"Spring\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                  [coordinates]\nx = { unit = \"m\" }\n[kinetic]\nm = \"1/2*m*dot(x)^2\"\n";
    let (names, absent) = list_references(spring, 0);
    assert!(names.is_empty());
    assert_eq!(
        absent[0].1,
        "there are no hand-written equations for spring"
    );
}

#[test]
fn another_machine_of_a_shipped_name_is_not_compared() {
    let namesake = "[model]\nname = \"crane\"\ntitle = \"Trolley\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                    [coordinates]\nx = { unit = \"m\" }\n[kinetic]\nm = \"1/2*m*dot(x)^2\"\n";
    let (names, absent) = list_references(namesake, 0);
    assert!(names.is_empty());
    assert_eq!(absent[0].1, "there are no hand-written equations for crane");
}

#[test]
fn arm_references_allow_other_plays_but_not_other_radii() {
    let wider = with(ARM, "b_sp = { value = 25e-6", "b_sp = { value = 80e-6");
    let heavier = with(&wider, "value = \"M_s*r_s^2\"", "value = 1e-3");
    let (names, absent) = list_references(&heavier, 4);
    assert_eq!(names, ["equation_22", "equation_22_dimensionless"]);
    assert!(absent.is_empty());
    let (names, absent) = list_references(&heavier, 9);
    assert_eq!(names, ["equation_22"]);
    assert_eq!(absent[0].0, "reference equation_22_dimensionless");
    assert_eq!(
        list_references(&heavier, 0).0,
        ["equation_12", "equation_10"]
    );
    let (names, absent) = list_references(&with(ARM, "\"m*z_s*cos(alpha)/2\"", "\"m*z_s/2\""), 4);
    assert!(names.is_empty());
    assert!(
        absent[0]
            .1
            .ends_with("its parameter `r_s` is derived differently")
    );
}

#[test]
fn flexible_links_have_no_closed_form() {
    assert_eq!(list_references(TWO_LINKS, 0).0, ["closed_form"]);
    let (names, absent) = list_references(TWO_LINKS, 2);
    assert!(names.is_empty());
    assert_eq!(absent[0].1, "the closed form needs a state of 4 entries");
}

#[test]
fn unused_optional_parameters_are_not_passed_on() {
    let text = with(
        EMPS,
        "[coordinates]",
        "offset = { value = 3, unit = \"N\" }\n[coordinates]",
    );
    let model = model(&text);
    let values = model.parameter_values().expect("values");
    let found = reference_equations(&model, 0, &values);
    let at_rest = (found.references[0].deviation)(0.0, &[0.1, 0.0], &[95.0], &[1.0]);
    assert!(at_rest < 1e-15, "{at_rest:e}");
}
