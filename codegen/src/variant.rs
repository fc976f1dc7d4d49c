//! Derivation of a checked model into equations and a program, with errors located in the specification.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;

use crate::examination;
use crate::independence::bounds::check_signs;
use crate::independence::constraint_program::{constraint_program, find_residual_indices};
use crate::independence::find_redundancy;
use crate::independence::rows::ConstraintRows;
use crate::mechanics::corners::{add_corner_sides, has_jumping_momenta};
use crate::mechanics::equations::{Equations, derive, derive_with_redundancy};
use crate::mechanics::fields::resolution::check_coefficients;
use crate::mechanics::inertia;
use crate::mechanics::outputs::derive_outputs;
use crate::mechanics::outputs::{Output, Outputs};
use crate::mechanics::redundancy::Redundancy;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sliding::{SideInputs, add_side_inputs, can_hold_motion};
use crate::mechanics::translate::{DeriveError, Translator};
use crate::mechanics::unsolved::translate_impacts;
use crate::program::evaluator::{Evaluator, Point};
use crate::program::lowering::{lower_controllers, lower_with_outputs, lower_with_values};
use crate::program::{Program, Quantity, ValueId};
use crate::symbolic::graph::NodeId;
use crate::trace::trace_program;

/// A model derived at one order for each of its fields.
pub struct Variant {
    /// Equations of motion.
    pub equations: Equations,
    /// Program whose parameter defaults are the values of the model.
    pub program: Program,
    /// Values of the nodes of the equations.
    values: Vec<(NodeId, ValueId)>,
}

impl Variant {
    /// Derives `model`; `orders` has one truncation order for each field.
    ///
    /// # Errors
    /// Inadmissible parameter values, expressions that cannot be derived, constraints that contradict each other or
    /// that no state satisfies, and coordinates without inertia at the initial state, each with its location in the
    /// specification.
    pub fn derive(model: &Model, orders: &[usize]) -> Result<Self, Diagnostics> {
        Self::derive_with(model, orders, &[])
    }

    /// Derives `model` with outputs in addition to the rates.
    ///
    /// # Errors
    /// The errors of [`Variant::derive`], and terms that cannot be differentiated.
    pub fn derive_with(
        model: &Model,
        orders: &[usize],
        outputs: &[Output],
    ) -> Result<Self, Diagnostics> {
        let variant = Self::derive_for_report(model, orders, outputs)?;
        let checked = check_inertia(model, orders, &variant);
        checked.map_err(|diagnostic| Diagnostics::from_one(model.source.clone(), diagnostic))?;
        Ok(variant)
    }

    /// Derives `model` for a report, even if a coordinate has no inertia at the initial state. The
    /// accelerations of such a model may be NaN.
    ///
    /// # Errors
    /// The errors of [`Variant::derive_with`], without those about inertia.
    pub fn derive_for_report(
        model: &Model,
        orders: &[usize],
        outputs: &[Output],
    ) -> Result<Self, Diagnostics> {
        let found = |diagnostic| Diagnostics::from_one(model.source.clone(), diagnostic);
        let values = parameter_values(model)?;
        let mut equations = derive_equations(model, orders).map_err(found)?;
        let outputs = differentiate(model, &mut equations, outputs)?;
        let (mut program, lowered) = lower_with_values(model, &equations, &values, &outputs);
        program.controllers = lower_controllers(model, &program).map_err(found)?;
        Ok(Self {
            equations,
            program,
            values: lowered,
        })
    }

    /// Derives `model` with outputs and with the terms that contribute to each value, for the comments of emitted
    /// files.
    ///
    /// # Errors
    /// The errors of [`Variant::derive_with`].
    pub fn derive_with_trace(
        model: &Model,
        orders: &[usize],
        outputs: &[Output],
    ) -> Result<Self, Diagnostics> {
        let mut variant = Self::derive_with(model, orders, outputs)?;
        variant.add_trace(model);
        Ok(variant)
    }

    /// Finds, for each value of the program, the terms of the specification that contribute to it. Emitted source
    /// then lists them in comments. `model` must be the model of this variant.
    pub fn add_trace(&mut self, model: &Model) {
        let values = self.values.iter().copied();
        self.program.trace = trace_program(model, &self.equations, &self.program, values);
    }
}

