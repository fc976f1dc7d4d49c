//! Reads a file or a text and returns a checked model, or all errors.

use std::path::Path;

use crate::checks::{check_drawing, check_sensors, check_tables, warn_unused};
use crate::control::check_units;
use crate::diagnostic::{DeclarationKind, Diagnostic, Diagnostics};
use crate::document;
use crate::extension;
use crate::model::Model;
use crate::motion;
use crate::resolve::resolve;
use crate::source::Source;
use crate::space;
use crate::specification_file::{MAX_SIZE, read_text, too_large};
use crate::units_check;
use crate::variant::ModelError;

/// Model that passed all checks.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The model.
    pub model: Model,
    /// Warnings about possible mistakes, for example unused names.
    pub warnings: Diagnostics,
}

/// Reads and checks the specification in a file.
///
/// A file that cannot be read, is larger than [`MAX_SIZE`] or is not UTF-8, and all errors of
/// [`check`].
pub fn load(path: &Path) -> Result<Checked, Diagnostics> {
    load_from(Path::new(""), path)
}

/// Reads and checks the specification in a file below `root`. Messages contain only `path`.
///
/// # Errors
/// As for [`load`].
pub fn load_from(root: &Path, path: &Path) -> Result<Checked, Diagnostics> {
    let shown = path.display().to_string();
    let file = root.join(path);
    let text = read_text(&file, &shown)?;
    let folder = file.parent().unwrap_or(Path::new(""));
    check(Source::new(shown, text).in_folder(folder))
}

/// Checks a specification, merged with all files that it extends.
///
/// # Errors
/// All errors of one stage. The stages are: grammar and keys; names and expressions; quantities allowed in each
/// section, inertia and units; values. If a stage has errors, later stages are not run.
pub fn check(source: Source) -> Result<Checked, Diagnostics> {
    let source = extension::merge(source)?;
    if source.text.len() as u64 > MAX_SIZE {
        let size = source.text.len() as u64;
        return Err(Diagnostics::from_one(source, too_large(size)));
    }
    let mut document = document::read(&source)?;
    let mut requirements = space::expand(&mut document, &source)?;
    let unused = std::mem::take(&mut requirements.unused);
    let mut resolved = resolve(document, requirements, &source)?;
    let mut found = Diagnostics::new(source.clone());
    motion::check(&mut resolved.model, &mut found);
    units_check::check(&mut resolved, &mut found);
    let (model, inertias) = (resolved.model, resolved.inertias);
    if found.is_empty() {
        check_units(&model, &mut found);
    }
    check_sensors(&model, &mut found);
    check_drawing(&model, &mut found);
    if found.is_empty() {
        found.push_error(model.check_numbers().map_err(ModelError::diagnostic));
        found.push_error(model.distributions().map_err(ModelError::diagnostic));
    }
    if found.is_empty() {
        check_tables(&model, &mut found);
    }
    if found.is_empty() && !inertias.is_empty() {
        let values = model.parameter_values().map_err(ModelError::diagnostic);
        if let Some(values) = found.push_error(values) {
            space::check_inertias(&inertias, &values, &mut found);
        }
    }
    if !found.is_empty() {
        return Err(found);
    }
    let mut warnings = Diagnostics::new(source);
    warn_unused(&model, &mut warnings);
    for vector in unused {
        let name = &vector.text;
        warnings.push(Diagnostic::unused(
            DeclarationKind::Definition,
            name,
            vector.span,
        ));
    }
    Ok(Checked { model, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::MAX_LISTED;
    use crate::suggest::tests::COMPARED;

    const HEAD: &str = "[model]\nname = \"a\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n[coordinates]\n\
                        x = { unit = \"m\" }\n[kinetic]\nk = \"1/2*m*dot(x)^2\"\n";

    /// Fills a section up to the size limit of a specification.
    fn filled(section: &str, most: usize, line: &dyn Fn(usize) -> String) -> String {
        let mut text = HEAD.to_owned() + section;
        for line in (0..most).map(line) {
            if (text.len() + line.len()) as u64 > MAX_SIZE {
                break;
            }
            text.push_str(&line);
        }
        text
    }

    /// Largest number of names that are compared for one message.
    const NAMES: usize = 2000;

    #[test]
    fn number_of_compared_names_is_bounded() {
        let any = usize::MAX;
        for (section, most, line) in [
            (
                "",
                any,
                &(|k| format!("[s{k}]\n")) as &dyn Fn(usize) -> String,
            ),
            ("", any, &|k| format!("k{k} = 1\n")),
            ("[observables]\n", 1900, &|k| {
                format!("o{k} = {{ value = \"y{k}\", unit = \"m\" }}\n")
            }),
            ("[definitions]\n", 1900, &|k| format!("d{k} = \"e{k}\"\n")),
            ("[forces]\n", 1900, &|k| {
                format!("f{k} = {{ of = \"x\", value = \"m\" }}\n")
            }),
        ] {
            let text = filled(section, most, line);
            COMPARED.set(0);
            let found = check(Source::new("full.toml", text)).expect_err(section);
            let (listed, compared) = (found.list().len(), COMPARED.get());
            assert!(listed <= MAX_LISTED, "{section}: {listed}");
            assert!(compared <= MAX_LISTED * NAMES, "{section}: {compared}");
            assert!(found.render(false).len() < 100_000, "{section}");
        }
    }
}
