//! Tests of specifications: grammar, units, ranges, every feature of the language.

mod broken_specs;
mod clipped_models;
mod correct_models;
mod features;
mod latex;
mod macro_errors;
mod ranges;
mod reference_pages;
mod schema;
