//! Usual motion at the sites of a model, computed from the records. It sets the scale of shape
//! parameters.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use eomgen_compiled_model::TypicalSizes;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;

use crate::catalogue::effect::ShapeScale;
use crate::catalogue::site::Site;
use crate::interval::Interval;

/// Known motion at the sites of a model.
#[derive(Clone, Debug, Default)]
pub struct UsualMotion {
    /// RMS rate of each axis, by its name, SI.
    pub rates: BTreeMap<String, f64>,
    /// Range of each expression on which an effect can act, by its text, SI.
    pub ranges: BTreeMap<String, Interval>,
    /// Strongest orders, in periods per turn, of the residual force over each angle, by the text of
    /// the angle.
    pub orders: BTreeMap<String, Vec<u32>>,
    /// Typical sizes of quantities of the model.
    pub sizes: TypicalSizes,
}

impl UsualMotion {
    /// Returns the typical size of a quantity in a unit, SI.
    pub(super) fn typical_size(&self, unit: &str) -> f64 {
        let dimension = Unit::parse(unit).map_or(Dimension::DIMENSIONLESS, |unit| unit.dimension);
        self.sizes.typical_size(dimension)
    }

    /// Returns the quantity that scales a shape parameter at a site. If the motion is unknown,
    /// returns the typical size in the given unit.
    pub(super) fn shape_scale(&self, scale: ShapeScale, site: &Site, unit: &str) -> f64 {
        let known = match scale {
            ShapeScale::Rate => self.rates.get(&site.name).copied(),
            ShapeScale::Travel => self
                .travel(site)
                .map(|travel| travel.low.abs().max(travel.high.abs())),
            ShapeScale::PositiveTravel => self.travel(site).map(|travel| travel.high),
            ShapeScale::NegativeTravel => self.travel(site).map(|travel| -travel.low),
        };
        let known = known.filter(|scale| *scale > 0.0);
        known.unwrap_or_else(|| self.typical_size(unit))
    }

    /// Returns true if the motion of an angle covers one period of this order (events per turn), or if its range is
    /// unknown.
    pub(super) fn covers_period(&self, angle: &Site, order: u32) -> bool {
        let covers = |travel: &Interval| f64::from(order) * (travel.high - travel.low) >= TAU;
        self.travel(angle).is_none_or(covers)
    }

    /// Returns the orders of the residual force over an angle.
    pub(super) fn orders(&self, angle: &Site) -> &[u32] {
        let on = angle.arguments.get("on");
        let orders = on.and_then(|on| self.orders.get(on));
        orders.map_or(&[], Vec::as_slice)
    }

    fn travel(&self, site: &Site) -> Option<&Interval> {
        self.ranges.get(site.arguments.get("on")?)
    }
}
