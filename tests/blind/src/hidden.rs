//! Effects that can be hidden, with the names of `discovery.json`, and their implementation in
//! machines and sensors.

use serde::{Deserialize, Serialize};

use crate::friction::UncataloguedForce;
use crate::machines::two_bodies::Form;
use crate::machines::{Machine, Setup};

/// Kind of hidden effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Effect {
    CoulombFriction,
    ViscousFriction,
    StribeckFriction,
    AsymmetricFriction,
    QuadraticDrag,
    ForceOffset,
    ElasticRestraint,
    Gravity,
    TorqueRipple,
    StructuralDamping,
    TipMass,
    StiffnessNonlinearity,
    JointCompliance,
    TransmissionError,
    StiffnessVariation,
    AsymmetricBacklash,
    SensorDelay,
    SensorGain,
    SensorBias,
    ParameterShift,
    Backlash,
    /// Stop on one side; the sign selects the side.
    EndStop,
    /// Equal stops on both sides.
    EndStops,
    InputGain,
    InputBias,
    /// Outside the catalogue: friction that increases with the displacement.
    WornFriction,
    /// Outside the catalogue: external force.
    ForeignHum,
    /// Outside the catalogue: drive that weakens with the displacement.
    WeakeningDrive,
}

/// Hidden effect with site and size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HiddenEffect {
    /// Kind of the effect.
    pub effect: Effect,
    /// Site: an axis, mesh, channel or parameter, or `arm`.
    pub on: String,
    /// Depends on the effect: periods per revolution, frequency in Hz of an external force, or
    /// deflection at which a stop is reached.
    pub order: f64,
    /// Sign of the effect, -1 or 1, if both are possible.
    pub sign: f64,
    /// Phase between cosine and sine, rad.
    pub phase: f64,
    /// Size, in the unit of the first parameter of the effect; for a joint, its compliance in rad
    /// per N m.
    pub amount: f64,
}

/// Errors of the sensors of all channels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensors {
    /// Gain minus 1.
    pub gain: Vec<f64>,
    /// Bias, SI.
    pub bias: Vec<f64>,
    /// Delay, s.
    pub delay: Vec<f64>,
}

impl Sensors {
    /// Returns sensors without errors.
    pub fn ideal(channels: usize) -> Self {
        Self {
            gain: vec![0.0; channels],
            bias: vec![0.0; channels],
            delay: vec![0.0; channels],
        }
    }

    /// Sensor effects of a channel, in the order of its unknowns.
    pub const UNKNOWNS: [Effect; 3] = [Effect::SensorGain, Effect::SensorBias, Effect::SensorDelay];

    /// Returns sensors with given errors of gain, bias and delay for each channel, in standard
    /// deviations of their priors.
    pub fn within_priors(setup: &Setup, deviations: &[f64]) -> Self {
        let mut sensors = Self::ideal(setup.channels.len());
        for (place, channel) in setup.channels.iter().enumerate() {
            let of = &deviations[3 * place..3 * place + 3];
            sensors.gain[place] = GAIN_PRIOR * of[0];
            sensors.bias[place] = BIAS_PRIOR * channel.noise * of[1];
            sensors.delay[place] = DELAY_PRIOR * setup.sample * of[2];
        }
        sensors
    }
}

/// Standard deviations of the sensor priors: gain, bias relative to the noise, delay in samples.
const GAIN_PRIOR: f64 = 0.01;
const BIAS_PRIOR: f64 = 10.0;
const DELAY_PRIOR: f64 = 0.5;

fn stribeck_speed(machine: &Machine) -> f64 {
    match machine {
        Machine::Arm(_) => 1.0,
        Machine::Stage(_) => 0.02,
        Machine::Pendulum(_) => 0.5,
        Machine::TwoBodies(bodies) => match bodies.form {
            Form::TwoMass => 0.3,
            Form::Crane | Form::QuarterCar => 0.02,
        },
    }
}

impl HiddenEffect {
    /// Applies the effect to a machine or its sensors.
    pub fn hide(&self, machine: &mut Machine, setup: &Setup, sensors: &mut Sensors) {
        let amount = self.amount * self.sign;
        let (sine, cosine) = self.phase.sin_cos();
        let repeating = (self.order, self.amount * cosine, self.amount * sine);
        let place = || setup.channels.iter().position(|c| c.name == self.on);
        match self.effect {
            Effect::SensorDelay => sensors.delay[place().expect("a channel")] += amount,
            Effect::SensorGain => sensors.gain[place().expect("a channel")] += amount,
            Effect::SensorBias => sensors.bias[place().expect("a channel")] += amount,
            Effect::ParameterShift => {
                assert!(machine.scale(&self.on, 1.0 + amount), "{}", self.on);
            }
            Effect::TransmissionError => machine.mesh(&self.on).expect("a mesh").error = repeating,
            Effect::StiffnessVariation => {
                machine.mesh(&self.on).expect("a mesh").variation = repeating;
            }
            Effect::AsymmetricBacklash => machine.mesh(&self.on).expect("a mesh").middle = amount,
            Effect::InputGain | Effect::InputBias => {
                let Machine::TwoBodies(bodies) = machine else {
                    panic!("only two bodies have drive faults");
                };
                match self.effect {
                    Effect::InputGain => bodies.actuator.0 = amount,
                    _ => bodies.actuator.1 = amount,
                }
            }
            _ if machine.spring(&self.on).is_some() => self.hide_in_spring(machine),
            _ if self.on == "arm" => self.hide_in_arm(machine, amount, repeating),
            _ => self.hide_on_axis(machine, amount, repeating),
        }
    }

