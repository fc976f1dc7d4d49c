//! Functions that emitted stages call: helpers as text, and elementary functions from their kernels.

use super::comments::comment;
use super::expression::Writer;
use super::names::fill_template;
use super::primitives::{CFormat, bits, primitives};
use crate::program::Program;
use crate::statements::layout::block;
use crate::statements::{KernelStatements, RequiredFunctions, describe_elementary};
use eomgen_elementary::{Double, Function as Elementary, Single};

/// Writes the functions that stages call. Elementary functions are written in both formats, of which the
/// preprocessor selects one.
pub(super) fn functions(program: &Program, needed: &RequiredFunctions, stages: &str) -> String {
    let mut helpers = String::new();
    for (needed, item) in [
        (needed.deadzone, DEADZONE),
        (needed.contact, CONTACT),
        (needed.above, ABOVE),
        (needed.deadzone_on_side, DEADZONE_ON_SIDE),
        (needed.contact_on_side, TOUCHING),
        (needed.outside_zero_interval, EITHER),
        (needed.pivot_reciprocal, PIVOT_RECIPROCAL),
        (needed.cholesky || needed.cholesky_of_matrix, CHOLESKY),
    ] {
        if needed {
            helpers += &fill_template(program, item);
        }
    }
    let called = helpers.clone() + stages;
    let double = elementary_functions::<Double>(program, needed, &called);
    if double.is_empty() {
        return helpers;
    }
    let single = elementary_functions::<Single>(program, needed, &called);
    fill_template(program, "#if NAME_IS_SINGLE(NAME_REAL)\n")
        + &single
        + "#else\n"
        + &double
        + "#endif\n"
        + &helpers
}

