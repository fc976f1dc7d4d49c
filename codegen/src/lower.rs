//! From the equations' graph to a program: sums and products become binary operations in
//! a fixed order, what depends on parameters alone is split off and prepared once.
//!
//! A term `c P X` of a sum, P of parameters and X of the state, becomes one prepared
//! coefficient |c| P times X, added or subtracted by the sign of c.

use std::collections::HashMap;

use model_spec::model::{Model, ParameterValue};
use model_spec::unit::Unit;

use crate::equations::{Equations, Rows};
use crate::graph::{Assembly, Graph, Id, Operation, Shape};
use crate::print::{Notation, formula};
use crate::program::{
    Extent, MassBlocks, Op, Program, ProgramField, ProgramGuard, ProgramParameter, ProgramTable,
    Quantity, RowValues, ScaledValue, Value, ValueId,
};

/// The program of one variant.
pub fn lower(model: &Model, equations: &Equations, parameter_values: &[f64]) -> Program {
    let mut lowering = Lowering::new(&equations.graph, equations);
    let accelerations = lowering.rows(&equations.accelerations.rows);
    let mass = lowering.mass(equations);
    let velocity_terms = lowering.rows(&equations.velocity_terms);
    let forces = lowering.rows(&equations.forces);
    let mut observable_values: Vec<ValueId> = equations
        .observables
        .iter()
        .map(|id| lowering.value(*id))
        .collect();
    let kinetic = lowering.value(equations.kinetic);
    let potential = lowering.value(equations.potential);
    let energy = lowering.emit(Op::Add(kinetic, potential), Extent::Scalar);
    observable_values.push(energy);
    observable_values.push(lowering.value(equations.power));
    let notation = Notation::text(model);
    let guards = equations
        .guards
        .iter()
        .map(|guard| ProgramGuard {
            formula: formula(&equations.graph, &notation, guard.value),
            value: lowering.value(guard.value),
        })
        .collect();
    let pivots = equations
        .accelerations
        .pivots
        .iter()
        .filter(|id| equations.graph.dependence(**id).is_prepared())
        .map(|id| lowering.value(*id))
        .collect();
    let coefficient_values = equations
        .coefficients
        .iter()
        .map(|coefficient| lowering.value(coefficient.value))
        .collect();
    Program {
        name: model.name.clone(),
        title: model.title.clone(),
        spec_hash: model.source.hash(),
        parameters: program_parameters(model, parameter_values),
        coordinates: model
            .coordinates
            .iter()
            .map(|c| quantity(&c.name, &c.unit.text, &c.doc))
            .collect(),
        fields: model
            .fields
            .iter()
            .zip(equations.graph.orders())
            .map(|(field, order)| ProgramField {
                coordinates: field.coordinates.clone(),
                unit: field.unit.text.clone(),
                order: *order,
            })
            .collect(),
        inputs: model
            .inputs
            .iter()
            .map(|i| quantity(&i.name, &i.unit.text, &i.doc))
            .collect(),
        observables: program_observables(model),
        tables: lowering.tables,
        values: lowering.values,
        accelerations,
        mass,
        velocity_terms,
        forces,
        observable_values,
        guards,
        pivots,
        coefficient_values,
    }
}

fn quantity(name: &str, unit: &str, doc: &str) -> Quantity {
    Quantity {
        name: name.to_owned(),
        unit: unit.to_owned(),
        doc: doc.to_owned(),
    }
}

/// A unit as it is written in the specification, or its SI equivalent.
fn si_unit(unit: &Unit) -> String {
    if unit.is_coherent() {
        unit.text.clone()
    } else {
        unit.dimension.to_string()
    }
}

fn program_parameters(model: &Model, values: &[f64]) -> Vec<ProgramParameter> {
    model
        .parameters
        .iter()
        .zip(values)
        .filter(|(parameter, _)| matches!(parameter.value, ParameterValue::Number(_)))
        .map(|(parameter, value)| ProgramParameter {
            quantity: quantity(&parameter.name, &si_unit(&parameter.unit), &parameter.doc),
            origin: parameter.origin.clone(),
            value: *value,
        })
        .collect()
}

fn program_observables(model: &Model) -> Vec<Quantity> {
    let mut all: Vec<Quantity> = model
        .observables
        .iter()
        .map(|o| quantity(&o.name, &si_unit(&o.unit), &o.doc))
        .collect();
    all.push(quantity("energy", "J", "kinetic plus potential energy"));
    all.push(quantity(
        "power",
        "W",
        "power of all non-conservative forces: the rate of the energy",
    ));
    all
}

