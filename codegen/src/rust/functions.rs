//! The elementary functions as emitted Rust: their kernels, printed operation by
//! operation, and the small functions they and the stages call.

use std::collections::BTreeSet;

use super::expression::{Expression, assignment};
use super::literals::block;
use elementary::{Function as Elementary, Kernel, Operation};

/// What a file needs besides the operators.
#[derive(Clone, Debug, Default)]
pub struct Needed {
    /// Elementary functions.
    pub elementary: BTreeSet<Elementary>,
    /// f_k of Eq. (7).
    pub deadzone: bool,
    /// The indicator of Eq. (8).
    pub contact: bool,
    /// Reciprocals of pivots.
    pub pivot_reciprocal: bool,
    /// Cholesky factors and their solutions.
    pub cholesky: bool,
    /// Sums of more elements than there are partial sums.
    pub sum: bool,
    /// Sums of no more.
    pub sum_of_few: bool,
}

/// The items of every function needed.
pub fn items(needed: &Needed) -> String {
    let mut elementary = needed.elementary.clone();
    if needed.cholesky {
        elementary.insert(Elementary::Sqrt);
    }
    let kernels: Vec<(Elementary, Kernel)> = elementary.iter().map(|f| (*f, f.kernel())).collect();
    let mut text = String::new();
    for (needed, item) in [
        (needed.deadzone, DEADZONE),
        (needed.contact, CONTACT),
        (needed.pivot_reciprocal, PIVOT_RECIPROCAL),
        (needed.cholesky, CHOLESKY),
        (needed.sum || needed.sum_of_few, PAIRED),
        (needed.sum_of_few, SUM_OF_FEW),
        (needed.sum, SUM),
    ] {
        if needed {
            text.push_str(item);
        }
    }
    for (function, kernel) in &kernels {
        text.push_str(&elementary_function(*function, kernel));
    }
    text + &primitives(&kernels)
}

/// f_k of Eq. (7).
const DEADZONE: &str = "\
/// Deflection beyond the backlash: f_k of Eq. (7).
#[inline(always)]
fn deadzone(p: f64, b: f64) -> f64 {
    if p > b { p - b } else if p < -b { p + b } else { 0.0 }
}
";

/// The indicator of Eq. (8).
const CONTACT: &str = "\
/// 1 where |p| > b and 0 elsewhere: the contact of Eq. (8).
#[inline(always)]
fn contact(p: f64, b: f64) -> f64 {
    if p > b || p < -b { 1.0 } else { 0.0 }
}
";

/// The reciprocal that is NaN where a pivot is not positive.
const PIVOT_RECIPROCAL: &str = "\
/// 1/pivot of a positive pivot; NaN where the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal(pivot: f64) -> f64 {
    if pivot > 0.0 { 1.0 / pivot } else { f64::NAN }
}
";

/// Cholesky factors and their solutions.
const CHOLESKY: &str = "\
/// Lower factor L of a symmetric matrix L L^T; NaN where it is not positive definite.
fn cholesky<const N: usize>(matrix: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut factor = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..i + 1 {
            let mut rest = matrix[i][j];
            for k in 0..j {
                rest -= factor[i][k] * factor[j][k];
            }
            factor[i][j] = if i == j {
                if rest > 0.0 { sqrt(rest) } else { f64::NAN }
            } else {
                rest / factor[j][j]
            };
        }
    }
    factor
}

/// Solution of L L^T x = right.
fn cholesky_solve<const N: usize>(factor: &[[f64; N]; N], right: &[f64; N]) -> [f64; N] {
    let mut x = [0.0; N];
    for i in 0..N {
        let mut rest = right[i];
        for k in 0..i {
            rest -= factor[i][k] * x[k];
        }
        x[i] = rest / factor[i][i];
    }
    for j in 0..N {
        let i = N - 1 - j;
        let mut rest = x[i];
        for k in i + 1..N {
            rest -= factor[k][i] * x[k];
        }
        x[i] = rest / factor[i][i];
    }
    x
}
";
/// How the partial sums of any sum are added.
const PAIRED: &str = "\
/// The sum of the first `length` of eight numbers, neighbours added in pairs.
#[inline(always)]
fn paired(length: usize, s: &[f64; 8]) -> f64 {
    let a = if length > 1 { s[0] + s[1] } else { s[0] };
    let b = if length > 3 { s[2] + s[3] } else { s[2] };
    let c = if length > 5 { s[4] + s[5] } else { s[4] };
    let d = if length > 7 { s[6] + s[7] } else { s[6] };
    let left = if length > 2 { a + b } else { a };
    let right = if length > 6 { c + d } else { c };
    if length > 4 { left + right } else { left }
}
";

