//! The frames and the bodies of a model as they are declared: what their energies, which are terms
//! of the model as any others, do not show. Nothing needs them; recursions from body to body do.

use crate::ids::FrameId;

/// Frames with the bodies fixed to them, and gravity; expressions of kind `T`.
#[derive(Clone, Debug)]
pub struct RigidTree<T> {
    /// The acceleration of free fall along the fixed axes, in m/s^2; 0 where bodies have no weight.
    pub gravity: [T; 3],
    /// The frames, each after the one that it is placed in.
    pub frames: Vec<PlacedFrame<T>>,
    /// The bodies. Each gives its name to its energies.
    pub bodies: Vec<RigidBody<T>>,
}

/// A frame: its origin moved, then its axes turned.
#[derive(Clone, Debug)]
pub struct PlacedFrame<T> {
    /// The frame that it is placed in; the fixed axes if there is none.
    pub parent: Option<FrameId>,
    /// Its origin along that frame's axes, in m.
    pub origin: [T; 3],
    /// From that frame's axes to its own, each about an axis that those before it have turned.
    pub turns: Vec<AxisTurn<T>>,
}

/// A turn about an axis by the right hand.
#[derive(Clone, Debug)]
pub struct AxisTurn<T> {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// The angle, in rad.
    pub angle: T,
    /// Its cosine: a number for quarter turns.
    pub cosine: T,
    /// Its sine: a number for quarter turns.
    pub sine: T,
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct RigidBody<T> {
    /// The name of its terms in the energies.
    pub name: String,
    /// The frame that it is fixed to.
    pub frame: FrameId,
    /// Its mass, in kg; 0 if it has inertia only.
    pub mass: T,
    /// Its centre of mass along the frame's axes, in m.
    pub centre: [T; 3],
    /// I_xx, I_yy, I_zz about the centre of mass along the frame's axes, in kg m^2; 0 of a point
    /// mass.
    pub moments: [T; 3],
    /// I_xy, I_yz, I_xz of the same matrix.
    pub products: [T; 3],
}

impl<T> RigidTree<T> {
    /// The tree of what becomes of each expression; the first failure ends it.
    ///
    /// # Errors
    /// Those of `change`.
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
            gravity: each(&self.gravity, change)?,
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
            origin: each(&self.origin, change)?,
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
            centre: each(&self.centre, change)?,
            moments: each(&self.moments, change)?,
            products: each(&self.products, change)?,
        })
    }
}

/// What becomes of three expressions.
fn each<T, U, E>(parts: &[T; 3], change: &mut impl FnMut(&T) -> Result<U, E>) -> Result<[U; 3], E> {
    let [x, y, z] = parts.each_ref().map(change);
    Ok([x?, y?, z?])
}
