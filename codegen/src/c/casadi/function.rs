//! External function in CasADi's C interface: names and sparsities of its arguments and results, length of the work
//! array, and body.

use super::super::names::fill_template;
use super::arguments::RateArgument;
use crate::program::Program;
use crate::statements::layout::block;

/// Function of time, state, inputs and parameters, and of additional arguments.
pub(super) struct Function {
    name: &'static str,
    given: Vec<(String, String)>,
    results: Vec<(String, String)>,
    /// Length of the work array, in numbers.
    work_length: usize,
    /// Statements after the preparation of the coefficients.
    pub(super) statements: String,
}

impl Function {
    /// Starts a function with the given arguments.
    pub(super) fn new(given: &[RateArgument], name: &'static str) -> Self {
        let given = given.iter();
        Self {
            name,
            given: given
                .map(|argument| (argument.name.to_owned(), argument.shape.to_owned()))
                .collect(),
            results: Vec::new(),
            work_length: 0,
            statements: String::new(),
        }
    }

    pub(super) fn push_argument(&mut self, name: &str, shape: &str) {
        self.given.push((name.to_owned(), shape.to_owned()));
    }

    pub(super) fn push_result(&mut self, name: String, sparsity: &str) {
        self.results.push((name, sparsity.to_owned()));
    }

    /// Increases the length of the work array to at least `length`.
    pub(super) fn reserve_work(&mut self, length: usize) {
        self.work_length = self.work_length.max(length);
    }

    /// Writes the function and its descriptions for CasADi.
    pub(super) fn text(&self, program: &Program) -> String {
        let names = |of: &[(String, String)]| {
            let names: Vec<String> = of.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            names.join(", ")
        };
        let shapes = |of: &[(String, String)]| {
            let shapes = of.iter().map(|(_, shape)| format!("NAME_{shape}_sparsity"));
            shapes.collect::<Vec<_>>().join(", ")
        };
        let text = FUNCTION
            .replace("GIVEN_NAMES", &names(&self.given))
            .replace("RESULT_NAMES", &names(&self.results))
            .replace("GIVEN_SHAPES", &shapes(&self.given))
            .replace("RESULT_SHAPES", &shapes(&self.results))
            .replace("GIVEN", &self.given.len().to_string())
            .replace("RESULTS", &self.results.len().to_string())
            .replace("ROOM", &self.work_length.to_string())
            .replace("FUNCTION", self.name);
        let head = format!(
            "CASADI_SYMBOL_EXPORT int {}(const casadi_real **arg, casadi_real **res, \
             casadi_int *iw, casadi_real *w, int mem) {{",
            self.name
        );
        let body = POINT.to_owned() + &self.statements + "return 0;\n";
        fill_template(program, &(text + &block(&head, &body, "}")))
    }
}

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
