//! Contradicting records, found by comparison of the fits of single records with the joint fit. A
//! property that differs in one record, such as a payload or a supply voltage, is not a property of
//! the machine.

use eomgen_model_spec::model::{Parameter, ParameterValue};
use rayon::prelude::*;

use crate::fit::fit_result::Fit;
use crate::fit::single_record::{
    SingleRecordFit, compute_largest_record_rms, fit_record_separately, list_records,
};
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, UnknownKind, bounds_with_sign};
use crate::thresholds;

/// Number of records that are fitted in parallel between two checks whether further fits can
/// matter.
const PARALLEL_FIT_COUNT: usize = 2;

/// Returns sentences about contradicting records of a fit with a gap. Two records contradict each
/// other if their single fits give different values of a declared or found parameter and each
/// single fit is much better than the joint fit. A record is also reported if it cannot be fitted
/// separately although other records can; the sentence names parameters that would explain it.
/// `floor`: noise floor, in standard deviations.
pub fn describe_contradictions(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    floor: f64,
    progress: &(dyn Fn(&str) + Sync),
) -> Vec<String> {
    // If records contradict each other, the joint residual of at least one record is large.
    if compute_largest_record_rms(problem, fit) < thresholds::MIN_CONTRADICTION_RATIO * floor {
        return Vec::new();
    }
    let indices = list_records(problem.dataset);
    let mut records: Vec<SingleRecordFit> = Vec::with_capacity(indices.len());
    let mut tried = 0;
    // The first record is fitted before the others: with two records its fit may be sufficient.
    let (first, others) = indices.split_at(1.min(indices.len()));
    for some in std::iter::once(first).chain(others.chunks(PARALLEL_FIT_COUNT)) {
        if !may_contradict(&records, indices.len() - tried, floor) {
            return Vec::new();
        }
        progress(&format!(
            "fitting records separately, {} of {}",
            tried + some.len(),
            indices.len()
        ));
        let of_its_own = some
            .par_iter()
            .map(|index| fit_record_separately(problem, fit, *index, None));
        let of_its_own: Vec<Option<SingleRecordFit>> = of_its_own.collect();
        records.extend(of_its_own.into_iter().flatten());
        tried += some.len();
    }
    let mut sentences = Vec::new();
    for (index, unknown) in fit.unknowns.iter().enumerate() {
        if let UnknownKind::Parameter(name) = &unknown.kind
            && let Some((a, b)) = find_largest_contradiction(&records, index)
        {
            sentences.push(describe_shift(fit, name, index, a, b));
        }
    }
    match sentences.is_empty() {
        true => find_odd_records(problem, fit, &records, floor),
        false => sentences,
    }
}

/// Returns true if `more` further fits of single records could still show a contradiction.
fn may_contradict(records: &[SingleRecordFit], more: usize, floor: f64) -> bool {
    let of_its_own = records.iter().filter(|record| is_better_alone(record));
    if of_its_own.count() + more > 1 {
        return true;
    }
    if more > 0 {
        return records.len() + more > 2;
    }
    let left: Vec<f64> = records.iter().map(|record| record.rms).collect();
    !RecordClasses::classify(&left, floor).odd.is_empty()
}

/// Returns true if a single fit explains a record much better than the joint fit.
fn is_better_alone(record: &SingleRecordFit) -> bool {
    record.rms.is_finite() && record.rms * thresholds::MIN_CONTRADICTION_RATIO < record.joint_rms
}

/// Records whose single fits have much larger residuals than those of the other records.
struct RecordClasses {
    /// Indices of the records with large residuals; empty if they are not a minority.
    odd: Vec<usize>,
    /// Indices of the records with usual residuals.
    explained: Vec<usize>,
}

