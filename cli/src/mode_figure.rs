//! Natural modes drawn: the shapes of fields over their lengths, coordinates and states of first
//! order as bars, and in which regime of a piecewise model that is.

use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_codegen::mechanics::fields::modes::table;
use eomgen_codegen::symbolic::tables::TableKind;
use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_model_spec::evaluate::evaluate;
use eomgen_model_spec::model::Field;
use eomgen_plot::modes::{Bar, Mode, Modes, Shape, modes};

use crate::error::{Error, Result};
use crate::regime::Side;

/// The most modes of a figure, from the lowest on.
const MOST_MODES: usize = 12;

/// The most bars of a mode; a machine with more shows its largest.
const MOST_BARS: usize = 24;

/// Sides of switching surfaces on a line, and the most lines.
const SIDES: usize = 4;
const MOST_LINES: usize = 8;

/// A shape is drawn through so many places and one.
const PLACES: usize = 120;

/// Draws the lowest modes of an instance.
pub fn figure(run: &Instance<'_>, regime: &[Side], found: &[NaturalMode]) -> Result<String> {
    let compiled = run.model();
    let fields = fields(run)?;
    let bars = bars(compiled, found);
    let shown = found.iter().take(MOST_MODES).enumerate();
    let of_mode = |(place, mode): (usize, &NaturalMode)| Mode {
        title: format!("mode {}: {}", place + 1, in_words(mode)),
        fields: fields.iter().map(|field| field.shape(mode)).collect(),
        bars: bars.iter().map(|bar| bar.of(mode)).collect(),
    };
    let model = compiled.model();
    let title = if model.title.is_empty() {
        &model.name
    } else {
        &model.title
    };
    let count = match found.len() {
        all if all > MOST_MODES => format!("; the lowest {MOST_MODES} of {all}"),
        _ => String::new(),
    };
    let figure = Modes {
        title: format!("Natural modes of {title}{count}"),
        notes: regime
            .chunks(SIDES)
            .map(in_regime)
            .take(MOST_LINES)
            .collect(),
        modes: shown.map(of_mode).collect(),
    };
    modes(&figure).map_err(|error| Error::input(format!("--plot: {error}")))
}

fn in_regime(sides: &[Side]) -> String {
    let sides: Vec<String> = sides.iter().map(Side::to_string).collect();
    format!("where {}", sides.join(", "))
}

/// Frequency and damping, or what else a mode does.
fn in_words(mode: &NaturalMode) -> String {
    let rate = mode.eigenvalue.re;
    if mode.eigenvalue.norm() == 0.0 {
        return "rigid motion, 0 Hz".to_owned();
    }
    if mode.eigenvalue.im == 0.0 {
        let course = if rate > 0.0 { "grows" } else { "decays" };
        return format!("{course} without swinging, as exp({rate:.4} t/s)").replace('-', "−");
    }
    let (frequency, damping) = (mode.frequency(), mode.damping());
    // As it is printed, and then not as -0.
    let damping = (damping * 1e6).round() / 1e6 + 0.0;
    format!("{frequency:.6} Hz, damping ratio {damping:.6}").replace('-', "−")
}

/// A field with its shape functions at the places that are drawn.
struct Drawn<'m> {
    field: &'m Field,
    positions: Vec<f64>,
    /// A row per place, a number per mode of the field.
    functions: Vec<Vec<f64>>,
    /// The place of its first modal coordinate among the numbers of a shape.
    first: usize,
}

/// The fields that have modes.
fn fields<'m>(run: &Instance<'m>) -> Result<Vec<Drawn<'m>>> {
    let compiled = run.model();
    let model = compiled.model();
    let values = model.parameter_values();
    let values = values.map_err(|error| Error::model(&model.source, error))?;
    let mut first = model.coordinates.len();
    let mut drawn = Vec::new();
    for (field, order) in model.fields.iter().zip(compiled.orders()) {
        let [from, to] = [&field.from, &field.to].map(|end| evaluate(end, &values));
        let shares: Vec<f64> = (0..=PLACES).map(|n| n as f64 / PLACES as f64).collect();
        let functions = |s: &f64| {
            let (bits, derivative) = (s.to_bits(), 0);
            table(
                &field.basis,
                *order,
                TableKind::ShapeAtPlace { bits, derivative },
            )
        };
        if *order > 0 {
            drawn.push(Drawn {
                field,
                positions: shares.iter().map(|s| from + s * (to - from)).collect(),
                functions: shares.iter().map(functions).collect(),
                first,
            });
        }
        first += order;
    }
    Ok(drawn)
}

impl Drawn<'_> {
    /// The field in a mode: the sum of its shape functions times their coordinates.
    fn shape(&self, mode: &NaturalMode) -> Shape {
        let coordinates = mode.shape.get(self.first..).unwrap_or_default();
        let amplitude = |functions: &Vec<f64>| {
            let terms = functions.iter().zip(coordinates);
            terms.fold([0.0, 0.0], |[re, im], (phi, q)| {
                [re + phi * q.re, im + phi * q.im]
            })
        };
        Shape {
            name: self.field.name.clone(),
            unit: self.field.unit.to_string(),
            along: self.field.along.clone(),
            positions: self.positions.clone(),
            amplitudes: self.functions.iter().map(amplitude).collect(),
        }
    }
}

/// What has a bar: its place among the numbers of a shape, its name and unit.
struct Named {
    place: usize,
    name: String,
    unit: String,
}

impl Named {
    fn of(&self, mode: &NaturalMode) -> Bar {
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

/// Coordinates and states of first order; of many those that move most in any mode drawn.
fn bars(compiled: &CompiledModel, found: &[NaturalMode]) -> Vec<Named> {
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
        Some(Named { place, name, unit })
    });
    let mut all: Vec<Named> = all.collect();
    if all.len() > MOST_BARS {
        let most = |named: &Named| {
            let modes = found.iter().take(MOST_MODES);
            let sizes = modes.filter_map(|mode| mode.shape.get(named.place));
            sizes.fold(0.0, |most: f64, value| most.max(value.norm()))
        };
        all.sort_by(|a, b| most(b).total_cmp(&most(a)));
        all.truncate(MOST_BARS);
        all.sort_by_key(|named| named.place);
    }
    all
}
