//! Figures of the residual force over time, rate, position, shaft order, frequency and amplitude,
//! before and after the search. Error bars are one standard deviation.

use eomgen_plot::{Axes, FigureWidth, Frame, Panel, Plate, Series, SeriesRole, plate_at};

use crate::residual_force::equations::Equation;
use crate::residual_force::types::{Profile, ResidualForce};
use crate::thresholds;

/// Half the width of an error bar's end mark, and the margin at both ends, as fractions of the
/// range.
const TICK: f64 = 0.008;
const MARGIN: f64 = 0.02;

/// Half the minimum distance between error bars, as a fraction of the range.
const TICK_GAP: f64 = 0.003;

/// Description of the figure of one profile.
struct Picture {
    title: &'static str,
    axes: Axes,
    /// True if the points are joined by a line.
    is_line: bool,
    /// True for amplitudes, whose bars end at 0.
    is_amplitude: bool,
    /// True if the force is estimated separately in every window. In a window that does not show
    /// it, the estimate is small.
    by_window: bool,
    of: fn(&ResidualForce) -> &Profile,
}

/// Draws the profiles of one equation; empty if there is nothing to draw.
pub fn draw_profiles(
    before: &ResidualForce,
    after: Option<&ResidualForce>,
    width: FigureWidth,
) -> String {
    let equation = &before.equations[before.equation];
    let mut forces = vec![(SeriesRole::Before, before)];
    forces.extend(after.map(|after| (SeriesRole::After, after)));
    let pictures = list_pictures(equation);
    let drawn: Vec<(&Picture, Vec<(SeriesRole, Points)>)> = pictures
        .iter()
        .map(|picture| {
            let of = |(role, force): &(SeriesRole, &ResidualForce)| {
                let most = compute_largest_sd((picture.of)(before));
                let lowest = if picture.is_amplitude {
                    0.0
                } else {
                    f64::NEG_INFINITY
                };
                (
                    *role,
                    build_curve((picture.of)(force), picture.is_line, (lowest, most)),
                )
            };
            (picture, forces.iter().map(of).collect::<Vec<_>>())
        })
        // The force after the search is drawn only together with the force before.
        .filter(|(picture, _)| {
            let profile = (picture.of)(before);
            let most = compute_largest_sd(profile);
            let known = profile.sd.iter().filter(|sd| is_known(**sd, most));
            let is_drawn = known.count() >= thresholds::MIN_DRAWN_POINT_COUNT;
            let is_significant =
                !picture.by_window || profile.explained_fraction > thresholds::MIN_FORCE_FRACTION;
            is_drawn && is_significant && (picture.axes != Axes::Time || is_resolved(before))
        })
        .collect();
    let frames = drawn.iter().map(|(picture, series)| Frame {
        panel: Panel {
            title: title_picture(picture, series, after.is_some()),
            quantity: "force".to_owned(),
            unit: equation.force_unit().to_owned(),
            series: series
                .iter()
                .filter(|(_, points)| has_values(points))
                .map(|(role, points)| Series {
                    label: match role {
                        SeriesRole::After => "after",
                        _ => "before",
                    }
                    .to_owned(),
                    abscissa: &points.0,
                    values: &points.1,
                    role: *role,
                })
                .collect(),
            references: Vec::new(),
        },
        axes: picture.axes,
        ..Frame::default()
    });
    let figure = Plate {
        title: format!("Residual force on {}", equation.name),
        columns: 2,
        frames: frames.collect(),
    };
    plate_at(&figure, width).unwrap_or_default()
}

/// Returns the title of a picture. A picture has no legend if the force after the search is too
/// uncertain to be drawn; its title states this.
fn title_picture(picture: &Picture, series: &[(SeriesRole, Points)], has_after: bool) -> String {
    let is_drawn =
        |(role, points): &(SeriesRole, Points)| *role == SeriesRole::After && has_values(points);
    match has_after && !series.iter().any(is_drawn) {
        true => format!("{}, before only", picture.title),
        false => picture.title.to_owned(),
    }
}

/// Returns true if a curve has a drawn point.
fn has_values(points: &Points) -> bool {
    points.1.iter().any(|value| value.is_finite())
}

fn list_pictures(equation: &Equation) -> [Picture; 6] {
    let over = |symbol, unit| Axes::Quantity { symbol, unit };
    let (position, name) = match equation.unit {
        "rad" => ("angle", "over the angle"),
        _ => ("position", "over the position"),
    };
    let (rate, over_rate, along_rate) = match equation.unit {
        "m" => (
            "speed",
            "over the speed",
            "one value per window, over its largest speed",
        ),
        _ => (
            "rate",
            "over the rate",
            "one value per window, over its largest rate",
        ),
    };
    [
        Picture {
            title: over_rate,
            axes: over(rate, equation.rate_unit()),
            is_line: true,
            is_amplitude: false,
            by_window: false,
            of: |force| &force.rate,
        },
        Picture {
            title: name,
            axes: over(position, equation.unit),
            // If the force does not depend on the position, the points scatter over it.
            is_line: false,
            is_amplitude: false,
            by_window: false,
            of: |force| &force.position,
        },
        Picture {
            title: "over time, training record 1",
            axes: Axes::Time,
            is_line: true,
            is_amplitude: false,
            by_window: true,
            of: |force| &force.time,
        },
        Picture {
            title: along_rate,
            axes: over(rate, equation.rate_unit()),
            is_line: false,
            is_amplitude: false,
            by_window: false,
            of: |force| &force.amplitude,
        },
        Picture {
            title: "amplitude over the frequency",
            axes: over("f", "Hz"),
            is_line: true,
            is_amplitude: true,
            by_window: true,
            of: |force| &force.frequency,
        },
        Picture {
            title: "amplitude over the order, per turn",
            axes: over("order", ""),
            is_line: false,
            is_amplitude: true,
            by_window: false,
            of: |force| &force.order,
        },
    ]
}

