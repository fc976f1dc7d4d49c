//! Claims of sections 3, 4.1 to 4.3 and 5 of the paper as data: text, place, rule and cases.
//!
//! The paper calls every motion quasi-periodic that is not chaotic. In the generous reading, such a claim holds for
//! regular motion: periodic or quasi-periodic. In the strict reading, which is counted separately, a periodic motion
//! contradicts the claim. The positioning error also has two readings: with the correct sign, and as printed.

use super::reading::{CaseKey, Forcing};

/// Rule that decides a claim, with its cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Regular motion.
    Regular(CaseKey),
    /// Chaotic motion.
    Chaotic(CaseKey),
    /// Regular motion at b = 10 um and chaotic motion at 100 um, without a return to regular motion in between.
    Route(Forcing),
    /// The greatest positioning error grows from each b to the next, 0 to 100 um, and by 5 % in total; a decrease of 1
    /// % is tolerated. The strict reading uses f_la of Eq. (24) as printed, a sum of opposed parts. In the generous
    /// reading, growth of the error dr - l dtheta of the end point suffices.
    ErrorGrows(Forcing),
    /// dr exceeds l dtheta, peak to peak and in RMS; undecided if the two measures disagree.
    DeflectionDominates(CaseKey),
    /// l dtheta exceeds dr, peak to peak and in RMS; undecided if the two measures disagree.
    TransmissionDominates(CaseKey),
    /// The ratio of l dtheta to dr, peak to peak, grows from each b to the next.
    ShareGrows(Forcing),
    /// This mode, counted from 1, has the largest vibration at the tip.
    DominantMode(CaseKey, usize),
    /// The mode with the largest vibration is not the same for all b > 0.
    ModeChanges(Forcing),
    /// Between b = 10 and 100 um, dr changes by less than a factor of 1.5 and by less than l dtheta, peak to peak and
    /// in RMS.
    DeflectionSteady(Forcing),
    /// For at least one b > 0 the motion is regular at one forcing frequency and chaotic at the
    /// other.
    FrequencyMatters,
    /// The rigid and the flexible arm have different kinds of motion.
    FlexibilityMatters,
    /// dr without backlash differs by less than 2 % between S = 4 and S = 5, peak to peak and in
    /// RMS.
    OrderSuffices,
}

/// Claim of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Name in tables and files.
    pub id: &'static str,
    /// Section and figure of the paper.
    pub place: &'static str,
    /// Claim in other words than the paper's.
    pub text: &'static str,
    /// Rule that decides the claim.
    pub rule: Rule,
}

/// Half-backlashes of the paper, um.
pub const HALF_BACKLASHES_UM: [u32; 5] = [0, 10, 25, 50, 100];

use Forcing::{FivePi, TenPi};

const fn at_five_pi(b: u32) -> CaseKey {
    CaseKey::flexible(FivePi, b)
}

const fn at_ten_pi(b: u32) -> CaseKey {
    CaseKey::flexible(TenPi, b)
}

const RIGID: CaseKey = CaseKey {
    order: 0,
    forcing: TenPi,
    micrometres: 100,
};

const fn claim(id: &'static str, place: &'static str, says: &'static str, rule: Rule) -> Claim {
    Claim {
        id,
        place,
        text: says,
        rule,
    }
}

