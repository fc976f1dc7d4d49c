//! Tests of chains of rods that hit walls, in Cartesian coordinates with constraints and in angles. Both give the same
//! impacts, each impact is logged with its jump, and no sample is beyond a wall.

use eomgen_compiled_model::{CompiledModel, EventKind, Motion, Orders, Request, Solver};
use eomgen_sim::ode::SurfaceMode;
use eomgen_tests::random_numbers::Numbers;

const MACHINES: u64 = 12;

/// Simulated time, s.
const UNTIL: f64 = 1.5;

struct Chain {
    lengths: Vec<f64>,
    masses: Vec<f64>,
    /// Initial angles from the vertical, rad.
    angles: Vec<f64>,
    /// Initial distances between the last mass and the walls, in m.
    gaps: [f64; 2],
    restitution: f64,
}

impl Chain {
    fn draw(seed: u64) -> Self {
        let mut numbers = Numbers(seed + 1);
        let links = 1 + (seed % 3) as usize;
        let mut draw = |count: usize, from: f64, to: f64| -> Vec<f64> {
            let all = (0..count).map(|_| from + (to - from) * 0.5 * (1.0 + numbers.symmetric()));
            all.collect()
        };
        Self {
            lengths: draw(links, 0.3, 1.2),
            masses: draw(links, 0.3, 2.0),
            angles: draw(links, -1.2, 1.2),
            gaps: [draw(1, 0.01, 0.3)[0], draw(1, 0.01, 0.3)[0]],
            restitution: [0.0, 0.3, 0.8][(seed / 3 % 3) as usize],
        }
    }

    fn positions(&self) -> Vec<[f64; 2]> {
        let mut place = [0.0; 2];
        let links = self.lengths.iter().zip(&self.angles);
        links
            .map(|(length, angle)| {
                place = [
                    place[0] + length * angle.sin(),
                    place[1] - length * angle.cos(),
                ];
                place
            })
            .collect()
    }

    /// Compiles the machine in coordinates x, y of each mass with constraints, or in the angles of the rods.
    fn compile(&self, has_constraints: bool) -> CompiledModel {
        let positions = self.positions();
        let last = positions.len() - 1;
        let [x, y] = positions[last];
        let mut parameters = format!(
            "g = {{ value = 9.81, unit = \"m/s^2\" }}\nw = {{ value = {:?}, unit = \"m\" }}\nf = {{ value = {:?}, unit = \"m\" }}\n",
            x - self.gaps[0],
            y - self.gaps[1]
        );
        let (mut coordinates, mut constraints, mut definitions) =
            (String::new(), String::new(), String::new());
        let (mut kinetic, mut potential) = (Vec::new(), Vec::new());
        for (i, [x, y]) in positions.iter().enumerate() {
            let (length, mass) = (self.lengths[i], self.masses[i]);
            parameters += &format!(
                "l{i} = {{ value = {length:?}, unit = \"m\" }}\nm{i} = {{ value = {mass:?}, unit = \"kg\" }}\n"
            );
            let before = |name: &str| match i {
                0 => String::new(),
                i => format!("{name}{}", i - 1),
            };
            if has_constraints {
                coordinates += &format!(
                    "x{i} = {{ unit = \"m\", initial = {x:?} }}\ny{i} = {{ unit = \"m\", initial = {y:?} }}\n"
                );
                let part = |name: &str| match i {
                    0 => format!("{name}{i}"),
                    _ => format!("({name}{i} - {})", before(name)),
                };
                constraints += &format!(
                    "rod{i} = {{ zero = \"{}^2 + {}^2 - l{i}^2\" }}\n",
                    part("x"),
                    part("y")
                );
            } else {
                coordinates += &format!(
                    "a{i} = {{ unit = \"rad\", initial = {:?} }}\n",
                    self.angles[i]
                );
                let plus = |name: &str| match i {
                    0 => String::new(),
                    _ => format!("{} + ", before(name)),
                };
                definitions += &format!("x{i} = \"{}l{i}*sin(a{i})\"\n", plus("x"));
                definitions += &format!("y{i} = \"{}-l{i}*cos(a{i})\"\n", plus("y"));
            }
            kinetic.push(format!("1/2*m{i}*(dot(x{i})^2 + dot(y{i})^2)"));
            potential.push(format!("m{i}*g*y{i}"));
        }
        let section = |name: &str, entries: &str| match entries.is_empty() {
            true => String::new(),
            false => format!("[{name}]\n{entries}"),
        };
        let e = self.restitution;
        let text = [
            "[model]\nname = \"chain\"\n".to_owned(),
            section("parameters", &parameters),
            section("coordinates", &coordinates),
            section("definitions", &definitions),
            format!("[kinetic]\nT = \"{}\"\n", kinetic.join(" + ")),
            format!("[potential]\nV = \"{}\"\n", potential.join(" + ")),
            section("constraints", &constraints),
            format!("[impacts]\nwall = {{ when = \"x{last} - w\", restitution = {e} }}\n"),
            format!("floor = {{ when = \"y{last} - f\", restitution = {e} }}\n"),
            format!("[observables]\nto_wall = \"x{last} - w\"\nto_floor = \"y{last} - f\"\n"),
        ];
        let compiled = CompiledModel::from_text("chain.toml", &text.concat(), Orders::Declared);
        compiled.unwrap_or_else(|error| panic!("{error}"))
    }
}

fn simulate(model: &CompiledModel, solver: Solver, tolerance: f64) -> Motion {
    let run = model.with_declared_parameters().unwrap();
    let times: Vec<f64> = (0..=300)
        .map(|step| UNTIL * f64::from(step) / 300.0)
        .collect();
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &run.default_inputs(),
        solver,
        tolerance,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
    assert!(motion.early_stop.is_none(), "{:?}", motion.early_stop);
    motion
}

/// Returns time and kind of all events except losses of contact.
fn hits(motion: &Motion, degrees: usize) -> Vec<(f64, String)> {
    let log = motion.event_log(degrees);
    let hits = log
        .iter()
        .filter(|event| event.kind != EventKind::Separation);
    hits.map(|event| (event.t, format!("{} {}", event.surface, event.kind.name())))
        .collect()
}

#[test]
fn impacts_with_constraints_match_impacts_in_angles_and_log_their_jumps() {
    let mut compared = 0;
    for seed in 0..MACHINES {
        let chain = Chain::draw(seed);
        let links = chain.lengths.len();
        let angles = hits(&simulate(&chain.compile(false), Solver::Rk, 1e-10), links);
        let model = chain.compile(true);
        for (solver, tolerance) in [
            (Solver::Rk, 1e-4),
            (Solver::Rk, 1e-6),
            (Solver::Rk, 1e-10),
            (Solver::Radau, 1e-6),
            (Solver::Radau, 1e-9),
        ] {
            let subject = format!("machine {seed}, {solver:?} {tolerance:e}");
            let motion = simulate(&model, solver, tolerance);
            for event in motion.event_log(2 * links) {
                assert_ne!(event.kind, EventKind::Input, "{subject}: {event:?}");
                let (_, to) = event.modes.expect("modes");
                assert_ne!(to, SurfaceMode::Negative, "{subject}: {event:?}");
            }
            let found = hits(&motion, 2 * links);
            let pairs = found.iter().zip(&angles).take(3);
            for ((t, kind), (expected, expected_kind)) in pairs {
                assert_eq!(kind, expected_kind, "{subject}");
                let allowed = 1e4 * tolerance.max(1e-9);
                assert!(
                    (t - expected).abs() < allowed,
                    "{subject}: {t} and {expected}"
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 60, "{compared}");
}
