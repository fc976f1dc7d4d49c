//! Tests of `eomgen family`: variants with certificates and a manifest, comparison, linking, and invalid family files.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use eomgen_tests::models::{path, project};
use eomgen_tests::program::eomgen;
use serde_json::Value;
use tempfile::TempDir;

/// Slewing beam that is driven through a gear with play.
const BEAM: &str = r#"
[model]
name = "beam"
[parameters]
J = { value = 0.012, unit = "kg m^2" }
k = { value = 900, unit = "N m" }
b = { value = 0.002, unit = "rad" }
l = { value = 0.8, unit = "m" }
rho = { value = 0.42, unit = "kg/m" }
B = { value = 18.0, unit = "N m^2" }
[coordinates]
motor = { unit = "rad" }
hub = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 3
unit = "m"
[kinetic]
motor = "1/2*J*dot(motor)^2"
hub = "1/2*J*dot(hub)^2"
boom = "1/2*integral(rho*(x*dot(hub) + dot(w))^2, w)"
[potential]
gear = "1/2*k*deadzone(motor - hub, b)^2"
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
[forces]
torque = { on = "motor", value = "u" }
[observables]
tip = "l*hub + at(w, l)"
"#;

/// Slewing beam without play.
const STIFF: &str = "[model]\nextends = \"beam.toml\"\n[parameters]\nb = false\n[potential]\ngear = \"1/2*k*(motor - hub)^2\"\n";

const FAMILY: &str = r#"
[family]
name = "beams"
operation_growth = 0.1

[[variant]]
name = "beam_1"
spec = "beam.toml"
order = 1
targets = ["rust", "c99"]

[[variant]]
name = "beam_3"
prefix = "long_beam"
spec = "beam.toml"
order = 3
set = { b = "1 mrad", k = 800 }
targets = ["rust", "c99"]
precision = ["f64", "f32"]

[[variant]]
name = "stiff_2"
spec = "stiff.toml"
order = 2
targets = ["c99"]
"#;

/// Creates a folder with the family and its output `models`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [
        ("beam.toml", BEAM),
        ("stiff.toml", STIFF),
        ("family.toml", FAMILY),
    ] {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

fn family(folder: &Path, more: &[&str]) -> (Option<i32>, String) {
    let mut command = eomgen();
    let command = command
        .current_dir(folder)
        .args(["family", "family.toml", "--out", "models"]);
    let output = command.args(more).output().expect("the program can be run");
    let said = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&said).into_owned(),
    )
}

pub(super) static WRITTEN: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = folder();
    let (status, said) = family(folder.path(), &[]);
    assert_eq!(status, Some(0), "{said}");
    folder
});

/// Returns all files below a folder, by relative path.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(current) = open.pop() {
        for entry in std::fs::read_dir(current).expect("a folder") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => open.push(path),
                false => {
                    let inside = path.strip_prefix(folder).expect("inside").to_owned();
                    all.push((inside, std::fs::read(&path).expect("a file")));
                }
            }
        }
    }
    all.sort();
    all
}

/// Returns a copy of the written family.
fn copy() -> TempDir {
    let copy = folder();
    for (path, contents) in files(WRITTEN.path()) {
        let place = copy.path().join(path);
        std::fs::create_dir_all(place.parent().expect("a folder")).expect("a folder");
        std::fs::write(place, contents).expect("a file");
    }
    copy
}

fn edit(path: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(path).expect("a file");
    assert!(text.contains(from), "{from}");
    std::fs::write(path, text.replacen(from, to, 1)).expect("a file");
}

