//! Text and figures of the next experiment.

use eomgen_page::section;
use eomgen_plot::{Panel, Reference, Series, TimeHistory, time_history_at};
use eomgen_records::dataset::Channel;
use maud::{Markup, html};

use crate::experiment::next_experiment::{ExperimentFile, MemberPair, NextExperiment};
use crate::model::problem::EstimationProblem;
use crate::report::pictures::responsive_figure;
use crate::report::quantity::{format_number, format_quantity};
use crate::thresholds;

/// Returns sentences on the proposed input and its predicted result.
pub(crate) fn describe_experiment(next: &NextExperiment, files: &[ExperimentFile]) -> String {
    let (Some(input), Some(form), Some(separation)) =
        (&next.input, &next.waveform, next.separation)
    else {
        let reason = next.reason.as_deref().unwrap_or("no input was tested");
        return format!("No experiment is proposed: {reason}.");
    };
    let size = match separation < 0.01 {
        true => "less than 0.01".to_owned(),
        false => format_number(separation, 2),
    };
    let bounds = match next.bounds_source.is_empty() {
        true => String::new(),
        false => format!(" {}", next.bounds_source),
    };
    let Some(file) = next.file.and_then(|file| files.get(file)) else {
        return format!(
            "No input within the bounds is sufficient: the best one, {form} on {input}, has a separation of \
             {size} standard deviations of the noise.{bounds}"
        );
    };
    let played = format!("Play {}: {form} on {input}.", file.name);
    let result = match &next.detectable {
        Some(shown) => format!(
            "Predicted smallest detectable value of {}: {}.",
            shown.parameter,
            format_quantity(shown.smallest, 4, &shown.unit)
        ),
        None => format!(
            "Predicted residual of a wrong effect: at least {size} standard deviations of the noise."
        ),
    };
    format!("{played} {result}{}{bounds}", describe_unseparated(next))
}

/// Describes the pairs that an experiment does not separate, in a sentence.
fn describe_unseparated(next: &NextExperiment) -> String {
    // Each pair occurs twice in succession, in both orders.
    let pairs = next.pairs.chunks_exact(2);
    let is_separated = |pair: &&[MemberPair]| {
        pair.iter()
            .all(|of| of.separation >= thresholds::MIN_SEPARATION_IN_NOISE)
    };
    let left = pairs.filter(|pair| !is_separated(pair));
    let left = left.map(|pair| format!("{} from {}", pair[0].truth.label(), pair[0].rival.label()));
    match left.collect::<Vec<String>>() {
        left if left.is_empty() => String::new(),
        left => format!(" It does not separate {}.", left.join(", nor ")),
    }
}

/// Draws the proposed inputs and the predictions of the models.
pub(crate) fn draw_experiments(
    problem: &EstimationProblem<'_>,
    files: &[ExperimentFile],
) -> Markup {
    if files.is_empty() {
        return html! {};
    }
    section(
        "The next experiment",
        &html! {
            @for file in files {
                h3 { code { (file.name) } }
                (draw_experiment(file, &problem.dataset.channels, &problem.noise))
            }
            p.note {
                "Predicted sensor outputs without noise, of one model and of the other after a fit to them and "
                "to the existing records. Dashed lines: plus and minus one standard deviation of the noise."
            }
        },
    )
}

fn draw_experiment(file: &ExperimentFile, channels: &[Channel], noise: &[f64]) -> Markup {
    let [first, second] = &file.predictions;
    let columns = first.iter().zip(second);
    let differences: Vec<Vec<f64>> = columns
        .map(|(first, second)| first.iter().zip(second).map(|(a, b)| b - a).collect())
        .collect();
    let series = |label: &str, values: &'_ [f64]| (label.to_owned(), values.to_vec());
    let mut panels = vec![(
        format!("{}: input signal", file.input),
        (file.input.clone(), file.unit.clone()),
        vec![series(&file.input, &file.values)],
        Vec::new(),
    )];
    for (index, channel) in channels.iter().enumerate() {
        let named = || (channel.name.clone(), channel.unit.clone());
        panels.push((
            format!("{}: predicted", channel.name),
            named(),
            vec![
                series(&file.members[0], &first[index]),
                series(&file.members[1], &second[index]),
            ],
            Vec::new(),
        ));
        let band = [1.0, -1.0].map(|sign| Reference {
            label: if sign > 0.0 { "noise" } else { "" }.to_owned(),
            value: sign * noise[index],
        });
        panels.push((
            format!("{}: difference", channel.name),
            named(),
            vec![series("difference", &differences[index])],
            band.to_vec(),
        ));
    }
    let history = TimeHistory {
        title: "Prediction of the next experiment".to_owned(),
        panels: panels
            .iter()
            .map(|(title, (quantity, unit), columns, references)| Panel {
                title: title.clone(),
                quantity: quantity.clone(),
                unit: unit.clone(),
                series: columns
                    .iter()
                    .map(|(label, values)| Series {
                        label: label.clone(),
                        abscissa: &file.times,
                        values,
                        ..Series::default()
                    })
                    .collect(),
                references: references.clone(),
            })
            .collect(),
    };
    let caption = format!("Proposed record: file `{}`.", file.name);
    responsive_figure(&caption, |width| time_history_at(&history, width))
}
