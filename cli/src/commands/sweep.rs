//! `eomgen sweep`: measures over a grid or random samples of parameters, in parallel and in shards.

use eomgen_model_spec::model::Model;
use eomgen_sweep::{Folder, Shard, Span, SweepError, SweepRequest};
use serde_json::{Value, json};

use crate::arguments::Sweep;
use crate::count::count;
use crate::document::SCHEMA;
use crate::engines::{self, Submission};
use crate::error::{Error, Result, print_json, print_text, warn};
use crate::model::{load, note_dependent_constraints, order, orders};
use crate::output::file_place;
use crate::progress::Bar;
use crate::settings::settings;
use crate::sweep_files::finish;

pub fn run(options: &Sweep) -> Result {
    engines::check(options)?;
    let shard = options
        .shard
        .as_deref()
        .map_or(Ok(Shard::WHOLE), Shard::parse);
    let shard = shard.map_err(input_error)?;
    let declared = load(&options.model.spec)?.model;
    note_dependent_constraints(&declared, &orders(&declared, options.model.order.text())?)?;
    let sweep = eomgen_sweep::Sweep::new(&declared, request(options, &declared)?)?;
    for warning in &sweep.warnings {
        warn(&format!("warning: {warning}"));
    }
    let measures = sweep.measures().map_err(input_error)?;
    let job = sweep.job(&measures).map_err(input_error)?;
    file_place(&options.out.join("sweep.csv"))?;
    let folder = Folder::open(&options.out, job).map_err(input_error)?;
    if let Some(engine) = options.engine {
        let Submission { document, text } = engines::submit(engine, options)?;
        return end(options, json!({ "schema": SCHEMA }), document, &text);
    }
    let mut bar = None;
    let mut progress = |computed: usize, whole: usize| {
        let bar = bar.get_or_insert_with(|| Bar::new("sweeping", whole as f64, "points"));
        bar.set(computed as f64);
    };
    let threads = options.threads.map_or(0, usize::from);
    let done = eomgen_sweep::run(&folder, &measures, shard, threads, &mut progress)
        .map_err(input_error)?;
    drop(bar);
    let counts = json!({ "schema": SCHEMA, "computed": done.computed_points, "resumed": done.complete_points });
    let summary = format!(
        "{} computed, {} resumed\n",
        count(done.computed_points, "point"),
        done.complete_points
    );
    if !shard.is_whole() {
        let document = json!({ "shard": shard.to_string() });
        let hint = format!(
            "{summary}shard {shard} is complete; when all shards are: eomgen merge {}\n",
            options.out.display()
        );
        return end(options, counts, document, &hint);
    }
    let finished = finish(&folder)?;
    end(
        options,
        counts,
        finished.json(),
        &(summary + &finished.text()),
    )?;
    finished.check()
}

fn input_error(error: SweepError) -> Error {
    Error::input(error.to_string())
}

/// Returns the sweep request that the command line describes.
fn request(options: &Sweep, declared: &Model) -> Result<SweepRequest> {
    Ok(SweepRequest {
        vary: options.vary.clone(),
        samples: options.samples,
        seed: options.seed,
        measures: options.measure.clone(),
        set: settings(declared, &options.parameters.set)?,
        order: order(options.model.order.text())?,
        frequency: options.frequency.clone(),
        span: Span {
            transient: options.transient,
            periods: options.periods,
        },
        until: options.until,
        section: options.section.clone(),
        inputs: options.inputs.input.clone(),
        record: (options.inputs.record.clone())
            .map(|record| (record, options.inputs.record_name.clone())),
        state: options.initial.state.clone(),
    })
}

/// Prints the counts and the document as JSON, or the text.
fn end(options: &Sweep, mut counts: Value, document: Value, text: &str) -> Result {
    if !options.output.json {
        return print_text(text);
    }
    if let (Value::Object(all), Value::Object(more)) = (&mut counts, document) {
        all.extend(more);
    }
    print_json(&counts)
}
