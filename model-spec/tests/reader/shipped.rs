//! Shipped specifications: they load without a warning and have the published values.

use std::path::Path;

use eomgen_model_spec::model::Model;
use eomgen_model_spec::models;

fn shipped(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let checked =
        eomgen_model_spec::load(&folder.join(name)).unwrap_or_else(|found| panic!("{found}"));
    assert!(checked.warnings.is_empty(), "{}", checked.warnings);
    checked.model
}

fn value(model: &Model, name: &str) -> f64 {
    let index = model
        .parameters
        .iter()
        .position(|parameter| parameter.name == name);
    let values = model.parameter_values().expect("checked");
    values[index.unwrap_or_else(|| panic!("{name}"))]
}

mod bodies;

mod vectors;

#[test]
fn shipped_specifications_load_without_warnings() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the models are there") {
        let name = entry
            .expect("readable")
            .file_name()
            .into_string()
            .expect("ASCII");
        let model = shipped(&name);
        assert_eq!(format!("{}.toml", model.name), name);
        names.push(name);
    }
    assert_eq!(names.len(), models::ALL.len(), "{names:?}");
}

#[test]
fn arm_has_the_names_and_values_of_the_paper() {
    let model = shipped("planetary_arm.toml");
    let orders = model.orders(None).expect("its own order");
    let expected = [
        "x_sp", "x_pr", "x_c", "q_1", "q_2", "q_3", "q_4", "x_sp_dot", "x_pr_dot", "x_c_dot",
        "q_1_dot", "q_2_dot", "q_3_dot", "q_4_dot",
    ];
    assert_eq!(model.state_names(&orders), expected);
    assert_eq!(value(&model, "b_sp"), 25e-6);
    assert_eq!(value(&model, "m"), 3e-3);
    assert_eq!(value(&model, "omega"), 10.0 * std::f64::consts::PI);
    assert_eq!(value(&model, "I"), 8.333e-10);
    for observable in [
        "theta_s",
        "theta_p",
        "theta_c",
        "tip",
        "dtheta",
        "f_la",
        "f_la_signed",
        "F_sp",
        "F_pr",
    ] {
        assert!(
            model
                .observables
                .iter()
                .any(|known| known.name == observable),
            "{observable}"
        );
    }
}

#[test]
fn geometry_of_the_arm_closes() {
    let model = shipped("planetary_arm.toml");
    let of = |name| value(&model, name);
    let carrier = of("r_c") * of("alpha").cos();
    // Both sides have several roundings, so the tolerance is ten units in the last place.
    assert!((carrier - of("r_s") - of("r_p")).abs() <= 10.0 * f64::EPSILON * carrier);
    let ratio = 2.0 * (of("z_s") + of("z_p")) / of("z_s");
    assert!((of("i_sH") - ratio).abs() <= 10.0 * f64::EPSILON * ratio);
    // The inertia of the arm in Table I is 0.033 kg m^2; the computed value agrees to the printed digits.
    let arm = of("rho") * of("A") * of("l").powi(3) / 3.0;
    assert!((arm - 0.033).abs() < 0.0005);
}

#[test]
fn units_of_observables_are_declared_or_inferred() {
    let model = shipped("hub_beam_tip_mass.toml");
    let units: Vec<_> = model
        .observables
        .iter()
        .map(|o| o.unit.to_string())
        .collect();
    assert_eq!(units, ["m", "rad"]);
    assert_eq!(value(&model, "E"), 70e9);
    assert_eq!(value(&model, "I"), 67.5e-12);
}

#[test]
fn constants_equal_the_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let files = std::fs::read_dir(&folder).expect("the models are there");
    assert_eq!(models::ALL.len(), files.count());
    for model in models::ALL {
        let file = folder.join(model.source().path);
        let text = std::fs::read_to_string(&file).expect("a file of the constant's name");
        assert!(model.text == text, "{}", file.display());
    }
}
