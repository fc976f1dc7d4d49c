//! Check that the mass matrix at the initial state and the declared parameters is positive definite. If it is not,
//! the error names the coordinates that can move with zero or negative inertia.

mod lack;
pub(crate) mod point;
pub(crate) mod sweep;

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::variant::ModelError;

use crate::mechanics::equations::Equations;
use crate::symbolic::graph::{Dependence, Graph, NodeId};
use lack::{Defect, SparseRows, find_defect, to_sparse};
use point::Point;
pub use sweep::Sweep;
use sweep::Velocities;

/// Rejects a model in which a motion has no inertia at the initial state; `mass` is the mass matrix at this state,
/// row by row in SI units.
///
/// # Errors
/// A coordinate with an inertia that is not positive or not finite, or a combination of coordinates without
/// inertia.
pub fn check(
    model: &Model,
    orders: &[usize],
    equations: &Equations,
    mass: &[f64],
) -> Result<(), Diagnostic> {
    let machine = InertiaMessages {
        model,
        names: model.state_names(orders),
        orders,
        is_variable: equations.has_variable_inertia(),
    };
    let size = model.coordinates.len() + orders.iter().sum::<usize>();
    machine.check_mass(&to_sparse(mass, size))
}

/// Checks the kinetic energy of a model without fields; the work grows linearly with the size of its expression.
/// Returns `None` if the energy contains functions of velocities other than sums and products.
///
/// # Errors
/// The errors of [`check`], and initial values that are not finite.
pub fn check_energy(
    model: &Model,
    graph: &Graph,
    kinetic: NodeId,
) -> Result<Option<Sweep>, Diagnostic> {
    let refused = |error: ModelError| error.diagnostic();
    let point = Point {
        parameters: &model.parameter_values().map_err(refused)?,
        state: &model.initial_state(&[]).map_err(refused)?,
        inputs: &model.typical_inputs(1.0).map_err(refused)?,
        coordinates: model.coordinates.len(),
    };
    let reachable = graph.reachable(&[kinetic]);
    let Some(values) = point.values(graph, &reachable) else {
        return Ok(None);
    };
    let velocities = Velocities::new(graph, &reachable, &values);
    let Some(sweep) = velocities.eliminate(point.coordinates) else {
        return Ok(None);
    };
    if sweep.is_definite {
        return Ok(Some(sweep));
    }
    let machine = InertiaMessages {
        model,
        names: model.state_names(&[]),
        orders: &[],
        is_variable: graph.dependence(kinetic).has(VARIABLE_ENERGY_DEPENDENCE),
    };
    let mass = velocities.mass_matrix(point.coordinates);
    mass.map_or(Ok(()), |rows| machine.check_mass(&rows))?;
    Ok(Some(sweep))
}

/// Quantities that make the inertia variable if the kinetic energy depends on them.
const VARIABLE_ENERGY_DEPENDENCE: Dependence = Dependence::COORDINATE
    .join(Dependence::INPUT)
    .join(Dependence::TIME);

/// Quantities that make the inertia variable if the mass matrix depends on them.
const VARIABLE_INERTIA_DEPENDENCE: Dependence = VARIABLE_ENERGY_DEPENDENCE.join(Dependence::RATE);

impl Equations {
    /// Returns true if the mass matrix depends on time, state or inputs.
    fn has_variable_inertia(&self) -> bool {
        let entries = self.mass.scalars.iter().chain(&self.mass.coupling);
        let mut nodes = entries.flatten().copied();
        let mut blocks = self.modal_blocks.iter().map(|block| block.matrix);
        let is_variable = |node| self.graph.dependence(node).has(VARIABLE_INERTIA_DEPENDENCE);
        nodes.any(is_variable) || blocks.any(is_variable)
    }
}

/// Model and names for the messages.
struct InertiaMessages<'m> {
    model: &'m Model,
    orders: &'m [usize],
    names: Vec<String>,
    /// True if the inertia depends on state or time.
    is_variable: bool,
}

