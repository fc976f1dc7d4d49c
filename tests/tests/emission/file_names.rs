//! Tests of the names of emitted files: no file is written twice, and no header has the name of a system header.

use std::path::Path;
use std::process::Command;

use eomgen_tests::program::eomgen;

/// Returns the specification of a wheel with this model name.
fn wheel(name: &str) -> String {
    format!(
        "[model]\nname = \"{name}\"\n[parameters]\nJ = {{ value = 2, unit = \"kg m^2\" }}\n\
         [coordinates]\nphi = {{ unit = \"rad\" }}\n[kinetic]\nwheel = \"1/2*J*dot(phi)^2\"\n"
    )
}

/// Runs the program in a folder. Returns its status and output.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = eomgen().current_dir(folder).args(arguments).output();
    let output = output.expect("the program can be run");
    let said = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&said).into_owned(),
    )
}

/// Writes the wheel and emits it to `out`.
fn generate(folder: &Path, name: &str, more: &[&str]) -> (Option<i32>, String) {
    std::fs::write(folder.join("wheel.toml"), wheel(name)).expect("written");
    let arguments = [&["generate", "wheel.toml", "--out", "out"], more].concat();
    run(folder, &arguments)
}

/// Writes a family of one variant of the wheel and emits it to a folder with the name of the family.
fn family(folder: &Path, name: &str, variant: &str) -> (Option<i32>, String) {
    std::fs::write(folder.join("wheel.toml"), wheel("wheel")).expect("written");
    let text = format!(
        "[family]\nname = \"{name}\"\n[[variant]]\nspec = \"wheel.toml\"\ntargets = [\"c99\"]\n{variant}"
    );
    std::fs::write(folder.join("family.toml"), text).expect("written");
    run(folder, &["family", "family.toml", "--out", name])
}

#[test]
fn two_files_with_one_name_are_rejected_before_any_is_written() {
    for (name, status) in [
        ("vectors", 2),
        ("Vectors", 2),
        ("vectors_1", 0),
        ("baked", 0),
        ("certificate", 0),
        ("trace", 0),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let given = ["--target", "c99", "--with", "self_test,trace"];
        let (found, said) = generate(folder.path(), name, &given);
        assert_eq!(found, Some(status), "{name}\n{said}");
        let variant = format!("name = \"a\"\nprefix = \"{name}\"\nwith = [\"self_test\"]\n");
        let (found, in_family) = family(folder.path(), "wheels", &variant);
        assert_eq!(found, Some(status), "{name}\n{in_family}");
        if status == 2 {
            for said in [said, in_family] {
                let message =
                    "two of the files would have the name `vectors.h`: give the model another name";
                assert!(said.contains(message), "{said}");
            }
            for out in ["out", "wheels"] {
                assert!(!folder.path().join(out).exists(), "{name}: {out}");
            }
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (status, said) = generate(folder.path(), "vectors", &["--target", "c99"]);
    assert_eq!(status, Some(0), "{said}");
}

#[test]
fn test_vectors_of_both_precisions_have_the_prefix_of_the_variant() {
    for precision in ["[\"f64\", \"f32\"]", "[\"f32\", \"f64\"]"] {
        let folder = tempfile::tempdir().expect("a folder");
        let variant = format!("name = \"a\"\nprecision = {precision}\nwith = [\"self_test\"]\n");
        let (status, said) = family(folder.path(), "wheels", &variant);
        assert_eq!(status, Some(0), "{said}");
        for (file, part) in [
            ("vectors.json", "\"model\": \"a\""),
            ("vectors.h", "#include \"a_baked.h\""),
            ("a_f32_vectors.h", "#include \"a_f32_baked.h\""),
        ] {
            let text = std::fs::read_to_string(folder.path().join("wheels/a").join(file));
            assert!(text.expect(file).contains(part), "{precision}: {file}");
        }
    }
}

#[test]
fn names_of_system_headers_are_rejected_for_c() {
    for (name, hidden) in [
        ("stdint", Some("stdint")),
        ("stddef", Some("stddef")),
        ("Math", Some("math")),
        ("string", Some("string")),
        ("features", Some("features")),
        ("stdint_", None),
        ("strings_2", None),
        ("arm", None),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let (status, said) = generate(folder, name, &["--target", "c99"]);
        let header = ["--target", "c99", "--packaging", "header-only"];
        let (of_header, _) = generate(folder, name, &header);
        let variant = format!("name = \"a\"\nprefix = \"{name}\"\n");
        let (of_family, in_family) = family(folder, "wheels", &variant);
        let expected = hidden.map_or(Some(0), |_| Some(2));
        assert_eq!(
            [status, of_header, of_family],
            [expected; 3],
            "{name}\n{said}{in_family}"
        );
        if let Some(hidden) = hidden {
            let message = format!(
                "`{name}.h` would replace the system header <{hidden}.h>: give the model another name"
            );
            assert!(
                said.contains(&message) && in_family.contains(&message),
                "{said}{in_family}"
            );
            assert!(!folder.join("out").exists(), "{name}");
        }
        let (status, said) = generate(folder, name, &["--target", "casadi"]);
        assert_eq!(status, expected, "{name}\n{said}");
        let (status, said) = generate(folder, name, &["--target", "rust"]);
        assert_eq!(status, Some(0), "{name}\n{said}");
    }
}

#[test]
fn headers_of_several_families_compile_in_one_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for name in ["first", "second", "third"] {
        let variant = format!("name = \"{name}_wheel\"\n");
        let (status, said) = family(folder, name, &variant);
        assert_eq!(status, Some(0), "{said}");
    }
    let text = "#include \"first/models.h\"\n#include \"second/models.h\"\n#include \"third/models.h\"\n\
                #include \"first/models.h\"\n\
                int states(void);\n\
                int states(void) { return first_wheel_model.states + second_wheel_model.states + third_wheel_model.states; }\n";
    std::fs::write(folder.join("all.c"), text).expect("written");
    for (compiler, language) in [
        ("cc", ["-std=c99", "-xc"]),
        ("c++", ["-std=c++11", "-xc++"]),
    ] {
        let mut command = Command::new(compiler);
        command.current_dir(folder).args(language);
        let compiled = command.args(["-Wall", "-Wextra", "-Werror", "-fsyntax-only", "all.c"]);
        let Ok(output) = compiled.output() else {
            skips::skip(
                "headers of families were not compiled: cc is missing (Debian: apt-get install gcc)",
            );
            return;
        };
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{compiler}: {said}");
    }
}
