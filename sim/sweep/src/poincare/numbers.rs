//! What the points of a section are summed up in.

use eomgen_analysis::poincare::Section;

/// Points of the section are equal within this share of the extent of the motion.
pub const EQUAL: f64 = 1e-3;

/// Period, clusters, mean, least, greatest and root mean square of the first of both numbers; none
/// where they are not finite. `extents` are those of the whole motion.
pub fn numbers(points: &[[f64; 2]], extents: [f64; 2]) -> Option<[f64; 6]> {
    // At rest there is no extent to compare with, and nothing to compare.
    let (period, clusters) = if extents.contains(&0.0) {
        (Some(1), Some(1))
    } else {
        let section = Section {
            points: points.as_flattened(),
            scale: &extents,
        };
        let shape = section.shape(EQUAL).ok()?;
        (shape.period, shape.clusters)
    };
    let values = || points.iter().map(|[x, _]| *x);
    let count = values().count() as f64;
    Some([
        period.unwrap_or(0) as f64,
        clusters.unwrap_or(0) as f64,
        values().sum::<f64>() / count,
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
        (values().map(|x| x * x).sum::<f64>() / count).sqrt(),
    ])
}

/// Greatest less least of both numbers.
pub fn extents<'s>(seen: impl Iterator<Item = &'s [f64; 2]> + Clone) -> [f64; 2] {
    [0, 1].map(|place| {
        let values = || seen.clone().map(|pair| pair[place]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOOKS: usize = 8;

    /// The looks at x = a + b cos(t) + c cos(t/2) at the phases of cos(t), over `periods`.
    fn seen(periods: usize, [a, b, c]: [f64; 3]) -> Vec<[f64; 2]> {
        let look = |look: usize| {
            let t = std::f64::consts::TAU * look as f64 / LOOKS as f64;
            [
                a + b * t.cos() + c * (t / 2.0).cos(),
                -b * t.sin() - c / 2.0 * (t / 2.0).sin(),
            ]
        };
        (0..periods * LOOKS).map(look).collect()
    }

    fn of(seen: &[[f64; 2]]) -> [f64; 6] {
        let points: Vec<[f64; 2]> = seen.iter().step_by(LOOKS).copied().collect();
        numbers(&points, extents(seen.iter())).expect("numbers")
    }

    fn close(found: f64, expected: f64) {
        // Rounding of a few dozen terms of order 10.
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }

    #[test]
    fn a_motion_of_half_the_forcing_frequency_has_two_points() {
        // On the section x = a + b + c and a + b - c in turn.
        let [period, clusters, mean, min, max, rms] = of(&seen(10, [3.0, 4.0, 1.0]));
        assert_eq!((period, clusters), (2.0, 2.0));
        close(mean, 7.0);
        close(min, 6.0);
        close(max, 8.0);
        close(rms, 50.0_f64.sqrt());
    }

    #[test]
    fn a_motion_of_the_forcing_frequency_has_one_point_and_rest_has_one() {
        let found = of(&seen(10, [3.0, 4.0, 0.0]));
        assert_eq!(found[..2], [1.0, 1.0]);
        close(found[2], 7.0);
        let rest = of(&[[2.0, 0.0]; 5 * LOOKS]);
        assert_eq!(rest, [1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
    }
}