/// Sums of no more elements than there are partial sums.
const SUM_OF_FEW: &str = "\
/// The sum of up to eight elements.
#[inline(always)]
fn sum_of_few<F: Fn(usize) -> f64>(length: usize, element: F) -> f64 {
    let mut s = [0.0; 8];
    for k in 0..length {
        s[k] = element(k);
    }
    paired(length, &s)
}
";

/// Sums of more elements. Not inlined: with the loops around it unrolled into one piece the
/// compiler vectorises across them, and spills.
const SUM: &str = "\
/// The sum of elements in eight partial sums, number k of elements k, k + 8, k + 16, ...
#[inline(never)]
fn sum<F: Fn(usize) -> f64>(length: usize, element: F) -> f64 {
    let mut s = [0.0; 8];
    for k in 0..8 {
        s[k] = element(k);
    }
    for block in 1..length / 8 {
        for k in 0..8 {
            s[k] += element(8 * block + k);
        }
    }
    for i in length / 8 * 8..length {
        s[i % 8] += element(i);
    }
    paired(length, &s)
}
";

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

fn elementary_function(function: Elementary, kernel: &Kernel) -> String {
    let name = function.name();
    let arguments: &[&str] = match (function, function.arity()) {
        (Elementary::Atan2, _) => &["y", "x"],
        (_, 1) => &["x"],
        _ => &["x", "y"],
    };
    let typed: Vec<String> = arguments.iter().map(|a| format!("{a}: f64")).collect();
    let opening = format!(
        "/// {} Plain operations in a fixed order: the same bits on every machine.\n\
         #[inline]\nfn {name}({}) -> f64 {{",
        describe(function),
        typed.join(", ")
    );
    block(&opening, &KernelBody::new(kernel, arguments).lines(), "}")
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
            Expression::call(name, &arguments)
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
            Operation::Abs(a) => call("magnitude_of", &[a]),
            Operation::CopySign { magnitude, sign } => call("copy_sign", &[magnitude, sign]),
            Operation::SelectLess {
                left,
                right,
                then,
                otherwise,
            } => Expression::choice("<", [o(left), o(right), o(then), o(otherwise)]),
            Operation::SelectEqual {
                left,
                right,
                then,
                otherwise,
            } => Expression::choice("==", [o(left), o(right), o(then), o(otherwise)]),
            Operation::PowerOfTwo(a) => call("power_of_two", &[a]),
            Operation::Exponent(a) => call("exponent_of", &[a]),
            Operation::Significand(a) => call("significand_of", &[a]),
        }
    }
}

/// The bit operations that the kernels need.
fn primitives(kernels: &[(Elementary, Kernel)]) -> String {
    let uses = |wanted: fn(&Operation) -> bool| {
        kernels
            .iter()
            .any(|(_, kernel)| kernel.operations.iter().any(wanted))
    };
    let mut text = String::new();
    for (used, item) in [
        (uses(|o| matches!(o, Operation::Abs(_))), MAGNITUDE_OF),
        (uses(|o| matches!(o, Operation::CopySign { .. })), COPY_SIGN),
        (
            uses(|o| matches!(o, Operation::PowerOfTwo(_))),
            POWER_OF_TWO,
        ),
        (uses(|o| matches!(o, Operation::Exponent(_))), EXPONENT_OF),
        (
            uses(|o| matches!(o, Operation::Significand(_))),
            SIGNIFICAND_OF,
        ),
    ] {
        if used {
            text.push_str(item);
        }
    }
    text
}

/// |x| by its bits.
const MAGNITUDE_OF: &str = "\
/// The sign bit cleared.
#[inline(always)]
fn magnitude_of(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !(1 << 63))
}
";

/// A magnitude with another number's sign.
const COPY_SIGN: &str = "\
/// A magnitude with the sign bit of another number.
#[inline(always)]
fn copy_sign(magnitude: f64, sign: f64) -> f64 {
    f64::from_bits((magnitude.to_bits() & !(1 << 63)) | (sign.to_bits() & (1 << 63)))
}
";

/// 2^k.
const POWER_OF_TWO: &str = "\
/// 2^k for an integral k: 2^52 + 1023 brings it to the place of the exponent.
#[inline(always)]
fn power_of_two(k: f64) -> f64 {
    f64::from_bits((k + 4503599627371519.0).to_bits() << 52)
}
";

/// The exponent field.
const EXPONENT_OF: &str = "\
/// The unbiased exponent field.
#[inline(always)]
fn exponent_of(x: f64) -> f64 {
    ((x.to_bits() >> 52) & 0x7ff) as f64 - 1023.0
}
";

/// The mantissa.
const SIGNIFICAND_OF: &str = "\
/// The mantissa under the exponent of 1.
#[inline(always)]
fn significand_of(x: f64) -> f64 {
    f64::from_bits((x.to_bits() & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000)
}
";
