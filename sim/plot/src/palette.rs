//! Colours of figures in a light and in a dark scheme.
//!
//! Figures are drawn in the light colours, as attributes of SVG elements. [`dark_style`] replaces them if the
//! reader prefers a dark scheme, in a page and in an SVG file.

/// Light colours, each with the dark colour that replaces it.
const DARK_COLOURS: [(&str, &str); 19] = [
    ("#ffffff", "#14181c"),
    ("#222222", "#e4e8ec"),
    ("#e6e6e6", "#2c343b"),
    ("#444444", "#8d98a2"),
    ("#555555", "#a0a8b0"),
    ("#6a6a6a", "#a0a8b0"),
    ("#8a8a8a", "#7c868f"),
    ("#000000", "#ffffff"),
    ("#b9c2ca", "#5f6a74"),
    ("#0072b2", "#6fbdf0"),
    ("#d55e00", "#ff9a66"),
    ("#009e73", "#4fd0a5"),
    ("#cc79a7", "#e3a3d0"),
    ("#e69f00", "#ecb84a"),
    ("#56b4e9", "#a5d4ee"),
    ("#56a0d3", "#4d94c6"),
    ("#0b4f86", "#a5d4ee"),
    ("#c4c4c4", "#5b6670"),
    ("#f2cfae", "#7d6145"),
];

/// Returns a style element that replaces the light colours in `body` by dark ones.
pub(super) fn dark_style(body: &str) -> String {
    let used = DARK_COLOURS
        .iter()
        .filter(|(light, _)| body.contains(light));
    let rules: String = used
        .map(|(light, dark)| {
            format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
        })
        .collect();
    format!("<style>@media (prefers-color-scheme:dark){{{rules}}}</style>\n")
}

/// Removes the style element, so that a PNG has the light colours.
pub(super) fn without_style(svg: &str) -> String {
    match svg.split_once("<style>") {
        Some((before, rest)) => {
            let after = rest.split_once("</style>\n").map_or("", |(_, after)| after);
            format!("{before}{after}")
        }
        None => svg.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of a colour, by WCAG 2.
    fn luminance(colour: &str) -> f64 {
        let channel = |at: usize| {
            let value =
                u8::from_str_radix(&colour[at..at + 2], 16).expect("two hexadecimal digits");
            let part = f64::from(value) / 255.0;
            if part <= 0.04045 {
                part / 12.92
            } else {
                ((part + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    }

    fn contrast(one: &str, other: &str) -> f64 {
        let [one, other] = [one, other].map(|colour| luminance(colour) + 0.05);
        one.max(other) / one.min(other)
    }

    #[test]
    fn dark_curves_and_text_are_as_visible_as_light_ones() {
        let (light_paper, dark_paper) = DARK_COLOURS[0];
        for (light, dark) in &DARK_COLOURS[1..] {
            let (light, dark) = (contrast(light, light_paper), contrast(dark, dark_paper));
            assert!(
                dark > light.min(4.5) || dark > 0.8 * light,
                "{light} {dark}"
            );
        }
    }

    #[test]
    fn style_has_only_used_colours_and_can_be_removed() {
        let style = dark_style("<path stroke=\"#0072b2\"/>");
        assert_eq!(
            style,
            "<style>@media (prefers-color-scheme:dark){[fill=\"#0072b2\"]{fill:#6fbdf0}\
             [stroke=\"#0072b2\"]{stroke:#6fbdf0}}</style>\n"
        );
        assert_eq!(without_style(&format!("<svg>{style}</svg>")), "<svg></svg>");
        assert_eq!(without_style("<svg></svg>"), "<svg></svg>");
    }
}
