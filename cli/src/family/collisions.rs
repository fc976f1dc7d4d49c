//! Collisions of C names between variants. They are possible because the prefix of one variant can begin with the
//! prefix of another.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::build::BuiltVariant;
use super::description::{Family, Variant};
use crate::arguments::Target;
use crate::error::{Error, Result};

/// Checks that no two variants declare the same C name. `built` contains the variants generated in this run; headers of
/// the others are read from `out`.
///
/// # Errors
/// A name that two variants declare.
pub fn check_declarations(family: &Family, built: &[BuiltVariant], out: &Path) -> Result {
    let in_c = family
        .variants
        .iter()
        .filter(|variant| variant.has(Target::C99));
    let prefixes: BTreeMap<String, &Variant> = in_c
        .flat_map(|variant| {
            let prefixes = variant.c_prefixes().into_iter();
            prefixes.map(move |(prefix, _)| (prefix, variant))
        })
        .collect();
    for (longer, second) in &prefixes {
        let ends = longer.match_indices('_').map(|(end, _)| &longer[..end]);
        for (shorter, first) in ends.filter_map(|start| prefixes.get_key_value(start)) {
            let names = [(shorter, first), (longer, second)].map(|(prefix, variant)| {
                let header = read_header(variant, prefix, built, out);
                find_names(&header, longer)
            });
            if let Some(name) = names[0].intersection(&names[1]).next() {
                return Err(Error::input(format!(
                    "the variants `{}` and `{}` ({}:{} and {}) both declare `{name}` in C; give one of them another prefix",
                    first.name,
                    second.name,
                    family.path.display(),
                    first.line,
                    second.line,
                )));
            }
        }
    }
    Ok(())
}

/// Returns the header of a variant; empty if there is none.
fn read_header(variant: &Variant, prefix: &str, built: &[BuiltVariant], out: &Path) -> String {
    let path = format!("{}/{prefix}.h", variant.name);
    let generated = built.iter().find(|built| built.name == variant.name);
    match generated.and_then(|built| built.files.get(&path)) {
        Some(contents) => String::from_utf8_lossy(contents).into_owned(),
        None => std::fs::read_to_string(out.join(path)).unwrap_or_default(),
    }
}

/// Returns the names in a header that begin with a prefix, ignoring case.
fn find_names(header: &str, prefix: &str) -> BTreeSet<String> {
    let code = without_comments(header);
    let prefix = prefix.to_lowercase();
    let names = code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let own = names.filter(|name| name.to_lowercase().starts_with(&prefix));
    own.map(str::to_owned).collect()
}

/// Removes comments between `/*` and `*/`. Emitted C has no other comments.
fn without_comments(text: &str) -> String {
    let mut parts = text.split("/*");
    let first = parts.next().unwrap_or_default();
    let code = parts.map(|part| part.split_once("*/").map_or("", |(_, code)| code));
    std::iter::once(first).chain(code).collect()
}
