//! Functions that emitted stages call: elementary functions, written from their kernels, and helpers, stored as text.

use super::comments::comment;
use super::expression::Writer;
use super::names::fill_template;
use super::primitives::{CFormat, bits, primitives};
use crate::program::Program;
use crate::statements::layout::block;
use crate::statements::{
    Elements, Expression, Helper, Index, KernelStatements, MatrixOperand, Place, Recorder,
    RequiredFunctions, Span, Statement,
};
use eomgen_elementary::{Double, Function as Elementary, Single};

/// Writes the functions that stages call. Elementary functions are written in single and in double precision; the
/// preprocessor selects one.
pub(super) fn write_functions(
    program: &Program,
    needed: &RequiredFunctions,
    stages: &str,
) -> String {
    let kernels = needed.kernels.iter();
    let mut helpers: String = kernels
        .filter(|function| function.is_generic())
        .map(|function| write_generic_function(program, *function))
        .collect();
    for (helper, item) in [
        (Helper::DeadzoneOnSide, DEADZONE_ON_SIDE),
        (Helper::Touching, TOUCHING),
        (Helper::Either, EITHER),
    ] {
        if needed.has_any(&[helper]) {
            helpers += &fill_template(program, item);
        }
    }
    if needed.has_any(&[Helper::Cholesky]) {
        helpers += &write_cholesky(program);
    }
    let called = helpers.clone() + stages;
    let double = write_elementary_functions::<Double>(program, needed, &called);
    if double.is_empty() {
        return helpers;
    }
    let single = write_elementary_functions::<Single>(program, needed, &called);
    fill_template(program, "#if NAME_IS_SINGLE(NAME_REAL)\n")
        + &single
        + "#else\n"
        + &double
        + "#endif\n"
        + &helpers
}

/// Writes the elementary functions in one precision, with the primitives that these functions or the text `called`
/// call.
fn write_elementary_functions<P: CFormat>(
    program: &Program,
    needed: &RequiredFunctions,
    called: &str,
) -> String {
    let mut text = String::new();
    for &function in needed.kernels.iter().filter(|f| !f.is_generic()) {
        let call = fill_template(program, &format!("NAME_{}(", function.name()));
        // If all stages compute sine and cosine together, the separate functions are not needed.
        let paired = matches!(function, Elementary::Sin | Elementary::Cos);
        if !paired || called.contains(&call) {
            text += &write_elementary_function::<P>(program, function);
        }
    }
    if called.contains(&fill_template(program, "NAME_sin_cos(")) {
        text += &write_sine_and_cosine::<P>(program);
    }
    let mut operations = String::new();
    for (name, item) in primitives::<P>() {
        let call = fill_template(program, &format!("NAME_{name}("));
        if text.contains(&call) || called.contains(&call) {
            operations += &fill_template(program, &item);
        }
    }
    if operations.is_empty() {
        return text;
    }
    fill_template(program, &bits::<P>()) + &operations + &text
}

/// Writes a function that is independent of the precision.
fn write_generic_function(program: &Program, function: Elementary) -> String {
    let head = format!(
        "static NAME_real NAME_{}({}) {{",
        function.name(),
        write_parameters(function, "NAME_real")
    );
    let lines = write_lines::<Double>(function, &Writer::new(program));
    comment(&[function.description().to_owned()])
        + &block(&fill_template(program, &head), &lines, "}")
}

/// Writes the parameters of a function for one number type.
fn write_parameters(function: Elementary, number: &str) -> String {
    let names = function.arguments().iter();
    let typed: Vec<String> = names.map(|name| format!("{number} {name}")).collect();
    typed.join(", ")
}

/// Writes the operations of a function and its return statement.
fn write_lines<P: CFormat>(function: Elementary, writer: &Writer) -> String {
    let kernel = KernelStatements::new::<P>(function);
    let mut lines = writer.statements(&kernel.computed);
    if let Some(value) = kernel.value() {
        lines += &format!("return {};\n", writer.expression(value));
    }
    lines
}

/// Writes an elementary function. In double precision, the value is rounded to the number type.
fn write_elementary_function<P: CFormat>(program: &Program, function: Elementary) -> String {
    let name = function.name();
    let lines = write_lines::<P>(function, &Writer::in_format::<P>(program));
    let description = comment(&[function.description().to_owned()]);
    let inline = inline_keyword::<P>(matches!(function, Elementary::Sin | Elementary::Cos));
    let outer = format!(
        "static {inline}NAME_real NAME_{name}({}) {{",
        write_parameters(function, "NAME_real")
    );
    let outer = fill_template(program, &outer);
    if P::NUMBER == "float" {
        return description + &block(&outer, &lines, "}");
    }
    let head = format!(
        "static double NAME_{name}_in_double({}) {{",
        write_parameters(function, "double")
    );
    let passed: Vec<String> = function
        .arguments()
        .iter()
        .map(|name| format!("(double){name}"))
        .collect();
    let rounded = format!(
        "return (NAME_real)NAME_{name}_in_double({});\n",
        passed.join(", ")
    );
    description
        + &block(&fill_template(program, &head), &lines, "}")
        + &block(&outer, &fill_template(program, &rounded), "}")
}

