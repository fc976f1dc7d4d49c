//! Check of user-defined effects at the sites of a specification. Each extended specification must
//! be valid; effects without a site are reported.

use crate::catalogue::candidate::{CandidateParameter, list_candidates};
use crate::catalogue::effect::Effect;
use crate::catalogue::sites::find_sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::error::DiscoverError;
use crate::model::specification_texts::edited_source;

/// Adds each user-defined effect to a specification at each of its sites. Returns the effects
/// without a site.
///
/// # Errors
///
/// Errors of a specification that contains an effect.
pub fn check_user_effects(
    effects: &[Effect],
    path: &str,
    text: &str,
) -> Result<Vec<String>, DiscoverError> {
    let Ok(checked) = eomgen_model_spec::check(edited_source(path, text)) else {
        // The errors of an invalid specification are reported when it is read.
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
        // Candidates of one site that differ only in the order have the same form.
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
