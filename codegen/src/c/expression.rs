//! Expressions and statements as marked C text, with parentheses only as the order of evaluation requires.

use std::collections::BTreeSet;

use super::comments::clean;
use super::primitives::CFormat;
use super::sine_and_cosine::{SineAndCosine, find_pair};
use eomgen_elementary::{Double, Precision};

use crate::program::{PARTIAL_SUMS, Program};
use crate::statements::layout::{
    BLOCK, CLOSE, COMMA_OUT, DEEPER, FLOW, FLOW_OUT, SHALLOWER, SPACE, ZERO, block,
};
use crate::statements::{
    Array, Expression, Index, Notes, Operator, Place, Span, Statement, Structure,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    And,
    Comparison,
    Sum,
    Product,
    Negation,
    Atom,
}

pub(super) struct Writer {
    /// Prefix of functions, types and tables.
    prefix: String,
    /// Type of numbers.
    pub(super) real: String,
    /// True if that type can be narrower than literals, which are then converted.
    narrow: bool,
    /// Number by which kernels round.
    rounding_aligner: f64,
    /// Origin of the values of the function.
    pub(super) notes: Notes,
}

impl Writer {
    pub(super) fn new(program: &Program) -> Self {
        Self {
            prefix: format!("{}_", program.name),
            real: format!("{}_real", program.name),
            narrow: true,
            rounding_aligner: Double::ROUNDING_ALIGNER,
            notes: Notes::new(),
        }
    }

    /// Creates the writer of kernels in a format.
    pub(super) fn in_format<P: CFormat>(program: &Program) -> Self {
        Self {
            real: P::NUMBER.to_owned(),
            narrow: P::NUMBER == "float",
            rounding_aligner: P::ROUNDING_ALIGNER,
            ..Self::new(program)
        }
    }

    pub(super) fn statements(&self, statements: &[Statement]) -> String {
        let mut text = String::new();
        let mut together = BTreeSet::new();
        for (place, statement) in statements.iter().enumerate() {
            if together.contains(&place) {
                continue;
            }
            match find_pair(&statements[place..]) {
                Some((ahead, sine_and_cosine)) => {
                    together.insert(place + ahead);
                    text += &self.note(statement);
                    text += &self.sine_and_cosine(&sine_and_cosine);
                }
                None => text += &(self.note(statement) + &self.statement(statement)),
            }
        }
        text
    }

    /// Writes the origin of the value that a statement defines.
    fn note(&self, statement: &Statement) -> String {
        let note = statement.defined().and_then(|name| self.notes.get(name));
        note.map_or_else(String::new, |note| format!("/* {} */\n", clean(note)))
    }

    fn sine_and_cosine(&self, both: &SineAndCosine) -> String {
        let [sine, cosine] = [both.sine, both.cosine];
        let declared = format!("{0} {sine};\n{0} {cosine};\n", self.real);
        let argument = self.expression(both.argument);
        declared
            + &self.call_function(
                "sin_cos",
                &[argument, format!("&{sine}"), format!("&{cosine}")],
            )
    }

    fn statement(&self, statement: &Statement) -> String {
        let real = &self.real;
        match statement {
            Statement::Let(name, value) => self.write_definition(name, value),
            Statement::Zeros(name, lengths) => self.zeros(name, lengths),
            Statement::Flag(name) => format!("int {name} = 1;\n"),
            Statement::Assign(place, value) if place.indices.is_empty() => {
                self.set_flag(&place.name, value)
            }
            Statement::Assign(place, value) => {
                assignment(&place_text(place), &self.expression(value))
            }
            Statement::Loop { index, span, lines } => {
                write_loop_over(index, span, &self.statements(lines))
            }
            Statement::Remainder {
                name,
                first,
                index,
                span,
                product,
            } => {
                let defined = assignment(&format!("{real} {name}"), &self.expression(first));
                let rest = Expression::subtract(&Expression::name(*name), product);
                let line = assignment(name, &self.expression(&rest));
                defined + &write_loop_over(index, span, &line)
            }
            Statement::Sum {
                name,
                length,
                element,
            } => self.sum(name, *length, element),
            Statement::Cholesky { name, matrix, rows } => {
                let declared = format!("{real} {name}[{rows}][{rows}];\n");
                let matrix = self.matrix(matrix);
                declared
                    + &self
                        .call_function("cholesky", &[rows.to_string(), matrix, first_entry(name)])
            }
            Statement::CholeskySolve {
                name,
                factor,
                right,
                rows,
                columns,
            } => self.solution(name, factor, right, (*rows, *columns)),
        }
    }

    pub(super) fn write_definition(&self, name: &str, value: &Expression) -> String {
        let value = self.expression(value);
        assignment(&format!("const {} {name}", self.real), &value)
    }

