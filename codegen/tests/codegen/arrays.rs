//! Parameters and inputs of emitted files: their numbers, their names, and the conversion of arrays of any
//! number type.

use std::process::Command;

use eomgen_codegen::rust::{Packaging, emit};

use crate::support::{compile, emitted, folder, model, program, shipped};

/// Returns assertions that `From` assigns number k of an array to the field with name k.
fn write_assertions(kind: &str, count: &str, names: &[&str]) -> String {
    let numbers: Vec<String> = (1..=names.len()).map(|k| format!("{k}")).collect();
    let mut text = format!(
        "    assert_eq!(emitted::{count}, {});\n\
         \x20   let numbers: [u8; emitted::{count}] = [{}];\n\
         \x20   let of = emitted::{kind}::from(numbers);\n",
        names.len(),
        numbers.join(", ")
    );
    for (name, number) in names.iter().zip(&numbers) {
        text += &format!("    assert_eq!(of.{name}, {number});\n");
    }
    text + "    let _ = of;\n"
}

/// Returns a program that fails unless arrays are assigned to the fields by their names.
fn write_checks(parameters: &[&str], inputs: &[&str]) -> String {
    format!(
        "#[allow(dead_code)]\nmod emitted;\n\nfn main() {{\n\
         \x20   let names: [&str; {}] = {parameters:?};\n\
         \x20   assert_eq!(emitted::PARAMETER_NAMES, names);\n\
         \x20   let names: [&str; {}] = {inputs:?};\n\
         \x20   assert_eq!(emitted::INPUT_NAMES, names);\n{}{}}}\n",
        parameters.len(),
        inputs.len(),
        write_assertions("Parameters", "PARAMETERS", parameters),
        write_assertions("Inputs", "INPUTS", inputs),
    )
}

/// Compiles the checks with the emitted module and runs them.
fn compile_and_run(name: &str, module: &str, checks: &str) {
    let folder = folder(name);
    std::fs::write(folder.join("emitted.rs"), module).unwrap();
    std::fs::write(folder.join("main.rs"), checks).unwrap();
    let program = folder.join("checks");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    for command in [
        Command::new(rustc)
            .args(["--edition", "2021", "-o"])
            .arg(&program)
            .arg(folder.join("main.rs")),
        &mut Command::new(&program),
    ] {
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {said}");
    }
}

#[test]
fn arrays_are_assigned_to_fields_by_name() {
    for name in ["hub_beam_tip_mass", "pendulum", "planetary_arm_rig"] {
        let program = program(&shipped(name), 1);
        let module = emit(&program, Packaging::Module).unwrap();
        let parameters: Vec<&str> = program
            .parameters
            .iter()
            .map(|parameter| parameter.quantity.name.as_str())
            .collect();
        let inputs: Vec<&str> = program.inputs.iter().map(|i| i.name.as_str()).collect();
        compile_and_run(
            &format!("arrays_{name}"),
            &module,
            &write_checks(&parameters, &inputs),
        );
    }
}

// If there are no names, the counts are 0, the arrays are empty, and the file compiles.
#[test]
fn model_without_parameters_and_inputs_has_empty_arrays() {
    let text = "[model]\nname = \"free\"\ntitle = \"Free\"\n\
                [coordinates]\nx = { unit = \"m kg^(1/2)\" }\n\
                [kinetic]\nfree = \"1/2*dot(x)^2\"\n";
    let model = model(text);
    assert!(emitted(&model, 0).contains("pub const PARAMETERS: usize = 0;"));
    let module = emit(&program(&model, 0), Packaging::Module).unwrap();
    compile_and_run("arrays_of_nothing", &module, &write_checks(&[], &[]));
}

// The field has no modes and there is no coordinate: the state is empty.
#[test]
fn model_without_state_compiles() {
    let text = "[model]\nname = \"still\"\ntitle = \"Still\"\n\
                [parameters]\nrho = { value = 2, unit = \"kg/m\" }\nl = { value = 1, unit = \"m\" }\n\
                [fields.w]\nalong = \"x\"\nfrom = \"0\"\nto = \"l\"\nbasis = \"clamped_free\"\n\
                coordinates = \"q\"\norder = 2\nunit = \"m\"\n\
                [kinetic]\nbeam = \"1/2*integral(rho*dot(w)^2, w)\"\n";
    let source = emitted(&model(text), 0);
    assert!(source.contains("pub const STATES: usize = 0;"));
    for edition in ["2015", "2024"] {
        compile(
            "no_state",
            &source,
            &["--edition", edition, "--emit=metadata"],
        );
    }
}

// No coefficient depends on the parameters, but the mass matrix has a pivot.
#[test]
fn model_with_unused_parameters_compiles() {
    let text = "[model]\nname = \"idle\"\ntitle = \"Idle\"\n\
                [parameters]\nk = { value = 3, unit = \"N/m\" }\n\
                [coordinates]\nx = { unit = \"m kg^(1/2)\" }\n\
                [kinetic]\nfree = \"1/2*dot(x)^2\"\n";
    let module = emit(&program(&model(text), 0), Packaging::Module).unwrap();
    let prepared = "    let coefficients = emitted::Coefficients::prepare(&emitted::Parameters::default());\n\
                    \x20   assert!(coefficients.positive_definite);\n}\n";
    let checks = write_checks(&["k"], &[]);
    let checks = format!("{}{prepared}", checks.trim_end_matches("}\n"));
    compile_and_run("arrays_of_idle", &module, &checks);
}
