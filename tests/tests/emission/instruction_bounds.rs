//! Comparison of the bounds of instructions and stack with counts on emulated microcontrollers
//! (`instruction_counts.c`). Tests are skipped with a message if the emulator or the compiler is missing.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use eomgen_tests::models::project;
use eomgen_tests::program::eomgen;
use serde_json::Value;

/// File with recorded bounds and counts of `rates` for all shipped machines; EOMGEN_REFRESH measures them again.
const RECORDED: &str = "examples/bare_metal/bounds.txt";

/// Machines that every test run measures: angles, contacts with play, modes, quaternions.
const MACHINES: [&str; 4] = [
    "crane",
    "planetary_arm",
    "hub_beam_tip_mass",
    "shaft_and_disc",
];

/// Processor cores with their emulated boards and compiler options.
const CORES: [[&str; 3]; 2] = [
    [
        "cortex-m4",
        "mps2-an386",
        "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16",
    ],
    ["cortex-m7", "mps2-an500", "-mcpu=cortex-m7 -mfpu=fpv5-d16"],
];

/// Functions in the order in which `instruction_counts.c` calls them.
const FUNCTIONS: [&str; 8] = [
    "prepare",
    "rates",
    "observables",
    "energy",
    "power",
    "guards",
    "mass_matrix",
    "step",
];

/// Bounds and largest counts of one function.
struct Measured {
    function: &'static str,
    /// Bounds: instructions for all numbers, instructions without subnormal numbers, stack.
    bounds: Option<[u64; 3]>,
    /// Largest counts: instructions at states of typical magnitude, instructions at all states, stack.
    counts: [u64; 3],
}

fn missing_tool() -> Option<&'static str> {
    let is_there = |program: &str| Command::new(program).arg("--version").output().is_ok();
    let tools = [
        (
            "qemu-system-arm",
            "qemu-system-arm (Debian: apt-get install qemu-system-arm)",
        ),
        (
            "arm-none-eabi-gcc",
            "arm-none-eabi-gcc (Debian: apt-get install gcc-arm-none-eabi)",
        ),
    ];
    let missing = tools.into_iter().find(|(program, _)| !is_there(program));
    missing.map(|(_, how)| how)
}

/// Returns true if the tools are installed; otherwise reports the skip.
fn has_tools() -> bool {
    if let Some(missing) = missing_tool() {
        skips::skip(&format!(
            "bounds of instructions were not compared with counts: {missing} is missing"
        ));
    }
    missing_tool().is_none()
}

fn run(command: &mut Command) -> std::process::Output {
    let output = command.output().expect("the tool");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
    output
}

fn emit(machine: &str, folder: &Path) {
    let specification = project().join(format!("model-spec/models/{machine}.toml"));
    let output = eomgen()
        .args(["generate", "--with", "step", "--target", "c99", "--out"])
        .args([folder, &specification])
        .output();
    assert!(output.expect("eomgen").status.success());
}

/// Computes the bounds of the functions of an emitted machine and counts their instructions in the emulator.
fn measure(
    machine: &str,
    folder: &Path,
    [_, board, options]: [&str; 3],
    number: &str,
    level: &str,
) -> Vec<Measured> {
    let real = format!("-D{machine}_REAL={number}");
    let command = format!(
        "arm-none-eabi-gcc {options} -mthumb -mfloat-abi=hard -std=c99 {level} -fno-tree-loop-distribute-patterns {real}"
    );
    let source = folder.join(format!("{machine}.c"));
    let output = eomgen()
        .arg("instructions")
        .arg(&source)
        .args(["--cc", &command, "--json"])
        .output();
    let output = output.expect("eomgen");
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let listed = document["functions"].as_array().expect("functions");
    let bounds = |function: &str| {
        // The header adds the type to the names.
        let end = if number == "float" { "_float" } else { "" };
        let name = format!("{machine}_{function}{end}");
        let found = listed
            .iter()
            .find(|listed| listed["name"] == *name)
            .expect("the function");
        let number = |key: &str| found[key].as_u64();
        Some([
            number("instructions")?,
            number("instructions_without_subnormals")?,
            number("stack")?,
        ])
    };
    let words: Vec<&str> = command.split(' ').collect();
    let gcc = |arguments: &[&str]| {
        run(Command::new(words[0])
            .args(&words[1..])
            .args(arguments)
            .arg("-I")
            .arg(folder)
            .current_dir(folder))
    };
    let source = source.display().to_string();
    let counts = project()
        .join("tests/tests/emission/instruction_counts.c")
        .display()
        .to_string();
    let script = project()
        .join("examples/bare_metal/link.ld")
        .display()
        .to_string();
    let [model, header] = [
        format!("-DMODEL={machine}"),
        format!("-DMODEL_H=\"{machine}.h\""),
    ];
    gcc(&["-c", "-o", "model.o", &source]);
    gcc(&[
        "-std=gnu99",
        "-O1",
        "-ffreestanding",
        &model,
        &header,
        "-c",
        "-o",
        "counts.o",
        &counts,
    ]);
    gcc(&[
        "-nostdlib",
        "-T",
        &script,
        "-o",
        "program",
        "counts.o",
        "model.o",
        "-lgcc",
    ]);
    let emulator = [
        "-nographic",
        "-monitor",
        "none",
        "-serial",
        "none",
        "-icount",
        "shift=0",
    ];
    let semihosting = [
        "-semihosting-config",
        "enable=on,target=native",
        "-kernel",
        "program",
    ];
    let emulated = run(Command::new("timeout")
        .args(["120", "qemu-system-arm", "-machine", board])
        .args(emulator)
        .args(semihosting)
        .current_dir(folder));
    let printed = String::from_utf8_lossy(&emulated.stderr).into_owned();
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), FUNCTIONS.len(), "{printed}");
    let measured = FUNCTIONS.into_iter().zip(lines).map(|(function, line)| {
        let mut words = line
            .split(' ')
            .map(|word| u64::from_str_radix(word, 16).expect("digits"));
        let mut next = || words.next().expect("three numbers");
        // A tick of the timer is 40 instructions. The ticks of 80 calls of a function are compared with 80 calls of a
        // function of one instruction.
        let [usual, all] = [next(), next()].map(|ticks| ticks / 2 + 1);
        Measured {
            function,
            bounds: bounds(function),
            counts: [usual, all, next()],
        }
    });
    measured.collect()
}

