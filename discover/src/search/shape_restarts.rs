//! Shapes, such as the speed at which friction has fallen, tried at other sizes: a fit that began at
//! the usual one may end in a minimum of its own.

use crate::search::fitted::{Round, Trial, at_floor};
use crate::search::hypothesis::Set;
use crate::search::selected::leaves_clearly_less;

/// How many times the usual size a shape is then.
const OTHER_SHAPES: [f64; 2] = [0.4, 2.5];

impl Round<'_> {
    /// Fits what has a shape, helps and does not reach the floor from other shapes, and takes over
    /// what is believed, or leaves less.
    pub(crate) fn reshape(&self, trials: &mut [Trial]) {
        let is_there =
            |trial: &Trial| trial.verdict.is_ok() && at_floor(&trial.fit, self.task.floor);
        if trials.iter().any(is_there) {
            return;
        }
        let wanted = trials.iter_mut().filter(|trial| {
            let has_shape = trial.own.iter().any(|own| own.is_shape);
            has_shape && leaves_clearly_less(&trial.fit, self.task.fit)
        });
        for trial in wanted {
            let sizes = trial.responses.iter();
            let sizes = sizes.flat_map(|r| self.screen.responses[*r].values.clone());
            let set = Set {
                responses: trial.responses.clone(),
                deleted: None,
                sizes: sizes.collect(),
            };
            let sketches = OTHER_SHAPES
                .iter()
                .filter_map(|times| Some((set.clone(), self.shaped_as(&set, *times).ok()?)));
            let found = self.completed(sketches.collect());
            for other in found {
                if is_better(&other, trial) {
                    *trial = other;
                }
            }
        }
    }
}

/// Whether a trial is believed where another is not, or else leaves less.
fn is_better(one: &Trial, other: &Trial) -> bool {
    match (one.verdict.is_ok(), other.verdict.is_ok()) {
        (true, false) => true,
        (false, true) => false,
        _ => one.fit.left() < other.fit.left(),
    }
}
