//! Random machines as specification texts: chains of masses on springs with random features. Lengths, masses and times
//! vary over several decades.

use std::fmt::Write;

use eomgen_sim::inputs::HeldInputs;
use eomgen_validate::random::Random;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Linear dampers between the masses.
    Damper,
    /// Hardening spring on the first mass.
    CubicSpring,
    /// Pendulum that hangs from the last mass.
    Pendulum,
    /// Quadratic drag on the last mass.
    Drag,
    /// Dry friction on the first mass.
    DryFriction,
    /// Backlash in the first spring between two masses.
    Play,
    /// Elastic stop of the last mass.
    ElasticStop,
    /// Preloaded stops of the last mass on both sides, with nested piecewise functions.
    PreloadedStop,
    /// Rigid stop of the first mass with restitution.
    RigidStop,
    /// Force on the first mass that follows the position of the last mass with a lag.
    Lag,
    /// Input force on the last mass, held between samples.
    Input,
    /// Bead on a circle around the first mass: two coordinates and one constraint.
    Constraint,
    /// Clamped beam on the last mass.
    Beam,
}

impl Feature {
    const ALL: [Self; 13] = [
        Self::Damper,
        Self::CubicSpring,
        Self::Pendulum,
        Self::Drag,
        Self::DryFriction,
        Self::Play,
        Self::ElasticStop,
        Self::PreloadedStop,
        Self::RigidStop,
        Self::Lag,
        Self::Input,
        Self::Constraint,
        Self::Beam,
    ];

    /// Returns true if the feature can increase the energy.
    fn can_supply_energy(self) -> bool {
        matches!(self, Self::Lag | Self::Input)
    }
}

#[derive(Clone, Debug)]
pub struct Machine {
    pub text: String,
    pub features: Vec<Feature>,
    pub inputs: HeldInputs,
    /// Duration of the motion, s.
    pub until: f64,
}

impl Machine {
    /// Returns true if the energy cannot increase.
    pub fn is_passive(&self) -> bool {
        !self
            .features
            .iter()
            .any(|feature| feature.can_supply_energy())
    }
}

const FEATURE_PROBABILITY: f64 = 0.25;

/// Duration of a motion in time units of the machine.
const DURATION: f64 = 8.0;

/// Times at which the input changes, as fractions of the duration.
const INPUT_TIMES: [f64; 4] = [0.0, 0.21, 0.48, 0.77];

const SECTIONS: [&str; 10] = [
    "parameters",
    "coordinates",
    "inputs",
    "states",
    "fields.w",
    "kinetic",
    "potential",
    "dissipation",
    "forces",
    "constraints",
];

/// Units of length (m), mass (kg) and time (s) of a machine.
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

impl Units {
    fn draw(random: &mut Random) -> Self {
        let mut decade = |width: f64| 10f64.powf(width * random.symmetric());
        Self {
            length: decade(3.0),
            mass: decade(3.0),
            time: decade(2.0),
        }
    }

    /// Converts a value in the unit `name` from the machine's units to SI.
    fn si(&self, name: &str, value: f64) -> f64 {
        let Self { length, mass, time } = self;
        value
            * match name {
                "kg" => *mass,
                "m" => *length,
                "s" => *time,
                "N" => mass * length / time.powi(2),
                "N/m" => mass / time.powi(2),
                "N/m^3" => mass / time.powi(2) / length.powi(2),
                "N s/m" => mass / time,
                "N s^2/m^2" => mass / length,
                "m/s^2" => length / time.powi(2),
                "m/s" => length / time,
                "kg/m" => mass / length,
                "N m^2" => mass * length.powi(3) / time.powi(2),
                _ => 1.0,
            }
    }
}

struct Writer<'r> {
    random: &'r mut Random,
    units: Units,
    sections: [String; SECTIONS.len()],
    impacts: String,
}

