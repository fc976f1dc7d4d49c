//! Numbers in the cells of text files.

use crate::decimal::Decimal;

/// Parses a number with the given decimal sign; `None` for other text. If the sign is a comma, a point is not allowed.
pub(crate) fn parse_number(cell: &str, decimal: u8) -> Option<f64> {
    if decimal == b'.' {
        return cell.parse().ok();
    }
    if cell.contains('.') {
        return None;
    }
    cell.replace(',', ".").parse().ok()
}

/// Parses a number without rounding; `None` for other text or too many digits.
pub(crate) fn parse_decimal(cell: &[u8], decimal: u8) -> Option<Decimal> {
    let cell = std::str::from_utf8(cell.trim_ascii()).ok()?;
    match decimal {
        b'.' => Decimal::parse(cell),
        _ => Decimal::parse(&cell.replace(',', ".")),
    }
}
