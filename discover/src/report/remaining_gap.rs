//! Remaining gap in noise floors, and the limit above which the name of an effect is provisional.

use std::collections::BTreeMap;

use crate::report::quantity::format_number;
use crate::report::result::ChannelGap;
use crate::thresholds;

/// Model whose gap is reported.
#[derive(Clone, Copy)]
pub(crate) enum ModelStage {
    /// The original model.
    Original,
    /// The model with the found effects.
    Extended,
}

/// Gap of the channel with the largest gap on the held-out records.
pub(crate) struct RemainingGap {
    /// Gap on the held-out records, in noise floors.
    pub(crate) floors: f64,
    /// Largest gap of a channel on the training records, in noise floors.
    training: f64,
    channel: String,
    is_only: bool,
}

impl RemainingGap {
    /// Finds the channel with the largest remaining gap.
    pub(crate) fn from_channels(gap: &BTreeMap<String, ChannelGap>, stage: ModelStage) -> Self {
        let of = |gap: &ChannelGap| match (stage, gap.after) {
            (ModelStage::Extended, Some(after)) => after,
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

    /// Returns true if the gap on either set of records is so large that another effect may be
    /// missing.
    pub(crate) fn is_large(&self) -> bool {
        let most = self.floors.max(self.training);
        most > thresholds::MAX_FLOORS_FOR_CERTAINTY || !self.floors.is_finite()
    }

    /// Returns a note if the missing effect acts in the held-out records only. A search in the
    /// training records cannot find it.
    pub(crate) fn note_missing_in_training(&self) -> Option<String> {
        let is_hidden = self.training < thresholds::MAX_FLOOR_RATIO_TO_STOP
            && self.floors > thresholds::MAX_FLOORS_FOR_CERTAINTY
            && self.floors.is_finite();
        is_hidden.then(|| {
            format!(
                "the training residual is {} noise floors, the held-out residual {}: the missing effect hardly \
                 acts in the training records; add a record that shows it to `train`",
                format_floors(self.training),
                self.describe()
            )
        })
    }

    /// Returns the gap in words, for example `1.2 noise floors in tip`.
    pub(crate) fn describe(&self) -> String {
        let number = match self.floors {
            floors if floors.is_nan() => return "an unknown number of noise floors".to_owned(),
            floors if floors.is_infinite() => {
                return "infinitely many noise floors (the simulation fails)".to_owned();
            }
            floors => format_floors(floors),
        };
        let of_training =
            match self.floors <= thresholds::MAX_FLOORS_FOR_CERTAINTY && self.is_large() {
                true => format!(", {} on the training records", format_floors(self.training)),
                false => String::new(),
            };
        match self.is_only {
            true => format!("{number} noise floors{of_training}"),
            false => format!("{number} noise floors in {}{of_training}", self.channel),
        }
    }

    /// Describes the decrease of the gap to that of another model. If the largest gaps are in
    /// different channels, both are named.
    pub(crate) fn describe_fall_to(&self, after: &Self) -> String {
        let is_number = self.floors.is_finite() && after.floors.is_finite();
        let (before, left) = (self.describe(), after.describe());
        match (self.is_only, self.channel == after.channel && is_number) {
            (true, _) => format!("The residual fell from {before} to {left}"),
            (false, true) => format!(
                "The residual of {} fell from {} noise floors to {} noise floors",
                self.channel,
                format_floors(self.floors),
                format_floors(after.floors)
            ),
            (false, false) => {
                format!("The largest residual of a channel fell from {before} to {left}")
            }
        }
    }

    /// Returns an explanation to be appended to the text of `describe`.
    pub(crate) fn explain_level(&self) -> &'static str {
        match self.floors < thresholds::MAX_FLOORS_OF_CORRECT_MODEL {
            true => ", the level of a correct model",
            false => " (1 = a correct model)",
        }
    }
}

/// Formats a number of noise floors.
pub(crate) fn format_floors(floors: f64) -> String {
    match floors < 10.0 {
        true => format!("{floors:.1}"),
        false => format_number(floors, 3),
    }
}
