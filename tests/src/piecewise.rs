//! Random machines with nested piecewise forces. All quantities are dimensionless. Half-widths and offsets are from a
//! small set. Therefore functions are often constant in a region, with the value zero or the threshold of another
//! function.

use eomgen_sim::inputs::HeldInputs;
use eomgen_validate::random::Random;

use crate::motions::TestMotion;

const NUMBERS: [f64; 5] = [0.0, 0.125, 0.25, 0.5, 1.0];

/// Arguments of functions. Rates are rare, because a force that jumps with a rate can cause sticking, which only the
/// exact solver handles.
const LEAVES: [&str; 8] = ["x", "y", "x", "y", "(x - y)", "(x + y)", "tau*dot(x)", "u"];

/// Returns a random machine of two masses with a random initial state and, in some cases, a piecewise constant input.
pub fn machine(random: &mut Random, deepest: usize) -> TestMotion {
    let mut text = HEAD.to_owned();
    let count = 1 + (2.0 * random.unit()) as usize;
    for index in 0..count {
        let on = if random.unit() < 0.5 { "x" } else { "y" };
        let size = 2.0 + 6.0 * random.unit();
        let term = piecewise(random, deepest);
        // A force that jumps with a rate acts on the same mass (friction) or on the other mass.
        text +=
            &format!("f_{index} = {{ on = \"{on}\", value = \"-{size:.3}*J/s^2*({term})\" }}\n");
    }
    let source = eomgen_model_spec::source::Source::new("random.toml", text.as_str());
    let model = match eomgen_model_spec::check(source) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{text}\n{}", found.render(false)),
    };
    let mut subject = TestMotion::new(model, 0);
    subject.initial = (0..4).map(|_| 1.5 * random.symmetric()).collect();
    let held = [-1.0, 0.0, 1.0, 0.25, 0.0];
    let values = (0..4).map(|_| random.pick(&held).copied().unwrap_or(0.0));
    let times = vec![0.0, 0.31, 0.62, 0.93];
    subject.inputs = HeldInputs::new(times, values.collect(), 1).expect("ascending times");
    subject
}

/// Returns a random piecewise function of at most this nesting depth.
pub fn piecewise(random: &mut Random, depth: usize) -> String {
    let inner = |random: &mut Random| {
        if depth <= 1 || random.unit() < 0.15 {
            leaf(random)
        } else {
            piecewise(random, depth - 1)
        }
    };
    let number = |random: &mut Random| random.pick(&NUMBERS).copied().unwrap_or(0.0);
    let a = inner(random);
    match (11.0 * random.unit()) as usize {
        0 => format!("deadzone({a}, {:?})", number(random)),
        1 => format!("contact({a}, {:?})", number(random)),
        2 => format!("sign({a})"),
        3 => format!("abs({a})"),
        4 => format!("min({a}, {:?})", number(random)),
        5 => format!("max({a}, -{:?})", number(random)),
        6 => format!("above({a})"),
        7 => format!("min({a}, {})", inner(random)),
        8 => format!("max({a}, {})", inner(random)),
        9 => format!("sign({a} - {:?})", number(random)),
        _ => format!("(above({a})*x + {:?}*{})", number(random), inner(random)),
    }
}

fn leaf(random: &mut Random) -> String {
    let leaf = random.pick(&LEAVES).copied().unwrap_or("x");
    if random.unit() < 0.5 {
        return leaf.to_owned();
    }
    let offset = random.pick(&NUMBERS).copied().unwrap_or(0.0);
    format!("({leaf} - {offset:?})")
}

const HEAD: &str = r#"
[model]
name = "nested"
[parameters]
J = { value = 1, unit = "kg m^2" }
s = { value = 1, unit = "s" }
tau = { value = 0.5, unit = "s" }
k = { value = 9, unit = "N m" }
c = { value = 0.4, unit = "N m s" }
[coordinates]
x = { unit = "1" }
y = { unit = "1" }
[inputs]
u = { unit = "1" }
[kinetic]
T = "1/2*J*(dot(x)^2 + 2*dot(y)^2)"
[potential]
V = "1/2*k*(x^2 + y^2)"
[dissipation]
R = "1/2*c*(dot(x)^2 + dot(y)^2)"
[forces]
drive = { on = "y", value = "3*J/s^2*cos(5*t/s)" }
"#;
