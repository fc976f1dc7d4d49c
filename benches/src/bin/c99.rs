//! Measures emitted C, emitted Rust and hand-written C for the same states of the planetary arm, with contact in half
//! of the meshes:
//!
//!     cargo run --release -p eomgen-benches --bin c99
//!
//! The Rust code is compiled with this program, the C code by `cc` with the flags in the table.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use eomgen_benches::eliminated_arm::EliminatedArm;
use eomgen_benches::variants;
use eomgen_codegen::c;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Number of states in a pass.
const STATES: usize = 1024;
/// Number of passes per turn. The fastest pass counts, because other work disturbs it least.
const PASSES: usize = 200;
/// Number of turns per program. Programs are measured in turns.
const TURNS: usize = 8;
/// Flags without fused or reordered operations. With these, C and Rust are bit-identical.
const FLAGS: [&[&str]; 3] = [
    &["-std=c99", "-O3"],
    &["-std=c99", "-O3", "-march=native"],
    &["-std=c99", "-O3", "-march=native", "-ffast-math"],
];
/// Largest accepted relative difference between the rates of the two C programs, which sum in different orders.
const MAX_DIFFERENCE: f64 = 1e-12;

/// Returns a generator of a fixed sequence of numbers in (-1, 1).
fn number_sequence() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Returns states with deflections of both signs within 50 um, twice the play.
fn states<const N: usize>() -> Vec<[f64; N]> {
    let mut number = number_sequence();
    let one = |k: usize, number: f64| match k % (N / 2) {
        0 | 1 if k < N / 2 => 5e-5 * number,
        mode @ 3.. => 1e-4 * number / (mode * mode) as f64,
        _ => 0.1 * number,
    };
    (0..STATES)
        .map(|_| std::array::from_fn(|k| one(k, number())))
        .collect()
}

/// Shortest times of a call, in ns.
#[derive(Clone, Copy)]
struct Times {
    rust: f64,
    emitted: f64,
    by_hand: f64,
}

/// Runs a command and returns its output.
fn run(command: &mut Command) -> Result<String, Box<dyn Error>> {
    let output = command.output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{command:?}: {said}").into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// Compiles both C programs with these flags.
fn compile(order: usize, flags: &[&str], folder: &Path) -> Result<(), Box<dyn Error>> {
    let by_hand = Path::new(env!("CARGO_MANIFEST_DIR")).join("c");
    run(Command::new("cc")
        .args(flags)
        .arg(format!("-DORDER={order}"))
        .arg("-Dplanetary_arm_ALLOW_REASSOCIATION")
        .arg("-I")
        .arg(folder)
        .arg(by_hand.join("turns.c"))
        .arg(by_hand.join("by_hand.c"))
        .arg(folder.join("planetary_arm.c"))
        .args(["-lm", "-o"])
        .arg(folder.join("turns")))?;
    Ok(())
}

/// Measures the times at one order with these flags.
fn measure_flags(
    flags: &[&str],
    order: usize,
    folder: &Path,
    rust: &mut dyn FnMut(),
) -> Result<Times, Box<dyn Error>> {
    compile(order, flags, folder)?;
    let mut best = Times {
        rust: f64::INFINITY,
        emitted: f64::INFINITY,
        by_hand: f64::INFINITY,
    };
    for _ in 0..TURNS {
        for _ in 0..PASSES {
            let begin = Instant::now();
            rust();
            let time = 1e9 * begin.elapsed().as_secs_f64() / STATES as f64;
            best.rust = best.rust.min(time);
        }
        let printed = run(Command::new(folder.join("turns"))
            .arg(folder.join("states"))
            .args([STATES.to_string(), PASSES.to_string()]))?;
        let found: Result<Vec<f64>, _> = printed.split_whitespace().map(str::parse).collect();
        let &[emitted, by_hand, apart] = found?.as_slice() else {
            return Err(format!("not three numbers: {printed}").into());
        };
        if apart.is_nan() || apart > MAX_DIFFERENCE {
            return Err(format!(
                "at order {order} the rates of the two C programs differ by {apart:e}"
            )
            .into());
        }
        best.emitted = best.emitted.min(emitted);
        best.by_hand = best.by_hand.min(by_hand);
    }
    Ok(best)
}

/// Measures one order with all flags.
macro_rules! order {
    ($model:ident, $order:literal, $module:ident) => {{
        use variants::$module as arm;
        let folder = tempfile::tempdir()?;
        emit($model, $order, folder.path())?;
        let states = states::<{ arm::STATES }>();
        let prepared =
            EliminatedArm::<$order>::new(&PlanetaryArmParameters::default()).prepared_numbers();
        let numbers = prepared.iter().chain(states.iter().flatten());
        let bytes: Vec<u8> = numbers.flat_map(|number| number.to_ne_bytes()).collect();
        std::fs::write(folder.path().join("states"), bytes)?;
        let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
        let inputs = arm::Inputs::default();
        let mut rates = [0.0; arm::STATES];
        let mut rust = || {
            for (i, state) in states.iter().enumerate() {
                let t = 1e-3 * i as f64;
                arm::rates_into(
                    t,
                    black_box(state),
                    &inputs,
                    black_box(&coefficients),
                    &mut rates,
                );
                black_box(&rates);
            }
        };
        for flags in FLAGS {
            let times = measure_flags(flags, $order, folder.path(), &mut rust)?;
            println!(
                "| {} | `{}` | {:.1} | {:.1} | {:.1} | {:.2} | {:.2} |",
                $order,
                flags[1..].join(" "),
                times.rust,
                times.emitted,
                times.by_hand,
                times.emitted / times.rust,
                times.emitted / times.by_hand,
            );
        }
    }};
}

/// Emits the C code of the model with this order.
fn emit(model: &Model, order: usize, folder: &Path) -> Result<(), Box<dyn Error>> {
    let variant = Variant::derive(model, &[order]).map_err(|found| found.render(false))?;
    let files = c::emit(&variant.program)?;
    std::fs::write(folder.join("planetary_arm.h"), files.header)?;
    std::fs::write(folder.join("planetary_arm.c"), files.source)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
    let model = &eomgen_model_spec::load(&path)
        .map_err(|found| found.render(false))?
        .model;
    println!("| S | cc | Rust, ns | C, ns | C by hand, ns | C : Rust | C : by hand |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    order!(model, 4, order_4);
    order!(model, 16, order_16);
    order!(model, 64, order_64);
    Ok(())
}
