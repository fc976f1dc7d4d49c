//! Effects as data: lists of edits with placeholders.

use eomgen_model_spec::edit::Section;

/// An effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Name in results.
    pub name: String,
    /// Kind of site at which the effect can act.
    pub site_kind: SiteKind,
    /// Description, which completes a sentence.
    pub description: String,
    /// Experiment that shows the effect best.
    pub experiment: String,
    /// True if the effect is periodic in an angle; it is tried at several shaft orders.
    pub has_orders: bool,
    /// True if the effect is tried with the load of each spring or mesh.
    pub has_loads: bool,
    /// Parameters, at least one.
    pub parameters: Vec<EffectParameter>,
    /// Edits, at least one.
    pub edits: Vec<Change>,
    /// True if the effect is defined in a user's file.
    pub is_user_defined: bool,
}

/// Converts the names of effects to words, for example `coulomb_friction` to `Coulomb friction`.
pub fn effect_in_words(name: &str) -> String {
    let name = name.replace("coulomb_", "Coulomb ");
    name.replace("stribeck_", "Stribeck ").replace('_', " ")
}

/// Placeholder for the term of a damper in edits that replace this term.
pub const DAMPER_PLACEHOLDER: &str = "damper";

/// Kind of a site.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SiteKind {
    /// Angle or position that can move.
    Axis,
    /// Angle.
    Angle,
    /// Pair of teeth with play.
    Mesh,
    /// Flexible body.
    Arm,
    /// Linear spring.
    Spring,
    /// Input.
    Input,
    /// Whole machine.
    Machine,
}

impl Effect {
    /// Returns true if the effect adds a coordinate or a state.
    pub fn adds_states(&self) -> bool {
        let adds = |edit: &Change| matches!(edit, Change::State { .. } | Change::Coordinate { .. });
        self.edits.iter().any(adds)
    }

    /// Returns true if only a scan finds the effect, because a linearisation at one size or shape
    /// does not show it. Examples are friction with memory and the dead zone of an input. A
    /// user-defined effect is always tested.
    pub fn is_only_scanned(&self) -> bool {
        let adds_state = |edit: &Change| matches!(edit, Change::State { .. });
        let has_shape = |parameter: &EffectParameter| parameter.shape.is_some();
        let has_memory = self.edits.iter().any(adds_state) && self.parameters.iter().any(has_shape);
        let substitutes = |edit: &Change| matches!(edit, Change::Substitution { .. });
        let has_dead_zone = self.site_kind == SiteKind::Input && self.edits.iter().all(substitutes);
        !self.is_user_defined && (has_memory || has_dead_zone)
    }

    /// Returns true if the effect declares which part of a force is linear between switches.
    pub(super) fn declares_linear_part(&self) -> bool {
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

    /// Returns true if the effect only scales the stiffness of a spring, as a shifted parameter
    /// does.
    pub fn scales_stiffness(&self) -> bool {
        let scales = |edit: &Change| matches!(edit, Change::Substitution { scope: SubstitutionScope::Site, pattern, .. } if pattern == "{k}");
        self.site_kind == SiteKind::Spring && self.edits.iter().all(scales)
    }
}

impl SiteKind {
    /// Kinds and their keywords in an effects file.
    pub const KEYWORDS: [(&'static str, Self); 7] = [
        ("axis", Self::Axis),
        ("angle", Self::Angle),
        ("mesh", Self::Mesh),
        ("arm", Self::Arm),
        ("spring", Self::Spring),
        ("input", Self::Input),
        ("machine", Self::Machine),
    ];

    /// Returns the placeholders of a kind of site. Some sites have no `{root}`, no `{stiffness}`,
    /// no `{k}` of a spring, or not all moments of a machine.
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
    /// Name; if it is in use, a suffix is added.
    pub name: String,
    /// Unit, with placeholders.
    pub unit: String,
    /// True if the value must not be negative.
    pub is_positive: bool,
    /// Description.
    pub doc: String,
    /// True if the effect vanishes at infinity instead of 0.
    pub is_inverse: bool,
    /// Initial value of a shape parameter.
    pub shape: Option<Shape>,
}

/// Initial value of a shape parameter as a fraction of the motion at the site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Quantity that sets the scale.
    pub quantity: ShapeScale,
    /// Fraction of the quantity.
    pub fraction: f64,
}

/// Quantity of the motion at a site.
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
    /// Scales and their keywords in an effects file.
    pub const KEYWORDS: [(&'static str, Self); 4] = [
        ("rate", Self::Rate),
        ("travel", Self::Travel),
        ("positive_travel", Self::PositiveTravel),
        ("negative_travel", Self::NegativeTravel),
    ];
}

/// Edit of the specification.
#[derive(Clone, Debug)]
pub enum Change {
    /// Adds a term to an energy or to the dissipation.
    Term {
        /// Section of the term.
        section: Section,
        /// Name.
        name: String,
        /// Expression.
        value: String,
    },
    /// Adds a definition for use in other edits.
    Definition {
        /// Name, which is also a placeholder of the effect.
        name: String,
        /// Expression.
        value: String,
    },
    /// Adds a force.
    Force {
        /// Name.
        name: String,
        /// Expression on which the force acts.
        target: String,
        /// Expression.
        value: String,
        /// Declared part of the expression that is linear between switches. The rest must be
        /// continuous at the switches.
        linear: Option<String>,
    },
    /// Adds a coordinate.
    Coordinate {
        /// Name, which is also a placeholder of the effect.
        name: String,
        /// Unit.
        unit: String,
        /// Description.
        doc: String,
    },
    /// Adds a first-order state.
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
    /// Replaces an expression.
    Substitution {
        /// Terms in which the expression is replaced.
        scope: SubstitutionScope,
        /// Replaced expression.
        pattern: String,
        /// New expression.
        replacement: String,
    },
}

impl Change {
    /// Returns the edit with the linear part of its expression, or the unchanged edit if no linear
    /// part is declared.
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
    /// Named terms of the kinetic energy.
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
