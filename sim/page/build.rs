//! Compiles the engine of interactive pages to WebAssembly, if the compiler has this target. If the environment
//! variable `EOMGEN_ENGINE` is set, it is the path of a compiled engine to use instead.

use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";

/// Sources of the engine and of the crates that it depends on, relative to the workspace. A change in them
/// reruns this script.
const SOURCES: [&str; 14] = [
    "Cargo.lock",
    "Cargo.toml",
    "codegen/Cargo.toml",
    "codegen/elementary/Cargo.toml",
    "codegen/elementary/src",
    "codegen/src",
    "model-spec/Cargo.toml",
    "model-spec/src",
    "sim/Cargo.toml",
    "sim/analysis/Cargo.toml",
    "sim/analysis/src",
    "sim/compiled_model",
    "sim/engine",
    "sim/src",
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=EOMGEN_ENGINE");
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    let compiled = match std::env::var_os("EOMGEN_ENGINE") {
        Some(given) => Ok(PathBuf::from(given)),
        None => compile(&out),
    };
    let engine = compiled.and_then(|file| {
        println!("cargo::rerun-if-changed={}", file.display());
        std::fs::read(&file).map_err(|error| format!("cannot read {}: {error}", file.display()))
    });
    let engine = engine.unwrap_or_else(|reason| {
        println!("cargo::warning=interactive pages are not available: {reason}");
        Vec::new()
    });
    if let Err(error) = std::fs::write(out.join("engine.wasm"), engine) {
        println!("cargo::error=cannot write the engine: {error}");
    }
}

/// Compiles the engine in its own target folder and returns the file.
fn compile(out: &Path) -> Result<PathBuf, String> {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let root = root.join("../..");
    if !root.join("sim/engine/Cargo.toml").is_file() {
        return Err("the source of the engine, sim/engine, is missing".to_owned());
    }
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
    }
    if !has_target() {
        return Err(format!(
            "the compiler target {TARGET} is not installed; run `rustup target add {TARGET}` and compile again"
        ));
    }
    // OUT_DIR is PROFILE/build/PACKAGE/out.
    let profile = out.ancestors().nth(3).unwrap_or(out);
    let folder = profile.join("engine");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo
        .current_dir(root)
        .args(["build", "--quiet", "--locked", "--profile", "page"])
        .args(["--package", "eomgen-engine", "--target", TARGET])
        .arg("--target-dir")
        .arg(&folder);
    // Removes the settings of the build that runs this script.
    for (name, _) in std::env::vars_os() {
        let is_setting = name.to_str().is_some_and(|name| {
            name.starts_with("CARGO_PROFILE_")
                || [
                    "RUSTFLAGS",
                    "CARGO_ENCODED_RUSTFLAGS",
                    "CARGO_INCREMENTAL",
                    "CARGO_BUILD_TARGET",
                    "RUSTC_WORKSPACE_WRAPPER",
                ]
                .contains(&name)
        });
        if is_setting {
            cargo.env_remove(name);
        }
    }
    let ended = cargo
        .output()
        .map_err(|error| format!("cannot run cargo: {error}"))?;
    if !ended.status.success() {
        let said = String::from_utf8_lossy(&ended.stderr);
        let first = said.lines().find(|line| line.starts_with("error"));
        let first = first.or_else(|| said.lines().next()).unwrap_or_default();
        return Err(format!("the engine does not compile: {first}"));
    }
    Ok(folder.join(TARGET).join("page/eomgen_engine.wasm"))
}

/// Returns true if the compiler has the standard library for the target.
fn has_target() -> bool {
    let compiler = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let printed = Command::new(compiler)
        .args(["--print", "target-libdir", "--target", TARGET])
        .output();
    printed.is_ok_and(|printed| Path::new(String::from_utf8_lossy(&printed.stdout).trim()).is_dir())
}
