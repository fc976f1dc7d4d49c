//! Comparison of machines with contacts without play, in which the force changes its sign, with machines with the
//! corresponding constraint.

use eomgen_compiled_model::{CompiledModel, Orders, Solver};
use eomgen_tests::random_numbers::Numbers;

/// Units of length (m) and mass (kg) of the tested coordinates.
const UNITS: [(f64, f64); 2] = [(1.0, 1.0), (1e-3, 1e3)];

/// Largest difference from the constrained machine, relative to the largest value.
const MAX_DIFFERENCE: f64 = 1e-6;

struct Machine {
    text: String,
    /// For each pair of contacts: the distance that they keep zero, and the constraint that replaces them.
    pairs: Vec<[String; 2]>,
}

impl Machine {
    fn constrained(&self) -> CompiledModel {
        let constraints = self.pairs.iter().enumerate();
        let constraints =
            constraints.map(|(place, [_, zero])| format!("c{place} = {{ zero = \"{zero}\" }}\n"));
        compile(&(self.text.clone() + "[constraints]\n" + &constraints.collect::<String>()))
    }

    fn with_contacts(&self, restitution: f64) -> CompiledModel {
        let impacts = self.pairs.iter().enumerate();
        let impacts = impacts.map(|(place, [distance, _])| {
            format!(
                "a{place} = {{ when = \"{distance}\", restitution = {restitution} }}\n\
                 b{place} = {{ when = \"-({distance})\", restitution = {restitution} }}\n"
            )
        });
        compile(&(self.text.clone() + "[impacts]\n" + &impacts.collect::<String>()))
    }
}

