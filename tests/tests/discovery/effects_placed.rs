//! Test of all sites in the shipped specifications: with each effect of the catalogue added, the specification passes
//! the checks and can be derived.

use std::collections::{BTreeMap, BTreeSet};

use eomgen_codegen::variant::Variant;
use eomgen_discover::catalogue::candidate::{Candidate, list_candidates};
use eomgen_discover::catalogue::effect::{Effect, SiteKind};
use eomgen_discover::catalogue::load_effects;
use eomgen_discover::catalogue::sites::find_sites;
use eomgen_discover::catalogue::usual_motion::UsualMotion;
use eomgen_discover::interval::Interval;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::shipped_specifications;

/// Returns the candidates of an effect in a model; of a periodic effect only the first order at each site and angle.
fn candidates_of(model: &Model, effect: &Effect) -> Vec<Candidate> {
    let one = std::slice::from_ref(effect);
    let mut found = list_candidates(model, one, &find_sites(model), &UsualMotion::default());
    let key = |c: &Candidate| {
        (
            c.site.clone(),
            c.angle_order.as_ref().map(|(angle, _)| angle.clone()),
            c.load.clone(),
        )
    };
    found.dedup_by(|a, b| key(a) == key(b));
    found
}

#[test]
fn catalogue_effects_keep_shipped_specifications_valid() {
    let effects = load_effects(None).expect("the catalogue");
    let mut homes: BTreeMap<usize, BTreeSet<String>> = BTreeMap::new();
    for path in shipped_specifications() {
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(&path).expect("a specification");
        let model = eomgen_model_spec::load(&path).expect("a model").model;
        for (place, effect) in effects.iter().enumerate() {
            for candidate in candidates_of(&model, effect) {
                let label = format!("{} in {name}", candidate.label());
                let values = vec![1.5; candidate.parameters.len()];
                let written = candidate.write_effect(&text, &name, &values, "a test");
                let written = written.unwrap_or_else(|error| panic!("{label}: {error}"));
                let checked =
                    eomgen_model_spec::check(Source::new(name.as_str(), written.as_str()));
                let checked = checked.unwrap_or_else(|found| panic!("{label}: {found}"));
                let orders = vec![1; checked.model.fields.len()];
                let derived = Variant::derive(&checked.model, &orders);
                assert!(derived.is_ok(), "{label}: {:?}", derived.err());
                homes.entry(place).or_default().insert(name.clone());
            }
        }
    }
    for (place, effect) in effects.iter().enumerate() {
        let homes = homes.get(&place).map_or(0, BTreeSet::len);
        // All shipped machines with several masses in space have weight; the tests in `effects_found` contain a machine
        // without weight.
        assert!(
            homes > 0 || effect.site_kind == SiteKind::Machine,
            "`{}` ({}) has no site in any shipped specification",
            effect.name,
            effect.description
        );
    }
    // Every moving coordinate must be a site of axis effects.
    let axis = effects
        .iter()
        .position(|effect| effect.site_kind == SiteKind::Axis);
    let of_axis = axis
        .and_then(|axis| homes.get(&axis))
        .map_or(0, BTreeSet::len);
    assert_eq!(of_axis, shipped_specifications().len(), "{homes:?}");
}

const ON_SPRINGS: &str = r#"
[[effect]]
name = "hardening"
site = "spring"
says = "a spring that hardens"
experiment = "large deflections"
parameters = [{ name = "k_h", unit = "N/m^3", sign = "+", doc = "hardening" }]
edits = [{ add = "potential", name = "hardening", value = "1/4*{k_h}*{p}^4" }]
"#;

const TWO_CARRIAGES: &str = r#"
[model]
name = "two_carriages"

[parameters]
m = { value = 1.5, unit = "kg" }
k = { value = 400, unit = "N/m" }
k_4 = { value = 400, unit = "N/m^3" }

[coordinates]
p = { unit = "m" }
q = { unit = "m" }

[kinetic]
both = "1/2*m*(dot(p)^2 + dot(q)^2)"

[potential]
spring = "1/2*k*(p - q)^2"
stop = "1/4*k_4*p^4"
"#;

/// Springs in several notations, and a force that only resembles a spring.
const SPRINGS: &str = r#"
[model]
name = "springs"

[parameters]
m = { value = 1.5, unit = "kg" }
J = { value = 0.1, unit = "kg m^2" }
r = { value = 0.2, unit = "m" }
k_1 = { value = 400, unit = "N/m" }
k_2 = { value = 300, unit = "N/m" }
k_t = { value = 5, unit = "N m" }

[coordinates]
p = { unit = "m" }
theta = { unit = "rad" }
phi = { unit = "rad" }

