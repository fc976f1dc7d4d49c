//! Quantities of a program.

/// Named quantity with its unit.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// ASCII name.
    pub name: String,
    /// SI unit, as text.
    pub unit: String,
    /// Description.
    pub doc: String,
}
