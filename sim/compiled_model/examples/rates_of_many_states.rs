//! Measures the time of the machine code for the rates of many states, for comparison with one call from Python in
//! `python/benches/many_states.py`.
//!
//! Arguments: a specification, a file of states (f64 in native byte order, one row per state), and the number of
//! passes. Writes the rates to standard output in the same format. Writes the shortest time of a pass, in ns per state,
//! to standard error.

use std::io::Write;
use std::time::Instant;

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{CompiledModel, Orders};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, specification, file, passes] = arguments.as_slice() else {
        return Err("expected SPEC STATES PASSES".into());
    };
    let model = CompiledModel::load(specification, Orders::Declared)?;
    let mut evaluator = model.with_declared_parameters()?.evaluator()?;
    let bytes = std::fs::read(file)?;
    let numbers = bytes.chunks_exact(8).filter_map(|n| n.try_into().ok());
    let states: Vec<f64> = numbers.map(f64::from_ne_bytes).collect();
    let width = evaluator.program().states();
    let inputs = vec![0.0; evaluator.program().inputs.len()];
    let mut rates = vec![0.0; states.len()];
    let mut least = f64::INFINITY;
    for _ in 0..passes.parse::<usize>()? {
        let begin = Instant::now();
        let rows = states
            .chunks_exact(width)
            .zip(rates.chunks_exact_mut(width));
        for (state, out) in rows {
            let (t, inputs) = (0.0, &inputs);
            evaluator.rates(Point { t, state, inputs }, out);
        }
        least = least.min(begin.elapsed().as_secs_f64());
    }
    let count = (states.len() / width).max(1);
    eprintln!("{:.3}", 1e9 * least / count as f64);
    let bytes: Vec<u8> = rates.iter().flat_map(|n| n.to_ne_bytes()).collect();
    Ok(std::io::stdout().write_all(&bytes)?)
}
