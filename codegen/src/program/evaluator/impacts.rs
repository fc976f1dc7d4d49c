//! Quantities of the impacts of a program at a point.

use super::{Evaluator, Point, Stage};

/// Quantities of an impact at a point, in SI units; see [`Impact`](crate::mechanics::impact::Impact).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactValues {
    /// Distance.
    pub distance: f64,
    /// Rate of the distance.
    pub rate: f64,
    /// Rate of the distance at which a contact force does no work.
    pub workless_rate: f64,
    /// Second rate of the distance without contact forces.
    pub acceleration: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Gradient of the distance, one number for each degree of freedom.
    pub row: Vec<f64>,
    /// Change of the rates per unit impulse, one number for each degree of freedom.
    pub column: Vec<f64>,
    /// Changes of the rate of the distance per unit normal impulse at each impact, then per unit tangential impulse
    /// at each impact with friction.
    pub delassus: Vec<f64>,
    /// Friction, if the contact has any.
    pub friction: Option<FrictionValues>,
}

/// Friction of a contact at a point, in SI units; see [`Friction`](crate::mechanics::impact::Friction).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrictionValues {
    /// Coefficient of friction.
    pub coefficient: f64,
    /// Tangential velocity.
    pub slip: f64,
    /// Slip at which the friction force does no work.
    pub workless_slip: f64,
    /// Rate of the slip without contact forces.
    pub acceleration: f64,
    /// Change of the rates per unit tangential impulse.
    pub column: Vec<f64>,
    /// Changes of the slip per unit impulse at each impact: normal impulses, then tangential impulses.
    pub delassus: Vec<f64>,
}

impl Evaluator {
    /// Writes the distances of the impacts to `out`.
    pub fn distances(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Distances, &point);
        for (slot, impact) in out.iter_mut().zip(&self.program.impacts) {
            *slot = self.memory[self.places.offset(impact.distance)];
        }
    }

    /// Computes all impacts in the order of the specification. A call with an `out` of a previous call
    /// allocates no memory.
    pub fn impacts(&mut self, point: Point<'_>, out: &mut Vec<ImpactValues>) {
        self.compute(Stage::Impacts, &point);
        let degrees = self.program.degrees_of_freedom();
        out.resize_with(self.program.impacts.len(), ImpactValues::default);
        for (slot, impact) in out.iter_mut().zip(&self.program.impacts) {
            let number = |id| self.memory[self.places.offset(id)];
            slot.distance = number(impact.distance);
            slot.rate = number(impact.rate);
            slot.workless_rate = number(impact.workless_rate);
            slot.acceleration = number(impact.acceleration);
            slot.restitution = number(impact.restitution);
            slot.delassus.resize(impact.delassus.len(), 0.0);
            for (entry, id) in slot.delassus.iter_mut().zip(&impact.delassus) {
                *entry = number(*id);
            }
            slot.row.resize(degrees, 0.0);
            self.copy_rows(&impact.row.scalars, &impact.row.modal, &mut slot.row);
            slot.column.resize(degrees, 0.0);
            self.copy_rows(
                &impact.column.scalars,
                &impact.column.modal,
                &mut slot.column,
            );
            let Some(friction) = &impact.friction else {
                slot.friction = None;
                continue;
            };
            let slot = slot.friction.get_or_insert_default();
            slot.coefficient = number(friction.coefficient);
            slot.slip = number(friction.slip);
            slot.workless_slip = number(friction.workless_slip);
            slot.acceleration = number(friction.acceleration);
            slot.delassus.resize(friction.delassus.len(), 0.0);
            for (entry, id) in slot.delassus.iter_mut().zip(&friction.delassus) {
                *entry = number(*id);
            }
            slot.column.resize(degrees, 0.0);
            self.copy_rows(
                &friction.column.scalars,
                &friction.column.modal,
                &mut slot.column,
            );
        }
    }
}
