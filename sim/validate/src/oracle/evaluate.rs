//! Evaluation of a [`Tree`] at a [`Scene`] with derivatives in two directions. A time derivative adds a dual part along
//! the motion. `lower` rejects accelerations, because they would need two dual parts.

use super::conditioned::Conditioned;
use super::functions;
use super::scene::{Direction, Motion, Scene};
use super::tree::Tree;
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::Function;
use num_dual::{Dual, DualNum, HyperDual};
use std::cell::Cell;

/// Value with its derivatives in two directions.
pub(super) type Number = HyperDual<Conditioned>;

/// Number with derivatives in two directions, optionally also with its time derivative.
pub(super) trait EvaluationNumber: DualNum<Primitive = f64> + Copy {
    fn from_motion(motion: Motion) -> Self;
    fn dot(pass: &Pass<'_>, tree: &Tree, frame: &Frame<'_>) -> Self;
    fn state(pass: &Pass<'_>, index: usize) -> Self;
    fn definition_cache<'p>(
        pass: &'p Pass<'_>,
        definition: usize,
    ) -> Option<&'p Cell<Option<Self>>>;
    /// Returns integral `index` with its derivatives from the cache of all rows; `None` if they are not cached.
    fn integral(pass: &Pass<'_>, index: usize) -> Option<Self>;
    /// Returns true if the value and all its derivatives are 0.
    fn is_constant_zero(&self) -> bool;
}

impl EvaluationNumber for Number {
    fn from_motion(motion: Motion) -> Self {
        motion.value
    }

    fn dot(pass: &Pass<'_>, tree: &Tree, frame: &Frame<'_>) -> Self {
        pass.evaluate::<Dual<Number>>(tree, frame).eps
    }

    fn state(pass: &Pass<'_>, index: usize) -> Self {
        let along = pass.directions.contains(&Direction::Time);
        let still = || Pass::new(pass.scene, Direction::Zero, Direction::Zero);
        let rate = along.then(|| still().state_rate::<Self>(index, &Frame::Outside).re.value);
        pass.scene
            .state(index, rate.unwrap_or(0.0), pass.directions)
    }

    fn definition_cache<'p>(
        pass: &'p Pass<'_>,
        definition: usize,
    ) -> Option<&'p Cell<Option<Self>>> {
        Some(&pass.definitions.get(definition)?.0)
    }

    fn integral(pass: &Pass<'_>, index: usize) -> Option<Self> {
        pass.scene.integral(index, pass.directions)
    }

    fn is_constant_zero(&self) -> bool {
        let parts = [self.re, self.eps1, self.eps2, self.eps1eps2];
        parts.iter().all(|part| part.value == 0.0)
    }
}

impl EvaluationNumber for Dual<Number> {
    fn from_motion(motion: Motion) -> Self {
        Dual::new(motion.value, motion.rate)
    }

    fn dot(_: &Pass<'_>, _: &Tree, _: &Frame<'_>) -> Self {
        Self::from(f64::NAN)
    }

    fn state(pass: &Pass<'_>, index: usize) -> Self {
        let rate = pass.state_rate(index, &Frame::Outside);
        Dual::new(Number::state(pass, index), rate)
    }

    fn definition_cache<'p>(
        pass: &'p Pass<'_>,
        definition: usize,
    ) -> Option<&'p Cell<Option<Self>>> {
        Some(&pass.definitions.get(definition)?.1)
    }

    fn integral(_: &Pass<'_>, _: usize) -> Option<Self> {
        None
    }

    fn is_constant_zero(&self) -> bool {
        self.re.is_constant_zero() && self.eps.is_constant_zero()
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Frame<'f> {
    Outside,
    /// At a node of the enclosing set of positions.
    Place {
        node: usize,
        outer: &'f Frame<'f>,
    },
    Mode {
        field: usize,
        mode: usize,
        outer: &'f Frame<'f>,
    },
}

impl Frame<'_> {
    fn node(&self) -> usize {
        match self {
            Self::Outside => usize::MAX,
            Self::Place { node, .. } => *node,
            Self::Mode { outer, .. } => outer.node(),
        }
    }

    fn mode(&self, wanted: usize) -> usize {
        match self {
            Self::Outside => usize::MAX,
            Self::Place { outer, .. } => outer.mode(wanted),
            Self::Mode { field, mode, .. } if *field == wanted => *mode,
            Self::Mode { outer, .. } => outer.mode(wanted),
        }
    }
}

type DefinitionCache = (Cell<Option<Number>>, Cell<Option<Dual<Number>>>);

