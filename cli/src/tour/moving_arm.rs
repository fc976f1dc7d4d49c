//! The paper's arm with a drawing, for the animation at the top of the tour's page.

use eomgen_compiled_model::CompiledModel;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;

use crate::error::{Error, Result};
use crate::model::derive;

/// Name of the written file.
pub const PATH: &str = "moving_arm.toml";

/// Parameters that have sliders.
pub const MOVED: [&str; 6] = ["enlarged", "b_sp", "b_pr", "a_m", "F_w", "omega"];

/// Entries that the drawing needs: name of a section, and entries to insert at its beginning.
const ENTRIES: [(&str, &str); 2] = [
    ("[parameters]\n", PARAMETERS),
    ("[observables]\n", OBSERVABLES),
];

const PARAMETERS: &str = r#"enlarged = { value = 30, unit = "1", doc = "factor of the deflections in the drawing", min = 1, max = 100 }
"#;

/// Points of the arm with enlarged deflections, and a tooth of the sun and of a planet.
const OBSERVABLES: &str = r#"x_1 = { value = "l/3*cos(theta_c) - enlarged*at(w, l/3)*sin(theta_c)", unit = "m" }
y_1 = { value = "l/3*sin(theta_c) + enlarged*at(w, l/3)*cos(theta_c)", unit = "m" }
x_2 = { value = "2/3*l*cos(theta_c) - enlarged*at(w, 2/3*l)*sin(theta_c)", unit = "m" }
y_2 = { value = "2/3*l*sin(theta_c) + enlarged*at(w, 2/3*l)*cos(theta_c)", unit = "m" }
x_3 = { value = "l*cos(theta_c) - enlarged*at(w, l)*sin(theta_c)", unit = "m" }
y_3 = { value = "l*sin(theta_c) + enlarged*at(w, l)*cos(theta_c)", unit = "m" }
x_sun = { value = "r_s*cos(theta_s)", unit = "m" }
y_sun = { value = "r_s*sin(theta_s)", unit = "m" }
x_planet = { value = "r_c*cos(theta_c)", unit = "m" }
y_planet = { value = "r_c*sin(theta_c)", unit = "m" }
x_tooth = { value = "r_c*cos(theta_c) + r_p*cos(theta_p)", unit = "m" }
y_tooth = { value = "r_c*sin(theta_c) - r_p*sin(theta_p)", unit = "m" }
"#;

const DRAWING: &str = r#"
[drawing.points]
arm_1 = { x = "x_1", y = "y_1" }
arm_2 = { x = "x_2", y = "y_2" }
tip = { x = "x_3", y = "y_3" }
sun = { x = "x_sun", y = "y_sun" }
planet = { x = "x_planet", y = "y_planet" }
tooth = { x = "x_tooth", y = "y_tooth" }

[drawing.lines]
arm = ["origin", "arm_1", "arm_2", "tip"]
sun = ["origin", "sun"]
planet = ["planet", "tooth"]
"#;

/// Replaced declarations of the backlashes with other units, for readable numbers on sliders.
const UNITS: [(&str, &str); 2] = [
    (
        "b_sp = { value = 25e-6, unit = \"m\",",
        "b_sp = { value = 25, unit = \"um\",",
    ),
    (
        "b_pr = { value = 25e-6, unit = \"m\",",
        "b_pr = { value = 25, unit = \"um\",",
    ),
];

/// Returns the text of the specification.
pub fn specification() -> String {
    let arm = models::PLANETARY_ARM.text.to_owned();
    let arm = UNITS.iter().fold(arm, |text, (declared, shown)| {
        text.replacen(declared, shown, 1)
    });
    let with_entries = ENTRIES.iter().fold(arm, |text, (section, entries)| {
        text.replacen(section, &format!("{section}{entries}"), 1)
    });
    with_entries + DRAWING
}

/// Derives the arm with its drawing at a truncation order.
pub fn derive_arm(text: &str, order: usize) -> Result<CompiledModel> {
    let checked =
        eomgen_model_spec::check(Source::new(PATH, text)).map_err(Error::Specification)?;
    derive(checked.model, &[order])
}
