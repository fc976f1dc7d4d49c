//! Helper functions of the stages: piecewise functions, reciprocals of pivots, and elementary functions from
//! their kernels. Each has only numbers as arguments; none calls another.

use wasm_encoder::Function;

use super::code::Code;
use super::indices::Indices;
use super::memory::Memory;
use crate::program::Program;
use crate::statements::{EmitResult, Expression, KernelStatements, RequiredFunctions, Statement};
use eomgen_elementary::{Double, Function as Elementary};

#[derive(Debug)]
pub(super) struct Helper {
    pub(super) name: &'static str,
    pub(super) arguments: &'static [&'static str],
    computed: Vec<Statement>,
    value: Expression,
}

impl Helper {
    pub(super) fn function(
        &self,
        program: &Program,
        memory: &mut Memory,
        functions: &Indices,
    ) -> EmitResult<Function> {
        let mut code = Code::new(program, memory, functions, self.arguments);
        code.statements(&self.computed)?;
        code.expression(&self.value)?;
        Ok(code.finish())
    }
}

pub(super) fn helpers(needed: &RequiredFunctions) -> Vec<Helper> {
    let mut elementary = needed.elementary.clone();
    if needed.cholesky || needed.cholesky_of_matrix {
        elementary.insert(Elementary::Sqrt);
    }
    let mut all: Vec<Helper> = elementary.into_iter().filter_map(kernel_helper).collect();
    for (needed, helper) in [
        (needed.deadzone, deadzone as fn() -> Helper),
        (needed.contact, contact),
        (needed.above, above),
        (needed.pivot_reciprocal, pivot_reciprocal),
    ] {
        if needed {
            all.push(helper());
        }
    }
    all
}

fn kernel_helper(function: Elementary) -> Option<Helper> {
    let arguments: &[&str] = match function.arity() {
        2 => &["x", "y"],
        _ => &["x"],
    };
    let kernel = KernelStatements::new::<Double>(function, arguments);
    Some(Helper {
        name: function.name(),
        arguments,
        value: kernel.value()?.clone(),
        computed: kernel.computed,
    })
}

/// Returns `then` if a > b, else `otherwise`.
fn select(a: &Expression, b: &Expression, then: Expression, otherwise: Expression) -> Expression {
    Expression::Select(Box::new([a.clone(), b.clone(), then, otherwise]))
}

fn deflection_helper(
    name: &'static str,
    computed: Vec<Statement>,
    value: impl FnOnce(&Expression, &Expression) -> Expression,
) -> Helper {
    Helper {
        name,
        arguments: &["p", "b"],
        computed,
        value: value(&Expression::name("p"), &Expression::name("b")),
    }
}

/// Deflection beyond the backlash: f_k of Eq. (7).
fn deadzone() -> Helper {
    let [p, b, held] = ["p", "b", "held"].map(Expression::name);
    let within = select(&p, &b, b.clone(), p.clone());
    deflection_helper(
        "deadzone",
        vec![Statement::Let("held".to_owned(), within)],
        |p, b| {
            let least = Expression::negate(b);
            Expression::subtract(p, &select(&least, &held, least.clone(), held.clone()))
        },
    )
}

/// Indicator of |p| > b: the contact of Eq. (8).
fn contact() -> Helper {
    let [zero, one] = [0.0, 1.0].map(Expression::Number);
    deflection_helper("contact", Vec::new(), |p, b| {
        let beyond = select(&Expression::negate(b), p, one.clone(), zero);
        select(p, b, one, beyond)
    })
}

/// Indicator of p > 0.
fn above() -> Helper {
    let [zero, one] = [0.0, 1.0].map(Expression::Number);
    let p = Expression::name("p");
    Helper {
        name: "above",
        arguments: &["p"],
        computed: Vec::new(),
        value: select(&p, &zero, one, zero.clone()),
    }
}

/// 1/pivot of a positive pivot; NaN if the mass matrix is not positive definite.
fn pivot_reciprocal() -> Helper {
    let [zero, one, none] = [0.0, 1.0, f64::NAN].map(Expression::Number);
    let pivot = Expression::name("pivot");
    Helper {
        name: "pivot_reciprocal",
        arguments: &["pivot"],
        computed: Vec::new(),
        value: select(&pivot, &zero, Expression::divide(&one, &pivot), none),
    }
}
