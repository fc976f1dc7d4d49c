//! A C program computes gradients of a motion with play, dry friction and an input, and compares them with differences.

use std::path::PathBuf;
use std::process::Command;

const SLIDER: &str = r#"
[model]
name = "slider"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 300, unit = "N/m" }
b = { value = 2, unit = "mm" }
c = { value = 1.5, unit = "N s/m" }
F = { value = 0.4, unit = "N" }
[coordinates]
x = { unit = "m", initial = 0.05, initial_rate = -0.2 }
y = { unit = "m", initial_rate = 0.3 }
[inputs]
u = { unit = "N" }
[kinetic]
bodies = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
gap = "1/2*k*deadzone(x - y, b)^2"
ground = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*(dot(x)^2 + dot(y)^2)"
[forces]
drive = { on = "x", value = "u - F*sign(dot(x))" }
"#;

/// Returns the folder of the compiled library, that of this test.
fn find_library_folder() -> PathBuf {
    let test = std::env::current_exe().expect("the running test has a path");
    test.parent().expect("target/PROFILE/deps").to_owned()
}

#[test]
fn gradients_in_c_match_differences_through_events() {
    if Command::new("cc").arg("--version").output().is_err() {
        skips::skip("the C interface was not tested: cc is missing (Debian: gcc)");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    std::fs::write(file("slider.toml"), SLIDER).expect("a file");
    let own = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let library = find_library_folder();
    let compiled = Command::new("cc")
        .args(["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-I"])
        .arg(own.join("include"))
        .arg(own.join("tests/gradient.c"))
        .arg("-L")
        .arg(&library)
        .args(["-leomgen_simulation", "-lm", "-o"])
        .arg(file("gradient"))
        .output()
        .expect("cc");
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
    let output = Command::new(file("gradient"))
        .arg(file("slider.toml"))
        .env("LD_LIBRARY_PATH", &library)
        .env("DYLD_LIBRARY_PATH", &library)
        .current_dir(folder.path())
        .output()
        .expect("the program runs");
    let [printed, errors] =
        [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{printed}{errors}");
    for message in ["`motion` is NULL", "absent.toml", "1 1"] {
        assert!(printed.contains(message), "{message}: {printed}");
    }
}
