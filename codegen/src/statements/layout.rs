//! Lines of emitted source from marked text: where an expression is too long for its line
//! it is broken at its groups, outermost first, as formatters of Rust do it (Oppen, "Prettyprinting",
//! 1980; widths and rules are those of `prettyplease`, which tests compare with).
//!
//! Marked text is source with control characters in it that open and close groups and say
//! where a line may end. Lines that need no decision hold none and pass through as they are.

/// The width lines are kept to where they can be.
const WIDTH: isize = 89;

/// The least width a deeply indented line is given.
const LEAST_WIDTH: isize = 60;

/// One level of indentation.
const INDENT: isize = 4;

/// Opens a group that breaks only where its line is full; its further lines are indented.
pub const FLOW: char = '\u{1}';
/// The same, with the indentation of the group around it taken back.
pub const FLOW_OUT: char = '\u{2}';
/// The same, at the indentation of the group around it.
pub const FLOW_EVEN: char = '\u{3}';
/// Opens a group that breaks everywhere or nowhere; its further lines are indented.
pub const BLOCK: char = '\u{4}';
/// The same, with the indentation of the group around it taken back.
pub const BLOCK_OUT: char = '\u{5}';
/// The same, at the indentation of the group around it.
pub const BLOCK_EVEN: char = '\u{6}';
/// Closes a group.
pub const CLOSE: char = '\u{7}';
/// A space, or the end of a line.
pub const SPACE: char = '\u{8}';
/// A space, or the end of a line after which the group's indentation ends.
pub const SPACE_OUT: char = '\u{11}';
/// Nothing, or the end of a line after which the group's indentation ends.
pub const ZERO_OUT: char = '\u{16}';
/// Nothing, or the end of a line.
pub const ZERO: char = '\u{12}';
/// Nothing, or a comma and the end of a line after which the group's indentation ends.
pub const COMMA_OUT: char = '\u{e}';
/// Nothing, or an opening brace and the end of a line.
pub const BRACE: char = '\u{14}';
/// Nothing, or the end of a line after which the group's indentation ends and a closing
/// brace.
pub const BRACE_OUT: char = '\u{15}';
/// Nothing, and no end of a line; what stands before is laid out without regard to what
/// follows.
pub const FIRM: char = '\u{13}';
/// At the start of a line: this line and those after it stand one level deeper.
pub const DEEPER: char = '\u{f}';
/// At the start of a line: this line and those after it stand one level less deep.
pub const SHALLOWER: char = '\u{10}';

/// Lines one level deeper, between a line that opens a block and one that closes it.
pub fn block(opening: &str, lines: &str, closing: &str) -> String {
    if lines.is_empty() {
        return format!("{opening}{closing}\n");
    }
    format!("{opening}\n{DEEPER}{lines}{SHALLOWER}{closing}\n")
}

/// The source that marked text stands for, with an empty line before every documented
/// item, as a person would set it.
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
        /// What stands before and after the end of the line if it ends here.
        around: [&'a str; 2],
    },
    Firm,
}

/// A group being printed.
enum Frame {
    Fits,
    Broken { outer: isize, everywhere: bool },
}

struct Printer<'a> {
    out: String,
    level: isize,
    in_header: bool,
    tokens: Vec<Token<'a>>,
    /// For each token its width up to the next place where the line may end outside of it.
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

    /// Follows the marks of indentation at the start of a line; what is left of it.
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

    /// The widths of groups and breaks: each is known at the next break that stands in no
    /// group opened after it.
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
        let mut room = (WIDTH - indent).max(LEAST_WIDTH);
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
                        room = (WIDTH - indent - offset).max(LEAST_WIDTH);
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

/// Whether a byte of marked text is a mark inside a line.
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
            FIRM => Self::Firm,
            _ => Self::Close,
        }
    }
}
