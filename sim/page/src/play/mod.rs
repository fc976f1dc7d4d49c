//! Common parts of pages with a simulation: motion by the engine (`engine.js`), drawing (`canvas.js`), sliders.
//! [`embed_motion`] embeds the engine and a model.

mod embedding;
mod slider;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

pub use embedding::{TOLERANCE, Unplayable, embed_motion};
pub use slider::{Slider, format_unit};

/// Scripts at the start of every script: the class `Motion` (a motion of an embedded model), `bytes` (the
/// inverse of [`encode_base64`]), and functions for pictures and sliders.
const COMMON_SCRIPTS: [&str; 3] = [
    include_str!("engine.js"),
    include_str!("canvas.js"),
    include_str!("slider.js"),
];

/// Additional style of pages with a simulation.
pub const STYLE: &str = include_str!("play.css");

/// Encodes bytes in base 64 for a script.
pub fn encode_base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Returns a script of the common scripts and these parts, in a block without global names.
pub fn join_scripts(parts: &[&str]) -> String {
    [
        "\"use strict\";\n{\n",
        &COMMON_SCRIPTS.concat(),
        &parts.concat(),
        "}\n",
    ]
    .concat()
}
