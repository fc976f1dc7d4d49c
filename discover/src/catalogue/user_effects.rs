//! Check of a user's effects at the sites of a specification. The result must be a valid
//! specification, and effects without a site are reported.

use crate::catalogue::candidate::{CandidateParameter, list_candidates};
use crate::catalogue::effect::Effect;
use crate::catalogue::sites::find_sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::error::DiscoverError;
use crate::model::specification_texts::edited_source;

/// Writes each effect of the user into a specification at each of its sites. Returns the effects
/// without a site.
///
/// # Errors
///
/// Errors of a specification with an effect.
pub fn check_user_effects(
    effects: &[Effect],
    path: &str,
    text: &str,
) -> Result<Vec<String>, DiscoverError> {
    let Ok(checked) = eomgen_model_spec::check(edited_source(path, text)) else {
        // Reading the specification reports its errors.
        return Ok(Vec::new());
    };
    let model = checked.model;
    let mut homeless = Vec::new();
    for effect in effects.iter().filter(|effect| effect.is_user_defined) {
        let effect_alone = std::slice::from_ref(effect);
        let mut found = list_candidates(
            &model,
            effect_alone,
            &find_sites(&model),
            &UsualMotion::default(),
        );
        // Orders are but numbers in it.
        found.dedup_by(|a, b| a.site == b.site);
        for candidate in &found {
            let values: Vec<f64> = candidate
                .parameters
                .iter()
                .map(CandidateParameter::neutral_value)
                .collect();
            let written = candidate.write_effect(text, path, &values, "");
            written.map_err(|error| DiscoverError::Effect {
                effect: effect.name.clone(),
                site: candidate.site.clone(),
                error: Box::new(error),
            })?;
        }
        if found.is_empty() {
            homeless.push(format!(
                "the effect `{}` has no site in this model and is not tested",
                effect.name
            ));
        }
    }
    Ok(homeless)
}
