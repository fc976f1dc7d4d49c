//! Random smooth models as text, correct by construction, so that their certificates must pass. The
//! generator follows the specification language only; it shares no code with the derivation, the
//! oracle or their samplers.
//!
//! Each model has up to three coordinates (angles or lengths). Kinetic energies are quadratic in the rates, with masses
//! that depend on the configuration, on time or on points, plus terms linear in the rates. Potentials use all
//! functions, some with a domain around the initial state. Models can also have dissipation, forces on coordinates and
//! points, inputs, definitions and derived parameters.

use std::fmt::Write;

/// Specification of a random model, with a list of its terms.
pub struct SmoothModel {
    /// Specification.
    pub text: String,
    /// Terms as (section, name, expression).
    pub terms: Vec<(&'static str, String, String)>,
}

/// Generator of random models.
pub struct SmoothModels {
    state: u64,
}

struct Coordinate {
    name: String,
    is_length: bool,
}

impl Coordinate {
    /// Returns the coordinate as a dimensionless expression.
    fn pure(&self) -> String {
        match self.is_length {
            true => format!("{}/L", self.name),
            false => self.name.clone(),
        }
    }

    fn rate(&self) -> String {
        match self.is_length {
            true => format!("dot({})*tau/L", self.name),
            false => format!("dot({})*tau", self.name),
        }
    }

    /// Returns the rate as an expression with the unit of a speed.
    fn speed(&self) -> String {
        match self.is_length {
            true => format!("dot({})", self.name),
            false => format!("L*dot({})", self.name),
        }
    }
}

impl SmoothModels {
    /// Creates the sequence with the seed `seed`.
    pub fn new(seed: u64) -> Self {
        Self {
            state: seed.wrapping_mul(2).wrapping_add(1),
        }
    }

    /// Returns the next random model.
    pub fn model(&mut self) -> SmoothModel {
        let coordinates = self.coordinates();
        let inputs = self.below(3);
        let points = self.below(3);
        let mut text = self.head(&coordinates, inputs);
        let arguments = self.definitions(&coordinates, points, &mut text);
        let terms = [
            self.kinetic(&coordinates, points),
            self.potential(&coordinates, &arguments, points),
            self.dissipation(&coordinates, &arguments, points),
        ];
        let mut all = Vec::new();
        for (section, terms) in ["kinetic", "potential", "dissipation"]
            .into_iter()
            .zip(terms)
        {
            if !terms.is_empty() {
                let _ = writeln!(text, "\n[{section}]");
            }
            for (place, term) in terms.into_iter().enumerate() {
                let _ = writeln!(text, "{section}_{place} = \"{term}\"");
                all.push((section, format!("{section}_{place}"), term));
            }
        }
        self.forces(
            &coordinates,
            &arguments,
            (inputs, points),
            &mut text,
            &mut all,
        );
        SmoothModel { text, terms: all }
    }

    /// Draws a number from [0, 1) with Knuth's linear congruential generator; only the high bits are used.
    fn unit(&mut self) -> f64 {
        self.state = self
            .state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let bits = (self.state >> 33) ^ (self.state >> 12);
        (bits & 0xffff_ffff) as f64 / 4_294_967_296.0
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    fn draw_between(&mut self, low: f64, high: f64) -> f64 {
        let value = low + (high - low) * self.unit();
        (value * 1e3).round() / 1e3
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    fn one_of<'c, T>(&mut self, choices: &'c [T]) -> &'c T {
        &choices[self.below(choices.len())]
    }

    fn coordinates(&mut self) -> Vec<Coordinate> {
        let count = 1 + self.below(3);
        let coordinate = |(place, is_length)| Coordinate {
            name: format!("q{place}"),
            is_length,
        };
        let kinds: Vec<bool> = (0..count).map(|_| self.chance(0.5)).collect();
        kinds.into_iter().enumerate().map(coordinate).collect()
    }

    fn head(&mut self, coordinates: &[Coordinate], inputs: usize) -> String {
        let mut text = "[model]\nname = \"smooth\"\n\n[parameters]\n".to_owned();
        let (mass, length) = (
            self.draw_between(200.0, 3000.0),
            self.draw_between(300.0, 1500.0),
        );
        let (other, energy) = (self.draw_between(0.2, 3.0), self.draw_between(0.3, 9.0));
        let (time, angle) = (
            self.draw_between(200.0, 2000.0),
            self.draw_between(5.0, 80.0),
        );
        let _ = write!(
            text,
            "m_1 = {{ value = {mass}, unit = \"g\" }}\nm_2 = {{ value = {other}, unit = \"kg\" }}\n\
             L = {{ value = {length}, unit = \"mm\" }}\nE_0 = {{ value = {energy}, unit = \"J\" }}\n\
             tau = {{ value = {time}, unit = \"ms\" }}\nal = {{ value = {angle}, unit = \"deg\" }}\n\
             mu = {{ value = \"m_1*m_2/(m_1 + m_2)\", unit = \"kg\" }}\n\
             r = {{ value = \"L*sqrt(1 + cos(al)^2)/2\", unit = \"m\" }}\n\n[coordinates]\n"
        );
        for coordinate in coordinates {
            let (unit, size) = match coordinate.is_length {
                true => ("m", 0.15),
                false => ("rad", 0.4),
            };
            let (place, rate) = (self.draw_between(-size, size), self.draw_between(-0.5, 0.5));
            let range = match self.chance(0.25) {
                true => format!(", range = [{}, {}]", -2.5 * size, 2.0 * size),
                false => String::new(),
            };
            let name = &coordinate.name;
            let _ = writeln!(
                text,
                "{name} = {{ unit = \"{unit}\", initial = {place}, initial_rate = {rate}{range} }}"
            );
        }
        if inputs > 0 {
            text += "\n[inputs]\n";
        }
        for place in 0..inputs {
            let range = match self.chance(0.3) {
                true => ", range = [-3, \"2*al\"]",
                false => "",
            };
            let _ = writeln!(text, "u{place} = {{ unit = \"1\"{range} }}");
        }
        text
    }

