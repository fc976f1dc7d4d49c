//! Expressions and statements as marked Rust text, with parentheses only as the order of evaluation requires.

use super::literals::number;
use crate::program::{Extent, PARTIAL_SUMS};
use crate::statements::layout::block;
use crate::statements::layout::{
    BLOCK, BLOCK_OUT, BRACE, BRACE_OUT, CLOSE, COMMA_OUT, FLOW, FLOW_EVEN, FLOW_OUT,
    LAYOUT_BOUNDARY, SPACE, SPACE_OUT, ZERO,
};
use crate::statements::{
    ArgumentStruct, Array, Expression, Index, Notes, Operator, Place, Span, Statement,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    And,
    Sum,
    Product,
    Negation,
    Atom,
}

/// Array conversions that the file uses.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Conversions {
    /// True if vectors are converted to another number type.
    pub(super) converted: bool,
    /// True if matrices are converted to another number type.
    pub(super) converted_matrix: bool,
    /// True if whole vectors of coefficients are read.
    pub(super) read_array: bool,
    /// True if whole matrices of coefficients are read.
    pub(super) read_matrix: bool,
}

#[derive(Debug, Default)]
pub(super) struct Writer {
    /// True if coefficients are read for SIMD lanes.
    pub(super) lanes: bool,
    pub(super) conversions: Conversions,
    /// Units and terms of the named values in the current function.
    pub(super) notes: Notes,
}

impl Writer {
    pub(super) fn statements(&mut self, statements: &[Statement]) -> String {
        let mut text = String::new();
        for statement in statements {
            if let Some(note) = statement.defined().and_then(|name| self.notes.get(name)) {
                text += &format!("// {note}\n");
            }
            text += &self.statement(statement);
        }
        text
    }

    fn statement(&mut self, statement: &Statement) -> String {
        match statement {
            Statement::Let(name, value) => self.write_definition(name, value),
            Statement::Zeros(name, lengths) => {
                let lengths: Vec<String> = lengths.iter().map(usize::to_string).collect();
                zeros(name, &lengths)
            }
            Statement::Flag(name) => format!("let mut {name} = true;\n"),
            Statement::Assign(place, value) => {
                write_assignment(&write_target(place), self.expression(value)) + "\n"
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
                let defined = write_assignment(&format!("let mut {name}"), self.expression(first));
                let rest = Expression::subtract(&Expression::name(*name), product);
                let line = write_assignment(name, self.expression(&rest)) + "\n";
                defined + "\n" + &write_loop_over(index, span, &line)
            }
            Statement::Sum {
                name,
                length,
                element,
            } => {
                let function = if *length > PARTIAL_SUMS {
                    "sum"
                } else {
                    "sum_of_few"
                };
                let sum = self.write_sum(function, *length, element);
                write_assignment(&format!("let {name}"), sum) + "\n"
            }
            Statement::Cholesky { name, matrix, .. } => {
                let matrix = reference(self.array(matrix));
                let factor = call("cholesky", &[matrix]);
                write_assignment(&format!("let {name}"), factor) + "\n"
            }
            Statement::CholeskySolve {
                name,
                factor,
                right,
                columns,
                ..
            } => {
                let function = match columns {
                    Some(_) => "cholesky_solve_matrix",
                    None => "cholesky_solve",
                };
                let operands = [factor, right].map(|array| reference(self.array(array)));
                let solution = call(function, &operands);
                write_assignment(&format!("let {name}"), solution) + "\n"
            }
        }
    }

    pub(super) fn write_definition(&mut self, name: &str, value: &Expression) -> String {
        write_assignment(&format!("let {name}"), self.expression(value)) + "\n"
    }

    /// Writes an expression without outer parentheses.
    pub(super) fn expression(&mut self, expression: &Expression) -> String {
        self.write_with_level(expression).0
    }

    pub(super) fn expressions(&mut self, expressions: &[Expression]) -> Vec<String> {
        expressions.iter().map(|e| self.expression(e)).collect()
    }

