//! Sections and keys of a specification. The reader, its messages, the JSON schema and the reference page
//! (`docs/specification.md`) use this table.

use crate::keys::{Key, Keys, Kind};

const DOC: Key = Key::new("doc", "text", "\"...\"", FREE_TEXT);
const SOURCE: Key = Key::new("source", "text", "\"...\"", FREE_TEXT);
const FREE_TEXT: &str = "free text for the documentation of emitted code";
const UNIT: Key = Key::new("unit", "coherent_unit", "\"m\"", "SI unit").required();
const RANGE: Key = Key::new("range", "range", "[-0.1, 0.1]", "range of validity").explained("Ranges");

pub(crate) static MODEL: Keys = Keys::new(&[
    Key::new("name", "name", "\"my_machine\"", "name of emitted files and items").required(),
    Key::new("title", "text", "\"My machine\"", "title in one line"),
    Key::new("gravity", "components", "[0, 0, \"-g\"]", "acceleration of free fall along the fixed axes, for bodies").explained("Bodies in space"),
    Key::new("extends", "text", "\"arm.toml\"", "specification whose entries this one changes; relative to this file").explained("Extending another specification"),
]);
pub(crate) static PARAMETER: Keys = Keys::new(&[
    Key::new("value", "expression", "0.5", "value in `unit`, or an expression of other parameters").required(),
    Key::new("unit", "unit", "\"mm\"", "unit, with or without a prefix; a pure number if absent"),
    DOC,
    SOURCE,
    Key::new("min", "number", "0", "lower limit in `unit`; a value below is rejected, also with `--set`"),
    Key::new("max", "number", "1", "upper limit in `unit`"),
    Key::nested("uncertainty", Kind::Table(&UNCERTAINTY), "Uncertain parameters", "uncertainty of the value"),
]);
pub(crate) static UNCERTAINTY: Keys = Keys {
    one_of: &[&["relative"], &["sd"], &["between"]],
    ..Keys::new(&[
        Key::new("relative", "fraction", "0.02", "standard deviation as a fraction of the value"),
        Key::new("sd", "positive_number", "0.01", "standard deviation in the unit"),
        Key::new("between", "pair_of_numbers", "[1, 2]", "ends of a uniform distribution, in the unit"),
    ])
};
pub(crate) static COORDINATE: Keys = Keys::new(&[
    UNIT,
    DOC,
    Key::new("initial", "expression", "0", "initial value, in SI, without quantities that move; 0 if absent"),
    Key::new("initial_rate", "expression", "0", "initial rate, in SI; 0 if absent"),
    RANGE,
]);
pub(crate) static INPUT: Keys = Keys::new(&[
    UNIT,
    Key::new("rates", "rate_count", "2", "number of rates that are inputs too").explained("Prescribed motion"),
    DOC,
    RANGE,
]);
pub(crate) static STATE: Keys = Keys::new(&[
    UNIT,
    Key::new("rate", "expression", "\"(k*x - z)/tau\"", "time derivative").required(),
    Key::new("initial", "expression", "0", "initial value, in SI; 0 if absent"),
    RANGE,
    DOC,
]);
pub(crate) static FIELD: Keys = Keys::new(&[
    Key::new("along", "name", "\"x\"", "name of the position").required(),
    Key::new("from", "expression", "0", "start of the domain, a length of parameters").required(),
    Key::new("to", "expression", "\"l\"", "end of the domain, a length of parameters").required(),
    Key::new("basis", "basis", "\"clamped_free\"", "mode shapes").required(),
    Key::new("table", "text", "\"modes.csv\"", "file with the shapes; only with `basis = \"table\"`").explained("Mode shapes from a file"),
    Key::new("coordinates", "name", "\"q\"", "name of the modal coordinates; `\"q\"` gives q_1, q_2 and so on").required(),
    Key::new("order", "mode_count", "4", "number of modes; `--order` overrides it").required(),
    UNIT,
    DOC,
]);
pub(crate) static FRAME: Keys = Keys::new(&[
    Key::new("in", "text", "\"link_1\"", "parent frame; the fixed axes if absent"),
    Key::new("origin", "vector", "[0, 0, \"d\"]", "position in the parent"),
    Key::new("rotation", "text", "\"rotation_z(q_2)\"", "product of rotations about x, y and z"),
    DOC,
]);
pub(crate) static BODY: Keys = Keys {
    any_of: &["mass", "inertia"],
    ..Keys::new(&[
        Key::new("frame", "text", "\"link_1\"", "frame that the body is fixed to").required(),
        Key::new("mass", "expression", "\"m\"", "mass in kg"),
        Key::new("centre", "vector", "[0, 0, \"c\"]", "centre of mass in the frame"),
        Key::new("inertia", "inertia", "[\"I_x\", \"I_y\", \"I_z\"]", "moments of inertia about the centre of mass"),
        DOC,
        SOURCE,
    ])
};
/// Keys of an energy term or a dissipation term.
pub(crate) static TERM: Keys = Keys::new(&[
    Key::new("value", "expression", "\"1/2*m*dot(x)^2\"", "expression of the term").required(),
    DOC,
    SOURCE,
])
.or_value("expression");
pub(crate) static DEFINITION: Keys = Keys::new(&[
    Key::new("value", "scalar_or_vector", "\"l*sin(theta)\"", "expression; it must not refer to itself").required(),
    DOC,
    SOURCE,
])
.or_value("scalar_or_vector");
pub(crate) static FORCE: Keys = Keys::new(&[
    Key::new("on", "scalar_or_vector", "\"theta\"", "coordinate or displacement on which the force works").required(),
    Key::new("value", "scalar_or_vector", "\"-c*dot(theta)\"", "force or torque").required(),
    DOC,
    SOURCE,
]);
pub(crate) static CONSTRAINT: Keys = Keys::new(&[
    Key::new("zero", "scalar_or_vector", "\"x^2 + y^2 - l^2\"", "expression that stays zero").required(),
    DOC,
    SOURCE,
]);
pub(crate) static IMPACT: Keys = Keys::new(&[
    Key::new("when", "expression", "\"y\"", "distance that falls to zero at the impact").required(),
    Key::new("restitution", "expression", "0.8", "coefficient of restitution, from 0 (plastic) to 1 (elastic)").required(),
    Key::new("friction", "expression", "\"mu\"", "coefficient of Coulomb friction; needs `slip`").explained("Contact friction"),
    Key::new("slip", "expression", "\"dot(x) - r*dot(phi)\"", "tangential velocity of the contact; needs `friction`").explained("Contact friction"),
    DOC,
    SOURCE,
]);
pub(crate) static OBSERVABLE: Keys = Keys::new(&[
    Key::new("value", "scalar_or_vector", "\"at(w, l)\"", "expression of the quantity").required(),
    Key::new("unit", "coherent_unit", "\"m\"", "SI unit, for a check; inferred if absent"),
    DOC,
    SOURCE,
])
.or_value("scalar_or_vector");
pub(crate) static COEFFICIENT: Keys = Keys {
    one_of: &[&["of", "by"], &["value"]],
    ..Keys::new(&[
        Key::new("value", "expression", "\"k_1 + k_2\"", "expression of parameters and earlier coefficients"),
        Key::new("of", "expression", "\"x_c\"", "coordinate of the equation, or modal coordinates of a field"),
        Key::new("by", "expression", "\"dot(x_c)\"", "quantity multiplied by the coefficient"),
        Key::new("times", "expression", "\"m\"", "factor of the acceleration in the equation; not with `value`"),
        Key::new("each", "text", "\"w[i]\"", "field with one coefficient for each mode, and the index"),
        DOC,
    ])
}
.or_value("expression");
pub(crate) static SENSOR: Keys = Keys::new(&[
    Key::new("observable", "text", "\"tip\"", "measured quantity; the name of the channel if absent"),
    Key::new("gain", "number", "1", "gain; 1 if absent"),
    Key::new("bias", "number", "0", "offset in the unit of the channel; 0 if absent"),
    Key::new("delay", "number", "0", "delay in s, negative if earlier than the inputs and other channels; 0 if absent"),
]);
/// Keys of the period, the offset and the delay of a controller.
pub(crate) static SAMPLE_TIME: Keys = Keys::new(&[
    Key::new("value", "expression", "1", "time in `unit`, or an expression of parameters in SI").required(),
    Key::new("unit", "unit", "\"ms\"", "unit of time; s if absent"),
]);
pub(crate) static CONTROLLER_STATE: Keys = Keys::new(&[
    UNIT,
    Key::new("next", "expression", "\"e_i + period*(r - theta)\"", "value after a sample").required(),
    Key::new("initial", "expression", "0", "initial value, in SI; 0 if absent"),
    DOC,
]);
pub(crate) static CONTROLLER_OUTPUT: Keys = Keys::new(&[
    Key::new("value", "expression", "\"-k_p*theta\"", "value of the input, held until the next one").required(),
])
.or_value("expression");
pub(crate) static CONTROLLER: Keys = Keys {
    any_of: &["states", "outputs"],
    ..Keys::new(&[
        Key::new("period", "sample_time", "{ value = 1, unit = \"ms\" }", "time between two samples").required(),
        Key::new("offset", "sample_time", "0", "time of the first sample; 0 if absent"),
        Key::new("delay", "sample_time", "0", "time between a sample and the action of its outputs; 0 if absent"),
        Key::nested("states", Kind::Entries(&CONTROLLER_STATE), "", "states of difference equations"),
        Key::nested("outputs", Kind::Entries(&CONTROLLER_OUTPUT), "", "inputs of the model that the controller drives"),
        DOC,
    ])
};
pub(crate) static DRAWING: Keys = Keys::new(&[
    Key::nested("points", Kind::Entries(&POINT), "", "points that move; the point `origin` at (0, 0) always exists"),
    Key::new("lines", "lines", "{ arm = [\"origin\", \"tip\"] }", "lines, each with the names of two or more points"),
]);
pub(crate) static POINT: Keys = Keys::new(&[
    Key::new("x", "ordinate", "\"tip_x\"", "ordinate to the right, in m").required(),
    Key::new("y", "ordinate", "\"tip_y\"", "ordinate upwards, in m").required(),
]);
/// Sections of a specification.
pub static SECTIONS: Keys = Keys::new(&[
    Key::nested("model", Kind::Table(&MODEL), "", "name, title and gravity of the model").required(),
    Key::nested("parameters", Kind::Entries(&PARAMETER), "", "constants, changeable at run time"),
    Key::nested("coordinates", Kind::Entries(&COORDINATE), "", "generalised coordinates, in the order of the state"),
    Key::nested("inputs", Kind::Entries(&INPUT), "", "signals supplied at run time"),
    Key::nested("states", Kind::Entries(&STATE), "First-order states", "first-order states: filters, actuators, currents"),
    Key::nested("fields", Kind::Entries(&FIELD), "Fields: integral, diff, at, sum", "flexible bodies: w(x, t) = sum over i of phi_i(x) q_i(t)"),
    Key::nested("definitions", Kind::Entries(&DEFINITION), "Vectors", "named expressions, scalars or vectors"),
    Key::nested("frames", Kind::Entries(&FRAME), "Bodies in space", "axes in space"),
    Key::nested("bodies", Kind::Entries(&BODY), "Bodies in space", "rigid bodies, shorthand for their energies"),
    Key::nested("kinetic", Kind::Entries(&TERM), "", "terms of the kinetic energy, in J"),
    Key::nested("potential", Kind::Entries(&TERM), "", "terms of the potential energy, in J; without rates"),
    Key::nested("dissipation", Kind::Entries(&TERM), "", "terms of the Rayleigh function, in W; viscous friction c is `1/2*c*dot(x)^2`"),
    Key::nested("forces", Kind::Entries(&FORCE), "Forces by virtual work", "forces by virtual work"),
    Key::nested("constraints", Kind::Entries(&CONSTRAINT), "Constraints", "expressions that stay zero"),
    Key::nested("impacts", Kind::Entries(&IMPACT), "Impacts", "bodies that collide"),
    Key::nested("observables", Kind::Entries(&OBSERVABLE), "Vectors", "output quantities; `energy` and `power` are always added"),
    Key::nested("coefficients", Kind::Entries(&COEFFICIENT), "Named coefficients", "names for factors of the derived equations"),
    Key::nested("sensors", Kind::Entries(&SENSOR), "", "sensors of channels: measured(t) = gain * quantity(t - delay) + bias"),
    Key::nested("controllers", Kind::Entries(&CONTROLLER), "Controllers", "sampled controllers"),
    Key::nested("drawing", Kind::Table(&DRAWING), "A drawing", "drawing of the machine for `eomgen page`"),
]);
