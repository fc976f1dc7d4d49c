//! Selection of the nodes of a report and their names. The selection must be complete before formulas are written,
//! because formulas share subexpressions.

use eomgen_model_spec::ids::{CoordinateId, FieldId};
use eomgen_model_spec::model::{MULTIPLIER, Model, Term};

use crate::mechanics::coefficients::EquationRow;
use crate::mechanics::equations::Equations;
use crate::mechanics::linearity::{Linearity, linearity};
use crate::mechanics::rows::RowNodes;
use crate::symbolic::formula::{Formula, Index, Symbol};
use crate::symbolic::graph::{Graph, NodeId, Space};

pub(super) type NamedNode = (Formula, NodeId);

pub(super) struct Outline<'a> {
    model: &'a Model,
    equations: &'a Equations,
    /// Definitions of the specification that are used.
    pub definitions: Vec<NamedNode>,
    /// Named terms of the specification.
    pub terms: Vec<NamedNode>,
    /// Nonzero entries of the mass matrix: row, column, node.
    pub mass_matrix: Vec<(Formula, Formula, NodeId)>,
    pub velocity_terms: Vec<NamedNode>,
    pub forces: Vec<NamedNode>,
    /// Rates of first-order states.
    pub state_rates: Vec<NamedNode>,
    pub constraints: Vec<NamedNode>,
    pub multipliers: Vec<NamedNode>,
    pub linearity: Linearity,
}

impl<'a> Outline<'a> {
    pub fn new(model: &'a Model, equations: &'a Equations) -> Self {
        let mut outline = Self {
            model,
            equations,
            definitions: Vec::new(),
            terms: Vec::new(),
            mass_matrix: Vec::new(),
            velocity_terms: Vec::new(),
            forces: Vec::new(),
            state_rates: Vec::new(),
            constraints: Vec::new(),
            multipliers: Vec::new(),
            linearity: linearity(equations),
        };
        outline.definitions = outline.definitions();
        outline.terms = outline.terms();
        outline.mass_matrix = outline.mass_matrix();
        outline.velocity_terms = outline.rows(&equations.velocity_terms);
        outline.forces = outline.rows(&equations.forces);
        outline.state_rates = outline.state_rates();
        outline.constraints = outline.list_constraints("", &equations.residuals);
        outline.multipliers = outline.list_constraints(MULTIPLIER, &equations.multipliers);
        outline
    }

    /// Returns all nodes that have formulas in the report.
    pub fn nodes(&self) -> Vec<NodeId> {
        let equations = self.equations;
        let shown = [
            &self.definitions,
            &self.terms,
            &self.velocity_terms,
            &self.forces,
            &self.state_rates,
            &self.constraints,
            &self.multipliers,
        ];
        let mut nodes: Vec<NodeId> = shown.into_iter().flatten().map(|(_, node)| *node).collect();
        nodes.extend(self.mass_matrix.iter().map(|(_, _, node)| *node));
        let pivots = equations.accelerations.pivots.iter();
        nodes.extend(pivots.filter(|pivot| self.graph().name(**pivot).is_some()));
        nodes.extend(equations.coefficients.iter().map(|known| known.value));
        nodes.extend(equations.guards.iter().map(|guard| guard.value));
        if let Linearity::Nonlinear(node) | Linearity::Corners(node) = self.linearity {
            nodes.push(node);
        }
        nodes
    }

    /// Returns the symbol of a row: its coordinate, or the modal coordinates of its field.
    pub fn row_symbol(&self, row: EquationRow) -> Symbol {
        match row {
            EquationRow::Coordinate(index) => Symbol::plain(&self.model.coordinates[index].name),
            EquationRow::Modes(field) => {
                Symbol::plain(&self.model.fields[field].coordinates).with_indices(&[Index::I])
            }
        }
    }

