//! What the exact solver must survive: degenerate parameters, resonance, dry friction,
//! surfaces that are grazed or started on, requests that make no sense. Every motion is
//! compared with something that shares nothing with it but the equations: a closed form, a
//! conserved quantity, or the general solver over a short time.

mod arm;
mod flow;
mod friction;
mod held_inputs;
mod oscillators;
mod pieces;
mod requests;
mod surfaces;
