//! Detection of separator and decimal sign: the choice with the longest block of lines of numbers.

use crate::description::format::{DECIMALS, Format, SEPARATORS, Separator};
use crate::number::parse_number;
use eomgen_model_spec::unit::Unit;

/// Number of lines to examine from the start of the file.
const MAX_EXAMINED_LINES: usize = 400;

const COMMENTS: [char; 3] = ['#', '%', '!'];

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    pub format: Format,
    /// Names of the columns; "" without a name.
    pub names: Vec<String>,
    /// Units of the columns; "" without a unit.
    pub units: Vec<String>,
    pub numeric_columns: Vec<bool>,
}

pub(crate) fn detect_layout(text: &str) -> Option<Layout> {
    let lines: Vec<&str> = match text.contains('\n') {
        true => text.lines().take(MAX_EXAMINED_LINES).collect(),
        false => text.split('\r').take(MAX_EXAMINED_LINES).collect(),
    };
    let comment = COMMENTS.into_iter().find(|sign| {
        let begin = |line: &&str| line.trim_start().starts_with(*sign);
        lines.iter().any(begin)
    });
    let mut best: Option<Block<'_>> = None;
    for (_, separator) in SEPARATORS {
        for (_, decimal) in DECIMALS {
            if separator == Separator::Character(decimal) {
                continue;
            }
            let block = Block::find_block(&lines, separator, decimal, comment);
            if block.score > best.as_ref().map_or(0.0, |best| best.score) {
                best = Some(block);
            }
        }
    }
    let block = best?;
    let mut layout = block.to_layout(comment);
    layout.numeric_columns = block.numeric_columns(comment);
    Some(layout)
}

struct Block<'t> {
    lines: &'t [&'t str],
    separator: Separator,
    decimal: u8,
    first: usize,
    cells: usize,
    /// Number of numeric cells, weighted by their fraction of all cells; 0 without a block.
    score: f64,
}

