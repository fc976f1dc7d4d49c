//! Lists of effects and sites for the cases.

use std::f64::consts::PI;

use super::{Case, Group, Nuisances, PlannedEffect};
use crate::hidden::{Effect, HiddenEffect};
use crate::inputs::Excitation;
use crate::machines::Kind;
use crate::machines::two_bodies::Form;
use crate::random::RandomStream;

/// True parameters deviate according to their priors, biases by a fifth of their priors. There are
/// no other sensor errors.
const USUAL_NUISANCES: Nuisances = Nuisances {
    declared: 1.0,
    bias: 0.2,
    gain: 0.0,
    delay: 0.0,
};

/// Sizes of single effects, in noise floors: one that is hard to detect, the smallest that must be
/// found, and three larger ones.
const LEVELS: [f64; 5] = [1.5, 3.0, 6.0, 15.0, 60.0];

fn case(group: Group, machine: Kind, manner: Excitation, hidden: Vec<PlannedEffect>) -> Case {
    Case {
        number: 0,
        group,
        machine,
        manner,
        hidden,
        nuisances: USUAL_NUISANCES,
    }
}

fn plan_effect(effect: Effect, on: &str, level: f64, draw: &mut RandomStream) -> PlannedEffect {
    use Effect::{
        AsymmetricBacklash, AsymmetricFriction, EndStop, ForceOffset, ForeignHum, InputGain,
        ParameterShift, SensorBias, SensorGain, StiffnessNonlinearity, StiffnessVariation,
        TorqueRipple, TransmissionError, WeakeningDrive,
    };
    let either = match effect {
        AsymmetricFriction
        | ForceOffset
        | SensorGain
        | SensorBias
        | AsymmetricBacklash
        | StiffnessNonlinearity
        | EndStop
        | InputGain
        | WeakeningDrive => true,
        ParameterShift => !matches!(on, "b_m" | "F_v"),
        _ => false,
    };
    let order = match (effect, on) {
        (TorqueRipple, "theta_m") => draw.one_of(&[1.0, 2.0, 5.0, 7.0, 11.0]),
        (TorqueRipple, "theta") => draw.one_of(&[2.0, 3.0, 4.0]),
        (TorqueRipple, _) => draw.one_of(&[1.0, 2.0, 3.0, 4.0, 6.0]),
        (TransmissionError | StiffnessVariation, _) => draw.one_of(&[1.0, 2.0, 3.0, 27.0]),
        (ForeignHum, _) => draw.between(9.0, 14.0),
        _ => 0.0,
    };
    let drawn = if either { draw.sign() } else { 1.0 };
    let sign = match (effect, on) {
        // The hidden law of a spring can only harden.
        (StiffnessNonlinearity, on) if on != "arm" => 1.0,
        _ => drawn,
    };
    let hidden = HiddenEffect {
        effect,
        on: on.to_owned(),
        order,
        sign,
        phase: draw.between(0.0, 2.0 * PI),
        amount: 0.0,
    };
    PlannedEffect {
        hidden,
        level,
        inseparable: list_inseparable(effect, on, order),
    }
}

/// Returns the effects that are inseparable from a hidden effect.
fn list_inseparable(effect: Effect, on: &str, order: f64) -> Vec<(String, String)> {
    if effect == Effect::TorqueRipple && order == 1.0 {
        // An unbalanced weight on any rotating body.
        return vec![("gravity".to_owned(), on.to_owned())];
    }
    let list: &[(&str, &str)] = match (effect, on) {
        // A torque ripple of order 1.
        (Effect::Gravity, "theta_c") => &[("torque_ripple", "theta_c")],
        // Only the sum of the offsets of both plays is observable.
        (Effect::AsymmetricBacklash, "x_sp") => &[("asymmetric_backlash", "x_pr")],
        // Only the product E I occurs.
        (Effect::ParameterShift, "E") => &[("parameter_shift", "I")],
        (Effect::ParameterShift, "m_c") => &[("parameter_shift", "m_p")],
        (Effect::ParameterShift, "a") => &[("parameter_shift", "g"), ("gravity", "theta")],
        // Far from the upright position, the torque of a spring to this position is nearly
        // constant.
        (Effect::ForceOffset, "theta") => &[("elastic_restraint", "theta")],
        (Effect::ElasticRestraint, "theta") => &[("force_offset", "theta")],
        // A bias of the encoder is equivalent to a rotated direction of gravity.
        (Effect::SensorBias, "theta") => &[("gravity", "theta")],
        _ => &[],
    };
    let owned = list.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned()));
    owned.collect()
}