/// Abscissae and ordinates of a curve.
type Points = (Vec<f64>, Vec<f64>);

/// Returns the largest standard deviation to draw, computed from the force before. Values much
/// less accurate than the others do not count, because they would determine the axis.
fn compute_largest_sd(profile: &Profile) -> f64 {
    let accurate = thresholds::MAX_SD_OVER_MEDIAN * compute_median_sd(profile);
    let known = profile.values.iter().zip(&profile.sd);
    let largest = known
        .filter(|(value, sd)| is_known(**sd, accurate) && value.abs() > 2.0 * **sd)
        .map(|(value, _)| value.abs())
        .fold(0.0, f64::max);
    let finite = profile.sd.iter().filter(|sd| **sd > 0.0);
    match largest > 0.0 {
        true => thresholds::MAX_DRAWN_SD * largest,
        false => 3.0 * finite.copied().fold(f64::INFINITY, f64::min),
    }
}

/// Returns the median of the positive standard deviations; NaN without any.
fn compute_median_sd(profile: &Profile) -> f64 {
    let mut sds: Vec<f64> = (profile.sd.iter().copied())
        .filter(|sd| *sd > 0.0)
        .collect();
    sds.sort_by(f64::total_cmp);
    sds.get(sds.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Returns true if the knots over the time of a window resolve the strongest frequency of the
/// force.
fn is_resolved(force: &ResidualForce) -> bool {
    let gap = match force.time.arguments[..] {
        [first, second, ..] => second - first,
        _ => return false,
    };
    let peak = force
        .frequency
        .peak
        .map(|peak| force.frequency.arguments[peak]);
    gap * peak.unwrap_or(0.0) < 0.5
}

fn is_known(sd: f64, most: f64) -> bool {
    sd > 0.0 && sd < most
}

/// Returns a profile with its error bars as one curve that goes up and down at each point, or as
/// crosses. `lowest`: lower limit of the bars. `most`: largest standard deviation to draw.
fn build_curve(profile: &Profile, is_line: bool, (lowest, most): (f64, f64)) -> Points {
    let (Some(first), Some(last)) = (profile.arguments.first(), profile.arguments.last()) else {
        return Points::default();
    };
    let width = last - first;
    let (mut over, mut values) = (vec![first - MARGIN * width], vec![f64::NAN]);
    let gap = |pair: &[f64]| match pair {
        // Limit: a plot joins error bars whose gap is narrower than its lines.
        [before, after] => (0.5 * (after - before) - TICK_GAP * width).clamp(0.0, TICK * width),
        _ => TICK * width,
    };
    for (number, at) in profile.arguments.iter().enumerate() {
        let (value, sd) = (profile.values[number], profile.sd[number]);
        let bar = [value, (value - sd).max(lowest), value + sd, value].map(|value| (0.0, value));
        let drawn = match is_known(sd, most) {
            true if is_line => bar.to_vec(),
            true => {
                let before = gap(&profile.arguments[number.saturating_sub(1)..=number]);
                let after =
                    gap(&profile.arguments[number..(number + 2).min(profile.arguments.len())]);
                let ends = [(after, value), (after, f64::NAN)];
                [&[(-before, value)], &bar[..], &ends].concat()
            }
            false => vec![(0.0, f64::NAN)],
        };
        over.extend(drawn.iter().map(|(aside, _)| at + aside));
        values.extend(drawn.iter().map(|(_, value)| value));
    }
    over.push(last + MARGIN * width);
    values.push(f64::NAN);
    (over, values)
}

#[cfg(test)]
mod tests {
    use super::{build_curve, compute_largest_sd};
    use crate::residual_force::types::Profile;

    /// Abscissae of a plotted curve must not decrease.
    #[test]
    fn close_crosses_do_not_overlap() {
        let profile = Profile {
            arguments: vec![0.0, 1.0, 1.0, 1.001, 5.0],
            values: vec![1.0, 2.0, 3.0, 4.0, 5.0],
            sd: vec![0.1, 0.1, f64::NAN, 0.1, 0.1],
            ..Profile::default()
        };
        for is_line in [true, false] {
            let (over, values) = build_curve(&profile, is_line, (f64::NEG_INFINITY, 1.0));
            assert!(over.is_sorted(), "{over:?}");
            assert_eq!(over.len(), values.len());
            let drawn = |wanted: f64| values.iter().filter(|v| **v == wanted).count();
            assert_eq!((drawn(2.0), drawn(3.0)), (if is_line { 2 } else { 4 }, 0));
            assert!(values[0].is_nan() && over[0] < 0.0 && over[over.len() - 1] > 5.0);
        }
    }

    #[test]
    fn inaccurate_points_do_not_determine_the_axis() {
        let profile = Profile {
            arguments: vec![-2.0, -1.0, 0.0, 1.0, 2.0],
            values: vec![4.0, 4.1, 95.0, -4.0, -4.2],
            sd: vec![0.3, 0.5, 45.0, 0.5, 0.3],
            ..Profile::default()
        };
        let most = compute_largest_sd(&profile);
        assert!((0.5..5.0).contains(&most), "{most}");
    }

    #[test]
    fn bars_of_an_amplitude_end_at_zero() {
        let profile = Profile {
            arguments: vec![0.0, 1.0],
            values: vec![1.0, 2.0],
            sd: vec![1.5, 0.5],
            ..Profile::default()
        };
        let (_, values) = build_curve(&profile, true, (0.0, 2.0));
        assert!(!values.iter().any(|value| *value < 0.0), "{values:?}");
        assert!(values.contains(&0.0) && values.contains(&1.5), "{values:?}");
    }
}
