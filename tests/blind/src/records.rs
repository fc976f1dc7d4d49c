//! Input files of a case: simulated motions, sensor readings with noise and quantisation, and the
//! files of the dataset. Labels are written to a separate folder.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::hidden::{HiddenEffect, Sensors};
use crate::inputs::{Drive, drive};
use crate::integrate::Stepper;
use crate::machines::{Machine, Setup, Specification};
use crate::plan::{Case, Group, Nuisances};
use crate::random::RandomStream;
use crate::size;

/// True values of a case, used only for scoring.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Label {
    /// Number of the case.
    pub case: usize,
    /// Group.
    pub group: Group,
    /// Machine.
    pub machine: crate::machines::Kind,
    /// Hidden effects.
    pub hidden: Vec<Truth>,
    /// True if all parameters and sensors deviate by their full priors.
    pub full_priors: bool,
    /// True values of the declared parameters, SI.
    pub declared: Vec<(String, f64)>,
    /// True errors of the sensors, without hidden effects.
    pub sensors: Sensors,
}

/// Hidden effect with the true values for scoring.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Effect with site and size.
    pub hidden: HiddenEffect,
    /// Name in results.
    pub effect: String,
    /// True values of its parameters, SI, sorted by name.
    pub parameters: Vec<f64>,
    /// RMS residual of the effect after a fit of initial states and nuisances, in noise floors.
    pub floors: f64,
    /// Effects that are inseparable from the hidden effect, with their sites.
    pub alike: Vec<(String, String)>,
}

/// Returns the sensor readings of a motion, one column per channel, SI.
pub fn sensor_readings(
    machine: &Machine,
    setup: &Setup,
    drive: &Drive,
    sensors: &Sensors,
    draw: &mut RandomStream,
) -> Vec<Vec<f64>> {
    let step = setup.sample / setup.steps as f64;
    let late: Vec<usize> = sensors
        .delay
        .iter()
        .map(|d| (d / step).round() as usize)
        .collect();
    let mut history: Vec<Vec<f64>> = vec![machine.outputs(&drive.start)];
    let mut state = drive.start.clone();
    let mut stepper = Stepper::new(state.len());
    let mut columns = vec![Vec::with_capacity(drive.input.len()); setup.channels.len()];
    for (sample, input) in drive.input.iter().enumerate() {
        for (place, channel) in setup.channels.iter().enumerate() {
            let then = (sample * setup.steps).saturating_sub(late[place]);
            let value = (1.0 + sensors.gain[place]) * history[then][place] + sensors.bias[place];
            // The variance of rounding is step^2/12.
            let white = (channel.noise.powi(2) - channel.step.powi(2) / 12.0).sqrt();
            let noisy = value + white * draw.normal();
            columns[place].push((noisy / channel.step).round() * channel.step);
        }
        for inner in 0..setup.steps {
            let t = sample as f64 * setup.sample + inner as f64 * step;
            stepper.advance(machine, t, step, 1, *input, &mut state);
            history.push(machine.outputs(&state));
        }
    }
    columns
}

/// Determines the sizes of the effects of a case, and writes its folder and its label.
///
/// # Errors
///
/// A file that cannot be written.
pub fn make_case(case: &Case, seed: u64, specifications: &Path, out: &Path) -> std::io::Result<()> {
    let label_file = out.join("labels").join(format!("{:03}.json", case.number));
    if label_file.exists() {
        return Ok(());
    }
    let setup = case.machine.setup();
    let mut draw = RandomStream::new(seed, 1 + case.number as u64);
    let mut machine = case.machine.nominal();
    machine.choose_dry(&mut draw);
    let mut sensors = Sensors::ideal(setup.channels.len());
    let declared = case
        .nuisances
        .draw(&setup, &mut machine, &mut sensors, &mut draw);
    let count = setup.records.0 + setup.records.1;
    let drives: Vec<Drive> = (0..count)
        .map(|place| drive(case.machine, &setup, case.manner, place, &mut draw))
        .collect();
    let mut truths = Vec::new();
    for planned in &case.hidden {
        let sized = size::determine_size(
            &machine,
            &setup,
            &drives,
            &declared,
            planned.hidden.clone(),
            planned.level,
        );
        truths.push(Truth {
            effect: sized.hidden.name(),
            parameters: sized.hidden.parameters(&machine),
            floors: sized.floors,
            alike: planned.inseparable.clone(),
            hidden: sized.hidden,
        });
    }
    let label = Label {
        case: case.number,
        group: case.group,
        machine: case.machine,
        hidden: truths,
        full_priors: case.nuisances == Nuisances::FULL,
        declared,
        sensors: sensors.clone(),
    };
    for truth in &label.hidden {
        truth.hidden.hide(&mut machine, &setup, &mut sensors);
    }
    let columns: Vec<Vec<Vec<f64>>> = drives
        .iter()
        .map(|drive| sensor_readings(&machine, &setup, drive, &sensors, &mut draw))
        .collect();
    let folder = out.join("cases").join(format!("{:03}", case.number));
    write_case(&folder, &setup, case, specifications, &drives, &columns)?;
    write_whole(&label_file, &serde_json::to_string_pretty(&label)?)
}