#[test]
fn family_has_certificates_and_a_manifest_without_paths() {
    let models = WRITTEN.path().join("models");
    let text = std::fs::read_to_string(models.join("manifest.json")).expect("a manifest");
    let manifest: Value = serde_json::from_str(&text).expect("JSON");
    let folder = WRITTEN.path().display().to_string();
    assert!(!text.contains(&folder));
    for (variant, orders) in manifest["variants"]
        .as_array()
        .expect("variants")
        .iter()
        .zip([1, 3, 2])
    {
        assert_eq!(variant["orders"], serde_json::json!([orders]));
        assert_eq!(variant["verdict"], "passed");
        assert!(variant["operations"]["rates"].as_u64() > Some(10));
        let name = variant["name"].as_str().expect("a name");
        let certificate = std::fs::read_to_string(models.join(name).join("certificate.json"));
        let certificate: Value = serde_json::from_str(&certificate.expect("a file")).expect("JSON");
        let checks = certificate["checks"].as_array().expect("checks");
        let compiled = checks.iter().find(|check| check["name"] == "emitted_c");
        assert_eq!(
            compiled.expect("C is checked")["value"],
            0.0,
            "{certificate}"
        );
    }
    assert_eq!(manifest["variants"][1]["definition"]["set"][0], "b=1 mrad");
    let inputs = manifest["variants"][2]["inputs"]
        .as_object()
        .expect("inputs");
    let inputs: Vec<&String> = inputs.keys().collect();
    assert_eq!(inputs, ["beam.toml", "stiff.toml"]);
    assert!(!models.join("stiff_2/mod.rs").exists());
    // The same input must give the same bytes.
    let again = self::folder();
    assert_eq!(family(again.path(), &[]).0, Some(0));
    assert_eq!(files(again.path()), files(WRITTEN.path()));
}

#[test]
fn unchanged_variants_are_not_generated_again() {
    let copy = copy();
    let (status, said) = family(copy.path(), &["--check"]);
    assert_eq!(status, Some(0), "{said}");
    // The certificate of every generated variant needs a compiler.
    let place = copy.path().join("models");
    let mut command = eomgen();
    let command = command
        .current_dir(copy.path())
        .env("RUSTC", "no-such-compiler")
        .env("CC", "no-such-compiler");
    let output = command
        .args(["family", "family.toml", "--out", "models", "--json"])
        .output()
        .expect("a run");
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(document["different"], serde_json::json!([]), "{document}");
    assert_eq!(files(&place), files(&WRITTEN.path().join("models")));
    assert_eq!(family(copy.path(), &["--check", "--force"]).0, Some(0));
}

#[test]
fn comparison_names_each_difference() {
    let copy = copy();
    let models = copy.path().join("models");
    edit(&models.join("beam_1/mod.rs"), "2", "3");
    std::fs::remove_file(models.join("beam_3/long_beam.h")).expect("removed");
    edit(
        &copy.path().join("stiff.toml"),
        "b = false",
        "b = false # none",
    );
    let before = files(copy.path());
    let (status, said) = family(copy.path(), &["--check"]);
    assert_eq!(status, Some(1), "{said}");
    for expected in [
        "beam_1: edited: beam_1/mod.rs",
        "beam_3: missing: beam_3/long_beam.h",
        "stiff_2: stale: stiff.toml changed",
    ] {
        assert!(said.contains(expected), "{expected}\n{said}");
    }
    assert_eq!(files(copy.path()), before, "--check wrote files");
    // A comment does not change the merged specification, so the emitted files are unchanged.
    assert_eq!(family(copy.path(), &[]).0, Some(0));
    assert_eq!(family(copy.path(), &["--check"]).0, Some(0));
    let (now, then) = (files(&models), files(&WRITTEN.path().join("models")));
    let differing: Vec<&PathBuf> = now
        .iter()
        .zip(&then)
        .filter(|(a, b)| a != b)
        .map(|(a, _)| &a.0)
        .collect();
    assert_eq!(differing, [Path::new("manifest.json")]);
}

#[test]
fn comparison_reports_failed_certificates_and_more_operations() {
    let copy = copy();
    let models = copy.path().join("models");
    let manifest = models.join("manifest.json");
    let text = std::fs::read_to_string(&manifest).expect("a manifest");
    let mut document: Value = serde_json::from_str(&text).expect("JSON");
    document["variants"][0]["operations"]["rates"] = Value::from(5);
    document["variants"][1]["verdict"] = Value::from("failed");
    std::fs::write(&manifest, format!("{document:#}\n")).expect("written");
    let (status, said) = family(copy.path(), &["--check", "--force"]);
    assert_eq!(status, Some(1), "{said}");
    assert!(
        said.contains("beam_1: operations: rates: 5 before, "),
        "{said}"
    );
    assert!(
        said.contains("beam_3: certificate: the certificate is failed"),
        "{said}"
    );
}

#[test]
fn failed_variant_leaves_all_files_unchanged() {
    let copy = copy();
    edit(&copy.path().join("beam.toml"), "value = 900", "value = 901");
    edit(&copy.path().join("family.toml"), "order = 1", "order = 500");
    let before = files(copy.path());
    let (status, said) = family(copy.path(), &[]);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("in variant `beam_1` (family.toml:7)"),
        "{said}"
    );
    assert!(
        said.contains("500") && said.contains("nothing was written"),
        "{said}"
    );
    assert_eq!(files(copy.path()), before);
}

