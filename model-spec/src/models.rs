//! Text of the specifications shipped with the crate.

use crate::source::Source;

/// Specification shipped with the crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedModel {
    /// Name of the model; the file is `NAME.toml`.
    pub name: &'static str,
    /// Text of the file.
    pub text: &'static str,
}

impl ShippedModel {
    /// Returns the text as a source with its file's name.
    pub fn source(&self) -> Source {
        Source::new(format!("{}.toml", self.name), self.text)
    }
}

/// Cart with two pendulum arms.
pub const CART_TWO_ARMS: ShippedModel = ShippedModel {
    name: "cart_two_arms",
    text: include_str!("../models/cart_two_arms.toml"),
};

/// Double pendulum.
pub const DOUBLE_PENDULUM: ShippedModel = ShippedModel {
    name: "double_pendulum",
    text: include_str!("../models/double_pendulum.toml"),
};

/// Ball-screw positioning axis.
pub const EMPS: ShippedModel = ShippedModel {
    name: "emps",
    text: include_str!("../models/emps.toml"),
};

/// Rotary inverted pendulum.
pub const FURUTA_PENDULUM: ShippedModel = ShippedModel {
    name: "furuta_pendulum",
    text: include_str!("../models/furuta_pendulum.toml"),
};

/// Hub-driven beam with a tip mass.
pub const HUB_BEAM_TIP_MASS: ShippedModel = ShippedModel {
    name: "hub_beam_tip_mass",
    text: include_str!("../models/hub_beam_tip_mass.toml"),
};

/// Measured pendulum arm.
pub const PENDULUM: ShippedModel = ShippedModel {
    name: "pendulum",
    text: include_str!("../models/pendulum.toml"),
};

/// Flexible arm on a planetary reducer with backlash, with a motor law.
pub const PLANETARY_ARM: ShippedModel = ShippedModel {
    name: "planetary_arm",
    text: include_str!("../models/planetary_arm.toml"),
};

/// Flexible arm of [`PLANETARY_ARM`], with the motor torque as an input.
pub const PLANETARY_ARM_RIG: ShippedModel = ShippedModel {
    name: "planetary_arm_rig",
    text: include_str!("../models/planetary_arm_rig.toml"),
};

/// Load on the rope of a trolley; trolley and rope follow prescribed motions.
pub const CRANE: ShippedModel = ShippedModel {
    name: "crane",
    text: include_str!("../models/crane.toml"),
};

/// Moving-coil loudspeaker, with currents as first-order states.
pub const LOUDSPEAKER: ShippedModel = ShippedModel {
    name: "loudspeaker",
    text: include_str!("../models/loudspeaker.toml"),
};

/// Disc on an elastic shaft.
pub const SHAFT_AND_DISC: ShippedModel = ShippedModel {
    name: "shaft_and_disc",
    text: include_str!("../models/shaft_and_disc.toml"),
};

/// PUMA 560, a six-joint arm of rigid bodies.
pub const PUMA_560: ShippedModel = ShippedModel {
    name: "puma_560",
    text: include_str!("../models/puma_560.toml"),
};

/// Two flexible links in a plane with a tip mass.
pub const TWO_LINK_ARM: ShippedModel = ShippedModel {
    name: "two_link_arm",
    text: include_str!("../models/two_link_arm.toml"),
};

/// Chaplygin's sleigh, with a nonholonomic constraint.
pub const CHAPLYGIN_SLEIGH: ShippedModel = ShippedModel {
    name: "chaplygin_sleigh",
    text: include_str!("../models/chaplygin_sleigh.toml"),
};

/// Quadrotor with a load on a rope, in vectors.
pub const QUADROTOR_SLUNG_LOAD: ShippedModel = ShippedModel {
    name: "quadrotor_slung_load",
    text: include_str!("../models/quadrotor_slung_load.toml"),
};

/// All shipped specifications, by name.
pub const ALL: [ShippedModel; 15] = [
    CART_TWO_ARMS,
    CHAPLYGIN_SLEIGH,
    CRANE,
    DOUBLE_PENDULUM,
    EMPS,
    FURUTA_PENDULUM,
    HUB_BEAM_TIP_MASS,
    LOUDSPEAKER,
    PENDULUM,
    PLANETARY_ARM,
    PLANETARY_ARM_RIG,
    PUMA_560,
    QUADROTOR_SLUNG_LOAD,
    SHAFT_AND_DISC,
    TWO_LINK_ARM,
];
