//! Meaning of valid specifications: values, units, orders, names, warnings.

use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::Severity;
use eomgen_model_spec::ids::{CoordinateId, FieldId, ObservableId};
use eomgen_model_spec::model::{CoefficientKind, ExprKind, MAX_ORDER, Model, Ordinate};
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;

const BEAM: &str = r#"[model]
name = "beam"

[parameters]
EI = { value = "E*I", unit = "N m^2" }
E = { value = 200, unit = "GPa", min = 1, max = 300 }
I = { value = 1000, unit = "mm^4" }
mu = { value = 0.8, unit = "kg/m" }
l = { value = 500, unit = "mm" }

[coordinates]
theta = { unit = "rad", initial = 0.25, initial_rate = "sqrt(EI/(mu*l^4))" }

[inputs]
u = { unit = "N m" }

[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 2
unit = "m"

[definitions]
torque = "u - 0"

[kinetic]
beam = "1/2*integral(mu*(x*dot(theta) + dot(w))^2, w)"

[potential]
bending = { value = "1/2*integral(EI*diff(diff(w, x), x)^2, w)", doc = "bending", source = "Eq. (21)" }

[forces]
motor = { on = "theta", value = "torque" }

[observables]
torque = "torque"
slope_rate = "at(dot(diff(w, x)), l)"
modal = "sum(i, w, dot(q[i])*at(phi[i], l))"

[coefficients]
h = { each = "w[i]", value = "integral(mu*x*phi[i], w)" }
total = "sum(i, w, h^2)"
stiffness = { of = "q", by = "q", times = "h" }

[sensors.theta_dot]
gain = 1.01
delay = -0.001
"#;

fn checked(text: &str) -> Checked {
    eomgen_model_spec::check(Source::new("test.toml", text))
        .unwrap_or_else(|found| panic!("{found}"))
}

fn refused(text: &str) -> String {
    let found = eomgen_model_spec::check(Source::new("test.toml", text)).expect_err("not a model");
    found.render(false)
}

fn value(model: &Model, name: &str) -> f64 {
    let index = model
        .parameters
        .iter()
        .position(|parameter| parameter.name == name);
    model.parameter_values().expect("finite")[index.expect(name)]
}

const ACTUATED: &str = r#"[model]
name = "actuated"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
tau = { value = 20, unit = "ms" }
[coordinates]
x = { unit = "m", initial_rate = 3 }
[inputs]
u = { unit = "N" }
[states]
lag = { unit = "N s", rate = "abs(z) - dot(z)*tau", initial = 0.25 }
z = { unit = "N", rate = "(command - max(z, 0))/tau", initial = "k*l" }
[definitions]
command = "u + k*x - m*dot(x)/tau"
both = "z + k*x"
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
actuator = { on = "x", value = "z + tau*dot(both)" }
[observables]
slope = "dot(z)"
[sensors.z]
gain = 1.01
"#;

#[test]
fn states_of_first_order_are_last_in_the_state() {
    let text = ACTUATED.replace(
        "[coordinates]",
        "l = { value = 30, unit = \"mm\" }\n[coordinates]",
    );
    let checked = checked(&text);
    let model = &checked.model;
    assert_eq!(model.state_names(&[]), ["x", "x_dot", "lag", "z"]);
    assert_eq!(
        model.initial_state(&[]).expect("numbers"),
        [0.0, 3.0, 0.25, 1.5]
    );
    let unit = model.observables[ObservableId::new(0)].unit.to_string();
    assert_eq!(model.observables[ObservableId::new(0)].name, "slope");
    assert!(["N/s", "kg m/s^3"].contains(&unit.as_str()), "{unit}");
    assert!(
        checked.warnings.is_empty(),
        "{}",
        checked.warnings.render(false)
    );
}

#[test]
fn chained_rates_of_states_have_limited_depth() {
    let chain = |count: usize| {
        let states = (1..count).map(|k| {
            let before = k - 1;
            format!("z_{k} = {{ unit = \"N\", rate = \"dot(d_{before})\" }}\n")
        });
        let definitions = (0..count).map(|k| format!("d_{k} = \"2*z_{k}\"\n"));
        let first = "z_0 = { unit = \"N\", rate = \"u*m/(m*s)\" }\n";
        ACTUATED
            .replace("lag = ", "other = ")
            .replace(
                "tau = { value",
                "l = { value = 1, unit = \"m\" }\ns = { value = 1, unit = \"s\" }\ntau = { value",
            )
            .replace(
                "[definitions]\n",
                &format!("[definitions]\n{}", definitions.collect::<String>()),
            )
            .replace(
                "[states]\n",
                &format!("[states]\n{first}{}", states.collect::<String>()),
            )
    };
    checked(&chain(50));
    let shown = refused(&chain(1000));
    assert!(shown.contains("deep"), "{shown}");
    let circle = chain(1000).replace("\"u*m/(m*s)\"", "\"dot(d_999)\"");
    let shown = refused(&circle);
    assert!(
        shown.contains("the rate of the state `z_0` refers to itself"),
        "{shown}"
    );
}

#[test]
fn values_are_in_si_and_follow_their_references() {
    let model = checked(BEAM).model;
    assert_eq!(value(&model, "E"), 2e11);
    assert_eq!(value(&model, "I"), 1e-9);
    assert_eq!(value(&model, "EI"), 2e11 * 1e-9);
    let softer = model.with_parameter("E", 100.0).expect("within its bounds");
    assert_eq!(value(&softer, "EI"), 1e11 * 1e-9);
    let fixed = model
        .with_parameter("EI", 50.0)
        .expect("replaces the expression");
    assert_eq!(value(&fixed, "EI"), 50.0);
    let state = fixed.initial_state(&[1]).expect("finite");
    // sqrt(EI/(mu l^4)) = sqrt(50/(0.8/16)), one rounding per operation.
    let rate = (50.0_f64 / (0.8 / 16.0)).sqrt();
    assert_eq!((state.len(), state[0], state[1]), (4, 0.25, 0.0));
    assert!((state[2] - rate).abs() <= 8.0 * f64::EPSILON * rate);
}

#[test]
fn settings_are_checked_together_in_any_order() {
    // If only one of the two parameters were set, the domain from a to l would be empty.
    let text = BEAM.replace("from = 0", "from = \"a\"").replace(
        "[coordinates]",
        "a = { value = 100, unit = \"mm\" }\n\n[coordinates]",
    );
    let model = checked(&text).model;
    for settings in [[("a", 600.0), ("l", 900.0)], [("l", 900.0), ("a", 600.0)]] {
        let moved = model.with_parameters(&settings);
        assert!(moved.is_ok(), "{settings:?}: {:?}", moved.err());
    }
    assert!(model.with_parameters(&[("a", 600.0)]).is_err());
}

#[test]
fn invalid_settings_are_rejected_with_help() {
    let model = checked(BEAM).model;
    let refused = |name: &str, value: f64| {
        let error = model.with_parameter(name, value).expect_err(name);
        error.to_string()
    };
    assert!(refused("EJ", 1.0).contains("did you mean `EI`?"));
    assert!(refused("E", f64::NAN).contains("cannot be NaN"));
    assert!(refused("E", f64::INFINITY).contains("cannot be inf"));
    assert!(refused("E", 0.5).contains("at least 1 GPa"));
    assert!(refused("E", 301.0).contains("at most 300 GPa"));
    assert!(
        refused("l", 0.0).contains("initial value"),
        "{}",
        refused("l", 0.0)
    );
    assert!(
        refused("l", -1.0).contains("length"),
        "{}",
        refused("l", -1.0)
    );
}

#[test]
fn orders_are_default_or_given() {
    let model = checked(BEAM).model;
    assert_eq!(model.orders(None), Ok(vec![2]));
    assert_eq!(model.orders(Some(0)), Ok(vec![0]));
    assert_eq!(model.orders(Some(MAX_ORDER)), Ok(vec![MAX_ORDER]));
    assert!(model.orders(Some(MAX_ORDER + 1)).is_err());
    let rigid = models::PENDULUM.text;
    let rigid = checked(rigid).model;
    assert_eq!(
        (rigid.orders(None), rigid.orders(Some(0))),
        (Ok(vec![]), Ok(vec![]))
    );
    assert!(rigid.orders(Some(1)).is_err());
    let names = ["theta", "q_1", "q_2", "theta_dot", "q_1_dot", "q_2_dot"];
    assert_eq!(model.state_names(&[2]), names);
}

#[test]
fn units_are_inferred_through_fields_and_sums() {
    let model = checked(BEAM).model;
    let units: Vec<_> = model
        .observables
        .iter()
        .map(|o| o.unit.to_string())
        .collect();
    assert_eq!(units, ["N m", "1/s", "m/s"]);
    assert_eq!(model.definitions[0].unit.to_string(), "N m");
}

#[test]
fn rates_and_derivatives_of_fields_have_one_form() {
    let model = checked(BEAM).model;
    let ExprKind::At { value, .. } = &model.observables[1].value.kind else {
        panic!("a value at a place");
    };
    let ExprKind::Diff(inner, 1) = &value.kind else {
        panic!("a derivative of a rate: {value:?}");
    };
    assert!(matches!(inner.kind, ExprKind::Dot(_)));
    let mut second = 0;
    model.potential[0].value.visit(&mut |part| {
        second += usize::from(matches!(part.kind, ExprKind::Diff(_, 2)));
    });
    assert_eq!(second, 1, "a derivative of a derivative is one of order 2");
}

/// dot(at(...)) and at(dot(...)) resolve to the same form.
#[test]
fn rate_at_a_position_has_one_form() {
    let observables = |value: &str| {
        let text = BEAM.replace(
            "slope_rate = \"at(dot(diff(w, x)), l)\"",
            &format!("slope_rate = \"{value}\""),
        );
        checked(&text).model.observables[1].clone()
    };
    let kind = |value: &str| {
        let observable = observables(value);
        let mut kinds = Vec::new();
        observable
            .value
            .visit(&mut |part| kinds.push(format!("{:?}", std::mem::discriminant(&part.kind))));
        (observable.unit.to_string(), kinds)
    };
    assert_eq!(kind("dot(at(w, l))"), kind("at(dot(w), l)"));
    assert_eq!(
        kind("dot(at(diff(w, x, 1), l))"),
        kind("at(dot(diff(w, x)), l)")
    );
    assert_eq!(kind("dot(at(x*w, l))").0, "m^2/s");
    for (value, wrong) in [
        ("dot(at(dot(w), l))", "acceleration"),
        ("dot(at(x, l))", "without a rate"),
    ] {
        let found = refused(&BEAM.replace("at(dot(diff(w, x)), l)", value));
        assert!(found.contains(wrong), "{value}: {found}");
    }
}

/// No expression refers to terms and forces, so any word is valid.
#[test]
fn terms_accept_reserved_names() {
    for name in [
        "t", "energy", "loop", "power", "fn", "sin", "pi", "dot", "theta", "q_1",
    ] {
        let text = BEAM
            .replace("beam = \"1/2", &format!("{name} = \"1/2"))
            .replace("bending = {", &format!("{name} = {{"))
            .replace("motor = {", &format!("{name} = {{"));
        let model = checked(&text).model;
        assert_eq!(
            (&*model.kinetic[0].name, &*model.forces[0].name),
            (name, name)
        );
    }
    assert!(refused(&BEAM.replace("motor = {", "\"mo tor\" = {")).contains("cannot be a name"));
    assert!(
        refused(&BEAM.replace("torque = \"u - 0\"", "loop = \"u - 0\""))
            .contains("cannot be a name")
    );
}

#[test]
fn unused_parameters_take_one_line() {
    let more = "[parameters]\ng = { value = 9.81, unit = \"m/s^2\" }\nh_2 = { value = 1 }\n";
    let warnings = checked(&BEAM.replace("[parameters]\n", more)).warnings;
    let shown = warnings.render(false);
    assert_eq!(shown.lines().count(), 1, "{shown}");
    assert!(
        shown.starts_with("warning: the specification does not use the parameters `g`, `h_2` ("),
        "{shown}"
    );
    assert!(shown.ends_with(":5:1, 6:1)"), "{shown}");
    let places: Vec<_> = warnings
        .records()
        .iter()
        .map(|record| record.line)
        .collect();
    assert_eq!(places, [Some(5), Some(6)]);
}

#[test]
fn unknown_parameter_suggests_similar_names() {
    let model = checked(BEAM).model;
    for (name, help) in [
        ("Ei", "did you mean `EI`?"),
        ("beam_mu", "did you mean one of `mu`"),
        ("theta", "`theta` is a coordinate"),
        ("stiffness", "the parameters are `EI`, `E`, `I`, `mu`, `l`"),
    ] {
        let error = model
            .with_parameter(name, 1.0)
            .expect_err("no such parameter");
        assert!(error.to_string().contains(help), "{name}: {error}");
    }
}

#[test]
fn coefficients_of_modes_have_their_field() {
    let model = checked(BEAM).model;
    assert_eq!(model.coefficients[0].each, Some(FieldId::new(0)));
    assert!(matches!(
        &model.coefficients[2].kind,
        CoefficientKind::Factor { of, times: Some(_), .. } if of.kind == ExprKind::ModeCoordinate(FieldId::new(0))
    ));
    let outside = refused(&BEAM.replace("\"sum(i, w, h^2)\"", "\"h^2\""));
    assert!(outside.contains("exists for each mode of `w`"), "{outside}");
}

#[test]
fn origins_and_sensors_are_kept() {
    let model = checked(BEAM).model;
    assert_eq!(
        (
            model.potential[0].doc.as_str(),
            model.potential[0].origin.as_str()
        ),
        ("bending", "Eq. (21)")
    );
    let sensor = &model.sensors[0];
    assert_eq!(
        (
            sensor.channel.as_str(),
            sensor.gain,
            sensor.bias,
            sensor.delay
        ),
        ("theta_dot", 1.01, 0.0, -0.001)
    );
}

#[test]
fn unused_names_give_warnings() {
    assert!(checked(BEAM).warnings.is_empty());
    let text = BEAM
        .replace("[inputs]\n", "[inputs]\nv = { unit = \"N\" }\n")
        .replace(
            "[definitions]\n",
            "[definitions]\nsum_of_angles = \"2*theta\"\n",
        )
        .replace(
            "[parameters]\n",
            "[parameters]\ng = { value = 9.81, unit = \"m/s^2\" }\n",
        );
    let warnings = checked(&text).warnings;
    let records = warnings.records();
    let messages: Vec<_> = records
        .iter()
        .map(|record| record.message.as_str())
        .collect();
    let expected = [
        "the specification does not use the parameter `g`",
        "the specification does not use the input `v`",
        "the specification does not use the definition `sum_of_angles`",
    ];
    assert_eq!(messages, expected);
    assert!(
        records
            .iter()
            .all(|record| record.severity == Severity::Warning)
    );
    assert_eq!((records[0].line, records[0].column), (Some(5), Some(1)));
}

#[test]
fn observables_are_rejected_in_expressions() {
    let text = BEAM.replace("modal = ", "twice = \"2*slope_rate\"\nmodal = ");
    assert!(refused(&text).contains("move the expression to [definitions]"));
}

#[test]
fn positions_are_right_with_carriage_returns_and_byte_order_mark() {
    let broken = BEAM.replace("x*dot(theta)", "x*dot(thetta)");
    let line = BEAM
        .lines()
        .position(|line| line.starts_with("beam ="))
        .expect("there")
        + 1;
    let column = r#"beam = "1/2*integral(mu*(x*dot("#.len() + 1;
    let place = format!("test.toml:{line}:{column}");
    for text in [
        broken.clone(),
        broken.replace('\n', "\r\n"),
        format!("\u{feff}{broken}"),
    ] {
        let shown = refused(&text);
        assert!(
            shown.contains(&place) && shown.contains("^^^^^^ not declared"),
            "{shown}"
        );
    }
}

const SPEAKER: &str = r#"[model]
name = "speaker"

[parameters]
m = { value = 10, unit = "g" }
b = { value = 5, unit = "mm" }
F = { value = 8, unit = "N" }

[coordinates]
y = { unit = "m" }
x = { unit = "m", initial = 0.001, range = ["-b", 0.004] }

[inputs]
u = { unit = "N", range = ["-2*F", "F*sqrt(2)"] }

[kinetic]
masses = "1/2*m*(dot(x)^2 + dot(y)^2)"

[forces]
coil = { on = "x", value = "u" }
"#;

#[test]
fn coordinates_and_inputs_have_ranges() {
    let model = checked(SPEAKER).model;
    let ranges = model.coordinate_ranges().expect("values");
    assert_eq!(ranges, [None, Some((-0.005, 0.004))]);
    let ranges = model.input_ranges().expect("values");
    assert_eq!(ranges, [Some((-16.0, 8.0 * 2.0_f64.sqrt()))]);
}

#[test]
fn parameter_with_initial_value_outside_range_is_rejected() {
    let text = SPEAKER.replace("[\"-b\", 0.004]", "[0, \"b\"]");
    let model = checked(&text).model;
    let error = model.with_parameter("b", 0.5).expect_err("0.5 mm");
    assert_eq!(
        error.message,
        "the initial value 0.001 of `x` is outside its range 0 to 0.0005"
    );
    assert!(error.span.is_some());
    let error = model.with_parameter("b", -5.0).expect_err("upside down");
    assert!(
        error.message.contains("evaluates to 0 to -0.005"),
        "{error}"
    );
}

#[test]
fn points_are_placed_by_numbers_coordinates_and_observables() {
    let text = "[model]\nname = \"a\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
        [coordinates]\nx = { unit = \"m\" }\n[kinetic]\nmass = \"1/2*m*dot(x)^2\"\n\
        [observables]\nspeed = \"dot(x)\"\ntwice = \"2*x\"\n\
        [drawing.lines]\nrope = [\"tip\", \"origin\", \"tip\"]\n\
        [drawing.points]\ntip = { x = \"twice\", y = -0.5 }\nend = { x = \"x\", y = 0 }\n";
    let drawing = checked(text).model.drawing.expect("a drawing");
    let names: Vec<&str> = drawing.points.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["origin", "tip", "end"]);
    let [tip, end] = [&drawing.points[1], &drawing.points[2]];
    assert_eq!(tip.x, Ordinate::Observable(ObservableId::new(1)));
    assert_eq!(tip.y, Ordinate::Number(-0.5));
    assert_eq!(end.x, Ordinate::Coordinate(CoordinateId::new(0)));
    let joined: Vec<usize> = drawing.lines[0].points.iter().map(|p| p.index()).collect();
    assert_eq!(joined, [1, 0, 1]);
    let (without, _) = text.split_once("[drawing").expect("a drawing");
    assert!(checked(without).model.drawing.is_none());
}

#[test]
fn initial_value_of_a_state_is_inside_its_range() {
    let state = "[states]\nz = { unit = \"m\", rate = \"dot(x)\", initial = 0.002, range = [\"-b\", 0.004] }\n\n[kinetic]";
    let text = SPEAKER.replace("[kinetic]", state);
    let model = checked(&text).model;
    assert_eq!(
        model.state_ranges().expect("values"),
        [Some((-0.005, 0.004))]
    );
    let outside = text.replace("initial = 0.002", "initial = 0.02");
    let message = refused(&outside);
    assert!(
        message.contains("the initial value 0.02 of `z` is outside its range -0.005 to 0.004"),
        "{message}"
    );
    let wrong = text.replace("[\"-b\", 0.004]", "[\"-b\", \"m\"]");
    assert!(refused(&wrong).contains("the upper end of `z` is in kg"));
}

/// Returns a specification of a mass with a definition `d` and additional sections.
fn with_definition(value: &str, more: &str) -> String {
    format!(
        "[model]\nname = \"m\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\nb = {{ value = 0, unit = \"m\" }}\n\
         k = {{ value = 2, unit = \"N/m\" }}\nn = {{ value = 0 }}\n[coordinates]\nx = {{ unit = \"m\" }}\n\
         [definitions]\nd = \"{value}\"\n[kinetic]\nT = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"1/2*k*x^2\"\n\
         [observables]\nd_seen = \"d\"\n{more}"
    )
}

#[test]
fn constants_without_finite_value_are_rejected_at_their_position() {
    for (value, message, place) in [
        ("1/0", "division by 0", "0\""),
        ("0/0", "division by 0", "0\""),
        ("x/n", "division by 0", "n\""),
        ("k*x/b", "division by 0", "b\""),
        ("x/(n*n)", "division by 0", "(n*n)"),
        ("min(x/b, 1/b*x)", "division by 0", "b, "),
        ("1e308*10", "evaluates to inf", "1e308*10"),
        ("x*exp(1000)", "`exp` of 1000 evaluates to inf", "exp(1000)"),
        ("sqrt(n - 1)", "`sqrt` of -1 evaluates to NaN", "sqrt"),
        ("ln(n)", "`ln` of 0 evaluates to -inf", "ln(n)"),
        ("asin(2)*x", "`asin` of 2 evaluates to NaN", "asin(2)"),
        ("(n - 2)^0.5", "evaluates to NaN", "(n - 2)^0.5"),
        ("n^(0 - 1)", "evaluates to inf", "n^"),
        ("atan(1/n)", "division by 0", "n)"),
    ] {
        let text = with_definition(value, "");
        let found = eomgen_model_spec::check(Source::new("test.toml", text.as_str()));
        let found = found.expect_err(value);
        let shown = found.render(false);
        assert!(shown.contains(message), "{value}: {shown}");
        let label = found.list()[0].primary.as_ref().expect("a place");
        let rest = &text[label.span.start..];
        assert!(rest.starts_with(place), "{value}: {shown}");
    }
    let coefficient = with_definition("x", "[coefficients]\nc = \"1/n\"\n");
    assert!(refused(&coefficient).contains("division by 0"));
    let force = with_definition("x", "[forces]\nf = { on = \"x\", value = \"k*x/n\" }\n");
    assert!(refused(&force).contains("division by 0"));
    let set = checked(&with_definition("k*x/m", "")).model;
    assert!(set.with_parameter("m", 0.0).is_err());
    for value in ["x/(k/k)", "deadzone(x, b)", "0*x", "n/m", "n*x", "1/x"] {
        checked(&with_definition(value, ""));
    }
}

#[test]
fn constants_outside_a_domain_are_rejected() {
    for (value, message, place) in [
        (
            "sin(1e10)",
            "`sin` of 10000000000 is outside its domain",
            "sin(",
        ),
        (
            "x*cos(-2e9)",
            "`cos` of -2000000000 is outside its domain",
            "cos(",
        ),
        ("tan((n + 2)*1e9)", "`tan` of 2000000000 is outside", "tan("),
        (
            "deadzone(x, -2*(b + q))",
            "`deadzone` is negative: -0.2",
            "-2*(b + q)",
        ),
        ("contact(x, -q)*x", "`contact` is negative: -0.1", "-q)"),
        ("contact(b, -q)*x", "`contact` is negative: -0.1", "-q)"),
    ] {
        let text = with_definition(value, "");
        let text = text.replace("n = {", "q = { value = 0.1, unit = \"m\" }\nn = {");
        let found = eomgen_model_spec::check(Source::new("test.toml", text.as_str()));
        let found = found.expect_err(value);
        assert!(
            found.render(false).contains(message),
            "{}",
            found.render(false)
        );
        let label = found.list()[0].primary.as_ref().expect("a place");
        assert!(text[label.span.start..].starts_with(place), "{value}");
    }
    for value in ["sin(1e9)*x", "deadzone(x, b)", "deadzone(x, -x)"] {
        checked(&with_definition(value, ""));
    }
    let model = checked(&with_definition("deadzone(x, b)", "")).model;
    assert!(model.with_parameter("b", -0.1).is_err());
}

#[test]
fn product_with_zero_keeps_its_unit() {
    let unit = |value: &str| {
        let model = checked(&with_definition(value, "")).model;
        model.definitions[0].unit.to_string()
    };
    assert_eq!(unit("0*b"), "m");
    assert_eq!(unit("0*b + x"), "m");
    assert_eq!(unit("0*dot(x)*m"), unit("dot(x)*m"));
    assert_eq!(unit("0/m"), "1/kg");
    assert_eq!(unit("0 + b"), "m");
    let message = refused(&with_definition("0*b + k", ""));
    assert!(message.contains("added to a quantity in m"), "{message}");
    // The literal 0 has any unit, also if a definition contains it.
    let by_name = with_definition("0", "total = \"d + x\"\nlength = \"max(d, b)\"\n");
    checked(&by_name);
}

#[test]
fn zero_components_keep_the_unit_of_their_vector() {
    for value in ["[b, 0*x, b]", "[x, 0, 0]", "2*[0, 0, x]"] {
        let more = "second = \"m*d.y + m*x\"\ntotal = \"d + [x, b, x]\"\n";
        let model = checked(&with_definition(value, more)).model;
        let units = model.observables.iter().map(|o| o.unit.to_string());
        let units: Vec<String> = units.collect();
        assert_eq!(units[..3], ["m", "m", "m"], "{value}");
    }
    let mixed = refused(&with_definition("[b, 0*k, b]", ""));
    assert!(mixed.contains("different units"), "{mixed}");
    refused(&GRAVITY.replace("0*a", "0*l"));
    checked(GRAVITY);
}

/// Frames and bodies multiply gravity by their rotations. An error in its unit is reported at `gravity`, not at the
/// rotations.
#[test]
fn unit_error_of_gravity_is_reported_at_gravity() {
    for (gravity, message) in [
        (
            "[1, \"-g\", 0]",
            "the x component of gravity is a pure number",
        ),
        (
            "[\"a*l\", 0, \"-g\"]",
            "the x component of gravity is in m^2/s^2",
        ),
        (
            "[\"a\", \"-g\", \"m\"]",
            "the z component of gravity is in kg",
        ),
        (
            "[\"a\", \"-g/l\", \"g\"]",
            "the y component of gravity is in 1/s^2",
        ),
    ] {
        let text = GRAVITY.replace("[\"a\", \"0*a\", \"-g\"]", gravity);
        let found = refused(&text);
        assert!(found.contains(message), "{found}");
        assert!(found.contains("gravity = ["), "{found}");
        assert!(!found.contains("rotation"), "{found}");
    }
}

/// Gravity with a component 0*a, in rotating frames.
const GRAVITY: &str = r#"[model]
name = "two_frames"
gravity = ["a", "0*a", "-g"]
[parameters]
g = { value = 9.81, unit = "m/s^2" }
a = { value = 1, unit = "m/s^2" }
m = { value = 1, unit = "kg" }
l = { value = 1, unit = "m" }
[coordinates]
p = { unit = "rad" }
q = { unit = "rad" }
[frames]
A = { rotation = "rotation_y(p)" }
B = { in = "A", origin = ["l", 0, 0], rotation = "rotation_x(q)" }
[bodies]
A = { frame = "A", mass = "m", centre = ["l", 0, 0] }
B = { frame = "B", mass = "m", centre = [0, "l", 0] }
"#;

#[test]
fn bound_at_one_standard_deviation_is_accepted_in_every_unit() {
    let is_accepted = |unit: &str, [value, sd, max]: [f64; 3]| {
        let text = format!(
            "[model]\nname = \"a\"\n[parameters]\nJ = {{ value = 1, unit = \"kg m^2\" }}\n\
             p = {{ value = {value:?}, unit = \"{unit}\", max = {max:?}, uncertainty = {{ sd = {sd:?} }} }}\n\
             [coordinates]\nq = {{ unit = \"rad\" }}\n[kinetic]\nT = \"1/2*J*dot(q)^2\"\n"
        );
        eomgen_model_spec::check(Source::new("a.toml", text)).is_ok()
    };
    for unit in ["rad", "deg", "mrad", "m", "um", "N/mm", "km/h", "1/min"] {
        for [value, sd, max] in [
            [-4.0, 1.0, -3.0],
            [0.3, 0.1, 0.4],
            [0.7, 0.1, 0.8],
            [7.3, 1.1, 8.4],
            [1e3, 1e-3, 1000.001],
        ] {
            assert!(
                is_accepted(unit, [value, sd, max]),
                "{value} {sd} {max} {unit}"
            );
            let nearer = max - 1e-6 * sd;
            assert!(
                !is_accepted(unit, [value, sd, nearer]),
                "{value} {sd} {unit}"
            );
        }
    }
}
