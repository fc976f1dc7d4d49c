//! Tests of gradients of trajectories against finite differences: smooth motions, crossed surfaces, sticking, held
//! inputs, fields and first-order states. Motions without a gradient must be rejected.

use eomgen_compiled_model::{
    CompiledModel, Error, Instance, Orders, Request, SampleWeights, Solver, TrajectoryGradient,
};
use eomgen_sim::inputs::HeldInputs;

const TOLERANCE: f64 = 1e-12;

/// Returns times of samples up to `until`, s.
fn times(until: f64) -> Vec<f64> {
    (0..=20)
        .map(|sample| until * f64::from(sample) / 20.0)
        .collect()
}

/// Returns random weights for all samples; no value occurs twice.
fn drawn_weights(samples: usize, states: usize, observables: usize) -> SampleWeights {
    let row = |sample: usize, width: usize, shift: f64| -> Vec<f64> {
        (0..width)
            .map(|place| (1.3 * sample as f64 + 2.1 * place as f64 + shift).sin())
            .collect()
    };
    SampleWeights {
        states: (0..samples)
            .map(|sample| row(sample, states, 0.2))
            .collect(),
        observables: (0..samples)
            .map(|sample| row(sample, observables, 0.9))
            .collect(),
    }
}

struct Case<'c> {
    run: Instance<'c>,
    initial: Vec<f64>,
    inputs: HeldInputs,
    times: Vec<f64>,
}

impl Case<'_> {
    fn request<'r>(&'r self, initial: &'r [f64], inputs: &'r HeldInputs) -> Request<'r> {
        Request {
            initial,
            times: &self.times,
            inputs,
            solver: Solver::Rk,
            tolerance: TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        }
    }

    /// Returns the weighted sum of the samples.
    fn value(
        &self,
        run: &Instance<'_>,
        (initial, inputs): (&[f64], &HeldInputs),
        weights: &SampleWeights,
    ) -> Result<f64, Error> {
        let motion = run.simulate_until_stop(&self.request(initial, inputs), &mut |_| {})?;
        let motion = motion.into_complete()?;
        let observables = run.observables(&motion)?;
        let sum = |rows: &[Vec<f64>], weights: &[Vec<f64>]| -> f64 {
            let pairs = rows.iter().flatten().zip(weights.iter().flatten());
            pairs.map(|(value, weight)| value * weight).sum()
        };
        Ok(sum(&motion.trajectory.states, &weights.states)
            + sum(&observables, &weights.observables))
    }

    fn gradient(&self, weights: &SampleWeights) -> Result<TrajectoryGradient, Error> {
        let recorded = self
            .run
            .record_motion(&self.request(&self.initial, &self.inputs), &mut |_| {})?;
        recorded.gradient(weights)
    }
}

/// Compares a derivative with four-point differences by several steps, in fractions of `size`. Large steps cross
/// events, and small steps have large rounding errors. A wrong derivative agrees with none of them to 6 digits.
fn compare(
    what: &str,
    found: f64,
    (size, least): (f64, f64),
    value: impl Fn(f64) -> Result<f64, Error>,
) -> Result<(), Error> {
    let pair = |far: f64| -> Result<f64, Error> { Ok((value(far)? - value(-far)?) / (2.0 * far)) };
    let mut differences = Vec::new();
    for exponent in [3, 4, 5, 6] {
        let step = size * 0.1_f64.powi(exponent);
        differences.push((4.0 * pair(step)? - pair(2.0 * step)?) / 3.0);
    }
    let error = |difference: &f64| (found - difference).abs() / difference.abs().max(least);
    let smallest = differences.iter().map(error).fold(f64::INFINITY, f64::min);
    assert!(
        smallest < 1e-6,
        "{what}: {found}, not one of {differences:?}"
    );
    Ok(())
}

