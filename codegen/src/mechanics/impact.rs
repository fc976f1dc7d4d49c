//! Quantities of an impact; `impacts` derives them.

/// Impact, with nodes or values `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Impact<N, R> {
    /// Distance g.
    pub distance: N,
    /// Rate g'.
    pub rate: N,
    /// Rate w at which a contact does no work: a force F there has the power F (g' - w) on T + V.
    pub workless_rate: N,
    /// Second rate g'' if no contact is closed.
    pub acceleration: N,
    /// Coefficient of restitution.
    pub restitution: N,
    /// Gradient A of the distance by the coordinates.
    pub row: R,
    /// Column D: change of the rates by a unit impulse.
    pub column: R,
    /// A D of all impacts: changes of g' by a unit impulse at each of them, then by a unit tangential impulse
    /// at each with friction.
    pub delassus: Vec<N>,
    /// Friction, if the contact has any.
    pub friction: Option<Friction<N, R>>,
}

/// Friction of a contact, with nodes or values `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Friction<N, R> {
    /// Coefficient.
    pub coefficient: N,
    /// Tangential velocity of the contact.
    pub slip: N,
    /// Slip at which friction does no work on T + V.
    pub workless_slip: N,
    /// Rate of the slip if no contact is closed.
    pub acceleration: N,
    /// Change of the rates by a unit tangential impulse.
    pub column: R,
    /// Changes of the slip by a unit impulse at each impact, normal, then tangential.
    pub delassus: Vec<N>,
}