/// Derives the equations of motion of `model`; constraints may depend on each other.
///
/// # Errors
/// The errors of [`Variant::derive`], without those about inertia.
pub fn derive_equations(model: &Model, orders: &[usize]) -> Result<Equations, Diagnostic> {
    let values = model
        .parameter_values()
        .map_err(|error| error.diagnostic())?;
    let mut equations = derive(model, orders).map_err(DeriveError::diagnostic)?;
    check_coefficients(model, orders)?;
    check_signs(model, &equations.graph, &equations.residuals, &values)?;
    let Some(program) = constraint_program(model, &equations, &values) else {
        return Ok(equations);
    };
    let residuals = find_residual_indices(model, &program);
    let redundancy = find_redundancy(model, orders, &mut ConstraintRows::new(program, residuals))?;
    match redundancy.groups.is_empty() {
        true => {
            equations.redundancy = redundancy;
            Ok(equations)
        }
        false => {
            derive_with_redundancy(model, orders, &redundancy).map_err(DeriveError::diagnostic)
        }
    }
}

/// Applies the checks of [`Variant::derive`] and returns the constraints that depend on each other. The work grows
/// linearly with the specification if no equations of motion are needed.
///
/// # Errors
/// The errors of [`Variant::derive`].
pub fn examine(model: &Model, orders: &[usize]) -> Result<Redundancy, Diagnostics> {
    match examination::examine(model) {
        Ok(Some(found)) => Ok(found.redundancy),
        Ok(None) => check_by_equations(model, orders),
        Err(diagnostic) => Err(Diagnostics::from_one(model.source.clone(), diagnostic)),
    }
}

/// Checks the model by its equations of motion, without impacts. The number of derived rate changes by impacts grows
/// with the square of the number of impacts, and they cause no error.
fn check_by_equations(model: &Model, orders: &[usize]) -> Result<Redundancy, Diagnostics> {
    let translated = translate_impacts(&mut Translator::new(model, orders));
    let found =
        |error: DeriveError| Diagnostics::from_one(model.source.clone(), error.diagnostic());
    translated.map_err(found)?;
    let without_impacts = Model {
        impacts: Vec::new(),
        ..model.clone()
    };
    Variant::derive(&without_impacts, orders).map(|variant| variant.equations.redundancy)
}

fn check_inertia(model: &Model, orders: &[usize], variant: &Variant) -> Result<(), Diagnostic> {
    let equations = &variant.equations;
    if model.fields.is_empty()
        && inertia::check_energy(model, &equations.graph, equations.kinetic)?.is_some()
    {
        return Ok(());
    }
    let mass = compute_initial_mass_matrix(model, orders, &variant.program)?;
    inertia::check(model, orders, equations, &mass)
}

/// Lowers `equations` of a model with the sides of switching surfaces as inputs, after those of the model; see
/// [`sliding`](crate::mechanics::sliding). Returns `None` if there are no surfaces.
///
/// # Errors
/// Parameter values that are not admissible.
pub fn lower_with_sides(
    model: &Model,
    equations: &Equations,
) -> Result<Option<Program>, Diagnostics> {
    let (equations, sides) = separate_sides(equations);
    match sides.others.is_empty() && sides.sliding.is_empty() {
        true => Ok(None),
        false => lower_separated(model, &equations, sides, Outputs::default()).map(Some),
    }
}

/// Lowers `equations` of a model with outputs in addition to the rates.
///
/// # Errors
/// Parameter values that are not admissible, and terms that cannot be differentiated.
pub fn lower_with_derivatives(
    model: &Model,
    equations: &Equations,
    outputs: &[Output],
) -> Result<Program, Diagnostics> {
    let values = parameter_values(model)?;
    let mut equations = equations.clone();
    let outputs = differentiate(model, &mut equations, outputs)?;
    Ok(lower_with_outputs(model, &equations, &values, &outputs))
}

