//! Tests of the bounds of rounding errors: no error of a shipped or random machine at random points exceeds the bound,
//! and missing bounds have a reason.

use std::collections::BTreeSet;
use std::fmt::Write;

use eomgen_codegen::program::{Op, Program};
use eomgen_codegen::rounding::{
    Format, RoundingBound, ScalarOp, Scalars, bound_quantities, quantities,
};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::function::Function;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::{load, project, shipped_specifications};
use eomgen_tests::program::eomgen;
use eomgen_validate::oracle::Oracle;
use eomgen_validate::random::Random;
use eomgen_validate::rounding::VariableRanges;
use eomgen_validate::rounding::samples::ErrorSampler;

const ORDER: usize = 2;

fn derive(model: &Model) -> Program {
    let orders = vec![ORDER; model.fields.len()];
    Variant::derive(model, &orders)
        .expect("the model can be derived")
        .program
}

fn check(text: &str) -> Model {
    eomgen_model_spec::check(Source::new("drawn.toml", text))
        .expect(text)
        .model
}

/// Returns the ranges of the certificate's random states.
fn typical_ranges(model: &Model, program: &Program) -> VariableRanges {
    let values = model
        .parameter_values()
        .expect("the parameters have values");
    let order = model.fields.first().map_or(0, |_| ORDER);
    let oracle = Oracle::new(model, order, &values).expect("the oracle supports the model");
    let mut ranges = VariableRanges::from_model(model, program).expect("values");
    ranges
        .fill_missing(&oracle)
        .expect("the oracle supports the model");
    ranges
}

/// Asserts that no error at `count` points exceeds its bound, and returns the bounds.
fn assert_bounded(program: &Program, ranges: &VariableRanges, count: usize) -> Vec<RoundingBound> {
    let mut all = Vec::new();
    for format in Format::ALL {
        let bounds = bound_quantities(program, format, ranges.ranges());
        let mut sampler = ErrorSampler::new(program, format, ranges.ranges());
        let mut random = Random::new(7);
        for _ in 0..count {
            sampler
                .draw(&mut random)
                .expect("the bits of the evaluator");
        }
        // The computed and the exact value of a point may be on different sides of a jump.
        assert!(
            count == 1 || sampler.compared() > 0,
            "{}: no point compared",
            program.name
        );
        for (found, error) in bounds.iter().zip(sampler.largest_errors()) {
            let bound = found.bound.as_ref().copied().unwrap_or(f64::INFINITY);
            assert!(
                *error <= bound,
                "{} of {} in {}: error {error:e}, bound {bound:e}",
                found.quantity.name,
                program.name,
                format.name()
            );
        }
        all.extend(bounds);
    }
    all
}

fn reason<'b>(bounds: &'b [RoundingBound], name: &str) -> &'b str {
    let found = bounds.iter().find(|bound| bound.quantity.name == name);
    match &found.expect("the quantity").bound {
        Ok(bound) => panic!("{name} has the bound {bound:e}"),
        Err(reason) => reason,
    }
}

fn bound(bounds: &[RoundingBound], name: &str) -> f64 {
    let found = bounds.iter().find(|bound| bound.quantity.name == name);
    *found
        .expect("the quantity")
        .bound
        .as_ref()
        .expect("a bound")
}

#[test]
fn errors_of_shipped_machines_stay_within_their_bounds() {
    for path in shipped_specifications() {
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let model = load(&name);
        let program = derive(&model);
        let ranges = typical_ranges(&model, &program);
        let bounds = assert_bounded(&program, &ranges, 60);
        for found in bounds {
            let name = &found.quantity.name;
            let is_rate = name.starts_with("rates");
            assert!(is_rate || found.bound.is_ok(), "{name}: {:?}", found.bound);
        }
    }
}