    fn hide_in_spring(&self, machine: &mut Machine) {
        let spring = machine.spring(&self.on).expect("a spring");
        let stop = (self.amount, self.order);
        match self.effect {
            Effect::Backlash => spring.play = self.amount,
            Effect::StiffnessNonlinearity => spring.hardening = self.amount,
            Effect::EndStop if self.sign > 0.0 => spring.upper = stop,
            Effect::EndStop => spring.lower = stop,
            Effect::EndStops => (spring.upper, spring.lower) = (stop, stop),
            other => panic!("{other:?} is not an effect of a spring"),
        }
    }

    fn hide_in_arm(&self, machine: &mut Machine, amount: f64, repeating: (f64, f64, f64)) {
        let Machine::Arm(arm) = machine else {
            panic!("only the arm is flexible");
        };
        match self.effect {
            Effect::StructuralDamping => arm.loss = amount,
            Effect::TipMass => arm.tip_mass = amount,
            Effect::StiffnessNonlinearity => arm.cubic = amount,
            Effect::JointCompliance => arm.compliance = amount,
            Effect::Gravity => arm.weight = (repeating.1, repeating.2),
            other => panic!("{other:?} is not an effect of the arm"),
        }
        arm.prepare();
    }

    fn hide_on_axis(&self, machine: &mut Machine, amount: f64, repeating: (f64, f64, f64)) {
        let fall = stribeck_speed(machine);
        let axis = machine.axis(&self.on).expect("an axis");
        match self.effect {
            Effect::CoulombFriction => axis.coulomb = amount,
            Effect::ViscousFriction => axis.viscous = amount,
            Effect::StribeckFriction => axis.stribeck = (amount, fall),
            Effect::AsymmetricFriction => axis.asymmetric = amount,
            Effect::QuadraticDrag => axis.drag = amount,
            Effect::ForceOffset => axis.offset = amount,
            Effect::ElasticRestraint => axis.restraint = amount,
            Effect::Gravity => axis.gravity = (repeating.1, repeating.2),
            Effect::TorqueRipple => axis.ripple = repeating,
            Effect::WornFriction => axis.strange = UncataloguedForce::Worn(amount),
            Effect::ForeignHum => axis.strange = UncataloguedForce::Hum(amount, self.order),
            Effect::WeakeningDrive => axis.strange = UncataloguedForce::Weakening(amount),
            other => panic!("{other:?} is not an effect on an axis"),
        }
    }

    /// Returns the true values of the parameters of the effect, SI, sorted by parameter name.
    pub fn parameters(&self, machine: &Machine) -> Vec<f64> {
        let amount = self.amount * self.sign;
        let (sine, cosine) = self.phase.sin_cos();
        match self.effect {
            Effect::StribeckFriction => vec![amount, stribeck_speed(machine)],
            Effect::Gravity
            | Effect::TorqueRipple
            | Effect::TransmissionError
            | Effect::StiffnessVariation => vec![self.amount * cosine, self.amount * sine],
            Effect::JointCompliance => vec![1.0 / amount],
            Effect::SensorGain | Effect::InputGain => vec![1.0 + amount],
            Effect::EndStop | Effect::EndStops => vec![self.amount, self.order],
            Effect::ParameterShift => Vec::new(),
            // The hidden law differs from the law of the catalogue, so their parameters cannot be
            // compared.
            Effect::StiffnessNonlinearity if self.on != "arm" => Vec::new(),
            _ => vec![amount],
        }
    }

    /// Returns true if the effect is outside the catalogue.
    pub fn is_strange(&self) -> bool {
        matches!(
            self.effect,
            Effect::WornFriction | Effect::ForeignHum | Effect::WeakeningDrive
        )
    }

    /// Returns the standard deviation of the prior if the null model contains the effect at small
    /// sizes, as for sensor errors and declared parameters.
    pub fn prior(&self, setup: &Setup) -> Option<f64> {
        let channel = || setup.channels.iter().find(|c| c.name == self.on);
        match self.effect {
            Effect::SensorDelay => Some(DELAY_PRIOR * setup.sample),
            Effect::SensorGain => Some(GAIN_PRIOR),
            Effect::SensorBias => channel().map(|c| BIAS_PRIOR * c.noise),
            Effect::ParameterShift => {
                let declared = setup.uncertain.iter().find(|(name, _)| *name == self.on);
                declared.map(|(_, relative)| *relative)
            }
            _ => None,
        }
    }

    /// Returns the name of the effect in results.
    pub fn name(&self) -> String {
        if self.effect == Effect::EndStops {
            return "end_stop".to_owned();
        }
        serde_json::to_value(self.effect)
            .ok()
            .and_then(|value| value.as_str().map(str::to_owned))
            .unwrap_or_default()
    }
}
