//! Tests of difficult cases for the exact solver: degenerate parameters, resonance, dry friction, grazing, initial
//! states on switching surfaces, invalid requests. Each motion is compared with an independent result: a closed form, a
//! conserved quantity, or the general solver over a short time.

mod arm;
mod flow;
mod friction;
mod held_inputs;
mod oscillators;
mod pieces;
mod requests;
mod surfaces;
