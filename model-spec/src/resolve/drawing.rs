//! Builds the points and lines of a drawing. `checks` verifies later that the ordinates are
//! lengths.

use super::Builder;
use crate::diagnostic::{Diagnostic, quote};
use crate::ids::{CoordinateId, ObservableId, PointId};
use crate::model::{Drawing, DrawnLine, DrawnPoint, Ordinate};
use crate::quantity::{Quantity, StringValue};
use crate::raw::{Document, RawLine, RawPoint};
use crate::span::Span;
use crate::suggest::did_you_mean;

/// Name of the point (0, 0), which every drawing has.
const ORIGIN: &str = "origin";

struct OrdinateNames<'d> {
    coordinates: Vec<&'d str>,
    observables: Vec<&'d str>,
}

impl OrdinateNames<'_> {
    fn resolve_ordinate(&self, quantity: &Quantity) -> Result<Ordinate, Diagnostic> {
        let written = match quantity {
            Quantity::Number(number) => return Ok(Ordinate::Number(number.value)),
            Quantity::Expression(written) => written,
            Quantity::Vector(..) | Quantity::Expansion(_) => {
                return Err(Diagnostic::error(
                    "the ordinate of a point must be a number or a name",
                )
                .with_span(quantity.span(), ""));
            }
        };
        let place = |names: &[&str]| names.iter().position(|name| *name == written.text);
        if let Some(place) = place(&self.observables) {
            return Ok(Ordinate::Observable(ObservableId::new(place)));
        }
        if let Some(place) = place(&self.coordinates) {
            return Ok(Ordinate::Coordinate(CoordinateId::new(place)));
        }
        let names = self.observables.iter().chain(&self.coordinates).copied();
        let help = "add the expression to [observables] and use its name";
        let message = format!("unknown name {}", quote(&written.text));
        Err(Diagnostic::error(message)
            .with_span(written.span, "neither an observable nor a coordinate")
            .with_help(did_you_mean(&written.text, names).unwrap_or(help.to_owned())))
    }
}

impl Builder {
    pub(super) fn build_drawing(&mut self, document: &Document) -> Option<Drawing> {
        let raw = document.drawing.as_ref()?;
        let coordinates = document.coordinates.iter();
        let observables = document.observables.iter();
        let known = OrdinateNames {
            coordinates: coordinates.map(|c| c.name.text.as_str()).collect(),
            observables: observables.map(|(o, _)| o.name.text.as_str()).collect(),
        };
        let mut points = vec![DrawnPoint {
            name: ORIGIN.to_owned(),
            x: Ordinate::Number(0.0),
            y: Ordinate::Number(0.0),
            spans: [Span::default(); 2],
        }];
        for point in &raw.points {
            points.extend(self.build_point(point, &known));
        }
        let mut names = vec![ORIGIN];
        names.extend(raw.points.iter().map(|point| point.name.text.as_str()));
        let mut lines = Vec::new();
        for line in &raw.lines {
            lines.push(self.build_line(line, &names));
        }
        Some(Drawing { points, lines })
    }

    fn build_point(&mut self, raw: &RawPoint, known: &OrdinateNames<'_>) -> Option<DrawnPoint> {
        if raw.name.text == ORIGIN {
            self.found.push(
                Diagnostic::error(format!("the point `{ORIGIN}` is predefined"))
                    .with_span(raw.name.span, "it is (0, 0)")
                    .with_help("choose another name"),
            );
        }
        let x = self.found.push_error(known.resolve_ordinate(&raw.x));
        let y = self.found.push_error(known.resolve_ordinate(&raw.y));
        Some(DrawnPoint {
            name: raw.name.text.clone(),
            x: x?,
            y: y?,
            spans: [raw.x.span(), raw.y.span()],
        })
    }

    fn build_line(&mut self, raw: &RawLine, names: &[&str]) -> DrawnLine {
        let points = raw.points.iter();
        let points = points.filter_map(|point| self.found.push_error(find_point(point, names)));
        DrawnLine {
            name: raw.name.text.clone(),
            points: points.collect(),
        }
    }
}

fn find_point(written: &StringValue, names: &[&str]) -> Result<PointId, Diagnostic> {
    let place = names.iter().position(|name| *name == written.text);
    place.map(PointId::new).ok_or_else(|| {
        let listed = format!("the points are {}", names.join(", "));
        let near = did_you_mean(&written.text, names.iter().copied());
        Diagnostic::error(format!("unknown point {}", quote(&written.text)))
            .with_span(written.span, "not in [drawing.points]")
            .with_help(near.unwrap_or(listed))
    })
}