/// Claims in the order of the paper.
#[rustfmt::skip]
pub const CLAIMS: [Claim; 30] = [
    claim("order", "Sec. 3, Fig. 4", "four modes are enough: five change the tip's motion little", Rule::OrderSuffices),
    claim("regular_5pi_10", "Sec. 4.2, Fig. 6", "quasi-periodic at 5 pi, b = 10 um", Rule::Regular(at_five_pi(10))),
    claim("regular_5pi_25", "Sec. 4.2, Fig. 7", "quasi-periodic at 5 pi, b = 25 um", Rule::Regular(at_five_pi(25))),
    claim("chaos_5pi_50", "Sec. 4.2, Fig. 8", "chaotic at 5 pi, b = 50 um", Rule::Chaotic(at_five_pi(50))),
    claim("chaos_5pi_100", "Sec. 4.2, Fig. 9", "chaotic at 5 pi, b = 100 um", Rule::Chaotic(at_five_pi(100))),
    claim("route_5pi", "Sec. 4.1; 5 (2)", "from quasi-periodic to chaotic as b grows, at 5 pi", Rule::Route(FivePi)),
    claim("error_5pi", "Sec. 4.1, Fig. 5-9", "the positioning error grows with b, at 5 pi", Rule::ErrorGrows(FivePi)),
    claim("small_b_5pi", "Sec. 4.1; 5 (3)", "the arm's deflection is the larger part of the error for small b (10 um, 5 pi)", Rule::DeflectionDominates(at_five_pi(10))),
    claim("large_b_5pi", "Sec. 4.1; 5 (3)", "the transmission error is the larger part for large b (100 um, 5 pi)", Rule::TransmissionDominates(at_five_pi(100))),
    claim("share_5pi", "Sec. 4.1; 5 (3)", "the ratio of transmission error to deflection grows with b, at 5 pi", Rule::ShareGrows(FivePi)),
    claim("mode_5pi_10", "Sec. 4.1, Fig. 10 (a)", "the first mode dominates dr at 5 pi, b = 10 um", Rule::DominantMode(at_five_pi(10), 1)),
    claim("mode_5pi_25", "Sec. 4.1, Fig. 10 (b)", "the first mode dominates dr at 5 pi, b = 25 um", Rule::DominantMode(at_five_pi(25), 1)),
    claim("mode_5pi_50", "Sec. 4.1, Fig. 10 (c)", "the first mode dominates dr at 5 pi, b = 50 um", Rule::DominantMode(at_five_pi(50), 1)),
    claim("mode_5pi_100", "Sec. 4.1, Fig. 10 (d)", "the third mode dominates dr at 5 pi, b = 100 um", Rule::DominantMode(at_five_pi(100), 3)),
    claim("regular_10pi_10", "Sec. 4.2, Fig. 12", "quasi-periodic at 10 pi, b = 10 um", Rule::Regular(at_ten_pi(10))),
    claim("chaos_10pi_25", "Sec. 4.2, Fig. 13", "chaotic at 10 pi, b = 25 um", Rule::Chaotic(at_ten_pi(25))),
    claim("chaos_10pi_50", "Sec. 4.2, Fig. 14", "chaotic at 10 pi, b = 50 um", Rule::Chaotic(at_ten_pi(50))),
    claim("chaos_10pi_100", "Sec. 4.2, Fig. 15", "chaotic at 10 pi, b = 100 um", Rule::Chaotic(at_ten_pi(100))),
    claim("route_10pi", "Sec. 5 (2)", "from quasi-periodic to chaotic as b grows, at 10 pi", Rule::Route(TenPi)),
    claim("frequency", "Sec. 4.2; 5 (2)", "the kind of motion depends on the forcing frequency", Rule::FrequencyMatters),
    claim("rigid_10pi_100", "Sec. 4.3, Fig. 19", "quasi-periodic with a rigid arm at 10 pi, b = 100 um", Rule::Regular(RIGID)),
    claim("flexibility", "Sec. 4.3; 5 (5)", "the arm's flexibility changes the kind of motion of the gears (10 pi, b = 100 um)", Rule::FlexibilityMatters),
    claim("error_10pi", "Sec. 5 (1), Fig. 11-15", "backlash impairs the positioning, at 10 pi", Rule::ErrorGrows(TenPi)),
    claim("small_b_10pi", "Sec. 5 (3)", "the deflection is the larger part for small b (10 um, 10 pi)", Rule::DeflectionDominates(at_ten_pi(10))),
    claim("large_b_10pi", "Sec. 5 (3)", "the transmission error is the larger part for large b (100 um, 10 pi)", Rule::TransmissionDominates(at_ten_pi(100))),
    claim("share_10pi", "Sec. 5 (3)", "the ratio of transmission error to deflection grows with b, at 10 pi", Rule::ShareGrows(TenPi)),
    claim("steady_5pi", "Sec. 5 (4)", "backlash changes the amplitude of the deflection little, at 5 pi", Rule::DeflectionSteady(FivePi)),
    claim("steady_10pi", "Sec. 5 (4)", "backlash changes the amplitude of the deflection little, at 10 pi", Rule::DeflectionSteady(TenPi)),
    claim("mode_changes_5pi", "Sec. 5 (4)", "the dominant mode depends on b, at 5 pi", Rule::ModeChanges(FivePi)),
    claim("mode_changes_10pi", "Sec. 5 (4)", "the dominant mode depends on b, at 10 pi", Rule::ModeChanges(TenPi)),
];