fn write_case(
    folder: &Path,
    setup: &Setup,
    case: &Case,
    specifications: &Path,
    drives: &[Drive],
    columns: &[Vec<Vec<f64>>],
) -> std::io::Result<()> {
    let specification = match &setup.specification {
        Specification::Shipped(file) => std::fs::read_to_string(specifications.join(file))?,
        Specification::Text(text) => text.clone(),
    };
    write_whole(&folder.join("spec.toml"), &specification)?;
    let names: Vec<String> = (0..drives.len())
        .map(|place| match place.checked_sub(setup.records.0) {
            None => format!("train{place}.csv"),
            Some(test) => format!("test{test}.csv"),
        })
        .collect();
    for ((drive, columns), name) in drives.iter().zip(columns).zip(&names) {
        write_whole(&folder.join(name), &write_table(setup, drive, columns))?;
    }
    let order = setup.order.map_or(String::new(), |order| order.to_string());
    write_whole(&folder.join("order.txt"), &order)?;
    write_whole(
        &folder.join("dataset.toml"),
        &write_description(setup, case, &names),
    )
}

fn write_table(setup: &Setup, drive: &Drive, columns: &[Vec<f64>]) -> String {
    let mut text = "t".to_owned();
    if let Some((name, _)) = setup.input {
        text += &format!(",{name}");
    }
    for channel in &setup.channels {
        text += &format!(",{}", channel.name);
    }
    text.push('\n');
    for (sample, input) in drive.input.iter().enumerate() {
        text += &format!("{:.6}", sample as f64 * setup.sample);
        if setup.input.is_some() {
            text += &format!(",{input:.8e}");
        }
        for (channel, column) in setup.channels.iter().zip(columns) {
            text += &format!(",{:.9e}", column[sample] / channel.scale);
        }
        text.push('\n');
    }
    text
}

fn write_description(setup: &Setup, case: &Case, names: &[String]) -> String {
    let (train, test) = names.split_at(setup.records.0);
    let mut text = format!(
        "[records]\ntrain = {train:?}\ntest = {test:?}\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n"
    );
    if let Some((name, unit)) = setup.input {
        text += &format!(
            "\n[inputs.{name}]\ncolumn = \"{name}\"\nunit = \"{unit}\"\nhold = \"zero-order\"\n"
        );
    }
    for channel in &setup.channels {
        text += &format!(
            "\n[channels.{0}]\ncolumn = \"{0}\"\nunit = \"{1}\"\nnoise = {2:e}\n",
            channel.name,
            channel.unit,
            channel.noise / channel.scale
        );
    }
    let initial = if case.starts_at_rest() {
        "rest"
    } else {
        "estimate"
    };
    text += &format!("\n[initial]\nstate = \"{initial}\"\n\n[uncertain]\n");
    for (name, relative) in &setup.uncertain {
        text += &format!("{name} = {{ relative = {relative} }}\n");
    }
    let length = setup
        .window
        .map_or("\"record\"".to_owned(), |length| length.to_string());
    text + &format!("\n[windows]\nlength = {length}\nstart = \"fitted\"\n")
}

/// Writes a temporary file and renames it.
///
/// # Errors
///
/// A folder or file that cannot be created.
pub fn write_whole(path: &Path, text: &str) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let file = tempfile::NamedTempFile::new_in(folder)?;
    std::fs::write(file.path(), text)?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}
