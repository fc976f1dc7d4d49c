//! Tests of the auditor on motions with a known energy balance.

use eomgen_sim::ode::ObservedStep;

use super::{Audit, Auditor, Energies, EnergyAndPower};

/// Returns energy and power of a mass of 1 kg on a spring of 1 N/m; its state is (x, v).
fn oscillator(_: f64, state: &[f64]) -> EnergyAndPower {
    EnergyAndPower {
        energy: 0.5 * (state[0] * state[0] + state[1] * state[1]),
        power: 0.0,
    }
}

/// Audits the oscillator's motion in steps of 0.1 s. `tamper` changes the states from step 20 on.
fn audit_oscillator(tamper: impl Fn(&mut [f64; 2]), energies: &mut dyn Energies) -> Audit {
    let mut auditor = Auditor::new(Some(1e-9), &[1.0; 2], None);
    let state = |t: f64| [t.cos(), -t.sin()];
    for count in 0..40 {
        let (t, next) = (0.1 * f64::from(count), 0.1 * f64::from(count + 1));
        let (start, mut end) = (state(t), state(next));
        if count >= 20 {
            tamper(&mut end);
        }
        let mut step = ObservedStep {
            start: (t, &start),
            end: (next, &end),
            state_inside: &mut |t, _| Some(state(t).to_vec()),
        };
        auditor.audit_step(&mut step, energies);
    }
    auditor.audit()
}

#[test]
fn exact_motion_has_no_fault() {
    let audit = audit_oscillator(|_| {}, &mut oscillator);
    assert_eq!(audit.fault_count, 0);
    assert!(audit.evaluations < 40 * 20, "{}", audit.evaluations);
}

#[test]
fn fault_of_changed_state_has_its_time_and_size() {
    let audit = audit_oscillator(|state| state[1] *= 1.0 + 1e-4, &mut oscillator);
    let fault = audit.first_fault.expect("a fault");
    assert!((fault.t - 2.1).abs() < 1e-12);
    let v: f64 = (2.1_f64).sin();
    assert!(
        (fault.energy_gain - 1e-4 * v * v).abs() < 1e-8,
        "{}",
        fault.energy_gain
    );
}

#[test]
fn jump_of_energy_is_a_fault() {
    // x falls through the wall at t = 2.05 s, between the steps at 2.0 s and 2.1 s.
    let wall = 2.05_f64.cos();
    let mut jump = |t: f64, state: &[f64]| EnergyAndPower {
        energy: oscillator(t, state).energy + f64::from(state[0] < wall),
        power: 0.0,
    };
    let audit = audit_oscillator(|_| {}, &mut jump);
    let fault = audit.first_fault.expect("a fault");
    assert!((fault.t - 2.1).abs() < 1e-12 && (fault.energy_gain - 1.0).abs() < 1e-9);
}

#[test]
fn energy_change_without_work_is_a_fault() {
    // The energy grows by 0.1 t^2. The power of a force explains this growth or is missing.
    let mut pushed = |t: f64, state: &[f64]| EnergyAndPower {
        energy: oscillator(t, state).energy + 0.1 * t * t,
        power: 0.2 * t,
    };
    let audit = audit_oscillator(|_| {}, &mut pushed);
    assert_eq!(audit.fault_count, 0);
    assert!((audit.work - 1.6).abs() < 1e-12);
    let mut idle = |t: f64, state: &[f64]| EnergyAndPower {
        power: 0.0,
        ..pushed(t, state)
    };
    assert_eq!(audit_oscillator(|_| {}, &mut idle).fault_count, 40);
}

#[test]
fn power_that_no_quadrature_resolves_is_not_audited() {
    // Pairs of the angular frequency of the power in rad/s, and whether a step of 0.1 s resolves it.
    for (frequency, is_resolved) in [(2e3, true), (1.1e4, true), (1e6, false), (1e9, false)] {
        let mut pulsating = |t: f64, state: &[f64]| EnergyAndPower {
            energy: oscillator(t, state).energy + 10.0 * (frequency * t).sin(),
            power: 10.0 * frequency * (frequency * t).cos(),
        };
        let audit = audit_oscillator(|_| {}, &mut pulsating);
        assert_eq!(audit.fault_count, 0, "{frequency}: {audit:?}");
        assert_eq!(
            audit.exclusion_reason.is_none(),
            is_resolved,
            "{frequency}: {audit:?}"
        );
        let mut twice = |t: f64, state: &[f64]| EnergyAndPower {
            power: 2.0 * pulsating(t, state).power,
            ..pulsating(t, state)
        };
        let found = audit_oscillator(|_| {}, &mut twice).fault_count > 0;
        assert!(found || !is_resolved, "{frequency}");
    }
}