impl<'t> Block<'t> {
    /// Finds the block, up to the last complete line.
    fn find_block(
        lines: &'t [&'t str],
        separator: Separator,
        decimal: u8,
        comment: Option<char>,
    ) -> Self {
        let mut block = Self {
            lines,
            separator,
            decimal,
            first: lines.len(),
            cells: 0,
            score: 0.0,
        };
        let end = lines.len().saturating_sub(usize::from(lines.len() > 2));
        for place in (0..end).rev() {
            let line = lines[place];
            let is_comment = comment.is_some_and(|sign| line.trim_start().starts_with(sign));
            let cells = split_row(
                line,
                separator,
                Some(block.cells).filter(|count| *count > 0),
            );
            if is_comment || cells.iter().all(String::is_empty) {
                continue;
            }
            let numbers = cells
                .iter()
                .filter(|cell| parse_number(cell, decimal).is_some());
            let numbers = numbers.count();
            let blank = cells.iter().filter(|cell| cell.is_empty()).count();
            let is_row = match block.cells {
                0 => numbers > 1,
                count => cells.len() == count && (numbers > 1 || numbers + blank == count),
            };
            if !is_row {
                break;
            }
            (block.first, block.cells) = (place, cells.len());
            // Cells that are not numbers can result from a wrong separator.
            block.score += (numbers * numbers) as f64 / cells.len() as f64;
        }
        block
    }

    fn numeric_columns(&self, comment: Option<char>) -> Vec<bool> {
        let mut numbers = vec![0; self.cells];
        let mut texts = vec![0; self.cells];
        let end = self.lines.len().saturating_sub(1).max(self.first);
        for line in &self.lines[self.first..end] {
            let is_comment = comment.is_some_and(|sign| line.trim_start().starts_with(sign));
            if is_comment {
                continue;
            }
            let cells = split_row(line, self.separator, Some(self.cells));
            for (place, cell) in cells.iter().enumerate().take(self.cells) {
                match parse_number(cell, self.decimal) {
                    Some(_) => numbers[place] += 1,
                    None if cell.is_empty() => {}
                    None => texts[place] += 1,
                }
            }
        }
        let pairs = numbers.into_iter().zip(texts);
        pairs
            .map(|(numbers, texts)| numbers > 0 && texts == 0)
            .collect()
    }

    fn to_layout(&self, comment: Option<char>) -> Layout {
        let unknown = vec![String::new(); self.cells];
        let row_above = |place: usize| {
            let line = self.lines[place].trim();
            let cells = split_cells(line, self.separator);
            let is_text = |cell: &String| parse_number(cell, self.decimal).is_none();
            (cells.len() == self.cells && cells.iter().any(is_text)).then_some(cells)
        };
        let is_comment = |place: usize| {
            let line = self.lines[place].trim_start();
            comment.is_some_and(|sign| line.starts_with(sign))
        };
        let mut above = (0..self.first).rev();
        let mut above = above
            .by_ref()
            .filter(|place| !self.lines[*place].trim().is_empty());
        let mut format = Format {
            separator: self.separator,
            decimal: self.decimal,
            has_names: false,
            skip: 0,
            comment: None,
            has_units: false,
        };
        let has_comments = |from: usize| (from..self.lines.len()).any(is_comment);
        let Some(nearest) = above.next() else {
            format.comment = comment.filter(|_| has_comments(0)).map(|sign| sign as u8);
            return Layout {
                format,
                names: unknown.clone(),
                units: unknown,
                numeric_columns: Vec::new(),
            };
        };
        if is_comment(nearest) {
            // Names after a comment sign are read only here, because the reader of records skips that line.
            format.comment = comment.map(|sign| sign as u8);
            let line = self.lines[nearest]
                .trim_start()
                .trim_start_matches(COMMENTS);
            let cells = split_cells(line.trim(), self.separator);
            let names = if cells.len() == self.cells {
                cells
            } else {
                unknown.clone()
            };
            return Layout {
                format: self.with_skip(format, nearest + 1),
                names,
                units: unknown,
                numeric_columns: Vec::new(),
            };
        }
        let (nearest_row, next) = (row_above(nearest), above.next());
        let next_row = next.filter(|place| !is_comment(*place)).and_then(row_above);
        match (nearest_row, next_row) {
            (Some(units), Some(names)) if units.iter().all(|cell| is_unit(cell)) => {
                format.has_names = true;
                format.has_units = true;
                Layout {
                    format: self.with_skip(format, next.unwrap_or(nearest)),
                    names,
                    units,
                    numeric_columns: Vec::new(),
                }
            }
            (Some(names), _) => {
                format.has_names = true;
                Layout {
                    format: self.with_skip(format, nearest),
                    names,
                    units: unknown,
                    numeric_columns: Vec::new(),
                }
            }
            (None, _) => Layout {
                format: self.with_skip(format, nearest + 1),
                names: unknown.clone(),
                units: unknown,
                numeric_columns: Vec::new(),
            },
        }
    }

    fn with_skip(&self, mut format: Format, lines: usize) -> Format {
        format.skip = lines;
        let sign = format.comment.map(char::from);
        let begins = |line: &&str| sign.is_some_and(|sign| line.trim_start().starts_with(sign));
        if !self.lines[lines..].iter().any(begins) {
            format.comment = None;
        }
        format
    }
}

/// Splits a line into cells without quotes; a separator at the end of the line adds no cell.
fn split_cells(line: &str, separator: Separator) -> Vec<String> {
    split_row(line, separator, None)
}

