//! Tests of random rows of masses with springs and dry friction.

use eomgen_compiled_model::Solver;

use super::time_stepping::{DryFriction, Machine};
use super::{GENERAL, compile_text, grid, simulated};

/// Generator of pseudorandom numbers between 0 and 1.
pub(super) struct Numbers(pub(super) u64);

impl Numbers {
    pub(super) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns the specification of a row from its coordinates, kinetic and potential energies and
/// forces.
fn specification([coordinates, kinetic, potential, forces]: &[String; 4]) -> String {
    format!(
        r#"
[model]
name = "row"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 1, unit = "N/m" }}
c = {{ value = 1, unit = "N s/m" }}
F = {{ value = 1, unit = "N" }}
v = {{ value = 1, unit = "m/s" }}
s = {{ value = 1, unit = "s" }}
[coordinates]
{coordinates}
[kinetic]
{kinetic}
[potential]
{potential}
[forces]
{forces}
"#
    )
}

/// Returns a random row of masses between springs with periodic forces. Each mass has friction at the ground, on a belt
/// or at the preceding mass. No motion is resisted by two frictions, because their forces would not be unique.
fn random_row(seed: u64) -> String {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut number = |least: f64, most: f64| least + (most - least) * numbers.next();
    let count = 1 + (seed % 3) as usize;
    let mut coordinates = String::new();
    let (mut kinetic, mut potential, mut forces) = (String::new(), String::new(), String::new());
    for i in 0..count {
        let (place, speed) = (number(-0.3, 0.3), number(-0.5, 0.5));
        let speed = if number(0.0, 1.0) < 0.4 { 0.0 } else { speed };
        coordinates +=
            &format!("x_{i} = {{ unit = \"m\", initial = {place}, initial_rate = {speed} }}\n");
        kinetic += &format!("T_{i} = \"{}*m*dot(x_{i})^2\"\n", number(0.2, 1.0));
        let before = if i == 0 {
            "x_0".to_owned()
        } else {
            format!("(x_{i} - x_{})", i - 1)
        };
        potential += &format!("V_{i} = \"{}*k*{before}^2\"\n", number(10.0, 60.0));
        let belt = if number(0.0, 1.0) < 0.3 {
            number(-0.2, 0.2)
        } else {
            0.0
        };
        let is_rubbed = number(0.0, 1.0) < 0.6;
        if is_rubbed {
            let level = number(0.5, 4.0);
            forces += &format!(
                "rub_{i} = {{ on = \"x_{i}\", value = \"-{level}*F*sign(dot(x_{i}) - {belt}*v)\" }}\n"
            );
        }
        if i > 0 && !is_rubbed {
            let level = number(0.5, 3.0);
            forces += &format!(
                "between_{i} = {{ on = \"x_{i} - x_{0}\", value = \"-{level}*F*sign(dot(x_{i}) - dot(x_{0}))\" }}\n",
                i - 1
            );
        }
        let (push, rate) = (number(1.0, 8.0), number(2.0, 12.0));
        forces +=
            &format!("push_{i} = {{ on = \"x_{i}\", value = \"{push}*F*sin({rate}*t/s)\" }}\n");
        forces += &format!(
            "damper_{i} = {{ on = \"x_{i}\", value = \"-{}*c*dot(x_{i})\" }}\n",
            number(0.0, 0.5)
        );
    }
    specification(&[coordinates, kinetic, potential, forces])
}

#[test]
fn random_rows_match_exact_solver() {
    let times = grid(4.0, 40);
    let (mut compared, mut held) = (0, 0);
    for seed in 1..=40 {
        let text = random_row(seed);
        let model = compile_text(&text);
        let run = model.with_declared_parameters().unwrap();
        let none = run.default_inputs();
        let Ok(exact) = run.simulate(run.initial_state(), &times, &none, Solver::Exact) else {
            continue;
        };
        compared += 1;
        let reference = run.observables(&exact).unwrap();
        for solver in GENERAL {
            let motion = simulated(&model, &[], &times, solver);
            let rows = run.observables(&motion).unwrap();
            let pairs = motion
                .trajectory
                .states
                .iter()
                .zip(&exact.trajectory.states);
            let mut worst = 0.0_f64;
            for (place, (a, b)) in pairs.enumerate() {
                worst = worst.max(difference(a, b));
                // Powers must agree as well, except in a row at an event.
                let power = (rows[place][1] - reference[place][1]).abs();
                assert!(power < 1e-3, "{seed} {solver} {place}: power {power:e}");
            }
            assert!(worst < 1e-6, "{seed} {solver}: {worst:e}\n{text}");
        }
        held += exact.trajectory.events.len();
    }
    println!("{compared} rows, {held} switches");
    assert!(compared >= 25 && held > 300, "{compared} {held}");
}

/// Row of up to three masses between springs with periodic forces. Each mass has dry friction at the ground, on a belt
/// and at the preceding mass.
struct Row {
    count: usize,
    masses: [f64; 3],
    places: [f64; 3],
    speeds: [f64; 3],
    springs: [f64; 3],
    dampers: [f64; 3],
    pushes: [(f64, f64); 3],
    belts: [f64; 3],
    at_ground: [f64; 3],
    between: [f64; 3],
}

