//! Free functions: what the model lacks, before it has a name. A smoother follows the records
//! (`reference_motion` with `smoother` and `transition`), the model is linearised once along that
//! motion, and all responses go through the same linear recursion (`segments`, `drives`,
//! `nuisances`). All of it is a `scene`. Laws with a shape are scanned over decades along the
//! motion (`law_scan`); for every direction of force and every variable a curve is fitted
//! (`curves` of `hat_functions`). Nothing here is accepted: the fit of a named law decides.

pub mod curves;
pub(crate) mod drives;
mod hat_functions;
pub mod law_scan;
pub(crate) mod nuisances;
pub(crate) mod reference_motion;
pub(crate) mod scene;
pub(crate) mod segments;
mod smoother;
mod transition;