    fn write_at_level(&mut self, expression: &Expression, level: Level) -> String {
        let (text, own) = self.write_with_level(expression);
        if own < level {
            format!("({text})")
        } else {
            text
        }
    }

    fn write_with_level(&mut self, expression: &Expression) -> (String, Level) {
        let text = match expression {
            Expression::Number(value) => convert_number(&number(*value)),
            Expression::Name(name) | Expression::Flag(name) => name.clone(),
            Expression::Element(array, indices) => self.write_element(array, indices),
            Expression::Field(structure, name) => write_field(structure_name(*structure), name),
            Expression::Shared(coefficient) => call("C::read", &[self.expression(coefficient)]),
            Expression::Binary(operator, a, b) => return self.write_binary(*operator, a, b),
            Expression::Negate(a) => {
                return (
                    format!("-{}", self.write_at_level(a, Level::Atom)),
                    Level::Negation,
                );
            }
            Expression::Call(name, arguments) => call(name, &self.expressions(arguments)),
            Expression::Select(parts) => call("T::select_greater", &self.expressions(&**parts)),
            Expression::Primitive(name, arguments) => {
                call(&format!("T::{name}"), &self.expressions(arguments))
            }
            Expression::Positive(place) => {
                call("positive", &["REGIME".to_owned(), place.to_string()])
            }
            Expression::Greater(parts) => call("T::all_greater", &self.expressions(&**parts)),
            Expression::And(parts) => {
                let [a, b] = &**parts;
                let text = write_infix(
                    "&&",
                    self.write_at_level(a, Level::And),
                    self.write_at_level(b, Level::Atom),
                );
                return (text, Level::And);
            }
            Expression::True => "true".to_owned(),
        };
        (text, Level::Atom)
    }

    fn write_binary(
        &mut self,
        operator: Operator,
        a: &Expression,
        b: &Expression,
    ) -> (String, Level) {
        let (sign, level, right) = match operator {
            Operator::Add => ("+", Level::Sum, Level::Product),
            Operator::Subtract => ("-", Level::Sum, Level::Product),
            Operator::Multiply => ("*", Level::Product, Level::Negation),
            Operator::Divide => ("/", Level::Product, Level::Negation),
        };
        let (a, b) = (self.write_at_level(a, level), self.write_at_level(b, right));
        (write_infix(sign, a, b), level)
    }

    /// Writes an element; an entry of a table is converted to the scalar type.
    fn write_element(&mut self, array: &Array, indices: &[Index]) -> String {
        let brackets: Vec<String> = indices.iter().map(write_index).collect();
        let brackets = brackets.join("][");
        match array {
            Array::Table(name, _) => convert_number(&format!("{name}[{brackets}]")),
            Array::Coefficient(name, _) => {
                format!("{}[{brackets}]", write_field("coefficients", name))
            }
            Array::Local(name) => format!("{name}[{brackets}]"),
            Array::Filled(value, _) => self.expression(value),
        }
    }

    pub(super) fn array(&mut self, array: &Array) -> String {
        match array {
            Array::Local(name) => name.clone(),
            Array::Filled(value, length) => format!("[{}; {length}]", self.expression(value)),
            Array::Table(name, extent) => {
                let function = if matches!(extent, Extent::Vector(_)) {
                    self.conversions.converted = true;
                    "converted"
                } else {
                    self.conversions.converted_matrix = true;
                    "converted_matrix"
                };
                format!("{function}(&{name})")
            }
            Array::Coefficient(name, extent) => {
                let field = write_field("coefficients", name);
                if !self.lanes {
                    return field;
                }
                let function = if matches!(extent, Extent::Matrix(..)) {
                    self.conversions.read_matrix = true;
                    "read_matrix"
                } else {
                    self.conversions.read_array = true;
                    "read_array"
                };
                call(function, &[reference(field)])
            }
        }
    }

