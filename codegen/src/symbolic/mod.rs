//! Expressions as nodes of one hash-consed graph, with all operations that do not depend on mechanics.
//!
//! - Nodes: `graph` and `node_map` store them, `operation`, `variable` and `arguments` define them, `simplify` applies
//!   algebraic laws in their constructors, `tables` and `table_text` hold constants of a basis.
//! - Derivatives: `differentiate`, `gradient`, `modal_derivative` and `matrix` keep the structure; `limits`,
//!   `cofactors`, `vanishing_products` and `orders` treat zeros of roots; `switches`, `branches` and `flat` treat
//!   operations that switch.
//! - Transformations: `substitute`, `expand`, `factor`, `trigonometry` and `association` (multiplication
//!   order), with `degree` and `operation_count` to compare forms.
//! - `formula` prints nodes.

pub(crate) mod arguments;
#[cfg(feature = "derive")]
pub(crate) mod association;
#[cfg(feature = "derive")]
pub(crate) mod branches;
#[cfg(feature = "derive")]
mod cofactors;
#[cfg(feature = "derive")]
pub(crate) mod degree;
#[cfg(feature = "derive")]
pub mod differentiate;
#[cfg(feature = "derive")]
pub(crate) mod expand;
#[cfg(feature = "derive")]
pub(crate) mod factor;
#[cfg(feature = "derive")]
pub(crate) mod flat;
#[cfg(feature = "derive")]
pub mod formula;
#[cfg(feature = "derive")]
pub(crate) mod gradient;
#[cfg(feature = "derive")]
pub mod graph;
#[cfg(feature = "derive")]
pub(crate) mod limits;
#[cfg(feature = "derive")]
pub mod matrix;
#[cfg(feature = "derive")]
pub mod modal_derivative;
#[cfg(feature = "derive")]
pub(crate) mod node_map;
#[cfg(feature = "derive")]
pub(crate) mod operation;
#[cfg(feature = "derive")]
pub(crate) mod operation_count;
#[cfg(feature = "derive")]
pub(crate) mod orders;
#[cfg(feature = "derive")]
mod simplify;
#[cfg(feature = "derive")]
pub(crate) mod substitute;
#[cfg(feature = "derive")]
pub(crate) mod switches;
#[cfg(feature = "derive")]
pub(crate) mod table_text;
#[cfg(feature = "derive")]
pub mod tables;
#[cfg(feature = "derive")]
pub(crate) mod trigonometry;
#[cfg(feature = "derive")]
mod vanishing_products;
pub(crate) mod variable;
