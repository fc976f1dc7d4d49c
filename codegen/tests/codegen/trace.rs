//! Names, units and terms of the values of emitted code.

use std::collections::BTreeSet;

use eomgen_codegen::c;
use eomgen_codegen::program::units::{ValueUnit, infer_units};
use eomgen_codegen::program::{Op, Output, Program, ValueId};
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::statements::collect_coefficients;
use eomgen_codegen::trace::{TracedLine, find_traced_lines};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::unit::Unit;

use crate::support::{model, models, shipped};

const CRANE: &str = r#"
[model]
name = "crane"
[parameters]
M = { value = 20, unit = "kg" }
m = { value = 5, unit = "kg" }
l = { value = 0.8, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
k = { value = 400, unit = "N/m" }
b = { value = 0.01, unit = "m" }
[coordinates]
x = { unit = "m" }
theta = { unit = "rad" }
[inputs]
F = { unit = "N" }
[definitions]
x_l = "x + l*sin(theta)"
y_l = "-l*cos(theta)"
[kinetic]
trolley = "1/2*M*dot(x)^2"
load = "1/2*m*(dot(x_l)^2 + dot(y_l)^2)"
[potential]
load = "m*g*y_l"
buffer = "1/2*k*deadzone(x, b)^2"
[forces]
drive = { on = "x", value = "F" }
"#;

fn derive(model: &Model, order: usize, outputs: &[Output]) -> Program {
    let orders = vec![order; model.fields.len()];
    match Variant::derive_with_trace(model, &orders, outputs) {
        Ok(variant) => variant.program,
        Err(found) => panic!("{}", found.render(false)),
    }
}

/// Emits the Rust source and the C source.
fn both(program: &Program) -> [String; 2] {
    let rust = emit(program, Packaging::Crate).expect("Rust");
    let files = c::emit(program).expect("C");
    [rust, files.header + &files.source]
}

/// Returns names and models of the shipped specifications.
fn all_shipped() -> Vec<(String, Model)> {
    let folder = std::fs::read_dir(models()).expect("models");
    let paths = folder.map(|entry| entry.expect("entry").path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|of| of == "toml"))
        .collect();
    paths.sort();
    let load = |path: std::path::PathBuf| {
        let name = path
            .file_stem()
            .expect("name")
            .to_string_lossy()
            .into_owned();
        let checked = eomgen_model_spec::load(&path);
        let checked = checked.unwrap_or_else(|found| panic!("{}", found.render(false)));
        (name, checked.model)
    };
    paths.into_iter().map(load).collect()
}

// Units are inferred from the operations and compared with the units that the specification declares.
#[test]
fn inferred_units_match_declared_ones() {
    let second = ValueUnit::Known(Dimension::TIME);
    for (name, model) in all_shipped() {
        let program = derive(&model, 2, &[]);
        let units = infer_units(&program);
        let check = |id: ValueId, expected: Option<Dimension>, what: &str| match units[id.index()] {
            ValueUnit::Any => {}
            found => assert_eq!(found.dimension(), expected, "{name}: {what}"),
        };
        let dimension = |unit: &str| Unit::parse(unit).expect("unit").dimension;
        let per_second = |of: Dimension| of.divide(second.dimension().expect("s"));
        for (coordinate, id) in program
            .coordinates
            .iter()
            .zip(&program.accelerations.scalars)
        {
            let rate = per_second(dimension(&coordinate.unit)).expect("rate");
            check(*id, per_second(rate), &coordinate.name);
        }
        for (field, id) in program.fields.iter().zip(&program.accelerations.modal) {
            let rate = per_second(dimension(&field.unit)).expect("rate");
            check(*id, per_second(rate), &field.coordinates);
        }
        for (observable, id) in program.observables.iter().zip(&program.observable_values) {
            check(*id, Some(dimension(&observable.unit)), &observable.name);
        }
        let unknown = program.values.iter().zip(&units);
        let unknown = unknown
            .filter(|(_, unit)| **unit == ValueUnit::Unknown)
            .count();
        assert_eq!(unknown, 0, "{name}");
    }
}

#[test]
fn no_formula_is_cut() {
    for (name, model) in all_shipped() {
        for text in both(&derive(&model, 2, &[])) {
            assert!(!text.contains("..."), "{name}");
        }
    }
}

/// Returns the traced lines of the emitted Rust and of the emitted C source.
fn lines_of_both(program: &Program) -> [Vec<TracedLine>; 2] {
    let rust = emit(program, Packaging::Crate).expect("Rust");
    let source = c::emit(program).expect("C").source;
    [rust, source].map(|text| find_traced_lines(&text, &program.trace))
}

#[test]
fn values_of_a_crane_have_its_terms() {
    let program = derive(&model(CRANE), 0, &[]);
    for lines in lines_of_both(&program) {
        let find = |function: &str, name: &str| -> Vec<&str> {
            let own = |line: &&TracedLine| line.function.contains(function) && line.name == name;
            let line = lines.iter().find(own);
            let line = line.unwrap_or_else(|| panic!("{function}, {name}: {lines:#?}"));
            line.terms.iter().map(String::as_str).collect()
        };
        assert_eq!(
            find("rates", "theta_ddot"),
            [
                "kinetic.trolley",
                "kinetic.load",
                "potential.load",
                "potential.buffer",
                "forces.drive"
            ]
        );
        assert_eq!(find("mass_matrix", "M_x_theta"), ["kinetic.load"]);
        // The energy contains no force.
        let of_energy = lines.iter().filter(|line| line.function.contains("energy"));
        assert!(of_energy.clone().count() > 3);
        assert!(
            of_energy
                .flat_map(|line| &line.terms)
                .all(|term| !term.starts_with("forces"))
        );
    }
}