fn assert_no_bound_is_exceeded(measured: &[Measured], case: &str) {
    for Measured {
        function,
        bounds,
        counts,
    } in measured
    {
        let Some([all, without_subnormals, stack]) = *bounds else {
            // gcc replaces the initialisation of an array with zeros by a call of `memset`, which is not part of
            // libgcc.
            assert_eq!(*function, "prepare", "{case} has no bound of {function}");
            continue;
        };
        let [usual_count, all_count, stack_count] = *counts;
        assert!(
            usual_count <= without_subnormals,
            "{case} {function}: {usual_count} > {without_subnormals}"
        );
        assert!(all_count <= all, "{case} {function}: {all_count} > {all}");
        assert!(
            stack_count <= stack,
            "{case} {function}: stack {stack_count} > {stack}"
        );
    }
}

/// Cases: both cores, both precisions, two optimisation levels, states of typical magnitude, and states with subnormal,
/// infinite and NaN numbers.
#[test]
fn emulated_counts_never_exceed_bounds() {
    if !has_tools() {
        return;
    }
    for machine in MACHINES {
        let folder = tempfile::tempdir().expect("a folder");
        emit(machine, folder.path());
        for core in CORES {
            for number in ["float", "double"] {
                for level in ["-O2", "-O3"] {
                    let measured = measure(machine, folder.path(), core, number, level);
                    let case = format!("{} {machine} {number} {level}", core[0]);
                    assert_no_bound_is_exceeded(&measured, &case);
                }
            }
        }
    }
}

/// The table in docs/embedding.md must match the recorded measurement of all shipped machines.
#[test]
fn documented_ratios_match_recorded_bounds() {
    if std::env::var_os("EOMGEN_REFRESH").is_some() && has_tools() {
        std::fs::write(project().join(RECORDED), measure_all_machines()).expect("written");
    }
    let recorded = std::fs::read_to_string(project().join(RECORDED)).expect("recorded bounds");
    let page = std::fs::read_to_string(project().join("docs/embedding.md")).expect("the page");
    let lines: Vec<Vec<&str>> = recorded
        .lines()
        .map(|line| line.split(' ').collect())
        .collect();
    for machine in lines.chunks(4) {
        let cells: Vec<String> = machine.iter().map(|words| cell(&words[3..])).collect();
        let row = format!("| `{}` | {} |", machine[0][0], cells.join(" | "));
        assert!(page.contains(&row), "docs/embedding.md has no row {row}");
    }
}

/// Returns a table cell with the bounds and their ratios to the largest counts.
fn cell(numbers: &[&str]) -> String {
    let numbers: Vec<f64> = numbers
        .iter()
        .map(|word| word.parse().expect("a number"))
        .collect();
    let [
        all,
        without_subnormals,
        stack,
        usual_count,
        all_count,
        stack_count,
    ] = numbers[..]
    else {
        panic!("six numbers");
    };
    assert!(usual_count <= without_subnormals && all_count <= all && stack_count <= stack);
    let mut text = format!(
        "{without_subnormals} ({:.2})",
        without_subnormals / usual_count
    );
    if all > without_subnormals {
        write!(text, ", {all} ({:.1})", all / all_count).expect("a string");
    }
    text
}

