//! Double-precision numbers with a bound of the rounding error. As scalars of dual numbers, they also bound the errors
//! of derivatives with cancelling terms.

use crate::rounded::Rounded;

pub type Tracked = Rounded<53>;

/// Implements the scalar of an emitted module. Elementary functions are accurate to two units in
/// the last place.
macro_rules! tracked_scalar_of {
    ($($module:ident),*) => {$(
        impl $module::Scalar for $crate::tracked::Tracked {
            fn number(value: f64) -> Self {
                Self::exact(value)
            }
            fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                if a.number > b.number { then } else { otherwise }
            }
            fn all_greater(a: Self, b: Self) -> bool {
                a.number > b.number
            }
            fn function<F: $module::Function>(self) -> Self {
                let value = F::value(self.number);
                let slope = F::slope(self.number, value);
                Self::with_rounding(value, slope.abs() * self.error + f64::EPSILON * value.abs())
            }
            fn function_of_two<F: $module::FunctionOfTwo>(self, other: Self) -> Self {
                let value = F::value(self.number, other.number);
                let [first, second] = F::slopes(self.number, other.number, value);
                let error = first.abs() * self.error + second.abs() * other.error;
                Self::with_rounding(value, error + f64::EPSILON * value.abs())
            }
        }
    )*};
}
pub(crate) use tracked_scalar_of;
