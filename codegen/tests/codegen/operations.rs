//! How many operations a call of the accelerations takes, by the program: linear in the
//! order, with the slope that the structure allows.

use crate::support::{program, shipped};

/// Operations of one call at an order.
fn operations(name: &str, order: usize) -> usize {
    let program = program(&shipped(name), order);
    program.operations(&program.accelerations.all())
}

/// The same for each further mode (of every field) between any two orders.
fn operations_per_mode(name: &str) -> usize {
    let per_mode = operations(name, 5) - operations(name, 4);
    for (low, high) in [(8, 16), (16, 64), (64, 128)] {
        let difference = operations(name, high) - operations(name, low);
        assert_eq!(difference, per_mode * (high - low), "{name}");
    }
    per_mode
}

/// A product and its sum into the bending moment, and an acceleration of two products.
#[test]
fn the_planetary_arm_takes_five_operations_per_mode() {
    assert_eq!(operations_per_mode("planetary_arm"), 5);
}

#[test]
fn a_tip_mass_adds_eight_operations_per_mode() {
    assert_eq!(operations_per_mode("hub_beam_tip_mass"), 13);
}

/// Two modes, one of each link. For each: deflections, slopes and moments with their
/// rates, one product and one sum each; the free acceleration; its share in three
/// interfaces; what the three interface forces add.
#[test]
fn two_flexible_links_take_at_most_120_operations_per_order() {
    let per_order = operations_per_mode("two_link_arm");
    assert!(per_order <= 120, "{per_order}");
    assert_eq!(per_order, 62);
}
