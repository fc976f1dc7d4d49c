//! Expressions as nodes of one hash-consed graph, with all operations on them that need no mechanics.
//!
//! - Nodes: `graph` and `node_map` store them, `operation` and `arguments` define them, `simplify` applies
//!   algebraic laws in their constructors, `tables` and `table_text` hold constants of a basis.
//! - Derivatives: `differentiate`, `gradient`, `modal_derivative` and `matrix` keep the structure; `limits`, `cofactors`,
//!   `vanishing_products` and `orders` handle zeros of roots, `switches`, `branches` and `flat` operations that switch.
//! - Transformations: `substitute`, `expand`, `factor`, `trigonometry` and `association` (multiplication
//!   order), with `degree` and `operation_count` to compare forms.
//! - `formula` prints nodes.

pub(crate) mod arguments;
pub(crate) mod association;
pub(crate) mod branches;
mod cofactors;
pub(crate) mod degree;
pub mod differentiate;
pub(crate) mod expand;
pub(crate) mod factor;
pub(crate) mod flat;
pub mod formula;
pub(crate) mod gradient;
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
mod vanishing_products;
