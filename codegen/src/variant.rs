//! The whole way from a checked model to its program, for those who come with a
//! specification and want what is emitted: what goes wrong on it is a finding on the
//! specification. Nothing is derived here.

use model_spec::diagnostic::{Diagnostic, Diagnostics};
use model_spec::model::Model;

use crate::equations::{Equations, derive};
use crate::inertia;
use crate::lower::lower_requested;
use crate::program::Program;
use crate::request::Request;
use crate::requested::requested;

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
    /// Parameter values that are not admissible, what cannot be derived, and coordinates
    /// without inertia at the initial state, each at its place in the specification.
    pub fn derive(model: &Model, orders: &[usize]) -> Result<Self, Diagnostics> {
        Self::derive_with(model, orders, &[])
    }

    /// The same, with what is requested beside the rates.
    ///
    /// # Errors
    /// The same, and what cannot be differentiated.
    pub fn derive_with(
        model: &Model,
        orders: &[usize],
        requests: &[Request],
    ) -> Result<Self, Diagnostics> {
        let variant = Self::derive_to_read(model, orders, requests)?;
        inertia::check(model, orders, &variant.equations, &variant.program)
            .map_err(|diagnostic| Diagnostics::one(model.source.clone(), diagnostic))?;
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
        requests: &[Request],
    ) -> Result<Self, Diagnostics> {
        let found = |diagnostic| Diagnostics::one(model.source.clone(), diagnostic);
        let values = model
            .parameter_values()
            .map_err(|error| found(error.diagnostic()))?;
        let mut equations = derive(model, orders).map_err(|error| found(error.diagnostic()))?;
        let requested = requested(&mut equations, requests).map_err(|error| {
            let message = Diagnostic::error(error.to_string());
            found(match model.kinetic.first() {
                Some(term) => message.at(term.value.span, "in this energy or the next"),
                None => message,
            })
        })?;
        let program = lower_requested(model, &equations, &values, &requested);
        Ok(Self { equations, program })
    }
}
