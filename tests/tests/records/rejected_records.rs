//! Tests that `compare` and `discover` reject implausible records with the reason, and print notes about weaknesses of
//! a record.

use eomgen_tests::measured::{DESCRIPTION, Measured, SAMPLES, record};

#[test]
fn valid_records_are_compared() {
    let (result, warned) = Measured::stage(0.0).run_command("compare", "out");
    assert_eq!(result["verdict"], "no_significant_gap", "{result:#}");
    assert_eq!(warned, "fitting the original model\n");
}

fn change_cells(change: impl Fn(usize, &mut Vec<String>)) -> String {
    let text = record(0.0, 0.0);
    let line = |(place, line): (usize, &str)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        change(place, &mut cells);
        cells.join(",") + "\n"
    };
    text.lines().enumerate().map(line).collect()
}

/// Returns the record with `by` applied to the cells of column `column` in all lines from line `from` on.
fn change_column(column: usize, from: usize, by: impl Fn(usize, &str) -> String) -> String {
    change_cells(|place, cells| {
        if place >= from.max(1) {
            cells[column] = by(place, &cells[column]);
        }
    })
}

#[test]
fn invalid_training_records_are_rejected() {
    let sound = record(0.0, 0.0);
    let whole = sound.len();
    let missing = |_: usize, _: &str| "NaN".to_owned();
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (Vec::new(), "is empty"),
        (b"\n\n\n".to_vec(), "train.csv"),
        (b"t,force,q\n".to_vec(), "has 0 samples"),
        (sound.as_bytes()[..700].to_vec(), "train.csv"),
        (
            sound.as_bytes()[..whole - 20].to_vec(),
            "line 401: has 2 cells",
        ),
        (
            (0..20_000).map(|i: u32| (i * i % 251) as u8).collect(),
            "train.csv",
        ),
        (vec![0; 5000], "train.csv"),
        (b"PAR1 and no more".to_vec(), "no column `t`"),
        (
            sound.replace(',', ";").into_bytes(),
            "separated by semicolons",
        ),
        (
            sound.replacen("force", "torque", 1).into_bytes(),
            "no column `force`; the file has t, torque, q",
        ),
        (sound.replacen("t,", "q,", 1).into_bytes(), "no column `t`"),
        (
            sound.replacen("force", "q", 1).into_bytes(),
            "no column `force`",
        ),
        (
            sound.replacen("t,force,q", "t,t,q", 1).into_bytes(),
            "two columns `t`",
        ),
        (
            change_column(2, 100, missing).into_bytes(),
            "301 of 400 samples are missing",
        ),
        (
            change_column(2, 1, missing).into_bytes(),
            "400 of 400 samples are missing",
        ),
        (
            change_column(1, 300, missing).into_bytes(),
            "input `force`: 101 of 400",
        ),
        (
            change_column(0, 200, missing).into_bytes(),
            "line 201: the time is missing",
        ),
        (
            change_column(0, 200, |_, _| "0.5".to_owned()).into_bytes(),
            "the time does not increase",
        ),
        (
            change_column(2, 7, |_, _| "oops".to_owned()).into_bytes(),
            "line 8: column 3: \"oops\" is not a number",
        ),
        (
            change_column(2, 1, |_, _| "0.25".to_owned()).into_bytes(),
            "the sensor is dead",
        ),
        (
            change_column(2, 1, |i, cell| format!("{cell}e{}", i % 40)).into_bytes(),
            "correct its `unit` or its `noise`",
        ),
        (
            change_column(0, 390, |i, _| format!("{i}e9")).into_bytes(),
            "most of the record is missing",
        ),
        (
            sound
                .lines()
                .take(30)
                .map(|line| format!("{line}\n"))
                .collect::<String>()
                .into_bytes(),
            "has 29 samples",
        ),
    ];
    let measured = Measured::stage(0.0);
    for (bytes, part) in cases {
        measured.write("train.csv", &bytes);
        let message = measured.rejection();
        assert!(
            message.contains("train.csv") && message.contains(part),
            "{part}: {message}"
        );
    }
}

