//! Tests of emitted controllers and steps, with bit-for-bit comparisons. The loop of `examples/closed_loop` is compared
//! with `simulate --solver fixed`. Controllers with every operation in C and Rust are compared with their evaluation in
//! simulations.

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c::{Files, emit};
use eomgen_codegen::program::{ControlValues, Output, Program, ProgramController};
use eomgen_codegen::rust::{self, Packaging};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::project;
use eomgen_tests::program::{run_accepted, text};

fn is_available(program: &str) -> bool {
    let output = Command::new(program).arg("--version").output();
    output.is_ok_and(|output| output.status.success())
}

fn run(command: &mut Command) -> String {
    let output = command.output().expect("a program");
    let said = text(&output.stdout);
    assert!(
        output.status.success(),
        "{command:?}: {said}{}",
        text(&output.stderr)
    );
    said
}

#[test]
fn loop_in_c_is_bit_identical_to_simulation_and_board() {
    if !is_available("cc") {
        skips::skip("the loop in C was not run: cc is missing (Debian: apt-get install gcc)");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let spec = project().join("examples/closed_loop/regulator.toml");
    let spec = spec.display().to_string();
    let (emitted, table) = (path("emitted"), path("motion.csv"));
    run_accepted(&[
        "generate", &spec, "--target", "c99", "--with", "step", "--out", &emitted,
    ]);
    let fixed = [
        "--solver",
        "fixed",
        "--step",
        "1e-4",
        "--interval",
        "1e-3",
        "--until",
        "2",
    ];
    run_accepted(&[&["simulate", &spec, "--out", &table][..], &fixed].concat());
    let said = run(Command::new("bash")
        .arg(project().join("examples/closed_loop/run"))
        .args([&emitted, &table, &path("built")]));
    assert!(
        said.contains("this machine: 2001 rows, 0 numbers differ\n"),
        "{said}"
    );
    match is_available("arm-none-eabi-gcc") && is_available("qemu-system-arm") {
        true => assert!(
            said.contains("cortex-m7: the same bits at 21 times\n"),
            "{said}"
        ),
        false => skips::skip(
            "the loop in C was not run on a board: arm-none-eabi-gcc or qemu-system-arm is missing",
        ),
    }
    // A gain that differs in the last digit must be detected.
    let changed = path("changed.csv");
    let set = ["--set", "k_phi=-0.38110000000000005"];
    run_accepted(&[&["simulate", &spec, "--out", &changed][..], &fixed, &set].concat());
    let other = Command::new(path("built/host")).arg(&changed).output();
    assert!(!other.expect("the loop").status.success());
}

/// Controllers with every operation of the language.
const OPERATIONS: &str = r#"
[model]
name = "operations"
[parameters]
m = { value = 2, unit = "kg m^2", min = 0 }
tau = { value = 10, unit = "ms" }
a = { value = 0.7, unit = "1" }
b = { value = "exp(-a)/3 + a^2", unit = "1" }
T = { value = "tau*b", unit = "s" }
[coordinates]
x = { unit = "1" }
[inputs]
r = { unit = "1" }
u = { unit = "1" }
v = { unit = "1" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
motor = { on = "x", value = "m*(u + v)/T^2" }
[observables]
far = { value = "x + r", unit = "1" }
[controllers.many]
period = "T"
offset = { value = 3, unit = "us" }
[controllers.many.states]
s = { unit = "1", next = "sin(x) + cos(tanh(s))*tan(far) - atan2(r, far) + asin(r/9)*acos(x/9) + pow_s", initial = "b/7" }
pow_s = { unit = "1", next = "abs(x)^1.3 + far^2 - tanh(s)^3 + sqrt(abs(r)) + ln(abs(x) + 1)" }
k = { unit = "1", next = "k + t/period + T*dot(x)" }
[controllers.many.outputs]
u = """quantise(clamp(sinh(r/3) + cosh(x/4)*tanh(far) + exp(-abs(r)), -b, a*s), 1/64) + min(x, far)*max(r, s)
    + deadzone(x, a) + contact(r, b) + above(far) + sign(x)"""
[controllers.second]
period = 0.25
outputs = { v = "-(s_2 + 1)*atan(x)" }
states = { s_2 = { unit = "1", next = "0.5*s_2 + clamp(u, -1, 1)", initial = 2 } }
"#;

/// Number of samples of each controller.
const SAMPLES: usize = 400;

/// Pseudo-random numbers from -4 to 4, identical in C and Rust.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64 * 8.0 - 4.0
    }
}

fn program() -> Program {
    let source = Source::new("operations.toml", OPERATIONS);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let variant = Variant::derive_with(&model, &[], &[Output::Step]);
    variant.expect("a derivation").program
}

/// Returns the bits of outputs and states of all samples in the format of the compiled programs.
fn evaluated(program: &Program) -> String {
    let parameters: Vec<f64> = program.parameters.iter().map(|known| known.value).collect();
    let mut printed = String::new();
    for controller in &program.controllers {
        let ([period, offset, delay], mut states) = controller.start(&parameters);
        let mut random = Random(1);
        let mut results = Vec::new();
        let mut print = |numbers: &mut dyn Iterator<Item = f64>| {
            numbers.for_each(|number| printed += &format!("{:016x}\n", number.to_bits()));
        };
        print(&mut [period, offset, delay].into_iter());
        for _ in 0..SAMPLES {
            let measured: Vec<f64> = controller.measured.iter().map(|_| random.next()).collect();
            let given = ControlValues {
                parameters: &parameters,
                period,
                measured: &measured,
                states: &states,
            };
            controller.evaluate(given, &mut results);
            print(&mut controller.output_values.iter().map(|place| results[*place]));
            states = controller
                .next
                .iter()
                .map(|place| results[*place])
                .collect();
            print(&mut states.iter().copied());
        }
    }
    printed
}

