//! Reports: their length, the correctness of their formulas, and equal formulas in all notations.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::PathBuf;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::report::Report;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;

use crate::support::{chain_of_pendulums, evaluator, model, models, observables, shipped};

/// Returns a report at the specification's own orders.
fn report(model: &Model) -> Report {
    let orders = model.orders(None).unwrap();
    let variant = Variant::derive_for_report(model, &orders, &[])
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    Report::new(model, &variant.equations, &Evaluator::new(variant.program))
}

/// Returns every shipped specification and every feature test.
fn specifications() -> Vec<(String, Model)> {
    let features = models().join("../../tests/features");
    let paths = [models(), features].into_iter().flat_map(|folder| {
        let entries = std::fs::read_dir(folder).unwrap();
        entries
            .map(|entry| entry.unwrap().path())
            .collect::<Vec<PathBuf>>()
    });
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    paths.sort();
    let load = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        (
            path.file_stem().unwrap().to_string_lossy().into_owned(),
            model(&text),
        )
    };
    paths.into_iter().map(load).collect()
}

fn json(report: &Report) -> String {
    serde_json::to_string_pretty(report).unwrap()
}

/// Returns a beam with a mass on a lever between two of its points, whose expression tree is huge.
fn lever_mass() -> Model {
    let path = models().join("../../tests/features/lever_mass.toml");
    model(&std::fs::read_to_string(path).unwrap())
}

#[test]
fn long_equations_take_less_than_a_megabyte() {
    let chain = (
        "a chain of forty".to_owned(),
        model(&chain_of_pendulums(40)),
    );
    for (name, model) in specifications().into_iter().chain([chain]) {
        let report = report(&model);
        for text in [report.text(), report.latex(), json(&report)] {
            assert!(text.len() < 1_000_000, "{name}: {}", text.len());
        }
    }
}

#[test]
fn short_reports_have_no_shared_lines() {
    for name in [
        "pendulum",
        "double_pendulum",
        "hub_beam_tip_mass",
        "planetary_arm",
    ] {
        let report = report(&shipped(name));
        assert!(report.shared.is_empty(), "{name}");
        assert!(!report.text().contains("Shared"), "{name}");
    }
}

#[test]
fn coefficients_precede_varying_factors() {
    let text = report(&shipped("crane")).text();
    for product in ["-c*dot(x)", "-m*g*l*sin(theta) - c*l*cos(theta)*dot(x)"] {
        assert!(text.contains(product), "{text}");
    }
}

#[test]
fn shared_lines_use_only_lines_before_them() {
    for model in [lever_mass(), model(&chain_of_pendulums(12))] {
        let report = report(&model);
        let names: Vec<String> = report
            .shared
            .iter()
            .map(|line| line.name.to_string())
            .collect();
        assert!(names.len() > 10, "{names:?}");
        let place: HashMap<&str, usize> = names
            .iter()
            .enumerate()
            .map(|(place, name)| (name.as_str(), place))
            .collect();
        for (line, own) in report.shared.iter().zip(0..) {
            line.formula.visit(&mut |part| {
                let used = place.get(part.to_string().as_str());
                assert!(
                    used.is_none_or(|used| *used < own),
                    "{} uses {part}",
                    line.name
                );
            });
        }
    }
}

#[test]
fn shared_lines_avoid_names_of_the_specification() {
    let text = chain_of_pendulums(12)
        .replace("l = {", "s_3 = {")
        .replace("l*", "s_3*");
    let report = report(&model(&text));
    assert_eq!(report.shared[0].name.to_string(), "z_1");
}

// The plain notation is the language of specifications. If the printed lines are used as definitions, they must give
// the mass matrix and the velocity terms of the program.
#[test]
fn printed_equations_read_back_as_the_same_equations() {
    let count = 10;
    let text = chain_of_pendulums(count);
    let chain = model(&text);
    let report = report(&chain);
    assert!(!report.shared.is_empty());
    let mut definitions = String::from("[definitions]\n");
    for line in &report.shared {
        writeln!(definitions, "{} = \"{}\"", line.name, line.formula).unwrap();
    }
    let mut read = String::from("[observables]\n");
    for entry in &report.mass_matrix {
        let (row, column, formula) = (&entry.row, &entry.column, &entry.formula);
        writeln!(definitions, "M_{row}_{column} = \"{formula}\"").unwrap();
        writeln!(
            read,
            "m_{row}_{column} = {{ value = \"M_{row}_{column}\", unit = \"kg m^2\" }}"
        )
        .unwrap();
    }
    for line in &report.pivots {
        if !definitions.contains(&format!("\n{} = ", line.name)) {
            writeln!(definitions, "{} = \"{}\"", line.name, line.formula).unwrap();
        }
    }
    for line in &report.velocity_terms {
        writeln!(
            read,
            "c_{} = {{ value = \"{}\", unit = \"N m\" }}",
            line.name, line.formula
        )
        .unwrap();
    }
    let again = model(&format!(
        "{}{read}",
        text.replace("[definitions]\n", &definitions)
    ));
    let state: Vec<f64> = (0..2 * count)
        .map(|i| (1.7 * i as f64 + 0.3).sin())
        .collect();
    let found = observables(&mut evaluator(&again, 0), 0.0, &state);
    let mut expected = Vec::new();
    let mut own = evaluator(&chain, 0);
    let point = || Point {
        t: 0.0,
        state: &state,
        inputs: &[],
    };
    let mut matrix = vec![0.0; count * count];
    own.mass_matrix(point(), &mut matrix);
    for row in 0..count {
        expected.extend((row..count).map(|column| matrix[row * count + column]));
    }
    let (mut bias, mut forces) = (vec![0.0; count], vec![0.0; count]);
    own.bias_and_forces(point(), &mut bias, &mut forces);
    expected.extend(bias);
    assert_eq!(found.len(), expected.len() + 2);
    for (found, expected) in found.iter().zip(&expected) {
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs().max(1.0),
            "{found} {expected}"
        );
    }
}

