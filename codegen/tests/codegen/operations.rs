//! Number of operations per call of the accelerations. It is linear in the order, with the smallest slope that the
//! structure of the equations permits.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;

use crate::support::{accelerations, chain_of_pendulums, evaluator, model, program, shipped};

/// Returns the number of operations of one call.
fn operations(name: &str, order: usize) -> usize {
    let program = program(&shipped(name), order);
    program.operations(&program.accelerations.all())
}

/// Returns the number of operations per additional mode of every field; asserts that it is equal between any two
/// orders.
fn operations_per_mode(name: &str) -> usize {
    let per_mode = operations(name, 5) - operations(name, 4);
    for (low, high) in [(8, 16), (16, 64), (64, 128)] {
        let difference = operations(name, high) - operations(name, low);
        assert_eq!(difference, per_mode * (high - low), "{name}");
    }
    per_mode
}

// Per mode: a product that is added to the bending moment, and an acceleration from two products.
#[test]
fn planetary_arm_takes_five_operations_per_mode() {
    assert_eq!(operations_per_mode("planetary_arm"), 5);
}

#[test]
fn tip_mass_adds_eight_operations_per_mode() {
    assert_eq!(operations_per_mode("hub_beam_tip_mass"), 13);
}

// Two modes, one of each link. For each: deflections, slopes and moments with their rates, one product and
// one sum each; the free acceleration; its share in three interfaces; the contributions of the three
// interface forces.
#[test]
fn two_flexible_links_take_at_most_120_operations_per_order() {
    let per_order = operations_per_mode("two_link_arm");
    assert!(per_order <= 120, "{per_order}");
    assert_eq!(per_order, 62);
}

/// Returns the operations of the velocity terms and of inverse dynamics of a model without fields.
fn operations_of_rows(model: &Model) -> (usize, usize) {
    let variant = Variant::derive_with(model, &[], &[Output::InverseDynamics]);
    let Ok(Variant { program, .. }) = variant else {
        panic!("not derived");
    };
    let inverse = program.outputs.inverse_dynamics.as_ref().unwrap();
    (
        program.operations(&program.velocity_terms.all()),
        program.operations(&inverse.all()),
    )
}

// Recursion along the chain needs no mass matrix.
#[test]
fn velocity_terms_and_inverse_dynamics_grow_linearly_with_a_chain() {
    let of = |bobs| operations_of_rows(&model(&chain_of_pendulums(bobs)));
    let (velocity, inverse) = of(4);
    for bobs in [8, 16] {
        let further = bobs - 4;
        assert_eq!(of(bobs), (velocity + 16 * further, inverse + 22 * further));
    }
}

// Velocities from frame to frame take about 150 operations for each joint; Lagrange's terms, entry by entry,
// took 330. Inverse dynamics propagates accelerations outward and forces inward.
#[test]
fn six_joints_take_fewer_than_a_thousand_operations() {
    assert_eq!(operations("puma_560", 0), 924);
    assert_eq!(operations_of_rows(&shipped("puma_560")).1, 345);
}

/// Two pendulums, described by the angle between them.
const BY_HAND: &str = r#"
[model]
name = "by_hand"
[parameters]
m = { value = 0.3, unit = "kg" }
l = { value = 0.4, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
q_1 = { unit = "rad" }
q_2 = { unit = "rad" }
[kinetic]
both = "m*l^2*dot(q_1)^2 + 1/2*m*l^2*dot(q_2)^2 + m*l^2*cos(q_1 - q_2)*dot(q_1)*dot(q_2)"
[potential]
both = "-m*g*l*(2*cos(q_1) + cos(q_2))"
"#;

#[test]
fn cartesian_positions_take_no_more_operations_than_manual_energies() {
    let (cartesian, by_hand) = (model(&chain_of_pendulums(2)), model(BY_HAND));
    let count = |model| {
        let program = program(model, 0);
        program.operations(&program.accelerations.all())
    };
    assert_eq!(count(&cartesian), count(&by_hand));
    let state = [0.7, -1.1, 2.0, 3.0];
    let found = accelerations(&mut evaluator(&cartesian, 0), &state);
    let expected = accelerations(&mut evaluator(&by_hand, 0), &state);
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-12 * expected.abs());
    }
}