    fn zeros(&self, name: &str, lengths: &[usize]) -> String {
        let extents: String = lengths.iter().map(|length| format!("[{length}]")).collect();
        let (open, close) = ("{".repeat(lengths.len()), "}".repeat(lengths.len()));
        format!("{} {name}{extents} = {open}0{close};\n", self.real)
    }

    /// Writes a sum: each of the first elements begins a partial sum, every eighth element after it is added
    /// in order, then neighbours are added in pairs.
    fn sum(&self, name: &str, length: usize, element: &Expression) -> String {
        let real = &self.real;
        if length == 0 {
            return format!("const {real} {name} = R(0.0);\n");
        }
        let parts = format!("{name}_parts");
        let count = length.min(PARTIAL_SUMS);
        let mut text = format!("{real} {parts}[{count}];\n");
        let first = assignment(&format!("{parts}[i]"), &self.expression(element));
        text += &write_loop("i", count, &first);
        // C adds from left to right, so a sum needs parentheses.
        let element = self.write_at_level(element, Level::Product);
        let blocks = length / PARTIAL_SUMS;
        let added = |first: &str, part: &str| {
            let at = format!("const int i = {first};\n");
            at + &assignment(
                &format!("{parts}[{part}]"),
                &format!("{parts}[{part}] + {element}"),
            )
        };
        // One block is written without a loop over blocks: gcc then vectorises the partial sums.
        if blocks == 2 {
            let first = format!("{PARTIAL_SUMS} + k");
            text += &write_loop("k", PARTIAL_SUMS, &added(&first, "k"));
        } else if blocks > 2 {
            let inner = write_loop("k", PARTIAL_SUMS, &added("first + k", "k"));
            let head = format!(
                "for (int first = {PARTIAL_SUMS}; first < {}; first += {PARTIAL_SUMS}) {{",
                blocks * PARTIAL_SUMS
            );
            text += &block(&head, &inner, "}");
        }
        let rest = length - blocks * PARTIAL_SUMS;
        if blocks > 0 && rest > 0 {
            let first = format!("{} + k", blocks * PARTIAL_SUMS);
            text += &write_loop("k", rest, &added(&first, "k"));
        }
        let terms = (0..count).map(|place| format!("{parts}[{place}]"));
        text + &assignment(&format!("const {real} {name}"), &in_pairs(terms.collect()))
    }

    fn solution(
        &self,
        name: &str,
        factor: &Array,
        right: &Array,
        (rows, columns): (usize, Option<usize>),
    ) -> String {
        let real = &self.real;
        let factor = self.matrix(factor);
        let count = columns.unwrap_or(1);
        let (declared, solution) = match columns {
            Some(columns) => (
                format!("{real} {name}[{rows}][{columns}];\n"),
                first_entry(name),
            ),
            None => (format!("{real} {name}[{rows}];\n"), name.to_owned()),
        };
        let (filled, right) = match (right, columns) {
            (Array::Filled(value, length), _) => {
                let line = assignment(&format!("{name}[i]"), &self.expression(value));
                (write_loop("i", *length, &line), name.to_owned())
            }
            (matrix, Some(_)) => (String::new(), self.matrix(matrix)),
            (vector, None) => (String::new(), self.array(vector)),
        };
        let arguments = [rows.to_string(), count.to_string(), factor, right, solution];
        declared + &filled + &self.call_function("cholesky_solve", &arguments)
    }

    fn call_function(&self, function: &str, arguments: &[String]) -> String {
        call(&format!("{}{function}", self.prefix), arguments) + ";\n"
    }

    /// Writes an expression without outer parentheses.
    pub(super) fn expression(&self, expression: &Expression) -> String {
        self.write_with_level(expression).0
    }

    fn expressions(&self, expressions: &[Expression]) -> Vec<String> {
        expressions.iter().map(|e| self.expression(e)).collect()
    }

    fn write_at_level(&self, expression: &Expression, level: Level) -> String {
        let (text, own) = self.write_with_level(expression);
        if own < level {
            format!("({text})")
        } else {
            text
        }
    }

