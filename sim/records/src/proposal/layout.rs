//! Detection of separator and decimal sign: those with the longest block of lines of numbers.

use crate::csv_file::parsed;
use crate::description::format::{DECIMALS, Format, SEPARATORS, Separator};
use eomgen_model_spec::unit::Unit;

/// Number of lines to examine from the start of the file.
const LINES: usize = 400;

const COMMENTS: [char; 3] = ['#', '%', '!'];

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    pub format: Format,
    /// Names of the columns; "" without a name.
    pub names: Vec<String>,
    /// Units of the columns; "" without a unit.
    pub units: Vec<String>,
    pub are_numbers: Vec<bool>,
}

pub(crate) fn found(text: &str) -> Option<Layout> {
    let lines: Vec<&str> = match text.contains('\n') {
        true => text.lines().take(LINES).collect(),
        false => text.split('\r').take(LINES).collect(),
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
            let block = Block::of(&lines, separator, decimal, comment);
            if block.score > best.as_ref().map_or(0.0, |best| best.score) {
                best = Some(block);
            }
        }
    }
    let block = best?;
    let mut layout = block.layout(comment);
    layout.are_numbers = block.are_numbers(comment);
    Some(layout)
}

struct Block<'t> {
    lines: &'t [&'t str],
    separator: Separator,
    decimal: u8,
    first: usize,
    cells: usize,
    /// Number of numbers, weighted by their fraction of all cells; 0 without a block.
    score: f64,
}

impl<'t> Block<'t> {
    /// Returns the block up to the last complete line.
    fn of(lines: &'t [&'t str], separator: Separator, decimal: u8, comment: Option<char>) -> Self {
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
            let cells = row(
                line,
                separator,
                Some(block.cells).filter(|count| *count > 0),
            );
            if is_comment || cells.iter().all(String::is_empty) {
                continue;
            }
            let numbers = cells.iter().filter(|cell| parsed(cell, decimal).is_some());
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

    fn are_numbers(&self, comment: Option<char>) -> Vec<bool> {
        let mut numbers = vec![0; self.cells];
        let mut texts = vec![0; self.cells];
        let end = self.lines.len().saturating_sub(1).max(self.first);
        for line in &self.lines[self.first..end] {
            let is_comment = comment.is_some_and(|sign| line.trim_start().starts_with(sign));
            if is_comment {
                continue;
            }
            let cells = row(line, self.separator, Some(self.cells));
            for (place, cell) in cells.iter().enumerate().take(self.cells) {
                match parsed(cell, self.decimal) {
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

    fn layout(&self, comment: Option<char>) -> Layout {
        let unknown = vec![String::new(); self.cells];
        let row_above = |place: usize| {
            let line = self.lines[place].trim();
            let cells = cells(line, self.separator);
            let is_text = |cell: &String| parsed(cell, self.decimal).is_none();
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
            names: false,
            skip: 0,
            comment: None,
            units: false,
        };
        let has_comments = |from: usize| (from..self.lines.len()).any(is_comment);
        let Some(nearest) = above.next() else {
            format.comment = comment.filter(|_| has_comments(0)).map(|sign| sign as u8);
            return Layout {
                format,
                names: unknown.clone(),
                units: unknown,
                are_numbers: Vec::new(),
            };
        };
        if is_comment(nearest) {
            // Names after a comment sign are read only here. The reader of records skips that line.
            format.comment = comment.map(|sign| sign as u8);
            let line = self.lines[nearest]
                .trim_start()
                .trim_start_matches(COMMENTS);
            let cells = cells(line.trim(), self.separator);
            let names = if cells.len() == self.cells {
                cells
            } else {
                unknown.clone()
            };
            return Layout {
                format: self.skipping(format, nearest + 1),
                names,
                units: unknown,
                are_numbers: Vec::new(),
            };
        }
        let (nearest_row, next) = (row_above(nearest), above.next());
        let next_row = next.filter(|place| !is_comment(*place)).and_then(row_above);
        match (nearest_row, next_row) {
            (Some(units), Some(names)) if units.iter().all(|cell| is_unit(cell)) => {
                format.names = true;
                format.units = true;
                Layout {
                    format: self.skipping(format, next.unwrap_or(nearest)),
                    names,
                    units,
                    are_numbers: Vec::new(),
                }
            }
            (Some(names), _) => {
                format.names = true;
                Layout {
                    format: self.skipping(format, nearest),
                    names,
                    units: unknown,
                    are_numbers: Vec::new(),
                }
            }
            (None, _) => Layout {
                format: self.skipping(format, nearest + 1),
                names: unknown.clone(),
                units: unknown,
                are_numbers: Vec::new(),
            },
        }
    }

    fn skipping(&self, mut format: Format, lines: usize) -> Format {
        format.skip = lines;
        let sign = format.comment.map(char::from);
        let begins = |line: &&str| sign.is_some_and(|sign| line.trim_start().starts_with(sign));
        if !self.lines[lines..].iter().any(begins) {
            format.comment = None;
        }
        format
    }
}

/// Splits a line into cells without quotes; a separator at its end adds no cell.
fn cells(line: &str, separator: Separator) -> Vec<String> {
    row(line, separator, None)
}

/// Splits a line into `count` cells; the last one can be blank.
fn row(line: &str, separator: Separator, count: Option<usize>) -> Vec<String> {
    let bare = |cell: &str| cell.trim().trim_matches('"').trim().to_owned();
    let mut cells: Vec<String> = match separator {
        Separator::Spaces => line.split_whitespace().map(bare).collect(),
        Separator::Character(sign) => line.split(sign as char).map(bare).collect(),
    };
    let is_open = cells.len() > 1 && cells.last().is_some_and(String::is_empty);
    if is_open && count != Some(cells.len()) {
        cells.pop();
    }
    cells
}

fn is_unit(cell: &str) -> bool {
    let bare = super::matching::bare_unit(cell);
    bare.is_empty() || bare == "-" || Unit::parse(&bare).is_ok()
}

#[cfg(test)]
mod tests {
    use super::{Format, Separator, found};

    fn text(head: &str, row: &str) -> String {
        head.to_owned() + &row.repeat(40)
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
                    units: true,
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
                    names: false,
                    ..usual
                },
                "  ",
                "",
            ),
            (
                text("# t u\n", "  0.1  2.0\n"),
                Format {
                    separator: Separator::Spaces,
                    names: false,
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
            let layout = found(&text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(layout.format, format, "{text}");
            assert_eq!(layout.names.join(" "), names, "{text}");
            if !units.is_empty() {
                assert_eq!(layout.units.join(" "), units, "{text}");
            }
        }
        assert_eq!(found("nothing\nof numbers\n"), None);
        assert_eq!(found(""), None);
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
                assert_eq!(found(&usual.replace('\n', end)), found(&usual), "{end:?}");
            }
        }
    }
}
