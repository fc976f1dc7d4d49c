//! Estimation from far away: for every trial of the unknowns the initial states are followed anew
//! through the records, because those that were fitted at wrong unknowns hold on to what impacts
//! folded. Once that is near, [`crate::fit::gauss_newton`] goes on.

use nalgebra::DVector;

use crate::fit::gauss_newton::{
    Estimate, PARTS, StartPrior, change_of_unknowns, eliminated, evaluated, level, moved_unknowns,
};
use crate::fit::sensitivity::Linear;
use crate::fit::shooting::{Residual, Shooting};
use crate::thresholds;

/// A step that lowers the cost by less than this part is the last: it costs much.
const WORTH_A_STEP: f64 = 0.02;

/// Where tangents lead nowhere, the most steps by secants.
const SECANT_STEPS: usize = 6;

/// A secant's change of an unknown is this part of its scale at first, and then what moves the
/// outputs by this part of what is left, within a factor.
const SECANT: f64 = 0.1;
const MOVED: f64 = 0.3;
const NEAR_MOVED: f64 = 3.0;

/// How initial states are found at given unknowns, from those at others if they are known:
/// what is known before, and the states.
pub type Follow<'f> = dyn Fn(&[f64], Option<&[Vec<f64>]>) -> (StartPrior, Vec<Vec<f64>>) + 'f;

/// Where an approach ended.
#[derive(Default)]
pub struct Approached {
    /// What is known of the windows' initial states.
    pub prior: StartPrior,
    /// The estimate.
    pub estimate: Estimate,
    /// Whether further steps would help little.
    pub is_there: bool,
}

/// Which derivatives by the unknowns a step goes by.
#[derive(Clone, Copy, PartialEq)]
enum By {
    /// Those of the motion. Impacts make them grow without bound, and right for next to nothing.
    Tangents,
    /// Differences of motions that are followed anew, for what has no prior.
    Secants,
}

/// Windows and how they are followed.
struct Way<'a> {
    shooting: &'a Shooting<'a>,
    follow: &'a Follow<'a>,
    /// By how much each unknown is changed for a secant.
    sizes: Vec<f64>,
}

/// Approaches the best unknowns from the best of some, by so many steps.
pub fn approach(
    shooting: &Shooting<'_>,
    begins: &[Vec<f64>],
    follow: &Follow<'_>,
    steps: usize,
) -> Approached {
    let mut way = Way::new(shooting, follow);
    let tried = begins.iter().map(|theta| way.at(theta.clone(), None));
    let best = tried.min_by(|a, b| a.estimate.cost.total_cmp(&b.estimate.cost));
    let mut present = best.unwrap_or_default();
    way.go(&mut present, steps, By::Tangents);
    present
}

/// Goes on where tangents lead nowhere though much more than noise is left.
pub fn approach_by_secants(shooting: &Shooting<'_>, present: &mut Approached, follow: &Follow<'_>) {
    Way::new(shooting, follow).go(present, SECANT_STEPS, By::Secants);
}

/// Derivatives at an estimate with secants in the place of tangents for what has no prior.
pub fn secants(
    shooting: &Shooting<'_>,
    estimate: &Estimate,
    mut tangents: Vec<Option<Linear>>,
    follow: &Follow<'_>,
) -> Vec<Option<Linear>> {
    Way::new(shooting, follow).take_secants(estimate, &mut tangents);
    tangents
}

impl<'a> Way<'a> {
    fn new(shooting: &'a Shooting<'a>, follow: &'a Follow<'a>) -> Self {
        let sizes = shooting.unknowns.iter();
        Self {
            shooting,
            follow,
            sizes: sizes.map(|unknown| SECANT * unknown.scale).collect(),
        }
    }

    /// The estimate at these unknowns.
    fn at(&self, theta: Vec<f64>, before: Option<&[Vec<f64>]>) -> Approached {
        let (prior, starts) = (self.follow)(&theta, before);
        let estimate = evaluated(self.shooting, &prior, theta, starts);
        Approached {
            prior,
            estimate,
            is_there: false,
        }
    }

    /// How many noises are left.
    fn left(&self, present: &Estimate) -> f64 {
        let count = self.shooting.part * self.shooting.windows.numbers();
        (present.squares.iter().sum::<f64>() / count).sqrt()
    }

