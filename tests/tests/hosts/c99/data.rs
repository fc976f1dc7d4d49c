//! Tests of units, initial state and ranges in emitted C and Rust: they equal the specification, and programs that do
//! not use them do not contain them.

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c;
use eomgen_codegen::rust::{self, Packaging};

use super::{WARNINGS, has_compilers, program, run};

/// Motor with a current, in units that are not coherent, and a beam with one mode.
const MOTOR: &str = r#"
[model]
name = "motor"
[parameters]
J = { value = 0.02, unit = "kg m^2" }
L = { value = 3, unit = "mH" }
k = { value = 0.5, unit = "N m/A" }
a = { value = 1.5, unit = "rad" }
l = { value = 0.8, unit = "m" }
rho = { value = 0.4, unit = "kg/m" }
B = { value = 18, unit = "N m^2" }
[coordinates]
turn = { unit = "rad", initial = "a/2", initial_rate = 0.25, range = ["-a", "a"] }
[states]
i = { unit = "A", rate = "(u - k*dot(turn))/L", initial = -2, range = [-10, 20] }
[inputs]
u = { unit = "V", range = [-24, 24] }
v = { unit = "N m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 1
unit = "m"
[kinetic]
rotor = "1/2*J*dot(turn)^2"
beam = "1/2*integral(rho*(x*dot(turn) + dot(w))^2, w)"
[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
[forces]
drive = { on = "turn", value = "k*i + v" }
[observables]
tip = "l*turn + at(w, l)"
"#;

/// Expected lines of both programs: units, then numbers.
const EXPECTED: &str = "\
state rad m rad/s m/s A
input V N m
parameter kg m^2 N m/A^2 N m/A rad m kg/m N m^2
observable m J W
initial 0.75 0 0.25 0 -2
state -1.5 -inf -inf -inf -10
state 1.5 inf inf inf 20
input -24 -inf
input 24 inf
";

const C_PROGRAM: &str = r#"
#include "motor.h"
#include <stdio.h>
static void print_texts(const char *name, const char *const *all, int count) {
    printf("%s", name);
    for (int i = 0; i < count; ++i) { printf(" %s", all[i]); }
    printf("\n");
}
static void print_numbers(const char *name, const motor_real *all, int count) {
    printf("%s", name);
    for (int i = 0; i < count; ++i) { printf(" %g", (double)all[i]); }
    printf("\n");
}
int main(void) {
    print_texts("state", motor_state_units, motor_STATES);
    print_texts("input", motor_input_units, motor_INPUTS);
    print_texts("parameter", motor_parameter_units, motor_PARAMETERS);
    print_texts("observable", motor_observable_units, motor_OBSERVABLES);
    print_numbers("initial", motor_initial_state, motor_STATES);
    print_numbers("state", motor_state_lower, motor_STATES);
    print_numbers("state", motor_state_upper, motor_STATES);
    print_numbers("input", motor_input_lower, motor_INPUTS);
    print_numbers("input", motor_input_upper, motor_INPUTS);
    return 0;
}
"#;

const RUST_PROGRAM: &str = r#"
#[path = "lib.rs"]
mod motor;
fn print_texts(name: &str, all: &[&str]) {
    println!("{name} {}", all.join(" "));
}
fn print_numbers(name: &str, all: &[f64]) {
    let all: Vec<String> = all.iter().map(|number| number.to_string()).collect();
    println!("{name} {}", all.join(" "));
}
fn main() {
    print_texts("state", &motor::STATE_UNITS);
    print_texts("input", &motor::INPUT_UNITS);
    print_texts("parameter", &motor::PARAMETER_UNITS);
    print_texts("observable", &motor::OBSERVABLE_UNITS);
    print_numbers("initial", &motor::INITIAL_STATE);
    print_numbers("state", &motor::STATE_LOWER);
    print_numbers("state", &motor::STATE_UPPER);
    print_numbers("input", &motor::INPUT_LOWER);
    print_numbers("input", &motor::INPUT_UPPER);
}
"#;

fn write_c(folder: &Path, main: &str) {
    let files = c::emit(&program(MOTOR, 1, &[])).expect("emitted");
    std::fs::write(folder.join("motor.h"), files.header).expect("written");
    std::fs::write(folder.join("motor.c"), files.source).expect("written");
    std::fs::write(folder.join("main.c"), main).expect("written");
}

/// Compiles `main.c` with the options and links only functions and data that it uses.
fn link(folder: &Path, options: &[&str]) {
    run(Command::new("cc")
        .current_dir(folder)
        .args(["-std=c99", "-O1", "-Wconversion", "-fdata-sections"])
        .args(["-ffunction-sections", "-Wl,--gc-sections"])
        .args(WARNINGS)
        .args(options)
        .args(["main.c", "motor.c", "-o", "main"]));
}

#[test]
fn emitted_data_equals_the_specification() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_c(folder, C_PROGRAM);
    for options in [&[][..], &["-Dmotor_REAL=float"]] {
        link(folder, options);
        assert_eq!(run(&mut Command::new(folder.join("main"))), EXPECTED);
    }
    let source = rust::emit(&program(MOTOR, 1, &[]), Packaging::Module).expect("emitted");
    std::fs::write(folder.join("lib.rs"), source).expect("written");
    std::fs::write(folder.join("main.rs"), RUST_PROGRAM).expect("written");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc).current_dir(folder).args([
        "--edition",
        "2021",
        "-A",
        "warnings",
        "main.rs",
        "-o",
        "in_rust",
    ]));
    assert_eq!(run(&mut Command::new(folder.join("in_rust"))), EXPECTED);
}

#[test]
fn unused_data_is_not_linked() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let symbols = |main: &str| {
        write_c(folder, main);
        link(folder, &[]);
        run(Command::new("nm").current_dir(folder).arg("main"))
    };
    let used =
        "#include \"motor.h\"\nint main(void) {\n    return motor_initial_state[0] > 0;\n}\n";
    let used = symbols(used);
    assert!(used.contains(" motor_initial_state\n"), "{used}");
    assert!(!used.contains("motor_state_units"), "{used}");
    let main = "#include \"motor.h\"\nint main(void) {\n    motor_parameters parameters;\n    \
                motor_coefficients coefficients;\n    motor_default_parameters(&parameters);\n    \
                motor_prepare(&parameters, &coefficients);\n    return !coefficients.positive_definite;\n}\n";
    let unused = symbols(main);
    assert!(unused.contains(" motor_identity\n"), "{unused}");
    for name in ["state", "input", "parameter", "observable", "initial"] {
        assert!(!unused.contains(&format!("motor_{name}_")), "{unused}");
    }
}