#[test]
fn files_of_removed_variants_are_removed_unless_edited() {
    let copy = copy();
    let models = copy.path().join("models");
    let text = FAMILY
        .split("[[variant]]\nname = \"beam_3\"")
        .next()
        .expect("a part");
    std::fs::write(copy.path().join("family.toml"), text).expect("written");
    edit(&models.join("beam_3/long_beam.h"), "beam", "other");
    assert_eq!(family(copy.path(), &["--check"]).0, Some(1));
    let (status, said) = family(copy.path(), &[]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("long_beam.h belongs to no variant"), "{said}");
    assert!(!models.join("stiff_2").exists());
    let left: Vec<_> = std::fs::read_dir(models.join("beam_3"))
        .expect("a folder")
        .collect();
    assert_eq!(left.len(), 1);
}

#[cfg(unix)]
#[test]
fn link_in_the_output_folder_is_replaced() {
    let copy = copy();
    let (file, other) = (
        copy.path().join("models/beam_1/mod.rs"),
        copy.path().join("other.rs"),
    );
    let right = std::fs::read(&file).expect("a file");
    std::fs::write(&other, "mine").expect("written");
    std::fs::remove_file(&file).expect("removed");
    std::os::unix::fs::symlink(&other, &file).expect("a link");
    let (status, said) = family(copy.path(), &[]);
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(std::fs::read(&other).expect("a file"), b"mine");
    assert!(!file.is_symlink());
    assert_eq!(std::fs::read(&file).expect("a file"), right);
}

#[test]
fn files_of_others_are_not_overwritten() {
    let copy = copy();
    let models = copy.path().join("models");
    for name in ["mod.rs", "models.c"] {
        let path = models.join(name);
        let emitted = std::fs::read(&path).expect("an emitted file");
        std::fs::write(&path, "// mine\n").expect("written");
        for has_manifest in [true, false] {
            let manifest = models.join("manifest.json");
            if !has_manifest {
                std::fs::remove_file(&manifest).expect("removed");
            }
            let before = files(copy.path());
            let (status, said) = family(copy.path(), &[]);
            assert_eq!(status, Some(2), "{said}");
            assert!(
                said.contains(name) && said.contains("move or delete the file"),
                "{said}"
            );
            assert_eq!(files(copy.path()), before);
        }
        std::fs::write(&path, emitted).expect("written");
        assert_eq!(family(copy.path(), &[]).0, Some(0));
    }
}

#[test]
fn truncated_manifest_is_rejected_and_nothing_written() {
    let copy = copy();
    let manifest = copy.path().join("models/manifest.json");
    let text = std::fs::read(&manifest).expect("a manifest");
    for kept in [0, 100, text.len() - 3] {
        std::fs::write(&manifest, &text[..kept]).expect("written");
        let before = files(copy.path());
        for more in [&["--check"][..], &[]] {
            let (status, said) = family(copy.path(), more);
            assert_eq!(status, Some(2), "{said}");
            assert!(
                said.contains("manifest.json") && said.contains("nothing was written"),
                "{said}"
            );
        }
        assert_eq!(files(copy.path()), before);
    }
}