    /// So many steps at most, while they are worth it.
    fn go(&mut self, present: &mut Approached, steps: usize, by: By) {
        for _ in 0..steps {
            if by == By::Secants && self.left(&present.estimate) < thresholds::AT_FLOOR {
                return;
            }
            let before = present.estimate.cost;
            let Some(next) = self.step(present, by) else {
                present.is_there = true;
                return;
            };
            *present = next;
            present.is_there = before - present.estimate.cost < WORTH_A_STEP * before;
            if present.is_there {
                return;
            }
        }
    }

    /// The next estimate, if there is one that is better.
    fn step(&mut self, present: &Approached, by: By) -> Option<Approached> {
        let Approached {
            prior, estimate, ..
        } = present;
        let level = level(self.shooting, estimate);
        let mut linear = self
            .shooting
            .linear(&estimate.theta, &estimate.starts, level);
        if by == By::Secants && !self.take_secants(estimate, &mut linear) {
            return None;
        }
        let windows = eliminated(prior, estimate, &linear);
        let change = change_of_unknowns(self.shooting, estimate, &windows, 0.0);
        PARTS.iter().find_map(|part| {
            let theta = moved_unknowns(self.shooting, estimate, &change, *part);
            let next = self.at(theta, Some(&estimate.starts));
            (next.estimate.cost < estimate.cost).then_some(next)
        })
    }

    /// Puts secants in the place of tangents; false if there is nothing to be changed.
    fn take_secants(&mut self, estimate: &Estimate, linear: &mut [Option<Linear>]) -> bool {
        let wanted = MOVED * self.left(estimate);
        let mut taken = false;
        for (place, unknown) in self.shooting.unknowns.iter().enumerate() {
            if unknown.prior.is_some() || unknown.bounds.0 == unknown.bounds.1 {
                continue;
            }
            let mut secant = self.secant(estimate, linear, (place, self.sizes[place]));
            let moved = secant.moved();
            if moved > 0.0 && !(wanted / NEAR_MOVED..wanted * NEAR_MOVED).contains(&moved) {
                self.sizes[place] = secant.size * wanted / moved;
                secant = self.secant(estimate, linear, (place, self.sizes[place]));
            }
            for (linear, change) in linear.iter_mut().zip(&secant.changes) {
                if let (Some(linear), Some(change)) = (linear, change) {
                    let column = change / secant.size;
                    linear.by_unknown.set_column(place, &column);
                    taken = true;
                }
            }
        }
        taken
    }

    /// What a change of an unknown, about so large, does to each window's residuals.
    fn secant(
        &self,
        estimate: &Estimate,
        linear: &[Option<Linear>],
        (place, size): (usize, f64),
    ) -> Secant {
        let unknown = &self.shooting.unknowns[place];
        let value = estimate.theta[place];
        let mut theta = estimate.theta.clone();
        let ends = [value + size, value - size].map(|end| unknown.admissible(end));
        theta[place] = ends.into_iter().find(|end| *end != value).unwrap_or(value);
        let size = theta[place] - value;
        let (_, starts) = (self.follow)(&theta, Some(&estimate.starts));
        let residuals = self.shooting.residuals(&theta, &starts);
        let of = |(residual, linear): (Option<Residual>, &Option<Linear>)| {
            let (residual, linear) = (residual?, linear.as_ref()?);
            let change = DVector::from_vec(residual.values) - &linear.residual;
            (size != 0.0 && change.iter().all(|c| c.is_finite())).then_some(change)
        };
        let changes = residuals.into_iter().zip(linear).map(of).collect();
        Secant { size, changes }
    }
}

/// What a change of an unknown did.
struct Secant {
    /// The change.
    size: f64,
    /// Each window's residuals after less those before, in noises; none where either is missing.
    changes: Vec<Option<DVector<f64>>>,
}

impl Secant {
    /// The root mean square of all, in noises.
    fn moved(&self) -> f64 {
        let all = || self.changes.iter().flatten();
        let count: usize = all().map(DVector::len).sum();
        (all().map(DVector::norm_squared).sum::<f64>() / count.max(1) as f64).sqrt()
    }
}