#[test]
fn work_of_a_transient_in_a_long_step_is_found() {
    // A force acts for one microsecond at 0.03 s, between the nodes of the first quadratures.
    let rise = |t: f64| 1.0 - (-(t - 0.03).max(0.0) / 1e-6).exp();
    let mut pushed = |t: f64, state: &[f64]| EnergyAndPower {
        energy: oscillator(t, state).energy + rise(t),
        power: (1.0 - rise(t)) / 1e-6 * f64::from(t > 0.03),
    };
    let audit = audit_oscillator(|_| {}, &mut pushed);
    assert_eq!(audit.fault_count, 0);
    assert!((audit.work - 1.0).abs() < 1e-6, "{}", audit.work);
    let mut idle = |t: f64, state: &[f64]| EnergyAndPower {
        power: 0.0,
        ..pushed(t, state)
    };
    assert_eq!(audit_oscillator(|_| {}, &mut idle).fault_count, 1);
}

#[test]
fn only_energy_gain_at_impact_is_a_fault() {
    let mut auditor = Auditor::new(Some(1e-9), &[1.0; 2], None);
    auditor.audit_impact(1.0, (&[0.0, -1.0], &[0.0, 0.5]), 0.0, &mut oscillator);
    assert_eq!(auditor.audit().fault_count, 0);
    assert_eq!(auditor.audit().impact_energy, 0.5 * (0.25 - 1.0));
    auditor.audit_impact(2.0, (&[0.0, -1.0], &[0.0, 1.1]), 0.0, &mut oscillator);
    let fault = auditor.audit().first_fault.expect("a fault");
    assert_eq!(fault.t, 2.0);
    assert!((fault.energy_gain - 0.5 * 0.21).abs() < 1e-12);
}

/// After the last bounce the energy is 1e-24 J; a fault of this size must be found.
#[test]
fn fault_of_a_small_motion_is_found() {
    let small = |t: f64| [1e-12 * t.cos(), -1e-12 * t.sin()];
    let faults = |gain: f64| {
        let mut auditor = Auditor::new(Some(1e-9), &[1e-12; 2], None);
        for count in 0..40 {
            let (t, next) = (0.1 * f64::from(count), 0.1 * f64::from(count + 1));
            let (start, mut end) = (small(t), small(next));
            if count == 20 {
                end[1] *= gain;
            }
            let mut step = ObservedStep {
                start: (t, &start),
                end: (next, &end),
                state_inside: &mut |t, _| Some(small(t).to_vec()),
            };
            auditor.audit_step(&mut step, &mut oscillator);
        }
        auditor.audit().fault_count
    };
    assert_eq!(faults(1.0), 0);
    assert!(faults(1.0 + 1e-4) > 0);
}

/// Oscillator with a large constant in its energy, which causes rounding errors.
struct OffsetOscillator(f64);

impl Energies for OffsetOscillator {
    fn evaluate(&mut self, (t, state): (f64, &[f64])) -> EnergyAndPower {
        let EnergyAndPower { energy, power } = oscillator(t, state);
        EnergyAndPower {
            energy: (energy + self.0) - self.0,
            power,
        }
    }

    fn bound_roundings(&mut self, _: (f64, &[f64])) -> EnergyAndPower {
        EnergyAndPower {
            energy: f64::EPSILON * self.0,
            power: 0.0,
        }
    }
}

#[test]
fn rounding_of_terms_is_no_fault_but_larger_changes_are() {
    for constant in [0.0, 1e3, 1e9] {
        let audit = audit_oscillator(|_| {}, &mut OffsetOscillator(constant));
        assert!(!audit.has_failed(), "{constant}: {audit:?}");
    }
    for (constant, is_found) in [(0.0, true), (1e9, true), (1e13, false)] {
        let audit = audit_oscillator(
            |state| state[1] *= 1.0 + 1e-4,
            &mut OffsetOscillator(constant),
        );
        assert_eq!(audit.has_failed(), is_found, "{constant}: {audit:?}");
    }
}

/// A body is at rest under two forces that cancel. Its speed has a rounding error, so each force has a power.
#[test]
fn work_by_errors_of_a_rate_at_rest_is_no_fault() {
    let force = 1e3;
    let mut pressed = |_: f64, state: &[f64]| EnergyAndPower {
        energy: 0.5 * state[1] * state[1],
        power: force * state[1],
    };
    let faults = |speed: f64, energies: &mut dyn Energies| {
        let mut auditor = Auditor::new(Some(1e-9), &[1.0; 2], None);
        let state = [0.0, speed];
        for count in 0..40 {
            let mut step = ObservedStep {
                start: (0.1 * f64::from(count), &state),
                end: (0.1 * f64::from(count + 1), &state),
                state_inside: &mut |_, _| Some(state.to_vec()),
            };
            auditor.audit_step(&mut step, energies);
        }
        auditor.audit().fault_count
    };
    assert_eq!(faults(1e-19, &mut pressed), 0);
    assert_eq!(faults(1e-5, &mut pressed), 40);
}
