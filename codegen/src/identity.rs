//! Identity of emitted source: a text that remains in compiled programs, with the hashes of specification and source.

use eomgen_model_spec::source::sha256;

use crate::program::Program;

/// First word of every identity text.
const MARK: &str = "eomgen-identity";

/// Placeholder for the source hash, replaced when the source is complete.
const PLACEHOLDER: &str = "0000000000000000000000000000000000000000000000000000000000000000";

/// Largest length of an identity, in bytes.
const MAX_LENGTH: usize = 512;

/// Identity of an emitted source.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identity {
    /// Prefix of the emitted C, or name of the model.
    pub name: String,
    /// SHA-256 of the specification.
    pub specification: String,
    /// SHA-256 of the source without its identity line, see [`hash_source`].
    pub source: String,
    /// Version of the generator.
    pub generator: String,
}

/// Returns the identity text with the placeholder in place of the source hash.
pub(crate) fn write_unsealed_identity(program: &Program) -> String {
    let (name, specification) = (&program.name, &program.spec_hash);
    let generator = env!("CARGO_PKG_VERSION");
    format!(
        "{MARK} name={name} specification={specification} source={PLACEHOLDER} generator={generator};"
    )
}

/// Replaces the placeholder in a complete source by the source hash.
pub(crate) fn seal(source: &str) -> String {
    let hash = format!("source={}", hash_source(source));
    source.replacen(&format!("source={PLACEHOLDER}"), &hash, 1)
}

/// Returns the SHA-256 of a source without the lines that contain an identity. Line ends count as `\n`.
pub fn hash_source(source: &str) -> String {
    let lines = source.lines().filter(|line| !line.contains(MARK));
    let text: String = lines.flat_map(|line| [line, "\n"]).collect();
    sha256(text)
}

/// Finds the identities in a source file, object file, library or firmware image, in their order, without repetition.
pub fn find(bytes: &[u8]) -> Vec<Identity> {
    let mark = format!("{MARK} ");
    let mark = mark.as_bytes();
    let mut found: Vec<Identity> = Vec::new();
    let mut start = 0;
    while let Some(next) = bytes[start..]
        .windows(mark.len())
        .position(|part| part == mark)
    {
        start += next + mark.len();
        let rest = &bytes[start..bytes.len().min(start + MAX_LENGTH)];
        let identity = rest.split(|byte| *byte == b';').next().and_then(parse);
        found.extend(identity.filter(|identity| !found.contains(identity)));
    }
    found
}

fn parse(text: &[u8]) -> Option<Identity> {
    let mut words = std::str::from_utf8(text).ok()?.split(' ');
    let mut field = |key: &str| {
        let value = words.next()?.strip_prefix(key)?.strip_prefix('=')?;
        let is_plain = value
            .bytes()
            .all(|b| b.is_ascii_alphanumeric() || b"._-+".contains(&b));
        is_plain.then(|| value.to_owned())
    };
    Some(Identity {
        name: field("name")?,
        specification: field("specification")?,
        source: field("source")?,
        generator: field("generator")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(source: &str) -> String {
        format!("{MARK} name=arm specification=ab12 source={source} generator=0.2.0;")
    }

    #[test]
    fn hash_excludes_the_line_of_the_identity() {
        let source =
            |inner: &str| format!("int a;\nconst char arm_identity[] = \"{inner}\";\nint b;\n");
        let sealed = seal(&source(&line(PLACEHOLDER)));
        assert_eq!(hash_source(&sealed), sha256("int a;\nint b;\n"));
        let [identity] = &find(sealed.as_bytes())[..] else {
            panic!("no identity")
        };
        assert_eq!(identity.source, hash_source(&sealed));
        assert_eq!(hash_source(&sealed.replace('\n', "\r\n")), identity.source);
        assert_ne!(
            hash_source(&sealed.replace("int b", "int c")),
            identity.source
        );
    }

    #[test]
    fn damaged_identities_in_binary_files_are_ignored() {
        let mut bytes = vec![0, 255, 3];
        bytes.extend(line("cd34").bytes());
        bytes.extend(b"\0eomgen-identity name=x;eomgen-identity ");
        bytes.extend([200; 600]);
        bytes.extend(line("cd34").bytes());
        bytes.extend(line("ef56").replace("name=arm", "name=\u{7}").bytes());
        let found = find(&bytes);
        assert_eq!(found.len(), 1);
        assert_eq!((&*found[0].name, &*found[0].source), ("arm", "cd34"));
        assert!(find(b"eomgen-identity ").is_empty());
    }
}
