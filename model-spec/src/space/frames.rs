//! Motion of frames: angular velocity, velocity of the origin and direction of gravity. They are computed from frame
//! to frame, as components along the axes of each frame.

use std::collections::HashMap;

use super::definitions::{Definitions, Owner};
use super::rotation::Turn;
use super::scalar::{add, is_literal, number};
use super::vector::{AXES, Vector, cross, inner, scale, sum, zero};
use crate::ast::Syntax;
use crate::diagnostic::{Diagnostic, quote};
use crate::ids::FrameId;
use crate::quantity::StringValue;
use crate::span::Span;
use crate::suggest::did_you_mean;

/// Longest chain of frames; the energies of a longer one would exceed the depth of expressions.
const MAX_CHAIN: usize = 100;

/// Motion of a frame, as components along its own axes.
#[derive(Clone)]
pub struct Motion {
    pub omega: Vector,
    /// Velocity of the origin, in m/s.
    pub velocity: Vector,
    /// Direction of gravity: a unit vector if `strength` is set, else the acceleration in m/s^2.
    pub down: Vector,
    /// Displacement of the origin along `down`, from the origin of the fixed axes.
    pub depth: Syntax,
}

#[derive(Clone)]
pub struct Frame {
    pub owner: Owner,
    /// Parent frame; `None` for the fixed axes.
    pub parent: Option<String>,
    /// Origin along the parent's axes, in m.
    pub origin: Vector,
    /// Rotations from the axes of the parent to the axes of the frame.
    pub turns: Vec<Turn>,
    pub motion: Motion,
    /// Index among the frames, in dependency order.
    pub id: FrameId,
    /// Number of frames between this frame and the fixed axes.
    level: usize,
}

pub struct Frames {
    frames: HashMap<String, Frame>,
    /// Motion of the fixed axes: zero.
    fixed: Motion,
    /// Factor from `down` to the acceleration of free fall, in m/s^2.
    pub strength: Option<Syntax>,
    pub gravity: bool,
}

impl Frames {
    /// Creates the list of frames, with gravity and with the fixed axes only.
    pub fn with_gravity(gravity: Option<Vector>, place: Span) -> Self {
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

    pub fn name_motion(&self, name: &str) -> Option<&Frame> {
        self.frames.get(name)
    }

    pub fn in_order(&self) -> Vec<&Frame> {
        let mut frames: Vec<&Frame> = self.frames.values().collect();
        frames.sort_by_key(|frame| frame.id);
        frames
    }

    /// Returns the acceleration of free fall along the fixed axes, in m/s^2.
    pub fn acceleration_of_free_fall(&self) -> Vector {
        match &self.strength {
            Some(strength) => scale(&self.fixed.down, strength),
            None => self.fixed.down.clone(),
        }
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.frames.keys().map(String::as_str)
    }

    pub fn get(&self, written: &StringValue) -> Result<&Frame, Diagnostic> {
        self.name_motion(&written.text)
            .ok_or_else(|| unknown_frame_error(written, self.names()))
    }

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
            return Err(Diagnostic::error(format!(
                "the chain of frames is longer than {MAX_CHAIN}"
            ))
            .with_span(owner.name.span, "one frame too many"));
        }
        let motion = before.map_or(&self.fixed, |frame| &frame.motion).clone();
        let motion = translate_motion(motion, &origin, &owner, definitions);
        let motion = rotate_motion(motion, &turns, &owner, definitions);
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

pub fn unknown_frame_error<'n>(
    written: &StringValue,
    known: impl Iterator<Item = &'n str>,
) -> Diagnostic {
    let help = "declare a frame as [frames.NAME]";
    Diagnostic::error(format!("unknown frame {}", quote(&written.text)))
        .with_span(written.span, "not in [frames]")
        .with_help(did_you_mean(&written.text, known).unwrap_or(help.to_owned()))
}

/// If gravity is along one axis, splits it into a magnitude and a direction. The rotations then transform only
/// numbers.
fn direction(gravity: Vector) -> (Vector, Option<Syntax>) {
    let mut along = gravity
        .iter()
        .enumerate()
        .filter(|(_, g)| !is_literal(g, 0.0));
    let (Some((axis, strength)), None) = (along.next(), along.next()) else {
        return (gravity, None);
    };
    let mut down = zero(strength.span);
    down[axis] = number(1.0, strength.span);
    (down, Some(strength.clone()))
}

/// Returns the motion of a frame with this origin, as components along the axes of the parent.
fn translate_motion(
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

fn rotate_motion(
    mut motion: Motion,
    turns: &[Turn],
    owner: &Owner,
    definitions: &mut Definitions,
) -> Motion {
    for (turn, stem) in turns.iter().zip(rotation_prefixes(turns.len())) {
        motion.omega = turn.rotate_axes(&motion.omega);
        let rate = definitions.rate(owner, &format!("{stem}angle"), turn.angle.clone());
        let about = motion.omega[turn.axis].clone();
        motion.omega[turn.axis] = add(about, rate);
        motion.velocity = turn.rotate_axes(&motion.velocity);
        motion.down = turn.rotate_axes(&motion.down);
        motion = name_motion(motion, &stem, owner, definitions);
    }
    if turns.is_empty() {
        motion = name_motion(motion, "", owner, definitions);
    }
    motion
}

/// Returns the prefixes of the names after each of `count` rotations; empty after the last.
pub fn rotation_prefixes(count: usize) -> impl Iterator<Item = String> {
    (1..=count).map(move |turn| match turn == count {
        true => String::new(),
        false => format!("turn_{turn}_"),
    })
}

fn name_motion(motion: Motion, stem: &str, owner: &Owner, definitions: &mut Definitions) -> Motion {
    let mut name = |what: &str, vector| definitions.name_each(owner, what, vector);
    Motion {
        omega: name(&format!("{stem}omega"), motion.omega),
        velocity: name(&format!("{stem}v"), motion.velocity),
        down: name(&format!("{stem}down"), motion.down),
        depth: motion.depth,
    }
}