/// Name of an operation, and a function that recognises it.
type Kind = (&'static str, fn(&Op) -> bool);

const OPERATIONS: [Kind; 11] = [
    ("Negate", |op| matches!(op, Op::Negate(_))),
    ("Divide", |op| matches!(op, Op::Divide(..))),
    ("Power", |op| matches!(op, Op::Power(..))),
    ("Select", |op| matches!(op, Op::Select { .. })),
    ("PivotReciprocal", |op| matches!(op, Op::PivotReciprocal(_))),
    ("Total", |op| matches!(op, Op::Total(_))),
    ("Apply", |op| matches!(op, Op::Apply { .. })),
    ("Gram", |op| matches!(op, Op::Gram { .. })),
    ("Assemble", |op| matches!(op, Op::Assemble { .. })),
    ("Cholesky", |op| matches!(op, Op::Cholesky(_))),
    ("CholeskySolve", |op| matches!(op, Op::CholeskySolve(..))),
];

const FUNCTIONS: [Function; 16] = [
    Function::Sin,
    Function::Cos,
    Function::Tan,
    Function::Asin,
    Function::Acos,
    Function::Atan,
    Function::Atan2,
    Function::Sinh,
    Function::Cosh,
    Function::Tanh,
    Function::Exp,
    Function::Ln,
    Function::Sqrt,
    Function::Abs,
    Function::Sign,
    Function::Deadzone,
];

#[test]
fn features_cover_every_operation() {
    let mut found = BTreeSet::new();
    let features = std::fs::read_dir(project().join("tests/features")).expect("the features");
    let mut paths: Vec<_> = features
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.extend(shipped_specifications());
    for path in paths {
        let model = eomgen_model_spec::load(&path)
            .expect("a specification")
            .model;
        let Ok(orders) = model.orders(None) else {
            continue;
        };
        let orders: Vec<usize> = orders.iter().map(|order| (*order).min(ORDER)).collect();
        let Ok(variant) = Variant::derive(&model, &orders) else {
            continue;
        };
        let program = variant.program;
        let quantities = quantities(&program);
        let roots: Vec<_> = quantities.iter().map(|quantity| quantity.value).collect();
        for id in program.reachable(&roots) {
            let op = &program.value(id).op;
            let own = OPERATIONS.iter().filter(|(_, is_kind)| is_kind(op));
            found.extend(own.map(|(name, _)| *name));
        }
        // All functions are defined at this state.
        let mut ranges = VariableRanges::from_model(&model, &program).expect("values");
        let near: Vec<f64> = (0..program.states() + program.inputs.len())
            .map(|place| 0.01 * (1.0 + (place as f64 * 0.37).fract()))
            .collect();
        let (state, inputs) = near.split_at(program.states());
        ranges.set_point(0.5, state, inputs);
        assert_bounded(&program, &ranges, 1);
    }
    for (name, _) in OPERATIONS {
        assert!(found.contains(name), "no model with {name}");
    }
}

/// Returns the functions that the quantities of a program depend on.
fn functions_of(program: &Program) -> Vec<String> {
    let quantities = quantities(program);
    let roots: Vec<_> = quantities.iter().map(|quantity| quantity.value).collect();
    let scalars = Scalars::record(program, &roots, Format::Double).list;
    let functions = scalars.iter().filter_map(|scalar| match scalar.op {
        ScalarOp::Call(function, ..) => Some(format!("{function:?}")),
        _ => None,
    });
    functions.collect()
}

/// Draws a random expression of x, y and numbers that is defined for |x|, |y| <= 1.
fn draw_expression(random: &mut Random, depth: usize) -> String {
    const LEAVES: [&str; 4] = ["x/d", "y/d", "0.7", "1.3"];
    const UNARY: [&str; 17] = [
        "sin(A)",
        "cos(A)",
        "tan(A/9)",
        "asin(tanh(A)/2)",
        "acos(tanh(A)/2)",
        "atan(A)",
        "sinh(tanh(A))",
        "cosh(tanh(A))",
        "tanh(A)",
        "exp(tanh(A))",
        "ln(2 + tanh(A))",
        "sqrt(1 + A^2)",
        "abs(A)^3",
        "(2 + tanh(A))^1.7",
        "A^3/9",
        "-A",
        "1/(2 + sin(A))",
    ];
    const BINARY: [&str; 10] = [
        "(A + B)",
        "(A - B)",
        "A*B",
        "A/(3 + tanh(B))",
        "max(A, B)^2",
        "min(A, B)^2",
        "atan2(A, 2 + tanh(B))",
        "deadzone(A, 0.3)^2*B",
        "(2 + tanh(A))^(B/9)",
        "above(A)*A^2*B",
    ];
    if depth == 0 {
        return random.pick(&LEAVES).unwrap_or(&"0.7").to_string();
    }
    let first = draw_expression(random, depth - 1);
    if random.unit() < 0.4 {
        let form = random.pick(&UNARY).unwrap_or(&"-A");
        return form.replace('A', &format!("({first})"));
    }
    let second = draw_expression(random, depth - 1);
    let form = random.pick(&BINARY).unwrap_or(&"A*B");
    let form = form
        .replace('A', "\u{1}")
        .replace('B', &format!("({second})"));
    form.replace('\u{1}', &format!("({first})"))
}

#[test]
fn errors_of_random_machines_stay_within_their_bounds() {
    let mut random = Random::new(11);
    let mut bounded = 0;
    let mut functions = BTreeSet::new();
    for _ in 0..60 {
        let mut text = String::from(
            "[model]\nname = \"drawn\"\n[parameters]\nm = { value = 0.7, unit = \"kg\" }\nd = { value = 1.1, unit = \"m\" }\n\
             V = { value = 2.3, unit = \"J\" }\nF = { value = 0.4, unit = \"N\" }\n[coordinates]\n\
             x = { unit = \"m\", range = [-1, 1] }\ny = { unit = \"m\", range = [-0.3, 1] }\n[kinetic]\n",
        );
        let mass = draw_expression(&mut random, 2);
        let _ = writeln!(
            text,
            "moving = \"1/2*m*dot(x)^2 + m*dot(y)^2 + 0.4*m*tanh({mass})*dot(x)*dot(y)\"\n[potential]"
        );
        let _ = writeln!(
            text,
            "all = \"V*({})\"\n[forces]",
            draw_expression(&mut random, 3)
        );
        let _ = writeln!(
            text,
            "push = {{ on = \"x\", value = \"F*({})\" }}",
            draw_expression(&mut random, 3)
        );
        let Ok(checked) = eomgen_model_spec::check(Source::new("drawn.toml", text.as_str())) else {
            continue;
        };
        let Ok(variant) = Variant::derive(&checked.model, &[]) else {
            continue;
        };
        let program = variant.program;
        let mut ranges = VariableRanges::from_model(&checked.model, &program).expect("values");
        for rate in ["x_dot", "y_dot"] {
            ranges.set(rate, -2.0, 3.0).expect("a range");
        }
        ranges.set("m", 0.6, 0.8).expect("a range");
        let found = assert_bounded(&program, &ranges, 200);
        functions.extend(functions_of(&program));
        bounded += found.iter().filter(|bound| bound.bound.is_ok()).count();
    }
    assert!(bounded > 300, "only {bounded} bounds");
    for function in FUNCTIONS {
        let name = format!("{function:?}");
        assert!(functions.contains(&name), "no machine with {name}");
    }
}

const INDUCTANCE: &str = r#"
[model]
name = "valve"
[parameters]
m = { value = 2, unit = "kg" }
h = { value = 3, unit = "kg/m" }
k = { value = 4, unit = "N/m" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*(m + h*x)*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
push = { on = "x", value = "u" }
"#;

#[test]
fn missing_ranges_are_named() {
    let model = check(INDUCTANCE);
    let program = derive(&model);
    let mut ranges = VariableRanges::from_model(&model, &program).expect("values");
    ranges.set("x", -0.1, 0.1).expect("a range");
    let bounds = bound_quantities(&program, Format::Double, ranges.ranges());
    assert!(bound(&bounds, "mass_matrix[x, x]") > 0.0);
    let missing = reason(&bounds, "velocity_terms[x]");
    assert_eq!(
        missing,
        "`x_dot` has no range; declare it with `--range x_dot=LOW:HIGH`"
    );
    assert!(reason(&bounds, "forces[x]").contains("--range u=LOW:HIGH"));
}

#[test]
fn pivots_must_be_proven_positive() {
    let model = check(INDUCTANCE);
    let program = derive(&model);
    let mut ranges = VariableRanges::from_model(&model, &program).expect("values");
    for name in ["x_dot", "u"] {
        ranges.set(name, -1.0, 1.0).expect("a range");
    }
    ranges.set("x", -1.0, 1.0).expect("a range");
    let bounds = assert_bounded(&program, &ranges, 100);
    let missing = reason(&bounds, "rates[x_dot]");
    assert!(
        missing.starts_with("a pivot of the mass matrix is not proven positive: it is between -"),
        "{missing}"
    );
    assert!(bound(&bounds, "forces[x]") > 0.0);
    ranges.set("x", -0.5, 1.0).expect("a range");
    let bounds = assert_bounded(&program, &ranges, 100);
    assert!(bound(&bounds, "rates[x_dot]") > 0.0);
}

#[test]
fn bounds_at_single_states_are_tight() {
    let model = load("puma_560");
    let program = derive(&model);
    let mut ranges = typical_ranges(&model, &program);
    let state: Vec<f64> = (0..program.states())
        .map(|place| 0.1 + 0.07 * place as f64)
        .collect();
    let inputs = vec![0.5; program.inputs.len()];
    ranges.set_point(0.0, &state, &inputs);
    for found in assert_bounded(&program, &ranges, 1) {
        let bound = found.bound.as_ref().expect("a bound");
        let limit = match found.format {
            Format::Double => 1e-10,
            Format::Single => 2e-2,
        };
        assert!(*bound < limit, "{}: {bound:e}", found.quantity.name);
    }
}

#[test]
fn invalid_ranges_are_rejected() {
    let model = check(INDUCTANCE);
    let program = derive(&model);
    let mut ranges = VariableRanges::from_model(&model, &program).expect("values");
    for (name, low, high, said) in [
        ("x", f64::NAN, 1.0, "is not finite"),
        ("x", 0.0, f64::INFINITY, "is not finite"),
        ("x", 1.0, 0.0, "exchange the ends"),
        ("z", 0.0, 1.0, "the variables are t, x, x_dot, u, m, h, k"),
    ] {
        let message = ranges.set(name, low, high).expect_err("invalid");
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn certificate_contains_requested_bounds() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("valve.toml");
    std::fs::write(&spec, INDUCTANCE).expect("writable");
    let run = |options: &[&str]| {
        let mut command = eomgen();
        command.arg("validate").arg(&spec).args(options);
        command.output().expect("it runs")
    };
    let output = run(&[
        "--bounds",
        "--range",
        "x=-10 cm:0.1",
        "--range",
        "x_dot=-1:1",
        "--range",
        "u=5",
        "--range",
        "k=3:5",
        "--json",
    ]);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let bounds = &document["bounds"];
    let ranges = bounds["ranges"].as_array().expect("ranges");
    let named = |name: &str| {
        let found = ranges.iter().find(|range| range["name"] == name);
        let found = found.expect("the range");
        [&found["low"], &found["high"]].map(|end| end.as_f64().expect("a number"))
    };
    assert_eq!(named("x"), [-0.1, 0.1]);
    assert_eq!(named("u"), [5.0, 5.0]);
    assert_eq!(named("k"), [3.0, 5.0]);
    let quantities = bounds["quantities"].as_array().expect("quantities");
    assert_eq!(quantities.len(), 8);
    for quantity in quantities {
        assert!(
            quantity["bound"].as_f64().is_some_and(|bound| bound < 1e-4),
            "{quantity}"
        );
        assert_eq!(quantity["reason"], serde_json::Value::Null);
    }
    assert_eq!(quantities[0]["unit"], "kg");
    let at = run(&["--bounds", "--state", "x=0.2"]);
    let said = String::from_utf8_lossy(&at.stdout).into_owned();
    assert!(said.contains("rounding errors, at most\n"), "{said}");
    assert!(!said.contains("not bounded"), "{said}");
    for (option, said) in [
        ("x=1:0", "exchange the ends"),
        ("x=nan:1", "nan"),
        ("x", "expected NAME=LOW:HIGH"),
        ("q=0:1", "no state and no input `q`"),
    ] {
        let output = run(&["--bounds", "--range", option]);
        assert_eq!(output.status.code(), Some(2), "{option}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(said), "{message}");
    }
}
