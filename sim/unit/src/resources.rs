//! Specification in the resources of a unit.

use std::path::{Path, PathBuf};

use eomgen_codegen::program::Program;
use eomgen_compiled_model::{CompiledModel, Orders};

use crate::rejection::{Outcome, Rejection, invalid};

/// Returns the token that links the description of an FMU to its specification: hash of the specification, orders of
/// the fields and version of the program.
pub fn token(program: &Program) -> String {
    let orders = program.fields.iter().map(|field| field.order.to_string());
    let orders: Vec<String> = orders.collect();
    let version = env!("CARGO_PKG_VERSION");
    format!("{}-{}-{version}", program.spec_hash, orders.join(","))
}

/// Reads and derives the specification in an FMU's resources. `location` is a path or a URI with the scheme `file`.
///
/// # Errors No resources or no specification at the location, an invalid specification, or one that does not
/// match the token.
pub fn derive_specification(
    location: Option<&[u8]>,
    given: Option<&str>,
) -> Outcome<CompiledModel> {
    let orders = given.and_then(parse_orders).ok_or_else(reject_token)?;
    let location = location.ok_or_else(|| {
        invalid("the importer passed no resource location, but the resources contain the specification of the FMU")
    })?;
    let folder = parse_location(location)?;
    let file = find_specification(&folder)?;
    let shown = file.display();
    let checked = eomgen_model_spec::load(&file).map_err(|found| {
        let found = found.to_string();
        invalid(format!(
            "the specification {shown} in the FMU's resources is damaged: {found}; generate the FMU again"
        ))
    })?;
    let model = checked.model;
    let compiled = CompiledModel::derive(model, Orders::PerField(&orders)).map_err(|error| {
        invalid(format!(
            "the specification {shown} in the FMU's resources cannot be derived: {error}"
        ))
    })?;
    match given == Some(&*token(compiled.program())) {
        true => Ok(compiled),
        false => Err(reject_token()),
    }
}

fn reject_token() -> Rejection {
    invalid(
        "the token is not that of the specification in the FMU's resources: modelDescription.xml or the specification \
         belongs to another FMU, or was changed; generate the FMU again",
    )
}

/// Returns the orders in a token.
fn parse_orders(token: &str) -> Option<Vec<usize>> {
    let (_, rest) = token.split_once('-')?;
    let (orders, _) = rest.split_once('-')?;
    let orders = orders.split(',').filter(|order| !order.is_empty());
    orders.map(|order| order.parse().ok()).collect()
}

/// Returns the path of the specification, the only file with its extension in the folder.
fn find_specification(folder: &Path) -> Outcome<PathBuf> {
    let shown = folder.display();
    let unreadable = |error: std::io::Error| {
        invalid(format!("cannot read the FMU's resources {shown}: {error}"))
    };
    let mut found = None;
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            if found.is_some() {
                return Err(invalid(format!(
                    "the FMU's resources {shown} contain more than one specification"
                )));
            }
            found = Some(path);
        }
    }
    found.ok_or_else(|| {
        invalid(format!(
            "the FMU's resources {shown} contain no specification"
        ))
    })
}

/// Returns the path of a location. A URI has percent-encoded bytes.
fn parse_location(location: &[u8]) -> Outcome<PathBuf> {
    let Some(uri) = location.strip_prefix(b"file:") else {
        return to_path(location.to_vec());
    };
    let path = match uri.strip_prefix(b"//") {
        // A host, which may be empty or `localhost`, ends at the next slash.
        Some(rest) => {
            let host = rest.iter().position(|byte| *byte == b'/');
            &rest[host.unwrap_or(rest.len())..]
        }
        None => uri,
    };
    let mut decoded = decode_percent(path);
    // In `/C:/folder` the slash belongs to the URI.
    if cfg!(windows) && decoded.first() == Some(&b'/') && decoded.get(2) == Some(&b':') {
        decoded.remove(0);
    }
    to_path(decoded)
}

#[cfg(unix)]
fn to_path(bytes: Vec<u8>) -> Outcome<PathBuf> {
    use std::os::unix::ffi::OsStringExt;
    Ok(std::ffi::OsString::from_vec(bytes).into())
}

#[cfg(not(unix))]
fn to_path(bytes: Vec<u8>) -> Outcome<PathBuf> {
    let text = String::from_utf8(bytes);
    let text =
        text.map_err(|_| invalid("the location of the FMU's resources is not valid UTF-8"))?;
    Ok(text.into())
}

fn decode_percent(text: &[u8]) -> Vec<u8> {
    let digit = |place: usize| {
        let digit = text.get(place).copied().map(char::from);
        digit.and_then(|digit| digit.to_digit(16))
    };
    let mut decoded = Vec::with_capacity(text.len());
    let mut place = 0;
    while let Some(byte) = text.get(place) {
        let pair = (*byte == b'%').then(|| digit(place + 1).zip(digit(place + 2)));
        if let Some((high, low)) = pair.flatten() {
            // Two hexadecimal digits are below 256.
            decoded.extend(u8::try_from(16 * high + low));
            place += 3;
        } else {
            decoded.push(*byte);
            place += 1;
        }
    }
    decoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locations_are_paths_or_file_uris() {
        for (location, path) in [
            ("/tmp/a b", "/tmp/a b"),
            ("file:///tmp/a%20b/%C3%BC", "/tmp/a b/ü"),
            ("file://localhost/tmp/a", "/tmp/a"),
            ("file:/tmp/100%", "/tmp/100%"),
            ("/tmp/%20", "/tmp/%20"),
        ] {
            let found = parse_location(location.as_bytes());
            assert_eq!(
                found.map_err(|rejection| rejection.message),
                Ok(path.into())
            );
        }
    }
}
