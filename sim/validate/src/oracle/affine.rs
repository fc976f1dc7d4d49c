//! Affine forms of expressions in one regime: a constant plus multiples of time, state entries, inputs and atoms. An
//! atom is a subexpression that is not affine.

use super::Oracle;
use super::functions;
use super::switches::PrescribedSides;
use super::tree::Tree;
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::interval::Interval;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variable {
    Time,
    Entry(usize),
    Input(usize),
    /// Subexpression that is not affine, by its index in [`AffineForms`].
    Atom(usize),
}

/// Affine form `constant + sum of coefficient * variable`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Affine {
    pub constant: f64,
    /// Variables with nonzero coefficients, each variable once.
    pub terms: Vec<(Variable, f64)>,
}

/// Size, relative to the summands, below which a sum is treated as rounding error.
const MAX_CANCELLATION_RATIO: f64 = 1e-14;

impl Affine {
    pub fn constant(constant: f64) -> Self {
        Self {
            constant,
            terms: Vec::new(),
        }
    }

    fn variable(variable: Variable) -> Self {
        Self {
            constant: 0.0,
            terms: vec![(variable, 1.0)],
        }
    }

    pub fn add_scaled(mut self, factor: f64, other: &Self) -> Self {
        self.constant = sum_or_zero(self.constant, factor * other.constant);
        for (variable, coefficient) in &other.terms {
            let added = factor * coefficient;
            match self.terms.iter_mut().find(|(known, _)| known == variable) {
                Some((_, known)) => *known = sum_or_zero(*known, added),
                None => self.terms.push((*variable, added)),
            }
        }
        self.terms.retain(|(_, coefficient)| *coefficient != 0.0);
        self
    }

    pub fn has_atoms(&self) -> bool {
        let mut variables = self.terms.iter().map(|(variable, _)| variable);
        variables.any(|variable| matches!(variable, Variable::Atom(_)))
    }

    fn scale_by(&self, factor: f64) -> Self {
        Self::default().add_scaled(factor, self)
    }
}

/// Returns the sum of two numbers; 0 if only rounding error remains.
fn sum_or_zero(first: f64, second: f64) -> f64 {
    let sum = first + second;
    if sum.abs() <= MAX_CANCELLATION_RATIO * first.abs().max(second.abs()) {
        0.0
    } else {
        sum
    }
}

pub(super) struct AffineForms<'o> {
    oracle: &'o Oracle,
    prescribed_sides: PrescribedSides<'o>,
    pub atoms: Vec<(Tree, Interval)>,
}

impl<'o> AffineForms<'o> {
    pub fn new(oracle: &'o Oracle, imposed: PrescribedSides<'o>) -> Self {
        Self {
            oracle,
            prescribed_sides: imposed,
            atoms: Vec::new(),
        }
    }

    pub fn affine_form(&mut self, tree: &Tree) -> Affine {
        match tree {
            Tree::Constant(value) => Affine::constant(*value),
            Tree::Time => Affine::variable(Variable::Time),
            Tree::Coordinate(index) => Affine::variable(Variable::Entry(*index)),
            Tree::State(index) => Affine::variable(Variable::Entry(2 * self.oracle.size() + index)),
            Tree::Input(index) | Tree::PrescribedInput { input: index, .. } => {
                Affine::variable(Variable::Input(*index))
            }
            Tree::StateRate(index) => self.state_rate_form(*index),
            Tree::Definition(index) => match self.oracle.system.definitions.get(*index) {
                Some(definition) => self.affine_form(definition),
                None => self.add_atom(tree),
            },
            Tree::Dot(operand) => self.rate_form(tree, operand),
            Tree::Negate(operand) => self.affine_form(operand).scale_by(-1.0),
            Tree::Binary(operator, left, right) => self.binary_form(tree, *operator, left, right),
            Tree::Power(base, exponent) => {
                let base = self.affine_form(base);
                match base.terms.is_empty() {
                    true => Affine::constant(functions::constant_power(base.constant, *exponent)),
                    false => self.add_atom(tree),
                }
            }
            Tree::Call(function, arguments) => {
                let side = self.prescribed_sides.side(*function, arguments);
                let branch = side.and_then(|side| self.branch_form(*function, side, arguments));
                branch.unwrap_or_else(|| self.add_atom(tree))
            }
            _ => self.add_atom(tree),
        }
    }