[definitions]
rim = "r*theta - p"

[kinetic]
mass = "1/2*m*dot(p)^2"
discs = "1/2*J*(dot(theta)^2 + dot(phi)^2)"

[potential]
both = "1/2*k_1*p^2 + k_2*rim^2/2"
shaft = "0.5*k_t*(theta - phi)^2"
other = "k_1*p*p - 1/2*k_1*p^2"
"#;

fn check_model(text: &str) -> Model {
    let checked = eomgen_model_spec::check(Source::new("machine.toml", text));
    checked.unwrap_or_else(|found| panic!("{found}")).model
}

#[test]
fn springs_are_recognised_in_all_notations() {
    let model = check_model(SPRINGS);
    let springs = find_sites(&model)
        .into_iter()
        .filter(|site| site.kind == SiteKind::Spring);
    let springs: Vec<[String; 3]> = springs
        .map(|site| [&site.name, &site.arguments["p"], &site.arguments["unit"]].map(Clone::clone))
        .collect();
    let expected = [
        ["both_k_1", "p", "m"],
        ["both_k_2", "rim", "m"],
        ["shaft", "(theta - phi)", "rad"],
    ];
    assert_eq!(springs, expected.map(|words| words.map(str::to_owned)));
}

#[test]
fn user_defined_effect_is_placed_on_springs() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("effects.toml");
    std::fs::write(&path, ON_SPRINGS).expect("a file");
    let effects = load_effects(Some(&path)).unwrap_or_else(|found| panic!("{found}"));
    let own = effects.last().expect("an effect");
    assert!(own.is_user_defined);
    let model = check_model(TWO_CARRIAGES);
    let found = candidates_of(&model, own);
    let places: Vec<&str> = found
        .iter()
        .map(|candidate| candidate.site.as_str())
        .collect();
    assert_eq!(places, ["spring"], "a cubic force is no linear spring");
    assert_eq!(found[0].term, "1/4*k_h*(p - q)^4");
}

/// Pendulum with observables that depend on its angle. Friction on an observable is equivalent to friction on the angle
/// only if they are proportional.
const BOB: &str = r#"
[model]
name = "bob"

[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.3, unit = "m" }
a = { value = 0.1, unit = "rad" }

[coordinates]
th = { unit = "rad" }

[definitions]
OBSERVED

[kinetic]
bob = "1/2*m*l^2*dot(th)^2"

[observables]
shown = { value = "y", unit = "UNIT" }
"#;

#[test]
fn only_affine_observables_replace_a_coordinate_as_site() {
    for (definitions, unit, replaces) in [
        ("y = \"th\"", "rad", true),
        ("y = \"2*th + a\"", "rad", true),
        ("y = \"-l*(th - a)/2\"", "m", true),
        ("x = \"th*cos(a)\"\ny = \"l*x - l\"", "m", true),
        ("y = \"l*sin(th)\"", "m", false),
        ("x = \"l*sin(th)\"\ny = \"2*x\"", "m", false),
        ("y = \"th^2\"", "rad", false),
        ("y = \"l*th*th\"", "m", false),
        ("y = \"l/(1 + th)\"", "m", false),
        ("y = \"l*th + l*cos(th)\"", "m", false),
    ] {
        let text = BOB.replace("OBSERVED", definitions).replace("UNIT", unit);
        let sites = find_sites(&check_model(&text));
        let axes = sites
            .iter()
            .filter(|site| matches!(site.kind, SiteKind::Axis | SiteKind::Angle));
        let axes: Vec<&str> = axes.map(|site| site.name.as_str()).collect();
        let expected = match replaces {
            true => &["shown"][..],
            false => &["shown", "th"],
        };
        assert_eq!(axes, expected, "{definitions}");
    }
}

/// Beam on a joint with its bending energy.
const BEAM: &str = r#"
[model]
name = "beam"

[parameters]
mu = { value = 1.5, unit = "kg/m" }
E = { value = 2e9, unit = "Pa" }
I = { value = 1e-9, unit = "m^4" }
EI = { value = 2, unit = "N m^2" }
l = { value = 0.8, unit = "m" }

[fields.w]
along = "x"
from = 0
to = "l"
unit = "m"
basis = "clamped_free"
coordinates = "q"
order = 1

[kinetic]
mass = "1/2*integral(mu*dot(w)^2, w)"

[potential]
bending = "ENERGY"
"#;