#[test]
fn contradictory_datasets_are_rejected() {
    let measured = Measured::stage(0.0);
    for (from, to, part) in [
        ("unit = \"m\"", "unit = \"N\"", "is in N, expected m"),
        ("unit = \"N\"", "unit = \"s\"", "is in s, expected N"),
        ("unit = \"s\"", "unit = \"m\"", "expected s"),
        ("noise = 1e-6", "noise = 0", "greater than 0"),
        ("noise = 1e-6", "noise = nan", "not a finite number"),
        (
            "noise = 1e-6",
            "noise = 1e-30",
            "correct its `unit` or its `noise`",
        ),
        ("noise = 1e-6", "", "noise"),
        (
            "[channels.q]",
            "[channels.elbow]",
            "no observable, coordinate or state `elbow`",
        ),
        (
            "length = 0.25",
            "length = 1e-9",
            "contains fewer than 4 samples",
        ),
        ("length = 0.25", "length = -1", "expected seconds"),
        ("length = 0.25", "length = \"all\"", "expected \"record\""),
        ("\"rest\"", "\"asleep\"", "expected \"rest\" or"),
        ("F_v", "F_w", "is not a parameter of the model"),
        (
            "relative = 0.05",
            "relative = -1",
            "expected a fraction of its value",
        ),
        ("[\"test.csv\"]", "[]", "lists no test record"),
        ("[\"test.csv\"]", "[\"train.csv\"]", "in one file"),
        (
            "[\"test.csv\"]",
            "[\"none.csv\"]",
            "the record \"none.csv\" does not exist\n --> ",
        ),
        ("length = 0.25", "length = \"1 s\"", "write length = 1"),
        ("[channels.", "[channel.", "unknown table `channel`"),
        ("[\"test.csv\"]", "[\".\"]", "is not a file"),
        (
            "[\"test.csv\"]",
            "[\"../test.csv\"]",
            "outside the dataset's folder",
        ),
        ("[windows]", "[windows", "dataset.toml"),
        (
            "[windows]",
            "[experiment]\ninputs.forse = { range = [-1, 1] }\n[windows]",
            "did you mean `force`",
        ),
        (
            "[windows]",
            "[experiment]\ninputs.force = { range = [1, -1] }\n[windows]",
            "the range from 1 to -1 is empty",
        ),
        (
            "[windows]",
            "[experiment]\ninputs.force = { range = [1] }\n[windows]",
            "has 1 numbers",
        ),
        (
            "[windows]",
            "[experiment]\ninputs.force = { band = [-1, 1] }\n[windows]",
            "a frequency cannot be -1",
        ),
        (
            "[windows]",
            "[experiment]\ninputs.force = { speed = 1 }\n[windows]",
            "speed",
        ),
        (
            "[windows]",
            "[experiment]\nlimits.p = [0, 1]\n[windows]",
            "there is no channel `p`",
        ),
        (
            "[windows]",
            "[experiment]\nduration = 0\n[windows]",
            "greater than 0",
        ),
        (
            "[windows]",
            "[experiment]\nduration = 1e9\nsample = 1e-3\n[windows]",
            "is too long",
        ),
    ] {
        let description = DESCRIPTION.replacen(from, to, 1);
        assert_ne!(description, DESCRIPTION, "{from}");
        measured.write("dataset.toml", description.as_bytes());
        let message = measured.rejection();
        assert!(message.contains(part), "{to}: {message}");
    }
}

