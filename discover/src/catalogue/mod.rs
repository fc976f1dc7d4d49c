//! What a model may lack: the effects that come with the program and a user's ([`effect`]), the
//! places of a model where they may sit ([`site`], [`sites`], `arms`, [`meshes`], `springs` and the `dampers` beside
//! them, read by `products` and `polynomial`), what `loads` these bear, how they move ([`usual_motion`]), and both together as
//! [`candidate`]s (the edits of an effect at a place: [`template`]; its parameters as unknowns:
//! [`candidate_unknown`]). What
//! effects do is decided by nobody but the specification. How a file of effects is read is in
//! `file` with `change`, `placeholders` and `fields`. Inputs that act otherwise than recorded are
//! candidates of their own ([`input_faults`]).

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
pub mod meshes;
mod placeholders;
mod polynomial;
mod products;
pub mod site;
pub mod sites;
mod springs;
pub mod template;
pub mod user_effects;
pub mod usual_motion;

use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::toml_file;

use crate::catalogue::effect::Effect;
use crate::thresholds;

/// The catalogue that comes with the program.
const BUILT_IN: &str = include_str!("catalogue.toml");

/// The effects that come with the program, then those of a user's file; one of the same name
/// replaces the built-in.
///
/// # Errors
/// All that is wrong with the user's file, with its places.
pub fn effects(own: Option<&Path>) -> Result<Vec<Effect>, Diagnostics> {
    let mut effects = file::read(&Source::new("catalogue.toml", BUILT_IN))?;
    if let Some(path) = own {
        let mut found = file::read(&toml_file::source(path, thresholds::LARGEST_EFFECTS_FILE)?)?;
        effects.retain(|known| found.iter().all(|own| own.name != known.name));
        found.iter_mut().for_each(|own| own.is_own = true);
        effects.extend(found);
    }
    Ok(effects)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_built_in_catalogue_can_be_read() {
        let effects = super::effects(None).unwrap_or_else(|found| panic!("{found}"));
        assert!(effects.len() >= 16);
    }
}
