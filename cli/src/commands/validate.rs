//! `eomgen validate`: the certificate of a variant.

use eomgen_validate::certificate::Certificate;
use eomgen_validate::model_certificate::certify_model;

use crate::arguments::{Extra, Validate};
use crate::bounds::bounds;
use crate::certification::{document, summary};
use crate::error::{Error, Result, print_bytes, print_text};
use crate::model::{load, note_dependent_constraints, orders};
use crate::output::Destination;
use crate::progress::Note;
use crate::settings::with_settings;

pub fn run(options: &Validate) -> Result {
    let out = options.out.as_deref();
    let destination = out
        .map(|path| Destination::for_output(path, options.output.json))
        .transpose()?;
    let model = load(&options.model.spec)?.model;
    let model = with_settings(model, &options.parameters.set)?;
    let orders = orders(&model, options.model.order.text())?;
    note_dependent_constraints(&model, &orders)?;
    let outputs = Extra::select_outputs(&options.with);
    let bounds = match options.bounds {
        true => Some(bounds(&model, &orders, &outputs, options)?),
        false => None,
    };
    let certificate = {
        let _note = Note::new(format!("validating {}", model.name));
        let certificate = certify_model(&model, &orders, &outputs)?;
        Certificate {
            bounds,
            ..certificate
        }
    };
    let text = document(&certificate)?;
    if let Some(destination) = &destination {
        destination.write(text.as_bytes())?;
    }
    match destination {
        _ if options.output.json => print_bytes(text.as_bytes())?,
        Some(destination) => destination.summarise(&summary(&certificate))?,
        None => print_text(&summary(&certificate))?,
    }
    if certificate.passed {
        Ok(())
    } else {
        Err(Error::Failed)
    }
}
