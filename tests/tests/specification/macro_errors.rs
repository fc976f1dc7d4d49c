//! Tests of the exact compiler messages of the macro for each file in `tests/macro_errors/errors`. To rewrite them, run
//! `EOMGEN_REFRESH=1 cargo test --release -p eomgen-tests --test specification macro_errors` and review the difference.

use std::path::Path;
use std::process::Command;

use eomgen_tests::models::project;
use eomgen_tests::program::compiled_library;

/// Returns the compiler's messages for a file that must not compile, without the summary line.
fn messages(file: &Path, root: &Path, library: &Path, out: &Path) -> String {
    let dependencies = library.parent().expect("a folder");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc)
        .args(["--edition", "2024", "--emit=metadata", "--out-dir"])
        .arg(out)
        .arg(format!("--extern=eomgen={}", library.display()))
        .arg(format!("-Ldependency={}", dependencies.display()))
        .arg(file)
        .current_dir(root)
        // Paths of specifications are relative to this folder.
        .env("CARGO_MANIFEST_DIR", root)
        .output()
        .expect("rustc can be run");
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{} compiles", file.display());
    let (messages, _) = text
        .split_once("\nerror: aborting due to")
        .unwrap_or_else(|| panic!("{}: {text}", file.display()));
    let lines: Vec<&str> = messages.lines().map(str::trim_end).collect();
    lines.join("\n")
}

#[test]
fn each_mistake_in_a_macro_gives_its_message() {
    let root = project().join("tests/macro_errors");
    let library = compiled_library("eomgen");
    let out = tempfile::tempdir().expect("a folder");
    let entries = std::fs::read_dir(root.join("errors")).expect("a folder");
    let mut names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
    names.retain(|name| Path::new(name).extension().is_some_and(|end| end == "rs"));
    names.sort();
    assert!(names.len() > 10, "{names:?}");
    let mut differing = String::new();
    for name in names {
        let file = Path::new("errors").join(name);
        let found = messages(&file, &root, &library, out.path());
        let kept = root.join(&file).with_extension("stderr");
        if std::env::var_os("EOMGEN_REFRESH").is_some() {
            std::fs::write(&kept, format!("{found}\n")).expect("written");
        }
        let expected = std::fs::read_to_string(&kept).expect("the recorded messages");
        if found.trim_end() != expected.trim_end() {
            differing += &format!("{}:\n{found}\nrecorded:\n{expected}\n", file.display());
        }
    }
    assert!(differing.is_empty(), "{differing}");
}
