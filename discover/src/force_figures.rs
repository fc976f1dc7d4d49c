//! Pictures of the residual force: over time, rate, place, shaft order, frequency and amplitude,
//! before and after. A bar at each point is one standard deviation to either side.

use sim::plot::{Axes, Frame, Panel, Plate, Series, plate};

use crate::equations::Equation;
use crate::residual_force::{Profile, ResidualForce};

/// What is not known to this many times the largest force is not drawn.
const KNOWN: f64 = 0.5;

/// What a profile is drawn over, how bars are set, and which of a force's it is.
struct View {
    title: &'static str,
    axes: Axes,
    /// Whether points belong to a line.
    is_line: bool,
    of: fn(&ResidualForce) -> &Profile,
}

/// The pictures of one equation; none if there is nothing to be drawn.
pub fn figures(before: &ResidualForce, after: Option<&ResidualForce>) -> String {
    let equation = &before.equations[before.equation];
    let mut forces = vec![("before", before)];
    forces.extend(after.map(|after| ("after", after)));
    let views = views(equation);
    let drawn: Vec<(&View, Vec<(&str, Points)>)> = views
        .iter()
        .map(|view| {
            let of = |(name, force): &(&'static str, &ResidualForce)| {
                let most = most((view.of)(before));
                (*name, points((view.of)(force), view.is_line, most))
            };
            (view, forces.iter().map(of).collect::<Vec<_>>())
        })
        .filter(|(_, series)| {
            series
                .iter()
                .any(|(_, points)| points.1.iter().any(|v| v.is_finite()))
        })
        .collect();
    let frames = drawn.iter().map(|(view, series)| Frame {
        panel: Panel {
            title: view.title.to_owned(),
            quantity: "force".to_owned(),
            unit: equation.force_unit().to_owned(),
            series: series
                .iter()
                .filter(|(_, points)| points.1.iter().any(|v| v.is_finite()))
                .map(|(label, points)| Series {
                    label: (*label).to_owned(),
                    abscissa: &points.0,
                    values: &points.1,
                })
                .collect(),
            references: Vec::new(),
        },
        axes: view.axes,
        ..Frame::default()
    });
    let figure = Plate {
        title: format!("Residual force on {}", equation.name),
        columns: 2,
        frames: frames.collect(),
    };
    plate(&figure).unwrap_or_default()
}

fn views(equation: &Equation) -> [View; 6] {
    let over = |symbol, unit| Axes::Quantity { symbol, unit };
    let (place, name) = match equation.unit {
        "rad" => ("angle", "over the angle"),
        _ => ("position", "over the position"),
    };
    [
        View {
            title: "over the rate",
            axes: over("rate", equation.rate_unit()),
            is_line: true,
            of: |force| &force.rate,
        },
        View {
            title: name,
            axes: over(place, equation.unit),
            is_line: true,
            of: |force| &force.place,
        },
        View {
            title: "over time, first record",
            axes: Axes::Time,
            is_line: true,
            of: |force| &force.time,
        },
        View {
            title: "along the rate, by a window's largest",
            axes: over("rate", equation.rate_unit()),
            is_line: false,
            of: |force| &force.amplitude,
        },
        View {
            title: "size over the frequency",
            axes: over("f", "Hz"),
            is_line: true,
            of: |force| &force.frequency,
        },
        View {
            title: "size over the order, per turn",
            axes: over("order", ""),
            is_line: false,
            of: |force| &force.order,
        },
    ]
}

/// Abscissae and values of a curve.
type Points = (Vec<f64>, Vec<f64>);

/// The largest standard deviation that is drawn, from what was there before.
fn most(profile: &Profile) -> f64 {
    let known = profile.values.iter().zip(&profile.sd);
    let largest = known
        .filter(|(value, sd)| **sd > 0.0 && value.abs() > 2.0 * **sd)
        .map(|(value, _)| value.abs())
        .fold(0.0, f64::max);
    let finite = profile.sd.iter().filter(|sd| **sd > 0.0);
    match largest > 0.0 {
        true => KNOWN * largest,
        false => 3.0 * finite.copied().fold(f64::INFINITY, f64::min),
    }
}

/// A profile with its bars as one curve that goes up and down at each point.
fn points(profile: &Profile, is_line: bool, most: f64) -> Points {
    let (mut over, mut values) = (Vec::new(), Vec::new());
    for (number, at) in profile.over.iter().enumerate() {
        let (value, sd) = (profile.values[number], profile.sd[number]);
        let drawn = match sd > 0.0 && sd < most {
            true if is_line => vec![value, value - sd, value + sd, value],
            true => vec![value - sd, value + sd, f64::NAN],
            false => vec![f64::NAN],
        };
        over.extend(vec![*at; drawn.len()]);
        values.extend(drawn);
    }
    (over, values)
}
