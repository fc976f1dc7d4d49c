//! Which cases a seed makes: 60 with one effect, 30 with nothing hidden, 15 with two and 15
//! with something outside the catalogue or that the record cannot tell. Their order says
//! nothing of what they are.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::hidden::{Effect, Hidden, Sensors};
use crate::inputs::Manner;
use crate::machines::{Kind, Machine, Setup};
use crate::random::Draw;

/// What kind of case it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// One effect of the catalogue.
    Single,
    /// Nothing.
    Nothing,
    /// Two effects of the catalogue.
    Pair,
    /// Something that no catalogue holds.
    Outside,
    /// An effect that the record cannot tell from another.
    Untellable,
}

/// An effect to hide.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// The effect; its size is found later.
    pub hidden: Hidden,
    /// How many floors high it shall stand.
    pub level: f64,
    /// What the record cannot tell from it.
    pub alike: Vec<(String, String)>,
}

/// A case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its number, from 0.
    pub number: usize,
    /// What kind of case it is.
    pub group: Group,
    /// The machine.
    pub machine: Kind,
    /// How it is driven.
    pub manner: Manner,
    /// What is hidden.
    pub hidden: Vec<Planned>,
    /// What is off without being an effect.
    pub nuisances: Nuisances,
}

/// What is off without being an effect: how many standard deviations of its prior each
/// declared parameter, bias, gain and delay may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nuisances {
    declared: f64,
    bias: f64,
    gain: f64,
    delay: f64,
}

impl Nuisances {
    /// Draws them, within two standard deviations; returns the true declared parameters.
    pub fn draw(
        &self,
        setup: &Setup,
        machine: &mut Machine,
        sensors: &mut Sensors,
        draw: &mut Draw,
    ) -> Vec<(String, f64)> {
        let mut declared = Vec::new();
        for (name, relative) in &setup.uncertain {
            let factor = 1.0 + relative * self.declared * draw.normal_within_two();
            machine.scale(name, factor);
            declared.push(((*name).to_owned(), factor));
        }
        // A motion that begins before the record cannot be seen late.
        let late = if setup.input.is_some() {
            self.delay
        } else {
            0.0
        };
        for (place, channel) in setup.channels.iter().enumerate() {
            sensors.bias[place] = 10.0 * channel.noise * self.bias * draw.normal_within_two();
            sensors.gain[place] = 0.01 * self.gain * draw.normal_within_two();
            let delay = 0.5 * setup.sample * late * draw.normal_within_two().abs();
            sensors.delay[place] = delay;
        }
        declared
    }
}

impl Case {
    /// Whether its motions begin at rest.
    pub fn starts_at_rest(&self) -> bool {
        self.machine != Kind::Pendulum && self.manner != Manner::OneWay
    }
}

/// Everything as declared but the parameters.
const USUAL: Nuisances = Nuisances {
    declared: 1.0,
    bias: 0.2,
    gain: 0.0,
    delay: 0.0,
};

/// How many floors single effects stand high: one that is hard to see, the least that must be
/// found, and some that are plain.
const LEVELS: [f64; 5] = [1.5, 3.0, 6.0, 15.0, 60.0];

/// The cases of a seed.
pub fn plan(seed: u64) -> Vec<Case> {
    let mut draw = Draw::new(seed, 0);
    let mut cases = singles(&mut draw);
    cases.extend(nothings());
    cases.extend(pairs(&mut draw));
    cases.extend(outside(&mut draw));
    cases.extend(untellable(&mut draw));
    draw.shuffle(&mut cases);
    for (number, case) in cases.iter_mut().enumerate() {
        case.number = number;
    }
    cases
}

fn case(group: Group, machine: Kind, manner: Manner, hidden: Vec<Planned>) -> Case {
    Case {
        number: 0,
        group,
        machine,
        manner,
        hidden,
        nuisances: USUAL,
    }
}

