//! The emitted C with reordered sums: other bits, the same values within rounding.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

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

/// Program that prints every observable on a grid over the square.
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

fn print_values(flags: &[&str], folder: &Path) -> Vec<f64> {
    let executable = folder.join("each");
    run(Command::new("cc")
        .arg("-std=c99")
        .args(flags)
        .args([folder.join("main.c"), folder.join("each.c")])
        .arg("-o")
        .arg(&executable));
    let text = run(&mut Command::new(executable));
    text.lines()
        .map(|line| line.parse().expect("a number"))
        .collect()
}

#[test]
fn reordered_sums_preserve_values() {
    if !has_compilers() {
        return;
    }
    let mut text = "[model]\nname = \"each\"\ntitle = \"Every elementary function\"\n\
        [parameters]\nm = { value = 1, unit = \"kg\" }\nd = { value = 1, unit = \"m\" }\n\
        [coordinates]\nx = { unit = \"m\" }\ny = { unit = \"m\" }\n\
        [kinetic]\nall = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[observables]\n"
        .to_owned();
    for (place, function) in FUNCTIONS.iter().enumerate() {
        writeln!(text, "o_{place} = \"{function}\"").expect("written");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let files = c::emit(&program(&text, 0, &[])).expect("emitted");
    for (name, content) in [
        ("each.h", files.header.as_str()),
        ("each.c", files.source.as_str()),
        ("main.c", MAIN),
    ] {
        std::fs::write(folder.path().join(name), content).expect("written");
    }
    let strict = print_values(&["-O1"], folder.path());
    let reordered = print_values(&["-O3", "-ffast-math"], folder.path());
    assert_eq!(strict.len(), reordered.len());
    assert!(strict.len() >= 199 * FUNCTIONS.len());
    for (place, (strict, reordered)) in strict.iter().zip(&reordered).enumerate() {
        let off = (strict - reordered).abs();
        assert!(
            off <= BOUND * strict.abs().max(1.0),
            "value {place}: {strict:e} and {reordered:e}"
        );
    }
}
