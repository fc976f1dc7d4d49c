//! Tests of several instances of emitted C in one process: two models in one program, a shared library that is loaded
//! twice, several threads. Emitted C has no writable static data.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use eomgen_codegen::c::{self, Real};
use eomgen_tests::models::{load, shipped_specifications, variant};

use super::hostile::pendulum;
use super::{WARNINGS, has_compilers, program, run, supported_outputs};

fn write_c(folder: &Path, name: &str) {
    let text = pendulum(name, "t", "d", "l", "u", "theta");
    let files = c::emit(&program(&text, 0, &supported_outputs())).expect("emitted");
    std::fs::write(folder.join(format!("{name}.h")), files.header).expect("written");
    std::fs::write(folder.join(format!("{name}.c")), files.source).expect("written");
}

fn compiler(folder: &Path) -> Command {
    let mut command = Command::new("cc");
    command.current_dir(folder).args(["-std=c99", "-O2"]);
    command.args(WARNINGS);
    command
}

#[test]
fn models_libraries_and_threads_are_independent() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_c(folder, "first");
    write_c(folder, "second");
    run(compiler(folder).args(["-shared", "-fPIC", "second.c", "-o", "one.so"]));
    // The loader would load the same file only once.
    std::fs::copy(folder.join("one.so"), folder.join("other.so")).expect("copied");
    std::fs::write(folder.join("linked.c"), include_str!("linked.c")).expect("written");
    run(compiler(folder).args([
        "-pthread", "linked.c", "first.c", "second.c", "-ldl", "-o", "linked",
    ]));
    let said = run(Command::new(folder.join("linked"))
        .arg(folder.join("one.so"))
        .arg(folder.join("other.so")));
    assert_eq!(said, "the same\n");
}

/// `nm` must list neither initialised nor uninitialised data.
#[test]
fn emitted_c_has_no_writable_static_data() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for path in shipped_specifications() {
        let name = path.file_stem().and_then(|name| name.to_str());
        let model = load(name.expect("a name"));
        let files = c::emit(variant(&model, 4).evaluator.program()).expect("emitted");
        std::fs::write(folder.join(format!("{}.h", model.name)), files.header).expect("written");
        std::fs::write(folder.join("model.c"), files.source).expect("written");
        run(compiler(folder).args(["-O0", "-fno-pic", "-c", "model.c", "-o", "model.o"]));
        let symbols = run(Command::new("nm").current_dir(folder).arg("model.o"));
        assert!(symbols.contains(" T "), "{symbols}");
        for line in symbols.lines() {
            let kind = line.rsplit(' ').nth(1).expect("a kind");
            assert!(!"BbCDdGgSsVvU".contains(kind), "{}: {line}", model.name);
        }
    }
}

/// Returns a model whose names are macros of standard headers: parameters, an input, coordinates, a state, definitions,
/// energies and observables.
fn model_of_macros(names: &[&str; 9]) -> String {
    let [
        parameter,
        other,
        input,
        x,
        y,
        state,
        definition,
        energy,
        observable,
    ] = names;
    format!(
        r#"
[model]
name = "rod"
[parameters]
{parameter} = {{ value = 2, unit = "kg" }}
{other} = {{ value = 3, unit = "N/m" }}
tau = {{ value = 1, unit = "s" }}
one = {{ value = 1, unit = "m" }}
F = {{ value = 1, unit = "N" }}
[coordinates]
{x} = {{ unit = "m", initial = 0.1 }}
{y} = {{ unit = "m" }}
[inputs]
{input} = {{ unit = "N" }}
[states]
{state} = {{ unit = "N", rate = "({input} - {state})/tau" }}
[definitions]
{definition} = "{x} - {y}"
[kinetic]
{energy} = "1/2*{parameter}*(dot({x})^2 + dot({y})^2)"
[potential]
b = "1/2*{other}*{definition}^2 + 1/2*{other}*{x}^2"
[forces]
a = {{ on = "{x}", value = "{input} + {state} - F*sin({x}/one)" }}
[observables]
{observable} = {{ value = "{definition}", unit = "m" }}
"#
    )
}

const MACRO_NAMES: [[&str; 9]; 4] = [
    [
        "I", "NAN", "EOF", "INFINITY", "M_PI", "M_E", "HUGE_VAL", "RAND_MAX", "BUFSIZ",
    ],
    [
        "complex", "M_SQRT2", "EDOM", "I", "NAN", "SIZE_MAX", "EIO", "M_PI", "EOF",
    ],
    [
        "M_E", "SIGINT", "I", "EOF", "FLT_MAX", "INT_MAX", "I_0", "HUGE_VAL", "M_PI",
    ],
    [
        "OVERFLOW",
        "I",
        "LC_ALL",
        "HUGE_VAL",
        "UINT8_MAX",
        "NAN",
        "INFINITY",
        "CLOCKS_PER_SEC",
        "imaginary",
    ],
];

