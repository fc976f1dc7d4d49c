//! Equations of motion of the planetary arm, rigid and with one to eight modes, as
//! emitted by `eomgen generate --all`. Do not edit: regenerate.

#![no_std]

#[rustfmt::skip]
pub mod planetary_arm_rigid;
#[rustfmt::skip]
pub mod planetary_arm_order_1;
#[rustfmt::skip]
pub mod planetary_arm_order_2;
#[rustfmt::skip]
pub mod planetary_arm_order_3;
#[rustfmt::skip]
pub mod planetary_arm_order_4;
#[rustfmt::skip]
pub mod planetary_arm_order_5;
#[rustfmt::skip]
pub mod planetary_arm_order_6;
#[rustfmt::skip]
pub mod planetary_arm_order_7;
#[rustfmt::skip]
pub mod planetary_arm_order_8;
