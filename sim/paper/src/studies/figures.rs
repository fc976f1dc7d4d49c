//! Figures of the paper: each row has a time history and its power spectrum.

use std::f64::consts::TAU;

use eomgen_analysis::spectrum::PowerSpectrum;
use eomgen_plot::{Axes, Frame, Panel, Plate, Reference, Series, plate};

use super::display::SampledCase;
use super::error::StudyError;
use super::planes::{orbit, section};
use super::report::{Figure, format_case_name};

/// Smallest density drawn, relative to the greatest. Smaller values are rounding or leakage of the window; they are
/// replaced by this level.
const MIN_RELATIVE_DENSITY: f64 = 1e-13;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    MeshDeflection,
    PositioningError,
    ArmDeflection,
}

/// Row of a figure: one quantity of one or several cases in the same axes.
pub(super) struct Row<'a> {
    pub title: String,
    pub quantity: Quantity,
    /// Cases with their names in the legend.
    pub cases: Vec<(String, &'a SampledCase)>,
}

/// Row of a figure.
pub(super) enum FigureRow<'a> {
    /// Time history and power spectrum.
    TimeHistory(Row<'a>),
    /// Phase plane and stroboscopic section of the mesh, with their letter.
    Planes(&'static str, &'a SampledCase),
}

impl Quantity {
    fn name(self) -> &'static str {
        match self {
            Self::MeshDeflection => "x_sp",
            Self::PositioningError => "f_la",
            Self::ArmDeflection => "dr",
        }
    }

    fn history(self, display: &SampledCase) -> &[f64] {
        match self {
            Self::MeshDeflection => &display.history.x_sp,
            Self::PositioningError => &display.history.f_la,
            Self::ArmDeflection => &display.history.dr,
        }
    }

    fn spectrum(self, display: &SampledCase) -> &PowerSpectrum {
        match self {
            Self::MeshDeflection => &display.x_sp,
            Self::PositioningError => &display.f_la,
            Self::ArmDeflection => &display.dr,
        }
    }
}

/// Title of a figure.
pub(super) struct Heading {
    pub file: String,
    /// Corresponding figure of the paper, or empty.
    pub paper: String,
    pub caption: String,
}

/// Draws rows of two panels.
pub(super) fn draw_rows(heading: Heading, rows: &[FigureRow<'_>]) -> Result<Figure, StudyError> {
    let drawn: Vec<Vec<Vec<f64>>> = rows.iter().map(densities).collect();
    let sections: Vec<[Vec<f64>; 2]> = rows.iter().map(section_columns).collect();
    let frames = rows.iter().zip(drawn.iter().zip(&sections));
    let frames = frames.flat_map(|(row, (drawn, columns))| match row {
        FigureRow::TimeHistory(row) => [history(row), spectrum(row, drawn)],
        FigureRow::Planes(letter, display) => [orbit(letter, display), section(display, columns)],
    });
    let mut cases: Vec<String> = rows.iter().flat_map(ids).collect();
    cases.sort();
    cases.dedup();
    draw_frames(heading, cases, frames.collect())
}

fn ids(row: &FigureRow<'_>) -> Vec<String> {
    match row {
        FigureRow::TimeHistory(row) => row
            .cases
            .iter()
            .map(|(_, of)| format_case_name(&of.case))
            .collect(),
        FigureRow::Planes(_, display) => vec![format_case_name(&display.case)],
    }
}

fn section_columns(row: &FigureRow<'_>) -> [Vec<f64>; 2] {
    match row {
        FigureRow::TimeHistory(_) => [Vec::new(), Vec::new()],
        FigureRow::Planes(_, display) => [0, 2].map(|index| display.extract_section_column(index)),
    }
}

/// Draws panels in two columns.
pub(super) fn draw_frames(
    Heading {
        file,
        paper,
        caption,
    }: Heading,
    cases: Vec<String>,
    frames: Vec<Frame<'_>>,
) -> Result<Figure, StudyError> {
    let of = Plate {
        title: caption.clone(),
        columns: 2,
        frames,
    };
    let svg = plate(&of).map_err(|error| StudyError::Request(error.to_string()))?;
    Ok(Figure {
        file,
        paper,
        caption,
        cases,
        svg,
    })
}

fn densities(row: &FigureRow<'_>) -> Vec<Vec<f64>> {
    let FigureRow::TimeHistory(row) = row else {
        return Vec::new();
    };
    let spectra = row.cases.iter().map(|(_, d)| row.quantity.spectrum(d));
    spectra
        .map(|spectrum| raise_to_floor(&spectrum.density))
        .collect()
}

/// Replaces densities below the floor by the floor.
pub(super) fn raise_to_floor(density: &[f64]) -> Vec<f64> {
    let floor = MIN_RELATIVE_DENSITY * density.iter().copied().fold(0.0, f64::max);
    density.iter().map(|density| density.max(floor)).collect()
}

fn history<'a>(row: &Row<'a>) -> Frame<'a> {
    let curves = row.cases.iter().map(|(label, display)| Series {
        label: label.clone(),
        abscissa: &display.history.times,
        values: row.quantity.history(display),
        ..Series::default()
    });
    Frame {
        panel: Panel {
            title: row.title.clone(),
            quantity: row.quantity.name().to_owned(),
            unit: "m".to_owned(),
            series: curves.collect(),
            references: list_flank_marks(row),
        },
        ..Frame::default()
    }
}

/// Returns the positions of the flanks in a time history of the mesh.
fn list_flank_marks(row: &Row<'_>) -> Vec<Reference> {
    let backlash = row.cases.first().map_or(0.0, |(_, d)| d.case.backlash);
    if row.quantity != Quantity::MeshDeflection || backlash == 0.0 {
        return Vec::new();
    }
    let flanks = [("+b", backlash), ("−b", -backlash)];
    let lines = flanks.map(|(label, value)| Reference {
        label: label.to_owned(),
        value,
    });
    lines.into()
}

fn spectrum<'a>(row: &Row<'a>, drawn: &'a [Vec<f64>]) -> Frame<'a> {
    let cases = row.cases.iter().zip(drawn);
    let curves = cases.map(|((label, display), density)| Series {
        label: label.clone(),
        abscissa: &row.quantity.spectrum(display).frequency,
        values: density,
        ..Series::default()
    });
    Frame {
        panel: create_density_panel(row.quantity.name(), curves.collect()),
        axes: Axes::Frequency,
        marks: row
            .cases
            .last()
            .map_or_else(Vec::new, |(_, d)| list_frequency_marks(d)),
        ..Frame::default()
    }
}

/// Creates a panel of power spectral densities of a length.
pub(super) fn create_density_panel<'a>(of: &str, series: Vec<Series<'a>>) -> Panel<'a> {
    Panel {
        title: format!("power spectrum of {of}"),
        quantity: "G_q".to_owned(),
        unit: "m^2/Hz".to_owned(),
        series,
        references: Vec::new(),
    }
}

/// Returns marks at the forcing frequency and at the natural frequencies with both meshes in contact.
pub(super) fn list_frequency_marks(display: &SampledCase) -> Vec<Reference> {
    let forcing = Reference {
        label: "ω/2π".to_owned(),
        value: display.case.omega / TAU,
    };
    let natural = display.natural.iter().enumerate();
    let natural = natural.map(|(mode, frequency)| Reference {
        label: format!("f_{}", mode + 1),
        value: *frequency,
    });
    std::iter::once(forcing).chain(natural).collect()
}
