//! Pages that stand for themselves: one file of HTML, with its style sheet inside, light or dark
//! as its reader likes, without a reference to anything outside, and without script but where a
//! program computes in it. What a page
//! says is the caller's; its markup is written with [`maud`], which takes every text for nothing
//! but text.
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
//! The files: `document` (head, style sheet, body), `parts` (sections, tables, figures, files
//! behind a summary), `number`, [`mod@formula`] (formulas as MathML, from their trees), `equations`
//! (a report's formulas with what they are), [`mod@play`] (what pages that compute have in common).

mod document;
mod equations;
pub mod formula;
mod number;
mod parts;
pub mod play;

pub use document::{ScriptedDocument, document, scripted_document};
pub use equations::equations;
pub use formula::formula;
pub use number::number;
pub use parts::{Figure, figure, folded, section, table};
