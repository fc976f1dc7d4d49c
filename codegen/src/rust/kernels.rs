//! The elementary functions as emitted Rust: their kernels, printed operation by operation.
//! Their derivatives are in `slopes`.

use super::expression::{Expression, assignment};
use super::layout::{DEEPER, SHALLOWER};
use super::literals::block;
use super::slopes;
use eomgen_elementary::{Function as Elementary, Kernel, Operation};

fn describe(function: Elementary) -> &'static str {
    match function {
        Elementary::Abs => "Absolute value.",
        Elementary::Sign => "Sign, with sign(0) = 0.",
        Elementary::Min => "The smaller of two, NaN if either is.",
        Elementary::Max => "The larger of two, NaN if either is.",
        Elementary::Sqrt => "Square root.",
        Elementary::Exp => "Exponential function.",
        Elementary::ExpMinusOne => "exp(x) - 1.",
        Elementary::Ln => "Natural logarithm.",
        Elementary::Sinh => "Hyperbolic sine.",
        Elementary::Cosh => "Hyperbolic cosine.",
        Elementary::Tanh => "Hyperbolic tangent.",
        Elementary::Sin => "Sine for |x| up to 1e9, NaN beyond.",
        Elementary::Cos => "Cosine for |x| up to 1e9, NaN beyond.",
        Elementary::Tan => "Tangent for |x| up to 1e9, NaN beyond.",
        Elementary::Asin => "Inverse sine.",
        Elementary::Acos => "Inverse cosine.",
        Elementary::Atan => "Inverse tangent.",
        Elementary::Atan2 => "Angle of the point (x, y).",
        Elementary::Pow => "x to the power y.",
    }
}

/// The function that stages call and the type that names it.
pub(super) fn elementary_function(function: Elementary) -> String {
    let (name, type_name) = (function.name(), slopes::type_name(function));
    let description = describe(function);
    let binary = function.arity() == 2;
    let (family, apply, [x, y]) = match (function, binary) {
        (Elementary::Atan2, _) => ("FunctionOfTwo", "function_of_two", ["y", "x"]),
        (_, true) => ("FunctionOfTwo", "function_of_two", ["x", "y"]),
        (_, false) => ("Function", "function", ["x", ""]),
    };
    let (second, argument) = if binary {
        (format!(", {y}: T"), y)
    } else {
        (String::new(), "")
    };
    let call = format!(
        "/// {description}\n#[inline(always)]\nfn {name}<T: Scalar>({x}: T{second}) -> T {{\n"
    ) + &format!("{DEEPER}{x}.{apply}::<{type_name}>({argument})\n{SHALLOWER}}}\n");
    let arguments: &[&str] = if binary { &[x, y] } else { &[x] };
    let value = block(
        &format!("#[inline(always)]\nfn value<T: Real>({x}: T{second}) -> T {{"),
        &KernelBody::new(&function.kernel(), arguments).lines(),
        "}",
    );
    call + &format!("enum {type_name} {{}}\n")
        + &block(
            &format!("impl {family} for {type_name} {{"),
            &(value + &slopes::slope(function)),
            "}",
        )
}

/// The statements of a kernel: operations used once stand inside the expression that uses
/// them, up to a size, the others get a name.
struct KernelBody<'k> {
    kernel: &'k Kernel,
    arguments: &'k [&'k str],
    uses: Vec<usize>,
    expressions: Vec<Expression>,
    statements: String,
}

/// The most operations in one emitted expression of a kernel.
const EXPRESSION_SIZE: usize = 6;

impl<'k> KernelBody<'k> {
    fn new(kernel: &'k Kernel, arguments: &'k [&'k str]) -> Self {
        let mut uses = vec![0; kernel.operations.len()];
        for operation in &kernel.operations {
            operation.map_operands(|operand| {
                uses[operand] += 1;
                operand
            });
        }
        Self {
            kernel,
            arguments,
            uses,
            expressions: Vec::new(),
            statements: String::new(),
        }
    }

    fn lines(mut self) -> String {
        for index in 0..self.kernel.operations.len() {
            let operation = self.kernel.operations[index];
            let expression = self.expression(operation);
            let single = self.uses[index] <= 1 && expression.size <= EXPRESSION_SIZE;
            if !operation.is_computed() || single {
                self.expressions.push(expression);
            } else {
                self.statements
                    .push_str(&assignment(&format!("let v{index}"), expression));
                self.statements.push('\n');
                self.expressions.push(Expression::atom(format!("v{index}")));
            }
        }
        if let Some(output) = self.kernel.outputs.first() {
            self.statements
                .push_str(&format!("{}\n", self.expressions[*output]));
        }
        self.statements
    }

    fn expression(&self, operation: Operation) -> Expression {
        let o = |index: usize| &self.expressions[index];
        let call = |name: &str, arguments: &[usize]| {
            let arguments: Vec<Expression> = arguments.iter().map(|a| o(*a).clone()).collect();
            Expression::call(&format!("T::{name}"), &arguments)
        };
        match operation {
            Operation::Input(index) => {
                Expression::atom(self.arguments[index.min(self.arguments.len() - 1)])
            }
            Operation::Constant(value) => Expression::number(value),
            Operation::Add(a, b) => Expression::add(o(a), o(b)),
            Operation::Sub(a, b) => Expression::subtract(o(a), o(b)),
            Operation::Mul(a, b) => Expression::multiply(o(a), o(b)),
            Operation::Div(a, b) => Expression::divide(o(a), o(b)),
            Operation::Neg(a) => Expression::negate(o(a)),
            Operation::Abs(a) => call("magnitude", &[a]),
            Operation::CopySign { magnitude, sign } => call("copy_sign", &[magnitude, sign]),
            Operation::SelectLess {
                left,
                right,
                then,
                otherwise,
            } => call("select_greater", &[right, left, then, otherwise]),
            Operation::SelectEqual {
                left,
                right,
                then,
                otherwise,
            } => call("select_equal", &[left, right, then, otherwise]),
            Operation::PowerOfTwo(a) => call("power_of_two", &[a]),
            Operation::Exponent(a) => call("exponent", &[a]),
            Operation::Significand(a) => call("significand", &[a]),
        }
    }
}