#[test]
fn every_definition_of_a_function_is_traced() {
    for name in ["planetary_arm", "two_link_arm", "hub_beam_tip_mass"] {
        let program = derive(&shipped(name), 2, &[]);
        let source = emit(&program, Packaging::Crate).expect("Rust");
        let traced: BTreeSet<usize> = find_traced_lines(&source, &program.trace)
            .iter()
            .map(|line| line.line)
            .collect();
        let given = ["state[", "inputs.", "parameters."];
        for (place, line) in source.lines().enumerate() {
            let is_own = line.starts_with("    let s_") || line.starts_with("        let s_");
            if is_own && !given.iter().any(|word| line.contains(&format!("= {word}"))) {
                assert!(
                    traced.contains(&(place + 1)),
                    "{name}, line {}: {line}",
                    place + 1
                );
            }
        }
    }
}

// If a term does not occur in the trace of a value, the value and its name do not change when the term is removed.
#[test]
fn values_remain_without_a_term_outside_of_their_trace() {
    let without = CRANE.replace("drive = { on = \"x\", value = \"F\" }", "");
    let term = "forces.drive".to_owned();
    let whole = derive(&model(CRANE), 0, &[]);
    let part = derive(&model(&without), 0, &[]);
    for (whole, part) in lines_of_both(&whole).iter().zip(&lines_of_both(&part)) {
        let known: BTreeSet<(&str, &str)> = part
            .iter()
            .map(|line| (&*line.function, &*line.name))
            .collect();
        let mut count = 0;
        // Without the term, sums of forces are grouped differently.
        let is_sum =
            |line: &TracedLine| line.terms.iter().any(|term| term.starts_with("potential"));
        let others = whole.iter().filter(|line| !line.terms.contains(&term));
        for line in others.filter(|line| !line.function.contains("rates") || !is_sum(line)) {
            assert!(known.contains(&(&*line.function, &*line.name)), "{line:?}");
            count += 1;
        }
        assert!(count > 10, "{count}");
        assert!(whole.iter().any(|line| line.terms.contains(&term)));
    }
}

/// Returns the number of lines that `diff` prints: removed and added lines.
fn changed_lines(before: &str, after: &str) -> usize {
    let (before, after): (Vec<&str>, Vec<&str>) =
        (before.lines().collect(), after.lines().collect());
    let mut common = vec![0_usize; after.len() + 1];
    for line in &before {
        let mut diagonal = 0;
        for (place, other) in after.iter().enumerate() {
            let above = common[place + 1];
            common[place + 1] = match line == other {
                true => diagonal + 1,
                false => above.max(common[place]),
            };
            diagonal = above;
        }
    }
    before.len() + after.len() - 2 * common[after.len()]
}

#[test]
fn an_added_friction_changes_few_lines() {
    let arm = shipped("planetary_arm").source.text.clone();
    let before = |section: &str, line: &str| (section.to_owned(), format!("{line}\n{section}"));
    let parameter = before("[coordinates]", "c_v = { value = 0.3, unit = \"N s/m\" }");
    let force = before(
        "[observables]",
        "bearing = { on = \"x_c\", value = \"-c_v*dot(x_c)\" }",
    );
    let with_friction = arm
        .replacen(&parameter.0, &parameter.1, 1)
        .replacen(&force.0, &force.1, 1);
    let files = |text: &str| both(&derive(&model(text), 3, &[]));
    for (before, after) in files(&arm).iter().zip(&files(&with_friction)) {
        let changed = changed_lines(before, after);
        println!("{changed} of {} lines", before.lines().count());
        assert!(
            changed < 70,
            "{changed} of {} lines",
            before.lines().count()
        );
    }
}

#[test]
fn jacobians_by_state_need_fewer_coefficients() {
    let model = shipped("hub_beam_tip_mass");
    let program = |outputs: &[Output]| derive(&model, 3, outputs);
    let count = |program: &Program| collect_coefficients(program).len();
    let none = program(&[]);
    let by_state = program(&[Output::StateJacobians]);
    let all = program(&[Output::Jacobians]);
    assert!(count(&none) <= count(&by_state) && count(&by_state) < count(&all));
    let names = |program: &Program| -> Vec<&str> {
        program
            .outputs
            .jacobians
            .iter()
            .map(|known| known.name)
            .collect()
    };
    assert_eq!(names(&by_state), ["rates_by_state", "observables_by_state"]);
    // The text of the function is equal in both files.
    let function = |program: &Program| {
        let text = emit(program, Packaging::Crate).expect("Rust");
        let begin = text.find("pub fn rates_by_state<").expect("begin");
        text[begin..].split("\n}\n").next().expect("end").to_owned()
    };
    assert_eq!(function(&by_state), function(&all));
}

#[test]
fn model_with_the_name_of_a_stem_is_emitted_as_c() {
    for name in ["s", "c"] {
        let text = CRANE.replace("name = \"crane\"", &format!("name = \"{name}\""));
        let text = c::emit(&derive(&model(&text), 0, &[])).expect("C").source;
        assert!(text.contains(&format!("void {name}_rates(")));
    }
}

#[test]
fn programs_without_a_trace_have_no_notes() {
    let orders = [2];
    let variant = Variant::derive(&shipped("planetary_arm"), &orders).expect("derived");
    let text = emit(&variant.program, Packaging::Crate).expect("Rust");
    assert!(find_traced_lines(&text, &variant.program.trace).is_empty());
    let is_constant = |op: &Op| matches!(op, Op::Constant(_));
    assert!(
        variant
            .program
            .values
            .iter()
            .any(|value| is_constant(&value.op))
    );
}