#[test]
fn bending_stiffness_is_recognised_in_all_notations() {
    for (energy, stiffness) in [
        ("1/2*integral(EI*diff(w, x, 2)^2, w)", "EI"),
        ("integral(1/2*EI*diff(w, x, 2)^2, w)", "EI"),
        ("1/2*EI*integral(diff(w, x, 2)^2, w)", "EI"),
        ("integral(EI*diff(w, x, 2)^2, w)/2", "EI"),
        ("integral(EI/2*diff(w, x, 2)^2, w)", "EI"),
        ("integral(diff(w, x, 2)^2*EI, w)*0.5", "EI"),
        ("EI*integral(diff(w, x, 2)^2/2, w)", "EI"),
        ("0.5*integral(diff(w, x, 2)*EI*diff(w, x, 2), w)", "EI"),
        ("integral(EI*diff(w, x, 2)^2, w)", "2*EI"),
        ("1/2*E*integral(I*diff(w, x, 2)^2, w)", "E*I"),
        ("1/2*integral(E*diff(w, x, 2)^2*I, w)", "E*I"),
        ("1/2*integral((EI + E*I)*diff(w, x, 2)^2, w)", "(EI + E*I)"),
        (
            "1/2*integral(EI*(1 - x/l)^2*diff(w, x, 2)^2, w)",
            "EI*(1 - x/l)^2",
        ),
        (
            "1/2*integral(EI*l/(l + x)*diff(w, x, 2)^2, w)",
            "EI*l/(l + x)",
        ),
        (
            "1/2*integral(EI*w^2/l^4, w) + integral(EI*diff(w, x, 2)^2, w)/2",
            "EI",
        ),
    ] {
        let text = BEAM.replace("ENERGY", energy);
        let model = check_model(&text);
        let sites = find_sites(&model);
        let mut arms = sites.iter().filter(|site| site.kind == SiteKind::Arm);
        let arm = arms.next().unwrap_or_else(|| panic!("{energy}"));
        let found = arm.arguments.get("stiffness").map(String::as_str);
        assert_eq!(found, Some(stiffness), "{energy}");
        let effects = load_effects(None).expect("the catalogue");
        let mut effects = effects.iter().filter(|e| e.name == "structural_damping");
        let damping = candidates_of(&model, effects.next().expect("an effect"));
        let written = damping[0].write_effect(&text, "beam", &[1e-3], "a test");
        check_model(&written.unwrap_or_else(|error| panic!("{energy}: {error}")));
    }
}

#[test]
fn initial_position_of_a_stop_is_within_the_motion_on_its_side() {
    let model = check_model(TWO_CARRIAGES);
    let effects = load_effects(None).expect("the catalogue");
    let stops = effects.iter().filter(|effect| effect.name == "end_stop");
    let stops: Vec<&Effect> = stops.collect();
    for (low, high) in [(-1.0, 1.0), (-0.5, 1.0), (-1.0, 0.2), (-0.01, 3.0)] {
        let motion = UsualMotion {
            ranges: [("(p - q)".to_owned(), Interval::new(low, high))].into(),
            ..UsualMotion::default()
        };
        let sites = find_sites(&model);
        let found = list_candidates(&model, stops.iter().copied(), &sites, &motion);
        let places: Vec<f64> = found
            .iter()
            .filter(|candidate| candidate.site == "spring")
            .flat_map(|candidate| &candidate.parameters)
            .filter_map(|parameter| parameter.shape_size)
            .collect();
        let travels = [f64::max(-low, high), high, -low];
        let right = travels.map(|travel| 0.6 * travel);
        assert_eq!(places.len(), right.len(), "{low} to {high}");
        for (place, right) in places.iter().zip(right) {
            assert!((place - right).abs() < 1e-12, "{low} to {high}: {places:?}");
        }
    }
}

/// Dampers parallel to a spring in several notations, and a force that only resembles a damper.
const DAMPERS: &str = r#"
[model]
name = "dampers"

[parameters]
J = { value = 0.1, unit = "kg m^2" }
r_1 = { value = 0.2, unit = "m" }
r_2 = { value = 0.3, unit = "m" }
k = { value = 400, unit = "N/m" }
d = { value = 2, unit = "N s/m" }
d_t = { value = 0.1, unit = "N m s" }
d_4 = { value = 0.1, unit = "N m s^3" }
F = { value = 10, unit = "N" }

[coordinates]
theta = { unit = "rad" }
phi = { unit = "rad" }
psi = { unit = "rad" }

[definitions]
way = "r_1*theta - r_2*phi"
slip = "phi*r_2/r_1 - theta"

[kinetic]
discs = "1/2*J*(dot(theta)^2 + dot(phi)^2 + dot(psi)^2)"

[potential]
belt = "1/2*k*(r_1*(theta - phi*r_2/r_1))^2"

