//! Proofs that no state has a given combination of sides. A regime is empty if the inequalities of the switches, the
//! ranges and the bounds of atoms contradict each other.

use super::affine::{Affine, AffineForms, Variable};
use super::switches::{PrescribedSides, Side, is_piecewise_function};
use super::tree::Tree;
use super::{Oracle, Switch};
use crate::feasibility::cone_is_empty;
use eomgen_model_spec::interval::Interval;
use eomgen_model_spec::model::Function;

/// Relative widening of bounds. Without it, a range as narrow as the rounding error would be a contradiction.
const RELATIVE_SLACK: f64 = 1e-9;

/// Bound of the relative rounding error of an affine form.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Kind of an inequality.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Relation {
    /// > 0.
    Positive,
    /// >= 0, and > 0 at some states.
    PositiveInside,
    /// >= 0.
    NotNegative,
}

impl Oracle {
    /// Returns true if bounds prove that no state has these sides of the first switches of
    /// [`Oracle::switches`]. `sizes` and `input_sizes` only scale the inequalities.
    ///
    /// Ranges are closed: a regime beyond a switching surface at the end of a range is empty. States on the boundary
    /// of a function's domain are ignored.
    pub fn is_empty(&self, sides: &[Side], sizes: &[f64], input_sizes: &[f64]) -> bool {
        let switches = self.switches.get(..sides.len()).unwrap_or_default();
        let imposed = PrescribedSides { switches, sides };
        let mut forms = AffineForms::new(self, imposed);
        let mut rows = Vec::new();
        for (switch, side) in switches.iter().zip(sides) {
            rows.extend(side_rows(&mut forms, switch, *side));
        }
        for argument in self.domain_arguments() {
            rows.push((forms.affine_form(argument), Relation::PositiveInside));
        }
        let is_false = |(form, relation): &(Affine, Relation)| {
            let (most, rounding) = self.largest_value(form, &forms);
            match relation {
                Relation::Positive => most <= rounding,
                Relation::PositiveInside if !form.terms.is_empty() => most <= rounding,
                Relation::PositiveInside => most < -rounding,
                Relation::NotNegative => most < -rounding,
            }
        };
        if rows.iter().any(is_false) {
            return true;
        }
        let rows = rows.into_iter().map(|(form, _)| form);
        let rows: Vec<Affine> = rows.filter(|form| !form.terms.is_empty()).collect();
        cone_is_empty(&self.homogeneous_system(&rows, &forms, sizes, input_sizes))
    }

    /// Returns the largest value of a form within the closed ranges of its variables, and its rounding error.
    fn largest_value(&self, form: &Affine, forms: &AffineForms<'_>) -> (f64, f64) {
        let (mut most, mut size) = (form.constant, form.constant.abs());
        for (variable, coefficient) in &form.terms {
            let bounds = self.variable_bounds(*variable, forms);
            let end = match *coefficient > 0.0 {
                true => bounds.high,
                false => bounds.low,
            };
            most += coefficient * end;
            size += (coefficient * end).abs();
        }
        match size.is_finite() {
            true => (most, ROUNDING * size),
            false => (f64::INFINITY, 0.0),
        }
    }

    /// Returns rows and bounds as a homogeneous system of scaled variables; the last one is 1.
    fn homogeneous_system(
        &self,
        rows: &[Affine],
        forms: &AffineForms<'_>,
        sizes: &[f64],
        input_sizes: &[f64],
    ) -> Vec<Vec<f64>> {
        let mut variables: Vec<Variable> = Vec::new();
        for (variable, _) in rows.iter().flat_map(|row| &row.terms) {
            if !variables.contains(variable) {
                variables.push(*variable);
            }
        }
        let size = |variable: &Variable| match variable {
            Variable::Time => 1.0,
            Variable::Entry(entry) => sizes.get(*entry).copied().unwrap_or(1.0),
            Variable::Input(input) => input_sizes.get(*input).copied().unwrap_or(1.0),
            Variable::Atom(atom) => forms
                .atoms
                .get(*atom)
                .map_or(1.0, |(_, b)| magnitude_bound(*b)),
        };
        let scales: Vec<f64> = variables.iter().map(size).collect();
        let last = variables.len();
        let mut matrix = Vec::new();
        for row in rows {
            let mut line = vec![0.0; last + 1];
            for (variable, coefficient) in &row.terms {
                if let Some(place) = variables.iter().position(|known| known == variable) {
                    line[place] = coefficient * scales[place];
                }
            }
            line[last] = row.constant;
            matrix.push(line);
        }
        for (place, (variable, scale)) in variables.iter().zip(&scales).enumerate() {
            let bounds = self.variable_bounds(*variable, forms);
            for (end, sign) in [(bounds.low, 1.0), (bounds.high, -1.0)] {
                if end.is_finite() {
                    let mut line = vec![0.0; last + 1];
                    line[place] = sign;
                    line[last] = RELATIVE_SLACK * (1.0 + (end / scale).abs()) - sign * end / scale;
                    matrix.push(line);
                }
            }
        }
        let mut positive = vec![0.0; last + 1];
        positive[last] = 1.0;
        matrix.push(positive);
        matrix
    }

