//! Figure of natural modes: shapes of fields over their length, bars for coordinates and first-order states, and the
//! regime of a piecewise model.

use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_plot::modes::{Bar, Mode, Modes, Shape, modes};

use crate::error::{Error, Result};
use crate::field_shapes::{FieldShapes, field_shapes};
use crate::regime::{Side, summary};

/// Maximum number of modes in a figure.
const MAX_MODES: usize = 12;

/// Maximum number of bars of a mode; the largest are shown.
const MAX_BARS: usize = 24;

/// Number of switching surfaces in one line of the figure.
const SIDES_PER_LINE: usize = 4;

/// Maximum number of lines with switching surfaces.
const MAX_LINES: usize = 8;

/// Number of intervals along a shape.
const INTERVALS: usize = 120;

pub fn figure(run: &Instance<'_>, regime: &[Side], found: &[NaturalMode]) -> Result<String> {
    let compiled = run.model();
    let fields = field_shapes(compiled, INTERVALS)?;
    let bars = bars(compiled, found);
    let shown = found.iter().take(MAX_MODES).enumerate();
    let of_mode = |(place, mode): (usize, &NaturalMode)| Mode {
        title: format!("mode {}: {}", place + 1, describe_mode(mode)),
        fields: fields
            .iter()
            .map(|field| field_shape(field, mode))
            .collect(),
        bars: bars.iter().map(|bar| bar.bar(mode)).collect(),
    };
    let model = compiled.model();
    let title = if model.title.is_empty() {
        &model.name
    } else {
        &model.title
    };
    let count = match found.len() {
        all if all > MAX_MODES => format!("; the lowest {MAX_MODES} of {all}"),
        _ => String::new(),
    };
    let figure = Modes {
        title: format!("Natural modes of {title}{count}"),
        notes: summary(regime)
            .chunks(SIDES_PER_LINE)
            .map(regime_line)
            .take(MAX_LINES)
            .collect(),
        modes: shown.map(of_mode).collect(),
    };
    modes(&figure).map_err(|error| Error::input(format!("--plot: {error}")))
}

fn regime_line(sides: &[String]) -> String {
    format!("where {}", sides.join(", "))
}

/// Describes a mode by frequency and damping ratio, or by its growth rate.
fn describe_mode(mode: &NaturalMode) -> String {
    let rate = mode.eigenvalue.re;
    if mode.eigenvalue.norm() == 0.0 {
        return "rigid motion, 0 Hz".to_owned();
    }
    if mode.eigenvalue.im == 0.0 {
        let course = if rate > 0.0 { "grows" } else { "decays" };
        return format!("{course} without swinging, as exp({rate:.4} t/s)").replace('-', "−");
    }
    let (frequency, damping) = (mode.frequency(), mode.damping());
    // Rounded as printed; adding 0.0 removes the sign of -0.
    let damping = (damping * 1e6).round() / 1e6 + 0.0;
    format!("{frequency:.6} Hz, damping ratio {damping:.6}").replace('-', "−")
}

/// Returns the deflection of a field in a natural mode: the sum of mode shapes times modal coordinates.
fn field_shape(shapes: &FieldShapes<'_>, mode: &NaturalMode) -> Shape {
    let coordinates = mode.shape.get(shapes.first..).unwrap_or_default();
    let amplitude = |functions: &Vec<f64>| {
        let terms = functions.iter().zip(coordinates);
        terms.fold([0.0, 0.0], |[re, im], (phi, q)| {
            [re + phi * q.re, im + phi * q.im]
        })
    };
    Shape {
        name: shapes.field.name.clone(),
        unit: shapes.field.unit.to_string(),
        position_name: shapes.field.along.clone(),
        positions: shapes.positions.clone(),
        amplitudes: shapes.functions.iter().map(amplitude).collect(),
    }
}

/// Quantity that is drawn as a bar: index in the state, name and unit.
struct BarQuantity {
    place: usize,
    name: String,
    unit: String,
}

impl BarQuantity {
    fn bar(&self, mode: &NaturalMode) -> Bar {
        let amplitude = mode
            .shape
            .get(self.place)
            .map_or([0.0, 0.0], |v| [v.re, v.im]);
        Bar {
            name: self.name.clone(),
            unit: self.unit.clone(),
            amplitude,
        }
    }
}

/// Returns coordinates and first-order states; if there are too many, those with the largest amplitudes.
fn bars(compiled: &CompiledModel, found: &[NaturalMode]) -> Vec<BarQuantity> {
    let degrees = compiled.program().degrees_of_freedom();
    let coordinates = compiled.model().coordinates.len();
    let all = compiled
        .state_names()
        .into_iter()
        .zip(compiled.state_units());
    let all = all.enumerate().filter_map(|(place, (name, unit))| {
        let place = match place {
            place if place < coordinates => place,
            place => place
                .checked_sub(degrees)
                .filter(|place| *place >= degrees)?,
        };
        Some(BarQuantity { place, name, unit })
    });
    let mut all: Vec<BarQuantity> = all.collect();
    if all.len() > MAX_BARS {
        let most = |named: &BarQuantity| {
            let modes = found.iter().take(MAX_MODES);
            let sizes = modes.filter_map(|mode| mode.shape.get(named.place));
            sizes.fold(0.0, |most: f64, value| most.max(value.norm()))
        };
        all.sort_by(|a, b| most(b).total_cmp(&most(a)));
        all.truncate(MAX_BARS);
        all.sort_by_key(|named| named.place);
    }
    all
}
