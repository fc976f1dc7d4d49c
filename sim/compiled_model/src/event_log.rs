//! Event log of a motion: surface, kind, modes before and after, and jumps of the rates.

use eomgen_sim::ode::{Event, Surface, SurfaceKind, SurfaceMode, Trajectory};

use crate::motion::Motion;

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// The motion crosses the surface.
    Crossing,
    /// The surface begins to hold the motion, for example at the start of sticking.
    Stick,
    /// The surface stops holding the motion.
    Slip,
    /// Bodies touch, and their rates jump.
    Impact,
    /// Bodies touch and stay together.
    Contact,
    /// Bodies that touched separate.
    Separation,
    /// The rates jump because the motion crosses a surface at which the energies jump.
    Corner,
    /// The motion is reflected from a surface at which the energies jump.
    Reflection,
    /// The rates jump because an input jumps.
    Input,
}

impl EventKind {
    /// Returns the name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Crossing => "crossing",
            Self::Stick => "stick",
            Self::Slip => "slip",
            Self::Impact => "impact",
            Self::Contact => "contact",
            Self::Separation => "separation",
            Self::Corner => "corner",
            Self::Reflection => "reflection",
            Self::Input => "input",
        }
    }

    fn find(kind: SurfaceKind, event: &Event, jumps: bool) -> Self {
        let is_returned = event.from == event.to;
        match (kind, event.from, event.to) {
            (SurfaceKind::Distance, SurfaceMode::Closed, _) => Self::Separation,
            (SurfaceKind::Distance, ..) if jumps => Self::Impact,
            (SurfaceKind::Distance, ..) => Self::Contact,
            (_, _, SurfaceMode::Held) => Self::Stick,
            (_, SurfaceMode::Held, _) => Self::Slip,
            (SurfaceKind::Function, ..) if is_returned => Self::Reflection,
            (SurfaceKind::Function, ..) if jumps => Self::Corner,
            _ => Self::Crossing,
        }
    }
}

/// An event of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedEvent<'m> {
    /// Time, s.
    pub t: f64,
    /// Name of the contact, or formula of the switching function; empty for jumps caused by a jump of an input.
    pub surface: &'m str,
    /// Kind of the event.
    pub kind: EventKind,
    /// Modes of the surface before and after; `None` without a surface.
    pub modes: Option<(SurfaceMode, SurfaceMode)>,
    /// Jump of each rate, in its SI unit; simultaneous events share it. Empty without a jump.
    pub jump: &'m [f64],
}

impl Motion {
    /// Returns the events of the motion in order of time. `degrees` is the number of degrees of freedom.
    pub fn event_log(&self, degrees: usize) -> Vec<LoggedEvent<'_>> {
        log_events(&self.trajectory, &self.surfaces, degrees)
    }
}

/// Returns the events of a trajectory at the given surfaces in order of time.
pub(crate) fn log_events<'m>(
    trajectory: &'m Trajectory,
    surfaces: &'m [Surface],
    degrees: usize,
) -> Vec<LoggedEvent<'m>> {
    let (events, jumps) = (&trajectory.events, &trajectory.jumps);
    let mut log = Vec::with_capacity(events.len());
    let mut next = 0;
    for jump in jumps {
        let (t, change) = (jump.t, &jump.change[degrees..2 * degrees]);
        while let Some(event) = events.get(next).filter(|event| event.t < t) {
            log.push(log_event(surfaces, event, &[]));
            next += 1;
        }
        let first = log.len();
        while let Some(event) = events.get(next).filter(|event| event.t == t) {
            log.push(log_event(surfaces, event, change));
            next += 1;
        }
        if log.len() == first {
            log.push(LoggedEvent {
                t,
                surface: "",
                kind: EventKind::Input,
                modes: None,
                jump: change,
            });
        }
    }
    log.extend(
        events[next..]
            .iter()
            .map(|event| log_event(surfaces, event, &[])),
    );
    log
}

fn log_event<'m>(surfaces: &'m [Surface], event: &Event, jump: &'m [f64]) -> LoggedEvent<'m> {
    let surface = surfaces.get(event.guard);
    let kind = surface.map_or(SurfaceKind::Function, |surface| surface.kind);
    LoggedEvent {
        t: event.t,
        surface: surface.map_or("", |surface| &surface.formula),
        kind: EventKind::find(kind, event, !jump.is_empty()),
        modes: Some((event.from, event.to)),
        jump,
    }
}
