//! Event log of `simulate` as CSV.

use eomgen_compiled_model::{Instance, Motion};

use crate::error::{Error, Result};

/// Encodes the events of a motion. The jump of a rate is 0 if the rate is continuous.
pub fn encode(instance: &Instance<'_>, motion: &Motion) -> Result<Vec<u8>> {
    let failed = |error: &dyn std::fmt::Display| Error::input(format!("cannot write CSV: {error}"));
    let names = instance.model().state_names();
    let degrees = instance.model().program().degrees_of_freedom();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = ["t", "surface", "kind", "from", "to"]
        .map(str::to_owned)
        .into();
    header.extend(names[..degrees].iter().map(|name| format!("jump_{name}")));
    writer
        .write_record(&header)
        .map_err(|error| failed(&error))?;
    for event in motion.event_log(degrees) {
        let [from, to] = match event.modes {
            Some((from, to)) => [from.name(), to.name()],
            None => ["", ""],
        };
        let mut fields: Vec<String> = vec![format!("{:?}", event.t)];
        fields.extend([event.surface, event.kind.name(), from, to].map(str::to_owned));
        let jump = |place: usize| event.jump.get(place).copied().unwrap_or(0.0);
        fields.extend((0..degrees).map(|place| format!("{:?}", jump(place))));
        writer
            .write_record(&fields)
            .map_err(|error| failed(&error))?;
    }
    writer.into_inner().map_err(|error| failed(&error))
}