#[test]
fn invalid_family_files_are_rejected_with_location() {
    let variant = |more: &str| {
        format!("[family]\nname = \"f\"\n[[variant]]\nname = \"a\"\nspec = \"beam.toml\"\n{more}")
    };
    let twice = |first: &str, second: &str| {
        variant(&format!(
            "{first}[[variant]]\nspec = \"beam.toml\"\n{second}"
        ))
    };
    let many: String = (0..2001)
        .map(|k| format!("[[variant]]\nname = \"v{k}\"\nspec = \"beam.toml\"\n"))
        .collect();
    let many = format!("[family]\nname = \"f\"\n{many}");
    for (text, expected) in [
        (String::new(), "the family file has no `family`"),
        ("[family]\nname = \"f\"\n".to_owned(), "has no `variant`"),
        ("[family]\n".to_owned(), "has no `name`"),
        ("[family\n".to_owned(), "family.toml:1:8"),
        (
            "[family]\nname = \"f\"\nfast = true\n".to_owned(),
            "unknown key `fast`",
        ),
        (variant("prefix = \"int\"\n"), "reserved word of C or C++"),
        (variant("prefix = \"match\"\n"), "reserved word of Rust"),
        (variant("prefix = \"eomgen\"\n"), "name of the common files"),
        (variant("prefix = \"Model\"\n"), "name of the common files"),
        (variant("prefix = \"a-b\"\n"), "no name of letters"),
        (variant("prefix = \"\"\n"), "no name of letters"),
        (
            twice("", "name = \"a\"\n"),
            "two variants have the name `a`",
        ),
        (
            twice("", "name = \"A\"\n"),
            "two variants have the name `A`",
        ),
        (
            twice("", "name = \"b\"\nprefix = \"a\"\n"),
            "two variants have the prefix `a`",
        ),
        (
            twice(
                "targets = [\"c99\"]\nprecision = [\"f64\", \"f32\"]\n",
                "name = \"a_f32\"\n",
            ),
            "two variants have the prefix `a_f32`",
        ),
        (variant("precision = [\"f32\"]\n"), "family.toml:6:13"),
        (
            variant("precision = [\"f64\", \"f32\"]\ntargets = [\"rust\", \"cuda\"]\n"),
            "`precision = [\"f32\"]` needs the target \"c99\", which this variant does not have",
        ),
        (
            variant("targets = [\"casadi\"]\nprecision = [\"f32\"]\n"),
            "add \"c99\" to `targets`, or remove `precision`",
        ),
        (
            variant("").replace("beam.toml", "family.toml"),
            "family.toml:5:8",
        ),
        (
            variant("").replace("beam.toml", "missing.toml"),
            "missing.toml",
        ),
        (
            variant("").replace("\"a\"", "\"../a\""),
            "cannot have the name `../a`",
        ),
        (variant("ordr = 3\n"), "did you mean `order`"),
        (variant("order = -1\n"), "`order` cannot be -1"),
        (variant("order = 129\n"), "129"),
        (variant("targets = [\"ada\"]\n"), "unknown target `ada`"),
        (variant("targets = [\"fmu2\"]\n"), "not reproducible"),
        (variant("targets = []\n"), "no targets"),
        (
            variant("with = [\"jacobian\"]\n"),
            "unknown output `jacobian`",
        ),
        (variant("with = [\"bench\"]\n"), "no benchmarks"),
        (
            variant("precision = [\"f16\"]\n"),
            "unknown precision `f16`",
        ),
        (variant("packaging = \"zip\"\n"), "\"module\" or \"crate\""),
        (variant("set = { bb = 3 }\n"), "no parameter `bb`"),
        (variant("set = 3\n"), "`set` is not a table"),
        (many, "more than 2000 variants"),
    ] {
        let folder = folder();
        std::fs::write(folder.path().join("family.toml"), &text).expect("written");
        let (status, said) = family(folder.path(), &[]);
        assert_eq!(status, Some(2), "{text}\n{said}");
        assert!(said.contains(expected), "{expected}\n{said}");
        assert!(!folder.path().join("models").exists(), "{text}");
    }
}

#[test]
fn variants_that_declare_the_same_name_in_c_are_rejected() {
    let pairs = [
        (
            "prefix = \"arm\"\n",
            "prefix = \"arm_default\"\n",
            "arm_default_parameters",
        ),
        (
            "prefix = \"arm\"\nwith = [\"guard_rates\"]\n",
            "prefix = \"arm_guard\"\n",
            "arm_guard_rates",
        ),
        (
            "prefix = \"arm\"\nwith = [\"guard_rates\"]\npackaging = \"header-only\"\n",
            "prefix = \"arm_guard\"\n",
            "arm_guard_rates",
        ),
        ("prefix = \"arm\"\n", "prefix = \"arm_rigid\"\n", ""),
    ];
    for (first, second, name) in pairs {
        let folder = folder();
        let variant = |name: &str, more: &str| {
            format!(
                "[[variant]]\nname = \"{name}\"\nspec = \"beam.toml\"\norder = 1\ntargets = [\"c99\"]\n{more}"
            )
        };
        let text = format!(
            "[family]\nname = \"f\"\n{}{}",
            variant("a", first),
            variant("b", second)
        );
        std::fs::write(folder.path().join("family.toml"), &text).expect("written");
        let (status, said) = family(folder.path(), &[]);
        if name.is_empty() {
            assert_eq!(status, Some(0), "{text}\n{said}");
            continue;
        }
        assert_eq!(status, Some(2), "{text}\n{said}");
        let expected = format!("both declare `{name}` in C; give one of them another prefix");
        assert!(said.contains(&expected), "{text}\n{said}");
        assert!(!folder.path().join("models").exists(), "{text}");
    }
}

