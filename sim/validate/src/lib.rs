//! Validation of derived equations of motion.
//!
//! [`oracle`] forms the equations a second time, from the checked model by automatic
//! differentiation; [`sampler`] draws states in every regime with [`random`] numbers; a
//! [`variant::Variant`] with [`outputs::Outputs`] is what is judged; [`checks`] compare, with a [`compiler`] for
//! emitted source; [`certify`](certify::certify) runs them and writes the
//! [`certificate`]. Nothing here knows how the equations under test were derived or
//! evaluated.

pub mod certificate;
pub mod certify;
pub mod checks;
pub mod compiler;
pub mod derived;
pub mod derived_outputs;
mod differences;
pub mod of_model;
pub mod oracle;
pub mod outputs;
pub mod random;
pub mod sampler;
mod sizes;
pub mod variant;

#[cfg(test)]
mod test_models;
#[cfg(test)]
mod test_outputs;
#[cfg(test)]
mod test_variants;
#[cfg(test)]
mod tests;