fn planned(effect: Effect, on: &str, level: f64, draw: &mut Draw) -> Planned {
    use Effect::{
        AsymmetricBacklash, AsymmetricFriction, ForceOffset, ForeignHum, ParameterShift,
        SensorBias, SensorGain, StiffnessNonlinearity, StiffnessVariation, TorqueRipple,
        TransmissionError, WeakeningDrive,
    };
    let either = match effect {
        AsymmetricFriction
        | ForceOffset
        | SensorGain
        | SensorBias
        | AsymmetricBacklash
        | StiffnessNonlinearity
        | WeakeningDrive => true,
        ParameterShift => !matches!(on, "b_m" | "F_v"),
        _ => false,
    };
    let order = match (effect, on) {
        (TorqueRipple, "theta") => draw.one_of(&[2.0, 3.0, 4.0]),
        (TorqueRipple, _) => draw.one_of(&[1.0, 2.0, 3.0, 4.0, 6.0]),
        (TransmissionError | StiffnessVariation, _) => draw.one_of(&[1.0, 2.0, 3.0, 27.0]),
        (ForeignHum, _) => draw.between(9.0, 14.0),
        _ => 0.0,
    };
    let sign = if either { draw.sign() } else { 1.0 };
    let hidden = Hidden {
        effect,
        on: on.to_owned(),
        order,
        sign,
        phase: draw.between(0.0, 2.0 * PI),
        amount: 0.0,
    };
    Planned {
        hidden,
        level,
        alike: alike(effect, on),
    }
}

/// What no record of these can tell from it.
fn alike(effect: Effect, on: &str) -> Vec<(String, String)> {
    let list: &[(&str, &str)] = match (effect, on) {
        // Only the sum of the plays' middles moves what is measured.
        (Effect::AsymmetricBacklash, "x_sp") => &[("asymmetric_backlash", "x_pr")],
        // E and I stand together everywhere.
        (Effect::ParameterShift, "E") => &[("parameter_shift", "I")],
        (Effect::ParameterShift, "m_c") => &[("parameter_shift", "m_p")],
        (Effect::ParameterShift, "a") => &[("parameter_shift", "g")],
        _ => &[],
    };
    let owned = list.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned()));
    owned.collect()
}

fn singles(draw: &mut Draw) -> Vec<Case> {
    use Effect::{
        AsymmetricBacklash, AsymmetricFriction, CoulombFriction, ElasticRestraint, ForceOffset,
        Gravity, JointCompliance, ParameterShift, QuadraticDrag, SensorBias, SensorDelay,
        SensorGain, StiffnessNonlinearity, StiffnessVariation, StribeckFriction, StructuralDamping,
        TipMass, TorqueRipple, TransmissionError, ViscousFriction,
    };
    use Kind::{Arm, Pendulum, Stage};
    let sun = (Arm, "theta_s");
    let carrier = (Arm, "theta_c");
    let (stage, pendulum) = ((Stage, "q"), (Pendulum, "theta"));
    let arm = (Arm, "arm");
    let mesh = (Arm, "x_sp");
    // Three places each, some more than once.
    let list: [(Effect, [(Kind, &str); 3]); 20] = [
        (
            CoulombFriction,
            [draw.one_of(&[sun, carrier]), stage, pendulum],
        ),
        (ViscousFriction, [carrier; 3]),
        (StribeckFriction, [carrier, stage, pendulum]),
        (AsymmetricFriction, [sun, stage, pendulum]),
        (QuadraticDrag, [sun, stage, pendulum]),
        (ForceOffset, [carrier, stage, pendulum]),
        (ElasticRestraint, [carrier, stage, pendulum]),
        (Gravity, [carrier; 3]),
        (TorqueRipple, [sun, sun, pendulum]),
        (StructuralDamping, [arm; 3]),
        (TipMass, [arm; 3]),
        (StiffnessNonlinearity, [arm; 3]),
        (JointCompliance, [arm; 3]),
        (TransmissionError, [mesh; 3]),
        (StiffnessVariation, [mesh; 3]),
        (AsymmetricBacklash, [mesh; 3]),
        (SensorDelay, [(Arm, "tip"), (Arm, "theta_s"), stage]),
        (SensorGain, [(Arm, "tip"), (Arm, "tip"), pendulum]),
        (SensorBias, [(Arm, "tip"), (Arm, "tip"), pendulum]),
        (ParameterShift, [(Arm, "m_c"), (Stage, "M"), (Stage, "F_v")]),
    ];
    let mut cases = Vec::new();
    for (index, (effect, places)) in list.into_iter().enumerate() {
        let mut levels = [0, 1, 2].map(|next| LEVELS[(index + 2 * next) % LEVELS.len()]);
        draw.shuffle(&mut levels);
        for ((machine, on), level) in places.into_iter().zip(levels) {
            let mut hidden = planned(effect, on, level, draw);
            // More of it would be a viscous friction beside it.
            if on == "F_v" {
                hidden.hidden.sign = -1.0;
            }
            cases.push(case(Group::Single, machine, Manner::Usual, vec![hidden]));
        }
    }
    cases
}

