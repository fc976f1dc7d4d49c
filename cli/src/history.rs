//! Figure (SVG) of a motion over time: coordinates, first-order states and observables, a panel for each unit.

use eomgen_compiled_model::CompiledModel;
use eomgen_plot::{Panel, Series, TimeHistory, time_history};

use crate::error::{Error, Result};
use crate::table::Table;

/// Maximum number of curves in a panel; more are hard to distinguish.
const MOST_CURVES: usize = 6;

/// Maximum number of panels in a figure.
const MOST_PANELS: usize = 10;

/// Draws a table of states and observables, without rates.
pub fn figure(compiled: &CompiledModel, table: &Table) -> Result<String> {
    let times = table.column("t").unwrap_or_default();
    let mut panels: Vec<Panel<'_>> = Vec::new();
    for (names, what) in [
        (coordinates(compiled), "Coordinates"),
        (first_order(compiled), "First-order states"),
        (observables(compiled), "Observables"),
    ] {
        let first = panels.len();
        for (name, unit) in names {
            let Some(values) = table.column(&name) else {
                continue;
            };
            let curve = Series {
                label: name.clone(),
                abscissa: times,
                values,
                ..Series::default()
            };
            let mut known = panels[first..].iter_mut();
            match known.find(|panel| panel.unit == unit && panel.series.len() < MOST_CURVES) {
                Some(panel) => panel.series.push(curve),
                None => panels.push(Panel {
                    title: what.to_owned(),
                    quantity: String::new(),
                    unit,
                    series: vec![curve],
                    references: Vec::new(),
                }),
            }
        }
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
