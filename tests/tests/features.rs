//! Specifications that use what the shipped ones do not, each with one feature of the
//! language: certified like the shipped ones, against an oracle that shares no code with
//! the derivation. One file in `features/` is one test; its orders stand here.

use std::path::{Path, PathBuf};

use codegen::equations::derive;
use codegen::lower::lower;
use codegen::rust::{Packaging, emit};
use model_spec::model::Model;
use sim::certificates::certificate;

/// Declares a test per file, and that no file is forgotten.
macro_rules! features {
    ($($name:ident: $orders:expr;)*) => {
        $(
            #[test]
            fn $name() {
                certify(stringify!($name), &$orders);
            }
        )*

        #[test]
        fn every_file_is_tested() {
            let tested = [$(stringify!($name)),*];
            for path in std::fs::read_dir(folder()).unwrap() {
                let name = path.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
                assert!(tested.contains(&name.as_str()), "features/{name}.toml is in no test");
            }
        }
    };
}

features! {
    polynomial_taper: [0, 1, 4];
    exponential_taper: [0, 1, 4];
    offset_domain: [0, 1, 4];
    points_along_the_beam: [0, 1, 4];
    sums_over_modes: [0, 1, 4];
    printed_basis: [0, 1, 4];
    two_fields: [0, 1, 3];
    cubic_stiffness: [0, 1, 3];
    gravity_arm: [0, 1, 4];
    centrifugal_stiffening: [0, 1, 4];
    rheonomic: [0, 1, 4];
    structural_damping: [0, 1, 3];
    lever_mass: [1, 2, 4];
    lever_mass_turning: [1, 2, 4];
    lever_mass_expanded: [1, 2, 4];
    mass_by_sum: [1, 4];
    sum_with_coordinate: [1, 4];
    massless_beam: [1];
    massless_beam_by_sum: [1];
    folding_arm: [0, 1, 2, 4];
    functions: [0];
    shorter_functions: [0];
    nonquadratic_kinetic: [0];
    gyroscopic: [0];
    pendulum_chain: [0];
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/features")
}

/// Certifies a file at every order and reports all checks that fail.
fn certify(name: &str, orders: &[usize]) {
    let checked = model_spec::load(&folder().join(format!("{name}.toml")))
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    let mut failures = Vec::new();
    for &order in orders {
        let source = emitted(&checked.model, order);
        let certificate = certificate(&checked.model, order, source).unwrap();
        failures.extend(certificate.failures().map(|check| {
            format!("order {order}, {}: {:?} ({})", check.name, check.value, check.detail)
        }));
    }
    assert!(failures.is_empty(), "{name}:\n{}", failures.join("\n"));
}

fn emitted(model: &Model, order: usize) -> String {
    let orders = vec![order; model.fields.len()];
    let equations = derive(model, &orders).unwrap_or_else(|error| panic!("{error}"));
    let program = lower(model, &equations, &model.parameter_values().unwrap());
    emit(&program, Packaging::Crate).unwrap()
}
