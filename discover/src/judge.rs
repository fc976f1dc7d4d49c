//! The decision: whether a fit with an effect more is better than one without by so much that
//! the effect is believed. Every limit stands in [`crate::rule`].

use crate::fitting::Fit;
use crate::rule;

/// What speaks for an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// The part by which the test records' gap falls.
    pub held_out: f64,
    /// How much the test records' squares fall, in standard errors over blocks of time.
    pub held_out_errors: f64,
    /// Half the fall of the training records' squares, whitened.
    pub information: f64,
    /// The smallest ratio of a scaling parameter (or pair) to its standard deviation.
    pub t: f64,
    /// What the effect does to the channel that shows it best, in noises.
    pub size: f64,
}

/// Judges a fit with more unknowns; the new ones begin at `first`, those that shape an effect
/// are marked in `shapes`.
///
/// # Errors
/// Why the effect is not believed, in words.
pub fn judge(before: &Fit, after: &Fit, first: usize, shapes: &[bool]) -> Result<Evidence, String> {
    let evidence = evidence(before, after, first, shapes);
    let at_bound = at_bound(after, first, shapes);
    if let Some(name) = at_bound {
        return Err(format!(
            "`{name}` has the wrong sign: held to it, the effect vanishes"
        ));
    }
    if evidence.held_out < rule::HELD_OUT {
        return Err(format!(
            "the test records are no better for it: the gap falls by {:.1} %, {:.0} % are asked for",
            100.0 * evidence.held_out,
            100.0 * rule::HELD_OUT
        ));
    }
    if evidence.held_out_errors < rule::STANDARD_ERRORS {
        return Err(format!(
            "the test records may be better by chance: {:.1} standard errors, {} are asked for",
            evidence.held_out_errors,
            rule::STANDARD_ERRORS
        ));
    }
    if evidence.information < rule::INFORMATION {
        return Err(format!(
            "too little evidence in the training records: a gain of {:.1}, {} are asked for",
            evidence.information,
            rule::INFORMATION
        ));
    }
    if evidence.t < rule::SIGNIFICANCE {
        return Err(format!(
            "its size is {:.1} standard deviations, {} are asked for",
            evidence.t,
            rule::SIGNIFICANCE
        ));
    }
    if evidence.size < rule::SIZE {
        return Err(format!(
            "what it does is {:.2} of the noise, {} are asked for",
            evidence.size,
            rule::SIZE
        ));
    }
    Ok(evidence)
}

/// What speaks for the unknowns from `first` on.
pub fn evidence(before: &Fit, after: &Fit, first: usize, shapes: &[bool]) -> Evidence {
    let (old, new) = (&before.test, &after.test);
    let falls: Vec<f64> = (old.blocks.iter().zip(&new.blocks))
        .map(|(a, b)| a.sqrt() - b.sqrt())
        .collect();
    let count = falls.len() as f64;
    let mean = falls.iter().sum::<f64>() / count;
    let variance = falls.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let fall = before.train.blocks.iter().sum::<f64>() - after.train.blocks.iter().sum::<f64>();
    let whitening = (after.train.pooled * after.train.pooled).max(1.0) * after.train.correlation;
    Evidence {
        held_out: 1.0 - new.pooled / old.pooled,
        held_out_errors: mean / (variance / count).sqrt(),
        information: fall / (2.0 * whitening),
        t: significance(after, first, shapes),
        size: size(before, after),
    }
}

/// What the effect does to the channel that shows it best, in noises: of the root mean square
/// that is left the part that goes.
fn size(before: &Fit, after: &Fit) -> f64 {
    let pairs = before.train.in_noises.iter().zip(&after.train.in_noises);
    let sizes = pairs.map(|(old, new)| (old * old - new * new).max(0.0).sqrt());
    sizes.fold(0.0, f64::max)
}

/// The size of the new effect in standard deviations. The two parts of a wave count together.
fn significance(fit: &Fit, first: usize, shapes: &[bool]) -> f64 {
    let scaling = (first..fit.unknowns.len())
        .filter(|place| !shapes.get(place - first).copied().unwrap_or(false));
    let ratios = scaling.map(|place| fit.train.estimate.theta[place] / fit.sd[place]);
    ratios.map(|t| t * t).sum::<f64>().sqrt()
}

/// A parameter that its sign's bound holds.
fn at_bound(fit: &Fit, first: usize, shapes: &[bool]) -> Option<String> {
    (first..fit.unknowns.len()).find_map(|place| {
        let unknown = &fit.unknowns[place];
        let value = fit.train.estimate.theta[place];
        let is_shape = shapes.get(place - first).copied().unwrap_or(false);
        let held = value <= unknown.bounds.0 || value >= unknown.bounds.1;
        (held && !is_shape).then(|| crate::unknowns::name(&unknown.what))
    })
}
