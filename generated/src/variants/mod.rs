//! Variants of the family `planetary_arm`, emitted by `eomgen family`. Do not edit: generate again.

#![allow(dead_code)]

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
