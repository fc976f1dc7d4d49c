//! Tests of the hand-written equations: energy balance, sufficiently short steps, and a residual of
//! missing modes below the noise floor.

use eomgen_blind::friction::{AxisForces, FrictionLaw};
use eomgen_blind::hidden::Sensors;
use eomgen_blind::inputs::{Drive, Excitation, drive};
use eomgen_blind::integrate::{Motion, Stepper};
use eomgen_blind::machines::arm::Arm;
use eomgen_blind::machines::axes::Pendulum;
use eomgen_blind::machines::two_bodies::{Form, TwoBodies};
use eomgen_blind::machines::{Kind, Machine, Setup};
use eomgen_blind::random::RandomStream;
use eomgen_blind::size::{floors_of_missing_modes, window};

fn advance_state(machine: &impl Motion, start: &[f64], span: f64, steps: usize) -> Vec<f64> {
    let mut state = start.to_vec();
    Stepper::new(start.len()).advance(machine, 0.0, span, steps, 0.0, &mut state);
    state
}

/// Returns an arm without losses, with all hidden effects that store energy.
fn lossless_arm(compliance: f64) -> Arm {
    let mut arm = Arm::nominal();
    arm.b_m = 0.0;
    for mesh in &mut arm.meshes {
        mesh.damping = 0.0;
        mesh.middle = 7e-6;
        mesh.error = (3.0, 4e-6, -6e-6);
        mesh.variation = (2.0, 0.1, 0.2);
    }
    arm.tip_mass = 0.2;
    arm.cubic = 1e9;
    arm.weight = (3.0, -5.0);
    arm.compliance = compliance;
    arm.prepare();
    arm
}

/// Returns a moving state with closed meshes and a bent arm.
fn state_in_motion(yields: bool) -> Vec<f64> {
    let mut state = vec![0.0; eomgen_blind::machines::arm::STATE];
    state[4] = 1e-3;
    state[5] = -2e-4;
    state[8] = 0.5;
    state[9] = 0.3;
    state[10] = 4.0;
    if yields {
        state[3] = 0.01;
    }
    state
}

#[test]
fn lossless_arm_conserves_energy() {
    for compliance in [0.0, 1e-3] {
        let arm = lossless_arm(compliance);
        let start = state_in_motion(compliance > 0.0);
        let deviation = |steps: usize| {
            let end = advance_state(&arm, &start, 0.05, steps);
            assert!((end[0] - start[0]).abs() > 1e-3, "the motion is too small");
            (arm.energy(&end) / arm.energy(&start) - 1.0).abs()
        };
        let (coarse, fine) = (deviation(20_000), deviation(80_000));
        // Steps in which a mesh closes are accurate to second order; there are about a hundred
        // impacts.
        assert!(fine < 1e-6, "{fine}");
        assert!(fine < coarse / 4.0, "{coarse} {fine}");
    }
}

#[test]
fn losses_of_arm_match_their_power() {
    let mut arm = lossless_arm(0.0);
    arm.on_carrier = AxisForces::none(FrictionLaw::Steep { speed: 0.01 });
    arm.on_carrier.viscous = 0.3;
    let start = state_in_motion(false);
    let (mut state, mut lost) = (start.clone(), 0.0);
    let mut stepper = Stepper::new(start.len());
    let step = 5e-7;
    for _ in 0..100_000 {
        let power = |state: &[f64]| 0.3 * state[10] * state[10];
        let before = power(&state);
        stepper.advance(&arm, 0.0, step, 1, 0.0, &mut state);
        lost += 0.5 * step * (before + power(&state));
    }
    let change = arm.energy(&start) - arm.energy(&state);
    assert!(lost > 1e-3 * arm.energy(&start), "{lost}");
    // The tolerance covers the error of the trapezoidal rule and of the impacts.
    assert!((change / lost - 1.0).abs() < 1e-4, "{change} {lost}");
}

#[test]
fn pendulum_conserves_energy_and_has_small_amplitude_period() {
    let mut pendulum = Pendulum::nominal();
    pendulum.viscous = 0.0;
    let hanging = std::f64::consts::PI;
    let start = [hanging - 2.0, 0.0, 0.0];
    let end = advance_state(&pendulum, &start, 3.0, 150_000);
    let scale = pendulum.mass * pendulum.gravity * pendulum.distance;
    assert!((pendulum.energy(&end) - pendulum.energy(&start)).abs() < 1e-9 * scale);
    let turned = pendulum.mass * pendulum.distance.powi(2) + pendulum.inertia;
    let period = 2.0 * hanging * (turned / scale).sqrt();
    let end = advance_state(&pendulum, &[hanging + 1e-4, 0.0, 0.0], period, 50_000);
    // The period increases by the fraction amplitude^2/16.
    assert!(
        (end[0] - hanging - 1e-4).abs() < 1e-10 && end[1].abs() < 1e-10,
        "{end:?}"
    );
}

#[test]
fn two_bodies_conserve_energy_without_losses_only() {
    for form in [Form::TwoMass, Form::Crane, Form::QuarterCar] {
        let declared = TwoBodies::random(form, 8);
        let mut bodies = declared.clone();
        bodies.viscous = [0.0; 2];
        bodies.spring.damping = 0.0;
        let start = [0.02, 0.3, -0.5, 1.0, 0.0, 0.0];
        let energy = bodies.energy(&start);
        let end = advance_state(&bodies, &start, 1.0, 20_000);
        assert!((end[0] - start[0]).abs() > 1e-3, "the motion is too small");
        let scale = bodies.energy(&[0.0, 0.3, 0.0, 1.0, 0.0, 0.0]).abs();
        assert!(
            (bodies.energy(&end) - energy).abs() < 1e-9 * scale,
            "{form:?}"
        );
        let end = advance_state(&declared, &start, 1.0, 20_000);
        assert!(energy - declared.energy(&end) > 1e-3 * scale, "{form:?}");
    }
}

