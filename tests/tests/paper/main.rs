//! Tests of the paper's equations, figures and claims.

mod claims_page;
mod errata;
mod studies;
mod study;
mod study_search;
