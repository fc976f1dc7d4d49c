//! Nuisances of the fit: declared and estimated values.

use eomgen_page::{section, table};
use maud::{Markup, html};

use crate::report::quantity::{estimate, to_tenths};
use crate::report::result::{Compared, Nuisance};

pub(super) fn fitted(compared: &Compared) -> Markup {
    let all = &compared.nuisances;
    if all.is_empty() {
        return html! {};
    }
    let far = all.iter().filter(|of| of.is_at_bound()).count();
    let rows = html! { @for of in all { (row(of)) } };
    section(
        "What was fitted beside it",
        &html! {
            @if far > 0 {
                p.warning {
                    (far) " of these " @if far == 1 { "is" } @else { "are" }
                    " as far from what was declared as the fit allows: a sign that something else "
                    "is wrong, or that what was declared is too narrow."
                }
            }
            (table(&["", "declared", "fitted", "off by"], &rows))
            p.note {
                "Declared is what the specification and the dataset say, with one standard deviation; how far "
                "the fit is from it is counted in these."
            }
        },
    )
}

fn row(of: &Nuisance) -> Markup {
    let (mean, sd) = of.declared;
    let unit = &of.fitted.unit;
    let class = of.is_at_bound().then_some("failed");
    let off = of.deviations();
    html! {
        tr {
            th scope="row" {
                @if let Some(fault) = of.fault { (fault) " of " }
                code { (of.of) }
            }
            td.number { (estimate(mean, sd, unit)) }
            td.number { (estimate(of.fitted.value, of.fitted.sd, unit)) }
            td class=[class] {
                @if off.is_finite() { (to_tenths(off)) } @else { "–" }
            }
        }
    }
}
