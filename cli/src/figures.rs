//! Figures of a finished sweep: a map for two axes, a diagram for one axis.

use eomgen_model_spec::unit::Unit;
use eomgen_plot::map::{Coordinate, Map, Scatter, Shades};
use eomgen_plot::{PlotError, draw_map, draw_scatter, render_png};
use eomgen_sweep::{Column, Description, Job, Table};

/// Draws each measure as PNG and returns the figures with the names of the measures. There is no figure unless one or
/// two axes have several values.
pub fn draw(job: &Job, table: &Table) -> Vec<(String, Result<Vec<u8>, PlotError>)> {
    let axes = job.points().axes();
    let wide: Vec<usize> = (0..axes.len())
        .filter(|axis| axes.get(*axis).is_some_and(|axis| axis.count > 1))
        .collect();
    let picture = |measure: &Description| match wide[..] {
        [along] => render_diagram(job, table, along, measure),
        [along, up] => render_map(job, table, (along, up), measure),
        _ => None,
    };
    let measures = job.plan().measures.iter();
    measures
        .filter_map(|measure| Some((measure.name.clone(), picture(measure)?)))
        .collect()
}

/// Draws the first column as a map: the first axis to the right, the second axis upwards.
fn render_map(
    job: &Job,
    table: &Table,
    (along, up): (usize, usize),
    measure: &Description,
) -> Option<Result<Vec<u8>, PlotError>> {
    let drawn = measure.drawn.first()?;
    let column = measure
        .columns
        .iter()
        .find(|column| column.name == *drawn)?;
    let (along, up) = (Line::new(job, along)?, Line::new(job, up)?);
    let shown = DisplayUnit::new(column);
    // In the table, the last axis varies fastest; in a map, the first axis does.
    let numbers = table.column(drawn)?;
    let rows = up.order.len();
    let cells = up.order.iter().flat_map(|j| {
        let row = along.order.iter().map(move |i| numbers.get(i * rows + j));
        row.map(|number| number.map_or(f64::NAN, |number| shown.si(*number)))
    });
    let values: Vec<f64> = cells.collect();
    let signed = values.iter().any(|value| *value < 0.0) && values.iter().any(|value| *value > 0.0);
    let svg = draw_map(&Map {
        title: title(job, &column.about),
        horizontal: along.coordinate(),
        vertical: up.coordinate(),
        quantity: measure.quantity.clone(),
        unit: shown.unit,
        shades: if signed {
            Shades::Signed
        } else {
            Shades::Sequential
        },
        values: &values,
    });
    Some(svg.and_then(|svg| render_png(&svg)))
}

/// Draws all columns as functions of the axis.
fn render_diagram(
    job: &Job,
    table: &Table,
    axis: usize,
    measure: &Description,
) -> Option<Result<Vec<u8>, PlotError>> {
    let line = Line::new(job, axis)?;
    let drawn = |column: &&Column| measure.drawn.contains(&column.name);
    let columns: Vec<&Column> = measure.columns.iter().filter(drawn).collect();
    let first = columns.first()?;
    let shown = DisplayUnit::new(first);
    let (mut abscissae, mut ordinates) = (Vec::new(), Vec::new());
    for column in &columns {
        let numbers = table.column(&column.name)?;
        for (value, point) in line.values.iter().zip(&line.order) {
            abscissae.push(*value);
            ordinates.push(
                numbers
                    .get(*point)
                    .map_or(f64::NAN, |number| shown.si(*number)),
            );
        }
    }
    let horizontal = Coordinate {
        values: &abscissae,
        ..line.coordinate()
    };
    let vertical = Coordinate {
        name: measure.quantity.clone(),
        unit: shown.unit,
        values: &ordinates,
        ..Coordinate::default()
    };
    let svg = draw_scatter(&Scatter {
        title: title(job, &first.about),
        horizontal,
        vertical,
    });
    Some(svg.and_then(|svg| render_png(&svg)))
}

fn title(job: &Job, about: &str) -> String {
    format!("{}: {about}", job.plan().model)
}

/// Axis with ascending values in SI.
struct Line {
    name: String,
    shown: DisplayUnit,
    values: Vec<f64>,
    /// Indices of the values on the axis of the grid.
    order: Vec<usize>,
}

impl Line {
    fn new(job: &Job, axis: usize) -> Option<Self> {
        let axis = job.points().axes().get(axis)?;
        let parameters = &job.plan().parameters;
        let of = |name: &String| parameters.iter().find(|column| column.name == *name);
        let first = of(axis.names.first()?)?;
        let shown = DisplayUnit::new(first);
        // Parameters with equal numbers but different units have different values in SI.
        let columns = axis.names.iter().filter_map(of);
        let columns = columns.filter(|column| column.unit == first.unit);
        let names: Vec<&str> = columns.map(|column| column.name.as_str()).collect();
        let mut order: Vec<usize> = (0..axis.count).collect();
        if axis.to < axis.from {
            order.reverse();
        }
        Some(Self {
            values: order
                .iter()
                .map(|place| shown.si(axis.value(*place)))
                .collect(),
            name: names.join(", "),
            shown,
            order,
        })
    }

    fn coordinate(&self) -> Coordinate<'_> {
        Coordinate {
            name: self.name.clone(),
            unit: self.shown.unit.clone(),
            values: &self.values,
            ..Coordinate::default()
        }
    }
}

/// SI unit of a column; figures add SI prefixes.
pub struct DisplayUnit {
    declared: Option<Unit>,
    /// Symbol of the unit; empty for a dimensionless number.
    pub unit: String,
}

impl DisplayUnit {
    pub fn new(column: &Column) -> Self {
        let declared = Unit::parse(&column.unit).ok();
        let unit = match &declared {
            Some(unit) if !unit.is_coherent() => Unit::coherent(unit.dimension).text,
            _ => column.unit.clone(),
        };
        let unit = if unit == "1" { String::new() } else { unit };
        Self { declared, unit }
    }

    /// Converts a number of the column to the unit.
    pub fn si(&self, value: f64) -> f64 {
        self.declared
            .as_ref()
            .map_or(value, |unit| unit.to_si(value))
    }
}
