//! Engine and model in the data of a page.

use std::fmt;
use std::io::Write;

use eomgen_codegen::program::Program;
use eomgen_codegen::wasm::{self, EmitError};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

use super::encode_base64;

/// The engine, which the build script compiled; empty without the target `wasm32-unknown-unknown`.
const ENGINE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/engine.wasm"));

/// Relative tolerance of a page's motion.
pub const TOLERANCE: f64 = 1e-8;

/// Reason why a page cannot simulate a model.
#[derive(Clone, Debug)]
pub enum Unplayable {
    /// This program was compiled without the engine.
    NoEngine,
    /// A program of the model cannot be emitted as WebAssembly.
    Emission(EmitError),
}

impl fmt::Display for Unplayable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEngine => f.write_str(
                "this program was compiled without the engine of pages, because the compiler had no target \
                 wasm32-unknown-unknown: run `rustup target add wasm32-unknown-unknown` and compile it again",
            ),
            Self::Emission(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Unplayable {}

/// Returns the arguments of `Motion.load` in the script: the engine, an exported model in bytes, its `program`,
/// and its program with sides if it has one.
///
/// # Errors
/// A program without the engine, or one that cannot be emitted.
pub fn embed_motion(
    model: &[u8],
    program: &Program,
    sided: Option<&Program>,
) -> Result<Value, Unplayable> {
    if ENGINE.is_empty() {
        return Err(Unplayable::NoEngine);
    }
    let modules = std::iter::once(program).chain(sided).map(|program| {
        let module = wasm::emit(program).map_err(Unplayable::Emission)?;
        Ok(json!({ "module": compress(&module.bytes), "size": module.size }))
    });
    let modules = modules.collect::<Result<Vec<Value>, Unplayable>>()?;
    Ok(json!({
        "engine": compress(ENGINE),
        "model": compress(model),
        "modules": modules,
        "tolerance": TOLERANCE,
        "counts": {
            "parameters": program.parameters.len(),
            "inputs": program.inputs.len(),
            "states": program.states(),
            "observables": program.observables.len(),
        },
    }))
}

/// Compresses bytes with gzip and encodes them in base 64.
fn compress(bytes: &[u8]) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    // Writing to memory does not fail.
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    encode_base64(&written.unwrap_or_default())
}
