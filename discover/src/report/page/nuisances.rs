//! Nuisances of the fit: declared and estimated values.

use eomgen_page::{prose, quantity_symbol, section, stacked_table};
use maud::{Markup, html};

use crate::report::quantity::{format_estimate, format_tenths};
use crate::report::result::{CommonResult, Nuisance};

pub(super) fn list_nuisances(compared: &CommonResult) -> Markup {
    let all = &compared.nuisances;
    if all.is_empty() {
        return html! {};
    }
    let far = all.iter().filter(|of| of.is_at_bound()).count();
    let rows = html! { @for of in all { (write_row(of)) } };
    section(
        "Refitted parameters and sensors",
        &html! {
            @if far > 0 {
                p.warning {
                    (far) " of these " @if far == 1 { "is" } @else { "are" }
                    " at the bound of the fit: another effect "
                    "may be missing, or the declared uncertainty is too small."
                }
            }
            (stacked_table(&["", "declared", "fitted", "deviation"], &rows))
            p.note {
                "Declared: mean and standard deviation from the specification and the dataset. Deviation: \
                 distance "
                "of the fit from the mean, in these standard deviations."
            }
        },
    )
}

fn write_row(of: &Nuisance) -> Markup {
    let (mean, sd) = of.declared;
    let unit = &of.estimate.unit;
    let class = of.is_at_bound().then_some("failed");
    let deviation = of.deviations_from_prior();
    html! {
        tr {
            th scope="row" {
                @if let Some(fault) = of.fault { (fault) " of " }
                (quantity_symbol(&of.name))
            }
            td.number { (prose(&format_estimate(mean, sd, unit))) }
            td.number { (prose(&format_estimate(of.estimate.value, of.estimate.sd, unit))) }
            td class=[class] {
                @if deviation.is_finite() { (format_tenths(deviation)) } @else { "–" }
            }
        }
    }
}
