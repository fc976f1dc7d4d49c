//! Grid of parameter values, spanned by axes.

use eomgen_model_spec::argument::Argument;
use serde::{Deserialize, Serialize};

use super::error::SweepError;
use eomgen_elementary::Function;

/// Maximum number of points of a grid.
pub const MAX_POINTS: usize = 10_000_000;

/// Spacing of the values of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// Linear spacing.
    #[default]
    Linear,
    /// Logarithmic spacing.
    Log,
}

impl Spacing {
    /// Returns true for the default spacing, which is omitted from plans.
    fn is_linear(&self) -> bool {
        *self == Self::Linear
    }
}

/// Parameters that vary together and take the same values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Names of the parameters.
    pub names: Vec<String>,
    /// First value, in the declared unit of each parameter.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values; if it is 1, the value is `from`.
    pub count: usize,
    /// Spacing of the values.
    #[serde(default, skip_serializing_if = "Spacing::is_linear")]
    pub spacing: Spacing,
}

impl Axis {
    /// Parses `NAME[,NAME...]=FROM:TO:COUNT[:log]`.
    ///
    /// # Errors
    /// The invalid part, with the expected form.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let refused = |reason: String| {
            SweepError::Request(format!(
                "{}: {reason}; expected NAME[,NAME...]=FROM:TO:COUNT or \
                 FROM:TO:COUNT:log, such as b_sp,b_pr=0:100e-6:200",
                Argument::Vary.with_text(text)
            ))
        };
        let (names, range) = text
            .split_once('=')
            .ok_or_else(|| refused("no `=`".to_owned()))?;
        let names: Vec<String> = names
            .split(',')
            .map(|name| name.trim().to_owned())
            .collect();
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let (from, to, count, spacing) = match parts[..] {
            [from, to, count] => (from, to, count, Spacing::Linear),
            [from, to, count, "log"] => (from, to, count, Spacing::Log),
            [_, _, _, other] => return Err(refused(format!("\"{other}\" is not a spacing"))),
            _ => return Err(refused(format!("{} numbers in the range", parts.len()))),
        };
        let number = |part: &str| {
            part.parse::<f64>()
                .map_err(|_| refused(format!("\"{part}\" is not a number")))
        };
        let axis = Self {
            names,
            from: number(from)?,
            to: number(to)?,
            count: count
                .parse()
                .map_err(|_| refused(format!("\"{count}\" is not a whole number")))?,
            spacing,
        };
        axis.check().map_err(refused)?;
        Ok(axis)
    }

    fn check(&self) -> Result<(), String> {
        if self.names.iter().any(String::is_empty) {
            return Err("a name is missing".to_owned());
        }
        if !(self.from.is_finite() && self.to.is_finite()) {
            return Err("the ends of the range must be finite".to_owned());
        }
        if self.count == 0 {
            return Err("the count must be at least 1".to_owned());
        }
        if self.count > MAX_POINTS {
            return Err(format!("the limit is {MAX_POINTS} points"));
        }
        if self.count > 1 && self.from == self.to {
            return Err("the ends of the range are equal, so the count must be 1".to_owned());
        }
        if !((self.to - self.from) * self.count as f64).is_finite() {
            return Err("the range is too wide".to_owned());
        }
        let is_log = self.spacing == Spacing::Log;
        let is_apart_from_zero = self.from != 0.0 && self.to != 0.0;
        if is_log && !(is_apart_from_zero && self.from.signum() == self.to.signum()) {
            return Err(
                "the ends of a logarithmic range must be both positive or both negative".to_owned(),
            );
        }
        if is_log && !(self.to / self.from).is_normal() {
            return Err("the range is too wide".to_owned());
        }
        Ok(())
    }

    /// Returns value `index`, counted from 0. The first and the last value are exact.
    pub fn value(&self, index: usize) -> f64 {
        if index == 0 {
            return self.from;
        }
        if index + 1 >= self.count {
            return self.to;
        }
        let part = index as f64 / (self.count - 1) as f64;
        match self.spacing {
            Spacing::Linear => {
                self.from + (self.to - self.from) * index as f64 / (self.count - 1) as f64
            }
            // The library functions may differ between machines; the project's own functions are bit-identical.
            Spacing::Log => {
                let logarithm = Function::Ln.apply(&[self.to / self.from]);
                self.from * Function::Exp.apply(&[logarithm * part])
            }
        }
    }

    /// Returns all values in order.
    pub fn values(&self) -> Vec<f64> {
        (0..self.count).map(|index| self.value(index)).collect()
    }
}

/// All combinations of the values of some axes. Points count from 0; the last axis varies fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    axes: Vec<Axis>,
    points: usize,
}

