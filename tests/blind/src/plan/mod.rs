//! Cases of a seed in random order: 60 with one effect, half of them with all nuisances; 30 without
//! hidden effects; 15 with two effects; 15 with effects outside the catalogue or with inseparable
//! effects.

mod lists;

use serde::{Deserialize, Serialize};

use crate::hidden::{HiddenEffect, Sensors};
use crate::inputs::Excitation;
use crate::machines::{Kind, Machine, Setup};
use crate::random::RandomStream;

/// Group of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// One effect of the catalogue.
    Single,
    /// No hidden effect.
    Nothing,
    /// Two effects of the catalogue.
    Pair,
    /// Effect outside the catalogue.
    Outside,
    /// Effect that is inseparable from another effect.
    Untellable,
}

/// Planned effect.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedEffect {
    /// Effect; its size is determined later.
    pub hidden: HiddenEffect,
    /// Size in noise floors.
    pub level: f64,
    /// Effects that are inseparable from the hidden effect, with their sites.
    pub inseparable: Vec<(String, String)>,
}

/// Machine with its excitation and hidden effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Number of the case, counted from 0.
    pub number: usize,
    /// Group.
    pub group: Group,
    /// Machine.
    pub machine: Kind,
    /// Excitation.
    pub manner: Excitation,
    /// Hidden effects.
    pub hidden: Vec<PlannedEffect>,
    /// Deviations that are not effects.
    pub nuisances: Nuisances,
}

/// Deviations that are not effects. Each factor scales the deviations of declared parameters,
/// biases, gains or delays, in standard deviations of the priors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nuisances {
    declared: f64,
    bias: f64,
    gain: f64,
    delay: f64,
}

impl Nuisances {
    /// Deviations by the full priors.
    pub const FULL: Self = Self {
        declared: 1.0,
        bias: 1.0,
        gain: 1.0,
        delay: 1.0,
    };

    /// Draws the deviations, within two standard deviations. Returns the true values of the
    /// declared parameters.
    pub fn draw(
        &self,
        setup: &Setup,
        machine: &mut Machine,
        sensors: &mut Sensors,
        draw: &mut RandomStream,
    ) -> Vec<(String, f64)> {
        let mut declared = Vec::new();
        for (name, relative) in &setup.uncertain {
            let factor = 1.0 + relative * self.declared * draw.normal_within_two();
            machine.scale(name, factor);
            declared.push(((*name).to_owned(), factor));
        }
        // Without an input, a delay is equivalent to an earlier initial state and is not drawn.
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
    /// Returns true if the motions start at rest.
    pub fn starts_at_rest(&self) -> bool {
        self.machine != Kind::Pendulum && self.manner != Excitation::OneWay
    }
}

/// Returns all cases of a seed.
pub fn plan(seed: u64) -> Vec<Case> {
    let mut draw = RandomStream::new(seed, 0);
    let mut cases = lists::single_effects(seed, &mut draw);
    cases.extend(lists::without_effects(seed));
    cases.extend(lists::effect_pairs(seed, &mut draw));
    cases.extend(lists::outside_catalogue(seed, &mut draw));
    cases.extend(lists::inseparable_effects(&mut draw));
    draw.shuffle(&mut cases);
    for (number, case) in cases.iter_mut().enumerate() {
        case.number = number;
    }
    cases
}

#[cfg(test)]
mod tests {
    use super::{Group, Nuisances, plan};
    use crate::machines::Kind;

    #[test]
    fn plan_has_the_documented_numbers_of_cases() {
        let cases = plan(7);
        let of = |group| cases.iter().filter(|case| case.group == group).count();
        assert_eq!(of(Group::Single), 60);
        assert_eq!(of(Group::Nothing), 30);
        assert_eq!(of(Group::Pair), 15);
        assert_eq!(of(Group::Outside) + of(Group::Untellable), 15);
        let drawn = |case: &&super::Case| matches!(case.machine, Kind::TwoBodies { .. });
        assert_eq!(cases.iter().filter(drawn).count(), 20 + 15 + 5 + 3);
        assert!(
            cases
                .iter()
                .enumerate()
                .all(|(place, case)| case.number == place)
        );
        assert_eq!(cases, plan(7));
        assert_ne!(cases, plan(8));
    }

    #[test]
    fn half_of_single_cases_have_full_nuisances() {
        let cases = plan(7);
        let singles = cases.iter().filter(|case| case.group == Group::Single);
        let full = singles.filter(|case| case.nuisances == Nuisances::FULL);
        assert_eq!(full.count(), 30);
        let pairs = cases.iter().filter(|case| case.group == Group::Pair);
        let full = pairs.filter(|case| case.nuisances == Nuisances::FULL);
        assert_eq!(full.count(), 7);
    }
}
