//! Tables of numbers, encoded as CSV or Parquet.

use std::path::Path;

use crate::error::{Error, Result};
use crate::parquet_file;

fn is_parquet(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

pub struct Table {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl Table {
    pub fn new(names: Vec<String>) -> Self {
        let columns = vec![Vec::new(); names.len()];
        Self { names, columns }
    }

    /// Creates a table of columns of equal length.
    pub fn from_columns(columns: &[(String, Vec<f64>)]) -> Self {
        let (names, columns) = columns.iter().cloned().unzip();
        Self { names, columns }
    }

    /// Appends a row, one number per column.
    pub fn push(&mut self, row: &[f64]) {
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.push(*value);
        }
    }

    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let place = self.names.iter().position(|known| known == name)?;
        Some(&self.columns[place])
    }

    /// Returns the columns with numbers that are not finite: name, index of the first row with such a number, and their
    /// count.
    pub fn not_finite(&self) -> impl Iterator<Item = (&str, usize, usize)> {
        let columns = self.names.iter().zip(&self.columns);
        columns.filter_map(|(name, column)| {
            let first = column.iter().position(|value| !value.is_finite())?;
            let count = column.iter().filter(|value| !value.is_finite()).count();
            Some((name.as_str(), first, count))
        })
    }

    /// Encodes as Parquet if the name of the file ends in `.parquet`, otherwise as CSV.
    pub fn encode(&self, path: &Path) -> Result<Vec<u8>> {
        if is_parquet(path) {
            return parquet_file::encode(&self.names, &self.columns)
                .map_err(|error| Error::input(format!("cannot write Parquet: {error}")));
        }
        self.csv()
    }

    /// Encodes numbers with the fewest digits that identify them exactly.
    fn csv(&self) -> Result<Vec<u8>> {
        let failed =
            |error: &dyn std::fmt::Display| Error::input(format!("cannot write CSV: {error}"));
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer
            .write_record(&self.names)
            .map_err(|error| failed(&error))?;
        for row in 0..self.rows() {
            let fields = self
                .columns
                .iter()
                .map(|column| format!("{:?}", column[row]));
            writer
                .write_record(fields)
                .map_err(|error| failed(&error))?;
        }
        writer.into_inner().map_err(|error| failed(&error))
    }
}