/// Writes the elementary functions in a format, with the primitives that they and `called` call.
fn elementary_functions<P: CFormat>(
    program: &Program,
    needed: &RequiredFunctions,
    called: &str,
) -> String {
    let mut elementary = needed.elementary.clone();
    if needed.cholesky || needed.cholesky_of_matrix {
        elementary.insert(Elementary::Sqrt);
    }
    let mut text = String::new();
    for function in elementary {
        let call = fill_template(program, &format!("NAME_{}(", function.name()));
        // A sine or cosine that all stages compute as a pair needs no separate function.
        let paired = matches!(function, Elementary::Sin | Elementary::Cos);
        if !paired || called.contains(&call) {
            text += &elementary_function::<P>(program, function);
        }
    }
    if called.contains(&fill_template(program, "NAME_sin_cos(")) {
        text += &sine_and_cosine::<P>(program);
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

/// Writes an elementary function. That of double precision is rounded to the type of numbers.
fn elementary_function<P: CFormat>(program: &Program, function: Elementary) -> String {
    let arguments: &[&str] = match (function, function.arity()) {
        (Elementary::Atan2, _) => &["y", "x"],
        (_, 2) => &["x", "y"],
        _ => &["x"],
    };
    let typed = |what: &str| {
        let typed: Vec<String> = arguments
            .iter()
            .map(|name| format!("{what} {name}"))
            .collect();
        typed.join(", ")
    };
    let name = function.name();
    let kernel = KernelStatements::new::<P>(function, arguments);
    let writer = Writer::in_format::<P>(program);
    let mut lines = writer.statements(&kernel.computed);
    if let Some(value) = kernel.value() {
        lines += &format!("return {};\n", writer.expression(value));
    }
    let description = comment(&[describe_elementary(function).to_owned()]);
    let inline = inline::<P>(matches!(function, Elementary::Sin | Elementary::Cos));
    let outer = format!(
        "static {inline}NAME_real NAME_{name}({}) {{",
        typed("NAME_real")
    );
    let outer = fill_template(program, &outer);
    if P::NUMBER == "float" {
        return description + &block(&outer, &lines, "}");
    }
    let head = format!(
        "static double NAME_{name}_in_double({}) {{",
        typed("double")
    );
    let passed: Vec<String> = arguments
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

/// Returns the keyword of functions that are shorter than their constants and calls: sine and cosine in single
/// precision.
fn inline<P: CFormat>(of_angle: bool) -> &'static str {
    if of_angle && P::NUMBER == "float" {
        "inline "
    } else {
        ""
    }
}

/// Writes the joint function of sine and cosine, with the same bits as the separate functions.
fn sine_and_cosine<P: CFormat>(program: &Program) -> String {
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
        inline::<P>(true),
        P::NUMBER
    );
    let description = describe_elementary(Elementary::Sin).replace("Sine", "Sine and cosine");
    comment(&[description]) + &block(&fill_template(program, &head), &lines, "}")
}

/// f_k of Eq. (7).
const DEADZONE: &str = "\
/** Deflection beyond the backlash: f_k of Eq. (7). */
static NAME_real NAME_deadzone(NAME_real p, NAME_real b) {
    const NAME_real held = p > b ? b : p;
    return p - (-b > held ? -b : held);
}
";

/// Indicator of Eq. (8), in the precision of the numbers. It compares the magnitude, because gcc compiles two
/// comparisons to a branch but one to a selection.
const CONTACT: &str = "\
/** 1 if |p| > b, else 0: the contact of Eq. (8). */
static NAME_real NAME_contact(NAME_real p, NAME_real b) {
    const NAME_real size = -p > p ? -p : p;
    return size > b ? R(1.0) : R(0.0);
}
";

const ABOVE: &str = "\
/** 1 if p > 0, else 0. */
static NAME_real NAME_above(NAME_real p) {
    return p > R(0.0) ? R(1.0) : R(0.0);
}
";

/// f_k on a given side of its dead zone.
const DEADZONE_ON_SIDE: &str = "\
/** Deflection beyond the backlash on a given side of it: f_k of Eq. (7). */
static NAME_real NAME_deadzone_on_side(uint32_t above, uint32_t beyond, NAME_real p, NAME_real b) {
    return (above != 0U) ? (p - b) : ((beyond != 0U) ? R(0.0) : (p + b));
}
";

/// Contact on a given side of its dead zone.
const TOUCHING: &str = "\
/** 1 if there is contact on a given side of the backlash, else 0. */
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

/// Reciprocal of a pivot, NaN if it is not positive.
const PIVOT_RECIPROCAL: &str = "\
/** 1/pivot for a positive pivot, else NaN: the mass matrix is not positive definite. */
static NAME_real NAME_pivot_reciprocal(NAME_real pivot) {
    const NAME_real reciprocal = R(1.0) / pivot;
    return pivot > R(0.0) ? reciprocal : R(NAME_nan());
}
";

const CHOLESKY: &str = "\
/** Lower factor L of a symmetric matrix L L^T of n rows; NaN if it is not positive definite. */
static void NAME_cholesky(int n, const NAME_real *matrix, NAME_real *factor) {
    for (int i = 0; i < n * n; ++i) {
        factor[i] = R(0.0);
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < i + 1; ++j) {
            NAME_real rest = matrix[i * n + j];
            for (int k = 0; k < j; ++k) {
                rest = rest - factor[i * n + k] * factor[j * n + k];
            }
            if (i == j) {
                const NAME_real root = NAME_sqrt(rest);
                factor[i * n + j] = rest > R(0.0) ? root : R(NAME_nan());
            } else {
                factor[i * n + j] = rest / factor[j * n + j];
            }
        }
    }
}
/** Solution of L L^T X = right, of n rows, for each of m columns. */
static void NAME_cholesky_solve(
    int n, int m, const NAME_real *factor, const NAME_real *right, NAME_real *x
) {
    for (int c = 0; c < m; ++c) {
        for (int i = 0; i < n; ++i) {
            NAME_real rest = right[i * m + c];
            for (int k = 0; k < i; ++k) {
                rest = rest - factor[i * n + k] * x[k * m + c];
            }
            x[i * m + c] = rest / factor[i * n + i];
        }
        for (int i = n - 1; i >= 0; --i) {
            NAME_real rest = x[i * m + c];
            for (int k = i + 1; k < n; ++k) {
                rest = rest - factor[k * n + i] * x[k * m + c];
            }
            x[i * m + c] = rest / factor[i * n + i];
        }
    }
}
";