    /// Returns definitions of points, and dimensionless expressions to use as arguments.
    fn definitions(
        &mut self,
        coordinates: &[Coordinate],
        points: usize,
        text: &mut String,
    ) -> Vec<String> {
        *text += "\n[definitions]\n";
        let mut arguments: Vec<String> = coordinates.iter().map(Coordinate::pure).collect();
        for place in 0..points {
            let (angle, other) = (
                self.one_of(&arguments).clone(),
                self.one_of(&arguments).clone(),
            );
            let base = match place {
                0 => String::new(),
                _ => format!("x{} + ", place - 1),
            };
            let _ = writeln!(text, "x{place} = \"{base}r*sin({angle}) + L/4*({other})\"");
            let _ = writeln!(text, "y{place} = \"-L*cos({angle}) + r*({other})^2/3\"");
        }
        let mixed = self.argument(&arguments, false);
        let _ = writeln!(text, "s = \"{mixed}\"");
        arguments.push("s".to_owned());
        arguments
    }

    /// Returns a dimensionless expression of the motion, of order one.
    fn argument(&mut self, arguments: &[String], timed: bool) -> String {
        let (first, second) = (
            self.one_of(arguments).clone(),
            self.one_of(arguments).clone(),
        );
        let factor = self.draw_between(0.3, 1.2);
        let choices = if timed { 7 } else { 5 };
        match self.below(choices) {
            0 => first,
            1 => format!("({first} - {factor}*{second})"),
            2 => format!("({first})*({second})"),
            3 => format!("({factor}*{first} + al)"),
            4 => format!("({first} + {second})/(1.5 + ({second})^2)"),
            5 => format!("({first} - {factor}*sin(t/tau))"),
            _ => format!("{first}*t/tau"),
        }
    }

    /// Returns a smooth dimensionless function. If `domain`, it may be defined only around the initial state.
    fn function(&mut self, arguments: &[String], timed: bool, domain: bool) -> String {
        let z = self.argument(arguments, timed);
        let inner = match self.chance(0.25) {
            true => self.function(arguments, timed, false),
            false => z.clone(),
        };
        let a = self.draw_between(1.3, 2.5);
        let everywhere = [
            format!("sin({inner})"),
            format!("cos({a}*({inner}))"),
            format!("tan(0.5*tanh({inner}))"),
            format!("asin(0.8*sin({inner}))"),
            format!("acos(0.7*tanh({inner}))"),
            format!("atan({a}*({inner}))"),
            format!("atan2({inner}, {a} + sin({z}))"),
            format!("sinh(tanh({inner}))"),
            format!("cosh(sin({inner}))"),
            format!("tanh({inner})"),
            format!("exp(-({inner})^2)"),
            format!("ln({a} + ({inner})^2)"),
            format!("sqrt({a} + ({inner})^2)"),
            format!("({a} + cos({inner}))^1.7"),
            format!("({inner})^3"),
            format!("1/({a} + sin({inner}))"),
        ];
        let around = [
            format!("ln({a} + {z})"),
            format!("sqrt({a} + {z})"),
            format!("({a} + {z})^1.5"),
            format!("asin(({z})/{a})"),
            format!("1/({a} - {z})"),
            format!("tan({z})"),
            format!("({a} + {z})^({z})"),
        ];
        match domain {
            true => self.one_of(&around).clone(),
            false => self.one_of(&everywhere).clone(),
        }
    }

    /// Returns a dimensionless factor that is positive in its domain.
    fn positive(&mut self, arguments: &[String], timed: bool) -> String {
        let z = self.argument(arguments, timed);
        let a = self.draw_between(1.2, 2.0);
        let choices = [
            format!("({a} + sin({z}))"),
            format!("(1 + ({z})^2)"),
            format!("exp({z}/3)"),
            format!("1/(2 + cos({z}))"),
            format!("({a} + tanh({z}))^2"),
            "1".to_owned(),
        ];
        self.one_of(&choices).clone()
    }