#[test]
fn folder_of_another_family_is_kept() {
    let copy = copy();
    edit(&copy.path().join("family.toml"), "\"beams\"", "\"others\"");
    let before = files(copy.path());
    let (status, said) = family(copy.path(), &[]);
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("contains the family `beams`"), "{said}");
    assert_eq!(files(copy.path()), before);
}

#[test]
fn unchanged_family_of_two_thousand_is_compared_quickly() {
    const COUNT: usize = 2000;
    let folder = folder();
    let entry = |k: usize| {
        format!(
            "[[variant]]\nname = \"v{k}\"\nspec = \"stiff.toml\"\norder = 0\ntargets = [\"c99\"]\n"
        )
    };
    let text = |count: usize| {
        "[family]\nname = \"many\"\n".to_owned() + &(0..count).map(entry).collect::<String>()
    };
    std::fs::write(folder.path().join("family.toml"), text(1)).expect("written");
    let (status, said) = family(folder.path(), &[]);
    assert_eq!(status, Some(0), "{said}");
    // The other variants are copies; only their hashes are compared.
    let models = folder.path().join("models");
    let manifest = models.join("manifest.json");
    let document = std::fs::read_to_string(&manifest).expect("a manifest");
    let mut document: Value = serde_json::from_str(&document).expect("JSON");
    let first = document["variants"][0].to_string();
    let copied = |k: usize| {
        let text = first.replace("v0", &format!("v{k}"));
        serde_json::from_str::<Value>(&text).expect("JSON")
    };
    document["variants"] = (0..COUNT).map(copied).collect();
    std::fs::write(&manifest, format!("{document:#}\n")).expect("written");
    for k in 1..COUNT {
        let place = models.join(format!("v{k}"));
        std::fs::create_dir(&place).expect("a folder");
        for (path, contents) in files(&models.join("v0")) {
            let name = path.to_string_lossy().replace("v0", &format!("v{k}"));
            std::fs::write(place.join(name), contents).expect("written");
        }
    }
    std::fs::write(folder.path().join("family.toml"), text(COUNT)).expect("written");
    // Writes the tables of all variants without generating a variant.
    let (status, said) = family(folder.path(), &[]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("2 written"), "{said}");
    let start = std::time::Instant::now();
    let (status, said) = family(folder.path(), &["--check"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

/// Runs the program and returns exit status and output.
fn run_and_read(arguments: &[&Path], more: &[&str]) -> (Option<i32>, String) {
    let output = eomgen()
        .args(arguments)
        .args(more)
        .output()
        .expect("the program can be run");
    let text = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&text).into_owned(),
    )
}

fn verify(file: &Path, more: &[&str]) -> (Option<i32>, String) {
    let certificate = file.with_file_name("certificate.json");
    run_and_read(&[Path::new("verify"), file, &certificate], more)
}

#[test]
fn emitted_files_are_verified_and_faults_are_found() {
    let copy = copy();
    let models = copy.path().join("models");
    let rust = models.join("beam_1/mod.rs");
    let (status, text) = verify(&rust, &[]);
    assert_eq!(status, Some(0), "{text}");
    assert!(
        text.contains("The compiled Rust gives the same bits")
            && text.contains("hash: as certified"),
        "{text}"
    );
    // An edited comment changes only the hash.
    edit(&rust, "/// Number of states", "/// Count of states");
    let (status, text) = verify(&rust, &[]);
    assert_eq!(status, Some(1), "{text}");
    assert!(
        text.contains("hash: DIFFERENT") && text.contains("\npassed\n"),
        "{text}"
    );
    if Command::new("cc").arg("--version").output().is_err() {
        return;
    }
    let c = models.join("beam_3/long_beam.c");
    let (status, text) = verify(&c, &["--json"]);
    assert_eq!(status, Some(0), "{text}");
    let document: Value = serde_json::from_str(&text).expect("JSON");
    let checks = document["checks"].as_array().expect("checks");
    assert!(
        checks
            .iter()
            .any(|check| check["name"] == "emitted_c" && check["passed"] == true)
    );
    assert_eq!(verify(&c, &["--cc", "cc -std=c99 -O0"]).0, Some(0));
    // The default of a parameter that `set` replaced is edited.
    edit(&c, "R(0.001)", "R(0.002)");
    let (status, text) = verify(&c, &[]);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("FAILED"), "{text}");
    let (status, text) = verify(&c, &["--cc", "no-such-compiler"]);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("NOT RUN"), "{text}");
}

