//! Catalogue of missing effects. An effect ([`effect`]) is defined by edits of the specification
//! only; effects of a user are read in `file` with `change`, `placeholders` and `fields`. Sites of
//! a model ([`site`], [`sites`]) are axes, angles, `arms` with their `stiffness`, [`meshes`],
//! `springs` with their `dampers`, inputs and the whole `machine`; `products` and `polynomial` read
//! their expressions. Sites have `loads` and a [`usual_motion`]. A [`candidate`] is an effect at a
//! site: the edits of a [`template`] and its parameters as unknowns ([`candidate_unknown`]). Errors
//! of inputs are separate candidates ([`input_faults`]).

mod arms;
pub mod candidate;
pub mod candidate_unknown;
mod change;
mod dampers;
pub mod effect;
mod fields;
mod file;
pub mod input_faults;
mod loads;
mod machine;
pub mod meshes;
mod placeholders;
mod polynomial;
mod products;
pub mod site;
pub mod sites;
mod springs;
mod stiffness;
pub mod template;
pub mod user_effects;
pub mod usual_motion;

use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::toml_file;

use crate::catalogue::effect::Effect;
use crate::thresholds;

/// Text of the built-in catalogue.
const BUILT_IN_CATALOGUE: &str = include_str!("catalogue.toml");

/// Loads the built-in effects and the effects of a user's file. A user-defined effect replaces the
/// built-in effect of the same name.
///
/// # Errors
///
/// All errors in the user's file, with line and column.
pub fn load_effects(own: Option<&Path>) -> Result<Vec<Effect>, Diagnostics> {
    let mut effects = file::read_effects(&Source::new("catalogue.toml", BUILT_IN_CATALOGUE))?;
    if let Some(path) = own {
        let mut found = file::read_effects(&toml_file::source(
            path,
            thresholds::MAX_EFFECTS_FILE_BYTES,
        )?)?;
        effects.retain(|known| found.iter().all(|own| own.name != known.name));
        found.iter_mut().for_each(|own| own.is_user_defined = true);
        effects.extend(found);
    }
    Ok(effects)
}

#[cfg(test)]
mod tests {
    #[test]
    fn built_in_catalogue_can_be_read() {
        let effects = super::load_effects(None).unwrap_or_else(|found| panic!("{found}"));
        assert!(effects.len() >= 16);
    }
}
