//! History of times and instruction counts of the contenders, as table lines and figures.

use std::fmt::Write;

use eomgen_plot::{Axes, Frame, Panel, Plate, PlotError, Series, plate};

use crate::instructions::Count;

/// Shortest times of many calls at one order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// Truncation order S.
    pub order: usize,
    /// Times of independent calls, whose execution overlaps in the processor.
    pub overlapping: Contenders,
    /// Times of dependent calls: the time t of a call depends on the previous result.
    pub waiting: Contenders,
}

/// Time per call of each contender, in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contenders {
    /// One sine and a copy of the rates.
    pub floor: f64,
    /// Generated code.
    pub generated: f64,
    /// Hand-written code in O(S).
    pub hand_written: f64,
    /// Hand-assembled Eq. (22).
    pub equation_22: f64,
}

/// Curves with their names.
type Named<'a> = Vec<(String, &'a [f64])>;

/// Orders whose time ratios are recorded.
const KEPT: [usize; 3] = [4, 16, 64];

/// Cases with recorded instruction counts.
const COUNTED: [&str; 5] = [
    "generated_4",
    "generated_16",
    "generated_64",
    "derive_and_emit_4",
    "derive_and_emit_128",
];

/// First columns of the table; the columns of orders and counts follow.
const FIRST: &str = "date,commit,features,floor_4_ns";

/// Returns the header of the table.
pub fn heading() -> String {
    let mut line = FIRST.to_owned();
    for order in KEPT {
        let ratios = [
            "generated_to_hand",
            "generated_to_equation_22",
            "hand_to_floor",
        ];
        for ratio in ratios {
            let _ = write!(line, ",{ratio}_{order}");
        }
    }
    for case in COUNTED {
        let _ = write!(line, ",instructions_{case}");
    }
    for order in KEPT {
        let _ = write!(line, ",hand_to_floor_waiting_{order}");
    }
    line + "\n"
}

/// Returns a line of the table. `run` contains date, commit and target features. Fields of missing counts are empty.
/// The floor of order 4 is measured with the same kind of calls as the contender.
pub fn line(run: &[String; 3], times: &[Times], counts: &[Count]) -> String {
    let at = |order: usize| times.iter().find(|times| times.order == order);
    let floor_of = |way: fn(&Times) -> Contenders| at(4).map_or(f64::NAN, |t| way(t).floor);
    let floor = floor_of(|times| times.overlapping);
    let waiting_floor = floor_of(|times| times.waiting);
    let mut line = format!("{},{:.2}", run.join(","), 1e9 * floor);
    for order in KEPT {
        if let Some(Times {
            overlapping: times, ..
        }) = at(order)
        {
            let ratios = [
                times.generated / times.hand_written,
                times.generated / times.equation_22,
                times.hand_written / floor,
            ];
            for ratio in ratios {
                let _ = write!(line, ",{ratio:.3}");
            }
        }
    }
    for case in COUNTED {
        let count = counts.iter().find(|(name, _)| name == case);
        let _ = write!(
            line,
            ",{}",
            count.map_or(String::new(), |(_, n)| n.to_string())
        );
    }
    for order in KEPT {
        let ratio = at(order).map_or(f64::NAN, |t| t.waiting.hand_written / waiting_floor);
        let _ = write!(line, ",{ratio:.3}");
    }
    line + "\n"
}

/// Returns the times of a run as a table in ns.
pub fn table(times: &[Times]) -> String {
    let line = |order: usize, calls: &str, c: &Contenders| {
        let all = [c.floor, c.generated, c.hand_written, c.equation_22].map(|time| 1e9 * time);
        let [floor, generated, hand_written, equation_22] = all;
        format!("{order},{calls},{floor:.2},{generated:.2},{hand_written:.2},{equation_22:.2}\n")
    };
    let overlapping = times
        .iter()
        .map(|t| line(t.order, "overlapping", &t.overlapping));
    let waiting = times.iter().map(|t| line(t.order, "waiting", &t.waiting));
    let lines: String = overlapping.chain(waiting).collect();
    format!("order,calls,floor,generated,hand_written,equation_22\n{lines}")
}

/// Returns the times of overlapping calls as a table in ns.
pub fn overlapping_table(times: &[Times]) -> String {
    let lines = times.iter().map(|times| {
        let c = &times.overlapping;
        let all = [c.floor, c.generated, c.hand_written, c.equation_22].map(|time| 1e9 * time);
        let [floor, generated, hand_written, equation_22] = all;
        let order = times.order;
        format!("{order},{floor:.3},{generated:.3},{hand_written:.3},{equation_22:.3}\n")
    });
    let lines: String = lines.collect();
    format!("order,floor,generated,hand_written,equation_22\n{lines}")
}

