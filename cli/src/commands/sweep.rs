//! `eomgen sweep`: measures over a grid or random samples of parameters, in parallel and in shards.

use eomgen_sweep::{Folder, Shard};
use serde_json::{Value, json};

use crate::arguments::Sweep;
use crate::count::count;
use crate::document::SCHEMA;
use crate::engines::{self, Submission};
use crate::error::{Result, print_json, print_text};
use crate::model::load;
use crate::progress::Bar;
use crate::settings::{as_borrowed, settings};
use crate::sweep_files::finish;
use crate::sweep_job::{input_error, job, measures, model, points};

pub fn run(options: &Sweep) -> Result {
    engines::check(options)?;
    let shard = options
        .shard
        .as_deref()
        .map_or(Ok(Shard::WHOLE), Shard::parse);
    let shard = shard.map_err(input_error)?;
    let declared = load(&options.model.spec)?.model;
    let set = settings(&declared, &options.parameters.set)?;
    let set = as_borrowed(&set);
    let points = points(options, &declared, &set)?;
    let model = model(options, &declared, &points, &set)?;
    let measures = measures(options, &model, &points)?;
    let job = job(&model, &points, &set, &measures)?;
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
    )
}

/// Prints the result.
fn end(options: &Sweep, mut counts: Value, document: Value, text: &str) -> Result {
    if !options.output.json {
        return print_text(text);
    }
    if let (Value::Object(all), Value::Object(more)) = (&mut counts, document) {
        all.extend(more);
    }
    print_json(&counts)
}