fn nothings() -> Vec<Case> {
    let none = Nuisances {
        declared: 0.0,
        bias: 0.0,
        gain: 0.0,
        delay: 0.0,
    };
    let kinds = [
        none,
        Nuisances {
            declared: 1.0,
            ..none
        },
        Nuisances { bias: 1.0, ..none },
        Nuisances { delay: 1.0, ..none },
        Nuisances {
            declared: 1.0,
            bias: 1.0,
            gain: 1.0,
            delay: 1.0,
        },
    ];
    let mut cases = Vec::new();
    for machine in [Kind::Arm, Kind::Stage, Kind::Pendulum] {
        for index in 0..10 {
            let mut made = case(Group::Nothing, machine, Manner::Usual, Vec::new());
            made.nuisances = kinds[index % kinds.len()];
            cases.push(made);
        }
    }
    cases
}

fn pairs(draw: &mut Draw) -> Vec<Case> {
    use Effect::{
        AsymmetricFriction, CoulombFriction, ElasticRestraint, ForceOffset, JointCompliance,
        QuadraticDrag, SensorBias, StribeckFriction, StructuralDamping, TipMass, TorqueRipple,
        ViscousFriction,
    };
    use Kind::{Arm, Pendulum, Stage};
    let list = [
        (
            Arm,
            (CoulombFriction, "theta_s"),
            (ViscousFriction, "theta_c"),
        ),
        (Arm, (TipMass, "arm"), (StructuralDamping, "arm")),
        (Arm, (CoulombFriction, "theta_c"), (TipMass, "arm")),
        (Arm, (TorqueRipple, "theta_s"), (CoulombFriction, "theta_c")),
        (Arm, (JointCompliance, "arm"), (CoulombFriction, "theta_s")),
        (
            Arm,
            (ElasticRestraint, "theta_c"),
            (QuadraticDrag, "theta_s"),
        ),
        (Stage, (CoulombFriction, "q"), (ForceOffset, "q")),
        (Stage, (CoulombFriction, "q"), (AsymmetricFriction, "q")),
        (Stage, (QuadraticDrag, "q"), (ForceOffset, "q")),
        (Stage, (CoulombFriction, "q"), (ElasticRestraint, "q")),
        (Stage, (CoulombFriction, "q"), (StribeckFriction, "q")),
        (
            Pendulum,
            (CoulombFriction, "theta"),
            (QuadraticDrag, "theta"),
        ),
        (Pendulum, (QuadraticDrag, "theta"), (ForceOffset, "theta")),
        (
            Pendulum,
            (CoulombFriction, "theta"),
            (TorqueRipple, "theta"),
        ),
        (Pendulum, (CoulombFriction, "theta"), (SensorBias, "theta")),
    ];
    let pair = |(machine, first, second): (Kind, (Effect, &str), (Effect, &str))| {
        let mut level = || draw.one_of(&[6.0, 10.0, 15.0]);
        let (one, other) = (level(), level());
        let hidden = vec![
            planned(first.0, first.1, one, draw),
            planned(second.0, second.1, other, draw),
        ];
        case(Group::Pair, machine, Manner::Usual, hidden)
    };
    list.map(pair).into()
}

