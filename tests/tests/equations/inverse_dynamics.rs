//! Comparison of the recursive inverse dynamics of rigid bodies with the oracle's mass matrix and forces. The random
//! trees contain hinges, slides, multiple rotations of a frame, oblique axes, bodies without mass, and additional
//! energies. Angles can depend on several coordinates, on time or on prescribed motion.

use std::fmt::Write;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::samples;
use eomgen_validate::oracle::Oracle;
use eomgen_validate::random::Random;

/// Maximum deviation relative to the terms of a row.
const TOLERANCE: f64 = 1e-12;
const STATES: usize = 5;
const COORDINATES: usize = 5;
const TREES: usize = 30;

fn check_model(text: &str) -> Model {
    match eomgen_model_spec::check(Source::new("rigid_tree.toml", text)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}{text}", found.render(false)),
    }
}

fn pick_text<'t>(random: &mut Random, texts: &[&'t str]) -> &'t str {
    random.pick(texts).copied().unwrap_or_default()
}

/// Returns a rotation of frame `i`. Its angle is coordinate `i`, unless this coordinate is a slide.
fn rotation(random: &mut Random, i: usize, slides: bool) -> String {
    let axes = ["x", "y", "z"];
    let before = i.saturating_sub(1).max(1);
    let mut turns = Vec::new();
    if random.unit() < 0.5 {
        let angle = pick_text(random, &["pi/2", "-pi/2", "pi", "beta", "0.7"]);
        turns.push(format!("rotation_{}({angle})", pick_text(random, &axes)));
    }
    if !slides {
        let angle = match pick_text(
            random,
            &["plain", "plain", "plain", "minus", "sum", "time", "given"],
        ) {
            "minus" => format!("-q_{i}"),
            "sum" => format!("2*q_{i} + q_{before}"),
            "time" => format!("q_{i} + w*t"),
            "given" => format!("q_{i} + s"),
            _ => format!("q_{i}"),
        };
        turns.push(format!("rotation_{}({angle})", pick_text(random, &axes)));
        if random.unit() < 0.3 {
            turns.push(format!(
                "rotation_{}(q_{before}/2)",
                pick_text(random, &axes)
            ));
        }
    }
    if random.unit() < 0.3 {
        turns.push(format!("rotation_{}(-pi/2)", pick_text(random, &axes)));
    }
    turns.join("*")
}

fn tree(random: &mut Random) -> String {
    let mut frames = String::from("[frames]\n");
    let mut bodies = String::from("[bodies]\n");
    for i in 1..=COORDINATES {
        let slides = random.unit() < 0.2;
        let mut origin =
            [0, 1, 2].map(|_| pick_text(random, &["0", "0", "a", "-b", "0.3*a"]).to_owned());
        if slides {
            let along = random.pick(&[0, 1, 2]).copied().unwrap_or_default();
            origin[along] = format!("a + b*q_{i}");
        }
        let parent = match i {
            1 => String::new(),
            _ => {
                let back = if random.unit() < 0.7 { 1 } else { 2 };
                match i.saturating_sub(back) {
                    0 => String::new(),
                    parent => format!("in = \"f_{parent}\", "),
                }
            }
        };
        let turns = rotation(random, i, slides);
        let turns = match turns.is_empty() {
            true => String::new(),
            false => format!(", rotation = \"{turns}\""),
        };
        let [x, y, z] = origin;
        _ = writeln!(
            frames,
            "f_{i} = {{ {parent}origin = [\"{x}\", \"{y}\", \"{z}\"]{turns} }}"
        );
        let centre = [0, 1, 2].map(|_| pick_text(random, &["0", "c", "-c/3"]));
        let [x, y, z] = centre;
        let weight = match pick_text(random, &["m", "m", "2*m", "none"]) {
            "none" => String::new(),
            mass => format!("mass = \"{mass}\", centre = [\"{x}\", \"{y}\", \"{z}\"], "),
        };
        let inertia = pick_text(
            random,
            &[
                "\"J\", \"1.2*J\", \"1.5*J\"",
                "\"J\", \"J\", \"0.1*J\"",
                "\"J\", \"1.2*J\", \"1.5*J\", \"0.1*J\", \"-0.2*J\", \"0.05*J\"",
            ],
        );
        _ = writeln!(
            bodies,
            "f_{i} = {{ frame = \"f_{i}\", {weight}inertia = [{inertia}] }}"
        );
    }
    let gravity = pick_text(random, &["0, 0, \"-g\"", "\"g/2\", 0, \"-g\""]);
    let mut text = format!(
        "[model]\nname = \"tree\"\ngravity = [{gravity}]\n[parameters]\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\nm = {{ value = 0.7, unit = \"kg\" }}\n\
         a = {{ value = 0.4, unit = \"m\" }}\nb = {{ value = 0.25, unit = \"m\" }}\n\
         c = {{ value = 0.1, unit = \"m\" }}\nJ = {{ value = 0.02, unit = \"kg m^2\" }}\n\
         K = {{ value = 0.03, unit = \"kg m^2\" }}\nk = {{ value = 2, unit = \"N m\" }}\n\
         d = {{ value = 0.3, unit = \"N m s\" }}\nbeta = {{ value = 0.4, unit = \"rad\" }}\n\
         w = {{ value = 0.9, unit = \"rad/s\" }}\n[coordinates]\n"
    );
    for i in 1..=COORDINATES {
        _ = writeln!(text, "q_{i} = {{ unit = \"rad\", initial = 0.{i} }}");
    }
    text += "[inputs]\ns = { unit = \"rad\", rates = 2 }\nu = { unit = \"N m\" }\n";
    text += &frames;
    text += &bodies;
    text += "[kinetic]\n";
    for i in 1..=COORDINATES {
        // An additional term gives every coordinate inertia in any tree.
        _ = writeln!(
            text,
            "rotor_{i} = \"1/2*K*(1 + cos(q_{i})^2)*dot(q_{i})^2\""
        );
    }
    text + "[potential]\nspring = \"1/2*k*(q_1 - q_2)^2\"\n[dissipation]\noil = \"1/2*d*dot(q_3)^2\"\n\
            [forces]\nmotor = { on = \"q_4\", value = \"u + k*s\" }\n"
}