    fn variable_bounds(&self, variable: Variable, forms: &AffineForms<'_>) -> Interval {
        let range = match variable {
            Variable::Time => None,
            Variable::Entry(entry) => self.ranges.state.get(entry).copied().flatten(),
            Variable::Input(input) => self.ranges.inputs.get(input).copied().flatten(),
            Variable::Atom(atom) => return forms.atoms.get(atom).map_or(Interval::ALL, |a| a.1),
        };
        range.map_or(Interval::ALL, |(low, high)| Interval { low, high })
    }

    /// Returns the arguments of roots and logarithms in all terms. Below 0 they make a term NaN.
    fn domain_arguments(&self) -> Vec<&Tree> {
        let mut found = Vec::new();
        let mut visited = vec![false; self.system.definitions.len()];
        let energies = self.kinetic.iter().chain(&self.potential);
        for term in energies.chain(&self.dissipation) {
            self.collect_arguments(&term.tree, &mut visited, &mut found);
        }
        for force in &self.forces {
            self.collect_arguments(&force.value, &mut visited, &mut found);
        }
        for addend in self.system.state_rates.iter().flatten() {
            self.collect_arguments(addend, &mut visited, &mut found);
        }
        found
    }

    fn collect_arguments<'t>(
        &'t self,
        tree: &'t Tree,
        visited: &mut [bool],
        found: &mut Vec<&'t Tree>,
    ) {
        match tree {
            // A piecewise function can have a finite value although an argument is NaN.
            Tree::Call(function, _) if is_piecewise_function(*function) => return,
            // The argument has another value at each node or mode.
            Tree::Places { .. } | Tree::Sum { .. } => return,
            Tree::Call(Function::Sqrt | Function::Ln, arguments) => found.extend(arguments),
            Tree::Power(base, exponent) if exponent.fract() != 0.0 => found.push(base),
            Tree::Definition(index) => {
                if let Some(visited) = visited.get_mut(*index)
                    && std::mem::replace(visited, true)
                {
                    return;
                }
                if let Some(definition) = self.system.definitions.get(*index) {
                    self.collect_arguments(definition, visited, found);
                }
            }
            _ => {}
        }
        for child in tree.children() {
            self.collect_arguments(child, visited, found);
        }
    }
}

fn side_rows(forms: &mut AffineForms<'_>, switch: &Switch, side: Side) -> Vec<(Affine, Relation)> {
    let quantity = forms.affine_form(switch.quantity());
    let width = switch.half_width().map(|width| forms.affine_form(width));
    let signed = |sign: f64| Affine::default().add_scaled(sign, &quantity);
    match (side, width) {
        (Side::Free, Some(width)) => [1.0, -1.0]
            .map(|sign| {
                (
                    signed(sign).add_scaled(1.0, &width),
                    Relation::PositiveInside,
                )
            })
            .into(),
        (Side::Free, None) if forms.is_nonzero_almost_everywhere(switch.quantity()) => {
            vec![(Affine::constant(-1.0), Relation::NotNegative)]
        }
        // It is unknown whether an atom is constantly 0.
        (Side::Free, None) if quantity.has_atoms() => Vec::new(),
        // The quantity is constantly 0, so the positive and the negative sign must both be impossible.
        (Side::Free, None) => [1.0, -1.0]
            .map(|sign| (signed(sign), Relation::NotNegative))
            .into(),
        (side, Some(width)) => {
            vec![(
                signed(side.sign()).add_scaled(-1.0, &width),
                Relation::Positive,
            )]
        }
        (side, None) => vec![(signed(side.sign()), Relation::Positive)],
    }
}

fn magnitude_bound(bounds: Interval) -> f64 {
    let ends = [bounds.low, bounds.high];
    let sizes = ends.into_iter().map(f64::abs);
    let largest = sizes.filter(|end| end.is_finite()).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}
