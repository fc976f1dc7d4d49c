//! Quantities of an impact, which `impacts` derives.

/// Impact, with nodes or values `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Impact<N, R> {
    /// Distance g.
    pub distance: N,
    /// Rate g'.
    pub rate: N,
    /// Rate w of the distance at which the contact force does no work: a contact force F changes T + V with the power
    /// F (g' - w).
    pub workless_rate: N,
    /// Second rate g'' without contact forces.
    pub acceleration: N,
    /// Coefficient of restitution.
    pub restitution: N,
    /// Gradient A of the distance with respect to the coordinates.
    pub row: R,
    /// Column D: change of the rates per unit impulse.
    pub column: R,
    /// Row of the Delassus matrix A D: changes of g' per unit normal impulse at each impact, then per unit tangential
    /// impulse at each impact with friction.
    pub delassus: Vec<N>,
    /// Friction, if the contact has any.
    pub friction: Option<Friction<N, R>>,
}

/// Friction of a contact, with nodes or values `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Friction<N, R> {
    /// Coefficient of friction.
    pub coefficient: N,
    /// Tangential velocity of the contact.
    pub slip: N,
    /// Slip at which the friction force does not change T + V.
    pub workless_slip: N,
    /// Rate of the slip without contact forces.
    pub acceleration: N,
    /// Change of the rates per unit tangential impulse.
    pub column: R,
    /// Changes of the slip per unit impulse at each impact: normal impulses, then tangential impulses.
    pub delassus: Vec<N>,
}