/// Help text for an inertia that is not finite.
const NOT_FINITE_HELP: &str = "a term of [kinetic] exceeds 1.8e308 or leaves the domain of a function: check for a \
                               parameter that is too large, a division by 0, or a logarithm of 0";

impl InertiaMessages<'_> {
    fn check_mass(&self, mass: &SparseRows) -> Result<(), Diagnostic> {
        match find_defect(mass) {
            None => Ok(()),
            Some(lack) => Err(self.diagnostic(&lack)),
        }
    }

    fn diagnostic(&self, lack: &Defect) -> Diagnostic {
        match lack {
            Defect::Entry(index, value) => self.describe_coordinate(*index, *value),
            Defect::Direction { rates, negative } => self.describe_direction(rates, *negative),
        }
        .with_optional_help(Some(match lack {
            Defect::Entry(_, value) if !value.is_finite() => NOT_FINITE_HELP.to_owned(),
            _ => self.help(),
        }))
    }

    fn describe_coordinate(&self, index: usize, value: f64) -> Diagnostic {
        let name = &self.names[index];
        let what = if !value.is_finite() {
            format!("the inertia {value}")
        } else if value < 0.0 {
            format!("the negative inertia {value:e}")
        } else {
            "no inertia".to_owned()
        };
        let message = format!(
            "{} `{name}` has {what} at the initial state: the mass matrix is not positive definite",
            self.kind(index)
        );
        let label = match value.is_finite() {
            true => "its kinetic energy does not grow with its rate",
            false => "its kinetic energy is not finite",
        };
        Diagnostic::error(message).with_span(self.span(index), label)
    }

    fn describe_direction(&self, rates: &[f64], negative: bool) -> Diagnostic {
        let moving: Vec<usize> = (0..rates.len()).filter(|at| rates[*at] != 0.0).collect();
        let names: Vec<String> = moving
            .iter()
            .map(|index| format!("`{}`", self.names[*index]))
            .collect();
        let direction: Vec<String> = moving
            .iter()
            .map(|index| {
                format!(
                    "dot({}) = {}",
                    self.names[*index],
                    format_short(rates[*index])
                )
            })
            .collect();
        let what = if negative { "a negative" } else { "no" };
        let message = format!(
            "{} together have {what} inertia at the initial state: the mass matrix is not positive definite",
            names.join(", ")
        );
        let label = format!(
            "kinetic energy does not grow along {}",
            direction.join(", ")
        );
        let mut spans = moving.iter().map(|index| self.span(*index));
        let mut found = Diagnostic::error(message);
        if let Some(first) = spans.next() {
            found = found.with_span(first, label);
            // All modes of a field have the same location.
            let mut others: Vec<Span> = spans.filter(|span| *span != first).collect();
            others.dedup();
            for other in others {
                found = found.with_related_span(other, "moves with it");
            }
        }
        found
    }

    fn help(&self) -> String {
        let mut help = "every coordinate, and every combination of them, needs a term of [kinetic] that grows \
                        with its rate; check for a missing term, a wrong sign or a parameter that is 0"
            .to_owned();
        if self.is_variable {
            help.push_str("; if inertia is missing only at this state, change `initial`");
        }
        help
    }

    fn kind(&self, index: usize) -> &'static str {
        if index < self.model.coordinates.len() {
            "the coordinate"
        } else {
            "the mode"
        }
    }

    /// Returns the location of the declaration of a coordinate, or of the field of a mode.
    fn span(&self, index: usize) -> Span {
        let coordinates = &self.model.coordinates;
        if let Some(coordinate) = coordinates.get(index) {
            return coordinate.span;
        }
        let mut first = coordinates.len();
        let fields = self.model.fields.iter().zip(self.orders);
        for (field, order) in fields {
            first += order;
            if index < first {
                return field.span;
            }
        }
        Span::default()
    }
}

fn format_short(value: f64) -> String {
    let text = format!("{value:.4}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "0" | "-0" => format!("{value:.1e}"),
        short => short.to_owned(),
    }
}
