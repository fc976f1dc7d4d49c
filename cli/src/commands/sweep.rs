//! `eomgen sweep`: measures over a grid or random samples of parameters, in parallel and in shards.

use eomgen_sweep::{Folder, Shard};
use serde_json::{Value, json};

use crate::arguments::Sweep;
use crate::document::SCHEMA;
use crate::engines::{self, Submitted};
use crate::error::{Result, say, say_json};
use crate::model::load;
use crate::progress::Bar;
use crate::settings::{borrowed, settings};
use crate::sweep_files::finish;
use crate::sweep_job::{job, measures, model, points, refused};

pub fn run(options: &Sweep) -> Result {
    engines::check(options)?;
    let shard = options
        .shard
        .as_deref()
        .map_or(Ok(Shard::WHOLE), Shard::parse);
    let shard = shard.map_err(refused)?;
    let declared = load(&options.model.spec)?.model;
    let set = settings(&declared, &options.parameters.set)?;
    let set = borrowed(&set);
    let points = points(options, &declared, &set)?;
    let model = model(options, &declared, &points, &set)?;
    let measures = measures(options, &model, &points)?;
    let job = job(&model, &points, &set, &measures)?;
    let folder = Folder::open(&options.out, job).map_err(refused)?;
    if let Some(engine) = options.engine {
        let Submitted { document, text } = engines::submit(engine, options)?;
        return end(options, json!({ "schema": SCHEMA }), document, &text);
    }
    let mut bar = None;
    let mut progress = |computed: usize, whole: usize| {
        let bar = bar.get_or_insert_with(|| Bar::new("sweeping", whole as f64, "points"));
        bar.set(computed as f64);
    };
    let threads = options.threads.map_or(0, usize::from);
    let done =
        eomgen_sweep::run(&folder, &measures, shard, threads, &mut progress).map_err(refused)?;
    drop(bar);
    let counts = json!({ "schema": SCHEMA, "computed": done.computed, "resumed": done.found });
    let summary = format!(
        "{} points computed, {} resumed\n",
        done.computed, done.found
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
        return say(text);
    }
    if let (Value::Object(all), Value::Object(more)) = (&mut counts, document) {
        all.extend(more);
    }
    say_json(&counts)
}
