//! Comparison of the equations of motion of two models, independent of parameter values.
//!
//! The comparison includes the names of coordinates, inputs and parameters, the expressions of energies and forces, and
//! the literals in these expressions. It ignores comments, names of terms, observables, and the division of expressions
//! into definitions.

use eomgen_model_spec::model::{Expr, ExprKind, Field, Force, Model, ParameterValue, Term};

/// Returns the first difference between the equations of motion of `model` and `known`; `None` if they are equal.
///
/// A parameter that `known` derives from others may have any value if it is among `given`. Other
/// derived parameters must be derived in the same way.
pub fn first_difference(model: &Model, known: &Model, given: &[&str]) -> Option<String> {
    let pair = ModelPair { model, known };
    pair.coordinates()
        .or_else(|| pair.inputs())
        .or_else(|| pair.states())
        .or_else(|| pair.fields())
        .or_else(|| pair.terms("kinetic", &model.kinetic, &known.kinetic))
        .or_else(|| pair.terms("potential", &model.potential, &known.potential))
        .or_else(|| pair.terms("dissipation", &model.dissipation, &known.dissipation))
        .or_else(|| pair.forces())
        .or_else(|| pair.derived_parameters(given))
}

struct ModelPair<'m> {
    model: &'m Model,
    known: &'m Model,
}

