//! Tests of `generate --set` and `validate --set`: default values of parameters in emitted code.

use eomgen_tests::models::path;
use eomgen_tests::program::eomgen;

fn run(arguments: &[&str]) -> (Option<i32>, String) {
    let output = eomgen()
        .args(arguments)
        .output()
        .expect("the program can be run");
    let text = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&text).into_owned(),
    )
}

#[test]
fn emitted_defaults_equal_values_of_set() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = path("pendulum");
    let spec = spec.to_str().expect("a path");
    let out = folder.path().join("out");
    let source = |settings: &[&str]| {
        let fixed = ["generate", spec, "--out", out.to_str().expect("a path")];
        let (status, said) = run(&[&fixed[..], settings].concat());
        assert_eq!(status, Some(0), "{said}");
        std::fs::read_to_string(out.join("lib.rs")).expect("a source")
    };
    let declared = source(&[]);
    let changed = source(&["--set", "a=450 mm"]);
    let differing: Vec<(&str, &str)> = declared
        .lines()
        .zip(changed.lines())
        .filter(|(a, b)| a != b)
        .collect();
    // Only two lines differ: the hash in the identity, and the default value.
    let [(_, identity), (_, default)] = differing[..] else {
        panic!("{differing:?}")
    };
    assert!(identity.contains("IDENTITY"), "{identity}");
    assert_eq!(default.trim(), "a: 0.45,");
    // The same number in another notation gives the same bytes.
    assert_eq!(source(&["--set", "a=0.45"]), changed);
}

#[test]
fn invalid_settings_are_rejected_and_write_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let out = out.to_str().expect("a path");
    let spec = path("pendulum");
    let spec = spec.to_str().expect("a path");
    for (setting, reason) in [("aa=2", "`aa`"), ("a", "NAME="), ("a=2 kg", "kg")] {
        for command in [
            vec!["generate", spec, "--out", out, "--set", setting],
            vec!["validate", spec, "--set", setting],
        ] {
            let (status, said) = run(&command);
            assert_eq!(status, Some(2), "{said}");
            assert!(said.contains(reason), "{setting}: {said}");
        }
    }
    assert!(!std::path::Path::new(out).exists());
}

#[test]
fn certificate_covers_the_set_values() {
    let spec = path("pendulum");
    let spec = spec.to_str().expect("a path");
    let hash = |settings: &[&str]| {
        let (status, text) = run(&[&["validate", spec, "--json"][..], settings].concat());
        assert_eq!(status, Some(0), "{text}");
        let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        document["source_sha256"].clone()
    };
    assert_ne!(hash(&[]), hash(&["--set", "a=0.45"]));
}
