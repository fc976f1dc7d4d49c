//! Names of the files that one command writes to a folder.

use std::collections::HashMap;

use crate::error::{Error, Result};

/// File name of a certificate.
pub const CERTIFICATE: &str = "certificate.json";

/// Checks that files with different contents have different names. Names are compared without case, because some file
/// systems ignore it.
///
/// # Errors
/// A name that two files have.
pub fn check_names<'f>(files: impl IntoIterator<Item = (&'f str, &'f [u8])>) -> Result {
    let mut known: HashMap<String, &[u8]> = HashMap::new();
    for (name, contents) in files {
        let earlier = known.insert(name.to_lowercase(), contents);
        if earlier.is_some_and(|earlier| earlier != contents) {
            return Err(Error::input(format!(
                "two of the files would have the name `{name}`: give the model another name, or the variant of a family \
                 another prefix; nothing was written"
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_with_different_contents_need_names_that_differ_in_more_than_case() {
        let check = |names: [(&str, &str); 2]| {
            let files = names.map(|(name, text)| (name, text.as_bytes()));
            check_names(files).is_ok()
        };
        for name in ["a.h", "A.h", "a.H"] {
            assert!(!check([("a.h", "1"), (name, "2")]), "{name}");
        }
        assert!(check([("a.h", "1"), ("a.h", "1")]));
        assert!(check([("a.h", "1"), ("a.c", "2")]));
    }
}