#[test]
fn comparison_names_edited_certificate() {
    for (from, to) in [
        ("\"value\": 0.0", "\"value\": 1.0"),
        ("\"order\": 1", "\"order\": 2"),
    ] {
        let copy = copy();
        edit(
            &copy.path().join("models/beam_1/certificate.json"),
            from,
            to,
        );
        let (status, said) = family(copy.path(), &["--check"]);
        assert_eq!(status, Some(1), "{said}");
        assert!(
            said.contains("beam_1: edited: beam_1/certificate.json")
                && said.contains("error: 1 file differs: beam_1/certificate.json;"),
            "{said}"
        );
    }
}

#[test]
fn invalid_files_and_certificates_are_rejected_by_verify() {
    let copy = copy();
    let models = copy.path().join("models");
    let rust = models.join("beam_1/mod.rs");
    let certificate = models.join("beam_1/certificate.json");
    let of = |file: &Path, certificate: &Path, more: &[&str]| {
        run_and_read(&[Path::new("verify"), file, certificate], more)
    };
    let other = models.join("beam_1/beam_1.txt");
    std::fs::write(&other, "text").expect("written");
    for (file, certificate, more, expected) in [
        (
            &rust,
            &rust,
            &[][..],
            "mod.rs:1:1: this is not a certificate",
        ),
        (&models.join("none.rs"), &certificate, &[], "cannot read"),
        (&rust, &models.join("none.json"), &[], "cannot read"),
        (
            &rust,
            &models.join("manifest.json"),
            &[],
            "has no `specification`",
        ),
        (&other, &certificate, &[], "neither Rust nor C nor an FMU"),
        (
            &rust,
            &certificate,
            &["--cc", "gcc"],
            "--cc applies only to C",
        ),
        (
            &models.join("beam_1/beam_1.c"),
            &certificate,
            &["--cc", " "],
            "--cc is blank",
        ),
    ] {
        let (status, text) = of(file, certificate, more);
        assert_eq!(status, Some(2), "{text}");
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    let unedited = std::fs::read(&certificate).expect("a certificate");
    for (from, to, expected) in [
        ("900.0", "901.0", "`parameters` is {"),
        ("\"passed\",", "\"failed\",", "states that checks failed"),
        (
            "\"coordinate_names\"",
            "\"others\"",
            "has no check `coordinate_names`",
        ),
        (
            "\"passed\": true,",
            "\"passed\": false,",
            "`passed` is false",
        ),
        (
            "\"tolerance\": 1e-12",
            "\"tolerance\": 1e9",
            "the tolerance of the check",
        ),
        (
            "\"source_sha256\": \"",
            "\"source_sha256\": \"0",
            "does not have the hash `content_sha256`",
        ),
        (
            "\"generator\": \"eomgen",
            "\"generator\": \"other",
            "does not have the hash `content_sha256`",
        ),
        (
            "\"content_sha256\"",
            "\"other_sha256\"",
            "does not end with `content_sha256`",
        ),
    ] {
        edit(&certificate, from, to);
        let (status, text) = of(&rust, &certificate, &[]);
        assert_eq!(status, Some(2), "{text}");
        assert!(text.contains(expected), "{expected}\n{text}");
        std::fs::write(&certificate, &unedited).expect("written");
    }
    edit(&certificate, "value = 900", "value = 901");
    let (status, text) = of(&rust, &certificate, &[]);
    assert_eq!(status, Some(2), "{text}");
    assert!(text.contains("the certificate was edited"), "{text}");
}

#[test]
fn linked_programs_keep_the_identities() {
    let models = WRITTEN.path().join("models");
    let work = tempfile::tempdir().expect("a folder");
    let identify = |image: &Path| {
        let (status, text) = run_and_read(
            &[
                Path::new("identify"),
                image,
                Path::new("--certificates"),
                &models,
            ],
            &[],
        );
        (status, text)
    };
    let rust = work.path().join("main.rs");
    let text = format!(
        "#[path = {:?}]\nmod models;\nuse models::long_beam as m;\nfn main() {{\n\
         let c = m::Coefficients::prepare(&m::Parameters::default());\n\
         print!(\"{{}}\", m::rates(0.0, &[0.0; m::STATES], &m::Inputs {{ u: 0.5 }}, &c)[m::state::MOTOR_DOT]);\n}}\n",
        models.join("mod.rs")
    );
    std::fs::write(&rust, text).expect("written");
    let program = work.path().join("rust_program");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc)
        .args([
            "-O",
            "-C",
            "lto=fat",
            "-C",
            "link-dead-code=no",
            "--edition",
            "2024",
            "-o",
        ])
        .arg(&program)
        .arg(&rust));
    let (status, text) = identify(&program);
    assert_eq!(status, Some(0), "{text}");
    assert!(
        text.starts_with("long_beam: eomgen ") && text.contains("beam_3/certificate.json"),
        "{text}"
    );
    assert!(
        !text.contains("beam_1"),
        "unused variants are not in the program: {text}"
    );
    let (status, text) = identify(&rust);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("contains no identity"), "{text}");
    if Command::new("cc").arg("--version").output().is_err() {
        return;
    }
    let source = work.path().join("main.c");
    std::fs::write(&source, LINKED_C).expect("written");
    let program = work.path().join("c_program");
    let mut compile = Command::new("cc");
    compile.args([
        "-std=c99",
        "-O2",
        "-ffunction-sections",
        "-fdata-sections",
        "-Wl,--gc-sections",
        "-s",
    ]);
    compile
        .arg("-I")
        .arg(models.join("beam_1"))
        .arg("-I")
        .arg(models.join("beam_3"))
        .arg(&source);
    for file in [
        "beam_1/beam_1.c",
        "beam_3/long_beam.c",
        "beam_3/long_beam_f32.c",
    ] {
        compile.arg(models.join(file));
    }
    run(compile.arg("-o").arg(&program));
    let search = ["--certificates", &models.display().to_string(), "--json"];
    let (status, text) = run_and_read(&[Path::new("identify"), &program], &search);
    assert_eq!(status, Some(0), "{text}");
    let document: Value = serde_json::from_str(&text).expect("JSON");
    let mut names: Vec<&str> = document["variants"]
        .as_array()
        .expect("variants")
        .iter()
        .filter_map(|v| v["name"].as_str())
        .collect();
    names.sort_unstable();
    assert_eq!(names, ["beam_1", "long_beam", "long_beam_f32"]);
}

