//! `eomgen compare` and `eomgen discover`.

use std::path::Path;

use serde_json::Value;

use crate::arguments;
use crate::discovery::{self, Task};
use crate::error::{Result, print_json, print_text};

pub fn compare(options: &arguments::Compare) -> Result {
    let task = Task {
        spec: &options.model.spec,
        order: options.model.order.text(),
        dataset: &options.dataset,
        out: &options.out,
        seed: options.noise.seed,
    };
    print(
        options.output.json,
        &discovery::compare(&task)?,
        &options.out,
    )
}

pub fn discover(options: &arguments::Discover) -> Result {
    let task = Task {
        spec: &options.model.spec,
        order: options.model.order.text(),
        dataset: &options.dataset,
        out: &options.out,
        seed: options.noise.seed,
    };
    let found = discovery::discover(&task, options.limit, options.effects.as_deref())?;
    print(options.output.json, &found, &options.out)
}

/// Prints the verdict, the effects and the residual of each channel.
fn print(as_json: bool, result: &Value, out: &Path) -> Result {
    if as_json {
        return print_json(result);
    }
    let mut text = format!(
        "{}: {}\n",
        out.display(),
        result["verdict"].as_str().unwrap_or("")
    );
    text += &format!("  {}\n", result["summary"].as_str().unwrap_or(""));
    // Without a named effect, the location of the residual is the main result.
    if ["gap_found", "unexplained"].contains(&result["verdict"].as_str().unwrap_or("")) {
        text += &format!("  {}\n", result["where"].as_str().unwrap_or(""));
    }
    for effect in result["effects"].as_array().into_iter().flatten() {
        let word = |key: &str| effect[key].as_str().unwrap_or("").to_owned();
        text += &format!(
            "  {} on {}, {}\n",
            word("effect"),
            word("on"),
            word("status")
        );
        for size in effect["conditional"].as_array().into_iter().flatten() {
            text += &format!("    {}\n", size["text"].as_str().unwrap_or(""));
        }
        if let Some(proposal) = effect["next_experiment"]["text"].as_str() {
            text += &format!("    {proposal}\n");
        }
    }
    for (name, gap) in result["gap"].as_object().into_iter().flatten() {
        let number = |value: &Value| {
            value
                .as_f64()
                .map_or_else(|| "-".to_owned(), |v| format!("{v:.3e}"))
        };
        let test = gap.get("after").map_or_else(
            || format!("test {}", number(&gap["test"])),
            |after| {
                format!(
                    "test {} -> {}",
                    number(&gap["before"]["test"]),
                    number(&after["test"])
                )
            },
        );
        text += &format!(
            "  {name}: {test} {}, floor {}\n",
            gap["unit"].as_str().unwrap_or(""),
            number(&gap["floor"])
        );
    }
    print_text(&text)
}
