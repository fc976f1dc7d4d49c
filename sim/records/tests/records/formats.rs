//! Tests of record formats: separators, decimal signs, comments, columns without names, parts of a file, decimation.
//! Each format is read exactly, or rejected with location and remedy.

mod wrapped;

use std::fmt::Write;
use std::path::Path;

use eomgen_model_spec::model::Model;
use eomgen_records::dataset::Dataset;
use eomgen_records::{Refusal, propose_dataset, read_dataset};
use tempfile::TempDir;

/// Dataset file of a pendulum; `format` is replaced by further tables.
const DESCRIPTION: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[channels.theta]
column = "angle"
unit = "mrad"
noise = 0.1
"#;

/// Number of samples of a record, and the sample time in s.
const SAMPLES: usize = 400;
const STEP: f64 = 0.01;

fn pendulum() -> Model {
    let source = eomgen_model_spec::models::PENDULUM.source();
    eomgen_model_spec::check(source).expect("a model").model
}

/// Returns the angle at a sample, in mrad; `turn` selects another record.
fn angle(sample: usize, turn: f64) -> f64 {
    100.0 * (1.3 * STEP * sample as f64 + turn).cos() + 20.0 * (3.1 * STEP * sample as f64).sin()
}

/// Returns the text of a record: `head`, then one line per sample, written by `line` from time and angle.
fn record(head: &str, turn: f64, line: impl Fn(f64, f64) -> String) -> String {
    let samples = 0..SAMPLES;
    let lines = samples.map(|sample| line(STEP * sample as f64, angle(sample, turn)));
    head.to_owned() + &lines.collect::<String>()
}

/// Creates a folder with a dataset file and its records.
fn folder(description: &str, head: &str, line: impl Fn(f64, f64) -> String) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "dataset.toml", description);
    write(folder.path(), "train.csv", &record(head, 0.0, &line));
    write(folder.path(), "test.csv", &record(head, 1.0, &line));
    folder
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("a file");
}

fn read(folder: &TempDir) -> Result<Dataset, Refusal> {
    read_dataset(&folder.path().join("dataset.toml"), &pendulum())
}

fn rejection_message(folder: &TempDir) -> String {
    match read(folder) {
        Ok(_) => panic!("it is taken"),
        Err(Refusal::Description(found)) => found.render(false),
        Err(Refusal::Record(message)) => message,
        Err(Refusal::Column(missing)) => missing.message,
    }
}

fn format_sample_line(t: f64, angle: f64) -> String {
    format!("{t:.2},{angle:.6}\n")
}

/// Asserts that a dataset contains the written numbers.
fn assert_has_written_numbers(dataset: &Dataset) {
    for (record, turn) in [(&dataset.train[0], 0.0), (&dataset.test[0], 1.0)] {
        assert_eq!(record.times.len(), SAMPLES);
        for sample in 0..SAMPLES {
            assert!((record.times[sample] - STEP * sample as f64).abs() < 1e-9);
            let expected = 1e-3 * angle(sample, turn);
            assert!((record.channels[0][sample] - expected).abs() < 1e-9);
        }
    }
}

/// Function that writes a line from time and angle.
type Line = Box<dyn Fn(f64, f64) -> String>;

#[test]
fn every_format_is_read_exactly() {
    let comma = |number: f64| format!("{number:.6}").replace('.', ",");
    let by_number = DESCRIPTION
        .replace("column = \"t\"", "column = 1")
        .replace("column = \"angle\"", "column = 3");
    let with = |format: &str| format!("{DESCRIPTION}\n[format]\n{format}\n");
    let cases: [(String, &str, Line); 9] = [
        (
            DESCRIPTION.to_owned(),
            "t,angle\n",
            Box::new(format_sample_line),
        ),
        (
            with("separator = \";\"\ndecimal = \",\""),
            "\u{feff}t;angle\n",
            Box::new(move |t, a| format!("{};{}\n", comma(t), comma(a))),
        ),
        (
            with("separator = \"tab\"\nskip = 3"),
            "measured on a bench\n\"a quote\nand more\nt\tangle\n",
            Box::new(|t, a| format!("{t:.2}\t{a:.6}\n")),
        ),
        (
            with("separator = \"spaces\"\ncomment = \"#\""),
            "# by hand\n  t   angle\n# here it goes\n",
            Box::new(|t, a| format!(" {t:8.2}  {a:12.6}\r\n")),
        ),
        (
            with("units = true\nseparator = \"|\""),
            "t|angle\ns|mrad\n",
            Box::new(|t, a| format!("{t:.2}|{a:.6}|\n")),
        ),
        (
            format!("{by_number}\n[format]\nnames = false\n"),
            "",
            Box::new(|t, a| format!("{t:.2},7,{a:.6}\n")),
        ),
        (
            format!("{by_number}\n[format]\nnames = false\nunits = true\n"),
            "s,-,mrad\n",
            Box::new(|t, a| format!("{t:.2},7,{a:.6}\n")),
        ),
        (
            by_number.clone(),
            "t,angle,angle\n",
            Box::new(|t, a| format!("{t:.2},7,{a:.6}\n")),
        ),
        (
            with("").replace("\"angle\"", "\"angle (mrad)\""),
            "t,angle (mrad)\n",
            Box::new(format_sample_line),
        ),
    ];
    for (description, head, line) in cases {
        let folder = folder(&description, head, line);
        let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{head}: {refusal}"));
        assert_has_written_numbers(&dataset);
    }
}

