//! Tests of exported models: exported bytes are reproducible, and imported programs compute bit-identical results.

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_compiled_model::{CompiledModel, ExportedModel, Orders};
use eomgen_tests::models::{project, shipped_specifications};
use eomgen_tests::random_numbers::Numbers;

fn examples() -> impl Iterator<Item = std::path::PathBuf> {
    let folders = ["constrained", "friction", "impacts"];
    folders.into_iter().flat_map(|folder| {
        let folder = project().join("examples").join(folder);
        let entries = std::fs::read_dir(folder).expect("a folder");
        entries.map(|entry| entry.expect("an entry").path())
    })
}

/// Returns the bits of rates and observables of a program at a random point.
fn bits(program: &Program, numbers: &mut Numbers) -> Vec<u64> {
    let mut evaluator = Evaluator::new(program.clone());
    let mut draw = |count: usize| {
        (0..count)
            .map(|_| numbers.symmetric())
            .collect::<Vec<f64>>()
    };
    let (state, inputs) = (draw(program.states()), draw(program.inputs.len()));
    let point = || Point {
        t: 0.3,
        state: &state,
        inputs: &inputs,
    };
    let mut rates = vec![0.0; program.states()];
    let mut observables = vec![0.0; program.observables.len()];
    evaluator.rates(point(), &mut rates);
    evaluator.observables(point(), &mut observables);
    rates
        .iter()
        .chain(&observables)
        .map(|number| number.to_bits())
        .collect()
}

#[test]
fn exported_models_are_imported_unchanged() {
    let mut sided = 0;
    for spec in shipped_specifications().into_iter().chain(examples()) {
        let name = spec.display();
        let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
        let run = compiled.with_declared_parameters().expect("it runs");
        let exported = ExportedModel::new(&run).expect("exported");
        let bytes = exported.to_bytes();
        let read = ExportedModel::from_bytes(&bytes).expect("a model");
        assert_eq!(read.to_bytes(), bytes, "{name}");
        let found = bits(read.program(), &mut Numbers(7));
        assert_eq!(found, bits(compiled.program(), &mut Numbers(7)), "{name}");
        if let Some(program) = read.sided_program() {
            let own = exported.sided_program().expect("surfaces");
            assert_eq!(
                bits(program, &mut Numbers(9)),
                bits(own, &mut Numbers(9)),
                "{name}"
            );
            sided += 1;
        }
        for end in (0..bytes.len()).step_by(97) {
            assert!(
                ExportedModel::from_bytes(&bytes[..end]).is_none(),
                "{name}: {end}"
            );
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(ExportedModel::from_bytes(&longer).is_none(), "{name}");
    }
    assert!(sided > 3, "{sided} models with surfaces");
}

#[test]
fn exported_model_has_the_parameters_of_its_instance() {
    let spec = eomgen_tests::models::path("pendulum");
    let compiled = CompiledModel::load(&spec, Orders::Declared).expect("it loads");
    let moon = compiled.with_parameters(&[("g", 1.62)]).expect("it runs");
    let exported = ExportedModel::new(&moon).expect("exported");
    assert_eq!(exported.program().default_parameters(), moon.parameters());
}
