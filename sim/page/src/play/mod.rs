//! What pages that compute have in common: the module and its integration (`motion.js`), what is
//! drawn on (`canvas.js`), and sliders. What is moved, drawn and compared is each page's own.

mod slider;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

pub use slider::{Slider, printed};

/// What comes first in every script: the classes `Machine`, an emitted module with its arrays, and
/// `Motion`, which integrates it, and `bytes`, the inverse of [`encoded`]; then what pictures and
/// sliders need.
const COMMON: [&str; 3] = [
    include_str!("motion.js"),
    include_str!("canvas.js"),
    include_str!("slider.js"),
];

/// What such a page needs besides the style of all pages.
pub const STYLE: &str = include_str!("play.css");

/// Bytes as a script is told of them, in base 64.
pub fn encoded(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// A script of these parts, after what all have in common. In a block of its own, so that no name
/// of it is one of the window's.
pub fn script(parts: &[&str]) -> String {
    [
        "\"use strict\";\n{\n",
        &COMMON.concat(),
        &parts.concat(),
        "}\n",
    ]
    .concat()
}
