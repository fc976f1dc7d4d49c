//! External functions of CasADi for a program, in one C file together with the functions that they call. `rates` and
//! `jac_rates` have the arguments (t, x, u, p) and sparsities in compressed columns. `default_parameters` returns the
//! p of the specification. If Hessians are requested, the file also contains `adj1_rates`, the gradient of the
//! weighted rates, and its Jacobian `jac_adj1_rates`.
//!
//! u and p are the inputs and the parameters in SI units, in the order of their names.
//!
//! `arguments` lists the arguments, `columns` builds compressed columns, `function` writes one external function, and
//! `gradient` writes the functions for the Hessians.

mod arguments;
mod columns;
mod function;
mod gradient;

use arguments::{find_jacobian, rate_arguments};
use columns::Columns;
use function::Function;
use gradient::write_gradient;

use super::comments::comment;
use super::emit::emit;
use super::names::fill_template;
use crate::program::{Output, Program};
use crate::statements::layout;
use crate::statements::{EmitError, EmitResult};

/// Outputs that the program must have.
pub const CASADI_OUTPUTS: [Output; 2] = [Output::Jacobians, Output::TimeDerivatives];

/// Writes the file `NAME_casadi.c`, which compiles without other files.
///
/// # Errors
/// A name of the program is a reserved word of C or C++, or the program lacks [`CASADI_OUTPUTS`].
pub fn emit_casadi(program: &Program) -> Result<String, EmitError> {
    let files = emit(program)?;
    let include = format!("#include \"{}.h\"\n", program.name);
    let double = fill_template(program, "#undef NAME_REAL\n#define NAME_REAL double\n");
    let functions = layout::source(&write_functions(program)?);
    Ok([
        double,
        files.header,
        files.source.replacen(&include, "", 1),
        functions,
    ]
    .concat())
}

fn write_functions(program: &Program) -> EmitResult<String> {
    let given = rate_arguments(program);
    let mut text = fill_template(program, OPENING);
    for argument in given {
        text += &Columns::dense(argument.count).write_sparsity(program, argument.shape);
    }
    let mut jac_rates = Function::new(&given, "jac_rates");
    jac_rates.push_argument("out_rates", "states");
    for (place, argument) in given.iter().enumerate() {
        let name = argument.jacobian;
        let compressed = Columns::from_jacobian(find_jacobian(program, name)?, argument.count);
        text += &compressed.write_sparsity(program, name);
        text += &compressed.write_order(program, name);
        jac_rates.push_result(format!("jac_rates_{}", argument.name), name);
        jac_rates.reserve_work(compressed.count());
        jac_rates.statements += &format!(
            "if (res[{place}]) {{\n    NAME_{name}(t, x, &inputs, &coefficients, w);\n    \
             for (int i = 0; i < {}; ++i) {{\n        \
             res[{place}][i] = w[NAME_{name}_order[i]];\n    }}\n}}\n",
            compressed.count()
        );
    }
    text += &fill_template(program, INTERFACE);
    let mut rates = Function::new(&given, "rates");
    rates.push_result("rates".to_owned(), "states");
    rates.statements =
        "if (res[0]) {\n    NAME_rates(t, x, &inputs, &coefficients, res[0]);\n}\n".to_owned();
    text += &rates.text(program);
    text += &jac_rates.text(program);
    if let Some(derivative) = &program.outputs.gradient_derivative {
        text += &write_gradient(program, &given, derivative)?;
    }
    text += &write_defaults(program);
    Ok(text + "#ifdef __cplusplus\n}\n#endif\n")
}

fn write_defaults(program: &Program) -> String {
    let line = "Parameters of the specification in SI units; a function without arguments.";
    let filled = program
        .parameters
        .iter()
        .enumerate()
        .map(|(place, parameter)| {
            let name = &parameter.quantity.name;
            format!("        res[0][{place}] = parameters.{name};\n")
        });
    let text = DEFAULTS.replace("FILLED\n", &filled.collect::<String>());
    comment(&[line.to_owned()]) + &fill_template(program, &text)
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
/** Coefficients and inputs from u and p; missing ones are 0. */
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
