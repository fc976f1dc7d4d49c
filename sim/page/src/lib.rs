//! Self-contained HTML pages: one file with its style sheet, in a light and a dark scheme, without
//! external references. Only pages that compute contain a script. The markup is written with
//! [`maud`], which escapes all text.
//!
//! ```
//! use eomgen_page::{document, section};
//! use maud::html;
//!
//! let page = document("a < b", &section("Result", &html! { p { "Tom & Jerry" } }));
//! assert!(page.contains("<title>a &lt; b</title>"));
//! assert!(page.contains("<p>Tom &amp; Jerry</p>"));
//! ```
//!
//! Modules: `document` (head, style sheet, body), `parts` (sections, tables, figures, collapsible
//! files), `prose`, `number`, `aligned` (columns of numbers), [`mod@formula`] (formulas as MathML), `equations` (formulas of a report),
//! [`mod@play`] (scripts of pages that compute).

mod aligned;
mod document;
mod equations;
pub mod formula;
mod number;
mod parts;
pub mod play;
mod prose;

pub use aligned::aligned;
pub use document::{ScriptedDocument, document, scripted_document};
pub use equations::equations;
pub use formula::{formula, name_letters, quantity_symbol};
pub use number::number;
pub use parts::{Figure, collapsible_file, figure, section, stacked_table, table};
pub use prose::prose;
