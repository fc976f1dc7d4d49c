//! A program as CasADi's external functions, in one file with the C that they call: `rates` and
//! `jac_rates` of (t, x, u, p), by CasADi's interface of C functions, with the sparsities of their
//! results in compressed columns, and `default_parameters`, the specification's p.
//!
//! u and p are the inputs and the parameters in SI, in the order of their names.

use super::comments::comment;
use super::emit::emit;
use super::expression::initialiser;
use super::names::named;
use crate::program::{Jacobian, Output, Program, ValueId};
use crate::statements::layout::{self, block};
use crate::statements::{EmitError, Emitted};

/// What a program has to be derived with.
pub const CASADI_OUTPUTS: [Output; 2] = [Output::Jacobians, Output::TimeDerivatives];

/// The file `NAME_casadi.c`, which compiles by itself.
///
/// # Errors
/// If a name of the program is a word of C or C++, or if it was not derived with
/// [`CASADI_OUTPUTS`].
pub fn emit_casadi(program: &Program) -> Result<String, EmitError> {
    let files = emit(program)?;
    let include = format!("#include \"{}.h\"\n", program.name);
    let double = named(program, "#undef NAME_REAL\n#define NAME_REAL double\n");
    let functions = layout::source(&functions(program)?);
    Ok([
        double,
        files.header,
        files.source.replacen(&include, "", 1),
        functions,
    ]
    .concat())
}

fn functions(program: &Program) -> Emitted<String> {
    let (states, inputs) = (program.states(), program.inputs.len());
    let parameters = program.parameters.len();
    let mut text = named(program, OPENING);
    for (name, count) in [
        ("scalar", 1),
        ("states", states),
        ("inputs", inputs),
        ("parameters", parameters),
    ] {
        text += &sparsity(program, name, &Columns::dense(count));
    }
    let mut calls = String::new();
    let mut most = 0;
    for (place, (name, columns)) in [
        ("rates_by_time", 1),
        ("rates_by_state", states),
        ("rates_by_inputs", inputs),
        ("rates_by_parameters", parameters),
    ]
    .into_iter()
    .enumerate()
    {
        let mut jacobians = program.outputs.jacobians.iter();
        let Some(jacobian) = jacobians.find(|jacobian| jacobian.name == name) else {
            return Err(EmitError::Value(format!("{name} was not derived")));
        };
        let compressed = Columns::of(jacobian, columns);
        text += &sparsity(program, name, &compressed);
        text += &order(program, name, &compressed);
        most = most.max(compressed.order.len());
        calls += &format!(
            "if (res[{place}]) {{\n    NAME_{name}(t, x, &inputs, &coefficients, w);\n    \
             for (int i = 0; i < {}; ++i) {{\n        \
             res[{place}][i] = w[NAME_{name}_order[i]];\n    }}\n}}\n",
            compressed.order.len()
        );
    }
    text += &named(program, INTERFACE);
    let rates = "if (res[0]) {\n    NAME_rates(t, x, &inputs, &coefficients, res[0]);\n}\n";
    let names = ["t", "x", "u", "p"];
    let given = ["scalar", "states", "inputs", "parameters"];
    text += &function(
        program,
        "rates",
        (&names, &given),
        &["rates"],
        (&["states"], 0),
        rates,
    );
    let names = ["t", "x", "u", "p", "out_rates"];
    let given = ["scalar", "states", "inputs", "parameters", "states"];
    let results = ["jac_rates_t", "jac_rates_x", "jac_rates_u", "jac_rates_p"];
    let sparsities = [
        "rates_by_time",
        "rates_by_state",
        "rates_by_inputs",
        "rates_by_parameters",
    ];
    let all = (&sparsities[..], most);
    text += &function(
        program,
        "jac_rates",
        (&names, &given),
        &results,
        all,
        &calls,
    );
    text += &defaults(program);
    Ok(text + "#ifdef __cplusplus\n}\n#endif\n")
}

/// A matrix by its columns.
struct Columns {
    rows: usize,
    columns: usize,
    /// Where each column begins among the rows, and where the last ends.
    starts: Vec<usize>,
    /// The row of each nonzero.
    row: Vec<usize>,
    /// The place of each nonzero among those row by row.
    order: Vec<usize>,
}