#[test]
fn wrong_formats_are_rejected_with_cure() {
    let with = |format: &str| format!("{DESCRIPTION}\n[format]\n{format}\n");
    let cases = [
        (with(""), "t;angle\n", "separator = \";\" in [format]"),
        (with(""), "t\tangle\n", "separator = \"tab\" in [format]"),
        (
            with("decimal = \",\""),
            "t,angle\n",
            "cannot be both the separator",
        ),
        (
            with("decimal = \",\"\nseparator = \";\""),
            "t;angle\n0.01;3\n",
            "line 2: column 1: \"0.01\" is not a number: [format] sets decimal = \",\"",
        ),
        (
            with("separator = \";\""),
            "t;angle\n0,01;3\n",
            "column 1: \"0,01\" is not a number; write decimal = \",\" in [format]",
        ),
        (
            with("skip = 2"),
            "one line",
            "has no line after the 2 skipped lines",
        ),
        (with("skip = -1"), "t,angle\n", "0 to 1000"),
        (
            with("skip = 2"),
            "a\nb\nt,angle\n0,x\n",
            "line 4: column 2: \"x\" is not a number",
        ),
        (
            with("skip = 2"),
            "a\nb\nt,angle\n0,-inf\n",
            "line 4: column 2: \"-inf\" is not a finite number",
        ),
        (
            with("comment = \"rem\""),
            "t,angle\n",
            "expected one character",
        ),
        (with("names = false"), "0,1\n", "give the column's number"),
        (with("names = 1"), "t,angle\n", "is not a truth value"),
        (
            with("separator = \"-\""),
            "t,angle\n",
            "expected \",\" or \";\"",
        ),
        (
            with("seperator = \";\""),
            "t,angle\n",
            "did you mean `separator`?",
        ),
        (
            DESCRIPTION.replace("\"angle\"", "3"),
            "t,angle\n",
            "line 1: there is no column 3; the file has 2",
        ),
        (
            DESCRIPTION.replace("\"angle\"", "\"angel\""),
            "t,angle\n",
            "did you mean `angle`?",
        ),
        (
            DESCRIPTION.replace("\"angle\"", "0"),
            "t,angle\n",
            "numbered from 1",
        ),
    ];
    for (description, text, part) in cases {
        let folder = folder(&description, text, |_, _| String::new());
        let message = rejection_message(&folder);
        assert!(message.contains(part), "{part}: {message}");
    }
    let folder = folder(DESCRIPTION, "t,angle\n", format_sample_line);
    std::fs::write(folder.path().join("train.csv"), b"\xff\xfet\0,\0").expect("a file");
    assert!(rejection_message(&folder).contains("is UTF-16; expected UTF-8"));
}

