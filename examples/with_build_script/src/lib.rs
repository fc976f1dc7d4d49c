//! The planetary arm, emitted by the build script.
#![no_std]

/// The planetary arm with four modes.
pub mod arm {
    include!(concat!(env!("OUT_DIR"), "/planetary_arm_order_4.rs"));
}
