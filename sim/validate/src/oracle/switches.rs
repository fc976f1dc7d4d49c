//! Switches of the model: quantities at whose zeros a piecewise function changes its branch. Functions inside integrals
//! and sums over modes are excluded, because each position or mode has a separate side.

use super::evaluate::Pass;
use super::scene::Direction;
use super::tree::Tree;
use super::{Oracle, OracleError};
use eomgen_model_spec::model::{Function, Model};

/// Quantity with a switching surface at zero, or with two surfaces at plus and minus a half-width.
#[derive(Clone, Debug, PartialEq)]
pub struct Switch {
    /// Name of the quantity in the specification, or `switch_1 ..`.
    pub name: String,
    quantity: Tree,
    half_width: Option<Tree>,
    /// True if the quantity contains a piecewise function: it can be zero in a whole region.
    rests_at_zero: bool,
}

/// Side of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// Below minus the half-width.
    Minus,
    /// Within the half-width. Without half-width: equal to zero, only if the quantity can be constantly zero.
    Free,
    /// Above the half-width.
    Plus,
}

/// Value of a switch at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchValue {
    /// Value of the quantity.
    pub quantity: f64,
    /// Half-width; 0 for a switch at 0.
    pub half_width: f64,
}

impl SwitchValue {
    /// Returns the side of the state.
    pub fn side(&self) -> Side {
        if self.quantity > self.half_width {
            Side::Plus
        } else if self.quantity < -self.half_width {
            Side::Minus
        } else {
            Side::Free
        }
    }
}

/// Derivatives of a switch with respect to the entries of the state, the inputs and the time, in this order.
#[derive(Clone, Debug, PartialEq)]
pub struct SwitchGradient {
    /// Derivatives of the quantity.
    pub quantity: Vec<f64>,
    /// Derivatives of the half-width; 0 for a switch at 0.
    pub half_width: Vec<f64>,
}

impl Switch {
    pub(super) fn quantity(&self) -> &Tree {
        &self.quantity
    }

    pub(super) fn half_width(&self) -> Option<&Tree> {
        self.half_width.as_ref()
    }

    /// Returns true if the quantity can be constantly zero in a region of states (side `Free`).
    pub fn rests_at_zero(&self) -> bool {
        self.half_width.is_none() && self.rests_at_zero
    }

    /// Returns the possible sides of this switch.
    pub fn sides(&self) -> &'static [Side] {
        if self.half_width.is_some() || self.rests_at_zero {
            &[Side::Minus, Side::Free, Side::Plus]
        } else {
            &[Side::Minus, Side::Plus]
        }
    }
}

/// Prescribed sides of piecewise functions, independent of the state.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrescribedSides<'s> {
    pub switches: &'s [Switch],
    pub sides: &'s [Side],
}

impl PrescribedSides<'_> {
    /// Returns the prescribed side of a function with these arguments; `None` if it is not a switch.
    pub fn side(&self, function: Function, arguments: &[Tree]) -> Option<Side> {
        let (quantity, half_width) = switching_quantity(function, arguments)?;
        let known =
            |switch: &Switch| switch.quantity == quantity && switch.half_width == half_width;
        let index = self.switches.iter().position(known)?;
        self.sides.get(index).copied()
    }
}

/// Returns the switching quantity and the half-width (if any) of a piecewise function; `None` for a smooth function.
fn switching_quantity(function: Function, arguments: &[Tree]) -> Option<(Tree, Option<Tree>)> {
    match (function, arguments) {
        (Function::Abs | Function::Sign | Function::Above, [argument]) => {
            Some((argument.clone(), None))
        }
        (Function::Deadzone | Function::Contact, [p, b]) => Some((p.clone(), Some(b.clone()))),
        (Function::Min | Function::Max, [left, right]) => Some((subtract_trees(left, right), None)),
        _ => None,
    }
}

impl Oracle {
    /// Returns all switches at a state.
    pub fn switch_values(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Vec<SwitchValue>, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let pass = Pass::new(&scene, Direction::Zero, Direction::Zero);
        let value = |switch: &Switch| SwitchValue {
            quantity: pass.value(&switch.quantity).re.value,
            half_width: switch
                .half_width
                .as_ref()
                .map_or(0.0, |width| pass.value(width).re.value),
        };
        Ok(self.switches.iter().map(value).collect())
    }

    /// Returns the derivatives of the quantity of switch `index` by every entry of the state.
    pub fn switch_slopes(
        &self,
        index: usize,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Vec<f64>, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let Some(switch) = self.switches.get(index) else {
            return Ok(vec![0.0; state.len()]);
        };
        Ok(self
            .state_directions()
            .map(|direction| {
                let pass = Pass::new(&scene, Direction::Zero, direction);
                pass.value(&switch.quantity).eps2.value
            })
            .collect())
    }
}

