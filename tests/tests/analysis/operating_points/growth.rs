//! Tests of the growth of the work of `check` and `modes` with the size of the model. Callgrind counts the instructions
//! for a model and for a model of twice the size. Skipped without valgrind and in unoptimised builds.

use std::process::Command;

use eomgen_tests::program::path;

const MAX_RATIO: f64 = 2.5;

/// Axes of hinges.
const SPATIAL: [char; 3] = ['x', 'y', 'z'];

/// Ratio of the work for twice the size if the work grows with the cube of the size, as for eigenvalues of a connected
/// machine.
const CUBIC_RATIO: f64 = 8.0;

fn section(name: &str, count: usize, line: &dyn Fn(usize) -> String) -> String {
    let lines = (0..count).map(|place| line(place) + "\n");
    format!("[{name}]\n{}", lines.collect::<String>())
}

fn masses(count: usize, further: &str) -> String {
    "[model]\nname = \"grown\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\nk = { value = 3, unit = \"N/m\" }\n"
        .to_owned()
        + &section("coordinates", count, &|k| format!("q{k} = {{ unit = \"m\" }}"))
        + &section("kinetic", count, &|k| format!("T{k} = \"1/2*m*dot(q{k})^2\""))
        + further
}

fn masses_on_springs(count: usize) -> String {
    let spring = |k: usize| format!("V{k} = \"1/2*{}*k*q{k}^2\"", k + 1);
    masses(count, &section("potential", count, &spring))
}

fn masses_with_impacts(count: usize) -> String {
    let floor = |k: usize| format!("i{k} = {{ when = \"q{k}\", restitution = \"1/2\" }}");
    masses(count, &section("impacts", count, &floor))
}

fn masses_with_constraints(count: usize) -> String {
    let pair = |k: usize| format!("c{k} = {{ zero = \"q{} - q{}\" }}", 2 * k, 2 * k + 1);
    masses(2 * count, &section("constraints", count, &pair))
}

fn constraint_over_masses(count: usize) -> String {
    let terms: Vec<String> = (0..count).map(|k| format!("sin(q{k}/l)")).collect();
    let length = "l = { value = 1, unit = \"m\" }\n";
    let constraint = format!(
        "[constraints]\nall = {{ zero = \"{}\" }}\n",
        terms.join(" + ")
    );
    masses(count, &constraint).replace("k = {", &format!("{length}k = {{"))
}

fn chain_with_coefficients(count: usize) -> String {
    let spring = |k: usize| match k {
        0 => "V0 = \"1/2*k*q0^2\"".to_owned(),
        _ => format!("V{k} = \"1/2*k*(q{k} - q{})^2\"", k - 1),
    };
    let named = |k: usize| format!("a{k} = {{ of = \"q{k}\", by = \"q{k}\" }}");
    let potential = section("potential", count, &spring);
    masses(
        count,
        &(potential + &section("coefficients", count, &named)),
    )
}