impl Grid {
    /// Creates the grid of the axes.
    ///
    /// # Errors
    /// No axis, an invalid or repeated axis, or more than [`MAX_POINTS`] points.
    pub fn new(axes: Vec<Axis>) -> Result<Self, SweepError> {
        let refused = |reason: String| Err(SweepError::Request(reason));
        if axes.is_empty() {
            return refused(format!(
                "nothing is varied: give {}",
                Argument::Vary.with_text("NAME=FROM:TO:COUNT")
            ));
        }
        if let Some(problem) = axes.iter().find_map(|axis| axis.check().err()) {
            return refused(problem);
        }
        let names: Vec<&String> = axes.iter().flat_map(|axis| &axis.names).collect();
        for (place, name) in names.iter().enumerate() {
            if names[..place].contains(name) {
                return refused(format!("`{name}` is varied twice; name it once"));
            }
        }
        let points = axes
            .iter()
            .try_fold(1_usize, |points, axis| points.checked_mul(axis.count))
            .filter(|points| *points <= MAX_POINTS);
        match points {
            Some(points) => Ok(Self { axes, points }),
            None => refused(format!(
                "the grid has more than {MAX_POINTS} points; give smaller counts"
            )),
        }
    }

    /// Returns the axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Returns the varied parameters, in the order of the axes.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.axes
            .iter()
            .flat_map(|axis| axis.names.iter().map(String::as_str))
    }

    /// Returns the parameters' values at a point, in the order of [`Grid::names`].
    pub fn settings(&self, point: usize) -> Vec<(&str, f64)> {
        let mut settings = Vec::new();
        let mut stride = self.points;
        for axis in &self.axes {
            stride /= axis.count;
            let value = axis.value(point / stride % axis.count);
            settings.extend(axis.names.iter().map(|name| (name.as_str(), value)));
        }
        settings
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, Grid};

    fn grid(texts: &[&str]) -> Result<Grid, String> {
        let axes = texts.iter().map(|text| Axis::parse(text));
        let axes = axes
            .collect::<Result<Vec<_>, _>>()
            .map_err(|e| e.to_string())?;
        Grid::new(axes).map_err(|error| error.to_string())
    }

    #[test]
    fn last_axis_varies_fastest_and_names_vary_together() {
        let grid = grid(&["a,b=0:1:3", "c=-5:5:2"]).expect("a grid");
        assert_eq!(grid.points(), 6);
        assert_eq!(grid.names().collect::<Vec<_>>(), ["a", "b", "c"]);
        assert_eq!(grid.settings(0), [("a", 0.0), ("b", 0.0), ("c", -5.0)]);
        assert_eq!(grid.settings(1), [("a", 0.0), ("b", 0.0), ("c", 5.0)]);
        assert_eq!(grid.settings(2), [("a", 0.5), ("b", 0.5), ("c", -5.0)]);
        assert_eq!(grid.settings(5), [("a", 1.0), ("b", 1.0), ("c", 5.0)]);
    }

    #[test]
    fn ends_are_exact_and_single_value_is_first() {
        let axis = Axis::parse("b = 0.1 : 0.7 : 7").expect("an axis");
        let values = axis.values();
        assert_eq!((values[0], values[6], values.len()), (0.1, 0.7, 7));
        assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(Axis::parse("b=3:9:1").expect("an axis").values(), [3.0]);
        assert_eq!(
            Axis::parse("b=1:0:2").expect("an axis").values(),
            [1.0, 0.0]
        );
    }

    #[test]
    fn malformed_ranges_are_rejected_with_expected_form() {
        for (text, part) in [
            ("b", "no `=`"),
            ("b=1:2", "2 numbers"),
            ("b=1:2:3:4", "\"4\" is not a spacing"),
            ("b=1:2:3:log:5", "5 numbers"),
            ("b=0:2:3:log", "both positive"),
            ("b=-1:2:3:log", "both positive"),
            ("b=1e-300:1e300:3:log", "too wide"),
            ("b=x:2:3", "\"x\" is not a number"),
            ("b=0:1:2.5", "\"2.5\" is not a whole number"),
            ("b=0:1:-3", "\"-3\" is not a whole number"),
            ("b=0:1:0", "at least 1"),
            ("b=0:inf:3", "finite"),
            ("b=NaN:1:3", "finite"),
            ("b=-1e308:1e308:3", "too wide"),
            ("b=1:1:3", "equal"),
            ("b=0:1:99999999999", "10000000 points"),
            ("b,=0:1:3", "a name is missing"),
            ("=0:1:3", "a name is missing"),
        ] {
            let error = grid(&[text]).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
            assert!(error.contains("FROM:TO:COUNT"), "{text}: {error}");
        }
    }

    #[test]
    fn too_large_grids_and_repeated_names_are_rejected() {
        let large = grid(&["a=0:1:4000", "b=0:1:4000"]).expect_err("16 million points");
        assert!(large.contains("more than 10000000 points"), "{large}");
        let overflow = ["a=0:1:9000000", "b=0:1:9000000", "c=0:1:9000000"];
        assert!(grid(&overflow).is_err());
        for twice in [vec!["a,a=0:1:2"], vec!["a=0:1:2", "b,a=0:1:2"]] {
            let error = grid(&twice).expect_err("varied twice");
            assert!(error.contains("`a` is varied twice"), "{error}");
        }
        assert!(grid(&[]).is_err());
    }
}
