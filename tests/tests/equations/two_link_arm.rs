//! Test of energy conservation of the two-link flexible arm along a motion, because certificates check only single
//! states.

use eomgen_tests::models::load;
use eomgen_tests::motions::{TestMotion, grid};

/// The arm falls from the horizontal without friction and torque for half a second; both links swing and bend. Each
/// step has a relative error of 1e-11, so the error after about a thousand steps may be 1e-8 of the exchanged energy.
#[test]
fn frictionless_fall_conserves_energy() {
    for order in [0, 1, 3] {
        let model = load("two_link_arm")
            .with_parameters(&[("c_1", 0.0), ("c_2", 0.0)])
            .expect("both are parameters");
        let size = 2 + 2 * order;
        let subject = TestMotion::new(model, order).with_initial_state(&vec![0.0; 2 * size]);
        let times = grid(0.5, 10);
        let motion = subject
            .simulate_generally((0.0, 0.5), &times, 1e-11)
            .expect("a motion");
        let energies = subject.energies(&times, &motion.states);
        // Energy (J) exchanged between T and V by a fall of about half a metre.
        let exchanged = 10.0;
        for (energy, t) in energies.iter().zip(&times) {
            let lost = (energy - energies[0]).abs();
            assert!(lost < 1e-8 * exchanged, "order {order}, {t} s: {lost:e} J");
        }
        let swung = motion.states.last().expect("a sample")[0];
        assert!(swung < -0.5, "order {order}: theta_1 = {swung}");
    }
}
