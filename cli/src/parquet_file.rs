//! Parquet files: one required double column per name, one row group, no compression.

use std::sync::Arc;

use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

/// Encodes columns of equal length.
///
/// # Errors
/// Errors of the Parquet writer.
pub fn encode(names: &[String], columns: &[Vec<f64>]) -> Result<Vec<u8>, ParquetError> {
    let fields = names
        .iter()
        .map(|name| {
            Type::primitive_type_builder(name, Physical::DOUBLE)
                .with_repetition(Repetition::REQUIRED)
                .build()
                .map(Arc::new)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("trajectory")
        .with_fields(fields)
        .build()?;
    let mut bytes = Vec::new();
    let properties = Arc::new(WriterProperties::builder().build());
    let mut file = SerializedFileWriter::new(&mut bytes, Arc::new(schema), properties)?;
    let mut group = file.next_row_group()?;
    for column in columns {
        if let Some(mut writer) = group.next_column()? {
            writer
                .typed::<DoubleType>()
                .write_batch(column, None, None)?;
            writer.close()?;
        }
    }
    group.close()?;
    file.close()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::encode;

    #[test]
    fn encoded_columns_are_read_back() {
        let names = vec!["t".to_owned(), "x_sp".to_owned()];
        let columns = vec![vec![0.0, 0.1, 0.2], vec![1e-300, -2.5, f64::MAX]];
        let bytes = encode(&names, &columns).expect("two columns of equal length");
        assert_eq!(bytes, encode(&names, &columns).expect("the same again"));
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).expect("a Parquet file");
        let rows: Vec<_> = reader
            .get_row_iter(None)
            .expect("rows")
            .map(|row| row.expect("a row"))
            .collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[1].get_double(1).expect("a number"), -2.5);
        assert_eq!(rows[0].get_double(1).expect("a number"), 1e-300);
    }
}