impl ModelPair<'_> {
    fn coordinates(&self) -> Option<String> {
        let names = |model: &Model| -> Vec<String> {
            let coordinates = model.coordinates.iter();
            coordinates.map(|known| known.name.clone()).collect()
        };
        name_difference("coordinates", &names(self.model), &names(self.known))
    }

    fn inputs(&self) -> Option<String> {
        let names = |model: &Model| -> Vec<String> {
            let inputs = model.inputs.iter();
            inputs.map(|input| input.name.clone()).collect()
        };
        name_difference("inputs", &names(self.model), &names(self.known))
    }

    fn states(&self) -> Option<String> {
        let names = |model: &Model| -> Vec<String> {
            let states = model.states.iter();
            states.map(|state| state.name.clone()).collect()
        };
        name_difference("states", &names(self.model), &names(self.known)).or_else(|| {
            let mut pairs = self.model.states.iter().zip(self.known.states.iter());
            let other = pairs.find(|(state, known)| !self.is_same(&state.rate, &known.rate));
            other.map(|(state, _)| format!("the rate of its state `{}` differs", state.name))
        })
    }

    fn fields(&self) -> Option<String> {
        let (fields, known) = (&self.model.fields, &self.known.fields);
        let alike = |(field, known): (&Field, &Field)| {
            field.basis == known.basis
                && self.is_same(&field.from, &known.from)
                && self.is_same(&field.to, &known.to)
        };
        (fields.len() != known.len() || !fields.iter().zip(known).all(alike))
            .then(|| "its fields, their domains or bases differ".to_owned())
    }

    fn terms(&self, section: &str, terms: &[Term], known: &[Term]) -> Option<String> {
        let same = |term: &Term, known: &Term| self.is_same(&term.value, &known.value);
        unmatched_entry(section, terms, known, same, |term| &term.name)
    }

    fn forces(&self) -> Option<String> {
        let same = |force: &Force, known: &Force| {
            self.is_same(&force.on, &known.on) && self.is_same(&force.value, &known.value)
        };
        let (forces, known) = (&self.model.forces, &self.known.forces);
        unmatched_entry("forces", forces, known, same, |force| &force.name)
    }

    /// Returns a difference in a derived parameter that is not among `given`.
    fn derived_parameters(&self, given: &[&str]) -> Option<String> {
        let derived = self.known.parameters.iter().filter_map(|known| {
            let ParameterValue::Expression(value) = &known.value else {
                return None;
            };
            (!given.contains(&known.name.as_str())).then_some((&known.name, value))
        });
        for (name, value) in derived {
            let own = self.model.parameters.iter().find(|own| own.name == *name);
            let alike = own.is_none_or(|own| match &own.value {
                ParameterValue::Expression(own) => self.is_same(own, value),
                ParameterValue::Number(_) => false,
            });
            if !alike {
                return Some(format!("its parameter `{name}` is derived differently"));
            }
        }
        None
    }

    /// Compares two expressions with expanded definitions. The depth of the recursion is bounded by the size of the
    /// known expression, even if definitions of this model share subexpressions.
    fn is_same(&self, left: &Expr, right: &Expr) -> bool {
        use ExprKind as K;
        if let K::Definition(index) = left.kind {
            let definition = self.model.definitions.get(index.index());
            return definition.is_some_and(|own| self.is_same(&own.value, right));
        }
        let right = self.resolve_definitions(right);
        match (&left.kind, &right.kind) {
            (K::Parameter(own), K::Parameter(known)) => {
                self.model.parameters.get(own.index()).map(|p| &p.name)
                    == self.known.parameters.get(known.index()).map(|p| &p.name)
            }
            (K::Dot(left), K::Dot(right)) | (K::Negate(left), K::Negate(right)) => {
                self.is_same(left, right)
            }
            (K::Diff(left, times), K::Diff(right, other)) => {
                times == other && self.is_same(left, right)
            }
            (K::At { .. }, K::At { .. })
            | (K::Integral { .. }, K::Integral { .. })
            | (K::Sum { .. }, K::Sum { .. }) => self.is_same_in_field(&left.kind, &right.kind),
            (K::Binary(operator, a, b), K::Binary(other, c, d)) => {
                operator == other && self.is_same(a, c) && self.is_same(b, d)
            }
            (K::Call(function, arguments), K::Call(other, others)) => {
                function == other
                    && arguments.len() == others.len()
                    && arguments
                        .iter()
                        .zip(others)
                        .all(|(a, b)| self.is_same(a, b))
            }
            // Both are leaves. The lists of coordinates, inputs, states and fields were compared before.
            (left, right) => left == right,
        }
    }

    /// Compares expressions that belong to a field.
    fn is_same_in_field(&self, left: &ExprKind, right: &ExprKind) -> bool {
        use ExprKind as K;
        match (left, right) {
            (
                K::At {
                    field,
                    value,
                    position,
                },
                K::At {
                    field: other,
                    value: known,
                    position: place,
                },
            ) => field == other && self.is_same(value, known) && self.is_same(position, place),
            (
                K::Integral { field, integrand },
                K::Integral {
                    field: other,
                    integrand: known,
                },
            ) => field == other && self.is_same(integrand, known),
            (
                K::Sum { field, summand },
                K::Sum {
                    field: other,
                    summand: known,
                },
            ) => field == other && self.is_same(summand, known),
            _ => false,
        }
    }

    /// Replaces a reference to a definition by its expression, repeatedly.
    fn resolve_definitions<'e>(&'e self, mut expression: &'e Expr) -> &'e Expr {
        while let ExprKind::Definition(index) = expression.kind {
            let Some(definition) = self.known.definitions.get(index.index()) else {
                break;
            };
            expression = &definition.value;
        }
        expression
    }
}

/// Returns a difference between two lists of names.
fn name_difference(what: &str, own: &[String], known: &[String]) -> Option<String> {
    (own != known).then(|| {
        let names = |names: &[String]| {
            if names.is_empty() {
                "none".to_owned()
            } else {
                names.join(", ")
            }
        };
        format!("its {what} are {}, not {}", names(own), names(known))
    })
}

/// Returns the first entry of either list that has no equal entry in the other.
fn unmatched_entry<T>(
    section: &str,
    own: &[T],
    known: &[T],
    same: impl Fn(&T, &T) -> bool,
    name: impl Fn(&T) -> &str,
) -> Option<String> {
    let mut left: Vec<&T> = known.iter().collect();
    for entry in own {
        let Some(place) = left.iter().position(|known| same(entry, known)) else {
            return Some(format!("`{}` of [{section}] differs", name(entry)));
        };
        left.swap_remove(place);
    }
    let missing = left.first()?;
    Some(format!("`{}` of [{section}] is missing", name(missing)))
}
