//! Tests of emitted C in other dialects (bit-identical results) and with reordered sums (equal results to within
//! rounding).

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Output};

use super::{has_compilers, program, run};
use eomgen_codegen::c;

/// Functions of x and y, with arguments up to 0.9.
const FUNCTIONS: [&str; 17] = [
    "sin(x/d)",
    "cos(x/d)",
    "tan(x/d)",
    "asin(x/d)",
    "acos(x/d)",
    "atan(x/d)",
    "atan2(x, y)",
    "sinh(x/d)",
    "cosh(x/d)",
    "tanh(x/d)",
    "exp(x/d)",
    "ln(1.5 + x/d)",
    "sqrt(1.5 + x/d)",
    "abs(x/d)^2.5",
    "(1.5 + x/d)^(y/d)",
    "exp(30*x/d)",
    "sin(300*x/d)",
];

/// Maximum deviation relative to the larger of the value and 1; arguments of 300 rad are reduced to
/// a turn.
const BOUND: f64 = 1e-12;

/// C program that prints every observable on a grid of x and y.
const MAIN: &str = "\
#include \"each.h\"
#include <stdio.h>
int main(void) {
    each_parameters parameters;
    each_coefficients coefficients;
    each_inputs inputs = {0};
    double state[each_STATES] = {0}, observables[each_OBSERVABLES];
    each_default_parameters(&parameters);
    each_prepare(&parameters, &coefficients);
    for (int k = 0; k < 199; ++k) {
        state[0] = 0.9 * (k - 99) / 99.0;
        state[1] = 0.9 * (k * 37 % 199 - 99) / 99.0;
        each_observables(0.0, state, &inputs, &coefficients, observables);
        for (int i = 0; i < each_OBSERVABLES; ++i) {
            printf(\"%.17g\\n\", observables[i]);
        }
    }
    return 0;
}
";

/// Compiles the program with `compiler` and these flags in `folder`, and runs it.
fn compile(compiler: &str, flags: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(compiler);
    command.current_dir(folder).args(flags);
    let files = ["main.c", "each.c", "-o", "each"];
    command.args(files).output().expect("a compiler")
}

fn print_values(compiler: &str, flags: &[&str], folder: &Path) -> Vec<f64> {
    let output = compile(compiler, flags, folder);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{flags:?}: {message}");
    let text = run(&mut Command::new(folder.join("each")));
    let values: Vec<f64> = text
        .lines()
        .map(|line| line.parse().expect("a number"))
        .collect();
    assert!(values.len() >= 199 * FUNCTIONS.len());
    values
}

fn write_program(folder: &Path) {
    let mut text = "[model]\nname = \"each\"\ntitle = \"Every elementary function\"\n\
        [parameters]\nm = { value = 1, unit = \"kg\" }\nd = { value = 1, unit = \"m\" }\n\
        [coordinates]\nx = { unit = \"m\" }\ny = { unit = \"m\" }\n\
        [kinetic]\nall = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[observables]\n"
        .to_owned();
    for (place, function) in FUNCTIONS.iter().enumerate() {
        writeln!(text, "o_{place} = \"{function}\"").expect("written");
    }
    let files = c::emit(&program(&text, 0, &[])).expect("emitted");
    for (name, content) in [
        ("each.h", files.header.as_str()),
        ("each.c", files.source.as_str()),
        ("main.c", MAIN),
    ] {
        std::fs::write(folder.join(name), content).expect("written");
    }
}

#[test]
fn reordered_sums_preserve_values() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    write_program(folder.path());
    let strict = print_values("cc", &["-std=c99", "-O1"], folder.path());
    let flags = ["-std=c99", "-O3", "-ffast-math"];
    let output = compile("cc", &flags, folder.path());
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(
        message.contains("define each_ALLOW_REASSOCIATION"),
        "{message}"
    );
    let allowed = [&flags[..], &["-Deach_ALLOW_REASSOCIATION"]].concat();
    let reordered = print_values("cc", &allowed, folder.path());
    for (place, (strict, reordered)) in strict.iter().zip(&reordered).enumerate() {
        let off = (strict - reordered).abs();
        assert!(
            off <= BOUND * strict.abs().max(1.0),
            "value {place}: {strict:e} and {reordered:e}"
        );
    }
}

/// In these dialects, gcc would fuse products and sums if the processor has a fused multiply-add.
#[test]
fn dialects_of_gnu_c_and_cpp_preserve_bits() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    write_program(folder.path());
    let strict = print_values("cc", &["-std=c99", "-O1"], folder.path());
    for (compiler, dialect) in [
        ("cc", &["-std=gnu99"][..]),
        ("cc", &["-std=gnu17"]),
        ("c++", &["-std=c++17", "-x", "c++"]),
        ("c++", &["-std=gnu++17", "-x", "c++"]),
    ] {
        let flags = [dialect, &["-O3", "-march=native"]].concat();
        let values = print_values(compiler, &flags, folder.path());
        assert_eq!(strict, values, "{flags:?}");
    }
}
