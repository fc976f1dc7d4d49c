//! Dimension of a quantity: rational exponents of the seven SI base units. Angles are dimensionless (rad = 1). The
//! module `unit` contains names and scales of units.

use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul, CheckedSub, Zero};

/// Exponent of a base unit.
pub type Exponent = Ratio<i32>;

/// Base units, in the order of the exponents.
const BASE: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// Symbols of common dimensions, by exponents of (kg, m, s, A). A torque and an energy have the same dimension, which
/// is printed as N m.
const COMMON: [(&str, [i32; 4]); 24] = [
    ("N", [1, 1, -2, 0]),
    ("N m", [1, 2, -2, 0]),
    ("W", [1, 2, -3, 0]),
    ("Pa", [1, -1, -2, 0]),
    ("N/m", [1, 0, -2, 0]),
    ("N/m^3", [1, -2, -2, 0]),
    ("N s/m", [1, 0, -1, 0]),
    ("N s", [1, 1, -1, 0]),
    ("N s^2/m^2", [1, -1, 0, 0]),
    ("N m s", [1, 2, -1, 0]),
    ("N m^2", [1, 3, -2, 0]),
    ("N m/s^2", [1, 2, -4, 0]),
    ("N/s", [1, 1, -3, 0]),
    ("C", [0, 0, 1, 1]),
    ("V", [1, 2, -3, -1]),
    ("V s", [1, 2, -2, -1]),
    ("N/A", [1, 1, -2, -1]),
    ("N m/A^2", [1, 2, -2, -2]),
    ("T", [1, 0, -2, -1]),
    ("ohm", [1, 2, -3, -2]),
    ("F", [-1, -2, 4, 2]),
    ("V/m", [1, 1, -3, -1]),
    ("W/m", [1, 1, -3, 0]),
    ("kg/m", [1, -1, 0, 0]),
];

/// Exponents of kg, m, s, A, K, mol and cd.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dimension {
    exponents: [Exponent; 7],
}

impl Dimension {
    /// Dimensionless.
    pub const DIMENSIONLESS: Self = Self::from_mechanical_exponents([0, 0, 0, 0]);
    /// m
    pub const LENGTH: Self = Self::from_mechanical_exponents([0, 1, 0, 0]);
    /// kg
    pub const MASS: Self = Self::from_mechanical_exponents([1, 0, 0, 0]);
    /// s
    pub const TIME: Self = Self::from_mechanical_exponents([0, 0, 1, 0]);
    /// J = N m
    pub const ENERGY: Self = Self::from_mechanical_exponents([1, 2, -2, 0]);
    /// W
    pub const POWER: Self = Self::from_mechanical_exponents([1, 2, -3, 0]);

    /// Returns the dimension with these exponents of kg, m, s and A.
    pub const fn from_mechanical_exponents([kg, m, s, a]: [i32; 4]) -> Self {
        Self::from_exponents([kg, m, s, a, 0, 0, 0])
    }

    /// Returns the dimension with these exponents of kg, m, s, A, K, mol and cd.
    pub const fn from_exponents(whole: [i32; 7]) -> Self {
        let mut exponents = [Ratio::new_raw(0, 1); 7];
        let mut index = 0;
        while index < 7 {
            exponents[index] = Ratio::new_raw(whole[index], 1);
            index += 1;
        }
        Self { exponents }
    }

    /// Returns the exponents of kg, m, s, A, K, mol and cd.
    pub fn exponents(self) -> [Exponent; 7] {
        self.exponents
    }

    /// Returns true if the quantity is dimensionless.
    pub fn is_dimensionless(self) -> bool {
        self == Self::DIMENSIONLESS
    }

    /// Returns the dimension of a product; `None` if an exponent overflows i32.
    pub fn multiply(self, other: Self) -> Option<Self> {
        self.combine(other, |a, b| a.checked_add(&b))
    }

    /// Returns the dimension of a quotient; `None` if an exponent overflows i32.
    pub fn divide(self, other: Self) -> Option<Self> {
        self.combine(other, |a, b| a.checked_sub(&b))
    }

    /// Returns the dimension of a power; `None` if an exponent overflows i32.
    pub fn raise(self, exponent: Exponent) -> Option<Self> {
        let mut exponents = self.exponents;
        for own in &mut exponents {
            *own = own.checked_mul(&exponent)?;
        }
        Some(Self { exponents })
    }

    fn combine(
        self,
        other: Self,
        combine: impl Fn(Exponent, Exponent) -> Option<Exponent>,
    ) -> Option<Self> {
        let mut exponents = self.exponents;
        for (own, others) in exponents.iter_mut().zip(other.exponents) {
            *own = combine(*own, others)?;
        }
        Some(Self { exponents })
    }

    /// Writes base units, with negative exponents after one `/`.
    fn in_base_units(self) -> String {
        let factor = |(unit, exponent): (&str, Exponent)| {
            if exponent == Ratio::new_raw(1, 1) {
                unit.to_owned()
            } else if exponent.is_integer() {
                format!("{unit}^{exponent}")
            } else {
                format!("{unit}^({exponent})")
            }
        };
        let written = BASE.into_iter().zip(self.exponents);
        let (above, below): (Vec<_>, Vec<_>) = written
            .filter(|(_, exponent)| !exponent.is_zero())
            .partition(|(_, exponent)| *exponent > Ratio::zero());
        let above: Vec<String> = above.into_iter().map(factor).collect();
        let below: Vec<String> = below
            .into_iter()
            .map(|(unit, exponent)| factor((unit, -exponent)))
            .collect();
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join(" ")
        };
        match below.as_slice() {
            [] => above,
            [only] => format!("{above}/{only}"),
            several => format!("{above}/({})", several.join(" ")),
        }
    }
}

impl std::fmt::Display for Dimension {
    /// Writes a unit that [`crate::unit::Unit::parse`] can read.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let common = COMMON
            .iter()
            .find(|(_, exponents)| *self == Self::from_mechanical_exponents(*exponents));
        match common {
            Some((name, _)) => f.write_str(name),
            None => f.write_str(&self.in_base_units()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_dimensions_are_printed_with_their_symbols() {
        let shown = |exponents| Dimension::from_mechanical_exponents(exponents).to_string();
        assert_eq!(shown([0, 0, 0, 0]), "1");
        assert_eq!(shown([1, 2, -2, 0]), "N m");
        assert_eq!(shown([1, 0, -1, 0]), "N s/m");
        assert_eq!(shown([0, 1, -1, 0]), "m/s");
        assert_eq!(shown([1, 2, 0, 0]), "kg m^2");
        assert_eq!(shown([1, -3, 0, 0]), "kg/m^3");
        assert_eq!(shown([0, 0, -1, 0]), "1/s");
        assert_eq!(shown([-1, 0, -1, 1]), "A/(kg s)");
    }

    #[test]
    fn fractional_exponents_are_exact() {
        let root = Dimension::LENGTH.raise(Ratio::new(1, 2)).unwrap();
        assert_eq!(root.to_string(), "m^(1/2)");
        assert_eq!(root.multiply(root), Some(Dimension::LENGTH));
        assert_eq!(root.divide(root), Some(Dimension::DIMENSIONLESS));
    }

    #[test]
    fn exponents_out_of_range_are_rejected() {
        let huge = Dimension::LENGTH
            .raise(Ratio::from_integer(i32::MAX))
            .unwrap();
        assert_eq!(huge.multiply(Dimension::LENGTH), None);
        assert_eq!(huge.raise(Ratio::from_integer(2)), None);
    }
}
