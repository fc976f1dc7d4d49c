//! Units in a dataset file.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::table::Written;
use eomgen_model_spec::unit::Unit;

pub fn parse_unit(written: &Written, expected: &str) -> Result<Unit, Diagnostic> {
    let wrong = |message: String| Diagnostic::error(message);
    let text = &written.text;
    let unit = Unit::parse(text).map_err(|error| {
        wrong(format!("unit \"{text}\": {error}"))
            .at(written.span, format!("expected {expected}"))
            .help_if(error.help)
    })?;
    let wanted = Unit::parse(expected).map_err(|error| wrong(error.to_string()))?;
    if unit.dimension == wanted.dimension {
        return Ok(unit);
    }
    Err(
        wrong(format!("the column is in {text}, expected {expected}")).at(
            written.span,
            format!("expected {expected}, or a unit of its dimension"),
        ),
    )
}