/// Compares with the oracle; returns the operation counts of the rates and of inverse dynamics.
fn compare_with_oracle(model: &Model) -> (usize, usize) {
    let variant = Variant::derive_with(model, &[], &[Output::InverseDynamics]);
    let program = match variant {
        Ok(variant) => variant.program,
        Err(found) => panic!("{}{}", found.render(false), model.source.text),
    };
    let inverse = program
        .outputs
        .inverse_dynamics
        .as_ref()
        .expect("requested");
    let operations = (
        program.operations(&program.accelerations.all()),
        program.operations(&inverse.all()),
    );
    let parameters = model.parameter_values().expect("values");
    let oracle = Oracle::new(model, 0, &parameters).expect("the oracle supports the model");
    let mut evaluator = Evaluator::new(program);
    let mut random = Random::new(0x7ee5);
    for sample in samples(model, 0, 0x7ee5, STATES) {
        let accelerations: Vec<f64> = model
            .coordinates
            .iter()
            .map(|_| 10.0 * random.away_from_zero())
            .collect();
        let point = Point {
            t: sample.time,
            state: &sample.state,
            inputs: &sample.inputs,
        };
        let mut found = vec![f64::NAN; accelerations.len()];
        assert!(evaluator.inverse_dynamics(point, &accelerations, &mut found));
        let equations = oracle
            .equations(sample.time, &sample.state, &sample.inputs)
            .expect("a state of this model");
        for (found, expected) in found.iter().zip(equations.missing_forces(&accelerations)) {
            let off = (found - expected.value).abs();
            assert!(
                off <= TOLERANCE * expected.scale,
                "{found} and {}\n{}",
                expected.value,
                model.source.text
            );
        }
    }
    operations
}

#[test]
fn inverse_dynamics_of_random_trees_matches_oracle() {
    let mut random = Random::new(20);
    let (mut all_rates, mut all_inverse) = (0, 0);
    for _ in 0..TREES {
        let (rates, inverse) = compare_with_oracle(&check_model(&tree(&mut random)));
        all_rates += rates;
        all_inverse += inverse;
    }
    // If inverse dynamics used mass matrices, or one sweep per coordinate, the ratio would be 0.71.
    assert!(2 * all_inverse < all_rates, "{all_inverse} of {all_rates}");
}

#[test]
fn inverse_dynamics_of_six_joints_matches_oracle() {
    let (rates, inverse) = compare_with_oracle(&eomgen_tests::models::load("puma_560"));
    assert!(5 * inverse < 2 * rates, "{inverse} of {rates}");
}