struct Lowering<'g> {
    graph: &'g Graph,
    derived: &'g [Option<Id>],
    /// Place among the independent parameters, for each parameter.
    independent: Vec<usize>,
    parameter_names: Vec<String>,
    values: Vec<Value>,
    known: HashMap<String, ValueId>,
    lowered: HashMap<Id, ValueId>,
    tables: Vec<ProgramTable>,
    table_places: HashMap<usize, usize>,
}

impl<'g> Lowering<'g> {
    fn new(graph: &'g Graph, equations: &'g Equations) -> Self {
        let mut next = 0;
        let independent = equations
            .derived_parameters
            .iter()
            .map(|derived| {
                let place = next;
                next += usize::from(derived.is_none());
                place
            })
            .collect();
        Self {
            graph,
            derived: &equations.derived_parameters,
            independent,
            parameter_names: equations.parameter_names.clone(),
            values: Vec::new(),
            known: HashMap::new(),
            lowered: HashMap::new(),
            tables: Vec::new(),
            table_places: HashMap::new(),
        }
    }

    fn rows(&mut self, rows: &Rows) -> RowValues {
        RowValues {
            scalars: rows.scalars.iter().map(|id| self.value(*id)).collect(),
            modal: rows.modal.iter().map(|id| self.value(*id)).collect(),
        }
    }

    fn mass(&mut self, equations: &Equations) -> MassBlocks {
        let mass = &equations.mass;
        let block = |rows: &Vec<Id>, lowering: &mut Self| {
            rows.iter()
                .map(|id| lowering.value(*id))
                .collect::<Vec<_>>()
        };
        MassBlocks {
            scalars: mass.scalars.iter().map(|row| block(row, self)).collect(),
            coupling: mass.coupling.iter().map(|row| block(row, self)).collect(),
            modal: mass
                .modal
                .iter()
                .map(|row| {
                    row.iter()
                        .map(|matrix| {
                            (!matrix.is_zero()).then(|| self.assembly(&matrix.assembly()))
                        })
                        .collect()
                })
                .collect(),
        }
    }

    fn extent(&self, shape: Shape) -> Extent {
        match shape {
            Shape::Scalar => Extent::Scalar,
            Shape::Vector(space) => Extent::Vector(self.graph.size(space)),
            Shape::Matrix(rows, columns) => {
                Extent::Matrix(self.graph.size(rows), self.graph.size(columns))
            }
        }
    }

    /// Adds a value, or finds it if it stands there already.
    fn emit(&mut self, op: Op, extent: Extent) -> ValueId {
        let key = format!("{op:?} {extent:?}");
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let prepared = match op {
            Op::Constant(_) | Op::Table(_) | Op::Parameter(_) => true,
            Op::Coordinate(_)
            | Op::Rate(_)
            | Op::ModeCoordinates(_)
            | Op::ModeRates(_)
            | Op::Input(_)
            | Op::Time => false,
            _ => op.operands().iter().all(|id| self.values[id.0].prepared),
        };
        let id = ValueId(self.values.len());
        self.values.push(Value {
            op,
            extent,
            prepared,
            name: None,
        });
        self.known.insert(key, id);
        id
    }

    fn join(&self, a: ValueId, b: ValueId) -> Extent {
        match self.values[a.0].extent {
            Extent::Scalar => self.values[b.0].extent,
            other => other,
        }
    }

    fn binary(&mut self, op: fn(ValueId, ValueId) -> Op, a: ValueId, b: ValueId) -> ValueId {
        let extent = self.join(a, b);
        self.emit(op(a, b), extent)
    }

    fn constant(&mut self, value: f64) -> ValueId {
        self.emit(Op::Constant(value), Extent::Scalar)
    }

    /// The value of a node.
    fn value(&mut self, id: Id) -> ValueId {
        if let Some(&known) = self.lowered.get(&id) {
            return known;
        }
        let value = self.lower_node(id);
        self.lowered.insert(id, value);
        if let Some(name) = self.graph.name(id)
            && self.values[value.0].name.is_none()
        {
            self.values[value.0].name = Some(name.to_owned());
        }
        value
    }

