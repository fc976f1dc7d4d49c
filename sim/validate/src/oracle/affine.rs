//! Affine forms of expressions in one regime: a constant plus multiples of time, state entries,
//! inputs and atoms. An atom is a subexpression that is not affine.

use super::Oracle;
use super::functions;
use super::switches::Imposed;
use super::tree::Tree;
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::interval::Interval;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variable {
    Time,
    Entry(usize),
    Input(usize),
    /// Subexpression that is not affine, by its index in [`Forms`].
    Atom(usize),
}

/// Affine form `constant + sum of coefficient * variable`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Affine {
    pub constant: f64,
    /// Variables with nonzero coefficients, each variable once.
    pub terms: Vec<(Variable, f64)>,
}

/// Relative size below which a coefficient after cancellation is rounding error.
const CANCELLED: f64 = 1e-14;

impl Affine {
    fn constant(constant: f64) -> Self {
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

    pub fn plus(mut self, factor: f64, other: &Self) -> Self {
        self.constant = sum(self.constant, factor * other.constant);
        for (variable, coefficient) in &other.terms {
            let added = factor * coefficient;
            match self.terms.iter_mut().find(|(known, _)| known == variable) {
                Some((_, known)) => *known = sum(*known, added),
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

    fn times(&self, factor: f64) -> Self {
        Self::default().plus(factor, self)
    }
}

/// Returns the sum of two numbers; 0 if only rounding error remains.
fn sum(first: f64, second: f64) -> f64 {
    let sum = first + second;
    if sum.abs() <= CANCELLED * first.abs().max(second.abs()) {
        0.0
    } else {
        sum
    }
}

pub(super) struct Forms<'o> {
    oracle: &'o Oracle,
    imposed: Imposed<'o>,
    pub atoms: Vec<(Tree, Interval)>,
}

impl<'o> Forms<'o> {
    pub fn new(oracle: &'o Oracle, imposed: Imposed<'o>) -> Self {
        Self {
            oracle,
            imposed,
            atoms: Vec::new(),
        }
    }

    pub fn of(&mut self, tree: &Tree) -> Affine {
        match tree {
            Tree::Constant(value) => Affine::constant(*value),
            Tree::Time => Affine::variable(Variable::Time),
            Tree::Coordinate(index) => Affine::variable(Variable::Entry(*index)),
            Tree::State(index) => Affine::variable(Variable::Entry(2 * self.oracle.size() + index)),
            Tree::Input(index) | Tree::PrescribedInput { input: index, .. } => {
                Affine::variable(Variable::Input(*index))
            }
            Tree::StateRate(index) => self.state_rate(*index),
            Tree::Definition(index) => match self.oracle.system.definitions.get(*index) {
                Some(definition) => self.of(definition),
                None => self.atom(tree),
            },
            Tree::Dot(operand) => self.rate(tree, operand),
            Tree::Negate(operand) => self.of(operand).times(-1.0),
            Tree::Binary(operator, left, right) => self.binary(tree, *operator, left, right),
            Tree::Power(base, exponent) => {
                let base = self.of(base);
                match base.terms.is_empty() {
                    true => Affine::constant(functions::constant_power(base.constant, *exponent)),
                    false => self.atom(tree),
                }
            }
            Tree::Call(function, arguments) => {
                let side = self.imposed.side(*function, arguments);
                let branch = side.and_then(|side| self.branch(*function, side, arguments));
                branch.unwrap_or_else(|| self.atom(tree))
            }
            _ => self.atom(tree),
        }
    }

    fn binary(
        &mut self,
        tree: &Tree,
        operator: BinaryOperator,
        left: &Tree,
        right: &Tree,
    ) -> Affine {
        let (first, second) = (self.of(left), self.of(right));
        let (still, fixed) = (first.terms.is_empty(), second.terms.is_empty());
        match operator {
            BinaryOperator::Add => first.plus(1.0, &second),
            BinaryOperator::Subtract => first.plus(-1.0, &second),
            BinaryOperator::Multiply if fixed => first.times(second.constant),
            BinaryOperator::Multiply if still => second.times(first.constant),
            BinaryOperator::Divide if fixed => first.times(1.0 / second.constant),
            _ => self.atom(tree),
        }
    }

    /// Returns the affine form of a piecewise function on a side, if it is linear in one argument.
    fn branch(
        &mut self,
        function: eomgen_model_spec::model::Function,
        side: super::Side,
        arguments: &[Tree],
    ) -> Option<Affine> {
        let arguments: Vec<Affine> = arguments.iter().map(|tree| self.of(tree)).collect();
        // The value on a side is linear, so values at unit arguments are coefficients.
        let at = |numbers: &[f64]| functions::on_side(function, side, numbers);
        let constant = at(&vec![0.0; arguments.len()])?;
        let mut form = Affine::constant(constant);
        for (place, argument) in arguments.iter().enumerate() {
            let mut unit = vec![0.0; arguments.len()];
            *unit.get_mut(place)? = 1.0;
            form = form.plus(at(&unit)? - constant, argument);
        }
        Some(form)
    }

    fn state_rate(&mut self, index: usize) -> Affine {
        let oracle = self.oracle;
        let addends = oracle.system.state_rates.get(index).into_iter().flatten();
        addends.fold(Affine::default(), |form, addend| {
            let addend = self.of(addend);
            form.plus(1.0, &addend)
        })
    }

    fn rate(&mut self, tree: &Tree, operand: &Tree) -> Affine {
        let form = self.of(operand);
        let mut rate = Affine::default();
        for (variable, coefficient) in &form.terms {
            let Some(moved) = self.variable_rate(*variable) else {
                return self.atom(tree);
            };
            rate = rate.plus(*coefficient, &moved);
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
            Variable::Entry(entry) => Some(self.state_rate(entry.checked_sub(2 * size)?)),
            Variable::Input(input) => {
                let rate = self.oracle.input_rates.get(input).copied().flatten();
                let variable = |rate| Affine::variable(Variable::Input(rate));
                Some(rate.map_or_else(Affine::default, variable))
            }
            Variable::Atom(_) => None,
        }
    }

    fn atom(&mut self, tree: &Tree) -> Affine {
        let known = self.atoms.iter().position(|(known, _)| known == tree);
        let place = known.unwrap_or_else(|| {
            let bounds = self.oracle.bounds(tree, self.imposed);
            self.atoms.push((tree.clone(), bounds));
            self.atoms.len() - 1
        });
        match self.atoms.get(place) {
            Some((_, bounds)) if bounds.low == bounds.high => Affine::constant(bounds.low),
            _ => Affine::variable(Variable::Atom(place)),
        }
    }
}