impl RecordClasses {
    /// Classifies records by the RMS residuals of their single fits, in standard deviations. A
    /// residual is large if it is far above the median and far above the noise floor. If an effect
    /// is missing, all records have similar residuals.
    fn classify(fits: &[f64], floor: f64) -> Self {
        let mut sorted = fits.to_vec();
        sorted.sort_by(f64::total_cmp);
        let median = sorted.get(sorted.len().saturating_sub(1) / 2);
        let usual = median.map_or(floor, |median| median.max(floor));
        let select = |is: &dyn Fn(f64) -> bool| {
            let indices = 0..fits.len();
            indices.filter(|index| is(fits[*index])).collect()
        };
        let explained: Vec<usize> =
            select(&|rms| rms < thresholds::MAX_FLOOR_RATIO_TO_STOP * usual);
        let odd: Vec<usize> = select(&|rms| rms > thresholds::MIN_RMS_FAR_FROM_NOISE * usual);
        // If most records have a large residual, an effect is missing and shows in these records
        // only.
        match odd.len() < explained.len() {
            true => Self { odd, explained },
            false => Self {
                odd: Vec::new(),
                explained,
            },
        }
    }
}

/// Describes records with large residuals in single fits, while most others have small residuals.
fn find_odd_records(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    fits: &[SingleRecordFit],
    floor: f64,
) -> Vec<String> {
    let left: Vec<f64> = fits.iter().map(|record| record.rms).collect();
    let RecordClasses { odd, explained } = RecordClasses::classify(&left, floor);
    let names: Vec<&str> = (explained.iter())
        .map(|index| fits[*index].name.as_str())
        .collect();
    let most = explained
        .iter()
        .map(|index| left[*index])
        .fold(0.0, f64::max);
    let sentence = |index: &usize| {
        let record = &fits[*index];
        let by = find_explaining_parameters(problem, fit, record, floor);
        let by = match by.is_empty() {
            true => String::new(),
            false => format!(" Its separate fit is explained by {}.", by.join(", or by ")),
        };
        format!(
            "{} does not agree with {}: fitted separately, these records have residuals of at most {most:.1} standard \
             deviations, and it has {:.1}.{by} Check if it was measured on the same machine with the same payload.",
            record.name,
            names.join(", "),
            record.rms
        )
    };
    odd.iter().map(sentence).collect()
}

/// Returns the single parameters that explain a record, with their values.
fn find_explaining_parameters(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    record: &SingleRecordFit,
    floor: f64,
) -> Vec<String> {
    let is_known = |parameter: &Parameter| {
        let mut unknowns = fit.unknowns.iter();
        unknowns.any(|known| known.kind == UnknownKind::Parameter(parameter.name.clone()))
    };
    let parameters = fit.model.specification().parameters.iter();
    let found = parameters
        .filter(|parameter| !is_known(parameter))
        .filter_map(|parameter| {
            let ParameterValue::Number(value) = parameter.value else {
                return None;
            };
            let bounds = bounds_with_sign(parameter, value);
            let unknown = Unknown {
                kind: UnknownKind::Parameter(parameter.name.clone()),
                label: format!("`{}`", parameter.name),
                start: value,
                prior: None,
                bounds,
                bounds_without_prior: bounds,
                scale: value.abs(),
            };
            let with = (value != 0.0)
                .then(|| fit_record_separately(problem, fit, record.record, Some(&unknown)))??;
            let estimate = *with.estimates.last()?;
            (with.rms < thresholds::MAX_FLOOR_RATIO_TO_STOP * floor).then(|| {
                format!(
                    "`{}` = {}",
                    parameter.name,
                    format_estimate(Some(parameter), estimate)
                )
            })
        });
    found.collect()
}

/// Returns the two records with the most significant difference of an unknown. The difference must
/// exceed the uncertainty, and the single fits of both records must explain them.
fn find_largest_contradiction(
    fits: &[SingleRecordFit],
    index: usize,
) -> Option<(&SingleRecordFit, &SingleRecordFit)> {
    let explained: Vec<&SingleRecordFit> = fits
        .iter()
        .filter(|record| is_better_alone(record))
        .collect();
    let apart = |a: &SingleRecordFit, b: &SingleRecordFit| {
        let ((x, sx), (y, sy)) = (a.estimates[index], b.estimates[index]);
        let is_large =
            (x - y).abs() > thresholds::MIN_CONTRADICTION_DIFFERENCE * x.abs().max(y.abs());
        ((x - y).abs() / f64::hypot(sx, sy), is_large)
    };
    let pairs = explained.iter().enumerate();
    let pairs = pairs.flat_map(|(n, a)| explained[n + 1..].iter().map(move |b| (*a, *b)));
    let pairs = pairs.filter(|(a, b)| {
        let (deviations, is_large) = apart(a, b);
        is_large && deviations > thresholds::MIN_SIGNIFICANCE
    });
    pairs.max_by(|(a, b), (c, d)| apart(a, b).0.total_cmp(&apart(c, d).0))
}