impl Claim {
    /// Returns the label in figures: the name, with the units of forcing frequency and half-backlash.
    pub fn label(&self) -> String {
        let mut words = Vec::new();
        let mut conditions = String::new();
        for part in self.id.split('_') {
            match (part.strip_suffix("pi"), part.parse::<u32>()) {
                (Some(multiple), _) => conditions.push_str(&format!(", {multiple}π rad/s")),
                (None, Ok(half_backlash)) => {
                    conditions.push_str(&format!(", {half_backlash} µm"));
                }
                (None, Err(_)) => words.push(part),
            }
        }
        words.join(" ") + &conditions
    }
}

impl Rule {
    /// Returns the cases that the rule needs.
    pub fn cases(self) -> Vec<CaseKey> {
        let all = |forcing, backlashes: &[u32]| -> Vec<CaseKey> {
            let keys = backlashes.iter().map(|b| CaseKey::flexible(forcing, *b));
            keys.collect()
        };
        match self {
            Self::Regular(key)
            | Self::Chaotic(key)
            | Self::DeflectionDominates(key)
            | Self::TransmissionDominates(key)
            | Self::DominantMode(key, _) => vec![key],
            Self::ErrorGrows(forcing) => all(forcing, &HALF_BACKLASHES_UM),
            Self::Route(forcing)
            | Self::ShareGrows(forcing)
            | Self::ModeChanges(forcing)
            | Self::DeflectionSteady(forcing) => all(forcing, &HALF_BACKLASHES_UM[1..]),
            Self::FrequencyMatters => {
                let mut keys = all(FivePi, &HALF_BACKLASHES_UM[1..]);
                keys.extend(all(TenPi, &HALF_BACKLASHES_UM[1..]));
                keys
            }
            Self::FlexibilityMatters => vec![RIGID, at_ten_pi(100)],
            Self::OrderSuffices => vec![
                at_five_pi(0),
                CaseKey {
                    order: 5,
                    ..at_five_pi(0)
                },
            ],
        }
    }
}

/// Returns the cases of all claims, each once, in a fixed order.
pub fn cases() -> Vec<CaseKey> {
    let mut keys: Vec<CaseKey> = CLAIMS.iter().flat_map(|claim| claim.rule.cases()).collect();
    keys.sort_unstable();
    keys.dedup();
    keys
}

#[cfg(test)]
mod tests {
    use super::CLAIMS;

    #[test]
    fn labels_have_words_and_units() {
        let label = |id: &str| {
            let claim = CLAIMS.iter().find(|claim| claim.id == id);
            claim.map(|claim| claim.label())
        };
        for (id, expected) in [
            ("order", "order"),
            ("regular_5pi_10", "regular, 5π rad/s, 10 µm"),
            ("small_b_10pi", "small b, 10π rad/s"),
        ] {
            assert_eq!(label(id).as_deref(), Some(expected));
        }
        assert!(CLAIMS.iter().all(|claim| !claim.label().contains('_')));
    }
}