fn two_bodies(seed: u64) -> [Kind; 3] {
    [Form::TwoMass, Form::Crane, Form::QuarterCar].map(|form| Kind::TwoBodies { form, seed })
}

/// Returns cases with each single effect of the catalogue. In every second case, the nuisances
/// deviate by their full priors.
pub fn single_effects(seed: u64, draw: &mut RandomStream) -> Vec<Case> {
    use Effect::{
        AsymmetricBacklash, AsymmetricFriction, Backlash, CoulombFriction, ElasticRestraint,
        EndStop, EndStops, ForceOffset, Gravity, InputGain, JointCompliance, ParameterShift,
        QuadraticDrag, SensorBias, SensorDelay, SensorGain, StiffnessNonlinearity,
        StiffnessVariation, StribeckFriction, StructuralDamping, TipMass, TorqueRipple,
        TransmissionError, ViscousFriction,
    };
    use Kind::{Arm, Pendulum, Stage};
    let sun = (Arm, "theta_s");
    let carrier = (Arm, "theta_c");
    let (stage, pendulum) = ((Stage, "q"), (Pendulum, "theta"));
    let arm = (Arm, "arm");
    let mesh = (Arm, "x_sp");
    let either = |one, other, draw: &mut RandomStream| draw.one_of(&[one, other]);
    let list: [(Effect, [(Kind, &str); 2]); 20] = [
        (
            CoulombFriction,
            [either(sun, carrier, draw), either(stage, pendulum, draw)],
        ),
        (ViscousFriction, [carrier; 2]),
        (StribeckFriction, [carrier, either(stage, pendulum, draw)]),
        (AsymmetricFriction, [sun, either(stage, pendulum, draw)]),
        (QuadraticDrag, [sun, either(stage, pendulum, draw)]),
        (ForceOffset, [carrier, either(stage, pendulum, draw)]),
        (ElasticRestraint, [carrier, either(stage, pendulum, draw)]),
        (Gravity, [carrier, arm]),
        (TorqueRipple, [sun, pendulum]),
        (StructuralDamping, [arm; 2]),
        (TipMass, [arm; 2]),
        (StiffnessNonlinearity, [arm; 2]),
        (JointCompliance, [arm; 2]),
        (TransmissionError, [mesh; 2]),
        (StiffnessVariation, [mesh; 2]),
        (AsymmetricBacklash, [mesh; 2]),
        (SensorDelay, [(Arm, "tip"), stage]),
        (SensorGain, [(Arm, "tip"), pendulum]),
        (SensorBias, [(Arm, "tip"), pendulum]),
        (
            ParameterShift,
            [(Arm, "m_c"), draw.one_of(&[(Stage, "M"), (Stage, "F_v")])],
        ),
    ];
    let [drive, crane, car] = two_bodies(seed);
    let further: [(Effect, Kind, &str); 20] = [
        (CoulombFriction, drive, "theta_m"),
        (CoulombFriction, drive, "theta_l"),
        (ViscousFriction, drive, "theta_l"),
        (TorqueRipple, drive, "theta_m"),
        (Backlash, drive, "shaft"),
        (Backlash, drive, "shaft"),
        (StiffnessNonlinearity, drive, "shaft"),
        (ParameterShift, drive, draw.one_of(&["J_m", "k"])),
        (InputGain, drive, "u"),
        (CoulombFriction, crane, "x"),
        (QuadraticDrag, crane, "theta"),
        (ElasticRestraint, crane, "x"),
        (ParameterShift, crane, draw.one_of(&["M", "l"])),
        (InputGain, crane, "F"),
        (CoulombFriction, car, "travel"),
        (AsymmetricFriction, car, "travel"),
        (StiffnessNonlinearity, car, "suspension"),
        (EndStop, car, "suspension"),
        (EndStops, car, "suspension"),
        (ParameterShift, car, draw.one_of(&["k_t", "m_w"])),
    ];
    let mut wanted = Vec::new();
    for (index, (effect, places)) in list.into_iter().enumerate() {
        let mut levels = [0, 1].map(|next| LEVELS[(index + 2 * next) % LEVELS.len()]);
        draw.shuffle(&mut levels);
        let both = places.into_iter().zip(levels);
        wanted.extend(both.map(|((machine, on), level)| (effect, machine, on, level)));
    }
    for (index, (effect, machine, on)) in further.into_iter().enumerate() {
        wanted.push((effect, machine, on, LEVELS[(2 * index + 1) % LEVELS.len()]));
    }
    let single = |(number, (effect, machine, on, level)): (usize, (Effect, Kind, &str, f64))| {
        let mut hidden = plan_effect(effect, on, level, draw);
        // A larger value would be equivalent to viscous friction.
        if on == "F_v" {
            hidden.hidden.sign = -1.0;
        }
        let mut made = case(Group::Single, machine, Excitation::Usual, vec![hidden]);
        if number % 2 == 1 {
            made.nuisances = Nuisances::FULL;
        }
        made
    };
    wanted.into_iter().enumerate().map(single).collect()
}

