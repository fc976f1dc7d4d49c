//! Layout of emitted source. Lines that are too long are broken at their groups, outermost first (Oppen,
//! "Prettyprinting", 1980), with the widths and rules of `prettyplease`, which tests compare with.
//!
//! Marked text is source with control characters that open and close groups and mark possible line ends.
//! Lines without marks are copied.

/// Target width of a line, in characters.
const WIDTH: isize = 89;

/// Smallest text width of a deeply indented line, in characters.
const MIN_WIDTH: isize = 60;

const INDENT: isize = 4;

/// Opens a group that breaks only where a line is full. Its lines after the first are indented.
pub const FLOW: char = '\u{1}';
/// [`FLOW`] that removes the indentation of the enclosing group.
pub const FLOW_OUT: char = '\u{2}';
/// [`FLOW`] at the indentation of the enclosing group.
pub const FLOW_EVEN: char = '\u{3}';
/// Opens a group that breaks at all its marks or at none. Its lines after the first are indented.
pub const BLOCK: char = '\u{4}';
/// [`BLOCK`] that removes the indentation of the enclosing group.
pub const BLOCK_OUT: char = '\u{5}';
/// [`BLOCK`] at the indentation of the enclosing group.
pub const BLOCK_EVEN: char = '\u{6}';
/// Closes a group.
pub const CLOSE: char = '\u{7}';
/// A space, or a line end.
pub const SPACE: char = '\u{8}';
/// A space, or a line end that also ends the group's indentation.
pub const SPACE_OUT: char = '\u{11}';
/// Nothing, or a line end that also ends the group's indentation.
pub const ZERO_OUT: char = '\u{16}';
/// Nothing, or a line end.
pub const ZERO: char = '\u{12}';
/// Nothing, or a comma and a line end that also ends the group's indentation.
pub const COMMA_OUT: char = '\u{e}';
/// Nothing, or an opening brace and a line end.
pub const BRACE: char = '\u{14}';
/// Nothing, or a line end that also ends the group's indentation, and a closing brace.
pub const BRACE_OUT: char = '\u{15}';
/// No line end; the text before it is laid out independently of the text after it.
pub const LAYOUT_BOUNDARY: char = '\u{13}';
/// At the start of a line: indents this line and those after it by one more level.
pub const DEEPER: char = '\u{f}';
/// At the start of a line: indents this line and those after it by one level less.
pub const SHALLOWER: char = '\u{10}';

/// Returns `lines`, one level deeper, between `opening` and `closing`.
pub fn block(opening: &str, lines: &str, closing: &str) -> String {
    if lines.is_empty() {
        return format!("{opening}{closing}\n");
    }
    format!("{opening}\n{DEEPER}{lines}{SHALLOWER}{closing}\n")
}

/// Lays out marked text, with an empty line before every documented item.
pub fn source(marked: &str) -> String {
    let mut printer = Printer::new(marked.len());
    let mut documented = true;
    for line in marked.lines() {
        let line = printer.indentation(line);
        let doc = printer.level == 0 && (line.starts_with("///") || line.starts_with("/**"));
        let header = line.starts_with("#![") || line.starts_with("//!");
        if (doc && !documented) || (!header && printer.in_header) {
            printer.out.push('\n');
        }
        printer.in_header = header && line.starts_with("#![");
        documented = doc || printer.out.is_empty();
        printer.line(line);
    }
    printer.out
}

#[derive(Clone, Copy)]
enum Token<'a> {
    Text(&'a str),
    Open {
        indent: isize,
        everywhere: bool,
    },
    Close,
    Break {
        blank: isize,
        offset: isize,
        /// Text before and after the line end, if the line ends here.
        around: [&'a str; 2],
    },
    Firm,
}

enum Frame {
    Fits,
    Broken { outer: isize, everywhere: bool },
}

struct Printer<'a> {
    out: String,
    level: isize,
    in_header: bool,
    tokens: Vec<Token<'a>>,
    /// Width from the start of each token to the next possible line end after it.
    widths: Vec<isize>,
    open: Vec<usize>,
    frames: Vec<Frame>,
}

impl<'a> Printer<'a> {
    fn new(length: usize) -> Self {
        Self {
            out: String::with_capacity(length),
            level: 0,
            in_header: false,
            tokens: Vec::new(),
            widths: Vec::new(),
            open: Vec::new(),
            frames: Vec::new(),
        }
    }