#[test]
fn test_record_equal_to_training_record_is_rejected() {
    let measured = Measured::stage(0.0);
    let sound = record(0.0, 0.0);
    let lines: Vec<&str> = sound.lines().collect();
    let later: String = (lines[..1].iter().chain(&lines[81..]))
        .map(|l| format!("{l}\n"))
        .collect();
    let negative = change_cells(|place, cells| {
        for cell in cells.iter_mut().skip(1).filter(|_| place > 0) {
            *cell = match cell.strip_prefix('-') {
                Some(positive) => positive.to_owned(),
                None => format!("-{cell}"),
            };
        }
    });
    let holed = change_column(2, 1, |place, cell| {
        if place % 9 == 1 {
            String::new()
        } else {
            cell.to_owned()
        }
    });
    for (text, part) in [
        (sound.clone(), "test[0] repeats train[0];"),
        (later, "samples later"),
        (negative, "with the opposite sign"),
        (holed, "test[0] repeats train[0];"),
    ] {
        measured.write("test.csv", text.as_bytes());
        let message = measured.rejection();
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn two_channels_with_the_same_values_are_rejected() {
    let measured = Measured::stage(0.0);
    let other = "[channels.again]\ncolumn = \"q\"\nobservable = \"q\"\nunit = \"m\"\nnoise = 1e-6\n\n[initial]";
    let description = DESCRIPTION.replacen("[initial]", other, 1);
    measured.write("dataset.toml", description.as_bytes());
    assert!(
        measured
            .rejection()
            .contains("have the same values except for the sign")
    );
}

#[test]
fn columns_with_wrong_sign_or_unit_are_reported() {
    let measured = Measured::stage(0.0);
    let scaled = |by: f64| {
        change_column(2, 1, |_, cell| {
            let value: f64 = cell.parse().expect("a number");
            format!("{:?}", value * by)
        })
    };
    for (by, part) in [
        (-1.0, "has the opposite sign of the model"),
        (1e3, "a thousand times"),
        (1e-3, "a thousandth of"),
    ] {
        measured.write("train.csv", scaled(by).as_bytes());
        let message = measured.rejection();
        assert!(message.contains(part), "{by}: {message}");
    }
    let description = DESCRIPTION
        .replacen("column = \"force\"", "column = \"q\"", 1)
        .replacen(
            "column = \"q\"\nunit = \"m\"",
            "column = \"force\"\nunit = \"m\"",
            1,
        );
    let exchanged = Measured::stage(0.0);
    exchanged.write("dataset.toml", description.as_bytes());
    let (_, warned) = exchanged.run_command("compare", "exchanged");
    assert!(warned.contains("`q` does not follow the model"), "{warned}");
    // A gain within the sensor's prior is not rejected.
    measured.write("train.csv", scaled(1.02).as_bytes());
    measured.run_command("compare", "gain");
}

#[test]
fn known_gain_of_a_sensor_is_part_of_the_expected_column() {
    let measured = Measured::stage(0.0);
    let specification = std::fs::read_to_string(eomgen_tests::models::path("emps"));
    let specification = specification.expect("the stage");
    for gain in [-1.0, 57.295_779_513] {
        let scaled = |turn: f64| -> String {
            let text = record(0.0, turn);
            let lines = text.lines().enumerate().map(|(place, line)| {
                let (head, cell) = line.rsplit_once(',').expect("three cells");
                match cell.parse::<f64>() {
                    Ok(value) if place > 0 => format!("{head},{:?}\n", gain * value),
                    _ => format!("{line}\n"),
                }
            });
            lines.collect()
        };
        measured.write("train.csv", scaled(0.0).as_bytes());
        measured.write("test.csv", scaled(1.0).as_bytes());
        let noise = format!("noise = {:e}\n", 1e-6 * gain.abs());
        let known = format!("{noise}gain = {{ mean = {gain}, sd = 0 }}\n");
        let in_dataset = DESCRIPTION.replacen("noise = 1e-6\n", &known, 1);
        measured.write("dataset.toml", in_dataset.as_bytes());
        let (result, _) = measured.run_command("compare", "out");
        assert_eq!(
            result["verdict"], "no_significant_gap",
            "{gain}: {result:#}"
        );
        // The specification has the same gain in one case and the opposite gain in the other.
        let unstated = DESCRIPTION.replacen("noise = 1e-6\n", &noise, 1);
        measured.write("dataset.toml", unstated.as_bytes());
        for (sign, is_right) in [(1.0, true), (-1.0, false)] {
            let sensors = format!("\n[sensors]\nq = {{ gain = {} }}\n", sign * gain);
            measured.write("stage.toml", (specification.clone() + &sensors).as_bytes());
            let mut arguments = measured.arguments("compare", "out");
            arguments[1] = measured.file("stage.toml").display().to_string();
            let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            let run = eomgen_tests::program::run(&arguments);
            let said = String::from_utf8_lossy(&run.stderr);
            assert_eq!(run.status.success(), is_right, "{gain}, {sign}: {said}");
            assert_eq!(said.contains("has the opposite sign"), !is_right, "{said}");
        }
    }
    let zero = DESCRIPTION.replacen(
        "noise = 1e-6\n",
        "noise = 1e-6\ngain = { mean = 0, sd = 0 }\n",
        1,
    );
    measured.write("dataset.toml", zero.as_bytes());
    let message = measured.rejection();
    assert!(message.contains("a gain cannot be 0"), "{message}");
    assert!(message.contains("dataset.toml:19:"), "{message}");
}

#[test]
fn empty_cells_of_an_input_split_a_record_like_missing_rows() {
    let measured = Measured::stage(0.0);
    let emptied = |count: usize| {
        change_column(1, 1, |place, cell| {
            match (200..200 + count).contains(&place) {
                true => String::new(),
                false => cell.to_owned(),
            }
        })
    };
    measured.write("train.csv", emptied(30).as_bytes());
    let (result, warned) = measured.run_command("compare", "out");
    assert_eq!(result["verdict"], "no_significant_gap", "{result:#}");
    let note = "train[0]: 30 samples of `force` are missing between 0.990000 s and 1.145000 s: the parts before and \
                after are used as separate records";
    assert!(warned.contains(note), "{warned}");
    measured.write("train.csv", emptied(4).as_bytes());
    let (_, warned) = measured.run_command("compare", "few");
    assert!(warned.contains("the last known value is held"), "{warned}");
    assert!(!warned.contains("separate records"), "{warned}");
}

#[test]
fn simulation_across_missing_rows_of_a_record_is_warned_of() {
    let measured = Measured::stage(0.0);
    let text = record(0.0, 0.0);
    let lines = text.lines().enumerate();
    let kept = lines.filter(|(line, _)| !(200..230).contains(line));
    let kept: String = kept.map(|(_, line)| format!("{line}\n")).collect();
    let mut arguments = measured.arguments("simulate", "out.csv");
    arguments[2].insert_str(0, "--record=");
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    for (rows, is_warned) in [(kept, true), (text.clone(), false)] {
        measured.write("train.csv", rows.as_bytes());
        let run = eomgen_tests::program::run(&arguments[..5]);
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{said}");
        let warning = "30 samples are missing between 0.990000 s and 1.145000 s: the inputs in between are unknown";
        assert_eq!(said.contains(warning), is_warned, "{said}");
    }
}

#[test]
fn output_folder_that_is_a_file_is_rejected_before_the_fit() {
    let measured = Measured::stage(0.0);
    measured.write("taken", b"kept");
    for command in ["compare", "discover"] {
        let arguments = measured.arguments(command, "taken");
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let message = eomgen_tests::program::run_rejected(&arguments);
        assert!(message.contains("is not a folder"), "{message}");
        assert!(!message.contains("fitting"), "{message}");
    }
    assert_eq!(measured.read("taken"), "kept");
}

#[test]
fn huge_records_are_rejected_before_reading() {
    let measured = Measured::stage(0.0);
    let file = std::fs::File::create(measured.file("train.csv")).expect("a file");
    // The file is sparse: it has a gigabyte but takes no disk space.
    file.set_len(1 << 30).expect("a long file");
    let message = measured.rejection();
    assert!(
        message.contains("1073741824 bytes, more than the limit"),
        "{message}"
    );
    let mut long = "t,force,q\n".to_owned();
    for sample in 0..1_000_002 {
        long += &format!("{sample},0,0\n");
    }
    measured.write("train.csv", long.as_bytes());
    let message = measured.rejection();
    assert!(message.contains("more than 1000000 samples"), "{message}");
}

#[test]
fn weaknesses_of_a_record_are_noted() {
    let measured = Measured::stage(0.0);
    let holes = |place: usize, cell: &str| {
        if place % 10 == 3 {
            "nan".to_owned()
        } else {
            cell.to_owned()
        }
    };
    measured.write("train.csv", change_column(2, 1, holes).as_bytes());
    let (result, warned) = measured.run_command("compare", "holes");
    assert!(
        warned.contains("missing, and ignored: 40 samples from t = "),
        "{warned}"
    );
    assert!(
        result["notes"].to_string().contains("missing"),
        "{result:#}"
    );
    // The peaks of the motion, a fortieth of the samples, are clipped.
    let clipped = change_column(2, 1, |_, cell| {
        let value: f64 = cell.parse().expect("a number");
        format!("{:?}", value.min(0.1))
    });
    measured.write("train.csv", clipped.as_bytes());
    let (_, warned) = measured.run_command("compare", "clipped");
    assert!(warned.contains("the sensor may be saturated"), "{warned}");
    let uneven = change_column(0, 1, |place, cell| {
        let t: f64 = cell.parse().expect("a number");
        format!("{:?}", if place % 20 == 0 { t + 0.002 } else { t })
    });
    measured.write("train.csv", uneven.as_bytes());
    let (_, warned) = measured.run_command("compare", "uneven");
    assert!(warned.contains("differ from 0.005"), "{warned}");
    assert_eq!(SAMPLES, 400);
}

#[test]
fn single_outliers_are_excluded_and_reported() {
    for (lines, error) in [(&[50][..], 1e6), (&[11, 70, 200], -0.4), (&[390], 0.05)] {
        let measured = Measured::stage(0.0);
        let wrong = |place: usize, cell: &str| {
            let value: f64 = cell.parse().expect("a number");
            let is_wrong = lines.contains(&(place + 1));
            format!("{:?}", if is_wrong { value + error } else { value })
        };
        measured.write("train.csv", change_column(2, 1, wrong).as_bytes());
        let (result, warned) = measured.run_command("compare", "outliers");
        assert_eq!(result["verdict"], "no_significant_gap", "{error}: {warned}");
        let named = format!("line {} of", lines[0]);
        let count = format!("the largest of {} outliers", lines.len());
        let is_named = warned.contains("left out as an outlier")
            && (lines.len() > 1 && warned.contains(&count) || warned.contains(&named));
        assert!(is_named, "{error}: {warned}");
    }
}

#[test]
fn control_characters_of_files_are_escaped_in_terminal_and_report() {
    let hostile = "x\u{1b}[31m\u{202e}\u{9b}";
    let is_hidden = |letter: char| letter != '\n' && (letter.is_control() || letter == '\u{202e}');
    let measured = Measured::stage(0.0);
    let sound = record(0.0, 0.0);
    let renamed = sound.replacen("force", hostile, 1);
    measured.write("train.csv", renamed.as_bytes());
    let said = measured.rejection();
    assert!(said.contains("x\\u{1b}[31m\\u{202e}\\u{9b}"), "{said:?}");
    assert!(!said.contains(is_hidden), "{said:?}");
    measured.write("train.csv", sound.as_bytes());
    let channel = format!(
        "[channels.\"{}\"]\nobservable = \"q\"",
        "x\\u001b[31m\\u202e"
    );
    let description = DESCRIPTION.replace("[channels.q]", &channel);
    let titled = format!("title = \"a\\u202eb\"\n{description}");
    measured.write("dataset.toml", titled.as_bytes());
    let (result, warned) = measured.run_command("compare", "out");
    assert!(!warned.contains(is_hidden), "{warned:?}");
    assert!(
        result["gap"].get("x\u{1b}[31m\u{202e}").is_some(),
        "{result:#}"
    );
    let page = std::fs::read_to_string(measured.file("out/report.html")).expect("a page");
    assert!(
        !page.contains(|letter| letter != '\t' && is_hidden(letter)),
        "{page}"
    );
    assert!(page.contains("a\\u{202e}b"), "{page}");
    assert!(
        page.contains("http-equiv=\"Content-Security-Policy\""),
        "{page}"
    );
}
