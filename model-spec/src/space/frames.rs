//! How frames move: angular velocity, velocity of the origin and the direction of gravity, from
//! frame to frame along each frame's own axes.

use std::collections::HashMap;

use super::moving::Moving;
use super::rotation::{Turn, turns};
use super::scalar::{add, call, is, name, number};
use super::vector::{AXES, Vector, cross, inner, sum, zero};
use super::{Demands, UnitDemand, expansion};
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use crate::dimension::Dimension;
use crate::order::{Reference, order};
use crate::raw::{Document, RawFrame, RawTerm};
use crate::span::Span;
use crate::suggest::did_you_mean;
use crate::table::{Name, Quantity, Written};

/// The longest chain of frames; beyond it the energies would be nested too deep.
const MAX_CHAIN: usize = 100;

/// How a frame moves, along its own axes.
#[derive(Clone)]
pub struct Frame {
    /// Angular velocity, in 1/s.
    pub omega: Vector,
    /// Velocity of the origin, in m/s.
    pub velocity: Vector,
    /// The direction of gravity, of length 1 if `strength` is there, else in m/s^2.
    pub down: Vector,
    /// The origin's way along `down` from that of the fixed axes.
    pub depth: Syntax,
    /// How many frames it is away from the fixed axes.
    level: usize,
}

/// The frames of a specification.
pub struct Frames {
    frames: HashMap<String, Frame>,
    /// By how much `down` is short of gravity, in m/s^2.
    pub strength: Option<Syntax>,
    /// Whether there is gravity.
    pub gravity: bool,
}

impl Frames {
    /// The frame of this name.
    ///
    /// # Errors
    /// If there is none, with the nearest.
    pub fn get(&self, written: &Written) -> Result<&Frame, Diagnostic> {
        let known = || self.frames.keys().map(String::as_str);
        self.frames
            .get(&written.text)
            .ok_or_else(|| unknown(written, known()))
    }
}

/// The frames, with what defines their motion added to the document's definitions.
pub fn expand(
    document: &mut Document,
    moving: &Moving,
    demands: &mut Demands,
    found: &mut Diagnostics,
) -> Frames {
    let place = document.name.span;
    let gravity = document.gravity.take();
    let (down, strength) = match gravity.as_ref() {
        Some(gravity) => along(
            gravity,
            "gravity",
            Dimension::of([0, 1, -2, 0]),
            demands,
            found,
        )
        .map_or((zero(place), None), direction),
        None => (zero(place), None),
    };
    let fixed = Frame {
        omega: zero(place),
        velocity: zero(place),
        down,
        depth: number(0.0, place),
        level: 0,
    };
    let mut frames = Frames {
        frames: HashMap::new(),
        strength,
        gravity: gravity.is_some(),
    };
    let raw = std::mem::take(&mut document.frames);
    let Some(sorted) = in_order(&raw, found) else {
        return frames;
    };
    for index in sorted {
        let frame = &raw[index];
        let parent = frame
            .parent
            .as_ref()
            .and_then(|p| frames.frames.get(&p.text));
        let parent = parent.unwrap_or(&fixed).clone();
        if parent.level == MAX_CHAIN {
            found.push(
                Diagnostic::error(format!("a chain of more than {MAX_CHAIN} frames"))
                    .at(frame.name.span, "one too many"),
            );
            return frames;
        }
        let mut motion = Motion {
            frame,
            moving,
            definitions: &mut document.definitions,
        };
        if let Some(built) = motion.of(parent, demands, found) {
            frames.frames.insert(frame.name.text.clone(), built);
        }
    }
    frames
}

/// Gravity along one axis is a strength times a direction, which keeps it out of the turning.
fn direction(gravity: Vector) -> (Vector, Option<Syntax>) {
    let mut along = gravity.iter().enumerate().filter(|(_, g)| !is(g, 0.0));
    let (Some((axis, strength)), None) = (along.next(), along.next()) else {
        return (gravity, None);
    };
    let mut down = zero(strength.span);
    down[axis] = number(1.0, strength.span);
    (down, Some(strength.clone()))
}

/// The components of a vector, which must have this unit.
pub fn along(
    components: &[Quantity],
    subject: &str,
    dimension: Dimension,
    demands: &mut Demands,
    found: &mut Diagnostics,
) -> Option<Vector> {
    let mut vector = Vec::with_capacity(3);
    for (value, axis) in components.iter().zip(AXES) {
        vector.push(found.keep(value.syntax())?);
        demands.units.push(UnitDemand {
            value: value.clone(),
            dimension,
            subject: format!("the {axis} component of {subject}"),
        });
    }
    vector.try_into().ok()
}

fn unknown<'n>(written: &Written, known: impl Iterator<Item = &'n str>) -> Diagnostic {
    let help = "frames are declared as [frames.NAME]";
    Diagnostic::error(format!("unknown frame {}", quoted(&written.text)))
        .at(written.span, "not in [frames]")
        .help(did_you_mean(&written.text, known).unwrap_or(help.to_owned()))
}

/// The frames so that each comes after the one it is placed in.
fn in_order(frames: &[RawFrame], found: &mut Diagnostics) -> Option<Vec<usize>> {
    let places: HashMap<&str, usize> = frames
        .iter()
        .enumerate()
        .map(|(index, frame)| (frame.name.text.as_str(), index))
        .collect();
    let mut references: Vec<Vec<Reference>> = Vec::with_capacity(frames.len());
    for frame in frames {
        let mut list = Vec::new();
        if let Some(parent) = &frame.parent {
            match places.get(parent.text.as_str()) {
                Some(&index) => list.push((index, parent.span)),
                None => found.push_with(|| unknown(parent, places.keys().copied())),
            }
        }
        references.push(list);
    }
    if !found.is_empty() {
        return None;
    }
    order(&references)
        .map_err(|circle| found.push(circular(&circle, frames)))
        .ok()
}