fn compile(text: &str) -> CompiledModel {
    CompiledModel::from_text("without_play.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn draw_between(numbers: &mut Numbers, low: f64, high: f64) -> f64 {
    low + 0.5 * (high - low) * (1.0 + numbers.symmetric())
}

/// Returns a random force that changes its sign; some forces start with zero, and some are zero during an interval.
fn force(numbers: &mut Numbers, case: usize) -> String {
    let (w, phase) = (
        draw_between(numbers, 1.0, 8.0),
        draw_between(numbers, 0.0, 6.0),
    );
    [
        format!("F*cos({w:?}*w*t + {phase:?})"),
        format!("F*sin({w:?}*w*t)"),
        format!("F*(w*t)^2*sin({w:?}*w*t)"),
        format!("-F*max(0, sin({w:?}*w*t + {phase:?}))"),
        format!("F*sign(sin({w:?}*w*t + {phase:?}))"),
    ][case % 5]
        .clone()
}

/// Returns a gear train; a torque acts on the first gear, a spring and dry friction on the last.
fn gears(numbers: &mut Numbers, case: usize, (length, mass): (f64, f64)) -> Machine {
    let count = 2 + case % 3;
    let torque = draw_between(numbers, 0.5, 5.0) * mass;
    let (spring, damping) = (
        draw_between(numbers, 0.0, 3.0),
        draw_between(numbers, 0.0, 0.3),
    );
    let dry = if case.is_multiple_of(2) {
        0.0
    } else {
        0.3 * torque
    };
    let mut parameters = format!(
        "F = {{ value = {torque:?}, unit = \"N*m\" }}\nw = {{ value = 1, unit = \"rad/s\" }}\n\
         k = {{ value = {:?}, unit = \"N*m/rad\" }}\nd = {{ value = {:?}, unit = \"N*m*s/rad\" }}\n\
         D = {{ value = {dry:?}, unit = \"N*m\" }}\n",
        spring * mass,
        damping * mass
    );
    let (mut coordinates, mut kinetic, mut pairs) = (String::new(), Vec::new(), Vec::new());
    let (mut angle, mut rate) = (numbers.symmetric(), 2.0 * numbers.symmetric());
    let mut before = 0.0;
    for gear in 0..count {
        let radius = draw_between(numbers, 0.05, 0.3);
        let inertia = draw_between(numbers, 0.01, 1.0) * mass;
        if gear > 0 {
            (angle, rate) = (-angle * before / radius, -rate * before / radius);
            let last = gear - 1;
            pairs.push([
                format!("r{last}*q{last} + r{gear}*q{gear}"),
                format!("r{last}*dot(q{last}) + r{gear}*dot(q{gear})"),
            ]);
        }
        before = radius;
        parameters += &format!(
            "r{gear} = {{ value = {:?}, unit = \"m\" }}\nI{gear} = {{ value = {inertia:?}, unit = \"kg*m^2\" }}\n",
            radius * length
        );
        coordinates += &format!(
            "q{gear} = {{ unit = \"rad\", initial = {angle:?}, initial_rate = {rate:?} }}\n"
        );
        kinetic.push(format!("1/2*I{gear}*dot(q{gear})^2"));
    }
    let (last, drive, kinetic) = (count - 1, force(numbers, case), kinetic.join(" + "));
    Machine {
        text: format!(
            "[model]\nname = \"gears\"\n[parameters]\n{parameters}[coordinates]\n{coordinates}\
             [kinetic]\nT = \"{kinetic}\"\n[potential]\nV = \"1/2*k*q{last}^2\"\n[forces]\n\
             drive = {{ on = \"q0\", value = \"{drive}\" }}\n\
             loss = {{ on = \"q{last}\", value = \"-d*dot(q{last}) - D*sign(dot(q{last}))\" }}\n"
        ),
        pairs,
    }
}

/// Returns a bead on a circle. Weight, a force and the centripetal force change the side of the ring that carries it.
fn ring(numbers: &mut Numbers, case: usize, (length, mass): (f64, f64)) -> Machine {
    let (radius, angle) = (
        draw_between(numbers, 0.3, 2.0),
        draw_between(numbers, 0.0, 6.3),
    );
    let speed = draw_between(numbers, 1.0, 5.0);
    let [x, y] = [angle.cos(), angle.sin()].map(|part| part * radius * length);
    let [u, v] = [-angle.sin(), angle.cos()].map(|part| part * speed * length);
    let (m, push) = (
        draw_between(numbers, 0.2, 3.0) * mass,
        draw_between(numbers, 1.0, 20.0),
    );
    Machine {
        text: format!(
            "[model]\nname = \"ring\"\n[parameters]\nm = {{ value = {m:?}, unit = \"kg\" }}\n\
             g = {{ value = {:?}, unit = \"m/s^2\" }}\nr = {{ value = {:?}, unit = \"m\" }}\n\
             F = {{ value = {:?}, unit = \"N\" }}\nw = {{ value = 1, unit = \"rad/s\" }}\n\
             [coordinates]\nx = {{ unit = \"m\", initial = {x:?}, initial_rate = {u:?} }}\n\
             y = {{ unit = \"m\", initial = {y:?}, initial_rate = {v:?} }}\n\
             [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[potential]\nV = \"m*g*y\"\n\
             [forces]\npush = {{ on = \"x\", value = \"{}\" }}\n",
            9.81 * length,
            radius * length,
            push * length * mass,
            force(numbers, case)
        ),
        pairs: vec![[
            "r - sqrt(x^2 + y^2)".to_owned(),
            "x*dot(x) + y*dot(y)".to_owned(),
        ]],
    }
}

/// Returns a bead in an oscillating slot.
fn slot(numbers: &mut Numbers, case: usize, (length, mass): (f64, f64)) -> Machine {
    let (m, stiffness) = (
        draw_between(numbers, 0.2, 3.0),
        draw_between(numbers, 0.0, 10.0),
    );
    let (amplitude, frequency) = (
        draw_between(numbers, 0.1, 1.0),
        draw_between(numbers, 1.0, 7.0),
    );
    Machine {
        text: format!(
            "[model]\nname = \"slot\"\n[parameters]\nm = {{ value = {:?}, unit = \"kg\" }}\n\
             A = {{ value = {:?}, unit = \"m\" }}\nw = {{ value = 1, unit = \"rad/s\" }}\n\
             O = {{ value = {frequency:?}, unit = \"rad/s\" }}\ns = {{ value = {:?}, unit = \"1\" }}\n\
             k = {{ value = {:?}, unit = \"N/m\" }}\nF = {{ value = {:?}, unit = \"N\" }}\n\
             [coordinates]\nx = {{ unit = \"m\", initial_rate = \"A*O\" }}\ny = {{ unit = \"m\" }}\n\
             [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n\
             [potential]\nV = \"1/2*k*(x^2 + y^2)\"\n[forces]\n\
             push = {{ on = \"y\", value = \"{}\" }}\n",
            m * mass,
            amplitude * length,
            numbers.symmetric(),
            stiffness * mass,
            draw_between(numbers, 1.0, 20.0) * length * mass,
            force(numbers, case)
        ),
        pairs: vec![[
            "x + s*y - A*sin(O*t)".to_owned(),
            "dot(x) + s*dot(y) - A*O*cos(O*t)".to_owned(),
        ]],
    }
}

fn simulate(model: &CompiledModel, solver: Solver, name: &str) -> Vec<Vec<f64>> {
    let run = model.with_declared_parameters().unwrap();
    let times: Vec<f64> = (0..=10).map(|step| 0.25 * f64::from(step)).collect();
    let motion = run.simulate(run.initial_state(), &times, &run.default_inputs(), solver);
    let motion = motion.unwrap_or_else(|error| panic!("{name}, {solver}: {error}"));
    motion.trajectory.states
}

fn assert_equal(found: &[Vec<f64>], expected: &[Vec<f64>], name: &str) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let count = found[0].len();
    for place in 0..count {
        let sizes = expected.iter().map(|state| state[place].abs());
        let size = sizes.fold(0.0, f64::max);
        for (found, expected) in found.iter().zip(expected) {
            let difference = (found[place] - expected[place]).abs();
            assert!(
                difference <= MAX_DIFFERENCE * size + f64::EPSILON,
                "{name}, state {place}: {} and {}",
                found[place],
                expected[place]
            );
        }
    }
}

