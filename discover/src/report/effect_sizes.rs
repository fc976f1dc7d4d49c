//! Sizes of effects: estimates of the fit, sizes of the members of a class, and the dependence of a
//! size on the choice of a member.

use std::collections::BTreeMap;

use crate::catalogue::candidate::Candidate;
use crate::fit::fit_result::Fit;
use crate::ids::UnknownId;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::UnknownKind;
use crate::report::names::{locate, name_unknown};
use crate::report::result::{ConditionalSize, EquivalentEffect, EstimateWithUnit};
use crate::search::member_fits::MemberFit;
use crate::search::search_result::AcceptedEffect;
use crate::thresholds;

/// Sizes of an effect, by the name of the parameter.
pub(crate) type Sizes = BTreeMap<String, EstimateWithUnit>;

/// Returns the sizes of a candidate in a fit. `unknowns`: unknowns of the candidate in this fit;
/// `floor`: noise floor, in standard deviations.
pub(crate) fn list_sizes(
    problem: &EstimationProblem<'_>,
    (fit, unknowns): (&Fit, &[UnknownId]),
    candidate: &Candidate,
    floor: f64,
) -> Sizes {
    let theta = &fit.train.estimate.theta;
    let sd = |id: &UnknownId| fit.sd_with_misfit(*id, floor);
    let own = candidate.parameters.iter().zip(unknowns);
    let mut sizes: Sizes = own
        .map(|(parameter, id)| {
            let (value, sd) = match fit.unknowns[*id].kind {
                UnknownKind::InverseParameter(_) => {
                    let inverse = theta[*id];
                    (1.0 / inverse, sd(id) / (inverse * inverse))
                }
                _ => {
                    let per_si = parameter.units_per_si();
                    (per_si * theta[*id], per_si * sd(id))
                }
            };
            let unit = parameter.unit.clone();
            (parameter.name.clone(), EstimateWithUnit { value, sd, unit })
        })
        .collect();
    if candidate.dropped_prior.is_some()
        && let Some(id) = unknowns.first()
        && let Some((name, per_si, unit)) = name_unknown(problem, fit, &fit.unknowns[*id].kind)
    {
        let (value, sd) = (per_si * theta[*id], per_si * sd(id));
        sizes.insert(name, EstimateWithUnit { value, sd, unit });
    }
    sizes
}

/// Returns the members of a class with their sizes. Without fits, the sizes are empty.
pub(crate) fn list_equivalents(
    problem: &EstimationProblem<'_>,
    effect: &AcceptedEffect,
    class: &[MemberFit],
    floor: f64,
) -> Vec<EquivalentEffect> {
    let equivalents = effect.equivalents.iter().enumerate();
    equivalents
        .map(|(index, candidate)| {
            let fitted = class.get(index).and_then(|member| member.fitted.as_ref());
            let sizes = fitted
                .map(|(fit, unknowns)| list_sizes(problem, (fit, unknowns), candidate, floor));
            EquivalentEffect {
                at: locate(candidate),
                parameters: sizes.unwrap_or_default(),
            }
        })
        .collect()
}

/// Sizes of an effect with a member of the class of another effect.
struct SizesWithMember<'a> {
    /// Other effect.
    other: &'a AcceptedEffect,
    /// Member of its class that replaces it.
    member: &'a MemberFit,
    sizes: Sizes,
}

/// Sizes of an effect with each member of the classes of other effects.
pub(crate) struct SizesByMember<'a>(Vec<SizesWithMember<'a>>);

impl<'a> SizesByMember<'a> {
    /// Collects the sizes of an effect. `best`: the fit that contains its unknowns; `others`: the
    /// other accepted effects with the members of their classes.
    pub(crate) fn collect(
        problem: &EstimationProblem<'_>,
        (best, effect): (&Fit, &AcceptedEffect),
        others: impl Iterator<Item = (&'a AcceptedEffect, &'a Vec<MemberFit>)>,
        floor: f64,
    ) -> Self {
        let members = others.flat_map(|(other, class)| class.iter().map(move |own| (other, own)));
        let with_member = |(other, member): (&'a AcceptedEffect, &'a MemberFit)| {
            let (fit, _) = member.fitted.as_ref()?;
            // Fits have different numbers of unknowns; the kind identifies an unknown.
            let find = |id: &UnknownId| {
                let kind = &best.unknowns[*id].kind;
                let mut unknowns = fit.unknowns();
                let found = unknowns.find(|(_, own)| own.kind == *kind);
                found.map(|(id, _)| id)
            };
            let unknowns: Option<Vec<UnknownId>> = effect.unknowns.iter().map(find).collect();
            Some(SizesWithMember {
                other,
                member,
                sizes: list_sizes(problem, (fit, &unknowns?), &effect.candidate, floor),
            })
        };
        Self(members.filter_map(with_member).collect())
    }

    /// Widens the standard deviations of sizes by the deviations with the members. The records do
    /// not separate the members, so all have the same weight, as in Bayesian model averaging
    /// (Hoeting et al., Statistical Science 14, 1999).
    pub(crate) fn widen(&self, sizes: &mut Sizes) {
        for (name, size) in sizes {
            let others = self.0.iter().filter_map(|with| with.sizes.get(name));
            let square =
                |other: &EstimateWithUnit| other.sd.powi(2) + (other.value - size.value).powi(2);
            let mut squares = vec![size.sd * size.sd];
            squares.extend(others.map(square));
            size.sd = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        }
    }

    /// Returns the sizes that differ significantly from the sizes of the best fit.
    pub(crate) fn list_different(&self, sizes: &Sizes) -> Vec<ConditionalSize> {
        let differs = |name: &str, size: &EstimateWithUnit| {
            sizes.get(name).is_some_and(|own| {
                let sd = own.sd.hypot(size.sd);
                (size.value - own.value).abs() > thresholds::MIN_NOTED_DEVIATION * sd
            })
        };
        let of_member = |with: &SizesWithMember<'_>| {
            let different = with.sizes.iter().filter(|(name, size)| differs(name, size));
            let conditional = different.map(|(name, size)| ConditionalSize {
                parameter: name.clone(),
                size: size.clone(),
                with: locate(&with.member.candidate),
                in_place_of: locate(&with.other.candidate),
            });
            conditional.collect::<Vec<_>>()
        };
        self.0.iter().flat_map(of_member).collect()
    }
}