// Braces, environments and stretched parentheses are closed in order, no letter has two subscripts, and every
// command is known.
#[test]
fn latex_is_well_formed_for_every_specification() {
    for (name, model) in specifications() {
        check_latex(&report(&model).latex()).unwrap_or_else(|wrong| panic!("{name}: {wrong}"));
    }
    assert!(check_latex("a_{1}_{2}").is_err());
    assert!(check_latex("a_i_j").is_err());
    assert!(check_latex("a_i'^{2}").is_err());
    assert!(check_latex("\\left(a").is_err());
    assert!(check_latex("\\frac{a}{b").is_err());
    assert!(check_latex("\\nosuch{a}").is_err());
    assert!(check_latex("sum_i(a)*b").is_err());
}

/// Commands of the document and of its formulas, which LaTeX or amsmath defines.
const COMMANDS: &str = "documentclass usepackage setlength parindent parskip emergencystretch raggedright everypar \
    everymath hangindent displaystyle frac tfrac sqrt dot ddot left right bigl bigr big \
    sum int varphi xi beta text mathrm mathsf operatorname cdot dots delta le sin cos tan sinh cosh tanh ln min max \
    arcsin arccos arctan alpha gamma epsilon zeta eta theta iota kappa lambda mu nu rho sigma tau upsilon phi chi psi \
    omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega";

fn check_latex(text: &str) -> Result<(), String> {
    let mut open: Vec<String> = Vec::new();
    let mut rest = text;
    let close = |open: &mut Vec<String>, expected: &str| match open.pop() {
        Some(found) if found == expected => Ok(()),
        found => Err(format!("{expected} is closed, {found:?} is open")),
    };
    // For each nesting level: true if the base already has a subscript, and true if it has a superscript.
    let mut scripts: Vec<(bool, bool)> = vec![(false, false)];
    let mut is_script = false;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        match c {
            '%' => rest = rest.split_once('\n').map_or("", |(_, after)| after),
            '\\' => {
                let length = rest
                    .find(|c: char| !c.is_ascii_alphabetic())
                    .unwrap_or(rest.len());
                let (command, after) = rest.split_at(length);
                rest = after;
                match command {
                    "" => rest = &rest[1..],
                    "begin" | "end" => {
                        let environment = after.split(['{', '}']).nth(1).unwrap_or_default();
                        rest = &after[environment.len() + 2..];
                        match command {
                            "begin" => open.push(environment.to_owned()),
                            _ => close(&mut open, environment)?,
                        }
                    }
                    "left" | "bigl" => open.push(command.to_owned()),
                    "right" => close(&mut open, "left")?,
                    "bigr" => close(&mut open, "bigl")?,
                    "section" | "subsection" => rest = after.strip_prefix('*').unwrap_or(after),
                    known if COMMANDS.split_whitespace().any(|word| word == known) => {}
                    unknown => return Err(format!("\\{unknown} is unknown")),
                }
                *scripts.last_mut().unwrap() = (false, false);
            }
            '{' => {
                if !std::mem::take(&mut is_script) {
                    *scripts.last_mut().unwrap() = (false, false);
                }
                open.push("{".to_owned());
                scripts.push((false, false));
            }
            '}' => {
                close(&mut open, "{")?;
                scripts.pop();
            }
            '$' if open.last().is_some_and(|last| last == "$") => close(&mut open, "$")?,
            '$' => open.push("$".to_owned()),
            '_' | '^' => {
                let last = scripts.last_mut().unwrap();
                let has = if c == '_' { &mut last.0 } else { &mut last.1 };
                if std::mem::replace(has, true) {
                    return Err(format!("two of {c} before {}", &rest[..rest.len().min(40)]));
                }
                is_script = rest.starts_with('{');
                // A single letter in a subscript or superscript cannot have its own scripts.
                if let Some(letter) = rest.chars().next().filter(|c| c.is_alphanumeric()) {
                    rest = &rest[letter.len_utf8()..];
                }
            }
            '\'' => scripts.last_mut().unwrap().1 = true,
            '*' => return Err(format!("a star before {}", &rest[..rest.len().min(40)])),
            _ => *scripts.last_mut().unwrap() = (false, false),
        }
    }
    match open.as_slice() {
        [] => Ok(()),
        open => Err(format!("{open:?} stay open")),
    }
}

#[test]
fn latex_contains_accelerations_and_piecewise_functions() {
    let latex = report(&shipped("planetary_arm")).latex();
    for part in [
        "% Needs the package amsmath",
        "\\ddot{x}_{sp} = a_{11} + a_{12}\\,\\dot{x}_{sp}",
        "a_{q0,i}\\,\\ddot{q}_{i} = \\sum_{j} a_{qq,ij}\\,q_{j}",
        "\\operatorname{deadzone}(p, b) = \\begin{cases} p - b & p > b",
        "\\operatorname{contact}(p, b) = \\begin{cases} 1 & |p| > b",
    ] {
        assert!(latex.contains(part), "{part} is missing in\n{latex}");
    }
    let title = shipped("pendulum")
        .source
        .text
        .replace("title = \"", "title = \"50 % of_θ ♥ ");
    let title = report(&model(&title)).latex();
    assert!(title.contains("50 \\% of\\_$\\theta$ U+2665 "), "{title}");
}