#[derive(Debug)]
pub(super) struct Pass<'s> {
    scene: &'s Scene<'s>,
    directions: [Direction; 2],
    definitions: Vec<DefinitionCache>,
}

impl<'s> Pass<'s> {
    pub fn new(scene: &'s Scene<'s>, first: Direction, second: Direction) -> Self {
        Self {
            scene,
            directions: [first, second],
            definitions: vec![DefinitionCache::default(); scene.system.definitions.len()],
        }
    }

    pub fn value(&self, tree: &Tree) -> Number {
        self.evaluate(tree, &Frame::Outside)
    }

    pub fn value_at_mode(&self, tree: &Tree, field: usize, mode: usize) -> f64 {
        let frame = Frame::Mode {
            field,
            mode,
            outer: &Frame::Outside,
        };
        self.evaluate::<Number>(tree, &frame).re.value
    }

    pub fn evaluate<N: EvaluationNumber>(&self, tree: &Tree, frame: &Frame<'_>) -> N {
        match tree {
            Tree::Definition(index) => self.definition(*index),
            Tree::Dot(operand) => N::dot(self, operand, frame),
            Tree::Places {
                set,
                body,
                integral,
            } => integral
                .and_then(|index| N::integral(self, index))
                .unwrap_or_else(|| self.sum_over_places(*set, body, frame)),
            Tree::Sum { field, body } => self.sum_over_modes(*field, body, frame),
            Tree::Negate(operand) => -self.evaluate::<N>(operand, frame),
            Tree::Binary(operator, left, right) => {
                let [first, second] = [left, right].map(|side| self.evaluate::<N>(side, frame));
                let is_power = *operator == BinaryOperator::Power;
                match is_power && self.has_zero_power((left, &first), second.re(), frame) {
                    true => N::from(0.0),
                    false => combine_operands(*operator, first, second),
                }
            }
            Tree::Power(base, exponent) => {
                let value = self.evaluate::<N>(base, frame);
                match self.has_zero_power((base, &value), *exponent, frame) {
                    true => N::from(0.0),
                    false => functions::constant_power(value, *exponent),
                }
            }
            Tree::Call(Function::Sqrt, arguments) if arguments.len() == 1 => {
                let value = self.evaluate::<N>(&arguments[0], frame);
                match self.has_zero_power((&arguments[0], &value), 0.5, frame) {
                    true => N::from(0.0),
                    false => value.sqrt(),
                }
            }
            Tree::Call(function, arguments) => self.evaluate_call(*function, arguments, frame),
            Tree::Time => N::from_motion(self.time()),
            Tree::Coordinate(index) => {
                N::from_motion(self.scene.coordinate(*index, self.directions))
            }
            Tree::PrescribedInput {
                input,
                rate,
                second,
            } => {
                let rates = (*rate, *second);
                N::from_motion(self.scene.prescribed_input(*input, rates, self.directions))
            }
            Tree::Input(index) => {
                N::from_motion(self.scene.constant_input(*index, self.directions))
            }
            Tree::Multiplier(index) => {
                let known = self.scene.multipliers.get(*index).copied();
                N::from_motion(Motion::constant(known.unwrap_or_else(|| f64::NAN.into())))
            }
            Tree::State(index) => N::state(self, *index),
            Tree::StateRate(index) => self.state_rate(*index, frame),
            Tree::Field { leaf, set } => {
                N::from_motion(self.scene.field(*leaf, *set, frame.node(), self.directions))
            }
            Tree::Mode { field } => N::from_motion(self.mode(*field, frame)),
            still => N::from(self.constant_value(still, frame)),
        }
    }

    /// Returns true if a power of a base that is 0 with all its derivatives is 0 with all its derivatives. The chain
    /// rule would give infinity times 0. An exponent above 1 is sufficient. For a smaller exponent, the base must be 0
    /// on a side of a switch. Then it is constant, unlike x^4 at x = 0.
    fn has_zero_power<N: EvaluationNumber>(
        &self,
        (base, value): (&Tree, &N),
        exponent: f64,
        frame: &Frame<'_>,
    ) -> bool {
        exponent > 0.0
            && value.is_constant_zero()
            && (exponent > 1.0 || self.is_beside_switch(base, frame))
    }