/// Returns the C program that prints the outputs and states of all samples.
fn c_driver(program: &Program) -> String {
    let mut text = "#include \"operations.h\"\n#include <stdio.h>\n#include <string.h>\n\
        static uint64_t seed;\n\
        static double random_number(void) {\n\
        seed = seed * 6364136223846793005u + 1442695040888963407u;\n\
        return (double)(seed >> 33) / 2147483648.0 * 8.0 - 4.0;\n}\n\
        static void print(double number) {\n\
        uint64_t bits;\nmemcpy(&bits, &number, sizeof bits);\n\
        printf(\"%016llx\\n\", (unsigned long long)bits);\n}\n\
        int main(void) {\n\
        operations_parameters parameters;\noperations_default_parameters(&parameters);\n"
        .to_owned();
    let lines = |controller: &ProgramController| {
        let own = format!("operations_controller_{}", controller.name);
        let of = |what: &str, all: &[eomgen_codegen::program::Quantity], line: &str| -> String {
            let all = all
                .iter()
                .map(|known| line.replace("FIELD", &format!("{what}.{}", known.name)));
            all.collect()
        };
        format!(
            "{{\n{own} memory;\n{own}_measured measured;\n{own}_outputs outputs;\nseed = 1;\n\
             {own}_start(&parameters, &memory);\n\
             print(memory.period);\nprint(memory.offset);\nprint(memory.delay);\n\
             for (int sample = 0; sample < {SAMPLES}; ++sample) {{\n{}\
             {own}_update(&memory, &measured, &parameters, &outputs);\n{}{}}}\n}}\n",
            of(
                "measured",
                &controller.measured,
                "FIELD = random_number();\n"
            ),
            of("outputs", &controller.outputs, "print(FIELD);\n"),
            of("memory", &controller.states, "print(FIELD);\n"),
        )
    };
    program
        .controllers
        .iter()
        .for_each(|controller| text += &lines(controller));
    text + "return 0;\n}\n"
}

/// Returns the Rust program that prints the outputs and states of all samples.
fn rust_driver(program: &Program) -> String {
    let mut text = "mod operations;\nuse operations::Parameters;\n\
        struct Random(u64);\nimpl Random {\nfn next(&mut self) -> f64 {\n\
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);\n\
        (self.0 >> 33) as f64 / 2147483648.0 * 8.0 - 4.0\n}\n}\n\
        fn print(number: f64) {\nprintln!(\"{:016x}\", number.to_bits());\n}\n\
        fn main() {\nlet parameters = Parameters::default();\n"
        .to_owned();
    let lines = |controller: &ProgramController| {
        let print = |what: &str, all: &[eomgen_codegen::program::Quantity]| -> String {
            all.iter()
                .map(|known| format!("print({what}.{});\n", known.name))
                .collect()
        };
        let measured = controller.measured.iter();
        let measured: Vec<String> = measured
            .map(|known| format!("{}: random.next()", known.name))
            .collect();
        format!(
            "{{\nuse operations::controller_{}::{{Measured, Memory, update}};\n\
             let mut memory = Memory::start(&parameters);\nlet mut random = Random(1);\n\
             print(memory.period);\nprint(memory.offset);\nprint(memory.delay);\n\
             for _ in 0..{SAMPLES} {{\nlet measured = Measured {{ {} }};\n\
             let outputs = update(&mut memory, &measured, &parameters);\n{}{}}}\n}}\n",
            controller.name,
            measured.join(", "),
            print("outputs", &controller.outputs),
            print("memory", &controller.states),
        )
    };
    program
        .controllers
        .iter()
        .for_each(|controller| text += &lines(controller));
    text + "}\n"
}

fn write(folder: &Path, name: &str, contents: &str) {
    std::fs::write(folder.join(name), contents).expect("written");
}

#[test]
fn emitted_controllers_are_bit_identical_to_simulated_controllers() {
    let program = program();
    let expected = evaluated(&program);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let emitted = rust::emit(&program, Packaging::Module).expect("Rust");
    write(folder, "operations.rs", &emitted);
    write(folder, "main.rs", &rust_driver(&program));
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let options = [
        "--edition",
        "2024",
        "-O",
        "-A",
        "dead_code",
        "-D",
        "warnings",
        "-o",
    ];
    run(Command::new(rustc)
        .args(options)
        .args(["in_rust", "main.rs"])
        .current_dir(folder));
    let printed = run(&mut Command::new(folder.join("in_rust")));
    assert_eq!(printed, expected, "Rust");
    if !is_available("cc") {
        skips::skip("controllers in C were not run: cc is missing (Debian: apt-get install gcc)");
        return;
    }
    let Files { header, source } = emit(&program).expect("C");
    write(folder, "operations.h", &header);
    write(folder, "operations.c", &source);
    write(folder, "main.c", &c_driver(&program));
    for optimisation in ["-O0", "-O2"] {
        let options = [
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-pedantic",
            optimisation,
        ];
        let files = ["main.c", "operations.c", "-o", "in_c"];
        run(Command::new("cc")
            .args(options)
            .args(files)
            .current_dir(folder));
        let printed = run(&mut Command::new(folder.join("in_c")));
        assert_eq!(printed, expected, "C with {optimisation}");
    }
}