/// One certificate covers the C in both precisions.
#[test]
fn files_in_single_precision_are_verified_by_the_certificate_of_their_variant() {
    let folder = WRITTEN.path().join("models/beam_3");
    let certificate = folder.join("certificate.json");
    let work = tempfile::tempdir().expect("a folder");
    let verify = |folder: &Path| {
        let file = folder.join("long_beam_f32.c");
        run_and_read(&[Path::new("verify"), &file, &certificate], &[])
    };
    let (status, text) = verify(&folder);
    assert_eq!(status, Some(0), "{text}");
    for ending in ["c", "h"] {
        let name = format!("long_beam_f32.{ending}");
        std::fs::copy(folder.join(&name), work.path().join(&name)).expect("copied");
    }
    let header = work.path().join("long_beam_f32.h");
    let text = std::fs::read_to_string(&header).expect("a file") + "\n";
    std::fs::write(&header, text).expect("written");
    let (status, text) = verify(work.path());
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("the header is DIFFERENT"), "{text}");
}

/// The same controller source drives the same coordinate at orders 3 and 7.
#[test]
fn controller_with_named_indices_serves_all_orders() {
    if Command::new("cc").arg("--version").output().is_err() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let page = std::fs::read_to_string(project().join("docs/families.md")).expect("a page");
    for order in ["3", "7"] {
        let out = folder.path().join(order);
        let spec = path("hub_beam_tip_mass");
        let arguments = [Path::new("generate"), &spec, Path::new("--out"), &out];
        let (status, text) = run_and_read(&arguments, &["--target", "c99", "--order", order]);
        assert_eq!(status, Some(0), "{text}");
        let program = folder.path().join(format!("control{order}"));
        run(Command::new("cc")
            .args([
                "-std=c99",
                "-O2",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-DMODEL=hub_beam_tip_mass",
            ])
            .args(["-DHEADER=\"hub_beam_tip_mass.h\"", "-I"])
            .arg(&out)
            .arg(project().join("examples/with_c/position_control.c"))
            .arg(out.join("hub_beam_tip_mass.c"))
            .arg("-o")
            .arg(&program));
        let printed = run(&mut Command::new(&program));
        assert!(
            printed.starts_with(&format!("order {order}: theta = 0.")),
            "{printed}"
        );
        assert!(page.contains(&printed), "{printed}");
    }
}

