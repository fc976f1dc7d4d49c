//! Stroboscopic points of mesh and arm over the backlash. If points coincide, the motion has the forcing period;
//! scattered points show a motion without a period.

use std::f64::consts::PI;

use eomgen_plot::{Axes, Frame, Panel, Series, SeriesStyle};
use rayon::prelude::*;

use super::arm::{Arm, Case, UndisclosedParameters};
use super::error::StudyError;
use super::figures::{Heading, draw_frames as drawn};
use super::report::{Figure, Table};
use super::run::Run;
use super::series::Record;

/// Half-backlashes, um.
const HALF_BACKLASHES_UM: std::ops::RangeInclusive<u32> = 0..=100;
/// Numbers of forcing periods of the transient and of the plot.
const TRANSIENT_PERIODS: usize = 160;
const SHOWN_PERIODS: usize = 80;

/// Stroboscopic points over the backlash; each list has one entry per point.
#[derive(Clone, Debug)]
pub(super) struct Bifurcation {
    order: usize,
    omega: f64,
    /// Half the backlash of both meshes, m.
    b: Vec<f64>,
    x_sp: Vec<f64>,
    /// Compression x_sp - b of the driving flank, m.
    compression: Vec<f64>,
    dr: Vec<f64>,
}

impl Bifurcation {
    /// Simulates the motion for every backlash, from rest at zero.
    pub fn run(arm: &Arm, order: usize, omega: f64) -> Result<Self, StudyError> {
        let sections = HALF_BACKLASHES_UM.into_par_iter().map(|micrometres| {
            let case = Case {
                order,
                backlash: f64::from(micrometres) * 1e-6,
                omega,
                undisclosed: UndisclosedParameters::ASSUMED,
            };
            let mut propagator = arm.propagator(&case)?;
            let mut run = Run::start(&mut propagator, &case, TRANSIENT_PERIODS, 1)?;
            run.extend(&mut propagator, SHOWN_PERIODS)?;
            let record = Record::from_states(&run.times, &run.states, &arm.lengths(&case));
            Ok((case.backlash, record))
        });
        let sections = sections.collect::<Result<Vec<_>, StudyError>>()?;
        let mut found = Self {
            order,
            omega,
            b: Vec::new(),
            x_sp: Vec::new(),
            compression: Vec::new(),
            dr: Vec::new(),
        };
        for (b, record) in sections {
            found.b.extend(std::iter::repeat_n(b, record.x_sp.len()));
            found
                .compression
                .extend(record.x_sp.iter().map(|x_sp| x_sp - b));
            found.x_sp.extend(record.x_sp);
            found.dr.extend(record.dr);
        }
        Ok(found)
    }

    pub fn table(&self) -> Table {
        let column = |name: &str, values: &[f64]| (name.to_owned(), values.to_vec());
        let multiple = (self.omega / PI).round();
        Table {
            file: format!("bifurcation_w{multiple:02}pi_s{}.parquet", self.order),
            columns: vec![
                column("b", &self.b),
                column("x_sp", &self.x_sp),
                column("dr", &self.dr),
            ],
        }
    }

    fn arm(&self) -> String {
        match self.order {
            0 => "rigid arm".to_owned(),
            order => format!("S = {order}"),
        }
    }

    /// Returns the panel of the compression over b.
    fn mesh(&self, letter: &str) -> Frame<'_> {
        let title = format!(
            "{letter} mesh, {}, ω = {:.0}π rad/s",
            self.arm(),
            self.omega / PI
        );
        frame(title, "x_sp − b", &self.b, &self.compression)
    }

    fn deflection(&self, letter: &str) -> Frame<'_> {
        frame(format!("{letter} arm's end"), "dr", &self.b, &self.dr)
    }
}

fn frame<'a>(title: String, quantity: &str, b: &'a [f64], values: &'a [f64]) -> Frame<'a> {
    Frame {
        panel: Panel {
            title,
            quantity: quantity.to_owned(),
            unit: "m".to_owned(),
            series: vec![Series {
                label: String::new(),
                abscissa: b,
                values,
                ..Series::default()
            }],
            references: Vec::new(),
        },
        axes: Axes::Quantity {
            symbol: "b",
            unit: "m",
        },
        style: SeriesStyle::Points,
        ..Frame::default()
    }
}

/// Draws mesh and deflection of one arm, or the meshes of two arms.
pub(super) fn figure(found: &[Bifurcation]) -> Result<Figure, StudyError> {
    let letters = ["(a)", "(b)"];
    let meshes = found
        .iter()
        .zip(letters)
        .map(|(of, letter)| of.mesh(letter));
    let mut frames: Vec<Frame<'_>> = meshes.collect();
    if let [only] = found {
        frames.push(only.deflection("(b)"));
    }
    let heading = Heading {
        file: "bifurcation.svg".to_owned(),
        paper: String::new(),
        caption: format!(
            "Bifurcation diagram over half the backlash b = 0 to 100 um in steps of 1 um: {SHOWN_PERIODS} forcing \
             periods after {TRANSIENT_PERIODS} from rest, each motion seen once per forcing period: x_sp less b, the \
             mesh deflection beyond contact, and dr; the modes from the second on are hardly damped and have not died \
             away by then"
        ),
    };
    drawn(heading, Vec::new(), frames)
}
