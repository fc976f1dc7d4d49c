//! The whole way from a checked model to its program, for those who come with a
//! specification and want what is emitted: what goes wrong on it is a finding on the
//! specification. Nothing is derived here.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;

use crate::examination;
use crate::independence::bounds::check_signs;
use crate::independence::check_independence;
use crate::independence::rows::{ConstraintRows, constraint_program};
use crate::mechanics::equations::{Equations, derive};
use crate::mechanics::inertia;
use crate::mechanics::outputs::derive_outputs;
use crate::mechanics::outputs::{Output, Outputs};
use crate::mechanics::sliding::with_sides;
use crate::mechanics::translate::{DeriveError, Translator};
use crate::mechanics::unsolved::translate_impacts;
use crate::program::evaluator::{Evaluator, Point};
use crate::program::lowering::lower_with_outputs;
use crate::program::{Program, Quantity};

/// A model derived at one order for each of its fields.
pub struct Variant {
    /// Its equations.
    pub equations: Equations,
    /// Its program, with the model's parameter values as defaults.
    pub program: Program,
}

impl Variant {
    /// Derives `model` with its fields at `orders`, one for each field.
    ///
    /// # Errors
    /// Parameter values that are not admissible, what cannot be derived, constraints that never hold or depend
    /// on each other, and coordinates without inertia at the initial state, each at its place in the specification.
    pub fn derive(model: &Model, orders: &[usize]) -> Result<Self, Diagnostics> {
        Self::derive_with(model, orders, &[])
    }

    /// The same, with outputs beside the rates.
    ///
    /// # Errors
    /// The same, and what cannot be differentiated.
    pub fn derive_with(
        model: &Model,
        orders: &[usize],
        outputs: &[Output],
    ) -> Result<Self, Diagnostics> {
        let variant = Self::derive_to_read(model, orders, outputs)?;
        let checked = check_inertia(model, orders, &variant);
        checked.map_err(|diagnostic| Diagnostics::one(model.source.clone(), diagnostic))?;
        Ok(variant)
    }

    /// The same for readers: equations of a machine in which something has no inertia at the
    /// initial state say what is missing. Their accelerations may be no numbers.
    ///
    /// # Errors
    /// The same but those about inertia.
    pub fn derive_to_read(
        model: &Model,
        orders: &[usize],
        outputs: &[Output],
    ) -> Result<Self, Diagnostics> {
        let found = |diagnostic| Diagnostics::one(model.source.clone(), diagnostic);
        let values = model
            .parameter_values()
            .map_err(|error| found(error.diagnostic()))?;
        let mut equations = derive(model, orders).map_err(|error| found(error.diagnostic()))?;
        let outputs = derive_outputs(&mut equations, outputs).map_err(|error| {
            let message = Diagnostic::error(error.to_string());
            let terms = model.kinetic.iter().chain(&model.potential);
            let spans = terms.chain(&model.dissipation).map(|term| term.value.span);
            let mut spans = spans.chain(model.forces.iter().map(|force| force.value.span));
            found(match error.term.and_then(|place| spans.nth(place)) {
                Some(span) => message.at(span, "in this term"),
                None => message,
            })
        })?;
        check_signs(model, &equations.graph, &equations.residuals, &values).map_err(found)?;
        if let Some(program) = constraint_program(model, &equations, &values) {
            let mut rows = ConstraintRows::new(model, program);
            check_independence(model, orders, &mut rows).map_err(found)?;
        }
        let program = lower_with_outputs(model, &equations, &values, &outputs);
        Ok(Self { equations, program })
    }
}

/// Refuses what [`Variant::derive`] refuses. Where equations of motion are not needed for that, the work
/// grows as the specification does.
///
/// # Errors
/// As [`Variant::derive`].
pub fn examine(model: &Model, orders: &[usize]) -> Result<(), Diagnostics> {
    match examination::examine(model) {
        Ok(Some(_)) => Ok(()),
        Ok(None) => examine_by_equations(model, orders),
        Err(diagnostic) => Err(Diagnostics::one(model.source.clone(), diagnostic)),
    }
}

/// The same by the equations of motion, without the changes of rates by impacts: they grow with the square of
/// their number and refuse nothing.
fn examine_by_equations(model: &Model, orders: &[usize]) -> Result<(), Diagnostics> {
    let translated = translate_impacts(&mut Translator::new(model, orders));
    let found = |error: DeriveError| Diagnostics::one(model.source.clone(), error.diagnostic());
    translated.map_err(found)?;
    let without_impacts = Model {
        impacts: Vec::new(),
        ..model.clone()
    };
    Variant::derive(&without_impacts, orders).map(drop)
}

fn check_inertia(model: &Model, orders: &[usize], variant: &Variant) -> Result<(), Diagnostic> {
    let equations = &variant.equations;
    if model.fields.is_empty()
        && inertia::check_energy(model, &equations.graph, equations.kinetic)?.is_some()
    {
        return Ok(());
    }
    let mass = initial_mass_matrix(model, orders, &variant.program)?;
    inertia::check(model, orders, equations, &mass)
}

/// The program of a model in which the sides of surfaces that may hold the motion are inputs, behind
/// those of the model; see [`sliding`](crate::mechanics::sliding). Nothing where no surface may.
///
/// # Errors
/// What cannot be derived.
pub fn derive_sliding(model: &Model, orders: &[usize]) -> Result<Option<Program>, Diagnostics> {
    let found = |diagnostic| Diagnostics::one(model.source.clone(), diagnostic);
    let values = model
        .parameter_values()
        .map_err(|error| found(error.diagnostic()))?;
    let mut equations = derive(model, orders).map_err(|error| found(error.diagnostic()))?;
    let sliding = with_sides(&mut equations);
    if sliding.is_empty() {
        return Ok(None);
    }
    let sides = (0..sliding.len()).map(|side| Quantity {
        name: format!("side_{side}"),
        unit: "1".to_owned(),
        doc: "0 to 1, between where the surface holds the motion".to_owned(),
    });
    let outputs = Outputs {
        sliding,
        ..Outputs::default()
    };
    let mut program = lower_with_outputs(model, &equations, &values, &outputs);
    program.inputs.extend(sides);
    Ok(Some(program))
}

/// The mass matrix at the initial state and the declared parameters, row by row.
fn initial_mass_matrix(
    model: &Model,
    orders: &[usize],
    program: &Program,
) -> Result<Vec<f64>, Diagnostic> {
    let state = model
        .initial_state(orders)
        .map_err(|error| error.diagnostic())?;
    let size = program.degrees_of_freedom();
    let mut matrix = vec![0.0; size * size];
    let inputs = model
        .typical_inputs(1.0)
        .map_err(|error| error.diagnostic())?;
    Evaluator::new(program.clone()).mass_matrix(
        Point {
            t: 0.0,
            state: &state,
            inputs: &inputs,
        },
        &mut matrix,
    );
    Ok(matrix)
}
