//! What is left of the gap, in noise floors, and whether that is so much that what is named may be
//! something else.

use std::collections::BTreeMap;

use crate::report::quantity::plain;
use crate::report::result::ChannelGap;
use crate::thresholds;

/// Of which model something is left.
#[derive(Clone, Copy)]
pub(crate) enum Stage {
    /// Of the model as it is.
    Before,
    /// Of the model with what was found.
    After,
}

/// What is left of the channel of which most is left on the records held out, in noise floors.
pub(crate) struct Left {
    /// So many times what a right model leaves.
    pub(crate) floors: f64,
    /// The same of the channel of which most is left on the training records.
    training: f64,
    channel: String,
    is_only: bool,
}

impl Left {
    /// What is left of the channels' gap.
    pub(crate) fn of(gap: &BTreeMap<String, ChannelGap>, stage: Stage) -> Self {
        let of = |gap: &ChannelGap| match (stage, gap.after) {
            (Stage::After, Some(after)) => after,
            _ => gap.before,
        };
        let floors = gap
            .iter()
            .map(|(name, gap)| (of(gap).test / gap.floor, name));
        let worst = floors.max_by(|a, b| a.0.total_cmp(&b.0));
        let (floors, channel) = worst.map_or((f64::NAN, String::new()), |(f, n)| (f, n.clone()));
        let training = gap.values().map(|gap| of(gap).train / gap.floor);
        Self {
            floors,
            training: training.fold(0.0, f64::max),
            channel,
            is_only: gap.len() < 2,
        }
    }

    /// Whether so much is left, on either set of records, that what is named may stand in for
    /// something else.
    pub(crate) fn is_much(&self) -> bool {
        let most = self.floors.max(self.training);
        most > thresholds::MAY_STAND_IN || !self.floors.is_finite()
    }

    /// That what is missing acts in the records held out alone: no search among records to learn from finds it.
    pub(crate) fn note(&self) -> Option<String> {
        let is_hidden = self.training < thresholds::CLOSE
            && self.floors > thresholds::MAY_STAND_IN
            && self.floors.is_finite();
        is_hidden.then(|| {
            format!(
                "the records to learn from leave {} noise floors, those held out {}: what is missing hardly acts in the \
                 first; list a record that shows it under `train`",
                counted(self.training),
                self.words()
            )
        })
    }

    /// As `1.2 noise floors in tip`.
    pub(crate) fn words(&self) -> String {
        let number = match self.floors {
            floors if floors.is_nan() => return "an unknown part".to_owned(),
            floors if floors.is_infinite() => return "a motion that cannot be followed".to_owned(),
            floors => counted(floors),
        };
        let of_training = match self.floors <= thresholds::MAY_STAND_IN && self.is_much() {
            true => format!(", {} on the training records", counted(self.training)),
            false => String::new(),
        };
        match self.is_only {
            true => format!("{number} noise floors{of_training}"),
            false => format!("{number} noise floors in {}{of_training}", self.channel),
        }
    }

    /// Behind `words`: what that means.
    pub(crate) fn meaning(&self) -> &'static str {
        match self.floors < thresholds::ONE_FLOOR {
            true => ", about what a right model leaves",
            false => "; a right model leaves one",
        }
    }
}

fn counted(floors: f64) -> String {
    match floors < 10.0 {
        true => format!("{floors:.1}"),
        false => plain(floors, 2),
    }
}