impl Columns {
    /// A column without zeros.
    fn dense(rows: usize) -> Self {
        Self {
            rows,
            columns: 1,
            starts: vec![0, rows],
            row: (0..rows).collect(),
            order: (0..rows).collect(),
        }
    }

    /// The structural nonzeros of a Jacobian.
    fn of(jacobian: &Jacobian<ValueId>, columns: usize) -> Self {
        let mut entries = Vec::new();
        for (block, place) in jacobian.entries.iter().zip(jacobian.places()) {
            for i in 0..block.rows {
                for j in 0..block.width() {
                    let column = block.column + if block.diagonal { i } else { j };
                    let at = place.start + i * place.width + j;
                    entries.push((column, block.row + i, at));
                }
            }
        }
        entries.sort_unstable();
        let starts = (0..=columns).map(|column| entries.partition_point(|entry| entry.0 < column));
        Self {
            rows: jacobian.rows,
            columns,
            starts: starts.collect(),
            row: entries.iter().map(|entry| entry.1).collect(),
            order: entries.iter().map(|entry| entry.2).collect(),
        }
    }
}

/// A sparsity as CasADi wants it: rows, columns, where each column begins, the row of each nonzero.
fn sparsity(program: &Program, name: &str, columns: &Columns) -> String {
    let numbers = [columns.rows, columns.columns].into_iter();
    let numbers = numbers.chain(columns.starts.iter().copied());
    let numbers = numbers.chain(columns.row.iter().copied());
    let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
    let head = format!(
        "static const casadi_int NAME_{name}_sparsity[{}]",
        numbers.len()
    );
    format!("{} = {};\n", named(program, &head), lines(&numbers))
}

/// Where the nonzeros by columns stand among those by rows.
fn order(program: &Program, name: &str, columns: &Columns) -> String {
    let mut numbers: Vec<String> = columns.order.iter().map(usize::to_string).collect();
    if numbers.is_empty() {
        numbers.push("0".to_owned());
    }
    let head = format!("static const int NAME_{name}_order[{}]", numbers.len());
    format!("{} = {};\n", named(program, &head), lines(&numbers))
}

/// Numbers, sixteen in a line.
fn lines(numbers: &[String]) -> String {
    let lines: Vec<String> = numbers.chunks(16).map(|line| line.join(", ")).collect();
    initialiser(&lines)
}

/// One function of the interface: names and sparsities of what it is given and gives, numbers of
/// room beside the point, and statements.
fn function(
    program: &Program,
    name: &str,
    (given, shapes): (&[&str], &[&str]),
    results: &[&str],
    (sparsities, room): (&[&str], usize),
    statements: &str,
) -> String {
    let listed = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        names.join(", ")
    };
    let shaped = |names: &[&str]| {
        let names: Vec<String> = names
            .iter()
            .map(|name| format!("NAME_{name}_sparsity"))
            .collect();
        names.join(", ")
    };
    let text = FUNCTION
        .replace("GIVEN_NAMES", &listed(given))
        .replace("RESULT_NAMES", &listed(results))
        .replace("GIVEN_SHAPES", &shaped(shapes))
        .replace("RESULT_SHAPES", &shaped(sparsities))
        .replace("GIVEN", &given.len().to_string())
        .replace("RESULTS", &results.len().to_string())
        .replace("ROOM", &room.to_string())
        .replace("FUNCTION", name);
    let head = format!(
        "CASADI_SYMBOL_EXPORT int {name}(const casadi_real **arg, casadi_real **res, \
         casadi_int *iw, casadi_real *w, int mem) {{"
    );
    let point = POINT.to_owned() + statements + "return 0;\n";
    named(program, &(text + &block(&head, &point, "}")))
}

fn defaults(program: &Program) -> String {
    let line = "The specification's parameters, in SI: a function of nothing.";
    let filled = program
        .parameters
        .iter()
        .enumerate()
        .map(|(place, parameter)| {
            let name = &parameter.quantity.name;
            format!("        res[0][{place}] = parameters.{name};\n")
        });
    let text = DEFAULTS.replace("FILLED\n", &filled.collect::<String>());
    comment(&[line.to_owned()]) + &named(program, &text)
}