    fn lower_node(&mut self, id: Id) -> ValueId {
        let graph = self.graph;
        let extent = self.extent(graph.shape(id));
        match graph.operation(id) {
            Operation::Constant(bits) => self.constant(bits.value()),
            Operation::Parameter(index) => self.parameter(*index),
            Operation::Coordinate(index) => self.emit(Op::Coordinate(*index), extent),
            Operation::Rate(index) => self.emit(Op::Rate(*index), extent),
            Operation::Input(index) => self.emit(Op::Input(*index), extent),
            Operation::Time => self.emit(Op::Time, extent),
            Operation::ModeCoordinates(field) => self.emit(Op::ModeCoordinates(*field), extent),
            Operation::ModeRates(field) => self.emit(Op::ModeRates(*field), extent),
            Operation::Table(index) => self.table(*index),
            Operation::Sum(terms) => self.sum(terms),
            Operation::Product(_) => self.term(1.0, id).1,
            Operation::Call(function, arguments) => {
                let arguments = arguments.iter().map(|a| self.value(*a)).collect();
                self.emit(Op::Call(*function, arguments), extent)
            }
            Operation::Power(base, exponent) => {
                let op = Op::Power(self.value(*base), self.value(*exponent));
                self.emit(op, extent)
            }
            Operation::Select {
                a,
                b,
                then,
                otherwise,
            } => {
                let op = Op::Select {
                    a: self.value(*a),
                    b: self.value(*b),
                    then: self.value(*then),
                    otherwise: self.value(*otherwise),
                };
                self.emit(op, extent)
            }
            other => self.matrix_operation(other, extent),
        }
    }

    fn matrix_operation(&mut self, operation: &Operation, extent: Extent) -> ValueId {
        let op = match operation {
            Operation::Total(a) => Op::Total(self.value(*a)),
            Operation::Apply {
                matrix,
                transposed,
                vector,
            } => Op::Apply {
                matrix: self.value(*matrix),
                transposed: *transposed,
                vector: self.value(*vector),
            },
            Operation::Gram {
                left,
                weight,
                right,
            } => Op::Gram {
                left: self.value(*left),
                weight: self.value(*weight),
                right: self.value(*right),
            },
            Operation::GramDiagonal {
                left,
                weight,
                right,
            } => Op::GramDiagonal {
                left: self.value(*left),
                weight: self.value(*weight),
                right: self.value(*right),
            },
            Operation::Assemble(assembly) => return self.assembly(assembly),
            Operation::Cholesky(matrix) => Op::Cholesky(self.value(*matrix)),
            Operation::CholeskySolve(factor, vector) => {
                Op::CholeskySolve(self.value(*factor), self.value(*vector))
            }
            Operation::PivotReciprocal(pivot) => Op::PivotReciprocal(self.value(*pivot)),
            // Scalars and leaves are lowered by the caller.
            _ => Op::Constant(f64::NAN),
        };
        self.emit(op, extent)
    }

    fn assembly(&mut self, assembly: &Assembly) -> ValueId {
        let op = Op::Assemble {
            diagonal: assembly.diagonal.map(|id| self.value(id)),
            outer: assembly
                .outer
                .iter()
                .map(|(u, v)| (self.value(*u), self.value(*v)))
                .collect(),
            matrices: assembly
                .matrices
                .iter()
                .map(|m| ScaledValue {
                    row: self.value(m.row),
                    matrix: self.value(m.matrix),
                    transposed: m.transposed,
                    column: self.value(m.column),
                })
                .collect(),
        };
        let extent = self.extent(Shape::Matrix(assembly.rows, assembly.columns));
        self.emit(op, extent)
    }

    fn parameter(&mut self, index: usize) -> ValueId {
        let value = match self.derived[index] {
            Some(expression) => self.value(expression),
            None => {
                let place = self.independent[index];
                self.emit(Op::Parameter(place), Extent::Scalar)
            }
        };
        let name = &mut self.values[value.0].name;
        if name.is_none() {
            *name = Some(self.parameter_names[index].clone());
        }
        value
    }

    fn table(&mut self, index: usize) -> ValueId {
        let table = self.graph.table(index);
        let extent = self.extent(table.shape());
        let place = match self.table_places.get(&index) {
            Some(&place) => place,
            None => {
                self.tables.push(ProgramTable {
                    doc: crate::table_text::doc(table),
                    name: crate::table_text::constant_name(table),
                    extent,
                    values: table.values.clone(),
                });
                self.table_places.insert(index, self.tables.len() - 1);
                self.tables.len() - 1
            }
        };
        self.emit(Op::Table(place), extent)
    }

