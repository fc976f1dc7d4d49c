//! Tests of `generate --with trace`: lines of the source with units and terms.

use eomgen_tests::models::path;
use eomgen_tests::program::eomgen;
use serde_json::Value;

#[test]
fn trace_names_the_line_of_every_value() {
    for (target, file) in [("rust", "lib.rs"), ("c99", "planetary_arm.c")] {
        let folder = tempfile::tempdir().expect("a folder");
        let output = eomgen()
            .arg("generate")
            .arg(path("planetary_arm"))
            .args([
                "--order", "2", "--target", target, "--with", "trace", "--out",
            ])
            .arg(folder.path())
            .output()
            .expect("the program can be run");
        assert!(output.status.success(), "{output:?}");
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect(name);
        let source = read(file);
        let lines: Vec<&str> = source.lines().collect();
        let trace: Value = serde_json::from_str(&read("trace.json")).expect("JSON");
        let all = trace["files"][file].as_array().expect("lines");
        assert!(all.len() > 40, "{}", all.len());
        let mut rates = Vec::new();
        for entry in all {
            let name = entry["name"].as_str().expect("a name");
            let line = lines[entry["line"].as_u64().expect("a line") as usize - 1];
            assert!(line.contains(name), "{name}: {line}");
            assert_ne!(entry["terms"], Value::Array(Vec::new()), "{line}");
            if name == "x_c_ddot" {
                rates.push(entry.clone());
            }
        }
        // The carrier's acceleration contains all inertias except the sun's, all springs and both dampers.
        let [rate] = &rates[..] else {
            panic!("{rates:?}")
        };
        assert_eq!(rate["unit"], "m/s^2");
        let terms: Vec<&str> = (rate["terms"].as_array().expect("terms").iter())
            .filter_map(Value::as_str)
            .collect();
        for term in [
            "kinetic.arm",
            "kinetic.carrier",
            "potential.bending",
            "potential.mesh_sp",
            "potential.mesh_pr",
            "forces.damping_sp",
            "forces.damping_pr",
        ] {
            assert!(terms.contains(&term), "{term}: {terms:?}");
        }
        assert!(!terms.contains(&"forces.motor"), "{terms:?}");
    }
}

#[test]
fn trace_of_a_target_without_comments_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = eomgen()
        .arg("generate")
        .arg(path("planetary_arm"))
        .args(["--target", "fmu3", "--with", "trace", "--out"])
        .arg(folder.path())
        .output()
        .expect("the program can be run");
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("--with trace needs --target rust"), "{said}");
}
