//! Emitted files.

/// Emitted file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmittedFile {
    /// Name, without a folder.
    pub name: String,
    /// Content.
    pub contents: Vec<u8>,
}

impl EmittedFile {
    pub(crate) fn text(name: String, text: String) -> Self {
        Self {
            name,
            contents: text.into_bytes(),
        }
    }
}
