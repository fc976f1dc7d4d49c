//! Derives equations of motion in a build script: the emitted source is a file that you can
//! read, and no procedural macro is needed.
//!
//! ```toml
//! [build-dependencies]
//! eomgen-build = { path = "../eomgen/eomgen-build" }
//! ```
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), eomgen_build::Error> {
//!     eomgen_build::generate("models/planetary_arm.toml", &[4, 8])?;
//!     Ok(())
//! }
//! ```
//!
//! ```ignore
//! // src/lib.rs
//! pub mod arm {
//!     include!(concat!(env!("OUT_DIR"), "/planetary_arm_order_4.rs"));
//! }
//! use arm::{Coefficients, Inputs, Parameters, rates};
//! ```
//!
//! The emitted items are those of `eomgen generate` and of the macro `eomgen::model!`. They
//! depend on no crate.

use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::{Diagnostics, Record};

/// Error of the generation. `Debug` prints the message, so that `fn main() -> Result<(),
/// eomgen_build::Error>` shows it with its line breaks.
pub struct Error(String);

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}

/// Emits a specification at each of `orders` into the folder `OUT_DIR`, and tells cargo to run
/// the build script again when the specification changes. Relative paths start at the root of
/// the crate. Returns the paths of the files, in the order of `orders`:
///
/// | `orders` | file, for a model named `arm` |
/// | --- | --- |
/// | `&[4, 8]` | `arm_order_4.rs` and `arm_order_8.rs`, every field with 4 and with 8 modes |
/// | `&[0]` | `arm_rigid.rs`, no modes |
/// | `&[]` | `arm.rs`, at the orders of the specification; also for models without a field |
///
/// Warnings, for example about an unused parameter, become warnings of cargo.
///
/// # Errors
/// The specification has errors (all are reported, with file, line and column), the model does not have an order, a
/// file cannot be written, or the call is outside a build script.
pub fn generate(specification: impl AsRef<Path>, orders: &[usize]) -> Result<Vec<PathBuf>, Error> {
    generate_with(specification, orders, &[])
}

/// Emits a specification like [`generate`], with additional functions: `bias_forces`, `inverse_dynamics`,
/// `guard_rates`, `jacobians`, `products`, `linearisation`, `regimes`, `lanes`.
///
/// # Errors
/// As for [`generate`], or a name in `with` is unknown.
pub fn generate_with(
    specification: impl AsRef<Path>,
    orders: &[usize],
    with: &[&str],
) -> Result<Vec<PathBuf>, Error> {
    let outputs = with
        .iter()
        .map(|name| name.parse())
        .collect::<Result<Vec<Output>, _>>()
        .map_err(|error| Error(error.to_string()))?;
    let folder = std::env::var_os("OUT_DIR").map(PathBuf::from);
    let Some(folder) = folder else {
        let message = "OUT_DIR is not set: call eomgen_build::generate from a build script";
        return Err(Error(message.to_owned()));
    };
    let root = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(PathBuf::new, PathBuf::from);
    let path = specification.as_ref();
    println!("cargo::rerun-if-changed={}", root.join(path).display());
    let checked =
        eomgen_model_spec::load_from(&root, path).map_err(|found| specification_error(&found))?;
    for file in checked.model.files().iter().skip(1) {
        println!("cargo::rerun-if-changed={}", root.join(file).display());
    }
    for warning in checked.warnings.records() {
        println!("cargo::warning={}", format_on_one_line(&warning));
    }
    generate_variants(&checked, orders, &outputs, &folder)
}

fn generate_variants(
    checked: &Checked,
    orders: &[usize],
    outputs: &[Output],
    folder: &Path,
) -> Result<Vec<PathBuf>, Error> {
    let name = &checked.model.name;
    if orders.is_empty() {
        return Ok(vec![generate_variant(
            checked,
            None,
            outputs,
            &folder.join(format!("{name}.rs")),
        )?]);
    }
    let of = |order: &usize| {
        let file = match order {
            0 => format!("{name}_rigid.rs"),
            order => format!("{name}_order_{order}.rs"),
        };
        generate_variant(checked, Some(*order), outputs, &folder.join(file))
    };
    orders.iter().map(of).collect()
}

fn generate_variant(
    checked: &Checked,
    order: Option<usize>,
    outputs: &[Output],
    path: &Path,
) -> Result<PathBuf, Error> {
    let model = &checked.model;
    let orders = model.orders(order).map_err(|error| {
        let found = Diagnostics::from_one(model.source.clone(), error.diagnostic());
        specification_error(&found)
    })?;
    let variant = Variant::derive_with_trace(model, &orders, outputs)
        .map_err(|found| specification_error(&found))?;
    let text =
        emit(&variant.program, Packaging::Items).map_err(|error| Error(error.to_string()))?;
    write(path, &text)
        .map_err(|error| Error(format!("cannot write {}: {error}", path.display())))?;
    Ok(path.to_owned())
}

