//! Affine values of a program, found from its operations. A numerical test would depend on units:
//! the square root of a pressure seems constant near one pascal.

use eomgen_codegen::program::{Op, Program, ValueId};

/// Dependence of a value on the state, in increasing order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Dependence {
    /// The value does not depend on the state.
    Constant,
    /// The value is a weighted sum of states plus a constant.
    Affine,
    /// Any other dependence, also on inputs or time.
    Other,
}

/// Returns true if the values are weighted sums of states plus a constant. The weights depend only
/// on parameters.
pub(crate) fn are_affine(program: &Program, values: &[ValueId]) -> bool {
    let mut forms = vec![Dependence::Other; program.values.len()];
    for id in program.reachable(values) {
        forms[id.index()] = classify(program, id, &forms);
    }
    values
        .iter()
        .all(|value| forms[value.index()] <= Dependence::Affine)
}

/// Returns the dependence of a value from the dependence of its operands.
fn classify(program: &Program, id: ValueId, forms: &[Dependence]) -> Dependence {
    let value = program.value(id);
    if value.parameter_only {
        return Dependence::Constant;
    }
    let of = |id: &ValueId| forms[id.index()];
    // A product is affine if one factor is affine and the other is constant.
    let product = |a: Dependence, b: Dependence| match a.min(b) {
        Dependence::Constant => a.max(b),
        Dependence::Affine | Dependence::Other => Dependence::Other,
    };
    match &value.op {
        Op::Coordinate(_)
        | Op::Rate(_)
        | Op::ModeCoordinates(_)
        | Op::ModeRates(_)
        | Op::State(_) => Dependence::Affine,
        Op::Negate(a) | Op::Total(a) => of(a),
        Op::Add(a, b) | Op::Subtract(a, b) => of(a).max(of(b)),
        Op::Multiply(a, b) => product(of(a), of(b)),
        Op::Apply { matrix, vector, .. } => product(of(matrix), of(vector)),
        Op::Divide(a, b) if of(b) == Dependence::Constant => of(a),
        Op::CholeskySolve(factor, right) if of(factor) == Dependence::Constant => of(right),
        _ => Dependence::Other,
    }
}