fn circular(circle: &[Reference], frames: &[RawFrame]) -> Diagnostic {
    let named: Vec<&str> = circle
        .iter()
        .take(8)
        .map(|(index, _)| frames[*index].name.text.as_str())
        .collect();
    let (first, place) = circle
        .first()
        .map_or(("", Span::default()), |(_, place)| (named[0], *place));
    Diagnostic::error(format!("the frame `{first}` is placed in itself"))
        .at(place, format!("here: {} -> ...", named.join(" -> ")))
        .help("one of them must be placed in the fixed axes: leave out `in`")
}

/// The motion of one frame.
struct Motion<'d> {
    frame: &'d RawFrame,
    moving: &'d Moving,
    definitions: &'d mut Vec<RawTerm>,
}

impl Motion<'_> {
    fn of(
        &mut self,
        parent: Frame,
        demands: &mut Demands,
        found: &mut Diagnostics,
    ) -> Option<Frame> {
        let own = &self.frame.name;
        let mut frame = Frame {
            level: parent.level + 1,
            ..parent
        };
        if let Some(origin) = &self.frame.origin {
            let subject = format!("the origin of `{}`", own.text);
            let origin = along(origin, &subject, Dimension::LENGTH, demands, found)?;
            frame.depth = add(frame.depth, inner(&frame.down, &origin));
            frame.depth = self.named(frame.depth, "depth");
            let carried = cross(&frame.omega, &origin);
            let relative = self.rates(origin);
            frame.velocity = sum(sum(frame.velocity, carried), relative);
        }
        let turns = match &self.frame.rotation {
            Some(rotation) => {
                let syntax = found.keep(rotation.syntax())?;
                found.keep(turns(&syntax))?
            }
            None => Vec::new(),
        };
        let last = turns.len();
        for (index, turn) in turns.iter().enumerate() {
            demands.units.push(UnitDemand {
                value: expansion(turn.angle.clone()),
                dimension: Dimension::NONE,
                subject: format!("an angle of `{}`", own.text),
            });
            let between = format!("turn_{}_", index + 1);
            let stem = if index + 1 == last { "" } else { &between };
            self.turn(turn, stem, &mut frame);
        }
        if last == 0 {
            self.name_all("", &mut frame);
        }
        Some(frame)
    }

    /// The frame along the axes that a turn makes.
    fn turn(&mut self, turn: &Turn, stem: &str, frame: &mut Frame) {
        frame.omega = turn.of(&frame.omega);
        if self.moving.holds(&turn.angle) {
            let rate = self.rate(turn.angle.clone(), &format!("{stem}angle"));
            let about = frame.omega[turn.axis].clone();
            frame.omega[turn.axis] = add(about, rate);
        }
        frame.velocity = turn.of(&frame.velocity);
        frame.down = turn.of(&frame.down);
        self.name_all(stem, frame);
    }

    fn name_all(&mut self, stem: &str, frame: &mut Frame) {
        self.name_each(&mut frame.omega, &format!("{stem}omega"));
        self.name_each(&mut frame.velocity, &format!("{stem}v"));
        self.name_each(&mut frame.down, &format!("{stem}down"));
    }

    fn name_each(&mut self, vector: &mut Vector, what: &str) {
        for (component, axis) in vector.iter_mut().zip(AXES) {
            *component = self.named(component.clone(), &format!("{what}_{axis}"));
        }
    }

    /// The rates of a vector's components.
    fn rates(&mut self, vector: Vector) -> Vector {
        let mut axes = AXES.into_iter();
        vector.map(|component| {
            let axis = axes.next().unwrap_or_default();
            if self.moving.holds(&component) {
                self.rate(component, &format!("origin_{axis}"))
            } else {
                number(0.0, component.span)
            }
        })
    }

    /// The rate of something that moves; what is no name gets one, for `dot` takes names.
    fn rate(&mut self, value: Syntax, what: &str) -> Syntax {
        let span = value.span;
        let value = match value.kind {
            SyntaxKind::Name(_) => value,
            _ => self.define(value, what),
        };
        Syntax {
            span,
            ..call("dot", value)
        }
    }

    /// The expression, by a name if it is more than a number, a name or a rate.
    fn named(&mut self, value: Syntax, what: &str) -> Syntax {
        let plain = |syntax: &Syntax| match &syntax.kind {
            SyntaxKind::Number(_) | SyntaxKind::Name(_) => true,
            SyntaxKind::Call { function, .. } => function == "dot",
            _ => false,
        };
        match &value.kind {
            SyntaxKind::Negate(operand) if plain(operand) => value,
            _ if plain(&value) => value,
            _ => self.define(value, what),
        }
    }

    fn define(&mut self, value: Syntax, what: &str) -> Syntax {
        let own = &self.frame.name;
        let span = value.span;
        let text = format!("{}_{what}", own.text);
        let defined = name(&text, span);
        self.definitions.push(RawTerm {
            name: Name {
                text,
                span: own.span,
            },
            value: expansion(value),
            doc: self.frame.doc.clone(),
            origin: String::new(),
        });
        defined
    }
}
