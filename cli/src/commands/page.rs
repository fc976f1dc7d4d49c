//! `eomgen page`: a page on which a model can be played with.

use crate::arguments::Page;
use crate::emission::without_impacts;
use crate::error::Result;
use crate::model::{derive, load, orders};
use crate::output::Destination;
use crate::page::playable;
use crate::settings::stabilised;

/// Runs the command.
pub fn run(options: &Page) -> Result {
    let destination = Destination::of(&options.out, false)?;
    let model = load(&options.spec)?.model;
    without_impacts(&model, "a page")?;
    let model = stabilised(model)?;
    let orders = orders(&model, options.order.as_deref())?;
    let compiled = derive(model, &orders)?;
    destination.write(playable(&compiled)?.as_bytes())?;
    destination.summarise(&format!("open {}\n", options.out.display()))
}