    /// Returns true if the row exists at these truncation orders.
    pub fn is_present(&self, row: EquationRow) -> bool {
        match row {
            EquationRow::Coordinate(_) => true,
            EquationRow::Modes(field) => self.graph().size(Space::Modes(field)) > 0,
        }
    }

    fn graph(&self) -> &Graph {
        &self.equations.graph
    }

    fn definitions(&self) -> Vec<NamedNode> {
        let definitions = self.model.definitions.iter();
        definitions
            .zip(&self.equations.definitions)
            .filter_map(|(definition, node)| Some((Formula::from_name(&definition.name), (*node)?)))
            .collect()
    }

    fn terms(&self) -> Vec<NamedNode> {
        let model = self.model;
        let named = |symbol: &'static str, terms: &'a [Term]| {
            terms.iter().map(move |term| term_symbol(symbol, term))
        };
        named("T", &model.kinetic)
            .chain(named("V", &model.potential))
            .chain(named("R", &model.dissipation))
            .chain(
                model
                    .forces
                    .iter()
                    .map(|force| Formula::from_name(&force.name)),
            )
            .zip(self.equations.terms.iter().copied())
            .collect()
    }

    fn rows(&self, rows: &RowNodes) -> Vec<NamedNode> {
        let scalars = CoordinateId::first(rows.scalars.len()).zip(&rows.scalars);
        let modal = FieldId::first(rows.modal.len()).zip(&rows.modal);
        scalars
            .map(|(index, id)| (EquationRow::Coordinate(index), *id))
            .chain(modal.map(|(field, id)| (EquationRow::Modes(field), *id)))
            .filter(|(row, id)| !self.graph().is_zero(*id) && self.is_present(*row))
            .map(|(row, id)| (Formula::Symbol(self.row_symbol(row)), id))
            .collect()
    }

    fn state_rates(&self) -> Vec<NamedNode> {
        let states = self.model.states.iter();
        states
            .map(|state| Formula::Symbol(Symbol::plain(&state.name).with_dots(1)))
            .zip(self.equations.state_rates.iter().copied())
            .collect()
    }

    fn list_constraints(&self, prefix: &str, nodes: &[NodeId]) -> Vec<NamedNode> {
        let constraints = self.model.constraints.iter();
        constraints
            .map(|constraint| Formula::from_name(&format!("{prefix}{}", constraint.name)))
            .zip(nodes.iter().copied())
            .collect()
    }

    fn mass_matrix(&self) -> Vec<(Formula, Formula, NodeId)> {
        let mass = &self.equations.mass;
        let mut entries = Vec::new();
        let mut push = |row: EquationRow, column: EquationRow, id: NodeId| {
            if !self.graph().is_zero(id) && self.is_present(row) && self.is_present(column) {
                let [row, column] = [row, column].map(|of| Formula::Symbol(self.row_symbol(of)));
                entries.push((row, column, id));
            }
        };
        let coordinates = CoordinateId::first(mass.scalars.len());
        for (row, values) in coordinates.clone().zip(&mass.scalars) {
            for (column, id) in coordinates.clone().zip(values).skip(row.index()) {
                push(
                    EquationRow::Coordinate(row),
                    EquationRow::Coordinate(column),
                    *id,
                );
            }
            let coupling = &mass.coupling[row];
            for (field, id) in FieldId::first(coupling.len()).zip(coupling) {
                push(EquationRow::Coordinate(row), EquationRow::Modes(field), *id);
            }
        }
        for block in &self.equations.modal_blocks {
            let (row, column) = (block.rows, block.columns);
            push(
                EquationRow::Modes(row),
                EquationRow::Modes(column),
                block.matrix,
            );
        }
        entries
    }
}

/// Returns the symbol of a term of an energy or of the dissipation.
pub(super) fn term_symbol(symbol: &str, term: &Term) -> Formula {
    Formula::Symbol(Symbol::part_of(symbol, vec![Symbol::plain(&term.name)]))
}
