//! Energies of bodies compared with energies from positions: products of numerical homogeneous transforms, with rates
//! by difference quotients. No velocity is propagated.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::{Expr, ExprKind, Function, Model, Term};

use super::{shipped, value};

pub type Matrix = [[f64; 4]; 4];

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [[0.0; 4]; 4];
    for (i, row) in product.iter_mut().enumerate() {
        for (j, element) in row.iter_mut().enumerate() {
            *element = (0..4).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    product
}

/// Returns the Denavit-Hartenberg transform of a joint: about z by q, along z by d, along x by
/// a, about x by alpha.
fn joint(q: f64, d: f64, a: f64, alpha: f64) -> Matrix {
    let ((s, c), (sa, ca)) = (q.sin_cos(), alpha.sin_cos());
    [
        [c, -s * ca, s * sa, a * c],
        [s, c * ca, -c * sa, a * s],
        [0.0, sa, ca, d],
        [0.0, 0.0, 0.0, 1.0],
    ]
}

pub fn links(q: &[f64; 6]) -> Vec<Matrix> {
    let half = std::f64::consts::FRAC_PI_2;
    let rows = [
        (0.0, 0.0, half),
        (0.0, 0.4318, 0.0),
        (0.15005, 0.0203, -half),
        (0.4318, 0.0, half),
        (0.0, 0.0, -half),
        (0.0, 0.0, 0.0),
    ];
    let mut all: Vec<Matrix> = Vec::new();
    for (q, (d, a, alpha)) in q.iter().zip(rows) {
        let own = joint(*q, d, a, alpha);
        all.push(all.last().map_or(own, |before| times(before, &own)));
    }
    all
}

/// Returns the kinetic and the potential energy of the arm, in J.
pub fn energies(q: &[f64; 6], rates: &[f64; 6]) -> (f64, f64) {
    let masses = [0.0, 17.4, 4.8, 0.82, 0.34, 0.09];
    let centres = [
        [0.0; 3],
        [-0.3638, 0.006, 0.2275],
        [-0.0203, -0.0141, 0.07],
        [0.0, 0.019, 0.0],
        [0.0; 3],
        [0.0, 0.0, 0.032],
    ];
    let inertias = [
        [0.35, 0.35, 0.35],
        [0.13, 0.524, 0.539],
        [0.066, 0.086, 0.0125],
        [0.0018, 0.0013, 0.0018],
        [0.0003, 0.0004, 0.0003],
        [0.00015, 0.00015, 4e-5],
    ];
    let step = 1e-5;
    let moved = |by: f64| {
        let mut moved = *q;
        for (own, rate) in moved.iter_mut().zip(rates) {
            *own += by * rate;
        }
        links(&moved)
    };
    let (now, before, after) = (links(q), moved(-step), moved(step));
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for link in 0..6 {
        let rate = |i: usize, j: usize| (after[link][i][j] - before[link][i][j]) / (2.0 * step);
        let [x, y, z] = centres[link];
        let mut speed = 0.0;
        for i in 0..3 {
            let v = rate(i, 0) * x + rate(i, 1) * y + rate(i, 2) * z + rate(i, 3);
            speed += v * v;
        }
        // R' dR/dt is the cross product with the angular velocity.
        let turned = |a: usize, b: usize| (0..3).map(|i| now[link][i][a] * rate(i, b)).sum::<f64>();
        let omega = [turned(2, 1), turned(0, 2), turned(1, 0)];
        let spin = inertias[link].iter().zip(omega).map(|(i, w)| i * w * w);
        kinetic += 0.5 * masses[link] * speed + 0.5 * spin.sum::<f64>();
        let [nx, ny, nz, p] = now[link][2];
        potential += masses[link] * 9.81 * (nx * x + ny * y + nz * z + p);
    }
    (kinetic, potential)
}

/// Coordinates and rates.
pub type State<'s> = (&'s [f64; 6], &'s [f64; 6]);

/// Evaluates an expression and its rate.
pub fn evaluate(model: &Model, state: State<'_>, expr: &Expr) -> (f64, f64) {
    let of = |expr: &Expr| evaluate(model, state, expr);
    match &expr.kind {
        ExprKind::Number(value) => (*value, 0.0),
        ExprKind::Pi => (std::f64::consts::PI, 0.0),
        ExprKind::Parameter(index) => (value(model, &model.parameters[*index].name), 0.0),
        ExprKind::Coordinate(index) => (state.0[index.index()], state.1[index.index()]),
        ExprKind::Definition(index) => of(&model.definitions[*index].value),
        ExprKind::Dot(operand) => (of(operand).1, f64::NAN),
        ExprKind::Negate(operand) => {
            let (value, rate) = of(operand);
            (-value, -rate)
        }
        ExprKind::Binary(operator, left, right) => {
            let ((a, da), (b, db)) = (of(left), of(right));
            match operator {
                BinaryOperator::Add => (a + b, da + db),
                BinaryOperator::Subtract => (a - b, da - db),
                BinaryOperator::Multiply => (a * b, da * b + a * db),
                BinaryOperator::Divide => (a / b, (da - a / b * db) / b),
                BinaryOperator::Power if b == 2.0 => (a * a, 2.0 * a * da),
                _ => panic!("not in this model"),
            }
        }
        ExprKind::Call(function, arguments) => {
            let (x, rate) = of(&arguments[0]);
            match function {
                Function::Sin => (x.sin(), x.cos() * rate),
                Function::Cos => (x.cos(), -x.sin() * rate),
                Function::Sqrt => (x.sqrt(), rate / (2.0 * x.sqrt())),
                _ => panic!("not in this model"),
            }
        }
        _ => panic!("not in this model"),
    }
}

#[test]
fn energies_of_the_puma_match_its_positions() {
    let model = shipped("puma_560.toml");
    for (q, rates) in [
        (
            [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
            [1.0, -0.7, 0.4, 2.0, -1.5, 0.3],
        ),
        (
            [-2.1, 1.2, -0.8, 2.4, -0.5, 1.6],
            [-0.3, 0.9, 1.4, -1.0, 0.5, 3.0],
        ),
    ] {
        let total = |terms: &[Term]| {
            let values = terms
                .iter()
                .map(|t| evaluate(&model, (&q, &rates), &t.value).0);
            values.sum::<f64>()
        };
        let (kinetic, potential) = energies(&q, &rates);
        let (own, fall) = (total(&model.kinetic), total(&model.potential));
        assert!((own - kinetic).abs() < 1e-8 * kinetic, "{own} {kinetic}");
        assert!(
            (fall - potential).abs() < 1e-12 * 100.0,
            "{fall} {potential}"
        );
    }
}

/// Body on a carriage: tilted by p, at r along an arm that rotates by q about the vertical.
const CARRIAGE: &str = r#"
[model]
name = "carriage"
gravity = [0, "g", "-2*g"]
[parameters]
g = { value = 9.81, unit = "m/s^2" }
m = { value = 2, unit = "kg" }
h = { value = 0.3, unit = "m" }
l = { value = 0.7, unit = "m" }
J = { value = 1, unit = "kg m^2" }
[coordinates]
q = { unit = "rad" }
r = { unit = "m" }
p = { unit = "rad" }
[frames]
tilted = { in = "arm", origin = ["r + l", "h", 0], rotation = "rotation_x(p)" }
arm = { rotation = "rotation_z(q)" }
[bodies]
load = { frame = "tilted", mass = "m", centre = [0, "l", 0], inertia = ["3*J", "4*J", "5*J", "0.1*J", "0.2*J", "0.3*J"] }
"#;

#[test]
fn energies_include_moving_origins_products_of_inertia_and_oblique_gravity() {
    let source = eomgen_model_spec::source::Source::new("carriage.toml", CARRIAGE);
    let model = eomgen_model_spec::check(source).expect("sound").model;
    let (q, r, p, dq, dr, dp) = (0.4_f64, -0.6, 1.1_f64, 0.7, -1.3, 2.1);
    let (m, g, h, l) = (2.0, 9.81, 0.3, 0.7);
    let (s, c) = p.sin_cos();
    // Components along the arm, across it and up.
    let (along, across) = (r + l, h + l * c);
    let v = [dr - dq * across, dq * along - l * s * dp, l * c * dp];
    let [x, y, z] = [dp, dq * s, dq * c];
    let twice = m * v.iter().map(|v| v * v).sum::<f64>()
        + 3.0 * x * x
        + 4.0 * y * y
        + 5.0 * z * z
        + 2.0 * (0.1 * x * y + 0.2 * y * z + 0.3 * x * z);
    let fall = -m * g * (q.sin() * along + q.cos() * across) + 2.0 * m * g * l * s;
    let state = (&[q, r, p, 0.0, 0.0, 0.0], &[dq, dr, dp, 0.0, 0.0, 0.0]);
    let kinetic = evaluate(&model, state, &model.kinetic[0].value).0;
    let potential = evaluate(&model, state, &model.potential[0].value).0;
    assert!((kinetic - twice / 2.0).abs() < 1e-13, "{kinetic} {twice}");
    assert!((potential - fall).abs() < 1e-13, "{potential} {fall}");
}

/// Returns the first message, and the text that it underlines.
fn expect_rejection(text: &str) -> (String, String) {
    let text = format!(
        "[model]\nname = \"a\"\ngravity = [0, 0, \"-g\"]\n[parameters]\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\nm = {{ value = 2, unit = \"kg\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\nJ = {{ value = 3, unit = \"kg m^2\" }}\n\
         [coordinates]\nq = {{ unit = \"rad\" }}\n{text}"
    );
    // The coordinate needs an inertia, with or without bodies.
    let own = "\n[kinetic]\nown = \"1/2*J*dot(q)^2\"\n";
    let text = match text.contains("[kinetic]") {
        true => text,
        false => text + own,
    };
    let source = eomgen_model_spec::source::Source::new("a.toml", text.as_str());
    let found = eomgen_model_spec::check(source).expect_err("refused");
    let first = &found.list()[0];
    let place = first.primary.as_ref().expect("a place").span;
    (
        first.message.clone(),
        text[place.start..place.end].to_owned(),
    )
}

#[test]
fn errors_in_frames_and_bodies_have_positions() {
    let frame = "[frames]\nf = { rotation = \"rotation_z(q)\" }\n";
    let body = "[bodies]\nb = { frame = \"f\", mass = \"m\" }\n";
    for (text, message, place) in [
        (
            "[frames]\na = { in = \"b\" }\nb = { in = \"a\" }\n".to_owned() + body,
            "placed in itself",
            "\"b\"",
        ),
        (
            frame.to_owned() + "[bodies]\nb = { frame = \"g\", mass = \"m\" }",
            "unknown frame `g`",
            "\"g\"",
        ),
        (
            frame.to_owned() + "[bodies]\nb = { frame = \"f\", mass = \"l\" }",
            "the mass of `b` is in m, expected in kg",
            "l",
        ),
        (
            frame.to_owned()
                + "[bodies]\nb = { frame = \"f\", mass = \"m\", centre = [\"l\", \"m\", 0] }",
            "the y component of the centre of `b`",
            "m",
        ),
        (
            frame.to_owned() + "[bodies]\nb = { frame = \"f\", mass = \"m\", centre = [\"l\", 0] }",
            "`centre` needs 3 components, not 2",
            "[\"l\", 0]",
        ),
        (
            frame.to_owned()
                + "[bodies]\nb = { frame = \"f\", mass = \"m\", inertia = [\"J\", \"J\", \"-J\"] }",
            "not positive semidefinite",
            "\"J\", \"J\", \"-J\"",
        ),
        (
            frame.to_owned()
                + "[bodies]\nb = { frame = \"f\", mass = \"m\", inertia = [\"J\", \"J\", \"3*J\"] }",
            "no body has the inertia of `b`",
            "\"J\", \"J\", \"3*J\"",
        ),
        (
            frame.to_owned() + "[bodies]\nb = { frame = \"f\", mass = 0 }",
            "the mass of `b` is 0 kg",
            "0",
        ),
        (
            frame.to_owned() + "[bodies]\nb = { frame = \"f\", mass = \"m - 2*m\" }",
            "the mass of `b` is -2 kg",
            "m - 2*m",
        ),
        (
            frame.to_owned() + "[bodies]\nb = { frame = \"f\" }",
            "has no `mass` and no `inertia`",
            "b",
        ),
        (
            frame.to_owned()
                + "[bodies]\nb = { frame = \"f\", mass = \"m\", centre = [\"l*cos(q)\", 0, 0] }",
            "the body `b` is not constant",
            "l*cos(q)",
        ),
        (
            "[frames]\nf = { rotation = \"rotation_w(q)\" }\n".to_owned() + body,
            "not a rotation",
            "rotation_w",
        ),
        (
            "[frames]\nf = { rotation = \"rotation_z(l)\" }\n".to_owned() + body,
            "an angle of `f` is in m",
            "l",
        ),
        (
            frame.to_owned() + body + "[kinetic]\nb = \"1/2*J*dot(q)^2\"",
            "the name `b` is taken",
            "b",
        ),
    ] {
        let (said, underlined) = expect_rejection(&text);
        assert!(said.contains(message), "{text}\n{said}");
        assert_eq!(underlined, place, "{text}\n{said}");
    }
    let mut chain = String::from("[frames]\nf_0 = { rotation = \"rotation_z(q)\" }\n");
    for link in 1..1000 {
        let before = link - 1;
        chain += &format!(
            "f_{link} = {{ in = \"f_{before}\", origin = [\"l\", 0, 0], rotation = \"rotation_z(q)\" }}\n"
        );
    }
    let many: String = (0..10_000)
        .map(|body| format!("b_{body} = {{ frame = \"f\", mass = \"m\" }}\n"))
        .collect();
    let (said, _) = expect_rejection(&(frame.to_owned() + "[bodies]\n" + &many));
    assert!(
        said.contains("[bodies] has more than 2000 entries"),
        "{said}"
    );
    let (said, _) =
        expect_rejection(&(chain + "[bodies]\nb = { frame = \"f_999\", mass = \"m\" }"));
    assert!(
        said.contains("chain of frames is longer than 100"),
        "{said}"
    );
}
