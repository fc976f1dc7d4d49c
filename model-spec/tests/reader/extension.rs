//! Specifications that extend others.

use std::path::Path;

use eomgen_model_spec::edit::{Edit, SetParameter, apply};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::{check, load};
use tempfile::TempDir;

const ARM: &str = r#"
[model]
name = "arm"
title = "Arm with play"
[parameters]
J = { value = 2, unit = "kg m^2" }
k = { value = 900, unit = "N m" }
b = { value = 0.002, unit = "rad" }
c = { value = 0.1, unit = "N m s" }
rho = { value = 3, unit = "kg/m" }
l = { value = 1, unit = "m" }
[coordinates]
theta = { unit = "rad" }
psi.unit = "rad"
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 1
unit = "m"
[kinetic]
arm = "1/2*J*dot(theta)^2"
motor = "1/2*J*dot(psi)^2"
beam = "1/2*integral(rho*dot(w)^2, w)"
[potential]
gear = "1/2*k*deadzone(theta - psi, b)^2"
[dissipation]
gear = "1/2*c*dot(theta)^2"
"#;

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, text).expect("a file");
    }
    folder
}

fn model(folder: &TempDir, name: &str) -> Model {
    let loaded = load(&folder.path().join(name));
    loaded.unwrap_or_else(|found| panic!("{found}")).model
}

fn rejected(files: &[(&str, &str)], name: &str) -> String {
    let folder = folder(files);
    let shown = load(&folder.path().join(name))
        .expect_err(name)
        .render(false);
    shown.replace(&folder.path().display().to_string(), "FOLDER")
}

#[test]
fn entries_are_replaced_added_and_removed() {
    let rigid = "[model]\nextends = \"arm.toml\"\nname = \"rigid\"\ntitle = false\n\
                 [parameters]\nb = false\nk = { value = 1, unit = \"kN m\" }\n\
                 [potential]\ngear = \"1/2*k*(theta - psi)^2\"\n\
                 [kinetic]\nbeam = false\n[fields]\nw = false\n\
                 [observables]\ntwist = \"theta - psi\"\n";
    let folder = folder(&[("arm.toml", ARM), ("rigid.toml", rigid)]);
    let model = model(&folder, "rigid.toml");
    assert_eq!((&*model.name, &*model.title), ("rigid", "rigid"));
    assert!(model.fields.is_empty());
    // Replaced entries keep their position.
    let names: Vec<&str> = model.parameters.iter().map(|p| &*p.name).collect();
    assert_eq!(names, ["J", "k", "c", "rho", "l"]);
    assert_eq!(model.parameter_values().expect("values")[1], 1000.0);
    assert_eq!(model.observables[0].name, "twist");
    // The merged text is complete: it passes the checks without the other file.
    let alone = check(Source::new("copy.toml", model.source.text.clone()));
    assert_eq!(
        alone.expect("complete").model.state_names(&[]),
        model.state_names(&[])
    );
}

#[test]
fn extension_without_changes_is_the_same_model() {
    let folder = folder(&[
        ("arm.toml", ARM),
        ("copy.toml", "[model]\nextends = \"arm.toml\"\n"),
    ]);
    let (copy, arm) = (model(&folder, "copy.toml"), model(&folder, "arm.toml"));
    assert_eq!(copy.name, arm.name);
    assert_eq!(copy.state_names(&[3]), arm.state_names(&[3]));
    assert_eq!(copy.parameter_values(), arm.parameter_values());
}

#[test]
fn chains_resolve_each_path_from_its_own_file() {
    let shapes: String = (0..=8)
        .map(|k| f64::from(k) / 8.0)
        .map(|x| format!("{x},{}\n", x * x))
        .collect();
    let shapes = format!("x,phi_1\n{shapes}");
    let tabled = ARM.replace("\"clamped_free\"", "\"table\"\ntable = \"shapes.csv\"");
    let folder = folder(&[
        ("base/arm.toml", &tabled),
        ("base/shapes.csv", &shapes),
        (
            "middle/soft.toml",
            "[model]\nextends = \"../base/arm.toml\"\n[parameters]\nk = { value = 5, unit = \"N m\" }\n",
        ),
        (
            "top.toml",
            "[model]\nextends = \"middle/soft.toml\"\n[dissipation]\ngear = false\n[parameters]\nc = false\n",
        ),
        ("flat.toml", "[model]\nextends = \"base/arm.toml\"\n"),
    ]);
    let flat = model(&folder, "flat.toml");
    assert_eq!(
        flat.fields[0].basis.table().expect("a table").file,
        "base/shapes.csv"
    );
    let files: Vec<String> = flat
        .files()
        .iter()
        .map(|path| relative(path, &folder))
        .collect();
    assert_eq!(files, ["flat.toml", "base/arm.toml", "base/shapes.csv"]);
    // Tables must be in the folder of the first file or below, also if their path leads through another folder.
    let message = load(&folder.path().join("top.toml"))
        .expect_err("outside")
        .render(false);
    assert!(
        message.contains("is outside the specification's folder"),
        "{message}"
    );
    assert!(message.contains("arm.toml:20:9"), "{message}");
}

fn relative(path: &Path, folder: &TempDir) -> String {
    path.strip_prefix(folder.path())
        .expect("inside")
        .display()
        .to_string()
}

