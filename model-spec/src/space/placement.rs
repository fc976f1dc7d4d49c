//! Directions of the axes of frames, and positions and velocities of their origins, as components along the fixed
//! axes. They are computed when they are needed, for a frame and its ancestors.

use std::collections::HashMap;

use super::definitions::Definitions;
use super::frames::{Frame, Frames, rotation_prefixes};
use super::scalar::{add, number};
use super::vector::{AXES, Rows, Vector, rotate, zero};
use crate::span::Span;

#[derive(Default)]
pub struct Placements {
    rows: HashMap<String, Rows>,
    origins: HashMap<String, Vector>,
    motions: HashMap<(String, &'static str), Vector>,
}

fn identity(span: Span) -> Rows {
    [0, 1, 2].map(|axis| {
        let mut row = zero(span);
        row[axis] = number(1.0, span);
        row
    })
}

impl Placements {
    /// Returns the directions of a frame's axes.
    pub fn rows(&mut self, frame: &Frame, frames: &Frames, definitions: &mut Definitions) -> Rows {
        let owner = &frame.owner;
        if let Some(rows) = self.rows.get(&owner.name.text) {
            return rows.clone();
        }
        let mut rows = self.parent_rows(frame, frames, definitions);
        for (turn, stem) in frame.turns.iter().zip(rotation_prefixes(frame.turns.len())) {
            rows = rows.map(|row| turn.rotate_axes(&row));
            for (row, fixed) in rows.iter_mut().zip(AXES) {
                for (element, own) in row.iter_mut().zip(AXES) {
                    // Component of the axis `own` of the frame along the fixed axis `fixed`.
                    let what = format!("{stem}{own}_{fixed}");
                    *element = definitions.named(owner, &what, element.clone());
                }
            }
        }
        self.rows.insert(owner.name.text.clone(), rows.clone());
        rows
    }

    pub fn origin(
        &mut self,
        frame: &Frame,
        frames: &Frames,
        definitions: &mut Definitions,
    ) -> Vector {
        let owner = &frame.owner;
        if let Some(origin) = self.origins.get(&owner.name.text) {
            return origin.clone();
        }
        let parent = frame
            .parent
            .as_deref()
            .and_then(|name| frames.name_motion(name));
        let before = match parent {
            Some(parent) => self.origin(parent, frames, definitions),
            None => zero(owner.name.span),
        };
        let rows = self.parent_rows(frame, frames, definitions);
        let [x, y, z] = rotate(&rows, &frame.origin);
        let [bx, by, bz] = before;
        let origin = [add(bx, x), add(by, y), add(bz, z)];
        let origin = definitions.name_each(owner, "origin", origin);
        self.origins.insert(owner.name.text.clone(), origin.clone());
        origin
    }

    pub fn velocity(
        &mut self,
        frame: &Frame,
        frames: &Frames,
        definitions: &mut Definitions,
    ) -> Vector {
        let own = &frame.motion.velocity;
        self.motion("velocity", own, frame, frames, definitions)
    }

    pub fn angular_velocity(
        &mut self,
        frame: &Frame,
        frames: &Frames,
        definitions: &mut Definitions,
    ) -> Vector {
        let own = &frame.motion.omega;
        self.motion("angular_velocity", own, frame, frames, definitions)
    }

    fn motion(
        &mut self,
        what: &'static str,
        own: &Vector,
        frame: &Frame,
        frames: &Frames,
        definitions: &mut Definitions,
    ) -> Vector {
        let key = (frame.owner.name.text.clone(), what);
        if let Some(known) = self.motions.get(&key) {
            return known.clone();
        }
        let rows = self.rows(frame, frames, definitions);
        let motion = definitions.name_each(&frame.owner, what, rotate(&rows, own));
        self.motions.insert(key, motion.clone());
        motion
    }

    fn parent_rows(
        &mut self,
        frame: &Frame,
        frames: &Frames,
        definitions: &mut Definitions,
    ) -> Rows {
        match frame
            .parent
            .as_deref()
            .and_then(|name| frames.name_motion(name))
        {
            Some(parent) => self.rows(parent, frames, definitions),
            None => identity(frame.owner.name.span),
        }
    }
}
