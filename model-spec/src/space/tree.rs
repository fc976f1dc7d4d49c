//! Builds the tree of frames and bodies as declared. The energies are generated separately.

use super::frames::{Frame, Frames};
use super::rotation::Turn;
use crate::ast::Syntax;
use crate::rigid_tree::{AxisTurn, PlacedFrame, RigidBody, RigidTree};

pub fn tree(frames: &Frames, bodies: Vec<RigidBody<Syntax>>) -> Option<RigidTree<Syntax>> {
    if bodies.is_empty() {
        return None;
    }
    let placed = |frame: &Frame| PlacedFrame {
        parent: frame
            .parent
            .as_ref()
            .and_then(|name| Some(frames.name_motion(name)?.id)),
        origin: frame.origin.clone(),
        turns: frame.turns.iter().map(axis_turn).collect(),
    };
    Some(RigidTree {
        gravity: frames.acceleration_of_free_fall(),
        frames: frames.in_order().into_iter().map(placed).collect(),
        bodies,
    })
}

fn axis_turn(turn: &Turn) -> AxisTurn<Syntax> {
    let (cosine, sine) = turn.cosine_and_sine();
    AxisTurn {
        axis: turn.axis,
        angle: turn.angle.clone(),
        cosine,
        sine,
    }
}
