//! The arm of two flexible links: its motion keeps the energy, which the certificate's
//! checks at single states cannot see.

use eomgen_tests::models::load;
use eomgen_tests::motions::{Subject, grid};

/// Let fall from the horizontal without friction and torque, for half a second: both links
/// swing and bend. The step's relative error is 1e-11 of each state; the energy that a
/// thousand steps or so may lose is a thousand times as much of what is exchanged.
#[test]
fn a_fall_without_friction_keeps_the_energy() {
    for order in [0, 1, 3] {
        let model = load("two_link_arm")
            .with_parameters(&[("c_1", 0.0), ("c_2", 0.0)])
            .expect("both are parameters");
        let size = 2 + 2 * order;
        let subject = Subject::new(model, order).from(&vec![0.0; 2 * size]);
        let times = grid(0.5, 10);
        let motion = subject
            .general((0.0, 0.5), &times, 1e-11)
            .expect("a motion");
        let energies = subject.energies(&times, &motion.states);
        // What falls by half a metre or so: the scale of what moves between T and V.
        let exchanged = 10.0;
        for (energy, t) in energies.iter().zip(&times) {
            let lost = (energy - energies[0]).abs();
            assert!(lost < 1e-8 * exchanged, "order {order}, {t} s: {lost:e} J");
        }
        let swung = motion.states.last().expect("a sample")[0];
        assert!(swung < -0.5, "order {order}: theta_1 = {swung}");
    }
}