/// Compares the gradient with finite differences with respect to all states, parameters and inputs.
fn compare_with_differences(case: &Case<'_>) -> Result<(), Error> {
    let model = case.run.model();
    let observables = model.observable_names().len();
    let weights = drawn_weights(case.times.len(), case.initial.len(), observables);
    let found = case.gradient(&weights)?;
    let nominal = (&case.initial[..], &case.inputs);
    let names = model.parameter_names();
    for (place, name) in names.iter().enumerate() {
        let unit = model
            .model()
            .parameters
            .iter()
            .find(|own| own.name == *name);
        let Some(unit) = unit.map(|own| &own.unit) else {
            continue;
        };
        let value = case.run.parameters()[place];
        let moved = |by: f64| {
            let run = model.with_parameters(&[(name, unit.from_si(value + by))])?;
            case.value(&run, nominal, &weights)
        };
        let size = if value == 0.0 { 1.0 } else { value.abs() };
        let least = 1e-4 * case.value(&case.run, nominal, &weights)?.abs() / size;
        compare(name, found.parameters[place], (size, least), moved)?;
    }
    let motion = case
        .run
        .simulate(&case.initial, &case.times, &case.inputs, Solver::Rk)?;
    let sizes = (0..case.initial.len()).map(|place| {
        let values = motion
            .trajectory
            .states
            .iter()
            .map(|state| state[place].abs());
        values.fold(0.0, f64::max)
    });
    let sizes: Vec<f64> = sizes.collect();
    if let Some(by_state) = &found.initial_state {
        for (place, by_state) in by_state.iter().enumerate() {
            let moved = |by: f64| {
                let mut initial = case.initial.clone();
                initial[place] += by;
                case.value(&case.run, (&initial, &case.inputs), &weights)
            };
            let size = sizes[place];
            compare(&format!("state {place}"), *by_state, (size, 1e-4), moved)?;
        }
    }
    let times = case.inputs.times().to_vec();
    for (row, by_inputs) in found.inputs.iter().enumerate() {
        for (place, by_input) in by_inputs.iter().enumerate() {
            let moved = |by: f64| {
                let mut values: Vec<f64> = (times.iter())
                    .flat_map(|t| case.inputs.last_sample(*t).to_vec())
                    .collect();
                values[row * by_inputs.len() + place] += by;
                let inputs = HeldInputs::new(times.clone(), values, by_inputs.len()).expect("rows");
                case.value(&case.run, (&case.initial, &inputs), &weights)
            };
            compare(
                &format!("input {row} {place}"),
                *by_input,
                (1.0, 1e-4),
                moved,
            )?;
        }
    }
    Ok(())
}

fn compare_text(text: &str, inputs: Option<HeldInputs>, until: f64) -> Result<(), Error> {
    let model = CompiledModel::from_text("machine.toml", text, Orders::Declared)?;
    let run = model.with_declared_parameters()?;
    let initial = run.initial_state().to_vec();
    let inputs = inputs.unwrap_or_else(|| run.default_inputs());
    compare_with_differences(&Case {
        run,
        initial,
        inputs,
        times: times(until),
    })
}

const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 700, unit = "mm" }
b = { value = 0.3, unit = "N m s" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { unit = "rad", initial = 0.6 }
[states]
z = { unit = "N m", rate = "(b*dot(theta) - z)/T", initial = 0.1 }
[inputs]
M = { unit = "N m" }
[definitions]
x = "l*sin(theta)"
y = "-l*cos(theta)"
[kinetic]
mass = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[forces]
drive = { on = "theta", value = "M - z" }
[observables]
x_m = { value = "x", unit = "m" }
"#;

#[test]
fn gradients_of_smooth_motion_equal_differences() -> Result<(), Error> {
    let text = PENDULUM.replace(
        "[coordinates]",
        "T = { value = 20, unit = \"ms\" }\n[coordinates]",
    );
    let inputs = HeldInputs::new(vec![0.0, 0.4, 1.1], vec![0.5, -1.2, 2.0], 1);
    compare_text(&text, inputs, 2.0)
}

/// Two masses with play, and a damper that acts on one side.
const PLAY: &str = r#"
[model]
name = "play"
[parameters]
m = { value = 1.5, unit = "kg" }
M = { value = 2.5, unit = "kg" }
k = { value = 400, unit = "N/m" }
c = { value = 3, unit = "N s/m" }
d = { value = 8, unit = "mm" }
F = { value = 4, unit = "N" }
h = { value = 6, unit = "N" }
[coordinates]
x = { unit = "m", initial = 0.05 }
y = { unit = "m" }
[definitions]
s = "x - y"
[kinetic]
masses = "1/2*m*dot(x)^2 + 1/2*M*dot(y)^2"
[potential]
mesh = "1/2*k*deadzone(s, d)^2"
wall = "1/2*k*y^2"
[forces]
damper = { on = "x", value = "-c*dot(x) + F*cos(3*t/one)" }
pawl = { on = "y", value = "-h*above(dot(y) - v)" }
"#;

#[test]
fn gradients_through_crossed_surfaces_equal_differences() -> Result<(), Error> {
    let text = PLAY.replace(
        "[coordinates]",
        "one = { value = 1, unit = \"s\" }\nv = { value = 0.04, unit = \"m/s\" }\n[coordinates]",
    );
    compare_text(&text, None, 1.5)
}

/// Block that slides, sticks and slides again under a growing force.
const BLOCK: &str = r#"
[model]
name = "block"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 30, unit = "N/m" }
F_c = { value = 3, unit = "N" }
A = { value = 9, unit = "N" }
w = { value = 2, unit = "rad/s" }
[coordinates]
x = { unit = "m", initial = 0.1 }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
drive = { on = "x", value = "A*sin(w*t) + u" }
friction = { on = "x", value = "-F_c*(1 + 0.2*x^2/one^2)*sign(dot(x))" }
"#;

