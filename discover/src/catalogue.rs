//! Effects as data: what a model may lack, each a list of edits with blanks. Where they go is
//! found in [`crate::sites`], what they do is decided by nobody but the specification.

use std::path::Path;

use serde::Deserialize;

/// The catalogue that comes with the program.
const BUILT_IN: &str = include_str!("catalogue.toml");

/// The largest file of a user's effects read, in bytes.
const LARGEST: u64 = 1 << 20;

/// An effect.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Effect {
    /// Its name in results.
    pub name: String,
    /// The kind of place it may have.
    pub site: SiteKind,
    /// What it is, as the end of a sentence.
    pub says: String,
    /// What would show it best.
    pub experiment: String,
    /// Whether it repeats with an angle, so that it is tried at several shaft orders.
    #[serde(default)]
    pub orders: bool,
    /// Its parameters.
    pub parameters: Vec<EffectParameter>,
    /// What it changes.
    pub edits: Vec<Change>,
}

/// The kinds of places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SiteKind {
    /// Anything that moves and can be held: an angle or a position.
    Axis,
    /// An angle.
    Angle,
    /// A pair of teeth with play.
    Mesh,
    /// A flexible body.
    Arm,
    /// A linear spring.
    Spring,
}

/// A parameter of an effect.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EffectParameter {
    /// Its name, with more behind it where that is taken.
    pub name: String,
    /// Its unit, with blanks.
    pub unit: String,
    /// "+" if it must not be negative, "" if it may.
    pub sign: String,
    /// What it is.
    pub doc: String,
    /// The effect is absent where it is infinite, not where it is 0.
    #[serde(default)]
    pub inverse: bool,
    /// "rate": it is as large as a part of the site's usual rate, and shapes the effect
    /// without scaling it.
    #[serde(default)]
    pub scale: String,
    /// That part.
    #[serde(default)]
    pub share: f64,
}

/// One change of the specification.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// What is added: `force`, `coordinate`, or a term of `kinetic`, `potential`,
    /// `dissipation` or `definition`.
    #[serde(default)]
    pub add: String,
    /// Where something is replaced: `kinetic`, `mesh` for all terms of one, or `measured` for
    /// all definitions and observables.
    #[serde(default)]
    pub substitute: String,
    /// The name of what is added.
    #[serde(default)]
    pub name: String,
    /// What a force works on.
    #[serde(default)]
    pub on: String,
    /// The expression added.
    #[serde(default)]
    pub value: String,
    /// The unit of a coordinate.
    #[serde(default)]
    pub unit: String,
    /// What it is.
    #[serde(default)]
    pub doc: String,
    /// The terms in which something is replaced.
    #[serde(default)]
    pub terms: Vec<String>,
    /// What is replaced.
    #[serde(default)]
    pub find: String,
    /// By what.
    #[serde(default)]
    pub replace: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    effect: Vec<Effect>,
}

/// The effects that come with the program, then those of a user's file; one of the same name
/// replaces the built-in.
///
/// # Errors
/// What is wrong with the user's file, with its line.
pub fn effects(own: Option<&Path>) -> Result<Vec<Effect>, String> {
    let parse = |text: &str| toml_edit::de::from_str::<File>(text).map_err(|e| e.to_string());
    let mut effects = parse(BUILT_IN)?.effect;
    if let Some(path) = own {
        let failed = |error: String| format!("{}: {error}", path.display());
        let size = std::fs::metadata(path)
            .map_err(|e| failed(e.to_string()))?
            .len();
        if size > LARGEST {
            return Err(failed(format!(
                "has {size} bytes; at most {LARGEST} are read"
            )));
        }
        let text = std::fs::read_to_string(path).map_err(|e| failed(e.to_string()))?;
        for effect in parse(&text).map_err(failed)?.effect {
            effects.retain(|known| known.name != effect.name);
            effects.push(effect);
        }
    }
    Ok(effects)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_built_in_catalogue_can_be_read() {
        let effects = super::effects(None).expect("a valid catalogue");
        assert!(effects.len() >= 16);
        assert!(effects.iter().all(|effect| !effect.parameters.is_empty()));
    }
}
