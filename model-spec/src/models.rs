//! The specifications shipped with the crate, as text: what a program shows, checks or
//! simulates without a file beside it.

use crate::source::Source;

/// A specification shipped with the crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedModel {
    /// The model's name, which is the file's without `.toml`.
    pub name: &'static str,
    /// The whole text of the file.
    pub text: &'static str,
}

impl ShippedModel {
    /// The text under its file's name, to be checked.
    pub fn source(&self) -> Source {
        Source::new(format!("{}.toml", self.name), self.text)
    }
}

/// A cart with two pendulum arms.
pub const CART_TWO_ARMS: ShippedModel = ShippedModel {
    name: "cart_two_arms",
    text: include_str!("../models/cart_two_arms.toml"),
};

/// A double pendulum.
pub const DOUBLE_PENDULUM: ShippedModel = ShippedModel {
    name: "double_pendulum",
    text: include_str!("../models/double_pendulum.toml"),
};

/// A ball-screw positioning axis.
pub const EMPS: ShippedModel = ShippedModel {
    name: "emps",
    text: include_str!("../models/emps.toml"),
};

/// A rotary inverted pendulum.
pub const FURUTA_PENDULUM: ShippedModel = ShippedModel {
    name: "furuta_pendulum",
    text: include_str!("../models/furuta_pendulum.toml"),
};

/// A hub-driven beam with a tip mass.
pub const HUB_BEAM_TIP_MASS: ShippedModel = ShippedModel {
    name: "hub_beam_tip_mass",
    text: include_str!("../models/hub_beam_tip_mass.toml"),
};

/// A pendulum arm, as measured.
pub const PENDULUM: ShippedModel = ShippedModel {
    name: "pendulum",
    text: include_str!("../models/pendulum.toml"),
};

/// A flexible arm on a planetary reducer with backlash, driven by a motor's law.
pub const PLANETARY_ARM: ShippedModel = ShippedModel {
    name: "planetary_arm",
    text: include_str!("../models/planetary_arm.toml"),
};

/// The same arm with the motor's torque as an input.
pub const PLANETARY_ARM_RIG: ShippedModel = ShippedModel {
    name: "planetary_arm_rig",
    text: include_str!("../models/planetary_arm_rig.toml"),
};

/// A load on the rope of a trolley, both moved as prescribed.
pub const CRANE: ShippedModel = ShippedModel {
    name: "crane",
    text: include_str!("../models/crane.toml"),
};

/// A moving-coil loudspeaker, with currents as states of first order.
pub const LOUDSPEAKER: ShippedModel = ShippedModel {
    name: "loudspeaker",
    text: include_str!("../models/loudspeaker.toml"),
};

/// A disc on an elastic shaft.
pub const SHAFT_AND_DISC: ShippedModel = ShippedModel {
    name: "shaft_and_disc",
    text: include_str!("../models/shaft_and_disc.toml"),
};

/// The PUMA 560, a six-joint arm of bodies in space.
pub const PUMA_560: ShippedModel = ShippedModel {
    name: "puma_560",
    text: include_str!("../models/puma_560.toml"),
};

/// Two flexible links in a plane with a tip mass.
pub const TWO_LINK_ARM: ShippedModel = ShippedModel {
    name: "two_link_arm",
    text: include_str!("../models/two_link_arm.toml"),
};

/// Chaplygin's sleigh, held by a constraint that holds rates.
pub const CHAPLYGIN_SLEIGH: ShippedModel = ShippedModel {
    name: "chaplygin_sleigh",
    text: include_str!("../models/chaplygin_sleigh.toml"),
};

/// A quadrotor with a load on a rope, in vectors.
pub const QUADROTOR_SLUNG_LOAD: ShippedModel = ShippedModel {
    name: "quadrotor_slung_load",
    text: include_str!("../models/quadrotor_slung_load.toml"),
};

/// All of them, by name.
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