impl Writer<'_> {
    fn line(&mut self, section: &str, line: &str) {
        if let Some(place) = SECTIONS.iter().position(|name| *name == section) {
            let _ = writeln!(self.sections[place], "{line}");
        }
    }

    /// Writes a parameter with a random value between two bounds in the machine's units.
    fn parameter(&mut self, name: &str, unit: &str, (low, high): (f64, f64)) {
        let value = self.units.si(unit, low + (high - low) * self.random.unit());
        let line = format!("{name} = {{ value = {value:e}, unit = \"{unit}\" }}");
        self.line("parameters", &line);
    }

    /// Writes mass `place` with its position as a coordinate with a random initial state.
    fn mass(&mut self, place: usize) {
        let position = self.units.si("m", self.random.symmetric());
        let rate = self.units.si("m/s", self.random.symmetric());
        self.line(
            "coordinates",
            &format!(
                "x_{place} = {{ unit = \"m\", initial = {position:e}, initial_rate = {rate:e} }}"
            ),
        );
        self.parameter(&format!("m_{place}"), "kg", (0.5, 2.0));
        self.parameter(&format!("k_{place}"), "N/m", (0.5, 20.0));
        self.line(
            "kinetic",
            &format!("m_{place} = \"1/2*m_{place}*dot(x_{place})^2\""),
        );
    }

    fn springs(&mut self, count: usize, has_play: bool) {
        self.line("potential", "k_0 = \"1/2*k_0*x_0^2\"");
        for place in 1..count {
            let stretch = format!("x_{place} - x_{}", place - 1);
            let stretch = match has_play && place == 1 {
                true => format!("deadzone({stretch}, b_play)"),
                false => stretch,
            };
            self.line(
                "potential",
                &format!("k_{place} = \"1/2*k_{place}*({stretch})^2\""),
            );
        }
    }

    fn feature(&mut self, feature: Feature, count: usize) {
        let last = format!("x_{}", count - 1);
        match feature {
            Feature::Damper => {
                self.parameter("c", "N s/m", (0.02, 0.5));
                self.line("dissipation", "c_0 = \"1/2*c*dot(x_0)^2\"");
                self.line("dissipation", &format!("c_n = \"1/2*c*dot({last})^2\""));
            }
            Feature::CubicSpring => {
                self.parameter("k_cubic", "N/m^3", (0.5, 10.0));
                self.line("potential", "cubic = \"1/4*k_cubic*x_0^4\"");
            }
            Feature::Pendulum => self.pendulum(&last),
            Feature::Drag => {
                self.parameter("c_drag", "N s^2/m^2", (0.05, 0.5));
                self.force(
                    "drag",
                    &last,
                    &format!("-c_drag*abs(dot({last}))*dot({last})"),
                );
            }
            Feature::DryFriction => {
                self.parameter("F_dry", "N", (0.05, 1.0));
                self.force("dry", "x_0", "-F_dry*sign(dot(x_0))");
            }
            Feature::Play => self.parameter("b_play", "m", (0.02, 0.5)),
            Feature::ElasticStop => {
                self.parameter("k_stop", "N/m", (10.0, 1000.0));
                self.parameter("d_stop", "m", (0.1, 1.0));
                self.line(
                    "potential",
                    &format!("stop = \"1/2*k_stop*max({last} - d_stop, 0)^2\""),
                );
            }
            Feature::PreloadedStop => {
                self.parameter("F_stop", "N", (0.1, 3.0));
                self.parameter("d_pre", "m", (0.1, 1.0));
                self.line(
                    "potential",
                    &format!("preload = \"F_stop*max(abs({last}) - d_pre, 0)\""),
                );
            }
            Feature::RigidStop => {
                self.parameter("d_rigid", "m", (1.05, 1.5));
                self.parameter("e", "1", (0.3, 0.9));
                self.impacts =
                    "[impacts]\nstop = { when = \"x_0 + d_rigid\", restitution = \"e\" }\n"
                        .to_owned();
            }
            Feature::Lag => {
                self.parameter("tau", "s", (0.05, 1.0));
                self.parameter("k_lag", "N/m", (0.1, 0.5));
                self.line(
                    "states",
                    &format!("z = {{ unit = \"m\", rate = \"({last} - z)/tau\" }}"),
                );
                self.force("lag", "x_0", "k_lag*z");
            }
            Feature::Input => {
                self.line("inputs", "u = { unit = \"N\" }");
                self.force("input", &last, "u");
            }
            Feature::Constraint => self.bead(),
            Feature::Beam => self.beam(&last),
        }
    }

    fn force(&mut self, name: &str, on: &str, value: &str) {
        self.line(
            "forces",
            &format!("{name} = {{ on = \"{on}\", value = \"{value}\" }}"),
        );
    }

    fn pendulum(&mut self, pivot: &str) {
        let angle = 2.0 * self.random.symmetric();
        self.line(
            "coordinates",
            &format!("theta = {{ unit = \"rad\", initial = {angle:e} }}"),
        );
        self.parameter("m_p", "kg", (0.1, 1.0));
        self.parameter("l_p", "m", (0.5, 2.0));
        self.parameter("g_p", "m/s^2", (1.0, 10.0));
        self.line(
            "kinetic",
            &format!(
                "pendulum = \"1/2*m_p*((dot({pivot}) + l_p*cos(theta)*dot(theta))^2 + (l_p*sin(theta)*dot(theta))^2)\""
            ),
        );
        self.line("potential", "pendulum = \"-m_p*g_p*l_p*cos(theta)\"");
    }

    fn bead(&mut self) {
        let angle = 3.0 * self.random.symmetric();
        let radius = self.units.si("m", 0.5 + self.random.unit());
        let (sine, cosine) = angle.sin_cos();
        for (name, position) in [("u_x", radius * cosine), ("u_y", radius * sine)] {
            self.line(
                "coordinates",
                &format!("{name} = {{ unit = \"m\", initial = {position:e} }}"),
            );
        }
        self.line(
            "parameters",
            &format!("r_b = {{ value = {radius:e}, unit = \"m\" }}"),
        );
        self.parameter("m_b", "kg", (0.2, 1.0));
        self.parameter("g_b", "m/s^2", (1.0, 5.0));
        self.parameter("k_b", "N/m", (0.2, 2.0));
        self.line("kinetic", "bead = \"1/2*m_b*(dot(u_x)^2 + dot(u_y)^2)\"");
        self.line(
            "potential",
            "bead = \"m_b*g_b*u_y + 1/2*k_b*(u_x - x_0)^2\"",
        );
        self.line(
            "constraints",
            "circle = { zero = \"u_x^2 + u_y^2 - r_b^2\" }",
        );
    }

    fn beam(&mut self, base: &str) {
        self.parameter("mu", "kg/m", (0.2, 1.0));
        self.parameter("EI", "N m^2", (0.2, 2.0));
        self.parameter("l_w", "m", (0.7, 1.5));
        let order = 1 + (2.0 * self.random.unit()) as usize;
        for line in [
            "along = \"s\"",
            "from = 0",
            "to = \"l_w\"",
            "basis = \"clamped_free\"",
            "coordinates = \"q\"",
            "unit = \"m\"",
            &format!("order = {order}"),
        ] {
            self.line("fields.w", line);
        }
        self.line(
            "kinetic",
            &format!("beam = \"1/2*mu*integral((dot({base}) + dot(w))^2, w)\""),
        );
        self.line(
            "potential",
            "beam = \"1/2*EI*integral(diff(w, s, 2)^2, w)\"",
        );
    }

    fn text(&self) -> String {
        let mut text = "[model]\nname = \"drawn\"\n".to_owned();
        for (name, lines) in SECTIONS.iter().zip(&self.sections) {
            if !lines.is_empty() {
                let _ = write!(text, "[{name}]\n{lines}");
            }
        }
        text + &self.impacts
    }
}

