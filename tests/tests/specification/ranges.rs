//! Tests of ranges: `simulate` warns with the first time at which a value leaves its range.

use eomgen_tests::program::eomgen;

const SPRING: &str = r#"
[model]
name = "spring"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 4, unit = "N/m" }
[coordinates]
x = { unit = "m", initial_rate = 1, range = [-0.6, 0.25] }
y = { unit = "m", range = [-1, 1] }
[inputs]
u = { unit = "N", range = [1, 2] }
[kinetic]
mass = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
spring = "1/2*k*x^2"
[forces]
pull = { on = "y", value = "u" }
"#;

/// Returns the stderr of `simulate` and asserts that it wrote its table.
fn simulate_stderr(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("spring.toml");
    std::fs::write(&spec, text).expect("writable");
    let table = folder.path().join("motion.csv");
    let mut command = eomgen();
    command
        .arg("simulate")
        .arg(&spec)
        .args(["--until", "3", "--interval", "0.01"]);
    let output = command.arg("--out").arg(&table).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(table.exists());
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn leaving_range_warns_with_name_and_time() {
    let text = SPRING.to_owned();
    let said = simulate_stderr(&text);
    // x = sin(2 t)/2 exceeds 1/4 after pi/12 = 0.2618 s.
    let warning = said
        .lines()
        .find(|line| line.contains("`x`"))
        .expect("a warning about `x`");
    assert!(
        warning.starts_with("warning: `x` leaves its range -0.6 to 0.25 m"),
        "{said}"
    );
    assert!(warning.contains("at t = 0.27 s"), "{said}");
    assert!(
        said.contains("`u` leaves its range 1 to 2 N: it is 0 at t = 0 s"),
        "{said}"
    );
    assert!(!said.contains("`y` leaves"), "{said}");
}

#[test]
fn motion_inside_range_gives_no_warning() {
    let text = SPRING
        .replace("0.25]", "0.6]")
        .replace("range = [1, 2]", "range = [-1, 2]");
    assert!(!simulate_stderr(&text).contains("leaves"));
}

#[test]
fn state_leaving_its_range_warns() {
    let state =
        "[states]\nz = { unit = \"m\", rate = \"dot(x)\", range = [-0.1, 0.25] }\n[kinetic]";
    let text = SPRING.replace("[kinetic]", state);
    let text = text.replace("range = [1, 2]", "range = [-1, 2]");
    let said = simulate_stderr(&text);
    assert!(
        said.contains("`z` leaves its range -0.1 to 0.25 m"),
        "{said}"
    );
}
