//! The constants of a basis as MathML: values and integrals of mode shapes.

use super::{element, fenced, identifier, row};
use crate::symbolic::tables::TableKind;

/// A constant of a basis.
pub(super) fn table(kind: TableKind) -> String {
    match kind {
        TableKind::Wavenumber => wavenumber(),
        TableKind::Mixing => mixing(),
        TableKind::GrowingAmplitude => format!(
            "{}<msup><mi>e</mi>{}</msup>",
            fenced("(", &format!("<mn>1</mn><mo>+</mo>{}", mixing()), ")"),
            wavenumber()
        ),
        TableKind::ShapeAtStart(derivative) => at_position(derivative, "<mn>0</mn>"),
        TableKind::ShapeAtEnd(derivative) => at_position(derivative, "<mn>1</mn>"),
        TableKind::Moment { power, derivative } => integral(power, &shape("i", derivative)),
        TableKind::OwnMoment { power, left, right } => {
            integral(power, &(shape("i", left) + &shape("i", right)))
        }
        TableKind::PairMoment { power, left, right } => {
            integral(power, &(shape("i", left) + &shape("j", right)))
        }
        TableKind::NodePosition => element(&identifier("s"), "g"),
        TableKind::NodeWeight => element(&identifier("w"), "g"),
        TableKind::ShapeAtNodes(derivative) => {
            at_position(derivative, &element(&identifier("s"), "g"))
        }
    }
}

fn wavenumber() -> String {
    element(&fenced("(", "<mi>β</mi><mi>l</mi>", ")"), "i")
}

fn mixing() -> String {
    element(&identifier("ξ"), "i")
}

/// A mode shape with primes for its derivatives.
fn shape(index: &str, derivative: u8) -> String {
    let shape = element(&identifier("φ"), index);
    match derivative {
        0 => shape,
        n => format!(
            "<msup>{shape}<mo>{}</mo></msup>",
            "′".repeat(usize::from(n))
        ),
    }
}

fn at_position(derivative: u8, place: &str) -> String {
    shape("i", derivative) + &fenced("(", place, ")")
}

/// The integral over s from 0 to 1 of a power of s times shapes.
fn integral(power: u32, shapes: &str) -> String {
    let position = match power {
        0 => String::new(),
        1 => identifier("s"),
        n => format!("<msup><mi>s</mi><mn>{n}</mn></msup>"),
    };
    row(&format!(
        "<msubsup><mo>∫</mo><mn>0</mn><mn>1</mn></msubsup>{position}{shapes}<mi mathvariant=\"normal\">d</mi><mi>s</mi>"
    ))
}
