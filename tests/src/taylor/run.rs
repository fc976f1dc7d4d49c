//! Integration of the arm from rest at zero. Steps end at switches.

use super::arm::{Arm, Case};
use super::crossing::first_rise;
use super::expansion::{Expander, Series, Side, State};
use super::scalar::Scalar;

/// Maximum step size, in s.
pub const MAX_STEP_S: f64 = 1.0 / 1024.0;

/// Magnitude in m of the smallest motion that steps resolve to rounding accuracy: 1/25 of the reference's half
/// backlash.
const RESOLUTION_M: f64 = 1e-6;

/// Change of the contact state of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Switch<T> {
    /// Time, in s.
    pub time: T,
    /// Mesh: 0 is sun-planet, 1 is planet-ring.
    pub mesh: usize,
    /// New contact state.
    pub to: Side,
}

/// Result of a run: states at the requested times, and all switches up to the last time.
#[derive(Clone, Debug)]
pub struct Run<T> {
    /// One state per requested time.
    pub states: Vec<State<T>>,
    /// Switches in the order of time. The initial contact state without backlash is not a switch.
    pub switches: Vec<Switch<T>>,
    /// Number of Taylor series.
    pub steps: usize,
    /// phi_i(l) of each mode.
    pub tips: Vec<T>,
}

impl<T: Scalar> Run<T> {
    /// Integrates from rest at zero through `times`, in s and ascending. `longest` is the maximum step size in s, a
    /// power of two. With [`MAX_STEP_S`] the motion determines the step sizes.
    pub fn simulate(case: Case, times: &[f64], longest: f64) -> Self {
        let arm = Arm::<T>::from_case(case);
        let tips = arm.modes.iter().map(|mode| mode.tip).collect();
        let mut motion = Motion::at_rest(Expander::new(arm, longest));
        let mut run = Self {
            states: Vec::with_capacity(times.len()),
            switches: Vec::new(),
            steps: 0,
            tips,
        };
        while run.states.len() < times.len() {
            motion.step(times, &mut run);
            run.steps += 1;
        }
        run
    }

    /// Returns the deflection of the arm's end at the time of index `sample`, in m.
    pub fn tip(&self, sample: usize) -> T {
        let positions = &self.states[sample].positions[3..];
        (self.tips.iter().zip(positions)).fold(T::from_f64(0.0), |tip, (phi, q)| tip + *phi * *q)
    }

    /// Returns the number of switches of each mesh.
    pub fn switch_counts(&self) -> [usize; 2] {
        [0, 1].map(|mesh| {
            self.switches
                .iter()
                .filter(|switch| switch.mesh == mesh)
                .count()
        })
    }
}

/// Current state of the integration.
struct Motion<T> {
    expander: Expander<T>,
    time: T,
    state: State<T>,
    sides: [Side; 2],
}

impl<T: Scalar> Motion<T> {
    fn at_rest(expander: Expander<T>) -> Self {
        let rest = vec![T::from_f64(0.0); expander.width()];
        let state = State {
            positions: rest.clone(),
            rates: rest,
        };
        let sides = initial_sides(&expander, &state);
        Self {
            expander,
            time: T::from_f64(0.0),
            state,
            sides,
        }
    }

    /// Advances the motion to the end of one series or to its first switch.
    fn step(&mut self, times: &[f64], run: &mut Run<T>) {
        let series = self.resolved_series();
        let sigma = self.expander.sigma();
        let switch = self.first_switch(&series);
        let until = switch.map_or(T::from_f64(1.0), |(at, ..)| at);
        while let Some(time) = times.get(run.states.len()) {
            let at = (T::from_f64(*time) - self.time).scaled_by(1.0 / sigma);
            if at > until {
                break;
            }
            run.states.push(series.state(at));
        }
        self.time = self.time + until.scaled_by(sigma);
        let Some((at, mesh, to)) = switch else {
            self.state = series.end();
            return;
        };
        self.state = series.state(at);
        self.sides[mesh] = to;
        if run.states.len() < times.len() {
            let time = self.time;
            run.switches.push(Switch { time, mesh, to });
        }
    }

    /// Returns the series about the current time, with a time unit for which the remainder is negligible. The unit
    /// decreases if the motion becomes faster and does not increase again.
    fn resolved_series(&mut self) -> Series<T> {
        loop {
            let series = self.expander.expand(self.time, &self.state, self.sides);
            if series.tail() <= T::EPSILON * RESOLUTION_M {
                return series;
            }
            self.expander = self.expander.with_half_time_unit();
        }
    }

    /// Returns the first switch within the series: its position, mesh and new contact state.
    fn first_switch(&self, series: &Series<T>) -> Option<(T, usize, Side)> {
        let b = self.expander.arm().b;
        let mut first: Option<(T, usize, Side)> = None;
        for (mesh, side) in self.sides.into_iter().enumerate() {
            let deflection = series.displacement_series(mesh);
            for (outside, to) in distances_beyond_edges(&deflection, side, b) {
                let Some(at) = first_rise(&outside) else {
                    continue;
                };
                if first.is_none_or(|(earliest, ..)| at < earliest) {
                    first = Some((at, mesh, to));
                }
            }
        }
        first
    }
}

/// Returns each contact state that can follow `side`, with the series of the distance beyond the edge of the backlash.
fn distances_beyond_edges<T: Scalar>(deflection: &[T], side: Side, b: T) -> Vec<(Vec<T>, Side)> {
    let beyond = |sign: f64, edge: T| {
        let mut outside: Vec<T> = deflection.iter().map(|x| x.scaled_by(sign)).collect();
        outside[0] = outside[0] - edge;
        outside
    };
    let without_play = b == T::from_f64(0.0);
    match side {
        Side::Free => vec![
            (beyond(1.0, b), Side::Positive),
            (beyond(-1.0, b), Side::Negative),
        ],
        Side::Positive if without_play => vec![(beyond(-1.0, b), Side::Negative)],
        Side::Negative if without_play => vec![(beyond(1.0, b), Side::Positive)],
        Side::Positive => vec![(beyond(-1.0, -b), Side::Free)],
        Side::Negative => vec![(beyond(1.0, -b), Side::Free)],
    }
}

/// Returns the initial contact states at rest at zero. Without backlash, the side is the sign of the first nonzero
/// derivative of the deflection. It can be computed with either side, because the mesh carries no force up to this
/// derivative.
fn initial_sides<T: Scalar>(expander: &Expander<T>, rest: &State<T>) -> [Side; 2] {
    let zero = T::from_f64(0.0);
    if expander.arm().b > zero {
        return [Side::Free; 2];
    }
    let series = expander.expand(zero, rest, [Side::Positive; 2]);
    [0, 1].map(|mesh| {
        match series
            .displacement_series(mesh)
            .into_iter()
            .find(|x| *x != zero)
        {
            Some(leading) if leading < zero => Side::Negative,
            _ => Side::Positive,
        }
    })
}
