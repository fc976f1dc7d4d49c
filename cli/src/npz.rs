//! NumPy archives (`.npz`) of `.npy` files, version 1.0 (NumPy Enhancement Proposal 1).

use eomgen_targets::archive::pack;

use crate::error::Result;

/// Alignment of the data in an `.npy` file, bytes.
const ALIGNMENT: usize = 64;

pub enum Array<'a> {
    /// Entries row by row, with the numbers of rows and columns.
    Matrix(&'a [f64], [usize; 2]),
    Vector(&'a [f64]),
    Names(&'a [String]),
}

pub fn archive(arrays: &[(&str, Array<'_>)]) -> Result<Vec<u8>> {
    let files = arrays.iter();
    let files = files.map(|(name, array)| (format!("{name}.npy"), array.file()));
    Ok(pack(files.collect())?)
}

impl Array<'_> {
    /// Returns the array as an `.npy` file.
    fn file(&self) -> Vec<u8> {
        let (kind, shape, contents) = match self {
            Self::Matrix(values, [rows, columns]) => (
                "<f8".to_owned(),
                format!("({rows}, {columns})"),
                bytes(values),
            ),
            Self::Vector(values) => {
                let shape = format!("({},)", values.len());
                ("<f8".to_owned(), shape, bytes(values))
            }
            Self::Names(names) => {
                let longest = names.iter().map(|name| name.chars().count());
                // NumPy has no text type of width 0.
                let width = longest.max().unwrap_or(0).max(1);
                let kind = format!("<U{width}");
                (
                    kind,
                    format!("({},)", names.len()),
                    encode_texts(names, width),
                )
            }
        };
        let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        let mut file = b"\x93NUMPY\x01\x00".to_vec();
        // The aligned header includes the two bytes of its length and the newline.
        let length =
            (file.len() + 2 + header.len() + 1).next_multiple_of(ALIGNMENT) - file.len() - 2;
        file.extend((length as u16).to_le_bytes());
        file.extend(format!("{header:<width$}\n", width = length - 1).into_bytes());
        file.extend(contents);
        file
    }
}

fn bytes(values: &[f64]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// Returns texts in UTF-32, padded to `width` characters.
fn encode_texts(names: &[String], width: usize) -> Vec<u8> {
    let characters = names.iter().flat_map(|name| {
        let letters = name.chars().map(u32::from);
        letters.chain(std::iter::repeat(0)).take(width)
    });
    characters.flat_map(u32::to_le_bytes).collect()
}
