//! Emitted source: comparison with `golden/`, reproducibility, compilation by plain `rustc`, and absence of
//! panics in the optimised code.

use std::path::Path;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;

use crate::support::{compile, emitted, emitted_with_all, models, shipped};

/// Compares with a file in `golden/`, or writes it if EOMGEN_REFRESH is set.
fn compare(name: &str, source: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/codegen/golden")
        .join(name);
    if std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, source).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let first = kept
        .lines()
        .zip(source.lines())
        .position(|(kept, now)| kept != now);
    assert!(
        kept == source,
        "{name} differs from line {}; if this is intended, run EOMGEN_REFRESH=1 cargo test -p eomgen-codegen",
        first.map_or(kept.lines().count().min(source.lines().count()), |line| {
            line
        }) + 1
    );
}

/// Returns the items of a source that define one of `names`, each with its documentation.
fn items(source: &str, names: &[&str]) -> String {
    let is_one_of = |item: &str| {
        let words = item.split(|c: char| !c.is_alphanumeric() && c != '_');
        let words: Vec<&str> = words.collect();
        let mut pairs = words.windows(2);
        pairs.any(|pair| ["fn", "static", "struct"].contains(&pair[0]) && names.contains(&pair[1]))
    };
    let ends = |line: &str| !line.starts_with([' ', '/', '#']) && line.ends_with(['}', ';']);
    let lines: Vec<&str> = source.split_inclusive('\n').collect();
    let items = lines.split_inclusive(|line| ends(line.trim_end()));
    items
        .map(|lines| lines.concat())
        .filter(|item| is_one_of(item))
        .collect()
}

#[test]
fn pendulum_matches_golden_file() {
    compare("pendulum.rs", &emitted(&shipped("pendulum"), 0));
}

// The beam with a tip mass has two interfaces, tables and an input.
#[test]
fn beam_with_tip_mass_matches_golden_file() {
    compare(
        "hub_beam_tip_mass_order_2.rs",
        &emitted(&shipped("hub_beam_tip_mass"), 2),
    );
}

// A model with an input and a contact.
#[test]
fn requested_outputs_of_an_axis_match_golden_file() {
    let source = emitted_with_all(&shipped("emps"), 0);
    let begin = source.find("/// Regime of a state").unwrap();
    let end = source.find("/// Number type").unwrap();
    compare("emps_requested_outputs.rs", &source[begin..end]);
}

// Derivatives of sums over modes.
#[test]
fn jacobians_of_a_beam_match_golden_file() {
    let source = emitted_with_all(&shipped("hub_beam_tip_mass"), 2);
    let jacobians = [
        "inlined_jacobian_vector_product",
        "inlined_vector_jacobian_product",
        "RATES_BY_STATE",
        "inlined_rates_by_state",
        "inlined_observables_by_parameters",
    ];
    compare(
        "hub_beam_tip_mass_order_2_jacobians.rs",
        &items(&source, &jacobians),
    );
}

// A basis that is not orthogonal needs the Cholesky factor.
#[test]
fn printed_basis_matches_golden_file() {
    let arm = shipped("planetary_arm")
        .source
        .text
        .replace("\"clamped_free\"", "\"clamped_free_printed\"");
    let model = crate::support::model(&arm);
    let source = emitted(&model, 2);
    compile(
        "printed",
        &source,
        &["--edition", "2015", "--emit=metadata"],
    );
    let full_matrices = [
        "prepare",
        "rates_into",
        "mass_matrix",
        "INTEGRAL_PHI_BY_PHI",
        "INTEGRAL_PHI_D2_BY_PHI_D2",
        "cholesky",
        "cholesky_solve",
        "converted_matrix",
    ];
    compare(
        "planetary_arm_printed_order_2.rs",
        &items(&source, &full_matrices),
    );
}

