//! Sliders for the fitted values: parameters of the extended specification, and sensors.

use eomgen_page::play::{Slider, format_unit};
use maud::{Markup, html};

use crate::fit::fit_result::Fit;
use crate::ids::UnknownId;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::UnknownKind;
use crate::search::search_result::AcceptedEffect;

/// Half the range of a sensor's slider, as a multiple of the result.
const SENSOR_RANGE_FACTOR: f64 = 2.0;

/// Writes the sliders and the reset button.
pub(super) fn write_controls(
    problem: &EstimationProblem<'_>,
    best: &Fit,
    model: &EstimationModel,
    accepted: &[AcceptedEffect],
) -> Markup {
    let unknowns = accepted.iter().flat_map(|effect| &effect.unknowns);
    html! {
        div.controls {
            @for id in unknowns { (write_slider(problem, best, model, *id)) }
            p.scripted { button #defaults type="button" { "Reset values" } }
        }
    }
}

fn write_slider(
    problem: &EstimationProblem<'_>,
    best: &Fit,
    model: &EstimationModel,
    id: UnknownId,
) -> Markup {
    let value = best.train.estimate.theta[id];
    let of_sensor = |channel: usize, fault: &str, neutral: f64, unit: &str| {
        let reach = (SENSOR_RANGE_FACTOR * (value - neutral).abs()).max(f64::MIN_POSITIVE);
        Slider {
            name: format!("{fault}_{}", problem.dataset.channels[channel].name),
            unit: format_unit(unit),
            doc: "",
            place: channel,
            factor: 1.0,
            value,
            low: neutral - reach,
            high: neutral + reach,
        }
    };
    match &best.unknowns[id].kind {
        UnknownKind::Parameter(name) => write_parameter_slider(model, name, false),
        UnknownKind::InverseParameter(name) => write_parameter_slider(model, name, true),
        UnknownKind::Gain(at) => of_sensor(at.index(), "gain", 1.0, "1").control("gain"),
        UnknownKind::Bias(at) => {
            let unit = &problem.dataset.channels[at.index()].unit;
            of_sensor(at.index(), "bias", 0.0, unit).control("bias")
        }
        // A delay of the input is a delay of all sensors, for which there is no common slider.
        UnknownKind::InputDelay => html! {},
        UnknownKind::Delay(at) => of_sensor(at.index(), "delay", 0.0, "s").control("delay"),
    }
}

/// Returns the slider of a parameter. `is_inverse`: the effect vanishes for an infinite value, so 0
/// is excluded from the range.
fn write_parameter_slider(model: &EstimationModel, name: &str, is_inverse: bool) -> Markup {
    let declared = model.specification().parameters.iter();
    let mut declared = declared.filter(|parameter| parameter.name == name);
    let (Some(declared), Some(index)) = (declared.next(), model.find_parameter(name)) else {
        return html! {};
    };
    let index = index.index();
    let mut slider = Slider::from_parameter(declared, index, model.values[index]);
    if is_inverse {
        (slider.low, slider.high) = (0.2 * slider.value, 5.0 * slider.value);
    }
    slider.control("parameter")
}
