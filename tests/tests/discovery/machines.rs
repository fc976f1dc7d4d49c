//! Small machines of all kinds, with records simulated with their models.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use eomgen_tests::program::run_accepted;
use serde_json::Value;

#[derive(Clone)]
pub struct Machine {
    pub specification: String,
    /// Unit and amplitude of the input `u`.
    pub input: (&'static str, f64),
    pub channels: Vec<Channel>,
}

/// Observable of a channel, its column of `simulate`, and its unit.
pub type Channel = (&'static str, &'static str, &'static str);

/// Mass on a spring. `SPRING` stands for the spring's energy, `PULL` for its force, `DRIVE` for the driving force.
const MASS: &str = r#"[model]
name = "mass"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 800, unit = "N/m" }
k_3 = { value = 2e6, unit = "N/m^3" }
c = { value = 3, unit = "N s/m" }
b = { value = 2e-3, unit = "m" }
F = { value = 0.5, unit = "N" }
tau = { value = 0.02, unit = "s" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
STATES[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "SPRING"
[forces]
drive = { on = "x", value = "DRIVE - c*dot(x)" }
[observables]
o = "2*x"
a = "(DRIVE - c*dot(x) - (PULL))/m"
a_o = "2*a_x"
[definitions]
a_x = "(DRIVE - c*dot(x) - (PULL))/m"
"#;

/// Returns a mass with this spring, drive and states.
pub fn mass_on_spring(spring: &str, pull: &str, drive: &str, states: &str) -> Machine {
    let specification = (MASS.replace("SPRING", spring).replace("PULL", pull))
        .replace("DRIVE", drive)
        .replace("STATES", states);
    let channels = vec![
        ("x", "x", "m"),
        ("x_dot", "x_dot", "m/s"),
        ("x_ddot", "a", "m/s^2"),
        ("o", "o", "m"),
        ("o_ddot", "a_o", "m/s^2"),
    ];
    Machine {
        specification,
        input: ("N", 6.0),
        channels,
    }
}

pub const PENDULUM: &str = r#"[model]
name = "pendulum"
[parameters]
m = { value = 1, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 0.1, unit = "N m s" }
[coordinates]
x = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
bob = "1/2*m*l^2*dot(x)^2"
[potential]
weight = "-m*g*l*cos(x)"
[forces]
drive = { on = "x", value = "u - c*dot(x)" }
[observables]
o = "l*sin(x)"
v_o = "l*cos(x)*dot(x)"
a = "a_x"
a_o = "l*(cos(x)*a_x - sin(x)*dot(x)^2)"
[definitions]
a_x = "(u - c*dot(x) - m*g*l*sin(x))/(m*l^2)"
"#;

/// Cylinder with a pressure in Pa as a first-order state.
pub const CYLINDER: &str = r#"[model]
name = "cylinder"
[parameters]
m = { value = 60, unit = "kg" }
c = { value = 500, unit = "N s/m" }
A = { value = 8e-4, unit = "m^2" }
E_V = { value = 5e12, unit = "Pa/m^3" }
K_v = { value = 5e-6, unit = "m^3/(s V)" }
p_s = { value = 1e7, unit = "Pa" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "V" }
[states]
p = { unit = "Pa", rate = "E_V*(K_v*u*sqrt(1 - p/p_s) - A*dot(x))" }
[kinetic]
load = "1/2*m*dot(x)^2"
[forces]
pressure = { on = "x", value = "A*p - c*dot(x)" }
[observables]
o = "A*p"
a = "(A*p - c*dot(x))/m"
place = "2*x"
a_place = "2*(A*p - c*dot(x))/m"
"#;

pub const BEAM: &str = r#"[model]
name = "beam"
[parameters]
J = { value = 0.02, unit = "kg m^2" }
l = { value = 0.5, unit = "m" }
mu = { value = 0.3, unit = "kg/m" }
EI = { value = 2, unit = "N m^2" }
k = { value = 4, unit = "N m" }
c = { value = 0.05, unit = "N m s" }
c_q = { value = 0.02, unit = "N s/m" }
[coordinates]
x = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[fields.w]
basis = "clamped_free"
along = "s"
from = "0"
to = "l"
unit = "m"
coordinates = "q"
order = 2
[kinetic]
hub = "1/2*J*dot(x)^2"
beam = "1/2*integral(mu*(s*dot(x) + dot(w))^2, w)"
[potential]
bending = "1/2*integral(EI*diff(w, s, 2)^2, w)"
spring = "1/2*k*x^2"
[dissipation]
losses = "1/2*c*dot(x)^2 + 1/2*sum(i, w, c_q*dot(q[i])^2)"
[forces]
drive = { on = "x", value = "u" }
[observables]
o = "at(w, l) + l*x"
v_o = "at(dot(w), l) + l*dot(x)"
"#;

pub const SAMPLES: usize = 160;
/// Time between samples, s.
pub const STEP: f64 = 0.01;

impl Machine {
    pub fn new(specification: &str, input: (&'static str, f64), channels: &[Channel]) -> Self {
        Self {
            specification: specification.to_owned(),
            input,
            channels: channels.to_vec(),
        }
    }

    /// Writes the model and its records `train.csv` and `test.csv`; returns the first.
    pub fn write_records(&self, folder: &Path) -> Table {
        fs::write(folder.join("model.toml"), &self.specification).expect("a file");
        self.record(folder, "test", 1.0);
        self.record(folder, "train", 0.0)
    }

    fn record(&self, folder: &Path, name: &str, turn: f64) -> Table {
        let mut table = self.simulate(folder, name, turn, STEP);
        table.add(
            "u",
            Table::read(&folder.join(format!("{name}_input.csv"))).column("u"),
        );
        table.write(&folder.join(format!("{name}.csv")));
        table
    }

    /// Simulates the model with its input, with samples `step` s apart.
    pub fn simulate(&self, folder: &Path, name: &str, turn: f64, step: f64) -> Table {
        self.simulate_with_solver("auto", folder, name, turn, step)
    }

    pub fn simulate_with_solver(
        &self,
        solver: &str,
        folder: &Path,
        name: &str,
        turn: f64,
        step: f64,
    ) -> Table {
        let (unit, size) = self.input;
        let mut input = "t,u\n".to_owned();
        for sample in 0..SAMPLES {
            let t = STEP * sample as f64;
            let wave = (5.0 * t * (1.0 + 0.3 * turn)).sin() + 0.6 * (14.0 * t + turn).sin();
            writeln!(input, "{t:.2},{}", size * wave).expect("a line");
        }
        let file = |ending: &str| folder.join(format!("{name}{ending}"));
        fs::write(file("_input.csv"), &input).expect("a file");
        let description = format!(
            "[records]\ntrain = [\"{name}_input.csv\"]\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\
             [inputs.u]\ncolumn = \"u\"\nunit = \"{unit}\"\n"
        );
        fs::write(file("_input.toml"), description).expect("a file");
        let paths = [file("_input.toml"), file("_motion.csv")];
        let [input_file, motion] = paths.map(|path| path.display().to_string());
        let specification = folder.join("model.toml").display().to_string();
        let until = STEP * (SAMPLES - 1) as f64;
        let (until, step) = (format!("{until:.2}"), step.to_string());
        run_accepted(&[
            "simulate",
            &specification,
            "--until",
            &until,
            "--interval",
            &step,
            "--record",
            &input_file,
            "--out",
            &motion,
            "--tolerance",
            "1e-10",
            "--solver",
            solver,
        ]);
        Table::read(&file("_motion.csv"))
    }
}

#[derive(Default)]
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    pub fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("a table");
        let mut lines = text.lines();
        let names = lines.next().expect("names").split(',');
        let names = names.map(str::to_owned).collect();
        let row = |line: &str| {
            line.split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        };
        let rows = lines.map(row).collect();
        Self { names, rows }
    }

    pub fn column(&self, name: &str) -> Vec<f64> {
        let place = self.names.iter().position(|known| known == name);
        let place = place.unwrap_or_else(|| panic!("no column {name}: {:?}", self.names));
        self.rows.iter().map(|row| row[place]).collect()
    }

    pub fn add(&mut self, name: &str, column: Vec<f64>) {
        self.names.push(name.to_owned());
        self.rows.resize(column.len(), Vec::new());
        let rows = self.rows.iter_mut().zip(column);
        rows.for_each(|(row, value)| row.push(value));
    }

    pub fn write(&self, path: &Path) {
        let mut text = self.names.join(",") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(f64::to_string).collect();
            text += &(cells.join(",") + "\n");
        }
        fs::write(path, text).expect("a file");
    }
}

pub fn standard_deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt()
}

pub fn run_command(folder: &Path, command: &str, description: &str) -> Value {
    let paths = ["model.toml", "dataset.toml", "answer"].map(|name| folder.join(name));
    fs::write(&paths[1], description).expect("a file");
    let [specification, dataset, out] = paths.map(|path| path.display().to_string());
    let mut arguments = vec![command, &specification, &dataset, "--out", &out, "--json"];
    if command == "discover" {
        arguments.extend(["--limit", "20"]);
    }
    serde_json::from_str(&run_accepted(&arguments)).expect("JSON")
}

/// Returns a dataset file with the single channel `c`.
pub fn description(machine: &Machine, channel: &Channel, noise: f64) -> String {
    let (unit, _) = machine.input;
    let (observable, column, channel_unit) = channel;
    format!(
        "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\
         [time]\ncolumn = \"t\"\nunit = \"s\"\n\
         [inputs.u]\ncolumn = \"u\"\nunit = \"{unit}\"\n\
         [channels.c]\ncolumn = \"{column}\"\nunit = \"{channel_unit}\"\nnoise = {noise:e}\n\
         observable = \"{observable}\"\n\
         [initial]\nstate = \"rest\"\n[windows]\nlength = 0.4\n"
    )
}
