//! Second derivatives for optimisers: the gradient of the weighted rates, `adj1_rates`, and its Jacobian,
//! `jac_adj1_rates`. The blocks of `jac_adj1_rates` with respect to (t, x, u, p) are second derivatives of the
//! weighted rates. The blocks with respect to the weights are transposed Jacobians of the rates.

use super::super::names::fill_template;
use super::arguments::{RateArgument, find_jacobian};
use super::columns::Columns;
use super::function::Function;
use crate::program::{GradientDerivative, Program, ValueId};
use crate::statements::EmitResult;

pub(super) fn write_gradient(
    program: &Program,
    given: &[RateArgument; 4],
    derivative: &GradientDerivative<ValueId>,
) -> EmitResult<String> {
    Ok(write_weighted_gradient(program, given)?
        + &write_second_derivative(program, given, derivative)?)
}

/// Creates a function of (t, x, u, p), of the rates (unused), and of the weights.
fn create_weighted_function(given: &[RateArgument; 4], name: &'static str) -> Function {
    let mut function = Function::new(given, name);
    function.push_argument("out_rates", "states");
    function.push_argument("adj_rates", "states");
    function.statements = "const double *weights = arg[5] ? arg[5] : zeros;\n".to_owned();
    function
}

fn write_weighted_gradient(program: &Program, given: &[RateArgument; 4]) -> EmitResult<String> {
    let mut function = create_weighted_function(given, "adj1_rates");
    for argument in given {
        function.push_result(format!("adj_{}", argument.name), argument.shape);
    }
    let by_time = find_jacobian(program, "rates_by_time")?.nonzeros();
    function.reserve_work(by_time.max(program.states()));
    let inputs = program
        .inputs
        .iter()
        .enumerate()
        .map(|(place, input)| format!("        res[2][{place}] = by_inputs.{};\n", input.name));
    let text = WEIGHTED.replace("BY_TIME", &by_time.to_string());
    function.statements += &text.replace("INPUTS\n", &inputs.collect::<String>());
    Ok(function.text(program))
}

/// Writes the Jacobian of the gradient, computed column by column, and the sparsities of its blocks.
fn write_second_derivative(
    program: &Program,
    given: &[RateArgument; 4],
    derivative: &GradientDerivative<ValueId>,
) -> EmitResult<String> {
    let mut function = create_weighted_function(given, "jac_adj1_rates");
    let mut text = fill_template(program, COLUMN);
    for argument in given {
        function.push_argument(&format!("out_adj_{}", argument.name), argument.shape);
    }
    let mut places = Vec::new();
    let mut first = 0;
    for argument in given {
        places.push(first..first + argument.count);
        first += argument.count;
    }
    let results = given.len() + 2;
    let mut by_weights = String::new();
    for (row, of) in given.iter().enumerate() {
        for (column, by) in given.iter().enumerate() {
            let name = format!("adj_{}_{}", of.name, by.name);
            let block = Columns::hessian_block(derivative, &places[row], &places[column]);
            text += &block.write_sparsity(program, &name);
            function.push_result(format!("jac_{name}"), &name);
        }
        let name = format!("adj_{}_out", of.name);
        text += &Columns::zero(of.count, program.states()).write_sparsity(program, &name);
        function.push_result(format!("jac_adj_{}_out_rates", of.name), &name);
        let turned =
            Columns::from_jacobian(find_jacobian(program, of.jacobian)?, of.count).transpose();
        let name = format!("adj_{}_weights", of.name);
        text += &turned.write_sparsity(program, &name);
        text += &turned.write_order(program, &name);
        function.reserve_work(turned.count());
        function.push_result(format!("jac_adj_{}_adj_rates", of.name), &name);
        let place = results * row + given.len() + 1;
        by_weights += &format!(
            "if (res[{place}]) {{\n    NAME_{}(t, x, &inputs, &coefficients, w);\n    \
             for (int i = 0; i < {}; ++i) {{\n        \
             res[{place}][i] = w[NAME_{name}_order[i]];\n    }}\n}}\n",
            of.jacobian,
            turned.count()
        );
    }
    function.statements += &fill_template(program, DIRECTION).replace("LENGTH", &first.to_string());
    for (column, by) in given.iter().enumerate() {
        let asked = (0..given.len()).map(|row| format!("res[{}]", results * row + column));
        let asked = asked.collect::<Vec<_>>().join(" || ");
        let mut lines = BY_COLUMN.replace("FIRST", &places[column].start.to_string());
        for (row, of) in given.iter().enumerate() {
            lines += &format!(
                "        NAME_column(NAME_adj_{}_{}_sparsity, k, product + {}, res[{}]);\n",
                of.name,
                by.name,
                places[row].start,
                results * row + column
            );
        }
        function.statements += &format!(
            "if ({asked}) {{\n    for (int k = 0; k < {}; ++k) {{\n{lines}    }}\n}}\n",
            by.count
        );
    }
    function.statements += &by_weights;
    Ok(text + &function.text(program))
}

const COLUMN: &str = "\
static void NAME_column(
    const casadi_int *sparsity, int k, const double *product, casadi_real *block
) {
    const casadi_int *rows = sparsity + 3 + sparsity[1];
    if (block) {
        for (casadi_int i = sparsity[2 + k]; i < sparsity[3 + k]; ++i) {
            block[i] = product[rows[i]];
        }
    }
}
";

const DIRECTION: &str = "\
double direction[LENGTH] = {0};
double product[LENGTH];
";

const BY_COLUMN: &str = "        \
direction[FIRST + k] = 1;
        NAME_gradient_derivative(
            t, x, &inputs, &coefficients, weights, direction, product
        );
        direction[FIRST + k] = 0;
";

const WEIGHTED: &str = "\
if (res[0]) {
    NAME_rates_by_time(t, x, &inputs, &coefficients, w);
    res[0][0] = 0;
    for (int i = 0; i < BY_TIME; ++i) {
        res[0][0] += w[NAME_rates_by_time_order[i]] * weights[NAME_rates_by_time_sparsity[4 + i]];
    }
}
if (res[1] || res[2]) {
    NAME_inputs by_inputs;
    NAME_vector_jacobian_product(
        t, x, &inputs, &coefficients, weights, res[1] ? res[1] : w, &by_inputs
    );
    if (res[2]) {
INPUTS
    }
}
if (res[3]) {
    NAME_vector_jacobian_product_by_parameters(
        t, x, &inputs, &coefficients, weights, res[3]
    );
}
";