const OPENING: &str = "\
#include <stddef.h>
#ifndef casadi_real
#define casadi_real double
#endif
#ifndef casadi_int
#define casadi_int long long int
#endif
#ifndef CASADI_SYMBOL_EXPORT
#if defined(_WIN32)
#define CASADI_SYMBOL_EXPORT __declspec(dllexport)
#else
#define CASADI_SYMBOL_EXPORT __attribute__((visibility(\"default\")))
#endif
#endif
#ifdef __cplusplus
extern \"C\" {
#endif
";

const INTERFACE: &str = "\
/** Coefficients and inputs from u and p; 0 stands for what is not given. */
static void NAME_point(
    const casadi_real *u, const casadi_real *p, NAME_inputs *inputs,
    NAME_coefficients *coefficients
) {
    double none[NAME_INPUTS + NAME_PARAMETERS + 1] = {0};
    NAME_parameters parameters;
    NAME_inputs_from_array(u ? u : none, inputs);
    NAME_parameters_from_array(p ? p : none, &parameters);
    NAME_prepare(&parameters, coefficients);
}
";

const POINT: &str = "\
NAME_inputs inputs;
NAME_coefficients coefficients;
double zeros[NAME_STATES] = {0};
const double t = arg[0] ? arg[0][0] : 0.0;
const double *x = arg[1] ? arg[1] : zeros;
(void)iw;
(void)w;
(void)mem;
NAME_point(arg[2], arg[3], &inputs, &coefficients);
";

const FUNCTION: &str = "\
CASADI_SYMBOL_EXPORT casadi_int FUNCTION_n_in(void) {
    return GIVEN;
}
CASADI_SYMBOL_EXPORT casadi_int FUNCTION_n_out(void) {
    return RESULTS;
}
CASADI_SYMBOL_EXPORT const char *FUNCTION_name_in(casadi_int i) {
    static const char *const names[GIVEN] = {GIVEN_NAMES};
    return i >= 0 && i < GIVEN ? names[i] : NULL;
}
CASADI_SYMBOL_EXPORT const char *FUNCTION_name_out(casadi_int i) {
    static const char *const names[RESULTS] = {RESULT_NAMES};
    return i >= 0 && i < RESULTS ? names[i] : NULL;
}
CASADI_SYMBOL_EXPORT const casadi_int *FUNCTION_sparsity_in(casadi_int i) {
    static const casadi_int *const shapes[GIVEN] = {GIVEN_SHAPES};
    return i >= 0 && i < GIVEN ? shapes[i] : NULL;
}
CASADI_SYMBOL_EXPORT const casadi_int *FUNCTION_sparsity_out(casadi_int i) {
    static const casadi_int *const shapes[RESULTS] = {RESULT_SHAPES};
    return i >= 0 && i < RESULTS ? shapes[i] : NULL;
}
CASADI_SYMBOL_EXPORT int FUNCTION_work(
    casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w
) {
    if (sz_arg) {
        *sz_arg = GIVEN;
    }
    if (sz_res) {
        *sz_res = RESULTS;
    }
    if (sz_iw) {
        *sz_iw = 0;
    }
    if (sz_w) {
        *sz_w = ROOM;
    }
    return 0;
}
";

const DEFAULTS: &str = "\
CASADI_SYMBOL_EXPORT casadi_int default_parameters_n_in(void) {
    return 0;
}
CASADI_SYMBOL_EXPORT casadi_int default_parameters_n_out(void) {
    return 1;
}
CASADI_SYMBOL_EXPORT const char *default_parameters_name_out(casadi_int i) {
    return i == 0 ? \"p\" : NULL;
}
CASADI_SYMBOL_EXPORT const casadi_int *default_parameters_sparsity_out(casadi_int i) {
    return i == 0 ? NAME_parameters_sparsity : NULL;
}
CASADI_SYMBOL_EXPORT int default_parameters(
    const casadi_real **arg, casadi_real **res, casadi_int *iw, casadi_real *w, int mem
) {
    NAME_parameters parameters;
    (void)arg;
    (void)iw;
    (void)w;
    (void)mem;
    NAME_default_parameters(&parameters);
    if (res[0]) {
FILLED
    }
    return 0;
}
";
