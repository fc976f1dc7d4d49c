//! Test that quantities may have names that appear in the emitted source: each such name compiles or is rejected as
//! reserved.

use std::collections::BTreeSet;
use std::process::Command;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::{self, Packaging};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::source::Source;

/// Outputs of emitted Rust; lanes repeat every function.
const OUTPUTS: [Output; 7] = [
    Output::BiasForces,
    Output::InverseDynamics,
    Output::GuardRates,
    Output::Jacobians,
    Output::Products,
    Output::Linearisation,
    Output::Regimes,
];

/// Returns a rotor with one definition for each name. Definitions are variables in the emitted functions.
fn rotor(names: &[&str]) -> String {
    let list = |line: &dyn Fn(usize, &str) -> String| -> String {
        let lines = names.iter().enumerate();
        lines.map(|(place, name)| line(place, name)).collect()
    };
    "[model]\nname = \"rotor_0\"\n[parameters]\nJ_0 = { value = 1, unit = \"kg m^2\" }\n\
     k_0 = { value = 100, unit = \"N m\" }\nb_0 = { value = 0.1, unit = \"rad\" }\n\
     [coordinates]\nphi_0 = { unit = \"rad\" }\n[inputs]\nu_0 = { unit = \"N m\" }\n[definitions]\n"
        .to_owned()
        + &list(&|place, name| format!("{name} = \"sin({}*phi_0)\"\n", place + 1))
        + "[kinetic]\nrotor = \"1/2*J_0*dot(phi_0)^2\"\n[potential]\nstop = \"1/2*k_0*deadzone(phi_0, b_0)^2\"\n[forces]\n"
        + &list(&|place, name| {
            format!("f_{place} = {{ on = \"phi_0\", value = \"(u_0 - k_0*{name})*{name}\" }}\n")
        })
        + "[observables]\n"
        + &list(&|place, name| format!("o_{place} = \"{name}*abs({name})\"\n"))
}

fn emit(names: &[&str]) -> Option<String> {
    let source = Source::new("rotor.toml", rotor(names).as_str());
    let model = eomgen_model_spec::check(source).ok()?.model;
    let variant = Variant::derive_with(&model, &[], &OUTPUTS).ok()?;
    rust::emit(&variant.program, Packaging::Crate).ok()
}

/// Returns the words of a source outside of comments.
fn words(source: &str) -> BTreeSet<&str> {
    let lines = source.lines().filter_map(|line| line.split("//").next());
    let words = lines.flat_map(|line| line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'));
    let is_name = |word: &&str| word.starts_with(|c: char| c.is_ascii_alphabetic());
    words.filter(is_name).collect()
}

#[test]
fn definitions_with_names_of_the_emitted_rust_compile() {
    let source = emit(&["z_0"]).expect("emitted");
    let own = ["rotor_0", "J_0", "k_0", "b_0", "phi_0", "u_0", "z_0"];
    let found = words(&source)
        .into_iter()
        .filter(|word| !own.contains(word));
    // Keywords and functions of the specification language are rejected, so they are excluded.
    let names: Vec<&str> = found.filter(|name| emit(&[*name]).is_some()).collect();
    for expected in ["REGIME", "T", "STATES", "Scalar", "positive", "rates"] {
        assert!(names.contains(&expected), "{expected}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("lib.rs");
    std::fs::write(&source, emit(&names).expect("emitted")).expect("written");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let arguments = [
        "--edition=2024",
        "--crate-type=lib",
        "--emit=metadata",
        "--cap-lints=allow",
    ];
    let mut command = Command::new(rustc);
    let command = command.current_dir(folder.path()).args(arguments);
    let output = command.arg(&source).output().expect("rustc");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}
