//! Controllers of a specification: accepted forms, and errors with their locations.

use eomgen_model_spec::check;
use eomgen_model_spec::model::MeasuredQuantity;
use eomgen_model_spec::source::Source;

const MACHINE: &str = r#"[model]
name = "machine"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 3, unit = "N/m" }
T = { value = 20, unit = "ms" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
v = { unit = "N" }
s = { unit = "m", rates = 2 }
[states]
z = { unit = "N", rate = "(u - z)/T" }
[definitions]
twice = "2*x"
[kinetic]
mass = "1/2*m*dot(x)^2 + 1/2*m*(dot(x) - dot(s))^2"
[forces]
motor = { on = "x", value = "z + v" }
[observables]
length = "twice"
"#;

fn read(controllers: &str) -> Result<eomgen_model_spec::model::Model, String> {
    let source = Source::new("machine.toml", MACHINE.to_owned() + controllers);
    let checked = check(source).map_err(|found| found.render(false));
    checked.map(|checked| checked.model)
}

#[test]
fn times_have_units_or_are_in_seconds() {
    for (time, right) in [
        ("{ value = 1, unit = \"ms\" }", 0.001),
        ("0.25", 0.25),
        ("\"T\"", 0.02),
        ("\"2*T\"", 0.04),
        ("{ value = \"T/2\" }", 0.01),
    ] {
        let model = read(&format!(
            "[controllers.c]\nperiod = {time}\noffset = {time}\noutputs = {{ u = \"-k*x\" }}\n"
        ));
        let model = model.unwrap_or_else(|error| panic!("{time}: {error}"));
        let values = model.parameter_values().expect("values");
        let schedule = model.controllers[0].schedule(&values).expect("times");
        assert!(
            (schedule.period - right).abs() < 1e-15,
            "{time}: {schedule:?}"
        );
        assert!((schedule.offset - right).abs() < 1e-15 && schedule.delay == 0.0);
    }
}

#[test]
fn measured_quantities_of_expressions_are_resolved() {
    let model = read(
        r#"[controllers.c]
period = 0.5
states = { old = { unit = "N", next = "u", initial = 0.5 } }
outputs = { u = { value = "quantise(clamp(k*x + 2*old - z, -k*length, k*length), k*x/4)" }, v = "m*dot(x)/period" }
"#,
    );
    let model = model.unwrap_or_else(|error| panic!("{error}"));
    let controller = &model.controllers[0];
    // Each quantity is listed once.
    let kind = |quantity: &MeasuredQuantity| match quantity {
        MeasuredQuantity::Parameter(_) => "parameter",
        MeasuredQuantity::Coordinate(_) => "coordinate",
        MeasuredQuantity::CoordinateRate(_) => "rate",
        MeasuredQuantity::Own(0) => "own state",
        MeasuredQuantity::State(_) => "state",
        MeasuredQuantity::Observable(name) if name == "length" => "observable",
        MeasuredQuantity::Input(_) => "input",
        MeasuredQuantity::Period => "period",
        other => panic!("{other:?}"),
    };
    let mut kinds: Vec<&str> = controller.measured.iter().map(kind).collect();
    kinds.sort_unstable();
    let right = [
        "coordinate",
        "input",
        "observable",
        "own state",
        "parameter",
        "parameter",
        "period",
        "rate",
        "state",
    ];
    assert_eq!(kinds, right);
    assert_eq!(controller.expressions().count(), 3);
    assert_eq!(model.controller_states()[0].0, "old");
    assert!(model.is_controlled(0) && model.is_controlled(1) && !model.is_controlled(2));
}

#[test]
fn mistakes_are_rejected_with_their_place() {
    let controller = |rest: &str| format!("[controllers.c]\nperiod = 0.1\n{rest}\n");
    let output = |value: &str| controller(&format!("outputs = {{ u = \"{value}\" }}"));
    let line = MACHINE.lines().count() + 1;
    for (controllers, place, parts) in [
        (
            "[controllers.c]\noutputs = { u = \"k*x\" }\n".to_owned(),
            0,
            &["has no `period`"][..],
        ),
        (
            output("k*x").replace("0.1", "0"),
            1,
            &["the period of the controller `c` is 0 s", "above 0"],
        ),
        (
            output("k*x").replace("0.1", "\"T - 1\""),
            1,
            &["a pure number", "in s"],
        ),
        (
            output("k*x").replace("0.1", "{ value = 1, unit = \"mm\" }"),
            1,
            &["`mm` is not a unit of time"],
        ),
        (
            output("k*x").replace("0.1", "\"x\""),
            1,
            &["`x` cannot be used here", "a coordinate"],
        ),
        (
            output("k*x").replace("period", "offset = -1\nperiod"),
            1,
            &["the offset of the controller `c` is -1 s"],
        ),
        (
            output("k*x").replace("period", "delay = \"-T\"\nperiod"),
            1,
            &["the delay of the controller `c` is -0.02 s"],
        ),
        (
            output("k*x").replace("period", "perid = 1\nperiod"),
            1,
            &["unknown key `perid`", "period"],
        ),
        (
            controller(""),
            0,
            &["the controller `c` has no `states` and no `outputs`"],
        ),
        (
            controller("outputs = { x = \"x\" }"),
            2,
            &[
                "a controller cannot write `x`",
                "this is a coordinate",
                "the inputs are u, v",
            ],
        ),
        (
            controller("outputs = { z = \"k*x\" }"),
            2,
            &["a controller cannot write `z`", "this is a state"],
        ),
        (
            controller("outputs = { w = \"k*x\" }"),
            2,
            &["the model has no input `w`"],
        ),
        (
            controller("outputs = { s = \"x\" }"),
            2,
            &["`s` is prescribed motion"],
        ),
        (
            controller("outputs = { s_dot = \"dot(x)\" }"),
            2,
            &["`s_dot` is prescribed motion"],
        ),
        (
            output("k*x") + "[controllers.d]\nperiod = 1\noutputs = { u = \"k*x\" }\n",
            5,
            &["two controllers drive the input `u`", "the first one"],
        ),
        (output("x"), 2, &["the output `u` is in m, expected in N"]),
        (
            output("clamp(k*x, -1, 1)"),
            2,
            &["compared in one call with"],
        ),
        (
            output("quantise(k*x, x)"),
            2,
            &["compared in one call with"],
        ),
        (
            output("clamp(k*x, k*x)"),
            2,
            &["`clamp` does not accept 2 arguments", "clamp(x, low, high)"],
        ),
        (
            output("k*clamp(x/length, 1, -1/2)"),
            2,
            &[
                "above the upper limit",
                "1 is above -0.5",
                "clamp(x, -0.5, 1)",
            ],
        ),
        (output("k*xx"), 2, &["unknown name `xx`"]),
        (
            output("k*twice"),
            2,
            &["`twice` is not measured", "[observables]"],
        ),
        (output("m*x_dot"), 2, &["write dot(x)"]),
        (output("dot(z)"), 2, &["this rate is not measured"]),
        (
            output("clap(k*x, k*x, k*x)"),
            2,
            &["unknown function `clap`", "clamp"],
        ),
        (
            output("sum(i, w, k*x)"),
            2,
            &["a controller cannot use `sum`"],
        ),
        (
            controller("states = { e = { unit = \"m s\", next = \"e + x\" } }"),
            2,
            &["a quantity in m is added to a quantity in m s"],
        ),
        (
            controller("states = { e = { unit = \"m\", next = \"x*period\" } }"),
            2,
            &["the next value of `e`"],
        ),
        (
            controller("states = { e = { unit = \"m\" } }"),
            2,
            &["`e` has no `next`"],
        ),
        (
            controller("states = { x = { unit = \"m\", next = \"x\" } }"),
            2,
            &["the name `x` is taken"],
        ),
        (
            controller("states = { e = { unit = \"m\", next = \"x\" } }")
                + "[controllers.d]\nperiod = 1\noutputs = { u = \"k*e\" }\n",
            5,
            &["`e` is a state of another controller"],
        ),
    ] {
        let message = read(&controllers)
            .err()
            .unwrap_or_else(|| panic!("accepted:\n{controllers}"));
        let at = format!("machine.toml:{}:", line + place);
        for part in parts.iter().copied().chain([&*at]) {
            assert!(
                message.contains(part),
                "{part} is missing for\n{controllers}\n{message}"
            );
        }
    }
    // Expressions of the model cannot use states of controllers or the function `clamp`.
    let seen = MACHINE.replace("z + v", "z + v + k*e")
        + &controller("states = { e = { unit = \"m\", next = \"x\" } }");
    let message = check(Source::new("machine.toml", seen))
        .err()
        .map(|found| found.render(false));
    let message = message.unwrap_or_default();
    assert!(
        message.contains("this is a state of a controller"),
        "{message}"
    );
}
