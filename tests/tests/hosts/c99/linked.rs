//! Coexistence of emitted C: two models in one program, a shared library loaded twice, several
//! threads, and no writable static data.

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c;
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

/// `nm` must list no initialised or uninitialised data.
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

/// Fields compile if the caller includes headers with macros of their names, and the macros remain.
#[test]
fn fields_with_the_names_of_standard_macros_compile() {
    if !has_compilers() {
        return;
    }
    for [parameter, input] in [["I", "NAN"], ["EOF", "M_PI"], ["INFINITY", "complex"]] {
        compile_after_standard_headers(parameter, input);
    }
}

fn compile_after_standard_headers(parameter: &str, input: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let text = pendulum("rod", "t", "d", parameter, input, "theta");
    let files = c::emit(&program(&text, 0, &supported_outputs())).expect("emitted");
    std::fs::write(folder.join("rod.h"), files.header).expect("written");
    std::fs::write(folder.join("rod.c"), files.source).expect("written");
    let main = "#include <complex.h>\n#include <math.h>\n#include <stdio.h>\n#include \"rod.h\"\n\
                int main(void) {\n    const double complex z = 2.0 * I;\n    return cimag(z) == 2.0 && isinf(INFINITY) && EOF < 0 ? 0 : 1;\n}\n";
    std::fs::write(folder.join("main.c"), main).expect("written");
    run(compiler(folder).args(["-Wno-pedantic", "main.c", "rod.c", "-lm", "-o", "main"]));
    run(&mut Command::new(folder.join("main")));
}