#[test]
fn file_is_split_by_times() {
    let parted = DESCRIPTION
        .replace("[\"train.csv\"]", "[{ file = \"train.csv\", to = 2500 }]")
        .replace(
            "[\"test.csv\"]",
            "[{ file = \"train.csv\", from = 2500, to = 3.5e3 }]",
        )
        .replace("unit = \"s\"", "unit = \"ms\"");
    let folder = folder(&parted, "t,angle\n", |t, a| {
        format!("{:.0},{a:.6}\n", 1e3 * t)
    });
    let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{refusal}"));
    let ends = |times: &[f64]| (times[0], times[times.len() - 1]);
    assert_eq!(ends(&dataset.train[0].times), (0.0, 2.49));
    assert_eq!(ends(&dataset.test[0].times), (2.5, 3.49));
    assert_eq!(dataset.test[0].channels[0].len(), 100);
    for (from, to, part) in [
        ("from = 2500", "from = 2000", "parts that do not overlap"),
        (
            "from = 2500",
            "from = 3600",
            "the part from 3600 to 3500 is empty",
        ),
        ("to = 2500", "to = -1", "its times are 0 to 3990 ms"),
        ("to = 2500", "until = 2500", "the keys are file, from, to"),
        ("to = 2500", "to = 100", "has 10 samples; expected 50"),
    ] {
        write(folder.path(), "dataset.toml", &parted.replacen(from, to, 1));
        let message = rejection_message(&folder);
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn decimation_works_with_and_without_low_pass() {
    // The ripple is far above the new Nyquist frequency.
    let ripple = |t: f64| 5.0 * (2.0 * std::f64::consts::PI * 19.0 * t + 0.4).sin();
    let line = move |t: f64, a: f64| format!("{t:.2},{:.6}\n", a + ripple(t));
    let every = |more: &str| DESCRIPTION.replace("\"s\"", &format!("\"s\"\nevery = 5\n{more}"));
    let furthest = |dataset: &Dataset| {
        let record = &dataset.train[0];
        assert_eq!(record.times.len(), 80);
        let apart = |kept: usize| (record.channels[0][kept] - 1e-3 * angle(5 * kept, 0.0)).abs();
        (8..72).map(apart).fold(0.0, f64::max)
    };
    let smooth = folder(&every(""), "t,angle\n", line);
    let dataset = read(&smooth).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(furthest(&dataset) < 5e-5, "{}", furthest(&dataset));
    // The noise decreases with the bandwidth.
    assert!((dataset.channels[0].noise / 1e-4 - 0.4).abs() < 0.03);
    let unfiltered = folder(&every("filter = \"none\""), "t,angle\n", line);
    let dataset = read(&unfiltered).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(furthest(&dataset) > 4e-3);
    assert_eq!(dataset.channels[0].noise, 1e-4);

    let text = record("t,angle\n", 0.0, line).replace("\n1.50,", "\n1.505,");
    write(smooth.path(), "train.csv", &text);
    let message = rejection_message(&smooth);
    assert!(message.contains("line 152: the low-pass"), "{message}");
    write(smooth.path(), "dataset.toml", &every("filter = \"none\""));
    assert!(read(&smooth).is_ok());
    for (wrong, part) in [
        ("every = 0", "of which one is kept, at least 1"),
        ("every = 2.5", "not a whole"),
    ] {
        write(
            smooth.path(),
            "dataset.toml",
            &every("").replace("every = 5", wrong),
        );
        assert!(rejection_message(&smooth).contains(part), "{wrong}");
    }
}

#[test]
fn sensor_priors_are_converted_to_si() {
    let said = format!(
        "{DESCRIPTION}gain = {{ mean = 2, sd = 0.5 }}\nbias = {{ sd = 3 }}\ndelay = {{ mean = 0.02, sd = 0 }}\n"
    );
    let folder = folder(&said, "t,angle\n", format_sample_line);
    let priors = read(&folder).expect("a dataset").channels[0].priors;
    let numbers = |of: Option<eomgen_records::dataset::PriorInSi>| {
        of.map(|expected| (expected.mean, expected.sd))
    };
    assert_eq!(numbers(priors.gain), Some((Some(2.0), 0.5)));
    assert_eq!(numbers(priors.bias), Some((None, 3e-3)));
    assert_eq!(numbers(priors.delay), Some((Some(0.02), 0.0)));
    let mut message = String::new();
    for (from, to, part) in [
        (
            "{ mean = 2, sd = 0.5 }",
            "0.05",
            "write gain = { sd = 0.02 }",
        ),
        ("sd = 3", "sd = -3", "0 or greater"),
        ("sd = 3", "mean = 3", "has no `sd`"),
        ("bias", "offset", "unknown key `offset`"),
        ("mean = 0.02", "mean = 0.2", "20.0 samples of the records"),
    ] {
        write(folder.path(), "dataset.toml", &said.replacen(from, to, 1));
        message.clear();
        write!(message, "{}", rejection_message(&folder)).expect("text");
        assert!(message.contains(part), "{part}: {message}");
        assert!(message.contains("dataset.toml:"), "{message}");
    }
}

#[test]
fn proposed_dataset_file_reads_original_numbers() {
    let comma = |number: f64| format!("{number:.6}").replace('.', ",");
    // Repeatable noise with a standard deviation of about one.
    let noise = |t: f64| 3.4 * ((t * 7919.123).sin() * 43_758.545).fract().abs() - 1.7;
    let cases: [(&str, Line, &[&str]); 4] = [
        (
            "t,theta,force,comment\n",
            Box::new(|t, a| format!("{t:.2},{:.9},0.5,fine\n", 1e-3 * a)),
            &["unit = \"rad\"", "# Not used: \"force\""],
        ),
        (
            "Pendel 3\n\nZeit [ms];Theta (mrad);Bemerkung\n",
            Box::new(move |t, a| format!("{};{};ok\n", comma(1e3 * t), comma(a))),
            &[
                "decimal = \",\"",
                "skip = 2",
                "column = \"Zeit [ms]\"",
                "unit = \"ms\"",
                "unit = \"mrad\"",
            ],
        ),
        (
            "% time_us  theta_deg\n",
            Box::new(|t, a| format!("{:.1} {:.9}\n", 1e6 * t, (1e-3 * a).to_degrees())),
            &[
                "names = false",
                "column = 2",
                "unit = \"us\"",
                "unit = \"deg\"",
            ],
        ),
        (
            "θ\tt\nmrad\ts\n",
            Box::new(|t, a| format!("{a:.6}\t{t:.2}\n")),
            &["separator = \"tab\"", "units = true", "column = \"θ\""],
        ),
    ];
    for (head, line, parts) in cases {
        let folder = folder("", head, |t, a| line(t, a + 0.1 * noise(t)));
        let record = folder.path().join("train.csv");
        let text = propose_dataset(&record, "train.csv", &pendulum());
        let text = text.unwrap_or_else(|refusal| panic!("{head}: {refusal}"));
        for part in parts {
            assert!(text.contains(part), "{part}: {text}");
        }
        write(folder.path(), "dataset.toml", &text);
        let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{refusal}: {text}"));
        let (train, test) = (&dataset.train[0], &dataset.test[0]);
        assert_eq!((train.times.len(), test.times.len()), (240, 160));
        for (k, value) in train.channels[0]
            .iter()
            .chain(&test.channels[0])
            .enumerate()
        {
            assert!((value - 1e-3 * angle(k, 0.0)).abs() < 2e-4, "{text}");
        }
        let noise = dataset.channels[0].noise;
        assert!((5e-5..2e-4).contains(&noise), "{noise}: {text}");
    }
}

#[test]
fn proposals_never_match_another_dimension() {
    let proposal = |head: &str| {
        let folder = folder("", head, |t, a| format!("{t:.2},{:.6},{a:.6}\n", 1e-3 * a));
        propose_dataset(&folder.path().join("train.csv"), "train.csv", &pendulum())
            .unwrap_or_else(|refusal| panic!("{head}: {refusal}"))
    };
    for unit in ["m/s^2", "parsec", "V", "m"] {
        let text = proposal(&format!("t,theta,theta_dot [{unit}]\n"));
        assert!(text.contains("# Not used: \"theta_dot ["), "{unit}: {text}");
    }
    for unit in ["deg/s^2", "°/s²", "rad s-2", "rad·s⁻²"] {
        let text = proposal(&format!("t,theta,theta_dot [{unit}]\n"));
        assert!(!text.contains("[channels.theta_dot]"), "{unit}: {text}");
    }
    let text = proposal("t,theta,theta_ddot [deg/s2]\n");
    assert!(
        text.contains("[channels.theta_ddot]") && text.contains("unit = \"deg/s^2\""),
        "{text}"
    );
    let said = folder("", "t [mm],theta\n", |t, a| format!("{t:.2},{a:.6}\n"));
    let said = propose_dataset(&said.path().join("train.csv"), "train.csv", &pendulum());
    let said = said.expect_err("no time").to_string();
    assert!(
        said.contains("`t [mm]`, is not in a unit of time"),
        "{said}"
    );
}

#[test]
fn counter_of_samples_is_marked_as_no_time() {
    let proposal = |head: &str, time: fn(f64) -> f64| {
        let folder = folder("", head, |t, a| format!("{},{:.6}\n", time(t), 1e-3 * a));
        propose_dataset(&folder.path().join("train.csv"), "train.csv", &pendulum())
            .unwrap_or_else(|refusal| panic!("{head}: {refusal}"))
    };
    let count = |t: f64| (100.0 * t).round() + 7.0;
    for head in ["sample,theta\n", "n,theta\n", "t,theta\n"] {
        let text = proposal(head, count);
        assert!(
            text.contains("a counter of samples must be replaced"),
            "{head}: {text}"
        );
    }
    for (head, time) in [
        ("t [ms],theta\n", count as fn(f64) -> f64),
        ("t,theta\n", |t| t),
    ] {
        let text = proposal(head, time);
        assert!(!text.contains("counter"), "{head}: {text}");
    }
}

#[test]
fn hidden_characters_in_names_survive_proposals() {
    let head = "t,theta,force\u{1b}[31m\u{202e}\"x\\\n";
    let folder = folder("", &head.replace(['"', '\\'], "'"), |t, a| {
        format!("{t:.2},{:.6},{a:.6}\n", 1e-3 * a)
    });
    let text = propose_dataset(&folder.path().join("train.csv"), "train.csv", &pendulum());
    let text = text.unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(
        !text.contains(eomgen_model_spec::hidden_characters::is_hidden),
        "{text}"
    );
    assert!(text.contains("\\u001b[31m\\u202e"), "{text}");
    write(folder.path(), "dataset.toml", &text);
    read(&folder).unwrap_or_else(|refusal| panic!("{refusal}: {text}"));
}

#[test]
fn records_without_possible_proposal_are_rejected() {
    let cases = [
        ("a,b\nno,numbers\n", "no two columns of numbers"),
        ("", "is empty"),
        (
            "t,elbow\n",
            "no column is an observable, coordinate or rate",
        ),
        (
            "theta,other\n",
            "no column with a unit of time, or without a unit, increases",
        ),
        ("t,theta,theta\n", "there are two columns `theta`"),
    ];
    for (head, part) in cases {
        let folder = folder("", head, |t, a| match head {
            "t,elbow\n" => format!("{t:.2},{a:.6}\n"),
            "theta,other\n" => format!("{:.6},{a:.6}\n", a),
            "t,theta,theta\n" => format!("{t:.2},{a:.6},{a:.6}\n"),
            _ => String::new(),
        });
        let message = propose_dataset(&folder.path().join("train.csv"), "train.csv", &pendulum());
        let message = message.expect_err(part).to_string();
        assert!(message.contains(part), "{part}: {message}");
    }
    let few = "t,theta\n".to_owned() + &(0..90).map(|k| format!("{k},{k}\n")).collect::<String>();
    let folder = folder("", &few, |_, _| String::new());
    let message = propose_dataset(&folder.path().join("train.csv"), "train.csv", &pendulum());
    let message = message.expect_err("too few").to_string();
    assert!(
        message.contains("has 90 samples; expected 125"),
        "{message}"
    );
}

#[test]
fn names_below_other_lines_are_located() {
    let head = "Bench 3\ndate 1.1.2020\nt,angle\n";
    let message = rejection_message(&folder(DESCRIPTION, head, format_sample_line));
    let cure = "the names of the columns, t, angle, are in line 3; write skip = 2 in [format]";
    assert!(message.contains(cure), "{message}");
    let cured = format!("{DESCRIPTION}\n[format]\nskip = 2\n");
    assert!(read(&folder(&cured, head, format_sample_line)).is_ok());
}

#[test]
fn utf_16_without_byte_order_mark_is_named() {
    let folder = folder(DESCRIPTION, "t,angle\n", format_sample_line);
    let text = record("t,angle\n", 0.0, format_sample_line);
    for order in [u16::to_le_bytes, u16::to_be_bytes] {
        let bytes: Vec<u8> = text.encode_utf16().flat_map(order).collect();
        std::fs::write(folder.path().join("train.csv"), bytes).expect("a file");
        let message = rejection_message(&folder);
        assert!(message.contains("is UTF-16; expected UTF-8"), "{message}");
    }
}

#[test]
fn gap_is_noted_and_splits_record() {
    let folder = folder(DESCRIPTION, "t,angle\n", format_sample_line);
    let whole = record("t,angle\n", 0.0, format_sample_line);
    let lost = |from: usize, to: usize| -> String {
        let lines = whole.lines().enumerate();
        let kept = lines.filter(|(line, _)| !(from..to).contains(line));
        kept.map(|(_, line)| format!("{line}\n")).collect()
    };
    write(folder.path(), "train.csv", &lost(121, 181));
    let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{refusal}"));
    let lengths: Vec<usize> = dataset.train.iter().map(|r| r.times.len()).collect();
    assert_eq!(lengths, [120, 220]);
    assert!(!dataset.train[0].is_continued && dataset.train[1].is_continued);
    assert_eq!(dataset.train[1].times[0], 1.8);
    assert!((dataset.train[1].channels[0][0] - 1e-3 * angle(180, 0.0)).abs() < 1e-9);
    let notes = dataset.notes.join("\n");
    assert!(
        notes.contains("train[0]: 60 samples are missing between 1.190000 s and 1.800000 s"),
        "{notes}"
    );
    // Parts with too few samples are dropped. A few missing samples do not split a record.
    write(folder.path(), "train.csv", &lost(31, 181));
    let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(dataset.train.len(), 1);
    assert!(
        dataset
            .notes
            .join("\n")
            .contains("30 samples from 0.000000 s on are too few")
    );
    write(folder.path(), "train.csv", &lost(121, 124));
    assert_eq!(
        read(&folder).map(|dataset| dataset.train.len()).ok(),
        Some(1)
    );
}

#[test]
fn rates_and_accelerations_are_channels_in_their_units() {
    let channel = |observable: &str, unit: &str| {
        DESCRIPTION.replace(
            "unit = \"mrad\"",
            &format!("unit = \"{unit}\"\nobservable = \"{observable}\""),
        )
    };
    use eomgen_records::dataset::Quantity;
    for (observable, unit, quantity) in [
        ("theta_dot", "deg/s", Quantity::Rate(0)),
        ("dot(theta)", "rad/s", Quantity::Rate(0)),
        ("theta_ddot", "rad/s^2", Quantity::Acceleration(0)),
        ("dot(dot(theta))", "deg/s^2", Quantity::Acceleration(0)),
    ] {
        let folder = folder(&channel(observable, unit), "t,angle\n", format_sample_line);
        let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{observable}: {refusal}"));
        assert_eq!(dataset.channels[0].quantity, quantity);
    }
    let folder = folder(
        &channel("theta_ddot", "rad/s"),
        "t,angle\n",
        format_sample_line,
    );
    assert!(rejection_message(&folder).contains("expected rad/s^2"));
}

#[test]
fn first_order_state_is_a_channel() {
    let description = DESCRIPTION.replace("[channels.theta]", "[channels.i]");
    let description = description.replace("\"mrad\"", "\"mA\"");
    let of_current = folder(&description, "t,angle\n", format_sample_line);
    let source = eomgen_model_spec::models::LOUDSPEAKER.source();
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let read = |folder: &TempDir| read_dataset(&folder.path().join("dataset.toml"), &model);
    let dataset = read(&of_current).unwrap_or_else(|refusal| panic!("{refusal}"));
    let channel = &dataset.channels[0];
    assert_eq!(
        channel.quantity,
        eomgen_records::dataset::Quantity::State(0)
    );
    assert!((channel.noise - 1e-4).abs() < 1e-12, "{}", channel.noise);
    let misspelt = folder(
        &description.replace("channels.i", "channels.i_3"),
        "t,angle\n",
        format_sample_line,
    );
    let refused = read(&misspelt).map(|_| ()).expect_err("no such state");
    assert!(refused.to_string().contains("`i_2`"), "{refused}");
}

/// Slide whose motion is given and whose force is measured.
const SLIDE: &str = r#"
[model]
name = "slide"
[parameters]
m = { value = 2, unit = "kg" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
[inputs]
F = { unit = "N" }
G = { unit = "N" }
H = { unit = "N" }
[kinetic]
slide = "1/2*m*(dot(x)^2 + dot(y)^2)"
[forces]
drive = { on = "x", value = "F + H" }
other = { on = "y", value = "G" }
"#;

const ALONG: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[motion.x]
column = "x"
unit = "mm"
[motion.y]
column = "x"
unit = "m"
[channels.F]
column = "F"
unit = "N"
noise = 0.01
[channels.second]
column = "G"
unit = "N"
noise = 0.01
observable = "G"
"#;

fn read_along_given_motion(description: &str) -> Result<Dataset, Refusal> {
    let folder = folder(description, "t,x,F,G\n", |t, angle| {
        format!(
            "{t},{:.12},{angle},{}\n",
            100.0 * (3.0 * t).sin() + angle,
            angle * angle
        )
    });
    let source = eomgen_model_spec::source::Source::new("slide.toml", SLIDE);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    read_dataset(&folder.path().join("dataset.toml"), &model)
}

#[test]
fn given_motion_has_rates() {
    for (every, decimated) in [(1, ""), (4, "unit = \"s\"\nevery = 4")] {
        let description = match every {
            1 => ALONG.to_owned(),
            _ => ALONG.replacen("unit = \"s\"", decimated, 1),
        };
        let dataset =
            read_along_given_motion(&description).unwrap_or_else(|refusal| panic!("{refusal}"));
        assert_eq!(dataset.motion, ["x", "y"]);
        let record = &dataset.train[0];
        for (place, t) in record.times.iter().enumerate() {
            // The row has three inputs, then coordinates, rates and second derivatives of both coordinates.
            let row = record.inputs.last_sample(*t);
            assert_eq!(row.len(), 3 + 6);
            let (sine, cosine) = (3.0 * t).sin_cos();
            let (a, b) = ((1.3 * t).sin_cos(), (3.1 * t).sin_cos());
            let wanted = [
                100.0 * sine + 100.0 * a.1 + 20.0 * b.0,
                300.0 * cosine - 130.0 * a.0 + 62.0 * b.1,
                -900.0 * sine - 169.0 * a.1 - 192.2 * b.0,
            ];
            if !(20..record.times.len() - 20).contains(&place) {
                continue;
            }
            for (kind, (wanted, within)) in wanted.iter().zip([1e-2, 1e-1, 1.0]).enumerate() {
                let (x, y) = (row[3 + 2 * kind], row[3 + 2 * kind + 1]);
                assert!(
                    (1e3 * x - wanted).abs() < within,
                    "{kind} at {t}: {x} {wanted}"
                );
                assert!((y - wanted).abs() < within, "{kind} at {t}: {y} {wanted}");
            }
        }
    }
}

/// Reads a dataset with given motion; in the training record, the cells of `x` between two samples are empty.
fn read_with_empty_cells(
    description: &str,
    empty: std::ops::Range<usize>,
) -> Result<Dataset, Refusal> {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "dataset.toml", description);
    for (file, turn) in [("train.csv", 0.0), ("test.csv", 1.0)] {
        let lines = (0..SAMPLES).map(|sample| {
            let (t, angle) = (STEP * sample as f64, angle(sample, turn));
            let x = match turn == 0.0 && empty.contains(&sample) {
                true => String::new(),
                false => format!("{:.12}", 100.0 * (3.0 * t).sin() + angle),
            };
            format!("{t:.2},{x},{angle},{x}\n")
        });
        let text = "t,x,F,G\n".to_owned() + &lines.collect::<String>();
        write(folder.path(), file, &text);
    }
    let source = eomgen_model_spec::source::Source::new("slide.toml", SLIDE);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    read_dataset(&folder.path().join("dataset.toml"), &model)
}

#[test]
fn empty_cells_of_a_given_motion_split_a_record_and_few_are_filled() {
    let x = |t: f64| {
        let angle = 100.0 * (1.3 * t).cos() + 20.0 * (3.1 * t).sin();
        let rate = 300.0 * (3.0 * t).cos() - 130.0 * (1.3 * t).sin() + 62.0 * (3.1 * t).cos();
        (1e-3 * (100.0 * (3.0 * t).sin() + angle), 1e-3 * rate)
    };
    for every in [1, 3] {
        let description =
            ALONG.replacen("unit = \"s\"", &format!("unit = \"s\"\nevery = {every}"), 1);
        let dataset = read_with_empty_cells(&description, 180..210);
        let dataset = dataset.unwrap_or_else(|refusal| panic!("{refusal}"));
        let notes = dataset.notes.join("\n");
        assert!(
            notes.contains("samples of `x` are missing between 1."),
            "{notes}"
        );
        assert!(!notes.contains("interpolated"), "{notes}");
        for record in &dataset.train {
            for (place, t) in record.times.iter().enumerate() {
                assert!(!(1.795..2.095).contains(t), "{t}");
                let inner = 20..record.times.len() - 20;
                let found = (
                    record.given_motion(0, 3)[place],
                    record.given_motion_rate(0, 2, 3)[place],
                );
                let wanted = x(*t);
                if inner.contains(&place) {
                    assert!(
                        (found.0 - wanted.0).abs() < 1e-4,
                        "{t}: {found:?} {wanted:?}"
                    );
                    assert!(
                        (found.1 - wanted.1).abs() < 1e-2,
                        "{t}: {found:?} {wanted:?}"
                    );
                }
            }
        }
    }
    let dataset = read_with_empty_cells(ALONG, 180..184);
    let dataset = dataset.unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(dataset.train.len(), 1);
    let notes = dataset.notes.join("\n");
    let note = "train[0]: missing, and interpolated: 4 samples from t = 1.8 s on of `x`";
    assert!(notes.contains(note), "{notes}");
    // The position is unknown before its first value.
    let dataset = read_with_empty_cells(ALONG, 0..20);
    let dataset = dataset.unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(dataset.train[0].times[0], 0.2);
}

#[test]
fn integrated_speed_with_a_gap_is_rejected() {
    let y = "[motion.y]\ncolumn = \"x\"\nunit = \"m\"\n";
    let speed = "[motion.y]\ncolumn = \"G\"\nunit = \"m/min\"\ninitial = 0.25\n";
    let given = ALONG.replace(y, speed);
    let said = read_with_empty_cells(&given, 180..210).map(|_| ());
    let said = said.expect_err("an unknown position").to_string();
    let place = "30 samples of `y` are missing between 1.790000 s and 2.100000 s";
    assert!(said.contains(place) && said.contains("train.csv"), "{said}");
    // In the part before the gap the position is known.
    let before = given.replacen(
        "train = [\"train.csv\"]",
        "train = [{ file = \"train.csv\", to = 1.7 }]",
        1,
    );
    assert!(read_with_empty_cells(&before, 180..210).is_ok());
    assert!(read_with_empty_cells(&given, 180..184).is_ok());
}

#[test]
fn given_speed_is_integrated_from_initial_position() {
    let y = "[motion.y]\ncolumn = \"x\"\nunit = \"m\"\n";
    let speed = "[motion.y]\ncolumn = \"G\"\nunit = \"m/min\"\ninitial = 0.25\n";
    let given = ALONG.replace(y, speed);
    let dataset = read_along_given_motion(&given).unwrap_or_else(|refusal| panic!("{refusal}"));
    let record = &dataset.train[0];
    for (place, t) in record.times.iter().enumerate().skip(1) {
        let row = record.inputs.last_sample(*t);
        let before = record.inputs.last_sample(record.times[place - 1]);
        // Columns of y, y_dot and y_ddot.
        let [y, rate, second] = [4, 6, 8].map(|column| (before[column], row[column]));
        let angle = angle(place, 0.0);
        assert!((rate.1 - angle * angle / 60.0).abs() < 1e-6, "{rate:?}");
        let step = t - record.times[place - 1];
        assert!((y.1 - y.0 - 0.5 * step * (rate.0 + rate.1)).abs() < 1e-3);
        assert!((rate.1 - rate.0 - 0.5 * step * (second.0 + second.1)).abs() < 1e-2);
    }
    assert_eq!(record.given_motion(1, 3)[0], 0.25);
    assert!(
        !dataset.notes.join("\n").contains("integrated"),
        "{:?}",
        dataset.notes
    );
    let unstated = read_along_given_motion(&given.replace("initial = 0.25\n", ""));
    let notes = unstated
        .unwrap_or_else(|refusal| panic!("{refusal}"))
        .notes
        .join("\n");
    assert!(notes.contains("set initial in [motion.y]"), "{notes}");
    for (wrong, part) in [
        (
            ALONG.replace("[motion.y]", "[motion.y]\ninitial = 1"),
            "the column contains the position",
        ),
        (
            given.replace("initial = 0.25", "wrap = 1"),
            "a speed does not wrap around",
        ),
    ] {
        let said = read_along_given_motion(&wrong)
            .err()
            .map(|refusal| refusal.to_string())
            .unwrap_or_default();
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn samples_at_reversals_are_ignored() {
    let dataset = read_along_given_motion(ALONG).unwrap_or_else(|refusal| panic!("{refusal}"));
    let left_out = dataset.train[0].channels[0]
        .iter()
        .filter(|v| v.is_nan())
        .count();
    assert!((4..40).contains(&left_out), "{left_out}");
    let notes = dataset.notes.join("\n");
    assert!(notes.contains("samples of `second` are ignored"), "{notes}");
    assert!(
        notes.contains("input `H` is not driven") && !notes.contains("input `F`"),
        "{notes}"
    );
}

#[test]
fn given_motion_cannot_drive_simulation_and_must_move() {
    let folder = folder(ALONG, "t,x,F,G\n", |t, angle| {
        format!("{t},3,{angle},{t}\n")
    });
    let source = eomgen_model_spec::source::Source::new("slide.toml", SLIDE);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let path = folder.path().join("dataset.toml");
    let still = read_dataset(&path, &model)
        .err()
        .map(|refusal| refusal.to_string());
    assert!(
        still.is_some_and(|said| said.contains("`F`")),
        "nothing moves"
    );
    let driven = eomgen_records::read_inputs(&path, "train[0]", (&model, &[]));
    let driven = driven.err().map(|refusal| refusal.to_string());
    let said = "the records give the motion, but no inputs to simulate it";
    assert!(driven.is_some_and(|driven| driven.contains(said)));
}

#[test]
fn incomplete_and_duplicate_motions_are_rejected() {
    let without = |part: &str| ALONG.replace(part, "");
    let y = "[motion.y]\ncolumn = \"x\"\nunit = \"m\"\n";
    let both =
        "[motion.x]\ncolumn = \"x\"\nunit = \"mm\"\n[motion.y]\ncolumn = \"x\"\nunit = \"m\"\n";
    let second =
        "[channels.second]\ncolumn = \"G\"\nunit = \"N\"\nnoise = 0.01\nobservable = \"G\"\n";
    let fed = "[inputs.F]\ncolumn = \"F\"\nunit = \"N\"\n";
    let rest = "[initial]\nstate = \"rest\"\n";
    let third = "[channels.z]\ncolumn = \"G\"\nunit = \"m\"\nnoise = 1\nobservable = \"x\"\n";
    for (description, said) in [
        (without(y), "the motion of `y` is not given"),
        (
            without(both),
            "`F` is an input of the model: it can be a channel only if the motion is given",
        ),
        (without(second), "measured inputs: 1, coordinates: 2"),
        (ALONG.to_owned() + fed, "`F` is both an input and a channel"),
        (
            ALONG.to_owned() + rest,
            "[initial] is not used if the motion is given",
        ),
        (ALONG.to_owned() + third, "`x` is given by [motion]"),
        (
            ALONG.replace("[motion.y]", "[motion.z]"),
            "the model has no coordinate `z`",
        ),
        (
            ALONG.replacen("unit = \"mm\"", "unit = \"N\"", 1),
            "expected m",
        ),
        (
            ALONG.replacen("unit = \"mm\"", "unit = \"mm\"\nnoise = 1", 1),
            "noise",
        ),
    ] {
        let refusal = read_along_given_motion(&description)
            .err()
            .map(|refusal| refusal.to_string());
        let refusal = refusal.unwrap_or_else(|| panic!("accepted: {description}"));
        assert!(refusal.contains(said), "{said}: {refusal}");
    }
}

#[test]
fn common_mistakes_are_reported_with_cure() {
    let refused_with = |description: &str, head: &str, line: &dyn Fn(f64, f64) -> String| {
        let folder = folder(description, head, line);
        rejection_message(&folder)
    };
    let bench = "# bench 4, drive, run 7\n# by hand\nt,angle\n";
    let said = refused_with(DESCRIPTION, bench, &format_sample_line);
    assert!(said.contains("write comment = \"#\" in [format]"), "{said}");
    let said = refused_with(DESCRIPTION, "t,angle\ns,mrad\n", &format_sample_line);
    assert!(said.contains("write units = true in [format]"), "{said}");
    let said = refused_with(DESCRIPTION, "", &format_sample_line);
    assert!(said.contains("write names = false in [format]"), "{said}");
    let quoted = DESCRIPTION
        .replace("column = \"t\"", "column = \"1\"")
        .replace("[time]", "[format]\nnames = false\n[time]");
    let said = refused_with(&quoted, "", &format_sample_line);
    assert!(said.contains("from 1 on: column = 1"), "{said}");
    let joined = DESCRIPTION.replace("\"mrad\"", "\"mNm\"");
    let said = refused_with(&joined, "t,angle\n", &format_sample_line);
    assert!(said.contains("separate factors by a space: mN m"), "{said}");
    let motion = read_along_given_motion(&ALONG.replace("observable = \"G\"", ""));
    let said = motion.err().map(|refusal| refusal.to_string());
    let said = said.expect("no such input");
    assert!(
        said.contains("no observable or input `second`") && said.contains("F, G"),
        "{said}"
    );
}

#[test]
fn blank_lines_after_samples_are_ignored() {
    for blank in ["", "\n", "   \n\t\n", ",\n , \n", "\r\n \r\n"] {
        let folder = folder(DESCRIPTION, "t,angle\n", |t, a| format!("{t:.2},{a:.6}\n"));
        let path = folder.path().join("train.csv");
        let text = std::fs::read_to_string(&path).expect("a record");
        write(folder.path(), "train.csv", &(text + blank));
        let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{blank:?}: {refusal}"));
        assert_eq!(dataset.train[0].times.len(), SAMPLES, "{blank:?}");
    }
}

#[test]
fn missing_last_cell_keeps_column_names() {
    let folder = folder("", "t,theta\n", |t, a| match (t / STEP).round() {
        50.0 => format!("{t:.2},\n"),
        _ => format!("{t:.2},{:.6}\n", 1e-3 * a),
    });
    let text = propose_dataset(&folder.path().join("train.csv"), "train.csv", &pendulum());
    let text = text.unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(text.contains("column = \"theta\""), "{text}");
}

/// Trolley with prescribed position, and rope with prescribed length.
const CRANE: &str = r#"[model]
name = "crane"
[parameters]
m = { value = 800, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
[inputs]
s = { unit = "m", rates = 2 }
l = { unit = "m", rates = 2, range = [2, 12] }
[coordinates]
theta = { unit = "rad" }
[kinetic]
load = "1/2*m*((dot(s) + dot(l)*sin(theta) + l*cos(theta)*dot(theta))^2 + (l*sin(theta)*dot(theta) - dot(l)*cos(theta))^2)"
[potential]
load = "-m*g*l*cos(theta)"
"#;

#[test]
fn prescribed_motion_is_a_spline_or_at_rest() {
    let source = eomgen_model_spec::source::Source::new("crane.toml", CRANE);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let folder = folder(DESCRIPTION, "t,angle\n", |t, a| format!("{t:.2},{a:.6}\n"));
    let path = folder.path().join("dataset.toml");
    let dataset = read_dataset(&path, &model).unwrap_or_else(|refusal| panic!("{refusal}"));
    let names: Vec<&str> = model
        .inputs
        .iter()
        .map(|input| input.name.as_str())
        .collect();
    let held = dataset.train[0].inputs.last_sample(1.0);
    for (name, value) in names.iter().zip(held) {
        let rest = if *name == "l" { 7.0 } else { 0.0 };
        assert_eq!(*value, rest, "{name}");
    }
    let notes = dataset.notes.join("\n");
    assert!(
        notes.contains("`l`, a prescribed motion, is not driven and rests at 7"),
        "{notes}"
    );
    let column = "[inputs.l]\ncolumn = \"angle\"\nunit = \"m\"\n[channels.theta]";
    let given = DESCRIPTION.replace("[channels.theta]", column);
    write(folder.path(), "dataset.toml", &given);
    let dataset = read_dataset(&path, &model).unwrap_or_else(|refusal| panic!("{refusal}"));
    let place = names.iter().position(|name| *name == "l").expect("l");
    let record = &dataset.train[0];
    let middle = 0.5 * (record.times[10] + record.times[11]);
    assert!(!record.inputs.is_held(place) && record.inputs.evaluate(middle)[place + 1] != 0.0);
    let gain = given.replace("[inputs.l]", "[inputs.l]\ngain = { sd = 0.1 }");
    write(folder.path(), "dataset.toml", &gain);
    let refusal = read_dataset(&path, &model).expect_err("a gain").to_string();
    assert!(
        refusal.contains("the gain of `l`, a prescribed motion, cannot be estimated"),
        "{refusal}"
    );
}
