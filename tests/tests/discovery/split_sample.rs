//! Tests of p-values in records of a rotor: p-values of absent effects are uniformly distributed or larger, and the
//! p-value of a present effect is small.

use std::path::Path;

use eomgen_discover::catalogue::candidate::list_candidates;
use eomgen_discover::catalogue::load_effects;
use eomgen_discover::catalogue::sites::find_sites;
use eomgen_discover::catalogue::usual_motion::UsualMotion;
use eomgen_discover::fit::null_model::fit_null_model;
use eomgen_discover::ids::ResponseId;
use eomgen_discover::model::problem::EstimationProblem;
use eomgen_discover::search::context::RoundContext;
use eomgen_discover::search::hypothesis::Hypothesis;
use eomgen_discover::search::hypothesis_fits::{run_full_fits, run_preliminary_fits};
use eomgen_discover::search::pool::CandidatePool;
use eomgen_discover::search::screening::screen_candidates;
use eomgen_model_spec::source::Source;
use eomgen_records::read_dataset;
use eomgen_tests::random_numbers::NormalNumbers;

const SPECIFICATION: &str = r#"
[model]
name = "rotor"

[parameters]
J = { value = 0.02, unit = "kg m^2", min = 0 }
c = { value = 0.02, unit = "N m s", min = 0 }

[coordinates]
x = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
rotor = "1/2*J*dot(x)^2"

[dissipation]
bearing = "1/2*c*dot(x)^2"

[forces]
motor = { on = "x", value = "u" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.u]
column = "u"
unit = "N m"

[channels.x]
column = "x"
unit = "rad"
noise = 1e-3

[initial]
state = "estimate"

[uncertain]
J = { relative = 0.05 }

[windows]
length = 0.4
"#;

const NOISE: f64 = 1e-3;

/// Returns a record with an additional constant force, by the midpoint rule.
fn record(normal: &mut NormalNumbers, turn: f64, force: f64) -> String {
    let (sample, samples, parts) = (0.01, 200, 20);
    let h = sample / f64::from(parts);
    let (mut x, mut v) = (0.0, 0.0);
    let mut text = "t,u,x\n".to_owned();
    for number in 0..samples {
        let t = sample * f64::from(number);
        let u = 0.5 * (2.1 * t + turn).cos() - 0.25 * (7.0 * t + turn).sin();
        text += &format!("{t:.3},{u:.12},{:.12}\n", x + NOISE * normal.draw());
        for _ in 0..parts {
            let acceleration = |v: f64| (u + force - 0.02 * v) / 0.02;
            let middle = v + 0.5 * h * acceleration(v);
            x += h * middle;
            v += h * acceleration(middle);
        }
    }
    text
}

const NAMES: [&str; 4] = [
    "force_offset",
    "quadratic_drag",
    "asymmetric_friction",
    "elastic_restraint",
];

/// Returns the p-value of each effect of `NAMES` that reduces the residual.
fn p_values(seed: u64, force: f64) -> Vec<Option<f64>> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut normal = NormalNumbers::new(12_345 + 7_919 * seed);
    for (name, turn) in [("train.csv", 0.3), ("test.csv", 1.7)] {
        let text = record(&mut normal, turn + 0.1 * seed as f64, force);
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    std::fs::write(folder.path().join("dataset.toml"), DATASET).expect("a file");
    let source = Source::new("rotor.toml", SPECIFICATION);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let dataset = read_dataset(Path::new(&folder.path().join("dataset.toml")), &model);
    let dataset = dataset.unwrap_or_else(|refusal| panic!("{refusal}"));
    let problem = EstimationProblem::new(&dataset, None, "rotor.toml", SPECIFICATION);
    let fit = fit_null_model(&problem, SPECIFICATION).expect("a fit");
    let mut all = list_candidates(
        &model,
        &load_effects(None).expect("the catalogue"),
        &find_sites(&model),
        &UsualMotion::default(),
    );
    all.retain(|candidate| NAMES.contains(&candidate.effect.as_str()));
    all.sort_by_key(|candidate| NAMES.iter().position(|name| *name == candidate.effect));
    let screening = screen_candidates(&problem, &fit, &all, 1.0);
    let context = RoundContext {
        problem: &problem,
        fit: &fit,
        floor: 1.0,
        effects: &[],
        progress: &|_| {},
    };
    let pool = CandidatePool::new(context, &all, &screening, true);
    let of = |candidate: usize| {
        let responses = ResponseId::first(screening.responses.len());
        let response = { responses }
            .find(|response| screening.responses[*response].candidate.index() == candidate)?;
        let hypothesis = Hypothesis {
            predicted_sizes: screening.responses[response].sizes.clone(),
            responses: vec![response],
            replaced_parameter: None,
        };
        let fitted = run_full_fits(&pool, run_preliminary_fits(&pool, vec![hypothesis]));
        fitted.first()?.p_value
    };
    (0..NAMES.len()).map(of).collect()
}

#[test]
fn p_values_of_absent_effects_are_uniform_or_larger() {
    let cases = 60;
    let all: Vec<Vec<Option<f64>>> = (1..=cases).map(|seed| p_values(seed, 0.0)).collect();
    let mut smallest: Vec<f64> = Vec::new();
    for (place, name) in NAMES.iter().enumerate() {
        let own: Vec<f64> = all.iter().filter_map(|of| of[place]).collect();
        println!("{name}: {own:.3?}");
        assert_uniform_or_larger(name, &own);
        // A parameter that must not be negative is estimated as zero in half of the cases, which then have no p-value.
        assert!(own.len() as u64 > cases / 4, "{name}: {}", own.len());
    }
    for of in &all {
        let of: Vec<f64> = of.iter().flatten().copied().collect();
        let least = of.iter().copied().fold(1.0, f64::min);
        smallest.push((least * of.len() as f64).min(1.0));
    }
    assert_uniform_or_larger("the smallest of all, adjusted", &smallest);
}

/// Asserts that the number of p-values below each level exceeds the expectation by at most two and
/// a half standard errors.
fn assert_uniform_or_larger(name: &str, p_values: &[f64]) {
    let count = p_values.len() as f64;
    for level in [0.02, 0.05, 0.1, 0.2, 0.5] {
        let below = p_values.iter().filter(|p| **p <= level).count() as f64;
        let most = count * level + 2.5 * (count * level * (1.0 - level)).sqrt();
        println!("{name}: {below} of {count} at {level}, at most {most:.1}");
        assert!(below <= most, "{name}: {below} of {count} at {level}");
    }
}

#[test]
fn p_value_of_present_effect_is_small() {
    let own = p_values(1, 2e-2)[0].expect("a p-value");
    assert!(own < 1e-6, "{own}");
}