/// Returns a chain of bodies on hinges; the axes of the hinges repeat periodically.
fn hinged_bodies(count: usize, axes: &[char]) -> String {
    let frame = |k: usize| {
        let axis = axes[k % axes.len()];
        let parent = match k {
            0 => String::new(),
            _ => format!(", in = \"f{}\", origin = [0, 0, \"-l\"]", k - 1),
        };
        format!("f{k} = {{ rotation = \"rotation_{axis}(q{k})\"{parent} }}")
    };
    let body = |k: usize| {
        format!("f{k} = {{ frame = \"f{k}\", mass = \"m\", inertia = [\"J\", \"J\", \"J\"] }}")
    };
    "[model]\nname = \"hinged\"\ngravity = [0, 0, \"-g\"]\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
     l = { value = 1, unit = \"m\" }\nJ = { value = 1, unit = \"kg m^2\" }\n\
     g = { value = 9.81, unit = \"m/s^2\" }\n"
        .to_owned()
        + &section("coordinates", count, &|k| format!("q{k} = {{ unit = \"rad\" }}"))
        + &section("frames", count, &frame)
        + &section("bodies", count, &body)
}

/// Returns a body at the end of a vector that is rotated several times; each rotation is the square of the previous
/// one.
fn doubled_rotations(count: usize) -> String {
    let square = |k: usize| match k {
        0 => "R0 = \"rotation_x(a)*rotation_z(b)\"".to_owned(),
        _ => format!("R{k} = \"R{0}*R{0}\"", k - 1),
    };
    "[model]\nname = \"doubled\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
     l = { value = 1, unit = \"m\" }\n[coordinates]\na = { unit = \"rad\" }\nb = { unit = \"rad\" }\n"
        .to_owned()
        + &section("definitions", count + 1, &square)
        + &format!(
            "r = \"R{count}*[l, 0, l]\"\n[kinetic]\nT = \"1/2*m*dot(dot(r), dot(r)) + \
             1/2*m*l^2*(dot(a)^2 + dot(b)^2)\"\n"
        )
}

fn strings_with_impacts(count: usize) -> String {
    let field = |k: usize| {
        format!(
            "[fields.w{k}]\nalong = \"s{k}\"\nfrom = 0\nto = \"l\"\nbasis = \"string\"\ncoordinates = \"q{k}_\"\n\
             order = 3\nunit = \"m\"\n"
        )
    };
    "[model]\nname = \"strings\"\n[parameters]\nmu = { value = 1, unit = \"kg/m\" }\nH = { value = 2, unit = \"N\" }\n\
     l = { value = 1, unit = \"m\" }\n"
        .to_owned()
        + &(0..count).map(field).collect::<String>()
        + &section("kinetic", count, &|k| {
            format!("T{k} = \"1/2*integral(mu*dot(w{k})^2, w{k})\"")
        })
        + &section("potential", count, &|k| {
            format!("V{k} = \"1/2*integral(H*diff(w{k}, s{k})^2, w{k})\"")
        })
        + &section("impacts", count, &|k| {
            format!("i{k} = {{ when = \"at(w{k}, l/2) + l\", restitution = \"1/2\" }}")
        })
}

fn instructions(command: &str, text: &str) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("model.toml");
    std::fs::write(&file, text).expect("written");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(path())
        .args([command, &file.display().to_string()])
        .output()
        .expect("valgrind starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let counted = said
        .lines()
        .find_map(|line| line.split_once("Collected : "));
    let (_, count) = counted.unwrap_or_else(|| panic!("no count: {said}"));
    count.trim().parse().expect("a number")
}

/// Asserts that a command on a model of twice the size takes at most [`MAX_RATIO`] times the
/// instructions.
fn assert_growth(command: &str, size: usize, text: impl Fn(usize) -> String) {
    assert_growth_below(MAX_RATIO, (command, size), text);
}

fn assert_growth_below(
    max_ratio: f64,
    (command, size): (&str, usize),
    text: impl Fn(usize) -> String,
) {
    if Command::new("valgrind").arg("--version").output().is_err() {
        skips::skip(
            "instructions were not counted: valgrind is missing (Debian: apt-get install valgrind)",
        );
        return;
    }
    if cfg!(debug_assertions) {
        skips::skip(
            "instructions were not counted: this needs optimised code (cargo test --release)",
        );
        return;
    }
    let [single, double] = [size, 2 * size].map(|size| instructions(command, &text(size)));
    let ratio = double / single;
    assert!(
        ratio <= max_ratio,
        "{command}: {single} to {double}, {ratio:.2}-fold"
    );
}

#[test]
fn check_of_masses_grows_linearly() {
    assert_growth("check", 200, |count| masses(count, ""));
}

#[test]
fn check_of_impacts_grows_linearly() {
    assert_growth("check", 50, masses_with_impacts);
}

#[test]
fn check_of_constraints_grows_linearly() {
    assert_growth("check", 50, masses_with_constraints);
}

#[test]
fn check_of_a_constraint_over_masses_grows_linearly() {
    assert_growth("check", 80, constraint_over_masses);
}

#[test]
fn check_of_coefficients_grows_linearly() {
    assert_growth("check", 100, chain_with_coefficients);
}

#[test]
fn check_of_fields_with_impacts_grows_linearly() {
    assert_growth("check", 16, strings_with_impacts);
}

#[test]
fn check_of_hinged_bodies_grows_linearly() {
    assert_growth("check", 25, |count| hinged_bodies(count, &SPATIAL));
}

#[test]
fn check_of_doubled_rotations_grows_linearly() {
    assert_growth("check", 8, doubled_rotations);
}

#[test]
fn modes_of_connected_masses_grow_with_the_cube() {
    assert_growth_below(CUBIC_RATIO, ("modes", 40), chain_with_coefficients);
}

/// `linearise` does the work of `modes` except the eigenvalues.
#[test]
fn linearise_of_connected_masses_grows_linearly() {
    assert_growth("linearise", 30, chain_with_coefficients);
}

#[test]
fn modes_of_hinged_bodies_grow_with_the_cube() {
    assert_growth_below(CUBIC_RATIO, ("modes", 4), |count| {
        hinged_bodies(count, &SPATIAL)
    });
}

/// If all entries of the Jacobians were derived, including zeros, this chain would need 1.5 GB.
#[test]
#[cfg(target_os = "linux")]
fn modes_of_forty_hinged_bodies_take_less_than_800_mebibytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("model.toml");
    std::fs::write(&file, hinged_bodies(40, &['y'])).expect("written");
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 819200; exec \"$0\" modes \"$1\""])
        .arg(path())
        .arg(&file)
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

#[test]
fn modes_of_independent_masses_grow_linearly() {
    assert_growth("modes", 30, masses_on_springs);
}
