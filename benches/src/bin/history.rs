//! Measures the right-hand sides, counts their instructions, writes `benches/times.csv`, appends a line to
//! `benches/history.csv` and draws both files as `docs/rates.svg` and `docs/history.svg`:
//!
//!     cargo run --release -p eomgen-benches --bin history

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use eomgen_benches::contenders::{equation_22, floor};
use eomgen_benches::eliminated_arm::EliminatedArm;
use eomgen_benches::history::{
    Contenders, Times, curves, development, heading, line, overlapping_table, table,
};
use eomgen_benches::instructions::{ARGUMENT, available, counted, names};
use eomgen_benches::{at_all_orders, cases, state, variants};
use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Number of calls per measurement.
const CALLS: u32 = 100;
/// Number of measurements per contender. The fastest counts, because other work disturbs it least.
const ROUNDS: usize = 600;

/// Returns the time of the fastest call of each contender, s.
fn fastest(contenders: &mut [&mut dyn FnMut(); 4]) -> [f64; 4] {
    let mut best = [f64::INFINITY; 4];
    for _ in 0..ROUNDS {
        for (best, contender) in best.iter_mut().zip(contenders.iter_mut()) {
            let begin = Instant::now();
            contender();
            *best = best.min(begin.elapsed().as_secs_f64() / f64::from(CALLS));
        }
    }
    best
}

/// Returns the time t of an independent call.
#[inline(always)]
fn independent_time(_: f64) -> f64 {
    black_box(0.3)
}

/// Returns the time t of a call that depends on the previous result: the rate that contains the sine.
#[inline(always)]
fn dependent_time(result: f64) -> f64 {
    0.3 + 0.0 * result
}

/// Measures the fastest call of each contender. The time t of a call is a function of the previous result.
macro_rules! calls {
    ($t:ident, $arm:ident, $state:ident, $inputs:ident, $coefficients:ident, $eliminated:ident, $equation:ident) => {{
        let [a, b, c, d] = &mut [$state; 4];
        // Index of the rate that contains the motor's sine.
        let row = $arm::DEGREES_OF_FREEDOM;
        let [floor, generated, hand_written, equation_22] = fastest(&mut [
            &mut || {
                for _ in 0..CALLS {
                    floor(
                        $t(a[row]),
                        black_box(&$state),
                        black_box(31.4),
                        black_box(a),
                    );
                }
            },
            &mut || {
                for _ in 0..CALLS {
                    $arm::rates_into(
                        $t(b[row]),
                        black_box(&$state),
                        &$inputs,
                        black_box(&$coefficients),
                        black_box(b),
                    );
                }
            },
            &mut || {
                for _ in 0..CALLS {
                    black_box(&$eliminated).rates($t(c[row]), black_box(&$state), black_box(c));
                }
            },
            &mut || {
                for _ in 0..CALLS {
                    equation_22(
                        black_box(&$equation),
                        $t(d[row]),
                        black_box(&$state),
                        black_box(d),
                    );
                }
            },
        ]);
        Contenders {
            floor,
            generated,
            hand_written,
            equation_22,
        }
    }};
}

macro_rules! times {
    ($($order:literal $module:ident),*) => {
        vec![$({
            use variants::$module as arm;
            let state = state::<{ arm::STATES }>();
            let inputs = arm::Inputs::default();
            let parameters = PlanetaryArmParameters::default();
            let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
            let eliminated = EliminatedArm::<$order>::new(&parameters);
            let equation = Equation22::<$order>::new(&parameters, 1.0, 1.0);
            Times {
                order: $order,
                overlapping: calls!(independent_time, arm, state, inputs, coefficients, eliminated, equation),
                waiting: calls!(dependent_time, arm, state, inputs, coefficients, eliminated, equation),
            }
        }),*]
    };
}

/// Returns the widest SIMD instruction set of this build.
fn features() -> &'static str {
    if cfg!(target_feature = "avx512f") {
        "avx512"
    } else if cfg!(target_feature = "avx2") {
        "avx2"
    } else if cfg!(target_feature = "sse2") {
        "sse2"
    } else {
        std::env::consts::ARCH
    }
}

/// Returns the output of git; empty if git fails.
fn git(arguments: &[&str]) -> String {
    let output = Command::new("git").args(arguments).output();
    output.map_or_else(
        |_| String::new(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().nth(1).as_deref() == Some(ARGUMENT) {
        cases::run();
        return Ok(());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let times: Vec<Times> = at_all_orders!(times);
    let counts = if available() {
        let here = std::env::current_exe()?;
        let profile = here.with_file_name("callgrind");
        std::fs::create_dir_all(&profile)?;
        counted(&here, &profile, &names())?
    } else {
        eprintln!("SKIPPED: instructions were not counted, because valgrind is missing");
        Vec::new()
    };
    let run = [
        git(&["log", "-1", "--format=%cs"]),
        git(&["describe", "--always", "--dirty=+"]),
        features().to_owned(),
    ];
    let path = folder.join("history.csv");
    let mut history = std::fs::read_to_string(&path).unwrap_or_else(|_| heading());
    let line = line(&run, &times, &counts);
    history.push_str(&line);
    let docs = folder.join("../docs");
    let drawn = overlapping_table(&times);
    let written = [
        (path, history.clone()),
        (folder.join("times.csv"), drawn.clone()),
        (docs.join("rates.svg"), curves(&drawn)?),
        (docs.join("history.svg"), development(&history)?),
    ];
    for (path, text) in written {
        let beside = path.with_extension("new");
        std::fs::write(&beside, text)?;
        std::fs::rename(&beside, &path)?;
    }
    print!("{}{}{line}", table(&times), heading());
    Ok(())
}