/// Lowers `equations` of a model for gradients of trajectories: the sides of switching surfaces are inputs, as in
/// [`lower_with_sides`], with the rates of guards and the outputs of
/// [`Output::TrajectoryGradients`].
///
/// # Errors
/// Parameter values that are not admissible, and terms that cannot be differentiated.
pub fn lower_for_gradients(model: &Model, equations: &Equations) -> Result<Program, Diagnostics> {
    let (mut equations, sides) = separate_sides(equations);
    let inputs = equations.inputs;
    equations.inputs += sides.others.len() + sides.sliding.len();
    let outputs = differentiate(
        model,
        &mut equations,
        &[Output::TrajectoryGradients, Output::GuardRates],
    )?;
    equations.inputs = inputs;
    lower_separated(model, &equations, sides, outputs)
}

/// Returns the equations with the sides of all switching surfaces as inputs.
fn separate_sides(equations: &Equations) -> (Equations, SideInputs) {
    let with_sides = |may_hold: bool| {
        let mut equations = equations.clone();
        let inputs = add_side_inputs(&mut equations, may_hold)?;
        Some((equations, inputs))
    };
    let found = can_hold_motion(equations).then(|| with_sides(true));
    let found = found.flatten().or_else(|| with_sides(false));
    found.unwrap_or_else(|| (equations.clone(), SideInputs::default()))
}

fn lower_separated(
    model: &Model,
    equations: &Equations,
    SideInputs { others, sliding }: SideInputs,
    outputs: Outputs<NodeId, RowNodes>,
) -> Result<Program, Diagnostics> {
    let values = parameter_values(model)?;
    let count = others.len() + sliding.len();
    let outputs = Outputs {
        sliding,
        sides: others,
        ..outputs
    };
    let mut program = lower_with_outputs(model, equations, &values, &outputs);
    program.inputs.extend(side_inputs(
        count,
        "0 or 1, or a number between them while the surface holds the motion",
    ));
    Ok(program)
}

/// Derives outputs. An error contains the location of the term that cannot be differentiated.
fn differentiate(
    model: &Model,
    equations: &mut Equations,
    outputs: &[Output],
) -> Result<Outputs<NodeId, RowNodes>, Diagnostics> {
    derive_outputs(equations, outputs).map_err(|error| {
        let message = Diagnostic::error(error.to_string());
        let terms = model.kinetic.iter().chain(&model.potential);
        let spans = terms.chain(&model.dissipation).map(|term| term.value.span);
        let mut spans = spans.chain(model.forces.iter().map(|force| force.value.span));
        let message = match error.term().and_then(|index| spans.nth(index)) {
            Some(span) => message.with_span(span, "in this term"),
            None => message,
        };
        Diagnostics::from_one(model.source.clone(), message)
    })
}

/// Lowers `equations` to a program that computes the momenta and the energy at corners of the motion. The sides of
/// the surfaces are additional inputs, after those of the model; see [`corners`](crate::mechanics::corners). Returns
/// None if no momenta can jump.
///
/// # Errors
/// Parameter values that are not admissible.
pub fn lower_corners(
    model: &Model,
    orders: &[usize],
    equations: &Equations,
) -> Result<Option<Program>, Diagnostics> {
    if !has_jumping_momenta(equations) {
        return Ok(None);
    }
    let values = parameter_values(model)?;
    let mut equations = equations.clone();
    let sides = equations.corners.len();
    let outputs = Outputs {
        corners: Some(add_corner_sides(model, orders, &mut equations)),
        ..Outputs::default()
    };
    let mut program = lower_with_outputs(model, &equations, &values, &outputs);
    program.inputs.extend(side_inputs(
        sides,
        "1 if the switching function is positive, else 0",
    ));
    Ok(Some(program))
}

/// Returns the values of all parameters in SI units.
fn parameter_values(model: &Model) -> Result<Vec<f64>, Diagnostics> {
    model
        .parameter_values()
        .map_err(|error| Diagnostics::from_one(model.source.clone(), error.diagnostic()))
}

fn side_inputs(count: usize, doc: &str) -> impl Iterator<Item = Quantity> {
    (0..count).map(move |side| Quantity {
        name: format!("side_{side}"),
        unit: "1".to_owned(),
        doc: doc.to_owned(),
    })
}

/// Returns the mass matrix at the initial state and the declared parameters, row by row.
fn compute_initial_mass_matrix(
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