    /// Writes the call of a function that sums `length` elements. The length is passed as the type of an array, so
    /// that it is known at compile time.
    fn write_sum(&mut self, function: &str, length: usize, element: &Expression) -> String {
        let (element, level) = self.write_with_level(element);
        let body = if level == Level::Atom && element.ends_with(')') {
            element
        } else {
            format!("{BLOCK}{BRACE}{element}{BRACE_OUT}{CLOSE}")
        };
        let closure =
            format!("{FLOW_EVEN}{BLOCK}|{ZERO}i|{SPACE_OUT}{CLOSE}{LAYOUT_BOUNDARY}{body}{CLOSE}");
        call(function, &[format!("[(); {length}]"), closure])
    }
}

pub(super) fn zeros(name: &str, lengths: &[String]) -> String {
    let zero = "T::number(0.0)".to_owned();
    let value = lengths
        .iter()
        .rev()
        .fold(zero, |inner, length| format!("[{inner}; {length}]"));
    format!("let mut {name} = {value};\n")
}

/// Converts an `f64`, a literal or a table entry, to the scalar type.
fn convert_number(number: &str) -> String {
    call("T::number", &[number.to_owned()])
}

fn write_field(of: &str, name: &str) -> String {
    format!("{BLOCK}{BLOCK_OUT}{of}{CLOSE}{ZERO}.{name}{CLOSE}")
}

fn structure_name(structure: ArgumentStruct) -> &'static str {
    match structure {
        ArgumentStruct::Coefficients => "coefficients",
        ArgumentStruct::Parameters => "parameters",
        ArgumentStruct::Inputs => "inputs",
        ArgumentStruct::InputDirection => "input_direction",
        ArgumentStruct::Measured => "measured",
        ArgumentStruct::Memory => "memory",
    }
}

fn write_target(place: &Place) -> String {
    let mut text = place.name.clone();
    for index in &place.indices {
        text.push_str(&format!("[{}]", write_index(index)));
    }
    text
}

fn write_index(index: &Index) -> String {
    match index {
        Index::Number(number) => number.to_string(),
        Index::Variable(name) => (*name).to_owned(),
        Index::Sum(a, b) => write_infix("+", write_index(a), write_index(b)),
        Index::Product(a, b) => write_infix("*", write_index(a), write_index(b)),
    }
}

pub(super) fn call(name: &str, arguments: &[String]) -> String {
    format!(
        "{name}({BLOCK}{ZERO}{}{COMMA_OUT}{CLOSE})",
        array_items(arguments)
    )
}

pub(super) fn write_loop(index: &str, length: usize, lines: &str) -> String {
    write_loop_over(index, &Span::between(0, length), lines)
}

fn write_loop_over(index: &str, span: &Span, lines: &str) -> String {
    let indices = format!("{}..{}", write_index(&span.from), write_index(&span.to));
    let head = if span.reversed {
        format!("for {index} in ({indices}).rev() {{")
    } else {
        format!("for {index} in {indices} {{")
    };
    block(&head, lines, "}")
}

/// Writes a binary operation that can be broken before the operator.
fn write_infix(operator: &str, a: impl std::fmt::Display, b: impl std::fmt::Display) -> String {
    format!("{FLOW}{FLOW_OUT}{a}{CLOSE}{SPACE}{operator} {b}{CLOSE}")
}

/// Writes an assignment; `target` can contain a declaration.
pub(super) fn write_assignment(target: &str, value: impl std::fmt::Display) -> String {
    format!("{target} = {LAYOUT_BOUNDARY}{value};")
}

/// Joins elements of an array or a call. If they do not fit on one line, each has its own line.
fn array_items(items: &[String]) -> String {
    let mut text = String::new();
    for (place, item) in items.iter().enumerate() {
        if place > 0 {
            text.push(',');
            text.push(SPACE);
        }
        text.push_str(item);
    }
    text
}

pub(super) fn array(items: &[String]) -> String {
    if items.is_empty() {
        return "[]".to_owned();
    }
    format!("[{BLOCK}{ZERO}{}{COMMA_OUT}{CLOSE}]", array_items(items))
}

pub(super) fn reference(array: String) -> String {
    format!("&{array}")
}
