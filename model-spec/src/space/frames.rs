//! How frames move: angular velocity, velocity of the origin and the direction of gravity, from
//! frame to frame along each frame's own axes.

use std::collections::HashMap;

use super::definitions::{Definitions, Owner};
use super::rotation::Turn;
use super::scalar::{add, is, number};
use super::vector::{AXES, Vector, cross, inner, scaled, sum, zero};
use crate::ast::Syntax;
use crate::diagnostic::{Diagnostic, quoted};
use crate::ids::FrameId;
use crate::span::Span;
use crate::suggest::did_you_mean;
use crate::table::Written;

/// The longest chain of frames; beyond it the energies would be nested too deep.
const MAX_CHAIN: usize = 100;

/// How a frame moves, along its own axes.
#[derive(Clone)]
pub struct Motion {
    /// Angular velocity, in 1/s.
    pub omega: Vector,
    /// Velocity of the origin, in m/s.
    pub velocity: Vector,
    /// The direction of gravity, of length 1 if `strength` is there, else in m/s^2.
    pub down: Vector,
    /// The origin's way along `down` from that of the fixed axes.
    pub depth: Syntax,
}

/// A frame of a specification.
#[derive(Clone)]
pub struct Frame {
    /// Its entry.
    pub owner: Owner,
    /// The frame that it is placed in; the fixed axes if there is none.
    pub parent: Option<String>,
    /// Its origin along that frame's axes, in m.
    pub origin: Vector,
    /// From that frame's axes to its own.
    pub turns: Vec<Turn>,
    /// How it moves.
    pub motion: Motion,
    /// Its place among the frames, in the order in which they are placed.
    pub id: FrameId,
    /// How many frames it is away from the fixed axes.
    level: usize,
}

/// The frames of a specification.
pub struct Frames {
    frames: HashMap<String, Frame>,
    /// The fixed axes, which do not move.
    fixed: Motion,
    /// By how much `down` is short of gravity, in m/s^2.
    pub strength: Option<Syntax>,
    /// Whether there is gravity.
    pub gravity: bool,
}

impl Frames {
    /// No frame yet but the fixed axes.
    pub fn under(gravity: Option<Vector>, place: Span) -> Self {
        let is_given = gravity.is_some();
        let (down, strength) = gravity.map_or((zero(place), None), direction);
        Self {
            frames: HashMap::new(),
            fixed: Motion {
                omega: zero(place),
                velocity: zero(place),
                down,
                depth: number(0.0, place),
            },
            strength,
            gravity: is_given,
        }
    }

    /// The frame of this name.
    pub fn named(&self, name: &str) -> Option<&Frame> {
        self.frames.get(name)
    }

    /// All frames, each after the one it is placed in.
    pub fn in_order(&self) -> Vec<&Frame> {
        let mut frames: Vec<&Frame> = self.frames.values().collect();
        frames.sort_by_key(|frame| frame.id);
        frames
    }

    /// Gravity along the fixed axes, in m/s^2; 0 if there is none.
    pub fn acceleration_of_free_fall(&self) -> Vector {
        match &self.strength {
            Some(strength) => scaled(&self.fixed.down, strength),
            None => self.fixed.down.clone(),
        }
    }

    /// The names of all frames.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.frames.keys().map(String::as_str)
    }

    /// The frame of this name.
    ///
    /// # Errors
    /// If there is none, with the nearest.
    pub fn get(&self, written: &Written) -> Result<&Frame, Diagnostic> {
        self.named(&written.text)
            .ok_or_else(|| unknown(written, self.names()))
    }

    /// Places a frame whose parent is placed.
    ///
    /// # Errors
    /// A chain of too many.
    pub fn place(
        &mut self,
        owner: Owner,
        parent: Option<&str>,
        (origin, turns): (Vector, Vec<Turn>),
        definitions: &mut Definitions,
    ) -> Result<(), Diagnostic> {
        let before = parent.and_then(|name| self.frames.get(name));
        let level = before.map_or(0, |frame| frame.level) + 1;
        if level > MAX_CHAIN {
            return Err(
                Diagnostic::error(format!("a chain of more than {MAX_CHAIN} frames"))
                    .at(owner.name.span, "one too many"),
            );
        }
        let motion = before.map_or(&self.fixed, |frame| &frame.motion).clone();
        let motion = moved(motion, &origin, &owner, definitions);
        let motion = turned(motion, &turns, &owner, definitions);
        let frame = Frame {
            parent: parent.map(str::to_owned),
            origin,
            turns,
            motion,
            id: FrameId::new(self.frames.len()),
            level,
            owner,
        };
        self.frames.insert(frame.owner.name.text.clone(), frame);
        Ok(())
    }
}

/// The finding that there is no frame of this name.
pub fn unknown<'n>(written: &Written, known: impl Iterator<Item = &'n str>) -> Diagnostic {
    let help = "frames are declared as [frames.NAME]";
    Diagnostic::error(format!("unknown frame {}", quoted(&written.text)))
        .at(written.span, "not in [frames]")
        .help(did_you_mean(&written.text, known).unwrap_or(help.to_owned()))
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

/// The motion of a frame with this origin, along its parent's axes.
fn moved(
    mut motion: Motion,
    origin: &Vector,
    owner: &Owner,
    definitions: &mut Definitions,
) -> Motion {
    motion.depth = add(motion.depth, inner(&motion.down, origin));
    motion.depth = definitions.named(owner, "depth", motion.depth);
    let origin = definitions.name_each(owner, "offset", origin.clone());
    let carried = cross(&motion.omega, &origin);
    let mut axes = AXES.into_iter();
    let relative = origin.map(|component| {
        let axis = axes.next().unwrap_or_default();
        definitions.rate(owner, &format!("offset_{axis}"), component)
    });
    motion.velocity = sum(sum(motion.velocity, carried), relative);
    motion
}

/// The motion along the axes that turns make.
fn turned(
    mut motion: Motion,
    turns: &[Turn],
    owner: &Owner,
    definitions: &mut Definitions,
) -> Motion {
    for (turn, stem) in turns.iter().zip(stems(turns.len())) {
        motion.omega = turn.of(&motion.omega);
        let rate = definitions.rate(owner, &format!("{stem}angle"), turn.angle.clone());
        let about = motion.omega[turn.axis].clone();
        motion.omega[turn.axis] = add(about, rate);
        motion.velocity = turn.of(&motion.velocity);
        motion.down = turn.of(&motion.down);
        motion = named(motion, &stem, owner, definitions);
    }
    if turns.is_empty() {
        motion = named(motion, "", owner, definitions);
    }
    motion
}

/// What the names behind each of some turns begin with; behind the last, nothing.
pub fn stems(count: usize) -> impl Iterator<Item = String> {
    (1..=count).map(move |turn| match turn == count {
        true => String::new(),
        false => format!("turn_{turn}_"),
    })
}

fn named(motion: Motion, stem: &str, owner: &Owner, definitions: &mut Definitions) -> Motion {
    let mut name = |what: &str, vector| definitions.name_each(owner, what, vector);
    Motion {
        omega: name(&format!("{stem}omega"), motion.omega),
        velocity: name(&format!("{stem}v"), motion.velocity),
        down: name(&format!("{stem}down"), motion.down),
        depth: motion.depth,
    }
}