/// Returns machine, core, number type, bounds and counts of the rates.
fn measure_all_machines() -> String {
    let mut text = String::new();
    let files = std::fs::read_dir(project().join("model-spec/models")).expect("the models");
    let mut machines: Vec<String> = files
        .filter_map(|file| {
            let name = file
                .expect("a file")
                .file_name()
                .into_string()
                .expect("a name");
            name.strip_suffix(".toml").map(str::to_owned)
        })
        .collect();
    machines.sort();
    for machine in machines {
        let folder = tempfile::tempdir().expect("a folder");
        emit(&machine, folder.path());
        for number in ["float", "double"] {
            for core in CORES {
                let measured = measure(&machine, folder.path(), core, number, "-O2");
                assert_no_bound_is_exceeded(&measured, &format!("{} {machine} {number}", core[0]));
                let rates = measured
                    .iter()
                    .find(|measured| measured.function == "rates");
                let rates = rates.expect("the rates");
                let bounds = rates.bounds.expect("bounds of the rates");
                let numbers = bounds.iter().chain(&rates.counts).map(u64::to_string);
                let numbers: Vec<String> = numbers.collect();
                writeln!(text, "{machine} {number} {} {}", core[0], numbers.join(" "))
                    .expect("a string");
            }
        }
    }
    text
}

/// If the number of iterations of a loop depends on data, there is no bound and the command fails.
#[test]
fn loop_over_data_has_no_bound() {
    if !has_tools() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    emit("crane", folder.path());
    let path = folder.path().join("crane.c");
    let source = std::fs::read_to_string(&path).expect("the source");
    let correct = "    (void)t;\n    const crane_real l = inputs->l;\n";
    let faulty = "    while (t > R(1e-3)) {\n        t = R(0.5) * t;\n    }\n    const crane_real l = inputs->l + t;\n";
    assert!(source.contains(correct));
    std::fs::write(&path, source.replacen(correct, faulty, 1)).expect("written");
    let command = format!(
        "arm-none-eabi-gcc {} -mthumb -mfloat-abi=hard -std=c99 -O2 -Dcrane_REAL=float",
        CORES[0][2]
    );
    let output = eomgen()
        .arg("instructions")
        .arg(&path)
        .args(["--cc", &command])
        .output();
    let output = output.expect("eomgen");
    assert_eq!(output.status.code(), Some(1));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let rates = printed
        .lines()
        .find(|line| line.starts_with("  crane_rates_float "));
    let rates = rates.expect("the rates");
    assert!(
        rates.contains("not bounded: a loop") && rates.contains("at crane_rates_float+"),
        "{printed}"
    );
    let energy = printed
        .lines()
        .find(|line| line.starts_with("  crane_energy_float "));
    assert!(
        energy.expect("the energy").contains(" instructions, "),
        "{printed}"
    );
}

/// The certificate contains the bounds. `verify` computes them again and rejects changed bounds.
#[test]
fn certificate_contains_bounds_that_verify_recomputes() {
    if !has_tools() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let command = format!(
        "arm-none-eabi-gcc {} -mthumb -mfloat-abi=hard -std=c99 -O2 -Dpendulum_REAL=float",
        CORES[1][2]
    );
    let specification = project().join("model-spec/models/pendulum.toml");
    let output = eomgen()
        .args([
            "generate",
            "--target",
            "c99",
            "--certify",
            "--instructions",
            &command,
            "--out",
        ])
        .args([folder.path(), &specification])
        .output();
    assert!(output.expect("eomgen").status.success());
    let path = folder.path().join("certificate.json");
    let text = std::fs::read_to_string(&path).expect("the certificate");
    let certificate: Value = serde_json::from_str(&text).expect("JSON");
    let bounds = &certificate["instructions"][0];
    assert_eq!(
        (&bounds["command"], &bounds["source"]),
        (&command.as_str().into(), &"pendulum.c".into())
    );
    let verify = |instructions: &[&str]| {
        let source = folder.path().join("pendulum.c");
        eomgen()
            .arg("verify")
            .args([&source, &path])
            .args(instructions)
            .output()
            .expect("eomgen")
    };
    let allowed = ["--instructions", &command];
    let output = verify(&allowed);
    assert!(output.status.success());
    assert!(
        String::from_utf8_lossy(&output.stdout).contains("instructions and stack: as certified")
    );
    let functions = bounds["functions"].as_array().expect("functions");
    let rates = functions
        .iter()
        .find(|function| function["name"] == "pendulum_rates_float");
    let output = verify(&[]);
    assert!(output.status.success());
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(printed.contains("NOT RUN (give this command"), "{printed}");
    assert!(
        printed.contains("PARTIAL") && !printed.contains("\npassed\n"),
        "{printed}"
    );
    let stated = format!(
        "\"instructions\": {},",
        rates.expect("the rates")["instructions"]
    );
    std::fs::write(&path, text.replace(&stated, "\"instructions\": 1,")).expect("written");
    let output = verify(&allowed);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("differ from those in the certificate")
    );
    // A certificate from an untrusted source must not run programs.
    let mark = folder.path().join("mark");
    let other = text.replace(&command, &format!("touch {}", mark.display()));
    assert_ne!(other, text);
    std::fs::write(&path, other).expect("written");
    assert_eq!(verify(&[]).status.code(), Some(2));
    assert!(!mark.exists());
    assert_eq!(verify(&allowed).status.code(), Some(2));
}