#[test]
fn contacts_without_play_move_like_constraints() {
    type Family = fn(&mut Numbers, usize, (f64, f64)) -> Machine;
    let families: [(&str, Family); 3] = [("gears", gears), ("ring", ring), ("slot", slot)];
    for (family, create) in families {
        for case in 0..12 {
            for units in UNITS {
                let numbers = &mut Numbers(0x9e37_79b9 + 7919 * case as u64);
                let machine = create(numbers, case, units);
                let expected = simulate(&machine.constrained(), Solver::Rk, family);
                let model = machine.with_contacts([0.0, 0.5, 0.9][case % 3]);
                for solver in [Solver::Rk, Solver::Radau, Solver::Auto] {
                    let name = format!("{family} {case} {units:?}");
                    let found = simulate(&model, solver, &name);
                    assert_equal(&found, &expected, &name);
                }
            }
        }
    }
}

/// The friction of two walls of a slot along x equals mu*abs(N) at a single wall that can also pull.
#[test]
fn bead_slides_along_rough_walls_without_play() {
    let text = |friction: &str, rest: &str| {
        format!(
            "[model]\nname = \"rough\"\n[parameters]\nm = {{ value = 2, unit = \"kg\" }}\n\
             F = {{ value = 3, unit = \"N\" }}\nw = {{ value = 4, unit = \"rad/s\" }}\n\
             [coordinates]\nx = {{ unit = \"m\", initial_rate = 9 }}\ny = {{ unit = \"m\" }}\n\
             [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n\
             [forces]\npush = {{ on = \"y\", value = \"F*cos(w*t)\" }}\n{friction}{rest}"
        )
    };
    let expected = compile(&text(
        "rough = { on = \"x\", value = \"-0.3*abs(F*cos(w*t))\" }\n",
        "[constraints]\nwall = { zero = \"dot(y)\" }\n",
    ));
    let found = compile(&text(
        "",
        "[impacts]\na = { when = \"y\", restitution = 0.4, friction = 0.3, slip = \"dot(x)\" }\n\
         b = { when = \"-y\", restitution = 0.4, friction = 0.3, slip = \"dot(x)\" }\n",
    ));
    let expected = simulate(&expected, Solver::Rk, "constraint");
    for solver in [Solver::Rk, Solver::Radau, Solver::Auto] {
        let name = format!("rough {solver}");
        assert_equal(&simulate(&found, solver, &name), &expected, &name);
    }
}