/// Writes to a temporary file and renames it, so that no partial file remains.
fn write(path: &Path, text: &str) -> std::io::Result<()> {
    let beside = path.with_extension("rs.new");
    std::fs::write(&beside, text)?;
    std::fs::rename(&beside, path)
}

fn specification_error(found: &Diagnostics) -> Error {
    Error(format!(
        "the specification has errors\n\n{}",
        found.render(false)
    ))
}

/// Formats a warning on one line, because cargo prints one line per warning.
fn format_on_one_line(finding: &Record) -> String {
    let place = match (finding.line, finding.column) {
        (Some(line), Some(column)) => format!("{}:{line}:{column}", finding.file),
        _ => finding.file.clone(),
    };
    let help = finding.help.iter().map(|help| format!("; {help}"));
    let text = format!("{place}: {}{}", finding.message, help.collect::<String>());
    text.replace(['\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use eomgen_model_spec::source::Source;

    use super::*;

    const PENDULUM: &str = "[model]\nname = \"p\"\n[parameters]\nJ = { value = 1, unit = \"kg m^2\" }\n\
                            [coordinates]\na = { unit = \"rad\" }\n[kinetic]\nrotor = \"1/2*J*dot(a)^2\"\n";

    fn checked(text: &str) -> Checked {
        eomgen_model_spec::check(Source::new("p.toml", text)).expect("sound")
    }

    fn arm() -> Checked {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
        eomgen_model_spec::load(&path).expect("sound")
    }

    fn names(paths: &[PathBuf]) -> Vec<String> {
        let name = |path: &PathBuf| {
            path.file_name()
                .expect("a file")
                .to_string_lossy()
                .into_owned()
        };
        paths.iter().map(name).collect()
    }

    #[test]
    fn each_order_gives_one_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths = generate_variants(&arm(), &[0, 2], &[], folder.path()).expect("generated");
        assert_eq!(
            names(&paths),
            ["planetary_arm_rigid.rs", "planetary_arm_order_2.rs"]
        );
        let text = std::fs::read_to_string(&paths[1]).expect("readable");
        assert!(text.contains("ORDERS: [usize; 1] = [2]"), "{text}");
        let left = std::fs::read_dir(folder.path()).expect("readable").count();
        assert_eq!(left, 2);
    }

    #[test]
    fn empty_orders_use_those_of_the_specification() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths =
            generate_variants(&checked(PENDULUM), &[], &[], folder.path()).expect("generated");
        assert_eq!(names(&paths), ["p.rs"]);
        let paths = generate_variants(&arm(), &[], &[], folder.path()).expect("generated");
        let text = std::fs::read_to_string(&paths[0]).expect("readable");
        assert!(text.contains("ORDERS: [usize; 1] = [4]"), "{text}");
    }

    #[test]
    fn requested_functions_are_emitted() {
        let folder = tempfile::tempdir().expect("a folder");
        let outputs = [Output::Products, Output::GuardRates];
        let paths = generate_variants(&arm(), &[2], &outputs, folder.path()).expect("generated");
        let text = std::fs::read_to_string(&paths[0]).expect("readable");
        for function in [
            "rates",
            "jacobian_vector_product",
            "vector_jacobian_product",
            "guard_rates",
        ] {
            assert!(text.contains(&format!("pub fn {function}<")), "{function}");
        }
        assert!(!text.contains("pub fn inverse_dynamics"), "not requested");
    }

    #[test]
    fn unknown_function_name_is_rejected() {
        let refused = generate_with("p.toml", &[], &["jacobian"]).expect_err("refused");
        let message = refused.to_string();
        assert!(
            message.starts_with("unknown output `jacobian`; use one of "),
            "{message}"
        );
        assert!(message.contains("jacobians"), "{message}");
    }

    #[test]
    fn impossible_orders_and_folders_are_reported() {
        let folder = tempfile::tempdir().expect("a folder");
        let no_field =
            generate_variants(&checked(PENDULUM), &[3], &[], folder.path()).expect_err("refused");
        assert!(
            format!("{no_field:?}").contains("no field, so no order 3"),
            "{no_field}"
        );
        let nowhere = folder.path().join("missing");
        let unwritten =
            generate_variants(&checked(PENDULUM), &[], &[], &nowhere).expect_err("refused");
        assert!(
            unwritten.to_string().starts_with("cannot write"),
            "{unwritten}"
        );
    }

    #[test]
    fn warnings_are_printed_on_one_line() {
        let text = format!("{PENDULUM}[inputs]\nu = {{ unit = \"N\" }}\n");
        let warnings = checked(&text).warnings.records();
        let shown = format_on_one_line(&warnings[0]);
        assert!(
            shown.starts_with("p.toml:10:1: the specification does not use the input `u`; "),
            "{shown}"
        );
        assert!(!shown.contains('\n'));
    }
}
