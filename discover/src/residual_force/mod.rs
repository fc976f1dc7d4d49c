//! The residual force: which equation of motion a missing force acts in, and what it looks like
//! over time, rate, angle, shaft order, frequency and amplitude. It says where to look; which
//! effects are believed is decided without it. The files: `equations` in which a force may act,
//! `shapes` that it may have, `pushed` (what these do to the outputs; `stepped`, where nothing is
//! marched) and `regression` (how much of each there is), `looked` (families of shapes),
//! `ranked` (equations compared), `profiles` (one of them in detail), `said` (words) and `figures`.

pub mod basis_functions;
pub mod equations;
pub mod family_regression;
pub mod figures;
mod finite_difference_response;
pub mod force_response;
pub mod profiles;
pub mod ranking;
pub mod regression;
pub mod wording;

use std::f64::consts::TAU;

use crate::fit::full::Fit;
use crate::model::problem::Setting;
use crate::report::location::peak_frequency;
use crate::residual_force::basis_functions::{Family, Over, Range};
use crate::residual_force::equations::{Equation, Equations, Standing};
use crate::residual_force::family_regression::Looked;
use crate::residual_force::force_response::stood;
use crate::residual_force::profiles::Blocks;
use crate::residual_force::ranking::{Judged, simple};
use crate::search::response::At;
use crate::thresholds;

/// Shaft orders that are looked at.
const ORDERS: [u32; 10] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 36];

/// The lowest frequencies that are looked at, in periods per window; higher ones follow by this
/// ratio, up to so many periods of samples.
const FREQUENCIES: (usize, f64, f64) = (4, 1.6, 4.0);

/// The most of them.
const MOST_FREQUENCIES: usize = 12;

/// Numbers with one standard deviation each, over something.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// Over which, in SI, ascending.
    pub over: Vec<f64>,
    /// The force there, N or N m.
    pub values: Vec<f64>,
    /// One standard deviation.
    pub sd: Vec<f64>,
    /// The part of the squares that it explains; of several waves that which explains most.
    pub part: f64,
    /// The place of the wave that does.
    pub peak: Option<usize>,
}

/// How well a force in an equation does.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The equation's place in the list.
    pub equation: usize,
    /// The part of the squares that a force over its rate explains, or over its place.
    pub by_state: f64,
    /// The same of a force over time that differs from window to window.
    pub by_time: f64,
}

/// What a force is a function of, as far as can be told.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Its rate: so much of simple functions of it.
    Rate(Vec<(Simple, f64, f64)>),
    /// Its place.
    Place(Vec<(Simple, f64, f64)>),
    /// Neither.
    Time,
}

/// Simple functions of a rate or a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simple {
    /// The same everywhere.
    Constant,
    /// The sign.
    Sign,
    /// In proportion.
    Linear,
    /// In proportion to the size.
    Size,
    /// With the square and the sign.
    Square,
}

/// The residual force of a fit.
pub struct ResidualForce {
    /// All equations.
    pub equations: Vec<Equation>,
    /// Those in which a force explains something, the best first.
    pub ranked: Vec<Ranked>,
    /// The best.
    pub best: usize,
    /// The one whose profiles these are.
    pub equation: usize,
    /// What the force in the best is a function of; none if nothing stands out.
    pub kind: Option<Kind>,
    /// How much of the squares it explains.
    pub part: f64,
    /// Over the rate.
    pub rate: Profile,
    /// Over the place, or within a turn.
    pub place: Profile,
    /// Over the time of the first record, s.
    pub time: Profile,
    /// The size over the shaft order; none for what does not turn.
    pub order: Profile,
    /// The size over the frequency, Hz.
    pub frequency: Profile,
    /// What opposes or drives the rate, over the largest rate of each window.
    pub amplitude: Profile,
}

impl ResidualForce {
    /// The name of the equation whose profiles these are.
    pub fn looked_at(&self) -> &str {
        &self.equations[self.equation].name
    }
}