fn describe_shift(
    fit: &Fit,
    name: &str,
    index: usize,
    a: &SingleRecordFit,
    b: &SingleRecordFit,
) -> String {
    let mut parameters = fit.model.specification().parameters.iter();
    let parameter = parameters.find(|parameter| parameter.name == name);
    let value = |record: &SingleRecordFit| format_estimate(parameter, record.estimates[index]);
    format!(
        "{} and {} contradict each other: separate fits give `{name}` as {} and {} with residuals of {:.1} and \
         {:.1} standard deviations, and the joint fit has {:.1} and {:.1}. Check if they were measured on one \
         machine with one payload.",
        a.name,
        b.name,
        value(a),
        value(b),
        a.rms,
        b.rms,
        a.joint_rms,
        b.joint_rms
    )
}

/// Formats an estimate and its standard deviation in the unit of a parameter. Both are given in SI.
pub(crate) fn format_estimate(parameter: Option<&Parameter>, (value, sd): (f64, f64)) -> String {
    match parameter {
        Some(p) => format!(
            "{:.3e} ± {:.1e} {}",
            p.unit.from_si(value),
            p.unit.from_si(sd),
            p.unit
        ),
        None => format!("{value:.3e} ± {sd:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::single_record::RecordIndex;

    fn record((rms, together): (f64, f64)) -> SingleRecordFit {
        SingleRecordFit {
            name: String::new(),
            record: RecordIndex::Train(0),
            joint_rms: together,
            rms,
            estimates: Vec::new(),
        }
    }

    /// Returns true if the fits show a contradiction, apart from the values of unknowns.
    fn contradicts(records: &[SingleRecordFit]) -> bool {
        let own = records.iter().filter(|of| is_better_alone(of)).count();
        let left: Vec<f64> = records.iter().map(|of| of.rms).collect();
        own > 1 || !RecordClasses::classify(&left, 1.0).odd.is_empty()
    }

    #[test]
    fn record_with_much_larger_residual_is_odd() {
        let odd = |fits: &[f64]| RecordClasses::classify(fits, 1.0).odd;
        let none: [usize; 0] = [];
        assert_eq!(odd(&[1.0, 1.1, 9.0]), [2]);
        assert_eq!(odd(&[1.8, 14.6, 2.8]), [1]);
        assert_eq!(odd(&[1.0, 9.0]), none);
        assert_eq!(
            odd(&[5.0, 7.0, 14.0]),
            none,
            "something is missing in all of them"
        );
        assert_eq!(odd(&[1.0, 1.0, 9.0, 9.0]), none);
        assert_eq!(odd(&[]), none);
    }

    #[test]
    fn all_possible_contradictions_are_examined() {
        // Each kind is (RMS of the single fit, RMS of the joint fit).
        let kinds = [
            (1.0, 1.2),
            (1.0, 9.0),
            (2.0, 2.5),
            (2.0, 9.0),
            (9.0, 9.0),
            (9.0, 99.0),
            (f64::INFINITY, f64::INFINITY),
        ];
        let all = |count: usize| {
            (0..kinds.len().pow(count as u32)).map(move |number| {
                let kind =
                    |index: usize| kinds[number / kinds.len().pow(index as u32) % kinds.len()];
                (0..count).map(kind).collect::<Vec<(f64, f64)>>()
            })
        };
        for known in 0..4 {
            for begin in all(known) {
                for more in 0..3 {
                    let records: Vec<SingleRecordFit> = begin.iter().copied().map(record).collect();
                    let mut ends = all(more);
                    let is_possible = ends.any(|end| {
                        let whole = [&begin[..], &end].concat();
                        contradicts(
                            &whole
                                .into_iter()
                                .map(record)
                                .collect::<Vec<SingleRecordFit>>(),
                        )
                    });
                    let may = may_contradict(&records, more, 1.0);
                    assert!(may || !is_possible, "{begin:?}, {more} more");
                    assert!(more > 0 || may == is_possible, "{begin:?}");
                }
            }
        }
    }
}