    fn kinetic(&mut self, coordinates: &[Coordinate], points: usize) -> Vec<String> {
        let pure: Vec<String> = coordinates.iter().map(Coordinate::pure).collect();
        let mut terms = Vec::new();
        for coordinate in coordinates {
            let timed = self.chance(0.2);
            let factor = match self.chance(0.12) {
                // An inductance that decreases with the displacement is positive only near the initial state.
                true => format!("(1.6 + {})", self.one_of(&pure)),
                false => self.positive(&pure, timed),
            };
            let mass = *self.one_of(&["m_1", "m_2", "(m_1 + mu)", "2*m_2/3"]);
            terms.push(format!("1/2*{mass}*({})^2*{factor}", coordinate.speed()));
        }
        for place in 0..points {
            terms.push(format!("1/2*mu*(dot(x{place})^2 + dot(y{place})^2)"));
        }
        if let [first, second, ..] = coordinates
            && self.chance(0.5)
        {
            let (v, w) = (first.speed(), second.speed());
            let turn = self.function(&pure, false, false);
            terms.push(format!("0.1*mu*{v}*{w}*tanh({turn})"));
            terms.push(format!("1/2*mu*({v} + {w})^2"));
        }
        if self.chance(0.3) {
            let timed = self.chance(0.5);
            let shape = self.function(&pure, timed, false);
            let coordinate = self.one_of(coordinates);
            terms.push(format!("0.3*mu*L/tau*{}*{shape}", coordinate.speed()));
        }
        if self.chance(0.2) {
            terms.push("1/2*m_1*(L*dot(s))^2".to_owned());
        }
        terms
    }

    fn potential(
        &mut self,
        coordinates: &[Coordinate],
        arguments: &[String],
        points: usize,
    ) -> Vec<String> {
        let mut terms = Vec::new();
        for _ in 0..self.below(4) {
            let (timed, domain) = (self.chance(0.3), self.chance(0.35));
            let shape = self.function(arguments, timed, domain);
            terms.push(format!("E_0*{shape}"));
        }
        if self.chance(0.6) {
            let way = self.one_of(coordinates).pure();
            terms.push(format!("1/2*E_0*({way})^2 + E_0/4*({way})^4"));
        }
        if points > 0 {
            terms.push(format!("m_1*L/tau^2*y{}", self.below(points)));
        }
        terms
    }

    fn dissipation(
        &mut self,
        coordinates: &[Coordinate],
        arguments: &[String],
        points: usize,
    ) -> Vec<String> {
        let mut terms = Vec::new();
        for _ in 0..self.below(3) {
            let rate = self.one_of(coordinates).rate();
            let factor = self.positive(arguments, false);
            let strength = *self.one_of(&[0.1, 0.6, 20.0]);
            terms.push(match self.below(3) {
                0 => format!("{strength}*E_0/tau*({rate})^2*{factor}"),
                1 => format!("{strength}*E_0/tau*sqrt(({rate})^2 + 0.01)"),
                _ => format!("{strength}*E_0/tau*(({rate})^2 + ({rate})^4/8)"),
            });
        }
        if points > 0 && self.chance(0.4) {
            terms.push("0.2*m_2/tau*(dot(x0)^2 + dot(y0)^2)".to_owned());
        }
        terms
    }

    fn forces(
        &mut self,
        coordinates: &[Coordinate],
        arguments: &[String],
        (inputs, points): (usize, usize),
        text: &mut String,
        all: &mut Vec<(&'static str, String, String)>,
    ) {
        let mut forces = Vec::new();
        for _ in 0..self.below(3) {
            let (on, scale) = match self.below(3) {
                0 if points > 0 => (format!("x{}", self.below(points)), "E_0/L"),
                1 => ("s".to_owned(), "E_0"),
                _ => match self.one_of(coordinates) {
                    Coordinate {
                        name,
                        is_length: true,
                    } => (name.clone(), "E_0/L"),
                    Coordinate { name, .. } => (name.clone(), "E_0"),
                },
            };
            let rate = self.one_of(coordinates).rate();
            let shape = self.function(arguments, true, false);
            forces.push((
                on,
                match self.below(3) {
                    0 => format!("{scale}*{shape}"),
                    1 => format!("-0.3*{scale}*tanh({rate})*{shape}"),
                    _ => format!("{scale}*({shape} - 0.2*{rate})"),
                },
            ));
        }
        for place in 0..inputs {
            let Coordinate { name, is_length } = self.one_of(coordinates);
            let scale = if *is_length { "E_0/L" } else { "E_0" };
            forces.push((name.clone(), format!("{scale}*u{place}")));
        }
        if !forces.is_empty() {
            *text += "\n[forces]\n";
        }
        for (place, (on, value)) in forces.into_iter().enumerate() {
            let name = format!("force_{place}");
            let _ = writeln!(text, "{name} = {{ on = \"{on}\", value = \"{value}\" }}");
            all.push(("forces", name, value));
        }
    }
}
