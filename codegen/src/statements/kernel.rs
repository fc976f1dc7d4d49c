//! Statements of the elementary functions: one for each operation of their kernels.

use super::expression::Expression;
use super::statement::Statement;
use eomgen_elementary::{Function as Elementary, Kernel, Operation, Precision, sin_cos_kernel};

/// Largest number of operations in one emitted expression of a kernel.
const MAX_OPERATIONS_PER_EXPRESSION: usize = 6;

/// Statements and results of a kernel. An operation with one use becomes part of the expression that uses it,
/// up to a size limit; the others get a name.
pub struct KernelStatements {
    /// Named operations.
    pub computed: Vec<Statement>,
    values: Vec<Expression>,
}

impl KernelStatements {
    /// Writes the kernel of a function in a number format.
    pub fn new<P: Precision>(function: Elementary) -> Self {
        Self::from_kernel(&function.kernel_in::<P>(), function.arguments())
    }

    /// Writes the joint kernel of sine and cosine in a number format. The results are sine, then cosine.
    pub fn sine_and_cosine<P: Precision>(argument: &str) -> Self {
        Self::from_kernel(&sin_cos_kernel::<P>(), &[argument])
    }

    fn from_kernel(kernel: &Kernel, arguments: &[&str]) -> Self {
        let uses = uses(kernel);
        let mut expressions: Vec<Expression> = Vec::new();
        let mut computed = Vec::new();
        for (index, operation) in kernel.operations.iter().enumerate() {
            let expression = expression(*operation, arguments, &expressions);
            let single = uses[index] <= 1 && expression.size() <= MAX_OPERATIONS_PER_EXPRESSION;
            // The negation of a name needs no variable of its own, because it is as short as a name.
            let negated_name = matches!(operation, Operation::Neg(_)) && expression.size() == 1;
            if !operation.is_computed() || single || negated_name {
                expressions.push(expression);
            } else {
                let name = format!("v{index}");
                computed.push(Statement::Let(name.clone(), expression));
                expressions.push(Expression::Name(name));
            }
        }
        let outputs = kernel.outputs.iter();
        Self {
            computed,
            values: outputs.map(|output| expressions[*output].clone()).collect(),
        }
    }

    /// Returns the first result.
    pub fn value(&self) -> Option<&Expression> {
        self.values.first()
    }

    /// Returns all results.
    pub fn values(&self) -> &[Expression] {
        &self.values
    }
}

fn uses(kernel: &Kernel) -> Vec<usize> {
    let mut uses = vec![0; kernel.operations.len()];
    for operation in &kernel.operations {
        operation.map_operands(|operand| {
            uses[operand] += 1;
            operand
        });
    }
    uses
}

fn expression(operation: Operation, arguments: &[&str], operands: &[Expression]) -> Expression {
    let o = |index: usize| &operands[index];
    let call = |name: &'static str, arguments: &[usize]| {
        Expression::Primitive(name, arguments.iter().map(|a| o(*a).clone()).collect())
    };
    match operation {
        Operation::Input(index) => Expression::name(arguments[index.min(arguments.len() - 1)]),
        Operation::Constant(value) => Expression::Number(value),
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
        } => {
            let parts = [right, left, then, otherwise].map(|part| o(part).clone());
            Expression::Select(Box::new(parts))
        }
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
