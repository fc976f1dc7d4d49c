//! Bit-for-bit comparison of emitted steps with sticking friction and contacts, in C on this machine and on a
//! microcontroller, with `simulate --solver fixed`.

use std::path::Path;
use std::process::Command;

use eomgen_tests::contact_machines::{BALLS, BLOCK_ON_CART, PENDULUM, STRIBECK};
use eomgen_tests::models::project;
use eomgen_tests::program::{run_accepted, text};

const STEPS: usize = 1500;
const ROW: usize = 50;

fn is_available(program: &str) -> bool {
    let output = Command::new(program).arg("--version").output();
    output.is_ok_and(|output| output.status.success())
}

fn run(command: &mut Command) -> String {
    let output = command.output().expect("a program");
    let said = text(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
    text(&output.stdout) + &said
}

/// Returns the bits of the states in all rows of a table except the first, one state per line.
fn bits_of_rows(table: &Path, states: usize) -> String {
    let table = std::fs::read_to_string(table).expect("a table");
    let numbers = table.lines().skip(2).flat_map(|row| {
        let numbers = row.split(',').skip(1).take(states);
        numbers.map(|number| number.parse::<f64>().expect("a number"))
    });
    numbers
        .map(|number| format!("{:016x}\n", number.to_bits()))
        .collect()
}

/// Compiles the harness with the emitted machine.
fn build(compiler: &str, options: &[&str], emitted: &Path, out: &Path) {
    let harness = project().join("tests/tests/emission/contact_steps.c");
    let sizes = format!("-DSTEPS={STEPS} -DROW={ROW} -DLENGTH=0.0009765625");
    run(Command::new(compiler)
        .args([
            "-std=c99",
            "-O2",
            "-ffp-contract=off",
            "-Wall",
            "-Wextra",
            "-Werror",
        ])
        .args(sizes.split(' '))
        .arg("-DHEADER=\"machine.h\"")
        .args(options)
        .arg("-I")
        .arg(emitted)
        .args([&harness, &emitted.join("machine.c")])
        .arg("-lgcc")
        .arg("-o")
        .arg(out));
}

#[test]
fn steps_in_c_are_bit_identical_to_simulation_and_board() {
    if !is_available("cc") {
        skips::skip("steps in C were not run: cc is missing (Debian: apt-get install gcc)");
        return;
    }
    let has_board = is_available("arm-none-eabi-gcc") && is_available("qemu-system-arm");
    if !has_board {
        skips::skip(
            "steps in C were not run on a board: arm-none-eabi-gcc or qemu-system-arm is missing",
        );
    }
    for (specification, states) in [(STRIBECK, 2), (BALLS, 4), (BLOCK_ON_CART, 6), (PENDULUM, 4)] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let shown = |name: &str| path(name).display().to_string();
        std::fs::write(path("machine.toml"), specification).expect("a file");
        run_accepted(&[
            "generate",
            &shown("machine.toml"),
            "--target",
            "c99",
            "--with",
            "step",
            "--out",
            &shown("emitted"),
        ]);
        let until = (STEPS as f64 / 1024.0).to_string();
        let interval = (ROW as f64 / 1024.0).to_string();
        run_accepted(&[
            "simulate",
            &shown("machine.toml"),
            "--solver",
            "fixed",
            "--step",
            "0.0009765625",
            "--until",
            &until,
            "--interval",
            &interval,
            "--out",
            &shown("rows.csv"),
        ]);
        let expected = bits_of_rows(&path("rows.csv"), states);
        build("cc", &[], &path("emitted"), &path("host"));
        let found = run(&mut Command::new(path("host")));
        assert!(found == expected, "{specification}\n{found}\n{expected}");
        if has_board {
            let link = project()
                .join("examples/bare_metal/link.ld")
                .display()
                .to_string();
            let options = "-DBOARD -mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-d16 -ffreestanding -nostdlib -T";
            let options: Vec<&str> = options.split(' ').chain([&*link]).collect();
            build(
                "arm-none-eabi-gcc",
                &options,
                &path("emitted"),
                &path("board"),
            );
            let board = "-machine mps2-an500 -nographic -monitor none -serial none -semihosting-config \
                         enable=on,target=native -kernel";
            let found = run(Command::new("qemu-system-arm")
                .args(board.split_whitespace())
                .arg(path("board")));
            assert!(found == expected, "{specification} on the board");
        }
    }
}
