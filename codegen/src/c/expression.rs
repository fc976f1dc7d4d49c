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
    ArgumentStruct, Array, Expression, Index, Notes, Operator, Place, Span, Statement,
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
    /// Number type.
    pub(super) real: String,
    /// True if the number type can be narrower than `double`. Literals are then converted.
    is_narrow: bool,
    /// Number c by which kernels round: x + c - c.
    rounding_aligner: f64,
    /// Units and terms of the named values, written as comments.
    pub(super) notes: Notes,
}

impl Writer {
    pub(super) fn new(program: &Program) -> Self {
        Self {
            prefix: format!("{}_", program.name),
            real: format!("{}_real", program.name),
            is_narrow: true,
            rounding_aligner: Double::ROUNDING_ALIGNER,
            notes: Notes::new(),
        }
    }

    /// Creates a writer of kernels in a number format.
    pub(super) fn in_format<P: CFormat>(program: &Program) -> Self {
        Self {
            real: P::NUMBER.to_owned(),
            is_narrow: P::NUMBER == "float",
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
                    text += &self.write_note(statement);
                    text += &self.sine_and_cosine(&sine_and_cosine);
                }
                None => text += &(self.write_note(statement) + &self.statement(statement)),
            }
        }
        text
    }

    /// Writes a comment with unit and terms of the value that a statement defines.
    fn write_note(&self, statement: &Statement) -> String {
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
            Statement::Zeros(name, lengths) => self.write_zeros(name, lengths),
            Statement::Flag(name) => format!("int {name} = 1;\n"),
            Statement::Assign(place, value) if place.indices.is_empty() => {
                self.set_flag(&place.name, value)
            }
            Statement::Assign(place, value) => {
                write_assignment(&write_target(place), &self.expression(value))
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
                let defined = write_assignment(&format!("{real} {name}"), &self.expression(first));
                let rest = Expression::subtract(&Expression::name(*name), product);
                let line = write_assignment(name, &self.expression(&rest));
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
            } => self.write_solution(name, factor, right, (*rows, *columns)),
        }
    }

    pub(super) fn write_definition(&self, name: &str, value: &Expression) -> String {
        let value = self.expression(value);
        write_assignment(&format!("const {} {name}", self.real), &value)
    }

    fn write_zeros(&self, name: &str, lengths: &[usize]) -> String {
        let extents: String = lengths.iter().map(|length| format!("[{length}]")).collect();
        let (open, close) = ("{".repeat(lengths.len()), "}".repeat(lengths.len()));
        format!("{} {name}{extents} = {open}0{close};\n", self.real)
    }

    /// Writes a sum in eight partial sums: sum k contains the elements k, k + 8, k + 16, ... in this order. The
    /// partial sums are then added pairwise.
    fn sum(&self, name: &str, length: usize, element: &Expression) -> String {
        let real = &self.real;
        if length == 0 {
            return format!("const {real} {name} = R(0.0);\n");
        }
        let parts = format!("{name}_parts");
        let count = length.min(PARTIAL_SUMS);
        let mut text = format!("{real} {parts}[{count}];\n");
        let first = write_assignment(&format!("{parts}[i]"), &self.expression(element));
        text += &write_loop("i", count, &first);
        // C adds from left to right, so a sum needs parentheses.
        let element = self.write_at_level(element, Level::Product);
        let blocks = length / PARTIAL_SUMS;
        let added = |first: &str, part: &str| {
            let at = format!("const int i = {first};\n");
            at + &write_assignment(
                &format!("{parts}[{part}]"),
                &format!("{parts}[{part}] + {element}"),
            )
        };
        // A single block after the first is written without a loop over blocks: gcc then vectorises the partial sums.
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
        text + &write_assignment(
            &format!("const {real} {name}"),
            &write_pairwise_sum(terms.collect()),
        )
    }

    fn write_solution(
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
                let line = write_assignment(&format!("{name}[i]"), &self.expression(value));
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
            Expression::Element(array, indices) => self.array(array) + &write_brackets(indices),
            Expression::Field(structure, name) => write_field(*structure, name),
            Expression::Shared(coefficient) => return self.write_with_level(coefficient),
            Expression::Binary(operator, a, b) => return self.write_binary(*operator, a, b),
            Expression::Negate(a) => {
                return (
                    format!("-{}", self.write_at_level(a, Level::Atom)),
                    Level::Negation,
                );
            }
            Expression::Call("chosen", parts) => self.write_conditional(parts),
            Expression::Call(name, parts) => self.function(name, parts),
            Expression::Primitive("select_equal", parts) => self.write_choice("==", parts),
            Expression::Primitive(name, parts) => self.function(name, parts),
            Expression::Select(parts) => self.write_choice(">", &**parts),
            Expression::Positive(place) => format!("((regime >> {place}) & 1U)"),
            Expression::Greater(parts) => {
                let [a, b] = &**parts;
                let text = write_infix(
                    ">",
                    self.write_at_level(a, Level::Sum),
                    self.write_at_level(b, Level::Sum),
                );
                return (text, Level::Comparison);
            }
            Expression::And(parts) => {
                let [a, b] = &**parts;
                let text = write_infix("&&", self.operand_of_and(a), self.operand_of_and(b));
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

    fn write_binary(&self, operator: Operator, a: &Expression, b: &Expression) -> (String, Level) {
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
            write_infix(
                sign,
                self.write_at_level(a, level),
                self.write_at_level(b, right),
            ),
            level,
        )
    }

    /// Writes `[a, b, then, otherwise]`: `then` if the comparison of a and b is true, else `otherwise`.
    fn write_choice(&self, comparison: &str, parts: &[Expression]) -> String {
        match parts {
            [a, b, then, otherwise] => {
                let condition = write_infix(
                    comparison,
                    self.write_at_level(a, Level::Sum),
                    self.write_at_level(b, Level::Sum),
                );
                write_ternary(
                    &condition,
                    &self.expression(then),
                    &self.expression(otherwise),
                )
            }
            _ => String::new(),
        }
    }

    /// Writes a condition as a comparison, because flags are `int` and sides of a regime are `uint32_t`.
    fn write_condition(&self, condition: &Expression) -> (String, Level) {
        let (text, level) = self.write_with_level(condition);
        match condition {
            Expression::Greater(_) | Expression::And(_) => (text, level),
            Expression::Flag(_) | Expression::True => {
                (write_infix("!=", text, "0"), Level::Comparison)
            }
            _ => (write_infix("!=", text, "0U"), Level::Comparison),
        }
    }

    fn operand_of_and(&self, operand: &Expression) -> String {
        match self.write_condition(operand) {
            (text, Level::And) => text,
            (text, _) => format!("({text})"),
        }
    }

    /// Writes statements that set a flag to 1 if a condition is true, else to 0.
    pub(super) fn set_flag(&self, target: &str, condition: &Expression) -> String {
        match condition {
            Expression::Flag(_) | Expression::True => {
                write_assignment(target, &self.expression(condition))
            }
            _ => {
                let head = format!("if ({}) {{", self.write_condition(condition).0);
                let set = |value: &str| write_assignment(target, value);
                let otherwise = block("} else {", &set("0"), "}");
                format!("{head}\n{DEEPER}{}{SHALLOWER}{otherwise}", set("1"))
            }
        }
    }

    /// Writes `[condition, then, otherwise]`.
    fn write_conditional(&self, parts: &[Expression]) -> String {
        match parts {
            [first, then, otherwise] => write_ternary(
                &self.write_condition(first).0,
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
        if self.is_narrow {
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
            Array::Coefficient(name, _) => write_field(ArgumentStruct::Coefficients, name),
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

/// Writes the pairwise sum of terms. In each round adjacent terms are added, and an odd last term is kept for the
/// next round.
fn write_pairwise_sum(mut terms: Vec<String>) -> String {
    while terms.len() > 1 {
        let last = terms.len() <= 2;
        terms = terms
            .chunks(2)
            .map(|pair| match pair {
                [a, b] if last => write_infix("+", a, b),
                [a, b] => format!("({})", write_infix("+", a, b)),
                rest => rest.concat(),
            })
            .collect();
    }
    terms.concat()
}

fn write_ternary(condition: &str, then: &str, otherwise: &str) -> String {
    format!("({FLOW}{condition}{SPACE}? {then}{SPACE}: {otherwise}{CLOSE})")
}

fn write_field(structure: ArgumentStruct, name: &str) -> String {
    let of = match structure {
        ArgumentStruct::Coefficients => "coefficients",
        ArgumentStruct::Parameters => "parameters",
        ArgumentStruct::Inputs => "inputs",
        ArgumentStruct::InputDirection => "input_direction",
        ArgumentStruct::Measured => "measured",
        ArgumentStruct::Memory => "memory",
    };
    format!("{of}->{name}")
}

pub(super) fn write_target(place: &Place) -> String {
    place.name.clone() + &write_brackets(&place.indices)
}

fn write_brackets(indices: &[Index]) -> String {
    let brackets = indices
        .iter()
        .map(|index| format!("[{}]", write_index(index)));
    brackets.collect()
}

fn write_index(index: &Index) -> String {
    match index {
        Index::Number(number) => number.to_string(),
        Index::Variable(name) => (*name).to_owned(),
        Index::Sum(a, b) => format!("{} + {}", write_index(a), write_index(b)),
        Index::Product(a, b) => format!("{} * {}", write_index(a), write_index(b)),
    }
}

/// Returns x and c if the difference is the rounding x + c - c. A rounding is written as a function call, because
/// compilers that may reorder sums would remove both operations.
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
    let (from, to) = (write_index(&span.from), write_index(&span.to));
    let head = if span.reversed {
        format!("for (int {index} = {to} - 1; {index} >= {from}; --{index}) {{")
    } else {
        format!("for (int {index} = {from}; {index} < {to}; ++{index}) {{")
    };
    block(&head, lines, "}")
}

/// Writes an assignment; `target` can contain a declaration.
pub(super) fn write_assignment(target: &str, value: &str) -> String {
    format!("{target} = {value};\n")
}

/// Writes a binary operation that can be broken before the operator.
fn write_infix(operator: &str, a: impl std::fmt::Display, b: impl std::fmt::Display) -> String {
    format!("{FLOW}{FLOW_OUT}{a}{CLOSE}{SPACE}{operator} {b}{CLOSE}")
}

/// Writes an initialiser. If the elements do not fit on one line, each has its own line.
pub(super) fn write_initialiser(items: &[String]) -> String {
    let separator = format!(",{SPACE}");
    format!(
        "{{{BLOCK}{ZERO}{}{COMMA_OUT}{CLOSE}}}",
        items.join(&separator)
    )
}
