//! `eomgen generate --with bench`: a Criterion benchmark of the emitted functions, with a `Cargo.toml`.

use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;

use crate::error::{Error, Result};
use crate::output::write_file;

/// Writes the benchmark to `out`, next to `lib.rs`, and a `Cargo.toml` unless there is one. Returns their paths.
pub fn write(
    model: &Model,
    variant: &Variant,
    outputs: &[Output],
    out: &Path,
) -> Result<Vec<PathBuf>> {
    let state = model
        .initial_state(variant.equations.graph.orders())
        .map_err(|error| Error::model(&model.source, error))?;
    let bench = out.join("benches").join("rates.rs");
    write_file(&bench, source(&state, outputs).as_bytes())?;
    let manifest_path = out.join("Cargo.toml");
    if manifest_path.exists() {
        return Ok(vec![bench]);
    }
    write_file(&manifest_path, manifest(&model.name).as_bytes())?;
    Ok(vec![bench, manifest_path])
}

fn manifest(name: &str) -> String {
    format!(
        r#"[package]
name = "{name}"
version = "0.1.0"
edition = "2024"
publish = false

[lib]
name = "model"
path = "lib.rs"
bench = false

[dev-dependencies]
criterion = {{ version = "0.8", default-features = false }}

[[bench]]
name = "rates"
harness = false

# A workspace of its own, also inside another one.
[workspace]
"#
    )
}

/// Returns the source of a benchmark of rates, observables and the requested functions.
fn source(state: &[f64], outputs: &[Output]) -> String {
    let state: Vec<String> = state.iter().map(|number| format!("{number:?}")).collect();
    let has = |request| outputs.contains(&request);
    let mut functions = vec![("rates", ""), ("observables", "")];
    let mut add = |request, calls: &[(&'static str, &'static str)]| {
        if has(request) {
            functions.extend_from_slice(calls);
        }
    };
    add(Output::BiasForces, &[("bias_forces", "")]);
    add(
        Output::InverseDynamics,
        &[("inverse_dynamics", ", &[1.0; DEGREES_OF_FREEDOM]")],
    );
    add(Output::GuardRates, &[("guard_rates", "")]);
    add(
        Output::Jacobians,
        &[("rates_by_state", ""), ("rates_by_parameters", "")],
    );
    add(
        Output::Products,
        &[
            (
                "jacobian_vector_product",
                ", &[1.0; STATES], &Inputs::default()",
            ),
            ("vector_jacobian_product", ", &[1.0; STATES]"),
        ],
    );
    add(Output::Linearisation, &[("linearise", "")]);
    let calls: Vec<String> = functions.iter().map(call).collect();
    let head = format!(
        r#"//! Time per call of the emitted functions at the initial state of the specification: `cargo bench`.
//! Written by `eomgen generate --with bench`.

use criterion::{{Criterion, criterion_group, criterion_main}};
use model::*;
use std::hint::black_box;

/// Initial state, in SI.
const INITIAL: [f64; STATES] = [{}];

fn calls(criterion: &mut Criterion) {{
    let coefficients = Coefficients::prepare(&Parameters::default());
    let c = &coefficients;
    let (state, inputs) = (INITIAL, Inputs::default());
"#,
        state.join(", ")
    );
    head + &calls.concat() + "}\n\ncriterion_group!(benches, calls);\ncriterion_main!(benches);\n"
}

fn call((name, more): &(&str, &str)) -> String {
    format!(
        "    criterion.bench_function(\"{name}\", |bencher| {{\n        \
         bencher.iter(|| {name}(black_box(0.0), black_box(&state), black_box(&inputs), c{more}))\n    }});\n"
    )
}
