//! Models whose trajectories do not support gradients.

use crate::error::Error;
use crate::instance::Instance;

/// Rejects models with features that gradients do not support.
pub(super) fn check_support(instance: &Instance<'_>) -> Result<(), Error> {
    let model = instance.model().model();
    let own = if let Some(impact) = model
        .impacts
        .iter()
        .find(|impact| impact.friction.is_some())
    {
        format!("friction at the impact `{}`", impact.name)
    } else if let Some(controller) = model.controllers.first() {
        format!("the controller `{}`", controller.name)
    } else if let Some(surface) = instance.model().first_corner() {
        format!("energies that jump where `{surface}` is zero")
    } else {
        let program = &instance.model().gradient_program()?.program;
        if program.outputs.sliding.iter().any(|row| row.disc.is_some()) {
            "friction along v/norm(v)".to_owned()
        } else if let Some(guard) = program
            .guards
            .iter()
            .find(|guard| program.value(guard.value).extent.length() != 1)
        {
            format!(
                "`{}`, which switches for each mode of a field",
                guard.formula
            )
        } else {
            return Ok(());
        }
    };
    Err(Error::Request(format!(
        "no gradient of the trajectory: this model has {own}"
    )))
}