pub fn draw(random: &mut Random) -> Machine {
    let units = Units::draw(random);
    let count = 1 + (3.0 * random.unit()) as usize;
    let mut features: Vec<Feature> = Feature::ALL
        .into_iter()
        .filter(|feature| {
            let is_drawn = random.unit() < FEATURE_PROBABILITY;
            is_drawn && (count > 1 || *feature != Feature::Play)
        })
        .collect();
    // Solvers reject dry friction together with impacts.
    let is_dry = features.contains(&Feature::DryFriction);
    features.retain(|feature| !is_dry || *feature != Feature::RigidStop);
    let until = DURATION * units.time;
    let force = units.si("N", 1.0);
    let mut writer = Writer {
        random,
        units,
        sections: Default::default(),
        impacts: String::new(),
    };
    for place in 0..count {
        writer.mass(place);
    }
    writer.springs(count, features.contains(&Feature::Play));
    for feature in &features {
        writer.feature(*feature, count);
    }
    let text = writer.text();
    let inputs = match features.contains(&Feature::Input) {
        true => draw_inputs(random, until, force),
        false => HeldInputs::zero(0),
    };
    Machine {
        text,
        features,
        inputs,
        until,
    }
}

/// Returns random input forces up to `force` (N), each held over a part of the duration.
fn draw_inputs(random: &mut Random, until: f64, force: f64) -> HeldInputs {
    let times = INPUT_TIMES.map(|part| part * until).to_vec();
    let values = times.iter().map(|_| force * random.symmetric()).collect();
    HeldInputs::new(times, values, 1).unwrap_or_else(|| HeldInputs::zero(1))
}
