//! Which cases a seed makes: 60 with one effect, half of them with everything else off as the priors
//! say, 30 with nothing hidden, 15 with two and 15 with something outside the catalogue or that the
//! record cannot tell. Their order says
//! nothing of what they are.

mod lists;

use serde::{Deserialize, Serialize};

use crate::hidden::{Hidden, Sensors};
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
    /// Everything as the priors say.
    pub const FULL: Self = Self {
        declared: 1.0,
        bias: 1.0,
        gain: 1.0,
        delay: 1.0,
    };

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

/// The cases of a seed.
pub fn plan(seed: u64) -> Vec<Case> {
    let mut draw = Draw::new(seed, 0);
    let mut cases = lists::singles(seed, &mut draw);
    cases.extend(lists::nothings(seed));
    cases.extend(lists::pairs(seed, &mut draw));
    cases.extend(lists::outside(seed, &mut draw));
    cases.extend(lists::untellable(&mut draw));
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
    fn a_seed_makes_the_numbers_of_cases_that_are_promised() {
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
    fn half_of_the_singles_have_nuisances_at_full_priors() {
        let cases = plan(7);
        let singles = cases.iter().filter(|case| case.group == Group::Single);
        let full = singles.filter(|case| case.nuisances == Nuisances::FULL);
        assert_eq!(full.count(), 30);
        let pairs = cases.iter().filter(|case| case.group == Group::Pair);
        let full = pairs.filter(|case| case.nuisances == Nuisances::FULL);
        assert_eq!(full.count(), 7);
    }
}
