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
        "Fitted nuisances",
        &html! {
            @if far > 0 {
                p.warning {
                    (far) " of these " @if far == 1 { "is" } @else { "are" }
                    " at the bound of the fit: another effect "
                    "may be missing, or the declared uncertainty is too small."
                }
            }
            (table(&["", "declared", "fitted", "deviation"], &rows))
            p.note {
                "Declared: mean and standard deviation from the specification and the dataset. Deviation: \
                 distance "
                "of the fit from the mean, in these standard deviations."
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