impl Row {
    fn random(seed: u64) -> Self {
        let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let mut number = |least: f64, most: f64| least + (most - least) * numbers.next();
        let mut three = |least: f64, most: f64, part: f64| -> [f64; 3] {
            std::array::from_fn(|_| {
                let value = number(least, most);
                if number(0.0, 1.0) < part { value } else { 0.0 }
            })
        };
        let mut between = three(0.5, 3.0, 0.7);
        between[0] = 0.0;
        let (pushes, rates) = (three(1.0, 8.0, 1.0), three(2.0, 12.0, 1.0));
        Self {
            count: 2 + (seed % 2) as usize,
            masses: three(0.2, 1.0, 1.0),
            places: three(-0.3, 0.3, 1.0),
            speeds: three(-0.5, 0.5, 0.5),
            springs: three(10.0, 60.0, 1.0),
            dampers: three(0.0, 0.5, 0.7),
            pushes: std::array::from_fn(|i| (pushes[i], rates[i])),
            belts: three(-0.2, 0.2, 0.2),
            at_ground: three(0.5, 4.0, 0.6),
            between,
        }
    }

    fn text(&self) -> String {
        let mut sections = [const { String::new() }; 4];
        let [coordinates, kinetic, potential, forces] = &mut sections;
        for i in 0..self.count {
            *coordinates += &format!(
                "x_{i} = {{ unit = \"m\", initial = {}, initial_rate = {} }}\n",
                self.places[i], self.speeds[i]
            );
            *kinetic += &format!("T_{i} = \"{}/2*m*dot(x_{i})^2\"\n", self.masses[i]);
            let stretch = match i {
                0 => "x_0".to_owned(),
                _ => format!("(x_{i} - x_{})", i - 1),
            };
            *potential += &format!("V_{i} = \"{}/2*k*{stretch}^2\"\n", self.springs[i]);
            let (push, rate) = self.pushes[i];
            *forces += &format!(
                "push_{i} = {{ on = \"x_{i}\", value = \"{push}*F*sin({rate}*t/s)\" }}\n\
                 damper_{i} = {{ on = \"x_{i}\", value = \"-{}*c*dot(x_{i})\" }}\n",
                self.dampers[i]
            );
            if self.at_ground[i] > 0.0 {
                *forces += &format!(
                    "rub_{i} = {{ on = \"x_{i}\", value = \"-{}*F*sign(dot(x_{i}) - {}*v)\" }}\n",
                    self.at_ground[i], self.belts[i]
                );
            }
            if self.between[i] > 0.0 {
                *forces += &format!(
                    "between_{i} = {{ on = \"x_{i} - x_{0}\", value = \"-{1}*F*sign(dot(x_{i}) - dot(x_{0}))\" }}\n",
                    i - 1,
                    self.between[i]
                );
            }
        }
        specification(&sections)
    }

    fn simulate_by_time_stepping(&self, until: f64, steps: u32) -> Vec<f64> {
        let count = self.count;
        let inside = |i: usize| i < count;
        let machine = Machine {
            inverse_mass: &|_| {
                std::array::from_fn(|i| {
                    std::array::from_fn(|j| if i == j { 1.0 / self.masses[i] } else { 0.0 })
                })
            },
            forces: &|t, x: [f64; 3], v: [f64; 3]| {
                let mut forces = [0.0; 3];
                for i in (0..3).filter(|i| inside(*i)) {
                    let (push, rate) = self.pushes[i];
                    let before = if i == 0 { 0.0 } else { x[i - 1] };
                    let spring = self.springs[i] * (x[i] - before);
                    forces[i] += push * f64::sin(rate * t) - self.dampers[i] * v[i] - spring;
                    if i > 0 {
                        forces[i - 1] += spring;
                    }
                }
                forces
            },
            rubbing: &|_, _| {
                let mut rubbing = Vec::new();
                for i in (0..3).filter(|i| inside(*i)) {
                    let mut along = [0.0; 3];
                    along[i] = 1.0;
                    if self.at_ground[i] > 0.0 {
                        rubbing.push(DryFriction {
                            along,
                            drift: self.belts[i],
                            level: self.at_ground[i],
                        });
                    }
                    if self.between[i] > 0.0 {
                        along[i - 1] = -1.0;
                        rubbing.push(DryFriction {
                            along,
                            drift: 0.0,
                            level: self.between[i],
                        });
                    }
                }
                rubbing
            },
        };
        let zero = |all: [f64; 3]| std::array::from_fn(|i| if inside(i) { all[i] } else { 0.0 });
        let end =
            machine.simulate_by_time_stepping((zero(self.places), zero(self.speeds)), until, steps);
        [&end[..count], &end[3..3 + count]].concat()
    }
}

#[test]
fn rows_with_several_frictions_match_time_stepping() {
    let until = 3.0;
    let times = grid(until, 60);
    for seed in (1..=60).chain([65, 91, 103, 151, 152, 167]) {
        let row = Row::random(seed);
        let model = compile_text(&row.text());
        let motion = simulated(&model, &[], &times, Solver::Exact).trajectory;
        for solver in GENERAL {
            let other = simulated(&model, &[], &times, solver).trajectory;
            for (t, (a, b)) in times.iter().zip(motion.states.iter().zip(&other.states)) {
                let apart = difference(a, b);
                assert!(apart < 1e-6, "{solver} {seed}, t = {t}: {apart:e}");
            }
        }
        if seed <= 24 {
            let apart = difference(
                &row.simulate_by_time_stepping(until, 30_000),
                &motion.final_state,
            );
            assert!(apart < 2e-3, "{seed}: {apart:e}");
        }
    }
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}
