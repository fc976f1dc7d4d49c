//! Proof that an expression is zero on no open set of states. A switch of such an expression cannot remain at zero.

use super::affine::{Affine, AffineForms, Variable};
use super::tree::Tree;
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::Function;

impl AffineForms<'_> {
    /// Returns true if the structure of an expression shows that its zeros in this regime form no open set.
    pub fn is_nonzero_almost_everywhere(&mut self, tree: &Tree) -> bool {
        let form = self.affine_form(tree);
        if !form.has_atoms() {
            return form != Affine::default();
        }
        let [(Variable::Atom(place), _)] = form.terms[..] else {
            return false;
        };
        let atom = self.atoms.get(place).map(|(tree, _)| tree.clone());
        form.constant == 0.0 && atom.is_some_and(|atom| self.is_atom_nonzero(&atom))
    }

    fn is_atom_nonzero(&mut self, atom: &Tree) -> bool {
        match atom {
            Tree::Binary(BinaryOperator::Multiply | BinaryOperator::Divide, left, right) => {
                self.is_nonzero_almost_everywhere(left) && self.is_nonzero_almost_everywhere(right)
            }
            Tree::Binary(BinaryOperator::Power, base, _) | Tree::Power(base, _) => {
                self.is_nonzero_almost_everywhere(base)
            }
            Tree::Call(Function::Exp | Function::Cosh, _) => true,
            Tree::Call(
                Function::Sqrt | Function::Sinh | Function::Tanh | Function::Asin | Function::Atan,
                arguments,
            ) => arguments
                .iter()
                .all(|argument| self.is_nonzero_almost_everywhere(argument)),
            Tree::Call(Function::Sin | Function::Cos | Function::Tan, arguments) => {
                arguments.iter().all(|argument| {
                    let form = self.affine_form(argument);
                    !form.has_atoms() && !form.terms.is_empty()
                })
            }
            _ => false,
        }
    }
}
