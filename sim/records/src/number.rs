//! Numbers in the cells of text files.

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
