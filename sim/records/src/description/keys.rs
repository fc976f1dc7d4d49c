//! Tables and keys of a dataset file. The reader, its messages and the reference page (`docs/discovery.md`) are based
//! on these lists.

use eomgen_model_spec::keys::{Key, Keys, Kind};

const COLUMN: Key = Key::new("column", "name or number", "\"x\"", "column of the values").required();
const UNIT: Key = Key::new("unit", "text", "\"m\"", "unit of the values").required();
const WRAP: Key = Key::new("wrap", "number, expression or `\"none\"`", "360", "period of values that wrap around, in `unit`, or an expression such as `\"2*pi rad\"`; without it, columns that look wrapped are rejected").explained("Values that wrap around");
const CORRECTION: &str = "prior of a correction: gain, bias in `unit`, delay in s; no correction if absent";
const SENSOR: &str = "prior of the sensor: gain, bias in `unit`, delay in s; the usual prior if absent";

/// Keys of the prior of a gain, a bias or a delay.
pub static PRIOR: Keys = Keys::new(&[
    Key::new("mean", "number", "1", "mean; the usual mean if absent"),
    Key::new("sd", "number", "0.02", "standard deviation, or 0 if the value is known").required(),
]);
/// Keys of `[records]`.
pub static RECORDS: Keys = Keys::new(&[
    Key::new("train", "list of files or parts", "[\"train.csv\"]", "training records").required(),
    Key::new("test", "list of files or parts", "[\"test.csv\"]", "test records: other measurements, or other parts").required(),
]);
/// Keys of a part of a file, a table in a list of `[records]`.
pub static STRETCH: Keys = Keys::new(&[
    Key::new("file", "text", "\"record.csv\"", "file of a part").required(),
    Key::new("from", "number", "0", "start of a part, in the unit of the time column; the start of the file if absent"),
    Key::new("to", "number", "10", "end of a part (exclusive); the end of the file if absent"),
]);
/// Keys of `[format]`.
pub static FORMAT: Keys = Keys::new(&[
    Key::new("separator", "text", "\";\"", "column separator: `\",\"` (default), `\";\"`, `\"\\|\"`, `\"tab\"`, or `\"spaces\"` (any number of spaces and tabs)"),
    Key::new("decimal", "text", "\",\"", "decimal sign: `\".\"` (default) or `\",\"`; numbers with commas contain no point, and the separator must differ"),
    Key::new("skip", "whole number", "3", "number of lines to skip at the top, comment lines included, up to 1000; 0 if absent"),
    Key::new("comment", "text", "\"#\"", "first character of comment lines, which are ignored everywhere; none if absent"),
    Key::new("names", "truth value", "false", "`true` (default) if the first line holds column names; with `false`, columns have numbers"),
    Key::new("units", "truth value", "true", "`true` if a line of units follows the names; it is ignored"),
]);
/// Keys of `[time]`.
pub static TIME: Keys = Keys::new(&[
    Key::new("column", "name or number", "\"t\"", "time column, which must increase").required(),
    Key::new("unit", "text", "\"s\"", "unit of the time. Its origin has no effect: times count from the first sample of the file, without rounding of the written digits. Only a model that depends on `t` uses the times of the file, as rounded doubles").required(),
    Key::new("every", "whole number", "10", "number of samples of which one is kept; 1 if absent. A held input is replaced by values over the kept samples with the same impulses, so keep 30 samples or more per period of the fastest motion. Gaps of at most `every` samples are filled; kept samples within 8 of a longer gap are missing"),
    Key::new("filter", "text", "\"none\"", "`\"low-pass\"` (default) or `\"none\"`").explained("Fewer samples"),
]);
/// Keys of `[inputs.NAME]`.
pub static INPUT: Keys = Keys::new(&[
    COLUMN,
    UNIT,
    WRAP,
    Key::new("hold", "text", "\"zero-order\"", "`\"zero-order\"` (default): a value is held until the next sample"),
    Key::nested("gain", Kind::Table(&PRIOR), "Input corrections", CORRECTION),
    Key::nested("bias", Kind::Table(&PRIOR), "Input corrections", CORRECTION),
    Key::nested("delay", Kind::Table(&PRIOR), "Input corrections", CORRECTION),
]);
/// Keys of `[motion.NAME]`.
pub static MOTION: Keys = Keys::new(&[
    COLUMN,
    UNIT,
    WRAP,
    Key::new("initial", "number", "0", "position at the first sample of every file, in SI, for a column of a speed; the initial value of the specification, with a note, if absent"),
]);
/// Keys of `[channels.NAME]`.
pub static CHANNEL: Keys = Keys::new(&[
    COLUMN,
    UNIT,
    WRAP,
    Key::new("noise", "number", "1e-6", "standard deviation of the noise, in `unit`").required(),
    Key::new("observable", "text", "\"tip\"", "measured quantity: an observable or a coordinate, its rate, `x_dot` or `dot(x)`, its acceleration, `x_ddot` or `dot(dot(x))`, or a first-order state; with given motion also an input; the name of the channel if absent").explained("Accelerations"),
    Key::nested("gain", Kind::Table(&PRIOR), "Sensors", SENSOR),
    Key::nested("bias", Kind::Table(&PRIOR), "Sensors", SENSOR),
    Key::nested("delay", Kind::Table(&PRIOR), "Sensors", SENSOR),
]);
/// Keys of `[initial]`.
pub static INITIAL: Keys = Keys::new(&[
    Key::new("state", "text", "\"rest\"", "initial state of every file, whatever its first time: `\"rest\"` (the initial values of the specification, 0 if it has none), `\"estimate\"` (default), or `\"given\"`").required(),
    Key::new("values", "table of numbers", "{ x = 0.1, x_dot = 0 }", "states by name, in SI, with `\"given\"`; others are those of the specification"),
]);
/// Keys of an entry of `[uncertain]`.
pub static UNCERTAIN: Keys = Keys::new(&[
    Key::new("relative", "number", "0.05", "relative standard deviation of the parameter; the fit may change it by up to three standard deviations").required(),
]);
/// Keys of `[windows]`.
pub static WINDOWS: Keys = Keys::new(&[
    Key::new("length", "number or `\"record\"`", "0.5", "length of the windows in s, each with its own initial state, or `\"record\"`: one window per record").required(),
    Key::new("start", "text", "\"smoothed\"", "source of this initial state: `\"fitted\"` (default), or `\"smoothed\"` (read from the smoothed record: faster, but the residual contains the errors of the rates, which may appear as a missing effect)"),
]);
/// Keys of `[experiment]`.
pub static EXPERIMENT: Keys = Keys::new(&[
    Key::new("duration", "number", "10", "duration in s; that of the longest training record, at most 4000 samples, if absent"),
    Key::new("sample", "number", "0.01", "sample time in s; as recorded if absent"),
    Key::nested("inputs", Kind::Entries(&EXPERIMENT_INPUT), "", "bounds of inputs, by name"),
    Key::new("limits", "table of pairs", "{ x = [-40, 40] }", "bounds of channels by name, in the unit of the column; as recorded, plus 5 %, if absent"),
]);
/// Keys of `[experiment.inputs.NAME]`.
pub static EXPERIMENT_INPUT: Keys = Keys::new(&[
    Key::new("range", "two numbers", "[-10, 10]", "minimum and maximum, in the unit of the column; the recorded range, extended to 0, if absent"),
    Key::new("rate", "number", "100", "highest rate of change, in the unit of the column per s; that of a sine with its range at the upper end of its band if absent"),
    Key::new("band", "two numbers", "[0.1, 20]", "lowest and highest frequency of oscillating forms, in Hz; from one period in the record to the limit of 99 % of the recorded power if absent"),
]);
/// Top-level tables of a dataset file.
pub static TABLES: Keys = Keys::new(&[
    Key::new("title", "text", "\"First runs\"", "title of the report"),
    Key::new("source", "text", "\"...\"", "origin of the records"),
    Key::nested("records", Kind::Table(&RECORDS), "", "files, or parts of files, as `{ file = \"a.csv\", from = 0, to = 10 }`").required(),
    Key::nested("format", Kind::Table(&FORMAT), "", "layout of text files"),
    Key::nested("time", Kind::Table(&TIME), "", "time of the samples").required(),
    Key::nested("inputs", Kind::Entries(&INPUT), "", "inputs; an input without a column is 0, with a warning"),
    Key::nested("motion", Kind::Entries(&MOTION), "Given motion", "coordinates with given motion: the position or, according to the unit, the speed"),
    Key::nested("channels", Kind::Entries(&CHANNEL), "", "measured quantities, at least one"),
    Key::nested("initial", Kind::Table(&INITIAL), "", "initial state of the files"),
    Key::nested("uncertain", Kind::Entries(&UNCERTAIN), "", "parameters with an uncertain value, by name"),
    Key::nested("windows", Kind::Table(&WINDOWS), "", "windows of the records"),
    Key::nested("experiment", Kind::Table(&EXPERIMENT), "The next experiment", "bounds of the next experiment"),
]);
