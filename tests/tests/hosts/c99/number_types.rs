//! Test of the external names of emitted C: files that are compiled with different number types do not link.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use eomgen_codegen::c;
use eomgen_codegen::variant::Variant;

use super::{WARNINGS, has_compilers, run, supported_outputs};
use eomgen_tests::models::project;

/// Items without numbers: one definition serves both types.
const WITHOUT_NUMBERS: [&str; 5] = ["_names", "_units", "_orders", "_identity", "_places"];

/// Returns the external names that the object file defines.
fn defined_names(folder: &Path, name: &str, real: &str) -> BTreeSet<String> {
    run(Command::new("cc")
        .current_dir(folder)
        .args(["-std=c99", "-Wconversion", "-c", "-o", "object.o"])
        .args(WARNINGS)
        .args([&format!("-D{name}_REAL={real}"), &format!("{name}.c")]));
    let listed =
        run(Command::new("nm")
            .current_dir(folder)
            .args(["-g", "--defined-only", "object.o"]));
    let names = listed
        .lines()
        .filter_map(|line| line.split(' ').next_back());
    names.map(str::to_owned).collect()
}

#[test]
fn external_names_of_double_have_no_type_and_others_have() {
    if !has_compilers() {
        return;
    }
    for path in [
        "examples/closed_loop/regulator.toml",
        "model-spec/models/planetary_arm.toml",
    ] {
        let checked = eomgen_model_spec::load(&project().join(path)).expect("a specification");
        let orders = vec![1; checked.model.fields.len()];
        let variant = Variant::derive_with(&checked.model, &orders, &supported_outputs());
        let program = variant.expect("the model can be derived").program;
        let name = &program.name;
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let files = c::emit(&program).expect("emitted");
        std::fs::write(folder.join(format!("{name}.h")), files.header).expect("written");
        std::fs::write(folder.join(format!("{name}.c")), files.source).expect("written");
        let double = defined_names(folder, name, "double");
        let single = defined_names(folder, name, "float");
        assert!(double.contains(&format!("{name}_prepare")), "{double:?}");
        let expected: BTreeSet<String> = double
            .iter()
            .map(
                |item| match WITHOUT_NUMBERS.iter().any(|end| item.ends_with(end)) {
                    true => item.clone(),
                    false => format!("{item}_float"),
                },
            )
            .collect();
        assert_eq!(single, expected);
        // The object is in single precision, the caller in double precision.
        let caller = format!(
            "#include \"{name}.h\"\nint main(void) {{\n    static {name}_parameters p;\n    static {name}_coefficients c;\n    \
             {name}_prepare(&p, &c);\n    return c.positive_definite;\n}}\n"
        );
        std::fs::write(folder.join("main.c"), caller).expect("written");
        let link = |options: &[&str]| {
            let output = Command::new("cc")
                .current_dir(folder)
                .args(["-std=c99", "main.c", "object.o", "-o", "main"])
                .args(options)
                .output();
            output.expect("the compiler")
        };
        let refused = link(&[]);
        assert!(!refused.status.success());
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(said.contains(&format!("{name}_prepare")), "{said}");
        assert!(link(&[&format!("-D{name}_REAL=float")]).status.success());
    }
}