const STANDARD_HEADERS: &str = "#include <complex.h>\n#include <errno.h>\n#include <float.h>\n#include <limits.h>\n\
    #include <locale.h>\n#include <math.h>\n#include <signal.h>\n#include <stdint.h>\n#include <stdio.h>\n\
    #include <stdlib.h>\n#include <time.h>\n";

const MACRO_USER: &str = "int main(void) {\n    const double complex z = 2.0 * I;\n    \
    return cimag(z) == 2.0 && isinf(INFINITY) && isnan(NAN) && EOF < 0 && M_PI > 3.0 && EDOM > 0 ? 0 : 1;\n}\n";

/// Names of a model compile if the caller includes headers with macros of the same names, before or after the emitted
/// code. The macros remain defined.
#[test]
fn names_of_standard_macros_compile_in_all_packagings() {
    if !has_compilers() {
        return;
    }
    for names in &MACRO_NAMES {
        let program = program(&model_of_macros(names), 0, &supported_outputs());
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let compile = |main: &str, sources: &[&str]| {
            std::fs::write(folder.join("main.c"), main).expect("written");
            let mut command = compiler(folder);
            let arguments = ["-Wno-pedantic", "-D_GNU_SOURCE", "-lm", "-o", "main"];
            run(command.arg("main.c").args(sources).args(arguments));
            run(&mut Command::new(folder.join("main")));
        };
        let header = c::emit_header_only(&program, Real::Double).expect("emitted");
        std::fs::write(folder.join("rod.h"), header).expect("written");
        let include = "#define rod_IMPLEMENTATION\n#include \"rod.h\"\n";
        compile(&[STANDARD_HEADERS, include, MACRO_USER].concat(), &[]);
        compile(&[include, STANDARD_HEADERS, MACRO_USER].concat(), &[]);
        let files = c::emit(&program).expect("emitted");
        std::fs::write(folder.join("rod.h"), files.header).expect("written");
        std::fs::write(folder.join("rod.c"), files.source).expect("written");
        let include = "#include \"rod.h\"\n";
        compile(
            &[STANDARD_HEADERS, include, MACRO_USER].concat(),
            &["rod.c"],
        );
        compile(
            &[STANDARD_HEADERS, "#include \"rod.c\"\n", MACRO_USER].concat(),
            &[],
        );
    }
}

/// The compiler lists all macros without arguments of the standard headers; each must be hidden while the emitted code
/// is compiled.
#[test]
fn each_macro_of_the_standard_headers_is_hidden() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let list = |text: &str| -> BTreeSet<String> {
        std::fs::write(folder.path().join("all.c"), text).expect("written");
        let mut command = compiler(folder.path());
        let text = run(command.args(["-std=gnu99", "-dM", "-E", "all.c"]));
        let names = text.lines().filter_map(|line| line.split(' ').nth(1));
        let plain = names.filter(|name| !name.contains('(') && !name.starts_with('_'));
        plain.map(str::to_owned).collect()
    };
    let own = list("\n");
    let all: BTreeSet<String> = &list(STANDARD_HEADERS) - &own;
    assert!(all.len() > 300, "{}", all.len());
    let mut names = all.iter().filter(|name| c::is_identifier(name)).peekable();
    while names.peek().is_some() {
        let mut given = ["p0", "p1", "u", "x", "y", "z", "d", "e", "o"];
        for slot in &mut given {
            if let Some(name) = names.next() {
                *slot = name;
            }
        }
        let program = program(&model_of_macros(&given), 0, &[]);
        let header = c::emit_header_only(&program, Real::Double).expect("emitted");
        for name in all.iter().filter(|name| given.contains(&name.as_str())) {
            let is_used = words(&header).contains(name.as_str());
            let is_hidden = header.contains(&format!("#undef {name}\n"));
            assert!(is_hidden || !is_used, "{name}");
        }
    }
}

/// Returns the words of a text without its comments and strings.
fn words(text: &str) -> BTreeSet<&str> {
    let mut code = BTreeSet::new();
    for part in text.split("*/") {
        let part = part.split("/*").next().unwrap_or_default();
        for line in part.lines().filter(|line| !line.contains('"')) {
            code.extend(line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'));
        }
    }
    code
}