    /// Prepared terms first, as one value; then the others, positive ones before
    /// negative ones so that no negation is needed.
    fn sum(&mut self, terms: &[(crate::graph::Bits, Id)]) -> ValueId {
        let graph = self.graph;
        let (prepared, live): (Vec<_>, Vec<_>) = terms
            .iter()
            .map(|(factor, id)| (factor.value(), *id))
            .partition(|(_, id)| graph.dependence(*id).is_prepared());
        let mut parts: Vec<(bool, ValueId)> = Vec::new();
        if !live.is_empty() && prepared.len() > 1 {
            let whole: Vec<(bool, ValueId)> =
                prepared.iter().map(|(c, id)| self.term(*c, *id)).collect();
            parts.push((false, self.add_all(&whole)));
        } else {
            parts.extend(prepared.iter().map(|(c, id)| self.term(*c, *id)));
        }
        parts.extend(live.iter().map(|(c, id)| self.term(*c, *id)));
        self.add_all(&parts)
    }

    /// The sum of values, each with whether it is subtracted.
    fn add_all(&mut self, parts: &[(bool, ValueId)]) -> ValueId {
        let mut ordered: Vec<(bool, ValueId)> = parts.to_vec();
        ordered.sort_by_key(|(negative, _)| *negative);
        let mut iterator = ordered.into_iter();
        let Some((negative, first)) = iterator.next() else {
            return self.constant(0.0);
        };
        let mut total = if negative {
            let extent = self.values[first.0].extent;
            self.emit(Op::Negate(first), extent)
        } else {
            first
        };
        for (negative, value) in iterator {
            let op = if negative { Op::Subtract } else { Op::Add };
            total = self.binary(op, total, value);
        }
        total
    }

    /// |c| times a node, and whether c is negative.
    fn term(&mut self, factor: f64, id: Id) -> (bool, ValueId) {
        let graph = self.graph;
        let (negative, magnitude) = (factor < 0.0, factor.abs());
        let factors = match graph.operation(id) {
            Operation::Product(factors) => factors.to_vec(),
            Operation::Constant(bits) => {
                return (negative, self.constant(magnitude * bits.value()));
            }
            _ => vec![(id, 1)],
        };
        let (prepared, live): (Vec<_>, Vec<_>) = factors
            .into_iter()
            .partition(|(id, _)| graph.dependence(*id).is_prepared());
        let coefficient = self.powers(magnitude, &prepared);
        let moving = (!live.is_empty())
            .then(|| self.powers(1.0, &live))
            .flatten();
        let value = match (coefficient, moving) {
            (Some(coefficient), Some(moving)) => self.binary(Op::Multiply, coefficient, moving),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => self.constant(1.0),
        };
        (negative, value)
    }

    /// A number times a product of powers, scalars before vectors; `None` for a bare 1.
    fn powers(&mut self, number: f64, factors: &[(Id, i32)]) -> Option<ValueId> {
        let graph = self.graph;
        let mut ordered = factors.to_vec();
        ordered.sort_by_key(|(id, _)| graph.shape(*id) != Shape::Scalar);
        let mut above: Option<ValueId> = (number != 1.0).then(|| self.constant(number));
        let mut below: Option<ValueId> = None;
        for (id, exponent) in ordered {
            let base = self.value(id);
            let power = self.integer_power(base, exponent.unsigned_abs());
            let side = if exponent > 0 { &mut above } else { &mut below };
            *side = Some(match *side {
                Some(product) => self.binary(Op::Multiply, product, power),
                None => power,
            });
        }
        match (above, below) {
            (above, None) => above,
            (Some(above), Some(below)) => Some(self.binary(Op::Divide, above, below)),
            (None, Some(below)) => {
                let one = self.constant(1.0);
                Some(self.binary(Op::Divide, one, below))
            }
        }
    }

    /// base^n by squaring.
    fn integer_power(&mut self, base: ValueId, exponent: u32) -> ValueId {
        let mut result: Option<ValueId> = None;
        let (mut square, mut rest) = (base, exponent);
        while rest > 0 {
            if rest & 1 == 1 {
                result = Some(match result {
                    Some(product) => self.binary(Op::Multiply, product, square),
                    None => square,
                });
            }
            rest >>= 1;
            if rest > 0 {
                square = self.binary(Op::Multiply, square, square);
            }
        }
        result.unwrap_or_else(|| self.constant(1.0))
    }
}
