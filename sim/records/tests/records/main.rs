//! Tests of reading records: documented forms, file formats, wrapped angles.

mod documented;
mod formats;
