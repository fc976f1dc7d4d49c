//! Free functions: form of the missing term before it has a physical name. A smoother estimates the
//! motion of the records (`reference_motion`, `smoother`, `transition`), and the model is
//! linearised once along this motion. All responses use the same linear recursion (`segments`,
//! `drives`, `nuisances`); `scene` contains all of these. Laws with a shape parameter are scanned
//! along the motion (`law_scan`). For every direction and every variable a curve is fitted
//! (`curves`, `hat_functions`). Free functions do not accept effects; only the fit of a named law
//! does.

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
