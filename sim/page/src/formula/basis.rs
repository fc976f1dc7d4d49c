//! Constants of a basis as MathML: values and integrals of mode shapes.

use eomgen_codegen::symbolic::tables::TableKind;
use maud::{Markup, html};

use super::{element, identifier, parenthesise};

pub(super) fn table(kind: TableKind) -> Markup {
    match kind {
        TableKind::Wavenumber => wavenumber(),
        TableKind::Mixing => mixing(),
        TableKind::GrowingAmplitude => html! {
            (parenthesise("(", &html! { mn { "1" } mo { "+" } (mixing()) }, ")"))
            msup { mi { "e" } mrow { (wavenumber()) } }
        },
        TableKind::FallingAmplitude => amplitude("−"),
        TableKind::RisingAmplitude => amplitude("+"),
        TableKind::ShapeAtStart(derivative) => shape_at_position(derivative, &html! { mn { "0" } }),
        TableKind::ShapeAtEnd(derivative) => shape_at_position(derivative, &html! { mn { "1" } }),
        TableKind::ShapeAtPlace { bits, derivative } => {
            shape_at_position(derivative, &html! { mn { (f64::from_bits(bits)) } })
        }
        TableKind::Moment { power, derivative } => integral(power, &shape("i", derivative)),
        TableKind::OwnMoment { power, left, right } if left == right => integral(
            power,
            &html! { msup { mrow { (shape("i", left)) } mn { "2" } } },
        ),
        TableKind::OwnMoment { power, left, right } => {
            integral(power, &html! { (shape("i", left)) (shape("i", right)) })
        }
        TableKind::PairMoment { power, left, right } => {
            integral(power, &html! { (shape("i", left)) (shape("j", right)) })
        }
        TableKind::Indicator(mode) => element(&identifier("δ"), &format!("i{mode}")),
        TableKind::NodePosition => element(&identifier("s"), "g"),
        TableKind::NodeWeight => element(&identifier("w"), "g"),
        TableKind::ShapeAtNodes(derivative) => {
            shape_at_position(derivative, &element(&identifier("s"), "g"))
        }
    }
}

fn wavenumber() -> Markup {
    element(
        &parenthesise("(", &html! { mi { "β" } mi { "l" } }, ")"),
        "i",
    )
}

fn mixing() -> Markup {
    element(&identifier("ξ"), "i")
}

fn amplitude(sense: &str) -> Markup {
    html! { msubsup { (identifier("φ")) (identifier("i")) mo { (sense) } } }
}

fn shape(index: &str, derivative: u8) -> Markup {
    let shape = element(&identifier("φ"), index);
    match derivative {
        0 => shape,
        n => html! { msup { (shape) mo { (prime_marks(n)) } } },
    }
}

/// Returns prime marks, as one character if Unicode has it.
fn prime_marks(count: u8) -> String {
    match count {
        1 => "′".to_owned(),
        2 => "″".to_owned(),
        3 => "‴".to_owned(),
        n => "′".repeat(usize::from(n)),
    }
}

fn shape_at_position(derivative: u8, place: &Markup) -> Markup {
    html! { (shape("i", derivative)) (parenthesise("(", place, ")")) }
}

fn integral(power: u32, shapes: &Markup) -> Markup {
    html! {
        mrow {
            msubsup { mo { "∫" } mn { "0" } mn { "1" } }
            @match power {
                0 => {},
                1 => (identifier("s")),
                n => msup { mi { "s" } mn { (n) } },
            }
            (shapes)
            mspace width="0.17em" {}
            mi mathvariant="normal" { "d" }
            mi { "s" }
        }
    }
}
