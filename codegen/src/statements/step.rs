//! Documentation of the step of the classical Runge-Kutta method, shared by the languages.

/// Documentation of the emitted function.
pub const STEP_DOC: &str = "Step of length h (s) of the classical Runge-Kutta method of order 4, with held inputs. It has\n\
                            the bits of `eomgen simulate --solver fixed`. Switches and impacts are not located.";