#[test]
fn gradients_through_sticking_equal_differences() -> Result<(), Error> {
    let text = BLOCK
        .replace(
            "[coordinates]",
            "one = { value = 1, unit = \"m\" }\n[coordinates]",
        )
        .replace("initial = 0.1 }", "initial = 0.1, initial_rate = 0.3 }");
    let inputs = HeldInputs::new(vec![0.0, 1.7], vec![0.5, -1.5], 1);
    compare_text(&text, inputs, 6.0)
}

#[test]
fn gradients_through_sticking_of_a_brake_that_is_open_at_first_equal_differences()
-> Result<(), Error> {
    let text = "[model]\nname = \"brake\"\n[parameters]\nJ = { value = 1, unit = \"kg m^2\" }\n\
                M = { value = 10, unit = \"N m\" }\nk = { value = 5, unit = \"N m\" }\n\
                w = { value = 3, unit = \"1/s\" }\n[coordinates]\n\
                q = { unit = \"rad\", initial_rate = 3 }\n[states]\n\
                N = { unit = \"N m\", rate = \"w*(M - N)\" }\n\
                [kinetic]\nt = \"1/2*J*dot(q)^2\"\n[potential]\nv = \"1/2*k*q^2\"\n\
                [forces]\nbrake = { on = \"q\", value = \"-N*sign(dot(q))\" }\n";
    compare_text(text, None, 1.0)
}

#[test]
fn gradients_of_flexible_arm_with_play_equal_differences() -> Result<(), Error> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let place = folder.join("../../model-spec/models/planetary_arm.toml");
    let model = CompiledModel::load(place, Orders::Uniform(1))?;
    let run = model.with_declared_parameters()?;
    let case = Case {
        initial: run.initial_state().to_vec(),
        inputs: run.default_inputs(),
        times: times(0.02),
        run,
    };
    compare_with_differences(&case)
}

/// Returns the message of a machine whose motion has no gradient.
fn rejection(text: &str, until: f64) -> String {
    let model = CompiledModel::from_text("machine.toml", text, Orders::Declared);
    let model = model.unwrap_or_else(|error| panic!("{error}"));
    let run = model.with_declared_parameters();
    let run = run.unwrap_or_else(|error| panic!("{error}"));
    let case = Case {
        initial: run.initial_state().to_vec(),
        inputs: run.default_inputs(),
        times: times(until),
        run,
    };
    let weights = drawn_weights(
        case.times.len(),
        case.initial.len(),
        model.observable_names().len(),
    );
    let found = case.gradient(&weights);
    found.expect_err("no gradient").to_string()
}

/// Returns an oscillator with a damper that acts only beyond the position `place`.
fn oscillator(x: f64, v: f64, place: f64, more: &str) -> String {
    format!(
        r#"
[model]
name = "oscillator"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 1, unit = "N/m" }}
F = {{ value = 0.5, unit = "N" }}
p = {{ value = {place}, unit = "m" }}
[coordinates]
x = {{ unit = "m", initial = {x}, initial_rate = {v} }}
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
stop = {{ on = "x", value = "-F*above(x - p)" }}
{more}"#
    )
}

