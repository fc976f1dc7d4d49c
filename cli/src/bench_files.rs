//! `eomgen generate --with bench`: a benchmark of the emitted functions by criterion, and the
//! `Cargo.toml` that it needs if there is none.

use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;

use crate::error::{Error, Result};
use crate::output::write_file;

/// Leaves the files in `out`, in which the source is `lib.rs`; a `Cargo.toml` that is there
/// already stays as it is. Gives the files' paths.
pub fn leave(
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
    let manifest = out.join("Cargo.toml");
    if manifest.exists() {
        return Ok(vec![bench]);
    }
    write_file(&manifest, manifest_of(&model.name).as_bytes())?;
    Ok(vec![bench, manifest])
}

fn manifest_of(name: &str) -> String {
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

# By itself, wherever this folder lies.
[workspace]
"#
    )
}

/// The benchmark: rates and observables, and whatever was requested.
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
        r#"//! How long a call of the emitted functions takes, at the initial state of the
//! specification: `cargo bench`. Left by `eomgen generate --with bench`.

use criterion::{{Criterion, criterion_group, criterion_main}};
use model::*;
use std::hint::black_box;

/// The initial state, in SI.
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