// The function for a regime contains no contact. The rest of the file does not depend on regimes.
#[test]
fn regimes_of_the_arm_match_golden_file() {
    let model = shipped("planetary_arm");
    let Ok(variant) = Variant::derive_with(&model, &[2], &[Output::Regimes]) else {
        panic!("the arm has regimes");
    };
    let source = emit(&variant.program, Packaging::Crate).unwrap();
    compare(
        "planetary_arm_order_2_regimes.rs",
        &items(&source, &["regime", "rates_in_regime_into"]),
    );
}

fn names() -> Vec<String> {
    let entries = std::fs::read_dir(models()).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| {
            e.unwrap()
                .path()
                .file_stem()
                .unwrap()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

// The model is derived twice from text. Hash maps have a new seed each time.
#[test]
fn emission_is_reproducible() {
    for name in names() {
        assert_eq!(
            emitted(&shipped(&name), 3),
            emitted(&shipped(&name), 3),
            "{name}"
        );
    }
}

// The reference is a formatter that prints the parsed source from its syntax tree, without empty lines.
#[test]
fn layout_matches_formatter() {
    let printed = shipped("planetary_arm")
        .source
        .text
        .replace("\"clamped_free\"", "\"clamped_free_printed\"");
    let mut models: Vec<_> = names().iter().map(|name| shipped(name)).collect();
    models.push(crate::support::model(&printed));
    for model in models {
        for order in [0, 1, 4, 128] {
            if order > 4 && *model.source.text == *printed {
                continue;
            }
            for source in [emitted(&model, order), emitted_with_all(&model, order)] {
                let tree = syn::parse_file(&source).unwrap();
                let formatted = prettyplease::unparse(&tree);
                let lines = source.lines().filter(|line| !line.is_empty());
                for (emitted, formatted) in lines.zip(formatted.lines()) {
                    assert_eq!(emitted, formatted, "{}, order {order}", model.name);
                }
            }
        }
    }
}

#[test]
fn every_shipped_model_compiles_without_a_warning() {
    for name in names() {
        let model = shipped(&name);
        let orders: &[usize] = if model.fields.is_empty() {
            &[0]
        } else {
            &[0, 1, 3]
        };
        for order in orders {
            for (what, source) in [
                ("", emitted(&model, *order)),
                ("with_all", emitted_with_all(&model, *order)),
            ] {
                compile(
                    &format!("{name}_{order}{what}"),
                    &source,
                    &["--edition", "2015", "--emit=metadata"],
                );
                for word in [
                    "panic!", "unwrap(", "expect(", "unsafe {", "std::", "alloc::",
                ] {
                    assert!(!source.contains(word), "{name}, order {order}: {word}");
                }
            }
        }
    }
}

/// Instances of the rates and of the preparation for `f64`, because generic code is compiled only where it is called.
const INSTANCE: &str = "
pub fn rates_of_numbers(state: &[f64; STATES], c: &Coefficients) -> [f64; STATES] {
    rates(0.0, state, &Inputs::default(), c)
}
pub fn prepared_numbers(parameters: &Parameters) -> Coefficients {
    Coefficients::prepare(parameters)
}
";

// The compiler removes all bounds checks: at no order does the machine code call a panic function.
#[test]
fn optimised_code_cannot_panic() {
    for (name, order) in [
        ("planetary_arm", 4),
        ("planetary_arm", 64),
        ("hub_beam_tip_mass", 3),
        ("hub_beam_tip_mass", 64),
        ("double_pendulum", 0),
    ] {
        let folder = format!("assembly_{name}_{order}");
        let options = ["-O", "--emit=asm", "-C", "symbol-mangling-version=v0"];
        let source = emitted(&shipped(name), order) + INSTANCE;
        let written = compile(&folder, &source, &options);
        let assembly = std::fs::read_to_string(written.join("emitted.s")).unwrap();
        assert!(
            assembly.contains("16rates_of_numbers"),
            "{folder}: `rates` was not compiled"
        );
        assert!(!assembly.contains("panic"), "{folder}: a panic is left");
    }
}