/// Splits a line into `count` cells; the last one can be blank.
fn split_row(line: &str, separator: Separator, count: Option<usize>) -> Vec<String> {
    let bare = |cell: &str| cell.trim().trim_matches('"').trim().to_owned();
    let mut cells: Vec<String> = match separator {
        Separator::Spaces => line.split_whitespace().map(bare).collect(),
        Separator::Character(sign) if line.contains('"') => {
            let cells = read_quoted_row(line, sign);
            cells.iter().map(|cell| bare(cell)).collect()
        }
        Separator::Character(sign) => line.split(sign as char).map(bare).collect(),
    };
    let is_open = cells.len() > 1 && cells.last().is_some_and(String::is_empty);
    if is_open && count != Some(cells.len()) {
        cells.pop();
    }
    cells
}

/// Splits a line whose cells may be quoted; quoted cells may contain the separator.
fn read_quoted_row(line: &str, separator: u8) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(line.trim().as_bytes());
    let row = reader.records().next().and_then(Result::ok);
    row.map_or_else(Vec::new, |row| row.iter().map(str::to_owned).collect())
}

fn is_unit(cell: &str) -> bool {
    let bare = super::matching::strip_unit_brackets(cell);
    bare.is_empty() || bare == "-" || Unit::parse(&bare).is_ok()
}

#[cfg(test)]
mod tests {
    use super::{Format, Separator, detect_layout};

    fn text(head: &str, row: &str) -> String {
        head.to_owned() + &row.repeat(40)
    }

    #[test]
    fn quoted_names_may_contain_the_separator() {
        for (sign, separator) in [(",", b','), (";", b';')] {
            let head = format!("\"t\"{sign}\"T{sign} motor\"{sign} \"phi\"\n");
            let row = format!("0.1{sign}0.2{sign}0.3\n");
            let layout = detect_layout(&text(&head, &row)).expect("a layout");
            assert_eq!(
                layout.names,
                ["t".to_owned(), format!("T{sign} motor"), "phi".to_owned()]
            );
            assert_eq!(layout.format.separator, Separator::Character(separator));
        }
    }

    #[test]
    fn layouts_are_detected() {
        let usual = Format::default();
        let semicolon = Separator::Character(b';');
        let cases = [
            (text("t,u,theta\n", "0.1,2,-3e-4\n"), usual, "t u theta", ""),
            (
                text("Prüfstand 3\n\nt;u\ns;N m\n", "0,01;2,5\n"),
                Format {
                    separator: semicolon,
                    decimal: b',',
                    skip: 2,
                    has_units: true,
                    ..usual
                },
                "t u",
                "s N m",
            ),
            (
                text("", "1\t2,5\t3\n"),
                Format {
                    separator: Separator::Character(b'\t'),
                    decimal: b',',
                    has_names: false,
                    ..usual
                },
                "  ",
                "",
            ),
            (
                text("# t u\n", "  0.1  2.0\n"),
                Format {
                    separator: Separator::Spaces,
                    has_names: false,
                    skip: 1,
                    ..usual
                },
                "t u",
                "",
            ),
            (
                text("t, u\n", "0, 1\n# a pause\n"),
                Format {
                    comment: None,
                    ..usual
                },
                "t u",
                "",
            ),
        ];
        for (text, format, names, units) in cases {
            let layout = detect_layout(&text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(layout.format, format, "{text}");
            assert_eq!(layout.names.join(" "), names, "{text}");
            if !units.is_empty() {
                assert_eq!(layout.units.join(" "), units, "{text}");
            }
        }
        assert_eq!(detect_layout("nothing\nof numbers\n"), None);
        assert_eq!(detect_layout(""), None);
    }

    #[test]
    fn carriage_returns_end_lines() {
        for (head, row) in [
            ("t,u,theta\n", "0.1,2,-3e-4\n"),
            ("Bench\nt;u\ns;N m\n", "0,01;2,5\n"),
            ("# t u\n", "  0.1  2.0\n"),
        ] {
            let usual = text(head, row);
            for end in ["\r", "\r\n"] {
                assert_eq!(
                    detect_layout(&usual.replace('\n', end)),
                    detect_layout(&usual),
                    "{end:?}"
                );
            }
        }
    }
}