    /// Returns true if an expression contains a switch and the state is not on its switching surface.
    fn is_beside_switch(&self, tree: &Tree, frame: &Frame<'_>) -> bool {
        let value = |tree: &Tree| self.evaluate::<Number>(tree, frame).re.value;
        let is_beside = match tree {
            Tree::Call(Function::Max | Function::Min, arguments) => {
                let mut values = arguments.iter().map(value);
                values.next() != values.next()
            }
            Tree::Call(Function::Deadzone | Function::Contact, arguments) => {
                let mut values = arguments.iter().map(|argument| value(argument).abs());
                values.next() != values.next()
            }
            Tree::Call(Function::Above, arguments) => {
                arguments.iter().all(|argument| value(argument) != 0.0)
            }
            Tree::Definition(index) => {
                let definition = self.scene.system.definitions.get(*index);
                definition.is_some_and(|tree| self.is_beside_switch(tree, &Frame::Outside))
            }
            Tree::Places { .. } | Tree::Sum { .. } => return false,
            _ => false,
        };
        let mut children = tree.children().into_iter();
        is_beside || children.any(|child| self.is_beside_switch(child, frame))
    }

    fn state_rate<N: EvaluationNumber>(&self, index: usize, frame: &Frame<'_>) -> N {
        let mut sum = N::from(0.0);
        for addend in self
            .scene
            .system
            .state_rates
            .get(index)
            .into_iter()
            .flatten()
        {
            sum += self.evaluate::<N>(addend, frame);
        }
        sum
    }

    /// Returns a value that does not depend on state or time.
    fn constant_value(&self, tree: &Tree, frame: &Frame<'_>) -> f64 {
        let number = match tree {
            Tree::Constant(value) => Some(*value),
            Tree::PerMode { field, values } => values.get(frame.mode(*field)).copied(),
            Tree::Position { set } => {
                let places = self.scene.system.places.get(*set);
                places.and_then(|places| places.positions.get(frame.node()).copied())
            }
            Tree::Shape { leaf, set } => {
                let mode = frame.mode(leaf.field);
                Some(self.scene.shape(*leaf, *set, frame.node(), mode))
            }
            _ => None,
        };
        number.unwrap_or(f64::NAN)
    }

    fn time(&self) -> Motion {
        let seeds = self
            .directions
            .map(|direction| (Scene::time_seed(direction), 0.0));
        Motion::new((self.scene.time, 1.0), seeds)
    }

    fn mode(&self, field: usize, frame: &Frame<'_>) -> Motion {
        let index = self.scene.system.modes(field).start + frame.mode(field);
        self.scene.coordinate(index, self.directions)
    }

    /// Returns the value of a definition. It is evaluated once per pass, because it contains no free position or index.
    fn definition<N: EvaluationNumber>(&self, index: usize) -> N {
        let kept = N::definition_cache(self, index);
        if let Some(value) = kept.and_then(Cell::get) {
            return value;
        }
        let Some(tree) = self.scene.system.definitions.get(index) else {
            return N::from(f64::NAN);
        };
        let value = self.evaluate(tree, &Frame::Outside);
        if let Some(kept) = kept {
            kept.set(Some(value));
        }
        value
    }

    fn sum_over_places<N: EvaluationNumber>(
        &self,
        set: usize,
        body: &Tree,
        outer: &Frame<'_>,
    ) -> N {
        let Some(places) = self.scene.system.places.get(set) else {
            return N::from(f64::NAN);
        };
        let mut sum = N::from(0.0);
        for (node, weight) in places.weights.iter().enumerate() {
            sum += self.evaluate::<N>(body, &Frame::Place { node, outer }) * *weight;
        }
        sum
    }

    fn sum_over_modes<N: EvaluationNumber>(
        &self,
        field: usize,
        body: &Tree,
        outer: &Frame<'_>,
    ) -> N {
        let mut sum = N::from(0.0);
        for mode in 0..self.scene.system.modes(field).len() {
            sum += self.evaluate::<N>(body, &Frame::Mode { field, mode, outer });
        }
        sum
    }

    fn evaluate_call<N: EvaluationNumber>(
        &self,
        function: Function,
        arguments: &[Tree],
        frame: &Frame<'_>,
    ) -> N {
        let side = self
            .scene
            .prescribed_sides
            .and_then(|imposed| imposed.side(function, arguments));
        let value = |values: &[N]| {
            side.and_then(|side| functions::evaluate_on_side(function, side, values))
                .unwrap_or_else(|| functions::evaluate_function(function, values))
        };
        match arguments {
            [only] => value(&[self.evaluate::<N>(only, frame)]),
            [first, second] => value(&[
                self.evaluate::<N>(first, frame),
                self.evaluate::<N>(second, frame),
            ]),
            _ => N::from(f64::NAN),
        }
    }
}

fn combine_operands<N: EvaluationNumber>(operator: BinaryOperator, left: N, right: N) -> N {
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left * right,
        BinaryOperator::Divide => left / right,
        BinaryOperator::Power => left.powd(right),
    }
}
