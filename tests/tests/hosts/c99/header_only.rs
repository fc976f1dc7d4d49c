//! Tests of header-only C (`--packaging header-only`) in programs of several files in C and C++. Results are
//! bit-identical to the source file with its header, and there are no warnings.

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c::{self, Real};
use eomgen_codegen::program::Program;
use eomgen_codegen::variant::Variant;
use eomgen_tests::models::load;

use super::hostile::pendulum;
use super::{Compiled, WARNINGS, has_compilers, program, run, run_c_driver, supported_outputs};

/// Writes the header, and `NAME.c`, a user's file that compiles the functions.
fn write_header_only(program: &Program, folder: &Path) {
    let name = &program.name;
    let header = c::emit_header_only(program, Real::Double).expect("emitted");
    let source =
        format!("#define {name}_IMPLEMENTATION\n#include \"{name}.h\"\n#include \"{name}.h\"\n");
    std::fs::write(folder.join(format!("{name}.h")), header).expect("written");
    std::fs::write(folder.join(format!("{name}.c")), source).expect("written");
}

fn write_two_files(program: &Program, folder: &Path) {
    let name = &program.name;
    let files = c::emit(program).expect("emitted");
    std::fs::write(folder.join(format!("{name}.h")), files.header).expect("written");
    std::fs::write(folder.join(format!("{name}.c")), files.source).expect("written");
}

/// Compiles a file with all documented warnings as errors.
fn compile(folder: &Path, language: [&str; 2], arguments: &[&str]) {
    let [compiler, standard] = language;
    run(Command::new(compiler)
        .current_dir(folder)
        .args([standard, "-O2", "-ffp-contract=off", "-Wconversion"])
        .args(WARNINGS)
        .args(arguments));
}

const C: [&str; 2] = ["cc", "-std=c99"];
const CPP: [&str; 2] = ["c++", "-std=c++11"];

#[test]
fn header_only_code_is_bit_identical_to_header_and_source() {
    if !has_compilers() {
        return;
    }
    let arm = Variant::derive_with(&load("planetary_arm"), &[1], &supported_outputs());
    let belt = pendulum("belt", "t", "d", "l", "u", "theta");
    for program in [
        arm.expect("derived").program,
        program(&belt, 0, &supported_outputs()),
    ] {
        let [header, files] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        write_header_only(&program, header.path());
        write_two_files(&program, files.path());
        for real in ["double", "float"] {
            let run = |folder: &Path| run_c_driver(&program, real, Compiled::Optimised, folder);
            assert!(run(header.path()) == run(files.path()), "{real}");
        }
    }
}

/// Two files call functions that a third file, in C or C++, compiles. The callers define macros with names of the
/// header.
#[test]
fn several_files_in_c_and_cpp_share_the_functions() {
    if !has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_header_only(
        &program(
            &pendulum("rod", "t", "d", "I", "u", "theta"),
            0,
            &supported_outputs(),
        ),
        folder,
    );
    let user = |function: &str| {
        format!(
            "#define R 3\n#include \"rod.h\"\n{function} {{\n    const rod_real state[2] = {{1, R}};\n    rod_parameters parameters;\n    \
             rod_coefficients coefficients;\n    const rod_inputs inputs = {{0.5}};\n    rod_real rates[2];\n    \
             rod_default_parameters(&parameters);\n    rod_prepare(&parameters, &coefficients);\n    \
             rod_rates(0, state, &inputs, &coefficients, rates);\n    return rates[1];\n}}\n"
        )
    };
    let calls = "double first(void);\n".to_owned() + &user("double first(void)");
    let declared = "extern \"C\" double second(void);\n".to_owned();
    let calls_in_cpp = declared + &user("extern \"C\" double second(void)");
    let main = "#define rod_IMPLEMENTATION\n#define I 7\n#define R 3\n#include \"rod.h\"\n\
                #ifdef __cplusplus\nextern \"C\" {\n#endif\ndouble first(void);\ndouble second(void);\n\
                #ifdef __cplusplus\n}\n#endif\n\
                int main(void) {\n    return first() != 0.0 && first() == second() && I == 7 && R == 3 ? 0 : 1;\n}\n";
    for (name, text) in [
        ("first.c", &*calls),
        ("second.cpp", &*calls_in_cpp),
        ("main.c", main),
    ] {
        std::fs::write(folder.join(name), text).expect("written");
    }
    compile(folder, C, &["-c", "first.c", "-o", "first.o"]);
    compile(folder, CPP, &["-c", "second.cpp", "-o", "second.o"]);
    for main in [(C, "c"), (CPP, "c++")] {
        let (compiler, language) = main;
        compile(
            folder,
            compiler,
            &["-c", "-x", language, "main.c", "-o", "main.o"],
        );
        run(Command::new("c++")
            .current_dir(folder)
            .args(["main.o", "first.o", "second.o", "-o", "main"]));
        run(&mut Command::new(folder.join("main")));
    }
}