#[test]
fn motion_that_touches_a_surface_has_no_gradient() {
    for shift in [-1e-13, 0.0, 1e-13] {
        let message = rejection(&oscillator(0.0, 1.0, 1.0 + shift, ""), 3.0);
        assert!(
            message.contains("touches the surface `x - p` = 0"),
            "{message}"
        );
        assert!(message.contains("t = 1.570"), "{message}");
    }
    let message = rejection(&oscillator(0.3, 1.0, 0.3, ""), 3.0);
    assert!(
        message.contains("t = 0.0 s, the motion touches"),
        "{message}"
    );
}

#[test]
fn models_without_gradients_are_rejected_by_name() {
    for (more, name) in [
        (
            "[impacts]\nfloor = { when = \"x + 9*p\", restitution = 1, friction = 0.1, slip = \"dot(x)\" }\n",
            "friction at the impact `floor`",
        ),
        (
            "[controllers.c]\nperiod = { value = 1, unit = \"ms\" }\noutputs = { u = \"-x*one\" }\n",
            "the controller `c`",
        ),
    ] {
        let driven = "[coordinates]";
        let input =
            "one = { value = 1, unit = \"N/m\" }\n[inputs]\nu = { unit = \"N\" }\n[coordinates]";
        let text = oscillator(0.3, 1.0, 0.7, more).replace(driven, input);
        let text = text.replace("-F*above(x - p)", "-F*above(x - p) + u");
        let message = rejection(&text, 1.0);
        assert!(message.contains(name), "{message}");
    }
}

#[test]
fn motion_that_starts_at_rest_has_no_gradient_by_its_start() -> Result<(), Error> {
    let text = BLOCK.replace(
        "[coordinates]",
        "one = { value = 1, unit = \"m\" }\n[coordinates]",
    );
    let text = text.replace("initial = 0.1", "initial = 0.01");
    let model = CompiledModel::from_text("block.toml", &text, Orders::Declared)?;
    let run = model.with_declared_parameters()?;
    let case = Case {
        initial: run.initial_state().to_vec(),
        inputs: run.default_inputs(),
        times: times(3.0),
        run,
    };
    compare_with_differences(&case)?;
    let weights = drawn_weights(case.times.len(), 2, model.observable_names().len());
    assert_eq!(case.gradient(&weights)?.initial_state, None);
    Ok(())
}

/// Compares the computation time of a gradient with that of simulations. A gradient makes each step twice and computes
/// its products once.
#[test]
fn gradient_by_fifty_parameters_costs_less_than_six_simulations() -> Result<(), Error> {
    let parts = 16;
    let each = |line: &dyn Fn(usize) -> String| -> String { (0..parts).map(line).collect() };
    let before = |i: usize| {
        if i == 0 {
            "0*x_0".to_owned()
        } else {
            format!("x_{}", i - 1)
        }
    };
    let text = format!(
        "[model]\nname = \"chain\"\n[parameters]\nh = {{ value = 1, unit = \"N\" }}\nv = {{ value = 1, unit = \"m/s\" }}\n\
         {}[coordinates]\n{}[kinetic]\n{}[potential]\n{}[dissipation]\n{}[forces]\ndrive = {{ on = \"x_3\", value = \"h*tanh(dot(x_2)/v)\" }}\n",
        each(&|i| format!(
            "m_{i} = {{ value = {}, unit = \"kg\" }}\nk_{i} = {{ value = {}, unit = \"N/m\" }}\nc_{i} = {{ value = 0.{}, unit = \"N s/m\" }}\n",
            i + 1,
            3 * i + 2,
            i + 1
        )),
        each(&|i| format!("x_{i} = {{ unit = \"m\", initial = 0.{i} }}\n")),
        each(&|i| format!("t_{i} = \"1/2*m_{i}*dot(x_{i})^2\"\n")),
        each(&|i| format!(
            "v_{i} = \"1/2*k_{i}*sin(x_{i}/one - {}/one)^2*one^2\"\n",
            before(i)
        )),
        each(&|i| format!("d_{i} = \"1/2*c_{i}*dot(x_{i})^2\"\n")),
    );
    let text = text.replace(
        "[coordinates]",
        "one = { value = 1, unit = \"m\" }\n[coordinates]",
    );
    let model = CompiledModel::from_text("chain.toml", &text, Orders::Declared)?;
    assert!(model.parameter_names().len() > 50);
    let program = eomgen_codegen::variant::lower_for_gradients(model.model(), model.equations())?;
    let products = program.outputs.products.as_ref().expect("products");
    let by_variables = products.reverse.iter().map(|(_, id)| *id);
    let by_parameters = products.by_parameters.entries.iter();
    let roots: Vec<_> = by_variables
        .chain(by_parameters.map(|entry| entry.value))
        .collect();
    let rates = program.operations(&program.rate_roots()) as f64;
    let ratio = 2.0 + program.operations(&roots) as f64 / rates;
    assert!(ratio < 6.0, "{ratio}");
    Ok(())
}

