//! Numbers in the cells of text files.

use crate::decimal::Decimal;

/// Returns the number in a cell with this decimal sign; `None` for other text. With a comma, a point is no number.
pub(crate) fn parse_number(cell: &str, decimal: u8) -> Option<f64> {
    if decimal == b'.' {
        return cell.parse().ok();
    }
    if cell.contains('.') {
        return None;
    }
    cell.replace(',', ".").parse().ok()
}

/// Returns the number in a cell without rounding; `None` for other text or too many digits.
pub(crate) fn parse_decimal(cell: &[u8], decimal: u8) -> Option<Decimal> {
    let cell = std::str::from_utf8(cell.trim_ascii()).ok()?;
    match decimal {
        b'.' => Decimal::parse(cell),
        _ => Decimal::parse(&cell.replace(',', ".")),
    }
}