impl Oracle {
    /// Returns the derivatives of quantity and half-width by every state entry, input and the time.
    pub fn switch_gradient(
        &self,
        index: usize,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<SwitchGradient, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let directions: Vec<Direction> = self
            .state_directions()
            .chain((0..self.input_count()).map(Direction::Input))
            .chain([Direction::ExplicitTime])
            .collect();
        let switch = self.switches.get(index);
        let along = |tree: Option<&Tree>| {
            let slope = |direction: &Direction| {
                let pass = Pass::new(&scene, Direction::Zero, *direction);
                tree.map_or(0.0, |tree| pass.value(tree).eps2.value)
            };
            directions.iter().map(slope).collect()
        };
        Ok(SwitchGradient {
            quantity: along(switch.map(Switch::quantity)),
            half_width: along(switch.and_then(Switch::half_width)),
        })
    }

    fn state_directions(&self) -> impl Iterator<Item = Direction> + use<> {
        let rows = 0..self.size();
        rows.clone()
            .map(Direction::Position)
            .chain(rows.map(Direction::Rate))
            .chain((0..self.states).map(Direction::State))
    }
}

pub(super) fn find_switches(oracle: &Oracle, model: &Model) -> Vec<Switch> {
    let mut search = SwitchSearch {
        oracle,
        model,
        visited: vec![false; oracle.system.definitions.len()],
        found: Vec::new(),
    };
    let energies = oracle.kinetic.iter().chain(&oracle.potential);
    for term in energies.chain(&oracle.dissipation) {
        search.search_tree(&term.tree);
    }
    for force in &oracle.forces {
        search.search_tree(&force.coordinate_tree);
        search.search_tree(&force.value);
    }
    for addend in oracle.system.state_rates.iter().flatten() {
        search.search_tree(addend);
    }
    search.found
}

struct SwitchSearch<'s> {
    oracle: &'s Oracle,
    model: &'s Model,
    visited: Vec<bool>,
    found: Vec<Switch>,
}

impl SwitchSearch<'_> {
    fn search_tree(&mut self, tree: &Tree) {
        if let Tree::Call(function, arguments) = tree {
            self.add(*function, arguments);
        }
        if let Tree::Definition(index) = tree {
            let oracle = self.oracle;
            if let Some(visited) = self.visited.get_mut(*index)
                && !std::mem::replace(visited, true)
                && let Some(definition) = oracle.system.definitions.get(*index)
            {
                self.search_tree(definition);
            }
        }
        for child in tree.children() {
            self.search_tree(child);
        }
    }

    fn add(&mut self, function: Function, arguments: &[Tree]) {
        let Some((quantity, half_width)) = switching_quantity(function, arguments) else {
            return;
        };
        let dependence = self.oracle.system.dependence(&quantity);
        let inside = dependence.has_position
            || !dependence.leaves.is_empty()
            || !dependence.indices.is_empty();
        let known = self
            .found
            .iter()
            .any(|switch| switch.quantity == quantity && switch.half_width == half_width);
        if !inside && !known {
            let name = self
                .name(&quantity)
                .unwrap_or_else(|| format!("switch_{}", self.found.len() + 1));
            self.found.push(Switch {
                name,
                rests_at_zero: self.is_piecewise(&quantity),
                quantity,
                half_width,
            });
        }
    }

    fn is_piecewise(&self, tree: &Tree) -> bool {
        let own = match tree {
            Tree::Call(function, _) if is_piecewise_function(*function) => true,
            Tree::Definition(index) => {
                let definition = self.oracle.system.definitions.get(*index);
                definition.is_some_and(|definition| self.is_piecewise(definition))
            }
            _ => false,
        };
        own || tree
            .children()
            .into_iter()
            .any(|child| self.is_piecewise(child))
    }

    fn name(&self, tree: &Tree) -> Option<String> {
        match tree {
            Tree::Coordinate(index) => self.oracle.names.get(*index).cloned(),
            Tree::Definition(index) => Some(self.model.definitions.get(*index)?.name.clone()),
            Tree::State(index) => Some(self.model.states.get(*index)?.name.clone()),
            Tree::StateRate(index) => Some(format!("{}_dot", self.model.states.get(*index)?.name)),
            Tree::Dot(operand) => Some(format!("{}_dot", self.name(operand)?)),
            _ => None,
        }
    }
}

pub(super) fn is_piecewise_function(function: Function) -> bool {
    matches!(
        function,
        Function::Abs
            | Function::Sign
            | Function::Above
            | Function::Deadzone
            | Function::Contact
            | Function::Min
            | Function::Max
    )
}

fn subtract_trees(left: &Tree, right: &Tree) -> Tree {
    let operator = eomgen_model_spec::ast::BinaryOperator::Subtract;
    Tree::Binary(operator, left.clone().into(), right.clone().into())
}

impl Side {
    /// Returns `-`, `0` or `+`.
    pub fn symbol(self) -> char {
        match self {
            Self::Minus => '-',
            Self::Free => '0',
            Self::Plus => '+',
        }
    }

    /// Returns -1, 0 or 1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Minus => -1.0,
            Self::Free => 0.0,
            Self::Plus => 1.0,
        }
    }
}
