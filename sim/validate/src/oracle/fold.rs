//! Constant folding by the same rules as `evaluate`.

use super::functions;
use super::tree::Tree;
use eomgen_model_spec::ast::BinaryOperator;

pub(super) fn binary_tree(operator: BinaryOperator, left: Tree, right: Tree) -> Tree {
    match (operator, &right) {
        (BinaryOperator::Power, Tree::Constant(exponent)) => Tree::Power(left.into(), *exponent),
        _ => Tree::Binary(operator, left.into(), right.into()),
    }
}

pub(super) fn fold_constants(tree: Tree) -> Tree {
    let numbers: Option<Vec<f64>> = tree
        .children()
        .into_iter()
        .map(|child| match child {
            Tree::Constant(value) => Some(*value),
            _ => None,
        })
        .collect();
    match (&tree, numbers.as_deref()) {
        (Tree::Negate(_), Some([value])) => Tree::Constant(-value),
        (Tree::Power(_, exponent), Some([base])) => {
            Tree::Constant(functions::constant_power(*base, *exponent))
        }
        (Tree::Binary(operator, ..), Some([left, right])) => {
            Tree::Constant(arithmetic(*operator, *left, *right))
        }
        (Tree::Call(function, _), Some(values)) => {
            Tree::Constant(functions::evaluate_function(*function, values))
        }
        _ => tree,
    }
}

fn arithmetic(operator: BinaryOperator, left: f64, right: f64) -> f64 {
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left * right,
        BinaryOperator::Divide => left / right,
        BinaryOperator::Power => left.powf(right),
    }
}
