//! Frames and bodies of a model as declared. The energies of the model already contain the terms of the bodies.
//! Recursive algorithms, which proceed from body to body, use this tree.

use crate::ids::FrameId;

/// Frames with the bodies fixed to them, and gravity; `T` is the type of an expression.
#[derive(Clone, Debug)]
pub struct RigidTree<T> {
    /// Acceleration of free fall along the fixed axes, in m/s^2; 0 without gravity.
    pub gravity: [T; 3],
    /// Frames, each after its parent.
    pub frames: Vec<PlacedFrame<T>>,
    /// Bodies.
    pub bodies: Vec<RigidBody<T>>,
}

/// Frame, given by the position of its origin and the rotation of its axes.
#[derive(Clone, Debug)]
pub struct PlacedFrame<T> {
    /// Parent frame; `None` for the fixed axes.
    pub parent: Option<FrameId>,
    /// Origin along the parent's axes, in m.
    pub origin: [T; 3],
    /// Rotations from the axes of the parent to the axes of this frame. Each is about an axis that the earlier
    /// rotations have rotated.
    pub turns: Vec<AxisTurn<T>>,
}

/// Right-handed rotation about a coordinate axis.
#[derive(Clone, Debug)]
pub struct AxisTurn<T> {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Angle, in rad.
    pub angle: T,
    /// Cosine of the angle: a number for quarter turns.
    pub cosine: T,
    /// Sine of the angle: a number for quarter turns.
    pub sine: T,
}

/// Rigid body.
#[derive(Clone, Debug)]
pub struct RigidBody<T> {
    /// Name of the body and of its terms in the energies.
    pub name: String,
    /// Frame that the body is fixed to.
    pub frame: FrameId,
    /// Mass, in kg; 0 for a body that has only inertia.
    pub mass: T,
    /// Centre of mass along the frame's axes, in m.
    pub centre: [T; 3],
    /// I_xx, I_yy, I_zz about the centre of mass along the frame's axes, in kg m^2; 0 for a point
    /// mass.
    pub moments: [T; 3],
    /// I_xy, I_yz, I_xz of the same inertia matrix.
    pub products: [T; 3],
}

impl<T> RigidTree<T> {
    /// Converts every expression of the tree.
    ///
    /// # Errors
    /// The first error that `change` returns.
    pub fn try_map<U, E>(
        &self,
        mut change: impl FnMut(&T) -> Result<U, E>,
    ) -> Result<RigidTree<U>, E> {
        let change = &mut change;
        let frames = self.frames.iter().map(|frame| frame.try_map(change));
        let frames = frames.collect::<Result<_, E>>()?;
        let bodies = self.bodies.iter().map(|body| body.try_map(change));
        let bodies = bodies.collect::<Result<_, E>>()?;
        Ok(RigidTree {
            gravity: try_map_three(&self.gravity, change)?,
            frames,
            bodies,
        })
    }
}

impl<T> PlacedFrame<T> {
    fn try_map<U, E>(
        &self,
        change: &mut impl FnMut(&T) -> Result<U, E>,
    ) -> Result<PlacedFrame<U>, E> {
        let mut turns = Vec::with_capacity(self.turns.len());
        for turn in &self.turns {
            turns.push(AxisTurn {
                axis: turn.axis,
                angle: change(&turn.angle)?,
                cosine: change(&turn.cosine)?,
                sine: change(&turn.sine)?,
            });
        }
        Ok(PlacedFrame {
            parent: self.parent,
            origin: try_map_three(&self.origin, change)?,
            turns,
        })
    }
}

impl<T> RigidBody<T> {
    fn try_map<U, E>(
        &self,
        change: &mut impl FnMut(&T) -> Result<U, E>,
    ) -> Result<RigidBody<U>, E> {
        Ok(RigidBody {
            name: self.name.clone(),
            frame: self.frame,
            mass: change(&self.mass)?,
            centre: try_map_three(&self.centre, change)?,
            moments: try_map_three(&self.moments, change)?,
            products: try_map_three(&self.products, change)?,
        })
    }
}

fn try_map_three<T, U, E>(
    parts: &[T; 3],
    change: &mut impl FnMut(&T) -> Result<U, E>,
) -> Result<[U; 3], E> {
    let [x, y, z] = parts.each_ref().map(change);
    Ok([x?, y?, z?])
}
