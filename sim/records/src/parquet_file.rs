//! Numeric columns of a Parquet file: doubles, floats and integers that are not nested.

use std::path::Path;

use bytes::Bytes;
use parquet::basic::Type as Physical;
use parquet::errors::ParquetError;
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use crate::decimal::Decimal;
use crate::description::columns::ColumnKey;
use crate::header::{MAX_SAMPLES, Table, find_columns, too_many_samples_error};
use crate::refusal::Refusal;

/// Reads columns; a missing number becomes NaN.
pub fn read_columns(path: &Path, bytes: Vec<u8>, wanted: &[&ColumnKey]) -> Result<Table, Refusal> {
    // The parquet crate panics on some damaged files.
    let said = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let columns = std::panic::catch_unwind(|| decode_columns(path, bytes, wanted));
    std::panic::set_hook(said);
    columns.unwrap_or_else(|_| {
        Err(Refusal::file_error(
            path,
            "cannot be read as Parquet: it is damaged",
        ))
    })
}

/// Returns the names and numbers (from 1) of a file's numeric columns, in the order of the file.
pub(crate) fn column_names(path: &Path, bytes: Vec<u8>) -> Result<Vec<(usize, String)>, Refusal> {
    let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(|error| {
        Refusal::file_error(path, format!("cannot be read as Parquet: {error}"))
    })?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let columns = (1..).zip(schema.columns());
    let numbers = columns.filter(|(_, column)| is_number(column.physical_type()));
    Ok(numbers
        .map(|(number, column)| (number, column.name().to_owned()))
        .collect())
}

fn is_number(kind: Physical) -> bool {
    matches!(
        kind,
        Physical::DOUBLE | Physical::FLOAT | Physical::INT32 | Physical::INT64
    )
}

fn decode_columns(path: &Path, bytes: Vec<u8>, wanted: &[&ColumnKey]) -> Result<Table, Refusal> {
    let broken = |error: ParquetError| {
        Refusal::file_error(path, format!("cannot be read as Parquet: {error}"))
    };
    let length = bytes.len();
    let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(broken)?;
    if !has_valid_offsets(reader.metadata(), length) {
        return Err(Refusal::file_error(
            path,
            "cannot be read as Parquet: it refers to columns outside of the file",
        ));
    }
    let metadata = reader.metadata().file_metadata();
    let schema = metadata.schema_descr_ptr();
    let columns = schema.columns();
    if metadata.num_rows() > MAX_SAMPLES as i64 {
        return Err(too_many_samples_error(path));
    }
    if columns.iter().any(|column| column.path().parts().len() > 1) {
        return Err(Refusal::file_error(
            path,
            "has nested columns; expected one number per column and row",
        ));
    }
    let there = columns.iter().map(|column| column.name().to_owned());
    let there: Vec<String> = there.collect();
    let places = find_columns(path, 1, &there, wanted)?;
    for place in &places {
        let kind = columns[*place].physical_type();
        if !is_number(kind) {
            let name = &there[*place];
            return Err(Refusal::file_error(
                path,
                format!("the column `{name}` contains {kind}; expected numbers"),
            ));
        }
    }
    let mut values = vec![Vec::new(); wanted.len()];
    let mut decimals = Vec::new();
    for row in reader.get_row_iter(None).map_err(broken)? {
        let row = row.map_err(broken)?;
        if values
            .first()
            .is_some_and(|column| column.len() == MAX_SAMPLES)
        {
            return Err(too_many_samples_error(path));
        }
        if let Some(place) = places.first() {
            let field = row.get_column_iter().nth(*place).map(|(_, field)| field);
            decimals.push(field.and_then(decimal_from_field));
        }
        for (column, place) in values.iter_mut().zip(&places) {
            let field = row.get_column_iter().nth(*place).map(|(_, field)| field);
            column.push(field.map_or(Ok(f64::NAN), |field| {
                number_from_field(path, &there[*place], field)
            })?);
        }
    }
    let lines = (0..values.first().map_or(0, Vec::len) as u64).map(|row| row + 2);
    Ok(Table {
        lines: lines.collect(),
        columns: values,
        decimals,
    })
}

/// Returns true if all offsets are inside the file. The parquet crate does not check this.
fn has_valid_offsets(metadata: &ParquetMetaData, length: usize) -> bool {
    let inside = |offset: i64, size: i64| {
        let end = offset.checked_add(size);
        offset >= 0 && size >= 0 && end.is_some_and(|end| end as u64 <= length as u64)
    };
    let whole = |column: &ColumnChunkMetaData| {
        let begin = column
            .dictionary_page_offset()
            .unwrap_or(column.data_page_offset());
        inside(begin, column.compressed_size())
            && inside(column.data_page_offset(), 0)
            && column.num_values() >= 0
    };
    let groups = metadata.row_groups().iter();
    groups
        .clone()
        .all(|group| group.num_rows() >= 0 && group.columns().iter().all(whole))
        && groups.map(|group| group.num_rows() as i128).sum::<i128>()
            == i128::from(metadata.file_metadata().num_rows())
}