/// Pendulum on a cart, with a moving wall and a bumper on the pendulum.
const BUMPED: &str = r#"
[model]
name = "bumped"
[parameters]
M = { value = 3, unit = "kg" }
m = { value = 1.2, unit = "kg" }
l = { value = 0.6, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
k = { value = 40, unit = "N/m" }
e = { value = 0.7 }
d = { value = 0.03, unit = "m" }
A = { value = 0.01, unit = "m" }
w = { value = 5, unit = "rad/s" }
F_c = { value = 1.5, unit = "N" }
[coordinates]
x = { unit = "m", initial = 0.1 }
theta = { unit = "rad", initial = 0.9 }
[inputs]
u = { unit = "N" }
[definitions]
x_m = "x + l*sin(theta)"
y_m = "-l*cos(theta)"
[kinetic]
cart = "1/2*M*dot(x)^2"
bob = "1/2*m*(dot(x_m)^2 + dot(y_m)^2)"
[potential]
weight = "m*g*y_m"
spring = "1/2*k*x^2"
[forces]
drive = { on = "x", value = "u" }
friction = { on = "x", value = "-F_c*sign(dot(x))" }
[impacts]
wall = { when = "x + d + A*sin(w*t)", restitution = "e" }
bumper = { when = "theta + 0.2", restitution = "e^2" }
"#;

#[test]
fn gradients_through_impacts_equal_differences() -> Result<(), Error> {
    let inputs = HeldInputs::new(vec![0.0, 0.8], vec![1.0, -2.0], 1);
    let model = CompiledModel::from_text("bumped.toml", BUMPED, Orders::Declared)?;
    let run = model.with_declared_parameters()?;
    let initial = run.initial_state().to_vec();
    let mut initial_moved = initial.clone();
    initial_moved[2] = 0.4;
    let case = Case {
        initial: initial_moved,
        inputs: inputs.expect("rows"),
        times: times(1.5),
        run,
    };
    let motion = case
        .run
        .simulate(&case.initial, &case.times, &case.inputs, Solver::Rk)?;
    assert!(
        motion.trajectory.jumps.len() > 1,
        "{:?}",
        motion.trajectory.jumps
    );
    compare_with_differences(&case)
}

#[test]
fn contact_that_stays_closed_has_no_gradient() {
    let floor = "[impacts]\nfloor = { when = \"x + 0.1*p\", restitution = 0.1 }\n";
    let text = oscillator(0.3, 0.0, 0.7, floor).replace("1/2*k*x^2", "1/2*k*(x + p)^2");
    let message = rejection(&text, 30.0);
    assert!(
        message.contains("the contact `floor` stays closed"),
        "{message}"
    );
}

/// Two masses on rods in Cartesian coordinates; a skate on the second mass keeps its direction.
const LINKED: &str = r#"
[model]
name = "linked"
[parameters]
m = { value = 1.5, unit = "kg" }
M = { value = 0.8, unit = "kg" }
l = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
J = { value = 0.2, unit = "kg m^2" }
k = { value = 3, unit = "N m" }
[coordinates]
x = { unit = "m", initial = 0.6 }
y = { unit = "m", initial = -0.8 }
X = { unit = "m", initial = 1.6 }
Y = { unit = "m", initial = -0.8 }
a = { unit = "rad", initial = 0.4 }
[inputs]
F = { unit = "N" }
[kinetic]
masses = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*M*(dot(X)^2 + dot(Y)^2) + 1/2*J*dot(a)^2"
[potential]
weight = "m*g*y + M*g*Y + 1/2*k*a^2"
[forces]
drive = { on = "x", value = "F" }
[constraints]
upper = { zero = "x^2 + y^2 - l^2" }
lower = { zero = "(X - x)^2 + (Y - y)^2 - l^2" }
CONSTRAINTS
"#;

#[test]
fn gradients_with_constraints_equal_differences() -> Result<(), Error> {
    for (more, until) in [
        ("", 1.0),
        ("skate = { zero = \"dot(X)*sin(a) - dot(Y)*cos(a)\" }", 0.8),
        ("twice = { zero = \"3*(x^2 + y^2) - 3*l^2\" }", 0.8),
    ] {
        let inputs = HeldInputs::new(vec![0.0, 0.4], vec![2.0, -3.0], 1);
        compare_text(&LINKED.replace("CONSTRAINTS", more), inputs, until)?;
    }
    Ok(())
}

/// Pendulum in Cartesian coordinates with a mass that slides on an inclined rail.
const SWINGING: &str = r#"
[model]
name = "linked"
[parameters]
m = { value = 2, unit = "kg" }
M = { value = 3, unit = "kg" }
l = { value = 700, unit = "mm" }
b = { value = 0.3, unit = "N s/m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
s = { unit = "m" }
x = { unit = "m", initial = 0.3 }
y = { unit = "m", initial = -0.6 }
[inputs]
u = { unit = "N" }
[kinetic]
masses = "1/2*M*dot(s)^2 + 1/2*m*(dot(x)^2 + dot(y)^2)*(1 + (x/l)^2)"
[potential]
weight = "m*g*y"
[dissipation]
air = "1/2*b*(dot(x)^2 + dot(s)^2)"
[forces]
drive = { on = "s", value = "u" }
[constraints]
rod = { zero = "(x - s)^2 + y^2 - l^2" }
"#;

#[test]
fn gradients_from_states_off_the_constraints_equal_differences() -> Result<(), Error> {
    let model = CompiledModel::from_text("linked.toml", SWINGING, Orders::Declared)?;
    let run = model.with_declared_parameters()?;
    for initial in [
        [0.0, 0.3, -0.6, 0.0, 0.0, 0.0],
        [0.1, 0.5, -0.8, 0.0, 0.0, 0.0],
        [0.0, 0.42, -0.56, 0.2, 0.7, 0.3],
        [-0.2, 0.1, -0.3, 0.5, -0.4, 1.0],
    ] {
        let case = Case {
            run: run.clone(),
            initial: initial.to_vec(),
            inputs: HeldInputs::new(vec![0.0, 0.3], vec![0.5, -1.2], 1).expect("rows"),
            times: times(0.8),
        };
        let request = case.request(&case.initial, &case.inputs);
        let recorded = case.run.record_motion(&request, &mut |_| {})?;
        assert!(!recorded.motion().initial_changes.is_empty(), "{initial:?}");
        compare_with_differences(&case)?;
    }
    Ok(())
}

#[test]
fn motion_that_stops_early_has_samples_and_no_gradient() -> Result<(), Error> {
    let text = oscillator(1.0, 0.0, 9.0, "").replace("-F*above(x - p)", "2*k*x^3/p^2*81");
    let model = CompiledModel::from_text("oscillator.toml", &text, Orders::Declared)?;
    let run = model.with_declared_parameters()?;
    let case = Case {
        initial: run.initial_state().to_vec(),
        inputs: run.default_inputs(),
        times: times(40.0),
        run,
    };
    let request = case.request(&case.initial, &case.inputs);
    let recorded = case.run.record_motion(&request, &mut |_| {})?;
    let motion = recorded.motion();
    assert!(motion.early_stop.is_some() && !motion.trajectory.times.is_empty());
    let weights = SampleWeights::default();
    let found = recorded.gradient(&weights);
    assert!(matches!(found, Err(Error::Stopped { .. })), "{found:?}");
    Ok(())
}
