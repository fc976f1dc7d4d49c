//! Accuracy compared with 128-bit arithmetic, special values, and native values compared with kernels.

mod exponential;
mod hard_cases;
mod kernels;
mod oracle;
mod piecewise_cases;
mod powers_and_roots;
mod single_precision;
mod special_values;
mod trigonometric;