    fn write_with_level(&self, expression: &Expression) -> (String, Level) {
        let text = match expression {
            Expression::Number(value) => return self.number(*value),
            Expression::Name(name) | Expression::Flag(name) => name.clone(),
            Expression::Element(Array::Filled(value, _), _) => return self.write_with_level(value),
            Expression::Element(array, indices) => self.array(array) + &brackets(indices),
            Expression::Field(structure, name) => field(*structure, name),
            Expression::Shared(coefficient) => return self.write_with_level(coefficient),
            Expression::Binary(operator, a, b) => return self.binary(*operator, a, b),
            Expression::Negate(a) => {
                return (
                    format!("-{}", self.write_at_level(a, Level::Atom)),
                    Level::Negation,
                );
            }
            Expression::Call("chosen", parts) => self.conditional(parts),
            Expression::Call(name, parts) => self.function(name, parts),
            Expression::Primitive("select_equal", parts) => self.choice("==", parts),
            Expression::Primitive(name, parts) => self.function(name, parts),
            Expression::Select(parts) => self.choice(">", &**parts),
            Expression::Positive(place) => format!("((regime >> {place}) & 1U)"),
            Expression::Greater(parts) => {
                let [a, b] = &**parts;
                let text = infix(
                    ">",
                    self.write_at_level(a, Level::Sum),
                    self.write_at_level(b, Level::Sum),
                );
                return (text, Level::Comparison);
            }
            Expression::And(parts) => {
                let [a, b] = &**parts;
                let text = infix("&&", self.operand_of_and(a), self.operand_of_and(b));
                return (text, Level::And);
            }
            Expression::True => "1".to_owned(),
        };
        (text, Level::Atom)
    }

    fn function(&self, name: &str, arguments: &[Expression]) -> String {
        call(
            &format!("{}{name}", self.prefix),
            &self.expressions(arguments),
        )
    }

    fn binary(&self, operator: Operator, a: &Expression, b: &Expression) -> (String, Level) {
        if let Some((x, aligner)) = rounding_operand(operator, a, b) {
            let function = match aligner / self.rounding_aligner {
                1.0 => Some("nearest_integer"),
                4.0 => Some("nearest_multiple_of_four"),
                _ => None,
            };
            if let Some(function) = function {
                let function = format!("{}{function}", self.prefix);
                return (call(&function, &[self.expression(x)]), Level::Atom);
            }
        }
        let (sign, level, right) = match operator {
            Operator::Add => ("+", Level::Sum, Level::Product),
            Operator::Subtract => ("-", Level::Sum, Level::Product),
            Operator::Multiply => ("*", Level::Product, Level::Negation),
            Operator::Divide => ("/", Level::Product, Level::Negation),
        };
        (
            infix(
                sign,
                self.write_at_level(a, level),
                self.write_at_level(b, right),
            ),
            level,
        )
    }

    /// Writes `[a, b, then, otherwise]`: `then` if the comparison of a and b is true, else `otherwise`.
    fn choice(&self, comparison: &str, parts: &[Expression]) -> String {
        match parts {
            [a, b, then, otherwise] => {
                let condition = infix(
                    comparison,
                    self.write_at_level(a, Level::Sum),
                    self.write_at_level(b, Level::Sum),
                );
                ternary(
                    &condition,
                    &self.expression(then),
                    &self.expression(otherwise),
                )
            }
            _ => String::new(),
        }
    }

    /// Writes a condition, which has the type of a comparison: flags are `int`, sides of a regime are `uint32_t`.
    fn condition(&self, condition: &Expression) -> (String, Level) {
        let (text, level) = self.write_with_level(condition);
        match condition {
            Expression::Greater(_) | Expression::And(_) => (text, level),
            Expression::Flag(_) | Expression::True => (infix("!=", text, "0"), Level::Comparison),
            _ => (infix("!=", text, "0U"), Level::Comparison),
        }
    }

    fn operand_of_and(&self, operand: &Expression) -> String {
        match self.condition(operand) {
            (text, Level::And) => text,
            (text, _) => format!("({text})"),
        }
    }

    /// Writes statements that set a flag to 1 if a condition is true, else to 0.
    pub(super) fn set_flag(&self, target: &str, condition: &Expression) -> String {
        match condition {
            Expression::Flag(_) | Expression::True => {
                assignment(target, &self.expression(condition))
            }
            _ => {
                let head = format!("if ({}) {{", self.condition(condition).0);
                let set = |value: &str| assignment(target, value);
                let otherwise = block("} else {", &set("0"), "}");
                format!("{head}\n{DEEPER}{}{SHALLOWER}{otherwise}", set("1"))
            }
        }
    }

    /// Writes `[condition, then, otherwise]`.
    fn conditional(&self, parts: &[Expression]) -> String {
        match parts {
            [first, then, otherwise] => ternary(
                &self.condition(first).0,
                &self.expression(then),
                &self.expression(otherwise),
            ),
            _ => String::new(),
        }
    }

    fn number(&self, value: f64) -> (String, Level) {
        let literal = if value.is_nan() {
            format!("{}nan()", self.prefix)
        } else if value.is_infinite() {
            let sign = if value > 0.0 { "" } else { "-" };
            format!("{sign}{}infinity()", self.prefix)
        } else {
            number(value)
        };
        if self.narrow {
            (format!("R({literal})"), Level::Atom)
        } else if value.is_sign_negative() {
            (literal, Level::Negation)
        } else {
            (literal, Level::Atom)
        }
    }