/// The residual force of a fit, in an equation by its name or in the one where it explains most;
/// none where neighbouring motions cannot be followed.
pub fn residual_force(
    setting: &Setting<'_>,
    fit: &Fit,
    wanted: Option<&str>,
) -> Option<ResidualForce> {
    let equations = Equations::of(setting, fit)?;
    let at = At::of(setting, fit, 1.0);
    let of = (&at, setting, fit);
    let standings = stood(of, &equations);
    let ranges: Vec<Range> = (0..equations.list.len())
        .map(|equation| {
            let own = standings.iter().flatten().map(|all| all[equation]);
            Range::of(&own.collect::<Vec<Standing>>())
        })
        .collect();
    let length = standings
        .iter()
        .flatten()
        .flatten()
        .map(|s| s.time)
        .fold(0.0, f64::max);
    let general = |equation: usize| {
        let is_angle = equations.list[equation].unit == "rad";
        [
            Family::over_rate(equation, &ranges[equation]),
            Family::over_place(equation, &ranges[equation], is_angle),
            Family::over_time(equation, length),
        ]
    };
    let moves = |equation: &usize| ranges[*equation].width() > 0.0 && ranges[*equation].rate > 0.0;
    let all: Vec<usize> = (0..equations.list.len()).filter(moves).collect();
    let wave = |equation: usize| {
        let own = &equations.list[equation];
        waves((equation, own), &ranges[equation], (setting, fit, length))
    };
    let named = |name: &str| all.iter().position(|e| equations.list[*e].name == name);
    let mut families: Vec<Family> = all.iter().flat_map(|e| general(*e)).collect();
    if let [only] = all[..] {
        families.extend(wave(only));
    }
    let few = at.thinned();
    let looked = Looked::at((&few, setting, fit), &equations, families)?;
    let judged = Judged::of(&looked, all.len(), (&few, setting))?;
    let number = wanted.and_then(named).unwrap_or(judged.best);
    let equation = all[number];
    let close = match all.len() {
        1 => None,
        _ => {
            let own = general(equation).into_iter().chain(wave(equation));
            Some(Looked::at(of, &equations, own.collect())?)
        }
    };
    let (close, seen) = match &close {
        Some(close) => (close, &at),
        None => (&looked, &few),
    };
    let blocks = Blocks {
        at: seen,
        setting,
        standings: &standings,
        equation,
    };
    let mut found = blocks.profiles(close, &ranges[equation], fit);
    found.ranked = judged.ranked(&all);
    found.equations.clone_from(&equations.list);
    found.best = all[judged.best];
    if judged.stands_out {
        found.part = judged.part;
        found.kind = Some(match judged.is_state {
            false => Kind::Time,
            true => simple(&looked, judged.family, (&few, setting)),
        });
    } else if found.frequency.part > thresholds::STANDS_OUT && number == judged.best {
        // A line may stand between the bends over time.
        found.part = found.frequency.part;
        found.kind = Some(Kind::Time);
    }
    Some(found)
}

/// Waves that are looked at in one equation: orders that are gone through at least once, and
/// frequencies from one period per window on.
fn waves(
    (equation, of): (usize, &Equation),
    range: &Range,
    (setting, fit, length): (&Setting<'_>, &Fit, f64),
) -> Vec<Family> {
    let mut found = Vec::new();
    if of.unit == "rad" && range.width() > TAU / 4.0 {
        let turns = |order: &u32| f64::from(*order) * range.width() > TAU;
        let orders = ORDERS.into_iter().filter(turns);
        found.extend(orders.map(|order| Family::wave(equation, Over::Order(order))));
    }
    let step = eomgen_records::samples::typical_step(&setting.dataset.train[0].times);
    let (lowest, ratio, samples) = FREQUENCIES;
    let mut frequencies: Vec<f64> = peak_frequency(setting, fit).into_iter().collect();
    let mut periods = 1.0;
    for number in 1..=MOST_FREQUENCIES {
        if periods * samples * step > length {
            break;
        }
        frequencies.push(periods / length);
        periods = if number < lowest {
            periods + 1.0
        } else {
            periods * ratio
        };
    }
    frequencies.sort_by(f64::total_cmp);
    let wave = |frequency: f64| Family::wave(equation, Over::Frequency(frequency));
    found.extend(frequencies.into_iter().map(wave));
    found
}