    /// Applies the indentation marks at the start of a line and returns the rest of the line.
    fn indentation(&mut self, line: &'a str) -> &'a str {
        let rest = line.trim_start_matches([DEEPER, SHALLOWER]);
        for mark in line[..line.len() - rest.len()].chars() {
            self.level += if mark == DEEPER { 1 } else { -1 };
        }
        rest
    }

    fn line(&mut self, line: &'a str) {
        if !line.is_empty() {
            let indent = self.level * INDENT;
            self.blanks(indent);
            if line.bytes().any(is_mark) {
                self.scan(line);
                self.measure();
                self.print(indent);
            } else {
                self.out.push_str(line);
            }
        }
        self.out.push('\n');
    }

    fn blanks(&mut self, count: isize) {
        self.out.extend((0..count).map(|_| ' '));
    }

    fn scan(&mut self, line: &'a str) {
        self.tokens.clear();
        let mut start = 0;
        for (place, byte) in line.bytes().enumerate() {
            if is_mark(byte) {
                if start < place {
                    self.tokens.push(Token::Text(&line[start..place]));
                }
                self.tokens.push(Token::mark(char::from(byte)));
                start = place + 1;
            }
        }
        if start < line.len() {
            self.tokens.push(Token::Text(&line[start..]));
        }
    }

    /// Computes the widths of groups and breaks. The width of a token is known at the next break outside the groups
    /// that are opened after the token.
    fn measure(&mut self) {
        self.widths.clear();
        let mut total = 0;
        for place in 0..self.tokens.len() {
            let token = self.tokens[place];
            if let Token::Break { .. } | Token::Firm = token {
                self.settle(total);
            }
            self.widths.push(-total);
            match token {
                Token::Text(text) => total += text.len() as isize,
                Token::Break { blank, .. } => {
                    self.open.push(place);
                    total += blank;
                }
                Token::Open { .. } | Token::Close | Token::Firm => self.open.push(place),
            }
        }
        self.settle(total);
        self.open.clear();
    }

    fn settle(&mut self, total: isize) {
        let mut depth = 0;
        while let Some(&place) = self.open.last() {
            match self.tokens[place] {
                Token::Open { .. } if depth == 0 => return,
                Token::Open { .. } => depth -= 1,
                Token::Close => depth += 1,
                _ => {}
            }
            self.open.pop();
            self.widths[place] += total;
            if depth == 0 && matches!(self.tokens[place], Token::Break { .. } | Token::Firm) {
                return;
            }
        }
    }

    fn print(&mut self, indent: isize) {
        let mut indent = indent;
        let mut room = (WIDTH - indent).max(MIN_WIDTH);
        self.frames.clear();
        for place in 0..self.tokens.len() {
            let width = self.widths[place];
            match self.tokens[place] {
                Token::Text(text) => {
                    self.out.push_str(text);
                    room -= text.len() as isize;
                }
                Token::Open {
                    indent: by,
                    everywhere,
                } if width > room => {
                    self.frames.push(Frame::Broken {
                        outer: indent,
                        everywhere,
                    });
                    indent += by;
                }
                Token::Open { .. } => self.frames.push(Frame::Fits),
                Token::Firm => {}
                Token::Close => {
                    if let Some(Frame::Broken { outer, .. }) = self.frames.pop() {
                        indent = outer;
                    }
                }
                Token::Break {
                    blank,
                    offset,
                    around,
                } => {
                    let ends = match self.frames.last() {
                        Some(Frame::Fits) => false,
                        Some(Frame::Broken {
                            everywhere: true, ..
                        }) => true,
                        _ => width > room,
                    };
                    if ends {
                        self.out.push_str(around[0]);
                        self.out.push('\n');
                        self.blanks(indent + offset);
                        self.out.push_str(around[1]);
                        room = (WIDTH - indent - offset).max(MIN_WIDTH);
                        room -= around[1].len() as isize;
                    } else {
                        self.blanks(blank);
                        room -= blank;
                    }
                }
            }
        }
    }
}

/// Returns true for the marks inside a line.
fn is_mark(byte: u8) -> bool {
    byte < 0x20
}

impl Token<'_> {
    fn mark(mark: char) -> Self {
        let open = |indent, everywhere| Self::Open { indent, everywhere };
        let ends = |blank, offset, around| Self::Break {
            blank,
            offset,
            around,
        };
        match mark {
            FLOW => open(INDENT, false),
            FLOW_OUT => open(-INDENT, false),
            FLOW_EVEN => open(0, false),
            BLOCK => open(INDENT, true),
            BLOCK_OUT => open(-INDENT, true),
            BLOCK_EVEN => open(0, true),
            SPACE => ends(1, 0, [""; 2]),
            SPACE_OUT => ends(1, -INDENT, [""; 2]),
            ZERO => ends(0, 0, [""; 2]),
            ZERO_OUT => ends(0, -INDENT, [""; 2]),
            COMMA_OUT => ends(0, -INDENT, [",", ""]),
            BRACE => ends(0, 0, ["{", ""]),
            BRACE_OUT => ends(0, -INDENT, ["", "}"]),
            LAYOUT_BOUNDARY => Self::Firm,
            _ => Self::Close,
        }
    }
}
