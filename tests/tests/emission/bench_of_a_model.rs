//! Test that the benchmark of `generate --with bench` compiles, runs, and compares with a saved baseline.

use std::path::Path;
use std::process::Command;

use eomgen_tests::models::{path, project};
use eomgen_tests::program::{compiled_library, run_accepted, text};

/// Returns the version of Criterion in `Cargo.lock`.
fn criterion_version() -> String {
    let lock = std::fs::read_to_string(project().join("Cargo.lock")).expect("Cargo.lock");
    let (_, entry) = lock
        .split_once("name = \"criterion\"\nversion = \"")
        .expect("Criterion is locked");
    entry.split('"').next().unwrap_or_default().to_owned()
}

/// Writes a package that re-exports the compiled Criterion. Compiling Criterion with its dependencies again would take
/// 40 s of processor time.
fn write_criterion(folder: &Path) {
    std::fs::create_dir_all(folder.join("src")).expect("a folder");
    let manifest = format!(
        "[package]\nname = \"criterion\"\nversion = \"{}\"\nedition = \"2024\"\n",
        criterion_version()
    );
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("written");
    std::fs::write(
        folder.join("src/lib.rs"),
        "pub use compiled_criterion::*;\n",
    )
    .expect("written");
}

fn run_bench(folder: &Path, criterion: &Path, options: &[&str]) -> String {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let compiled = compiled_library("criterion");
    let dependencies = compiled.parent().expect("a folder");
    let flags = [
        format!("--extern=compiled_criterion={}", compiled.display()),
        format!("-Ldependency={}", dependencies.display()),
    ];
    let short = [
        "--warm-up-time",
        "0.05",
        "--measurement-time",
        "0.1",
        "--sample-size",
        "10",
        "--nresamples",
        "1000",
    ];
    let output = Command::new(cargo)
        .args(["bench", "--offline", "--quiet", "--config"])
        .arg(format!(
            "patch.crates-io.criterion.path={:?}",
            criterion.display().to_string()
        ))
        .arg("--")
        .args(options)
        .args(short)
        .current_dir(folder)
        .env(
            "CARGO_TARGET_DIR",
            concat!(env!("CARGO_TARGET_TMPDIR"), "/bench_of_a_model"),
        )
        .env("CRITERION_HOME", folder.join("criterion"))
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"))
        // The test checks only the output, so the benchmark is compiled without optimisation.
        .env("CARGO_PROFILE_BENCH_OPT_LEVEL", "0")
        .output()
        .expect("cargo can be run");
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn generated_benchmark_runs_and_compares_with_baseline() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = path("cart_two_arms").display().to_string();
    let out = folder.path().display().to_string();
    let with = "bias_forces,inverse_dynamics,guard_rates,jacobians,products,linearisation,bench";
    let generate = ["generate", &spec, "--with", with, "--out", &out];
    run_accepted(&generate);
    // The lock file of this workspace is used, so that nothing is downloaded.
    std::fs::copy(
        project().join("Cargo.lock"),
        folder.path().join("Cargo.lock"),
    )
    .expect("a file can be copied");
    let criterion = tempfile::tempdir().expect("a folder");
    write_criterion(criterion.path());
    let first = run_bench(
        folder.path(),
        criterion.path(),
        &["--save-baseline", "before"],
    );
    for name in [
        "rates",
        "observables",
        "inverse_dynamics",
        "rates_by_state",
        "linearise",
    ] {
        assert!(first.contains(&format!("{name} ")), "{name}: {first}");
    }
    let manifest = folder.path().join("Cargo.toml");
    let own = std::fs::read_to_string(&manifest).expect("a manifest") + "# mine\n";
    std::fs::write(&manifest, &own).expect("a file can be written");
    run_accepted(&generate);
    let kept = std::fs::read_to_string(&manifest).expect("a manifest");
    assert_eq!(kept, own, "an existing manifest is not replaced");
    let second = run_bench(folder.path(), criterion.path(), &["--baseline", "before"]);
    assert!(second.contains("change:"), "{second}");
}

#[test]
fn unknown_output_is_rejected_and_bench_is_listed() {
    let spec = path("pendulum").display().to_string();
    let refused = eomgen_tests::program::run_rejected(&[
        "generate",
        &spec,
        "--with",
        "benchmark",
        "--out",
        "x",
    ]);
    assert!(refused.contains("lanes, hessians, bench"), "{refused}");
}
