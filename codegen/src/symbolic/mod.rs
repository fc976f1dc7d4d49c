//! Expressions as nodes of one hash-consed graph, and what is done with them without knowing any
//! mechanics.
//!
//! `operation` (of `arguments`) and `graph` (the nodes, known by `node_map`), `simplify` (the algebraic laws, applied
//! by the constructors), `tables` and `table_text` (constants of a basis), `matrix`, `differentiate` and
//! `modal_derivative` (derivatives that keep their structure), `limits` and `orders` (derivatives at zeros
//! of roots), `switches` and `branches` (operations that switch), `flat` (derivatives on their flat sides), `substitute`, `expand`, `degree` and `operation_count` (walks over nodes), `association`
//! (which factors are multiplied first), `factor` and `trigonometry` (other forms of sums, for whoever
//! compares what they cost), `formula` (for people).

pub(crate) mod arguments;
pub(crate) mod association;
pub(crate) mod branches;
pub(crate) mod degree;
pub mod differentiate;
pub(crate) mod expand;
pub(crate) mod factor;
pub(crate) mod flat;
pub mod formula;
pub mod graph;
pub(crate) mod limits;
pub mod matrix;
pub mod modal_derivative;
pub(crate) mod node_map;
pub(crate) mod operation;
pub(crate) mod operation_count;
pub(crate) mod orders;
mod simplify;
pub(crate) mod substitute;
pub(crate) mod switches;
pub(crate) mod table_text;
pub mod tables;
pub(crate) mod trigonometry;
