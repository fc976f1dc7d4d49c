//! Compares a model with measurements, finds what it lacks, names it and adds it.
//!
//! The pipeline, one file each: [`dataset`] (records with their description) and [`gate`]
//! (whether they can be believed); [`plant`] (a model that can be run), [`runner`] and
//! [`march`] (how it runs; `beside`: what is not linear; `runge_kutta`: a step), [`windows`]
//! (records in parts), [`smooth`] and [`starts`] (each part's initial state), [`unknowns`],
//! [`shooting`] (residuals) and [`crew`] (derivatives), [`mod@estimate`] (with [`eliminated`]:
//! initial states taken out; [`bounded`]: least squares; [`mod@approach`]: from far away),
//! [`setting`] (what all fits share), [`sketch`], [`fitting`] and [`rest`] (a specification fitted,
//! and what that leaves), [`mod@floor`] (what a right model would leave), [`labels`] (whether columns
//! are what they are called), [`locate`] (where the rest is) by the [`residual_force`];
//! [`catalogue`], [`sites`] and [`candidates`] (what may be missing; `placed`: a change at a place;
//! [`own`]: a user's effects there),
//! [`response`] with [`mod@driven`] and [`mod@tried`] (what each candidate does), [`mod@screen`]
//! (what it promises), [`mod@judge`] by [`rule`] (what is believed), [`trials`] (fits in earnest;
//! `sets`: how they begin; `shapes`: from elsewhere; `pairs`: two at once; `swaps`: others in the place of an answer;
//! `together`: two that are believed only with each other), [`thinned`] (what is needed no more),
//! [`mod@named`] (which of them is the answer, and which are one), [`undeclared`] (parameters that
//! nobody doubts), [`mod@search`] (all of it in turn; `views`: one round);
//! [`mod@empirical`] (what is left and has no name); [`extend`] (the specification changed),
//! [`mod@rerun`] (run again), [`document`] and [`report`] (for programs and for people).

pub mod approach;
mod beside;
pub mod bounded;
pub mod candidates;
pub mod catalogue;
pub mod crew;
pub mod dataset;
pub mod document;
pub mod driven;
pub mod eliminated;
pub mod empirical;
pub mod estimate;
pub mod extend;
pub mod fitting;
pub mod floor;
pub mod gate;
pub mod judge;
pub mod labels;
pub mod locate;
pub mod march;
pub mod named;
pub mod own;
mod pairs;
mod placed;
pub mod plant;
pub mod report;
pub mod rerun;
pub mod residual_force;
pub mod response;
pub mod rest;
pub mod rule;
mod runge_kutta;
pub mod runner;
pub mod screen;
pub mod search;
mod sets;
pub mod setting;
mod shapes;
pub mod shooting;
pub mod sites;
pub mod sketch;
pub mod smooth;
pub mod starts;
mod swaps;
pub mod thinned;
mod together;
pub mod trials;
pub mod tried;
pub mod undeclared;
pub mod unknowns;
mod views;
pub mod windows;