    pub(super) fn array(&self, array: &Array) -> String {
        match array {
            Array::Local(name) => name.clone(),
            Array::Coefficient(name, _) => field(Structure::Coefficients, name),
            Array::Table(name, _) => format!("{}{name}", self.prefix),
            Array::Filled(value, _) => self.expression(value),
        }
    }

    /// Returns the address of a matrix's first entry.
    fn matrix(&self, array: &Array) -> String {
        first_entry(&self.array(array))
    }
}

fn first_entry(matrix: &str) -> String {
    format!("&{matrix}[0][0]")
}

/// Writes a finite number with all its bits.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e7).contains(&magnitude) {
        format!("{value:?}")
    } else {
        format!("{value:e}")
    }
}

/// Adds neighbours in pairs until one is left; an odd last number moves on to the next round.
fn in_pairs(mut terms: Vec<String>) -> String {
    while terms.len() > 1 {
        let last = terms.len() <= 2;
        terms = terms
            .chunks(2)
            .map(|pair| match pair {
                [a, b] if last => infix("+", a, b),
                [a, b] => format!("({})", infix("+", a, b)),
                rest => rest.concat(),
            })
            .collect();
    }
    terms.concat()
}

fn ternary(condition: &str, then: &str, otherwise: &str) -> String {
    format!("({FLOW}{condition}{SPACE}? {then}{SPACE}: {otherwise}{CLOSE})")
}

fn field(structure: Structure, name: &str) -> String {
    let of = match structure {
        Structure::Coefficients => "coefficients",
        Structure::Parameters => "parameters",
        Structure::Inputs => "inputs",
        Structure::InputDirection => "input_direction",
        Structure::Measured => "measured",
        Structure::Memory => "memory",
    };
    format!("{of}->{name}")
}

pub(super) fn place_text(place: &Place) -> String {
    place.name.clone() + &brackets(&place.indices)
}

fn brackets(indices: &[Index]) -> String {
    let brackets = indices
        .iter()
        .map(|index| format!("[{}]", index_text(index)));
    brackets.collect()
}

fn index_text(index: &Index) -> String {
    match index {
        Index::Number(number) => number.to_string(),
        Index::Variable(name) => (*name).to_owned(),
        Index::Sum(a, b) => format!("{} + {}", index_text(a), index_text(b)),
        Index::Product(a, b) => format!("{} * {}", index_text(a), index_text(b)),
    }
}

/// Returns x and c if the difference is x + c - c. A rounding is written as a call, because compilers that may
/// reorder sums remove both operations.
fn rounding_operand<'e>(
    operator: Operator,
    a: &'e Expression,
    b: &Expression,
) -> Option<(&'e Expression, f64)> {
    match (operator, a) {
        (Operator::Subtract, Expression::Binary(Operator::Add, x, added)) => match (&**added, b) {
            (Expression::Number(added), Expression::Number(subtracted)) => {
                (added == subtracted).then_some((x, *added))
            }
            _ => None,
        },
        _ => None,
    }
}

pub(super) fn call(name: &str, arguments: &[String]) -> String {
    let separator = format!(",{SPACE}");
    format!("{name}({FLOW}{ZERO}{}{CLOSE})", arguments.join(&separator))
}

pub(super) fn write_loop(index: &str, length: usize, lines: &str) -> String {
    write_loop_over(index, &Span::between(0, length), lines)
}

fn write_loop_over(index: &str, span: &Span, lines: &str) -> String {
    let (from, to) = (index_text(&span.from), index_text(&span.to));
    let head = if span.reversed {
        format!("for (int {index} = {to} - 1; {index} >= {from}; --{index}) {{")
    } else {
        format!("for (int {index} = {from}; {index} < {to}; ++{index}) {{")
    };
    block(&head, lines, "}")
}

/// Writes an assignment; `target` can contain a declaration.
pub(super) fn assignment(target: &str, value: &str) -> String {
    format!("{target} = {value};\n")
}

/// Writes a binary operation that can be broken before the operator.
fn infix(operator: &str, a: impl std::fmt::Display, b: impl std::fmt::Display) -> String {
    format!("{FLOW}{FLOW_OUT}{a}{CLOSE}{SPACE}{operator} {b}{CLOSE}")
}

/// Writes an initialiser; elements that do not fit on one line have one line each.
pub(super) fn initialiser(items: &[String]) -> String {
    let separator = format!(",{SPACE}");
    format!(
        "{{{BLOCK}{ZERO}{}{COMMA_OUT}{CLOSE}}}",
        items.join(&separator)
    )
}