/// Draws a [table](overlapping_table) of times as a function of the order (SVG).
///
/// # Errors
/// An empty figure.
pub fn curves(table: &str) -> Result<String, PlotError> {
    let orders = column(table, "order");
    let of = |name: &str| -> Vec<f64> {
        let times = column(table, name).into_iter();
        times.map(|time| 1e-9 * time).collect()
    };
    let contenders = [
        ("Eq. (22) by hand", of("equation_22")),
        ("O(S) by hand", of("hand_written")),
        ("generated", of("generated")),
        ("floor: one sine and a copy", of("floor")),
    ];
    let named: Named<'_> = contenders
        .iter()
        .map(|(name, times)| ((*name).to_owned(), times.as_slice()))
        .collect();
    draw(
        "Time of one right-hand side over the number of modes S",
        vec![frame("time", "s", "number of modes S", &orders, &named)],
    )
}

/// Draws ratios and counts of all runs in a table (SVG).
///
/// # Errors
/// An empty figure.
pub fn development(table: &str) -> Result<String, PlotError> {
    let runs: Vec<f64> = (1..table.lines().count()).map(|run| run as f64).collect();
    let of = |kind: &str| {
        KEPT.map(|order| {
            let values = column(table, &format!("{kind}_{order}"));
            (format!("{order} modes"), values)
        })
    };
    let frames = [
        ("time / O(S) by hand", of("generated_to_hand")),
        ("time / Eq. (22)", of("generated_to_equation_22")),
        ("instructions", of("instructions_generated")),
    ];
    let drawn: Vec<(&str, Named<'_>)> = frames
        .iter()
        .map(|(quantity, series)| {
            let series = series.iter();
            let series = series.map(|(name, values)| (name.clone(), values.as_slice()));
            (*quantity, series.collect())
        })
        .collect();
    let frames = drawn
        .iter()
        .map(|(quantity, series)| frame(quantity, "", "recorded run", &runs, series))
        .collect();
    draw("Generated code in all recorded runs", frames)
}

/// Returns a column of the table; empty fields are NaN.
fn column(table: &str, name: &str) -> Vec<f64> {
    let mut lines = table.lines();
    let heading = lines.next().unwrap_or_default();
    let Some(index) = heading.split(',').position(|column| column == name) else {
        return Vec::new();
    };
    lines
        .map(|line| {
            let cell = line.split(',').nth(index);
            cell.and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN)
        })
        .collect()
}

fn frame<'a>(
    quantity: &str,
    unit: &str,
    over: &'static str,
    abscissa: &'a [f64],
    series: &[(String, &'a [f64])],
) -> Frame<'a> {
    let series = series.iter().map(|(label, values)| Series {
        label: label.clone(),
        abscissa,
        values,
        ..Series::default()
    });
    Frame {
        panel: Panel {
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            series: series.collect(),
            ..Panel::default()
        },
        axes: Axes::Count(over),
        ..Frame::default()
    }
}

fn draw(title: &str, frames: Vec<Frame<'_>>) -> Result<String, PlotError> {
    plate(&Plate {
        title: title.to_owned(),
        columns: 1,
        frames,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(order: usize) -> Times {
        let overlapping = Contenders {
            floor: 1e-8,
            generated: 2e-8,
            hand_written: 4e-8,
            equation_22: 8e-8,
        };
        let waiting = Contenders {
            floor: 3e-8,
            ..overlapping
        };
        Times {
            order,
            overlapping,
            waiting,
        }
    }

    #[test]
    fn figures_show_the_recorded_runs() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect(name);
        let rates = curves(&read("times.csv")).expect("a figure");
        assert!(rates == read("../docs/rates.svg"), "rates.svg differs");
        let history = development(&read("history.csv")).expect("a figure");
        assert!(
            history == read("../docs/history.svg"),
            "history.svg differs"
        );
    }

    #[test]
    fn table_has_the_times_of_overlapping_calls() {
        let table = overlapping_table(&[4, 16].map(times));
        assert_eq!(column(&table, "order"), [4.0, 16.0]);
        assert_eq!(column(&table, "floor"), [10.0, 10.0]);
        assert_eq!(column(&table, "equation_22"), [80.0, 80.0]);
    }

    #[test]
    fn lines_match_the_header() {
        let all = [4, 16, 64].map(times);
        let run = ["2026-01-02", "abc", "sse2"].map(String::from);
        let text = heading() + &line(&run, &all, &[("generated_16".to_owned(), 321)]);
        let count = |line: &str| line.split(',').count();
        let mut lines = text.lines();
        assert_eq!(lines.next().map(count), lines.next().map(count));
        assert_eq!(column(&text, "generated_to_hand_16"), [0.5]);
        assert_eq!(column(&text, "generated_to_equation_22_64"), [0.25]);
        assert_eq!(column(&text, "instructions_generated_16"), [321.0]);
        assert!(column(&text, "instructions_generated_4")[0].is_nan());
        assert_eq!(column(&text, "hand_to_floor_64"), [4.0]);
        assert_eq!(column(&text, "hand_to_floor_waiting_64"), [1.333]);
    }
}