[dissipation]
along = "1/2*d*dot(way)^2"
both = "1/2*d_t*dot(psi)^2 + d_t*dot(slip)^2/2"
bearings = "1/2*d_t*dot(theta)^2"
shaft = "1/2*d_t*(dot(theta) - dot(phi))^2"
fast = "1/4*d_4*dot(slip)^4"

[forces]
guide = { on = "way", value = "F - d*(r_1*dot(theta) - r_2*dot(phi))" }
other = { on = "theta", value = "-d_t*dot(slip)" }
"#;

#[test]
fn parallel_dampers_are_recognised_in_all_notations() {
    let model = check_model(DAMPERS);
    let belt = find_sites(&model)
        .into_iter()
        .find(|site| site.name == "belt");
    let dampers = belt.expect("a spring").dampers.into_iter();
    let dampers: Vec<[String; 2]> = dampers.map(|damper| [damper.term, damper.part]).collect();
    let expected = [
        ["along", "1/2*d*dot(way)^2"],
        ["both", "d_t*dot(slip)^2/2"],
        ["guide", "d*(r_1*dot(theta) - r_2*dot(phi))"],
    ];
    assert_eq!(dampers, expected.map(|words| words.map(str::to_owned)));
}

#[test]
fn backlash_can_include_parallel_dampers() {
    let model = check_model(DAMPERS);
    let effects = load_effects(None).expect("the catalogue");
    let play = effects.iter().filter(|effect| effect.name == "backlash");
    let written: Vec<String> = play
        .flat_map(|effect| candidates_of(&model, effect))
        .map(|candidate| candidate.write_effect(DAMPERS, "dampers", &[1e-3], "a test"))
        .map(|written| written.unwrap_or_else(|error| panic!("{error}")))
        .collect();
    let [opened, apart] = &written[..] else {
        panic!("{written:#?}");
    };
    for line in [
        "both = \"1/2*d_t*dot(psi)^2 + (d_t*dot(slip)^2/2*contact(",
        "bearings = \"1/2*d_t*dot(theta)^2\"",
        "value = \"F - (d*(r_1*dot(theta) - r_2*dot(phi))*contact(",
    ] {
        assert!(opened.contains(line), "{opened}");
    }
    assert!(!apart.contains("contact("), "{apart}");
    assert!(apart.contains("deadzone("), "{apart}");
}

/// Motor whose input drives a current and acts on the shaft.
const MOTOR: &str = r#"
[model]
name = "motor"

[parameters]
J = { value = 0.1, unit = "kg m^2" }
R = { value = 2, unit = "N m s" }
tau = { value = 0.1, unit = "s" }

[coordinates]
theta = { unit = "rad" }

[inputs]
u = { unit = "N m" }
v = { unit = "N m" }

[states]
T = { unit = "N m", rate = "(u - T)/tau" }

[definitions]
both = "u + v"

[kinetic]
rotor = "1/2*J*dot(theta)^2"

[dissipation]
bearing = "1/2*R*dot(theta)^2"

[forces]
drive = { on = "theta", value = "T + 0.1*both" }
"#;

fn documented_effect() -> String {
    let text = include_str!("../../../docs/discovery.md");
    let examples = text.split("```toml\n").skip(1);
    let mut blocks = examples.filter_map(|rest| rest.split_once("```").map(|(block, _)| block));
    let effects = blocks.find(|block| block.contains("site = \"input\""));
    effects.expect("an example").to_owned()
}

#[test]
fn effect_on_an_input_applies_to_all_its_uses() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("effects.toml");
    std::fs::write(&path, documented_effect()).expect("a file");
    let effects = load_effects(Some(&path)).unwrap_or_else(|found| panic!("{found}"));
    let model = check_model(MOTOR);
    for (name, lines) in [
        (
            "valve_overlap",
            &[
                "T = { unit = \"N m\", rate = \"(deadzone(u, u_0) - T)/tau\" }",
                "both = \"deadzone(u, u_0) + v\"",
            ][..],
        ),
        (
            "input_lag",
            &[
                "T = { unit = \"N m\", rate = \"(acting - T)/tau\" }",
                "both = \"acting + v\"",
                "acting = { unit = \"N m\", rate = \"w_b*(u - acting)\", doc = \"acting input\" }",
            ],
        ),
    ] {
        let mut named = effects.iter().filter(|effect| effect.name == name);
        let found = candidates_of(&model, named.next().expect("an effect"));
        let places: Vec<&str> = found.iter().map(|c| c.site.as_str()).collect();
        assert_eq!(places, ["u", "v"]);
        let written = found[0].write_effect(MOTOR, "motor.toml", &[0.5], "");
        let written = written.unwrap_or_else(|error| panic!("{name}: {error}"));
        for line in lines {
            assert!(written.lines().any(|own| own == *line), "{line}: {written}");
        }
    }
}