/// Returns `inline ` for functions whose body is shorter than their constants and calls: sine and cosine in single
/// precision.
fn inline_keyword<P: CFormat>(of_angle: bool) -> &'static str {
    if of_angle && P::NUMBER == "float" {
        "inline "
    } else {
        ""
    }
}

/// Writes the joint function of sine and cosine, bit-identical to the separate functions.
fn write_sine_and_cosine<P: CFormat>(program: &Program) -> String {
    let kernel = KernelStatements::sine_and_cosine::<P>("x");
    let writer = Writer::in_format::<P>(program);
    let mut lines = writer.statements(&kernel.computed);
    for (name, value) in ["sine", "cosine"].iter().zip(kernel.values()) {
        let exact = format!("{name}_of_x");
        lines += &writer.write_definition(&exact, value);
        lines += &fill_template(program, &format!("*{name} = (NAME_real){exact};\n"));
    }
    let head = format!(
        "static {}void NAME_sin_cos({} x, NAME_real *NAME_RESTRICT sine, NAME_real *NAME_RESTRICT cosine) {{",
        inline_keyword::<P>(true),
        P::NUMBER
    );
    let description = Elementary::Sin
        .description()
        .replace("Sine", "Sine and cosine");
    comment(&[description]) + &block(&fill_template(program, &head), &lines, "}")
}

/// Dead-zone function f_k of Eq. (7) on a given side of the play.
const DEADZONE_ON_SIDE: &str = "\
/** Deflection beyond the play on a given side. */
static NAME_real NAME_deadzone_on_side(uint32_t above, uint32_t beyond, NAME_real p, NAME_real b) {
    return (above != 0U) ? (p - b) : ((beyond != 0U) ? R(0.0) : (p + b));
}
";

/// Contact on a given side of the play.
const TOUCHING: &str = "\
/** 1 if there is contact on a given side of the play, else 0. */
static uint32_t NAME_touching(uint32_t above, uint32_t beyond) {
    return above | (beyond ^ 1U);
}
";

/// Indicator for a function on either side of its zero interval.
const EITHER: &str = "\
/** 1 if a switching function is on either side of its zero interval, else 0. */
static uint32_t NAME_either(uint32_t above, uint32_t below) {
    return above | below;
}
";

const CHOLESKY_HEAD: &str = "\
static void NAME_cholesky(int n, const NAME_real *matrix, NAME_real *factor) {";

const CHOLESKY_SOLVE_HEAD: &str = "\
static void NAME_cholesky_solve(
    int n, int m, const NAME_real *factor, const NAME_real *right, NAME_real *x
) {";

/// Writes the functions for the Cholesky factorisation and for the solution with the factor. Both functions take
/// matrices as pointers to their first entries.
fn write_cholesky(program: &Program) -> String {
    let writer = Writer::new(program);
    let function = |description: &str, head: &str, lines: &[Statement]| {
        comment(&[description.to_owned()])
            + &block(
                &fill_template(program, head),
                &writer.statements(lines),
                "}",
            )
    };
    let matrix = |name: &str, columns: &'static str| {
        MatrixOperand::local(name, Elements::Flat(columns.into()))
    };
    let entry = Place::new("factor", ["i".into()]);
    let mut lines = vec![Statement::Loop {
        index: "i",
        span: Span::between(0, Index::from("n").times("n")),
        lines: vec![Statement::Assign(entry, Expression::Number(0.0))],
    }];
    let factor = matrix("factor", "n");
    let recorder = || Recorder::new("rest");
    lines.extend(recorder().factorise("n", &matrix("matrix", "n"), &factor));
    let both = [&matrix("right", "m"), &matrix("x", "m")];
    let solution = recorder().solve(("n", Some("m".into())), &factor, both);
    function(
        "Lower factor L of a symmetric matrix L L^T of n rows; NaN if it is not positive definite.",
        CHOLESKY_HEAD,
        &lines,
    ) + &function(
        "Solution of L L^T X = right, of n rows, for each of m columns.",
        CHOLESKY_SOLVE_HEAD,
        &solution,
    )
}
