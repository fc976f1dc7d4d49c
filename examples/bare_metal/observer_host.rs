//! Runs the observer on the development machine, prints the bits of the run and the estimation errors, and asserts
//! limits of the errors.

use controller::prepared;
use observed::{MEASUREMENTS, Rig, SHOWN};

/// Index of the carrier's displacement in the state.
const CARRIER: usize = 2;

/// Index of the first mode in the state.
const MODE: usize = 3;

fn main() {
    let coefficients = prepared();
    let mut rig = Rig::new(&coefficients);
    let off = |rig: &Rig, i: usize| 1e6 * (rig.observer.state[i] - rig.arm[i]);
    eprintln!("after    carrier, um: arm    estimation error   first mode, um: arm   error");
    for count in 1..=MEASUREMENTS {
        rig.measure(&coefficients);
        let (arm, estimate) = (&rig.arm, &rig.observer.state);
        assert!(arm.iter().chain(estimate).all(|number| number.is_finite()));
        if count % SHOWN == 0 {
            eprintln!(
                "{:.1} s {:19.2} {:20.2} {:20.2} {:7.2}",
                f64::from(count) * 1e-3,
                1e6 * arm[CARRIER],
                off(&rig, CARRIER),
                1e6 * arm[MODE],
                off(&rig, MODE),
            );
            for number in estimate.iter().chain(arm) {
                println!("state           {:016x}", number.to_bits());
            }
        }
    }
    eprintln!("{} measured values were NaN", rig.observer.left_out);
    // In 20 measurements all three values are missing; in 68 others, every seventh, the first value is missing.
    assert_eq!(rig.observer.left_out, 20 * 3 + 500 / 7 - 3);
    assert!(off(&rig, CARRIER).abs() < 5.0 && off(&rig, MODE).abs() < 30.0);
    assert!(rig.arm[CARRIER].abs() < 50e-6);
}