/// Returns cases without hidden effects, with all nuisances.
pub fn without_effects(seed: u64) -> Vec<Case> {
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
        Nuisances::FULL,
    ];
    let mut cases = Vec::new();
    let [drive, crane, car] = two_bodies(seed);
    for machine in [Kind::Arm, Kind::Stage, Kind::Pendulum, drive, crane, car] {
        for index in 0..5 {
            let mut made = case(Group::Nothing, machine, Excitation::Usual, Vec::new());
            made.nuisances = kinds[index % kinds.len()];
            cases.push(made);
        }
    }
    cases
}

type EffectAtSite<'a> = (Effect, &'a str);

/// Returns cases with two large effects.
pub fn effect_pairs(seed: u64, draw: &mut RandomStream) -> Vec<Case> {
    use Effect::{
        AsymmetricFriction, Backlash, CoulombFriction, ElasticRestraint, EndStop, ForceOffset,
        QuadraticDrag, SensorBias, StiffnessNonlinearity, StructuralDamping, TipMass, TorqueRipple,
        ViscousFriction,
    };
    use Kind::{Arm, Pendulum, Stage};
    let [drive, crane, car] = two_bodies(seed);
    let list = [
        (drive, (CoulombFriction, "theta_l"), (Backlash, "shaft")),
        (
            drive,
            (ViscousFriction, "theta_l"),
            (TorqueRipple, "theta_m"),
        ),
        (crane, (CoulombFriction, "x"), (QuadraticDrag, "theta")),
        (car, (CoulombFriction, "travel"), (EndStop, "suspension")),
        (
            car,
            (AsymmetricFriction, "travel"),
            (StiffnessNonlinearity, "suspension"),
        ),
        (
            Arm,
            (CoulombFriction, "theta_s"),
            (ViscousFriction, "theta_c"),
        ),
        (Arm, (TipMass, "arm"), (StructuralDamping, "arm")),
        (Arm, (CoulombFriction, "theta_c"), (TipMass, "arm")),
        (Arm, (TorqueRipple, "theta_s"), (CoulombFriction, "theta_c")),
        (
            Arm,
            (ElasticRestraint, "theta_c"),
            (QuadraticDrag, "theta_s"),
        ),
        (Stage, (CoulombFriction, "q"), (ForceOffset, "q")),
        (Stage, (QuadraticDrag, "q"), (ForceOffset, "q")),
        (Stage, (CoulombFriction, "q"), (ElasticRestraint, "q")),
        (
            Pendulum,
            (CoulombFriction, "theta"),
            (QuadraticDrag, "theta"),
        ),
        (Pendulum, (CoulombFriction, "theta"), (SensorBias, "theta")),
    ];
    let pair = |(number, (machine, first, second)): (
        usize,
        (Kind, EffectAtSite<'_>, EffectAtSite<'_>),
    )| {
        let mut level = || draw.one_of(&[6.0, 10.0, 15.0]);
        let (one, other) = (level(), level());
        let hidden = vec![
            plan_effect(first.0, first.1, one, draw),
            plan_effect(second.0, second.1, other, draw),
        ];
        let mut made = case(Group::Pair, machine, Excitation::Usual, hidden);
        if number % 2 == 1 {
            made.nuisances = Nuisances::FULL;
        }
        made
    };
    list.into_iter().enumerate().map(pair).collect()
}

