//! Emitted C beside itself: two models in one program, a shared library loaded twice, several
//! threads, and no data that a call could change.

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c;
use eomgen_tests::models::{load, shipped, variant};

use super::hostile::pendulum;
use super::{WARNINGS, compilers, program, requested, run};

/// Writes the emitted C of a model to a folder.
fn written(folder: &Path, name: &str) {
    let text = pendulum(name, "t", "d", "l", "u", "theta");
    let files = c::emit(&program(&text, 0, &requested())).expect("emitted");
    std::fs::write(folder.join(format!("{name}.h")), files.header).expect("written");
    std::fs::write(folder.join(format!("{name}.c")), files.source).expect("written");
}

/// A compiler of C99 in a folder.
fn compiler(folder: &Path) -> Command {
    let mut command = Command::new("cc");
    command.current_dir(folder).args(["-std=c99", "-O2"]);
    command.args(WARNINGS);
    command
}

#[test]
fn models_libraries_and_threads_do_not_meet() {
    if !compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    written(folder, "first");
    written(folder, "second");
    run(compiler(folder).args(["-shared", "-fPIC", "second.c", "-o", "one.so"]));
    // The loader takes a file loaded twice for one.
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

/// Whatever `nm` calls data or uninitialised data could be changed by a call.
#[test]
fn nothing_static_can_be_written_to() {
    if !compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for path in shipped() {
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
