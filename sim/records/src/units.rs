//! Units in a dataset file.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::quantity::StringValue;
use eomgen_model_spec::unit::Unit;

pub fn parse_unit(written: &StringValue, expected: &str) -> Result<Unit, Diagnostic> {
    let wrong = |message: String| Diagnostic::error(message);
    let text = &written.text;
    let unit = Unit::parse(text).map_err(|error| {
        wrong(format!("unit \"{text}\": {error}"))
            .with_span(written.span, format!("expected {expected}"))
            .with_optional_help(error.help)
    })?;
    let wanted = Unit::parse(expected).map_err(|error| wrong(error.to_string()))?;
    if unit.dimension == wanted.dimension {
        return Ok(unit);
    }
    Err(
        wrong(format!("the column is in {text}, expected {expected}")).with_span(
            written.span,
            format!("expected {expected}, or a unit of its dimension"),
        ),
    )
}
