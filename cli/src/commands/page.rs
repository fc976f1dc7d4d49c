//! `eomgen page`: an interactive simulation of a model as an HTML page.

use serde_json::json;

use crate::arguments::Page;
use crate::document::SCHEMA;
use crate::error::{Result, print_json, print_text};
use crate::model::{derive, load, orders};
use crate::motion::note_moved;
use crate::operating_point::initial_state;
use crate::output::Destination;
use crate::page::interactive_page;
use crate::settings::with_settings;

pub fn run(options: &Page) -> Result {
    let destination = Destination::for_page(&options.out, options.output.json)?;
    let model = with_settings(load(&options.model.spec)?.model, &options.parameters.set)?;
    let orders = orders(&model, options.model.order.text())?;
    let compiled = derive(model, &orders)?;
    let run = compiled.with_declared_parameters()?;
    let requested = initial_state(&run, &options.initial.state)?;
    // The page projects the state again after a slider was moved.
    let (initial, moved) = run.find_consistent_state(&requested, 0.0, &run.default_inputs())?;
    note_moved("initial state", &moved);
    let page = interactive_page(&compiled, &initial)?;
    destination.write(page.as_bytes())?;
    if options.output.json {
        let document = json!({
            "schema": SCHEMA,
            "model": compiled.program().name,
            "orders": compiled.orders(),
            "file": options.out.display().to_string(),
            "bytes": page.len(),
        });
        return print_json(&document);
    }
    match destination {
        Destination::Stdout => Ok(()),
        _ => print_text(&format!(
            "{}: open it in a browser\n",
            options.out.display()
        )),
    }
}