fn decimal_from_field(field: &Field) -> Option<Decimal> {
    match field {
        Field::Long(value) => Some(Decimal::from_integer(*value)),
        Field::Float(value) => Decimal::parse(&format!("{value:e}")),
        other => Decimal::from_double(number_from_field(Path::new(""), "", other).ok()?),
    }
}

fn number_from_field(path: &Path, name: &str, field: &Field) -> Result<f64, Refusal> {
    let value = match field {
        Field::Double(value) => *value,
        Field::Float(value) => f64::from(*value),
        Field::Byte(value) => f64::from(*value),
        Field::Short(value) => f64::from(*value),
        Field::Int(value) => f64::from(*value),
        Field::Long(value) => *value as f64,
        Field::UByte(value) => f64::from(*value),
        Field::UShort(value) => f64::from(*value),
        Field::UInt(value) => f64::from(*value),
        Field::ULong(value) => *value as f64,
        Field::Null => f64::NAN,
        _ => {
            return Err(Refusal::file_error(
                path,
                format!("the column `{name}` contains dates or text; expected numbers"),
            ));
        }
    };
    if value.is_infinite() {
        return Err(Refusal::file_error(
            path,
            format!("the column `{name}` contains an infinity; a missing sample is null or NaN"),
        ));
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use parquet::basic::{Compression, Repetition, Type as Physical};
    use parquet::data_type::{DoubleType, Int64Type};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::types::Type;

    use eomgen_model_spec::quantity::StringValue;
    use eomgen_model_spec::span::Span;

    use super::{ColumnKey, read_columns};

    fn column_keys(names: [&str; 2]) -> [ColumnKey; 2] {
        names.map(|name| ColumnKey::Name(StringValue::without_text(name, Span::default())))
    }

    /// Returns a file with the columns `t` (double, compressed) and `n` (integers, some missing).
    fn parquet_bytes(rows: i64) -> Vec<u8> {
        let field = |name: &str, kind: Physical, repetition: Repetition| {
            let field = Type::primitive_type_builder(name, kind).with_repetition(repetition);
            Arc::new(field.build().expect("a column"))
        };
        let fields = vec![
            field("t", Physical::DOUBLE, Repetition::REQUIRED),
            field("n", Physical::INT64, Repetition::OPTIONAL),
        ];
        let schema = Type::group_type_builder("record").with_fields(fields);
        let schema = Arc::new(schema.build().expect("a schema"));
        let properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
        let mut bytes = Vec::new();
        let mut file = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties.build()))
            .expect("a file");
        let mut group = file.next_row_group().expect("a group");
        let times: Vec<f64> = (0..rows).map(|i| 0.5 * i as f64).collect();
        let mut column = group.next_column().expect("a column").expect("a column");
        let written = column.typed::<DoubleType>().write_batch(&times, None, None);
        assert_eq!(written.ok(), Some(times.len()));
        column.close().expect("a column");
        let present: Vec<i16> = (0..rows).map(|i| i16::from(i % 3 != 0)).collect();
        let numbers: Vec<i64> = (0..rows).filter(|i| i % 3 != 0).collect();
        let mut column = group.next_column().expect("a column").expect("a column");
        let typed = column.typed::<Int64Type>();
        typed
            .write_batch(&numbers, Some(&present), None)
            .expect("numbers");
        column.close().expect("a column");
        group.close().expect("a group");
        file.close().expect("a file");
        bytes
    }

    #[test]
    fn compressed_columns_and_missing_integers_are_read() {
        let [n, t] = column_keys(["n", "t"]);
        let table =
            read_columns(Path::new("a.parquet"), parquet_bytes(10), &[&n, &t]).expect("a record");
        let columns = table.columns;
        assert!(columns[0][0].is_nan() && columns[0][3].is_nan());
        assert_eq!(columns[0][1..3], [1.0, 2.0]);
        assert_eq!(
            columns[1],
            (0..10).map(|i| 0.5 * f64::from(i)).collect::<Vec<_>>()
        );
    }

    #[test]
    fn damaged_files_do_not_panic() {
        let whole = parquet_bytes(40);
        let [t, n] = column_keys(["t", "n"]);
        for place in 0..whole.len() {
            let answer = |bytes| read_columns(Path::new("a.parquet"), bytes, &[&t, &n]);
            assert!(answer(whole[..place].to_vec()).is_err());
            for damage in [0x01, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[place] ^= damage;
                answer(bytes).ok();
            }
        }
    }
}