/// Returns cases with effects outside the catalogue.
pub fn outside_catalogue(seed: u64, draw: &mut RandomStream) -> Vec<Case> {
    use Effect::{ForeignHum, WeakeningDrive, WornFriction};
    use Kind::{Arm, Pendulum, Stage};
    let [drive, crane, car] = two_bodies(seed);
    let list = [
        (Arm, WornFriction, "theta_c"),
        (Arm, WeakeningDrive, "theta_s"),
        (Stage, WornFriction, "q"),
        (Stage, ForeignHum, "q"),
        (Pendulum, WornFriction, "theta"),
        (drive, ForeignHum, "theta_l"),
        (crane, WeakeningDrive, "x"),
        (car, WornFriction, "travel"),
    ];
    let strange = |(machine, effect, on): (Kind, Effect, &str)| {
        let hidden = vec![plan_effect(effect, on, 10.0, draw)];
        case(Group::Outside, machine, Excitation::Usual, hidden)
    };
    list.map(strange).into()
}

/// Returns cases with effects that are inseparable from others.
pub fn inseparable_effects(draw: &mut RandomStream) -> Vec<Case> {
    use Effect::{CoulombFriction, ElasticRestraint, ForceOffset, ParameterShift};
    use Kind::{Arm, Pendulum, Stage};
    let list = [
        (
            Stage,
            Excitation::OneWay,
            CoulombFriction,
            "q",
            ("force_offset", "q"),
        ),
        (
            Stage,
            Excitation::OneWay,
            ForceOffset,
            "q",
            ("coulomb_friction", "q"),
        ),
        (
            Arm,
            Excitation::Gentle,
            ElasticRestraint,
            "theta_c",
            ("gravity", "theta_c"),
        ),
        (
            Arm,
            Excitation::Usual,
            ParameterShift,
            "E",
            ("parameter_shift", "I"),
        ),
        (
            Arm,
            Excitation::Usual,
            ParameterShift,
            "b_m",
            ("viscous_friction", "theta_s"),
        ),
        (
            Pendulum,
            Excitation::Usual,
            ParameterShift,
            "a",
            ("parameter_shift", "g"),
        ),
        (
            Stage,
            Excitation::Usual,
            ParameterShift,
            "F_v",
            ("viscous_friction", "q"),
        ),
    ];
    let unclear =
        |(machine, manner, effect, on, other): (Kind, Excitation, Effect, &str, (&str, &str))| {
            let mut hidden = plan_effect(effect, on, 10.0, draw);
            // Dry friction can only imitate the component of an offset that opposes the motion.
            if effect == ForceOffset {
                hidden.hidden.sign = -1.0;
            }
            let other = (other.0.to_owned(), other.1.to_owned());
            if !hidden.inseparable.contains(&other) {
                hidden.inseparable.push(other);
            }
            case(Group::Untellable, machine, manner, vec![hidden])
        };
    list.map(unclear).into()
}