    fn binary_form(
        &mut self,
        tree: &Tree,
        operator: BinaryOperator,
        left: &Tree,
        right: &Tree,
    ) -> Affine {
        let (first, second) = (self.affine_form(left), self.affine_form(right));
        let (still, fixed) = (first.terms.is_empty(), second.terms.is_empty());
        match operator {
            BinaryOperator::Add => first.add_scaled(1.0, &second),
            BinaryOperator::Subtract => first.add_scaled(-1.0, &second),
            BinaryOperator::Multiply if fixed => first.scale_by(second.constant),
            BinaryOperator::Multiply if still => second.scale_by(first.constant),
            BinaryOperator::Divide if fixed => first.scale_by(1.0 / second.constant),
            _ => self.add_atom(tree),
        }
    }

    /// Returns the affine form of a piecewise function on a side, if the function is linear in one argument on this
    /// side.
    fn branch_form(
        &mut self,
        function: eomgen_model_spec::model::Function,
        side: super::Side,
        arguments: &[Tree],
    ) -> Option<Affine> {
        let arguments: Vec<Affine> = arguments
            .iter()
            .map(|tree| self.affine_form(tree))
            .collect();
        // The function is linear on each side, so its values at unit arguments are the coefficients.
        let at = |numbers: &[f64]| functions::evaluate_on_side(function, side, numbers);
        let constant = at(&vec![0.0; arguments.len()])?;
        let mut form = Affine::constant(constant);
        for (place, argument) in arguments.iter().enumerate() {
            let mut unit = vec![0.0; arguments.len()];
            *unit.get_mut(place)? = 1.0;
            form = form.add_scaled(at(&unit)? - constant, argument);
        }
        Some(form)
    }

    fn state_rate_form(&mut self, index: usize) -> Affine {
        let oracle = self.oracle;
        let addends = oracle.system.state_rates.get(index).into_iter().flatten();
        addends.fold(Affine::default(), |form, addend| {
            let addend = self.affine_form(addend);
            form.add_scaled(1.0, &addend)
        })
    }

    fn rate_form(&mut self, tree: &Tree, operand: &Tree) -> Affine {
        let form = self.affine_form(operand);
        let mut rate = Affine::default();
        for (variable, coefficient) in &form.terms {
            let Some(moved) = self.variable_rate(*variable) else {
                return self.add_atom(tree);
            };
            rate = rate.add_scaled(*coefficient, &moved);
        }
        rate
    }

    fn variable_rate(&mut self, variable: Variable) -> Option<Affine> {
        let size = self.oracle.size();
        match variable {
            Variable::Time => Some(Affine::constant(1.0)),
            Variable::Entry(entry) if entry < size => {
                Some(Affine::variable(Variable::Entry(size + entry)))
            }
            Variable::Entry(entry) => Some(self.state_rate_form(entry.checked_sub(2 * size)?)),
            Variable::Input(input) => {
                let rate = self.oracle.input_rates.get(input).copied().flatten();
                let variable = |rate| Affine::variable(Variable::Input(rate));
                Some(rate.map_or_else(Affine::default, variable))
            }
            Variable::Atom(_) => None,
        }
    }

    fn add_atom(&mut self, tree: &Tree) -> Affine {
        let known = self.atoms.iter().position(|(known, _)| known == tree);
        let place = known.unwrap_or_else(|| {
            let bounds = self.oracle.bounds(tree, self.prescribed_sides);
            self.atoms.push((tree.clone(), bounds));
            self.atoms.len() - 1
        });
        match self.atoms.get(place) {
            Some((_, bounds)) if bounds.low == bounds.high => Affine::constant(bounds.low),
            _ => Affine::variable(Variable::Atom(place)),
        }
    }
}
