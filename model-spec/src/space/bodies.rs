//! Energies of a body: 1/2 m v.v + 1/2 omega.I omega, where v is the velocity of the centre of mass, and -m g.p under
//! gravity, where p is the position of the centre of mass.

use super::definitions::Owner;
use super::expression::Reader;
use super::frames::Motion;
use super::requirements::{Inertia, UnitRequirement};
use super::scalar::{add, expansion, half, is_literal, multiply, negate, number, square};
use super::state::ExpansionState;
use super::vector::{Vector, cross, inner, sum, zero};
use crate::ast::Syntax;
use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::dimension::Dimension;
use crate::ids::FrameId;
use crate::quantity::Quantity;
use crate::raw::{Document, RawBody, RawTerm};
use crate::rigid_tree::RigidBody;
use crate::span::Span;

/// Pairs of axes of I_xx, I_yy, I_zz, I_xy, I_yz, I_xz.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

/// Adds the energies of all bodies to the document. Returns the declared bodies.
pub fn expand(
    document: &mut Document,
    space: &mut ExpansionState,
    found: &mut Diagnostics,
) -> Vec<RigidBody<Syntax>> {
    let mut bodies = Vec::with_capacity(document.bodies.len());
    for body in std::mem::take(&mut document.bodies) {
        if found.is_full() {
            break;
        }
        let terms = document.kinetic.iter().chain(&document.potential);
        if let Some(term) = terms.into_iter().find(|t| t.name.text == body.name.text) {
            let name = quote(&body.name.text);
            found.push(
                Diagnostic::error(format!("the name {name} is taken"))
                    .with_span(body.name.span, "the energies of a body have its name")
                    .with_related_span(term.name.span, "here")
                    .with_help("choose another name"),
            );
            continue;
        }
        if found.push_error(space.frames.get(&body.frame)).is_none() {
            continue;
        }
        let Some(parts) = read_parts(&body, space, found) else {
            continue;
        };
        let frames = &space.frames;
        let Some(frame) = frames.name_motion(&body.frame.text) else {
            continue;
        };
        let motion = &frame.motion;
        let term = |value: Syntax| RawTerm {
            name: body.name.clone(),
            value: expansion(value),
            doc: body.doc.clone(),
            origin: body.origin.clone(),
        };
        let kinetic = build_kinetic_energy(&parts, motion);
        if !is_literal(&kinetic, 0.0) {
            document.kinetic.push(term(kinetic));
        }
        if frames.gravity {
            let way = add(motion.depth.clone(), inner(&motion.down, &parts.centre));
            let weight = match &frames.strength {
                Some(strength) => multiply(parts.mass.clone(), strength.clone()),
                None => parts.mass.clone(),
            };
            let potential = negate(multiply(weight, way));
            if !is_literal(&potential, 0.0) {
                document.potential.push(term(potential));
            }
        }
        bodies.push(parts.in_frame(body.name.text, frame.id));
    }
    bodies
}

struct BodyParts {
    mass: Syntax,
    centre: Vector,
    inertia: Vec<Syntax>,
    span: Span,
}

impl BodyParts {
    fn in_frame(self, name: String, frame: FrameId) -> RigidBody<Syntax> {
        let element = |place: usize| match self.inertia.get(place) {
            Some(element) => element.clone(),
            None => number(0.0, self.span),
        };
        RigidBody {
            name,
            frame,
            moments: [0, 1, 2].map(element),
            products: [3, 4, 5].map(element),
            mass: self.mass,
            centre: self.centre,
        }
    }
}

fn read_parts(
    body: &RawBody,
    space: &mut ExpansionState,
    found: &mut Diagnostics,
) -> Option<BodyParts> {
    let own = &body.name;
    let owner = Owner::new(own, &body.doc);
    let mass = match &body.mass {
        Some(mass) => {
            space.requirements.units.push(UnitRequirement {
                value: mass.clone(),
                dimension: Dimension::MASS,
                subject: format!("the mass of `{}`", own.text),
            });
            found.push_error(mass.syntax())?
        }
        None => number(0.0, own.span),
    };
    let subject = format!("the centre of `{}`", own.text);
    let centre = match &body.centre {
        Some(centre) => found.push_error(Reader::new(space, &owner).evaluate_with_unit(
            centre,
            &subject,
            Dimension::LENGTH,
        ))?,
        None => zero(own.span),
    };
    let mut inertia = Vec::new();
    for value in body.inertia.iter().flatten() {
        inertia.push(found.push_error(value.syntax())?);
        space.requirements.units.push(UnitRequirement {
            value: value.clone(),
            dimension: Dimension::from_mechanical_exponents([1, 2, 0, 0]),
            subject: format!("the inertia of `{}`", own.text),
        });
    }
    for part in centre.iter().chain(&inertia).chain([&mass]) {
        if space.definitions.moving.has_rate(part) {
            found.push(
                Diagnostic::error(format!("the body {} is not constant", quote(&own.text)))
                    .with_span(part.span, "this changes with the motion")
                    .with_help(
                        "give constant mass, centre and inertia; a frame describes the motion",
                    ),
            );
            return None;
        }
    }
    let elements = body.inertia.clone().unwrap_or_default();
    let span = elements.iter().map(Quantity::span).reduce(Span::join);
    space.requirements.inertias.push(Inertia {
        body: own.clone(),
        mass: body.mass.clone(),
        elements,
        span: span.unwrap_or(own.span),
    });
    Some(BodyParts {
        mass,
        centre,
        inertia,
        span: own.span,
    })
}

fn build_kinetic_energy(parts: &BodyParts, motion: &Motion) -> Syntax {
    let omega = &motion.omega;
    let velocity = sum(motion.velocity.clone(), cross(omega, &parts.centre));
    let [x, y, z] = velocity.map(square);
    let translation = half(multiply(parts.mass.clone(), add(add(x, y), z)));
    let mut rotation = number(0.0, parts.span);
    for (element, (i, j)) in parts.inertia.iter().zip(PAIRS) {
        let product = if i == j {
            square(omega[i].clone())
        } else {
            let both = multiply(omega[i].clone(), omega[j].clone());
            multiply(number(2.0, element.span), both)
        };
        rotation = add(rotation, multiply(element.clone(), product));
    }
    add(translation, half(rotation))
}
