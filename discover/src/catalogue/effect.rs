//! Effects as data: each a list of edits with placeholders.

use eomgen_model_spec::edit::Section;

/// An effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Its name in results.
    pub name: String,
    /// The kind of place it may have.
    pub site: SiteKind,
    /// What it is, as the end of a sentence.
    pub says: String,
    /// What would show it best.
    pub experiment: String,
    /// Whether it repeats with an angle, so that it is tried at several shaft orders.
    pub orders: bool,
    /// Whether it is tried with each load of a spring or of a pair of teeth.
    pub loads: bool,
    /// Its parameters, at least one.
    pub parameters: Vec<EffectParameter>,
    /// What it changes, at least one thing.
    pub edits: Vec<Change>,
    /// Whether it is from a user's file.
    pub is_own: bool,
}

/// The placeholder of a damper's term, in edits that replace it.
pub const DAMPER: &str = "damper";

/// The kinds of places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SiteKind {
    /// Anything that moves and can be held: an angle or a position.
    Axis,
    /// An angle.
    Angle,
    /// A pair of teeth with play.
    Mesh,
    /// A flexible body.
    Arm,
    /// A linear spring.
    Spring,
    /// An input.
    Input,
}

impl Effect {
    /// Whether it brings something that moves by itself.
    pub fn adds_states(&self) -> bool {
        let adds = |edit: &Change| matches!(edit, Change::State { .. } | Change::Coordinate { .. });
        self.edits.iter().any(adds)
    }

    /// Whether all that it does is to scale a spring's stiffness: a number of the model that is off does the
    /// same.
    pub fn scales_stiffness(&self) -> bool {
        let scales = |edit: &Change| matches!(edit, Change::Substitution { within: Within::Site, find, .. } if find == "{k}");
        self.site == SiteKind::Spring && self.edits.iter().all(scales)
    }
}

impl SiteKind {
    /// The kinds by their words in a file.
    pub const WORDS: [(&'static str, Self); 6] = [
        ("axis", Self::Axis),
        ("angle", Self::Angle),
        ("mesh", Self::Mesh),
        ("arm", Self::Arm),
        ("spring", Self::Spring),
        ("input", Self::Input),
    ];

    /// The placeholders that a site of this kind fills; `{root}`, `{stiffness}` and a spring's `{k}`
    /// where it has them.
    pub fn placeholders(self) -> &'static [&'static str] {
        match self {
            Self::Axis | Self::Angle => &["on", "unit", "force"],
            Self::Mesh => &["on", "p", "unit", "k", "b"],
            Self::Arm => &[
                "term",
                "velocity",
                "field",
                "x",
                "end",
                "lever",
                "root",
                "stiffness",
            ],
            Self::Spring => &["on", "p", "unit", "force", "k"],
            Self::Input => &["on", "unit"],
        }
    }
}

/// A parameter of an effect.
#[derive(Clone, Debug)]
pub struct EffectParameter {
    /// Its name, with more behind it where that is taken.
    pub name: String,
    /// Its unit, with placeholders.
    pub unit: String,
    /// Whether it must not be negative.
    pub positive: bool,
    /// What it is.
    pub doc: String,
    /// The effect is absent where it is infinite, not where it is 0.
    pub inverse: bool,
    /// How large it is at first, where it shapes the effect without scaling it.
    pub shape: Option<Shape>,
}

/// A parameter that shapes an effect: a part of how the site moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Of what of the motion.
    pub scale: Scale,
    /// So much.
    pub share: f64,
}

/// What of a site's motion a shape is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Its usual rate.
    Rate,
    /// How far it goes from 0.
    Travel,
}

impl Scale {
    /// The scales by their words in a file.
    pub const WORDS: [(&'static str, Self); 2] = [("rate", Self::Rate), ("travel", Self::Travel)];
}

/// One change of the specification.
#[derive(Clone, Debug)]
pub enum Change {
    /// A term of an energy or of the dissipation.
    Term {
        /// Which of them.
        section: Section,
        /// Its name.
        name: String,
        /// Its expression.
        value: String,
    },
    /// A definition, to be used by other changes.
    Definition {
        /// Its name, which is a placeholder of the effect.
        name: String,
        /// Its expression.
        value: String,
    },
    /// A force.
    Force {
        /// Its name.
        name: String,
        /// What it works on.
        on: String,
        /// Its expression.
        value: String,
    },
    /// A coordinate.
    Coordinate {
        /// Its name, which is a placeholder of the effect.
        name: String,
        /// Its unit.
        unit: String,
        /// What it is.
        doc: String,
    },
    /// A state of first order.
    State {
        /// Its name, which is a placeholder of the effect.
        name: String,
        /// Its unit.
        unit: String,
        /// Its rate.
        rate: String,
        /// What it is.
        doc: String,
    },
    /// Something replaced.
    Substitution {
        /// Where.
        within: Within,
        /// What.
        find: String,
        /// By what.
        replace: String,
    },
}

/// Where something is replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Within {
    /// These terms of the kinetic energy.
    Kinetic(Vec<String>),
    /// All terms of a pair of teeth, that of a spring, or of the kinetic energy of a body and of what it
    /// carries.
    Site,
    /// The dampers beside a spring, each by itself.
    Dampers,
    /// All definitions and observables.
    Measured,
    /// Wherever an input stands.
    Input,
}