#[test]
fn messages_name_the_file_and_the_line_of_the_entry() {
    let wrong_base = ARM.replace("1/2*c*dot(theta)^2", "1/2*c*theta^2");
    let changed =
        "[model]\nextends = \"arm.toml\"\n\n[parameters]\nb = { value = 1, unit = \"mm\" }\n";
    let shown = rejected(&[("arm.toml", &wrong_base), ("a.toml", changed)], "a.toml");
    assert!(shown.contains("--> FOLDER/arm.toml:30:9"), "{shown}");
    assert!(shown.contains("30 | gear = \"1/2*c*theta^2\""), "{shown}");
    // The second label of an error is in another file.
    let twice = "[model]\nextends = \"arm.toml\"\n[coordinates]\nk = { unit = \"m\" }\n";
    let both = rejected(&[("arm.toml", ARM), ("a.toml", twice)], "a.toml");
    let has = |place: &str| both.contains(&format!("FOLDER/{place}"));
    assert!(has("a.toml:4:1") && has("arm.toml:7"), "{both}");
    let folder = folder(&[("arm.toml", &wrong_base), ("a.toml", changed)]);
    let found = load(&folder.path().join("a.toml")).expect_err("wrong");
    let places: Vec<(bool, Option<usize>)> = (found.records().iter())
        .map(|record| (record.file.ends_with("arm.toml"), record.line))
        .collect();
    assert!(places.contains(&(true, Some(30))), "{places:?}");
    // Unused names in several files are reported together.
    let unused = ARM.replace("b = {", "spare = { value = 1 }\nb = {");
    let folder = self::folder(&[
        ("arm.toml", &unused),
        (
            "a.toml",
            "[model]\nextends = \"arm.toml\"\n[parameters]\nother = { value = 2 }\n",
        ),
    ]);
    let checked = load(&folder.path().join("a.toml")).expect("valid");
    let shown = checked.warnings.render(false);
    assert!(
        shown.contains("arm.toml:8:1, ") && shown.contains("a.toml:4:1)"),
        "{shown}"
    );
}

#[test]
fn wrong_extensions_are_rejected_with_their_place() {
    let extends = |file: &str| format!("[model]\nextends = \"{file}\"\n");
    let chain: Vec<(String, String)> = (0..20)
        .map(|k| (format!("{k}.toml"), extends(&format!("{}.toml", k + 1))))
        .collect();
    let chain: Vec<(&str, &str)> = chain
        .iter()
        .map(|(name, text)| (&**name, &**text))
        .collect();
    for (files, expected) in [
        (
            vec![("a.toml", &*extends("a.toml"))],
            "\"a.toml\" extends itself",
        ),
        (
            vec![
                ("a.toml", &*extends("b.toml")),
                ("b.toml", &*extends("./a.toml")),
            ],
            "b.toml:2:11",
        ),
        (
            vec![("a.toml", &*extends("no.toml"))],
            "\"no.toml\" cannot be read",
        ),
        (
            vec![("a.toml", &*extends("/etc/passwd"))],
            "needs a relative path",
        ),
        (vec![("a.toml", &*extends(""))], "needs a relative path"),
        (
            vec![("a.toml", "[model]\nextends = 3\n")],
            "`extends` is not a string",
        ),
        (
            vec![("a.toml", &*extends("b.toml")), ("b.toml", "[model\n")],
            "b.toml:1:7",
        ),
        (
            vec![
                (
                    "a.toml",
                    &*(extends("arm.toml") + "[potential]\ngaer = false\n"),
                ),
                ("arm.toml", ARM),
            ],
            "a.toml:4:8",
        ),
        (
            vec![
                (
                    "a.toml",
                    &*(extends("arm.toml") + "[parameters]\nd = { value = 1, unti = 2 }\n"),
                ),
                ("arm.toml", ARM),
            ],
            "a.toml:4:18",
        ),
    ] {
        let shown = rejected(&files, "a.toml");
        assert!(shown.contains(expected), "{expected}\n{shown}");
    }
    let shown = rejected(&chain, "0.toml");
    assert!(
        shown.contains("more than 16 files") && shown.contains("15.toml:2:11"),
        "{shown}"
    );
    let cycle = rejected(
        &[
            ("a.toml", &extends("b.toml")),
            ("b.toml", &extends("./a.toml")),
        ],
        "a.toml",
    );
    assert!(cycle.contains("extends this file"), "{cycle}");
}

#[test]
fn text_without_a_file_cannot_extend() {
    let source = Source::new("text", "[model]\nname = \"a\"\nextends = \"arm.toml\"\n");
    let shown = check(source).expect_err("no folder").render(false);
    assert!(
        shown.contains("text:3:1") && shown.contains("given as text"),
        "{shown}"
    );
}

#[test]
fn edits_apply_to_the_merged_text() {
    let folder = folder(&[
        ("arm.toml", ARM),
        ("copy.toml", "[model]\nextends = \"arm.toml\"\n"),
    ]);
    let copy = model(&folder, "copy.toml");
    let edit = Edit::SetParameter(SetParameter {
        name: "k".to_owned(),
        value: 7.0,
        source: String::new(),
    });
    let text = apply(&copy.source, &[edit]).expect("edited");
    let edited = check(Source::new("edited.toml", text))
        .expect("complete")
        .model;
    assert_eq!(edited.parameter_values().expect("values")[1], 7.0);
}