pub(super) fn run(command: &mut Command) -> String {
    let output = command.output().expect("the command can be run");
    assert!(output.status.success(), "{command:?}: {output:?}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// C program that prints the sizes and one rate of two variants of one model.
const LINKED_C: &str = r#"
#include "beam_1.h"
#include "long_beam.h"
#include "long_beam_f32.h"
#include <stdio.h>
int main(void) {
    beam_1_parameters p1; beam_1_coefficients c1; beam_1_inputs u1 = {0.5};
    long_beam_parameters p3; long_beam_coefficients c3; long_beam_inputs u3 = {0.5};
    long_beam_f32_parameters ps; long_beam_f32_coefficients cs; long_beam_f32_inputs us = {0.5f};
    double x1[beam_1_STATES] = {0}, r1[beam_1_STATES], x3[long_beam_STATES] = {0}, r3[long_beam_STATES];
    float xs[long_beam_f32_STATES] = {0}, rs[long_beam_f32_STATES];
    beam_1_default_parameters(&p1); beam_1_prepare(&p1, &c1); beam_1_rates(0, x1, &u1, &c1, r1);
    long_beam_default_parameters(&p3); long_beam_prepare(&p3, &c3); long_beam_rates(0, x3, &u3, &c3, r3);
    long_beam_f32_default_parameters(&ps); long_beam_f32_prepare(&ps, &cs);
    long_beam_f32_rates(0, xs, &us, &cs, rs);
    printf("%d %d %.3f %.3f %.3f", beam_1_STATES, long_beam_STATES, r1[3], r3[5], (double)rs[5]);
    return 0;
}
"#;

#[test]
fn two_variants_link_into_one_program() {
    let models = WRITTEN.path().join("models");
    let work = tempfile::tempdir().expect("a folder");
    let has_compiler = Command::new("cc").arg("--version").output().is_ok();
    if has_compiler {
        let source = work.path().join("main.c");
        std::fs::write(&source, LINKED_C).expect("written");
        let program = work.path().join("linked");
        let mut compile = Command::new("cc");
        compile.args([
            "-std=c99",
            "-O1",
            "-Wall",
            "-Wextra",
            "-Wconversion",
            "-Werror",
        ]);
        compile
            .arg("-I")
            .arg(models.join("beam_1"))
            .arg("-I")
            .arg(models.join("beam_3"))
            .arg(&source);
        for file in [
            "beam_1/beam_1.c",
            "beam_3/long_beam.c",
            "beam_3/long_beam_f32.c",
        ] {
            compile.arg(models.join(file));
        }
        run(compile.arg("-o").arg(&program));
        assert_eq!(
            run(&mut Command::new(&program)),
            "6 10 41.667 41.667 41.667"
        );
    }
    let source = work.path().join("main.rs");
    let text = format!(
        "#![deny(warnings)]\n#[path = {:?}]\nmod models;\nuse models::{{beam_1, long_beam}};\nfn main() {{\n\
         let c1 = beam_1::Coefficients::prepare(&beam_1::Parameters::default());\n\
         let c3 = long_beam::Coefficients::prepare(&long_beam::Parameters::default());\n\
         let r1 = beam_1::rates(0.0, &[0.0; beam_1::STATES], &beam_1::Inputs {{ u: 0.5 }}, &c1);\n\
         let r3 = long_beam::rates(0.0, &[0.0; long_beam::STATES], &long_beam::Inputs {{ u: 0.5 }}, &c3);\n\
         print!(\"{{}} {{}} {{:.3}} {{:.3}}\", r1.len(), r3.len(), r1[3], r3[5]);\n}}\n",
        models.join("mod.rs")
    );
    std::fs::write(&source, text).expect("written");
    let program = work.path().join("linked_rust");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc)
        .args(["--edition", "2024", "-o"])
        .arg(&program)
        .arg(&source));
    assert_eq!(run(&mut Command::new(&program)), "6 10 41.667 41.667");
}
