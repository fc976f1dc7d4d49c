//! Effects as data: lists of edits with placeholders.

use eomgen_model_spec::edit::Section;

/// An effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Name in results.
    pub name: String,
    /// Kind of its sites.
    pub site_kind: SiteKind,
    /// Description, as the end of a sentence.
    pub description: String,
    /// Experiment that shows it best.
    pub experiment: String,
    /// True if the effect is periodic in an angle and tried at several shaft orders.
    pub has_orders: bool,
    /// True if the effect is tried with the load of each spring or mesh.
    pub has_loads: bool,
    /// Parameters, at least one.
    pub parameters: Vec<EffectParameter>,
    /// Edits, at least one.
    pub edits: Vec<Change>,
    /// True if the effect is from a file of the user.
    pub is_user_defined: bool,
}

/// Returns names of effects in words, such as `Coulomb friction` for `coulomb_friction`.
pub fn effect_in_words(name: &str) -> String {
    let name = name.replace("coulomb_", "Coulomb ");
    name.replace("stribeck_", "Stribeck ").replace('_', " ")
}

/// Placeholder of the term of a damper in edits that replace it.
pub const DAMPER_PLACEHOLDER: &str = "damper";

/// Kind of a site.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SiteKind {
    /// A movable angle or position.
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
    /// The whole machine.
    Machine,
}

impl Effect {
    /// Returns true if the effect adds a coordinate or a state.
    pub fn adds_states(&self) -> bool {
        let adds = |edit: &Change| matches!(edit, Change::State { .. } | Change::Coordinate { .. });
        self.edits.iter().any(adds)
    }

    /// Returns true if a linearisation at one size or shape does not show the effect, so that only a
    /// scan finds it: a memory with a shape, such as the yielding of bristles, or a dead zone of an
    /// input. An effect of the user is always tested.
    pub fn is_only_scanned(&self) -> bool {
        let adds_state = |edit: &Change| matches!(edit, Change::State { .. });
        let has_shape = |parameter: &EffectParameter| parameter.shape.is_some();
        let has_memory = self.edits.iter().any(adds_state) && self.parameters.iter().any(has_shape);
        let substitutes = |edit: &Change| matches!(edit, Change::Substitution { .. });
        let has_dead_zone = self.site_kind == SiteKind::Input && self.edits.iter().all(substitutes);
        !self.is_user_defined && (has_memory || has_dead_zone)
    }

    /// Returns true if the effect states a part of a force that is linear between switches.
    pub(super) fn states_linear_part(&self) -> bool {
        let states = |edit: &Change| {
            matches!(
                edit,
                Change::Force {
                    linear: Some(_),
                    ..
                }
            )
        };
        self.edits.iter().any(states)
    }

    /// Returns true if the effect only scales the stiffness of a spring. A shifted parameter does
    /// the same.
    pub fn scales_stiffness(&self) -> bool {
        let scales = |edit: &Change| matches!(edit, Change::Substitution { scope: SubstitutionScope::Site, pattern, .. } if pattern == "{k}");
        self.site_kind == SiteKind::Spring && self.edits.iter().all(scales)
    }
}

impl SiteKind {
    /// Kinds by their keywords in a file.
    pub const KEYWORDS: [(&'static str, Self); 7] = [
        ("axis", Self::Axis),
        ("angle", Self::Angle),
        ("mesh", Self::Mesh),
        ("arm", Self::Arm),
        ("spring", Self::Spring),
        ("input", Self::Input),
        ("machine", Self::Machine),
    ];

    /// Returns the placeholders of a site of this kind. `{root}`, `{stiffness}`, the `{k}` of a
    /// spring and each moment of a machine exist only at some sites.
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
            Self::Machine => &["moment_x", "moment_y", "moment_z"],
        }
    }
}

/// Parameter of an effect.
#[derive(Clone, Debug)]
pub struct EffectParameter {
    /// Name; a suffix is added if the name is used already.
    pub name: String,
    /// Unit, with placeholders.
    pub unit: String,
    /// True if the value must not be negative.
    pub is_positive: bool,
    /// Description.
    pub doc: String,
    /// True if the effect vanishes at infinity instead of 0.
    pub is_inverse: bool,
    /// Initial size of a parameter that shapes the effect without scaling it.
    pub shape: Option<Shape>,
}

/// Initial size of a shape parameter: a fraction of the motion of the site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Quantity that sets the scale.
    pub quantity: ShapeScale,
    /// Fraction of that quantity.
    pub fraction: f64,
}

/// Quantity of the motion of a site.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeScale {
    /// Usual rate.
    Rate,
    /// Largest distance from 0.
    Travel,
    /// Largest positive value.
    PositiveTravel,
    /// Largest absolute value of a negative position.
    NegativeTravel,
}

impl ShapeScale {
    /// Scales by their keywords in a file.
    pub const KEYWORDS: [(&'static str, Self); 4] = [
        ("rate", Self::Rate),
        ("travel", Self::Travel),
        ("positive_travel", Self::PositiveTravel),
        ("negative_travel", Self::NegativeTravel),
    ];
}

/// A change of the specification.
#[derive(Clone, Debug)]
pub enum Change {
    /// A term of an energy or of the dissipation.
    Term {
        /// Section of the term.
        section: Section,
        /// Name.
        name: String,
        /// Expression.
        value: String,
    },
    /// A definition for other changes.
    Definition {
        /// Name, which is also a placeholder of the effect.
        name: String,
        /// Expression.
        value: String,
    },
    /// A force.
    Force {
        /// Name.
        name: String,
        /// Expression that the force acts on.
        target: String,
        /// Expression.
        value: String,
        /// Part of the expression that is linear between switches, if it is stated. The rest is
        /// continuous where the expression switches.
        linear: Option<String>,
    },
    /// A coordinate.
    Coordinate {
        /// Name, which is also a placeholder of the effect.
        name: String,
        /// Unit.
        unit: String,
        /// Description.
        doc: String,
    },
    /// A state of first order.
    State {
        /// Name, which is also a placeholder of the effect.
        name: String,
        /// Unit.
        unit: String,
        /// Rate.
        rate: String,
        /// Description.
        doc: String,
    },
    /// A substitution.
    Substitution {
        /// Terms in which expressions are replaced.
        scope: SubstitutionScope,
        /// Replaced expression.
        pattern: String,
        /// New expression.
        replacement: String,
    },
}

impl Change {
    /// Returns the change with the part of its expression that is linear between switches, if that
    /// is stated; otherwise the change itself.
    pub(super) fn linear_part(&self) -> Self {
        match self {
            Self::Force {
                name,
                target,
                linear: Some(linear),
                ..
            } => Self::Force {
                name: name.clone(),
                target: target.clone(),
                value: linear.clone(),
                linear: None,
            },
            change => change.clone(),
        }
    }
}

/// Terms in which an expression is replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SubstitutionScope {
    /// These terms of the kinetic energy.
    Kinetic(Vec<String>),
    /// All terms of a mesh or of a spring, or the kinetic energy of a body and its load.
    Site,
    /// Each damper parallel to a spring.
    Dampers,
    /// All definitions and observables.
    Measured,
    /// Each occurrence of an input.
    Input,
}