fn drives(kind: Kind, setup: &Setup, seed: u64) -> Vec<Drive> {
    let mut draw = RandomStream::new(seed, 0);
    vec![drive(kind, setup, Excitation::Usual, 0, &mut draw)]
}

/// Returns the RMS difference between steps and half steps over windows of 0.1 s from the same
/// states, relative to the noise.
fn step_error(machine: &Machine, setup: &Setup, drive: &Drive) -> f64 {
    let fine = Setup {
        steps: 2 * setup.steps,
        ..setup.clone()
    };
    let all = window(machine, setup, drive, &drive.start, 0, drive.input.len());
    let length = (0.1 / setup.sample).round() as usize;
    let (mut sum, mut count) = (0.0, 0);
    for first in (0..drive.input.len() - length).step_by(length) {
        let other = window(machine, &fine, drive, &all[first], first, length);
        for (a, b) in all[first..].iter().zip(&other) {
            let outputs = machine.outputs(a).into_iter().zip(machine.outputs(b));
            for ((a, b), channel) in outputs.zip(&setup.channels) {
                sum += ((a - b) / channel.noise).powi(2);
                count += 1;
            }
        }
    }
    f64::sqrt(sum / f64::from(count))
}

/// Maximum step error, relative to the noise. It increases the RMS of the noise by 2 %. Impacts
/// amplify step errors, mainly on the arm.
const MAX_STEP_ERROR: f64 = 0.2;

#[test]
fn integration_steps_are_short_enough() {
    let drawn = [Form::TwoMass, Form::Crane, Form::QuarterCar]
        .map(|form| Kind::TwoBodies { form, seed: 5 });
    for kind in [Kind::Arm, Kind::Stage, Kind::Pendulum]
        .into_iter()
        .chain(drawn)
    {
        let setup = kind.setup();
        let (level, bristles) = match kind {
            Kind::Arm => (0.05, (2e-3, 6e-4)),
            Kind::Stage => (5.0, (5e-6, 95.0)),
            Kind::Pendulum => (1e-3, (3e-4, 3.3e-3)),
            Kind::TwoBodies { form, seed } => {
                let bodies = TwoBodies::random(form, seed);
                (0.2 * bodies.usual_input(), bodies.bristles()[0])
            }
        };
        for bends in [false, true] {
            let mut machine = kind.nominal();
            let name = match &machine {
                Machine::TwoBodies(bodies) => bodies.axes()[0],
                _ => setup.channels[0].name,
            };
            let axis = machine.axis(name).expect("an axis");
            axis.coulomb = level;
            if bends {
                let (reach, inertia) = bristles;
                axis.dry = FrictionLaw::Bristles { reach, inertia };
            }
            let error = step_error(&machine, &setup, &drives(kind, &setup, 5)[0]);
            println!("{kind:?}, bristles {bends}: {error} times the noise");
            assert!(
                error < MAX_STEP_ERROR,
                "{kind:?} {bends}: {error} times the noise"
            );
        }
    }
}

#[test]
fn missing_modes_stay_below_noise_floor() {
    let setup = Kind::Arm.setup();
    let mut sum = 0.0;
    for seed in 0..4 {
        let machine = Kind::Arm.nominal();
        let drives = drives(Kind::Arm, &setup, seed);
        let floors = floors_of_missing_modes(&machine, &setup, &drives);
        println!("missing modes: {floors} floors");
        sum += floors;
    }
    // The missing modes increase the RMS of the noise by 3 %, well below the detectable 10 %.
    assert!(sum / 4.0 < 0.25, "{sum}");
}

#[test]
fn sensors_have_declared_noise_and_delay() {
    let setup = Kind::Stage.setup();
    let machine = Kind::Stage.nominal();
    let drive = &drives(Kind::Stage, &setup, 3)[0];
    let mut draw = RandomStream::new(3, 1);
    let mut sensors = Sensors::ideal(1);
    let clean = window(&machine, &setup, drive, &drive.start, 0, drive.input.len());
    let seen = eomgen_blind::records::sensor_readings(&machine, &setup, drive, &sensors, &mut draw);
    let noise = setup.channels[0].noise;
    let square = |(a, b): (&f64, &Vec<f64>)| ((a - b[0]) / noise).powi(2);
    let mean = seen[0].iter().zip(&clean).map(square).sum::<f64>() / clean.len() as f64;
    // Tolerance: five standard errors of a mean of 1600 squares.
    assert!(
        (mean - 1.0).abs() < 5.0 * (2.0 / 1600.0f64).sqrt(),
        "{mean}"
    );
    sensors.delay[0] = 2.0 * setup.sample;
    let late = eomgen_blind::records::sensor_readings(&machine, &setup, drive, &sensors, &mut draw);
    let worst = late[0][2..]
        .iter()
        .zip(&clean)
        .map(|(a, b)| (a - b[0]).abs());
    assert!(worst.fold(0.0, f64::max) < 6.0 * noise);
}