fn outside(draw: &mut Draw) -> Vec<Case> {
    use Effect::{ForeignHum, WeakeningDrive, WornFriction};
    use Kind::{Arm, Pendulum, Stage};
    let list = [
        (Arm, WornFriction, "theta_c"),
        (Arm, ForeignHum, "theta_c"),
        (Arm, WeakeningDrive, "theta_s"),
        (Stage, WornFriction, "q"),
        (Stage, ForeignHum, "q"),
        (Stage, WeakeningDrive, "q"),
        (Pendulum, WornFriction, "theta"),
        (Pendulum, ForeignHum, "theta"),
    ];
    let strange = |(machine, effect, on): (Kind, Effect, &str)| {
        let hidden = vec![planned(effect, on, 10.0, draw)];
        case(Group::Outside, machine, Manner::Usual, hidden)
    };
    list.map(strange).into()
}

fn untellable(draw: &mut Draw) -> Vec<Case> {
    use Effect::{CoulombFriction, ElasticRestraint, ForceOffset, ParameterShift};
    use Kind::{Arm, Pendulum, Stage};
    let list = [
        (
            Stage,
            Manner::OneWay,
            CoulombFriction,
            "q",
            ("force_offset", "q"),
        ),
        (
            Stage,
            Manner::OneWay,
            ForceOffset,
            "q",
            ("coulomb_friction", "q"),
        ),
        (
            Arm,
            Manner::Gentle,
            ElasticRestraint,
            "theta_c",
            ("gravity", "theta_c"),
        ),
        (
            Arm,
            Manner::Usual,
            ParameterShift,
            "E",
            ("parameter_shift", "I"),
        ),
        (
            Arm,
            Manner::Usual,
            ParameterShift,
            "b_m",
            ("viscous_friction", "theta_s"),
        ),
        (
            Pendulum,
            Manner::Usual,
            ParameterShift,
            "a",
            ("parameter_shift", "g"),
        ),
        (
            Stage,
            Manner::Usual,
            ParameterShift,
            "F_v",
            ("viscous_friction", "q"),
        ),
    ];
    let unclear =
        |(machine, manner, effect, on, other): (Kind, Manner, Effect, &str, (&str, &str))| {
            let mut hidden = planned(effect, on, 10.0, draw);
            // Dry friction can only take the part of an offset that opposes the motion.
            if effect == ForceOffset {
                hidden.hidden.sign = -1.0;
            }
            let other = (other.0.to_owned(), other.1.to_owned());
            if !hidden.alike.contains(&other) {
                hidden.alike.push(other);
            }
            case(Group::Untellable, machine, manner, vec![hidden])
        };
    list.map(unclear).into()
}

#[cfg(test)]
mod tests {
    use super::{Group, plan};

    #[test]
    fn a_seed_makes_the_numbers_of_cases_that_are_promised() {
        let cases = plan(7);
        let of = |group| cases.iter().filter(|case| case.group == group).count();
        assert_eq!(of(Group::Single), 60);
        assert_eq!(of(Group::Nothing), 30);
        assert_eq!(of(Group::Pair), 15);
        assert_eq!(of(Group::Outside) + of(Group::Untellable), 15);
        assert!(
            cases
                .iter()
                .enumerate()
                .all(|(place, case)| case.number == place)
        );
        assert_eq!(cases, plan(7));
        assert_ne!(cases, plan(8));
    }
}
