//! Figure (SVG) of a motion over time: coordinates, first-order states and observables. Quantities of the same kind and
//! unit share a panel, unless one of them would look constant in it.

use eomgen_codegen::program::Quantity;
use eomgen_compiled_model::CompiledModel;
use eomgen_plot::{Panel, Series, TimeHistory, time_history};

use crate::error::{Error, Result};
use crate::table::Table;

/// Maximum number of curves in a panel; more are hard to distinguish.
const MOST_CURVES: usize = 6;

/// Maximum number of panels in a figure.
const MOST_PANELS: usize = 24;

/// Smallest range of a curve that varies, as a fraction of the range of its panel.
const MIN_RANGE_FRACTION: f64 = 0.05;

/// Draws a table of states and observables, without rates.
pub fn figure(compiled: &CompiledModel, table: &Table) -> Result<String> {
    let times = table.column("t").unwrap_or_default();
    let program = compiled.program();
    let described = [
        &program.coordinates,
        &program.first_order,
        &program.observables,
    ];
    let described: Vec<Quantity> = described.into_iter().flatten().cloned().collect();
    let mut panels: Vec<Panel<'_>> = Vec::new();
    for names in [
        coordinates(compiled),
        first_order(compiled),
        observables(compiled),
    ] {
        let mut group: Vec<Panel<'_>> = Vec::new();
        for (name, unit) in names {
            let Some(values) = table.column(&name) else {
                continue;
            };
            let curve = Series {
                label: name,
                abscissa: times,
                values,
                ..Series::default()
            };
            let known = group.iter_mut();
            match known
                .filter(|panel| panel.unit == unit)
                .find(|panel| has_room(panel, &curve))
            {
                Some(panel) => panel.series.push(curve),
                None => group.push(Panel {
                    unit,
                    series: vec![curve],
                    ..Panel::default()
                }),
            }
        }
        for panel in &mut group {
            let names: Vec<&str> = panel.series.iter().map(|curve| &curve.label[..]).collect();
            panel.title = title(&described, &names);
        }
        panels.extend(group);
    }
    panels.truncate(MOST_PANELS);
    for panel in &mut panels {
        if let [only] = &panel.series[..] {
            panel.quantity.clone_from(&only.label);
        }
    }
    let history = TimeHistory {
        title: compiled.model().title.clone(),
        panels,
    };
    time_history(&history).map_err(|error| Error::input(format!("--plot: {error}")))
}

/// Returns the title of a panel: the description of a single quantity, else the names. The axis has the name of a single
/// quantity.
fn title(described: &[Quantity], names: &[&str]) -> String {
    let mut known = described.iter();
    let doc = match names {
        [only] => known.find(|quantity| quantity.name == *only),
        _ => None,
    };
    let mut letters = doc.map_or("", |quantity| &quantity.doc).chars();
    match letters.next() {
        Some(first) => format!("{}{}", first.to_uppercase(), letters.as_str()),
        None => names.join(", "),
    }
}

/// Returns true if the new curve and all curves of the panel remain visible in one panel.
fn has_room(panel: &Panel<'_>, curve: &Series<'_>) -> bool {
    let curves = panel.series.iter().chain([curve]);
    let ranges: Vec<(f64, f64)> = curves.map(|curve| range(curve.values)).collect();
    let (low, high) = ranges
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), own| {
            (low.min(own.0), high.max(own.1))
        });
    let is_visible = |(least, most): &(f64, f64)| {
        most - least >= MIN_RANGE_FRACTION * (high - low) || most <= least
    };
    panel.series.len() < MOST_CURVES && ranges.iter().all(is_visible)
}

/// Returns the smallest and the largest finite value.
fn range(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(*value), high.max(*value))
    })
}

fn coordinates(compiled: &CompiledModel) -> Vec<(String, String)> {
    let names = compiled.state_names();
    let degrees = compiled.program().degrees_of_freedom();
    names
        .into_iter()
        .zip(compiled.state_units())
        .take(degrees)
        .collect()
}

fn first_order(compiled: &CompiledModel) -> Vec<(String, String)> {
    let rest = 2 * compiled.program().degrees_of_freedom();
    let names = compiled.state_names().into_iter();
    names.zip(compiled.state_units()).skip(rest).collect()
}

/// Returns names and units of observables that are not states.
fn observables(compiled: &CompiledModel) -> Vec<(String, String)> {
    let states = compiled.state_names();
    let all = compiled.program().observables.iter();
    let own = all.filter(|known| !states.contains(&known.name));
    own.map(|known| (known.name.clone(), known.unit.clone()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(values: &[f64]) -> Series<'_> {
        Series {
            abscissa: &[0.0, 1.0],
            values,
            ..Series::default()
        }
    }

    #[test]
    fn title_describes_a_single_quantity() {
        let observable = |name: &str, doc: &str| Quantity {
            name: name.to_owned(),
            unit: "J".to_owned(),
            doc: doc.to_owned(),
        };
        let described = [
            observable("energy", "kinetic plus potential energy"),
            observable("work", ""),
        ];
        let title = |names: &[&str]| title(&described, names);
        assert_eq!(title(&["energy"]), "Kinetic plus potential energy");
        assert_eq!(title(&["work"]), "work");
        assert_eq!(title(&["energy", "work"]), "energy, work");
    }

    #[test]
    fn small_curves_have_their_own_panel() {
        let panel = |values: &'static [f64]| Panel {
            series: vec![curve(values)],
            ..Panel::default()
        };
        let large = panel(&[-1.0, 1.0]);
        assert!(has_room(&large, &curve(&[0.0, 0.2])));
        assert!(!has_room(&large, &curve(&[0.0, 0.05])));
        // A constant curve is visible in any panel, but it must not make other curves look constant.
        assert!(has_room(&large, &curve(&[3.0, 3.0])));
        assert!(!has_room(&panel(&[0.0, 0.01]), &curve(&[3.0, 3.0])));
        assert!(has_room(&panel(&[0.0, 0.0]), &curve(&[0.0, 1.0])));
    }
}
