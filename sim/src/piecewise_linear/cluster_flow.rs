//! Motion of a cluster of eigenvalues: exp(centre tau) times a polynomial, and the response to constant and
//! sinusoidal forces, including resonance.

use nalgebra::{Complex, DVector};

use super::event_evaluation::{Local, ROUNDING};
use super::event_function::{monomial, write_monomials};
use super::forced_integrals::{DERIVATIVES, integrals};
use super::regime::Cluster;

/// Coordinates of a cluster at the start of a flow, and the forces on it.
#[derive(Clone, Debug)]
pub(super) struct ClusterFlow {
    zeta: DVector<Complex<f64>>,
    drift: DVector<Complex<f64>>,
    /// Factors of I_k(i omega - centre) and of I_k(-i omega - centre) for each phase.
    sinusoids: Vec<[DVector<Complex<f64>>; 2]>,
}

/// Binomial coefficients up to the fourth derivative.
const BINOMIALS: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

impl ClusterFlow {
    /// Starts at a state, with exp(i theta) of the phases at that time.
    pub fn new(cluster: &Cluster, state: &[f64], inputs: &[f64], phases: &[Complex<f64>]) -> Self {
        let complex = state.iter().map(|y| Complex::new(*y, 0.0));
        let mut drift = cluster.constants[0].clone();
        for (column, input) in cluster.constants[1..].iter().zip(inputs) {
            drift += column * Complex::new(*input, 0.0);
        }
        let sinusoids = cluster.sinusoids.iter().zip(phases);
        Self {
            zeta: &cluster.rows * DVector::from_iterator(state.len(), complex),
            drift,
            // beta sin + gamma cos = ((gamma - i beta) e + (gamma + i beta) / e) / 2.
            sinusoids: sinusoids
                .map(|([beta, gamma], e)| {
                    let turned = beta * Complex::new(0.0, 0.5);
                    let half = gamma * Complex::new(0.5, 0.0);
                    [(&half - &turned) * *e, (half + turned) * e.conj()]
                })
                .collect(),
        }
    }

    /// Returns the exponents of the forces, relative to the centre, with the force vector of each.
    fn exponents<'a>(
        &'a self,
        cluster: &Cluster,
        phases: &[[f64; 2]],
    ) -> Vec<(Complex<f64>, &'a DVector<Complex<f64>>)> {
        let mut all = vec![(-cluster.centre, &self.drift)];
        for (pair, [frequency, _]) in self.sinusoids.iter().zip(phases) {
            all.push((Complex::new(0.0, *frequency) - cluster.centre, &pair[0]));
            all.push((Complex::new(0.0, -frequency) - cluster.centre, &pair[1]));
        }
        all
    }

    /// Adds the cluster's contribution to a function at `tau`, with bounds over the next `ahead` s.
    pub fn add_to(
        &self,
        cluster: &Cluster,
        powers: &[DVector<Complex<f64>>],
        phases: &[[f64; 2]],
        (tau, ahead): (f64, f64),
        local: &mut Local,
    ) {
        let end = tau + ahead;
        let mut inner = [Complex::new(0.0, 0.0); 5];
        let mut bound = [0.0; 5];
        let mut powers_of_tau = vec![0.0; DERIVATIVES + cluster.terms];
        write_monomials(tau, &mut powers_of_tau[DERIVATIVES..]);
        for (k, power) in powers.iter().enumerate() {
            let coefficient = dot(power, &self.zeta);
            for order in 0..5 {
                inner[order] += coefficient * powers_of_tau[DERIVATIVES + k - order];
                bound[order] += coefficient.norm() * monomial(end, k as i32 - order as i32);
            }
        }
        let mut values = vec![Complex::new(0.0, 0.0); DERIVATIVES + cluster.terms];
        for (nu, vector) in self.exponents(cluster, phases) {
            integrals(nu, tau, (nu * tau).exp(), &mut values);
            for (k, power) in powers.iter().enumerate() {
                let factor = dot(power, vector);
                for order in 0..5 {
                    inner[order] += factor * values[DERIVATIVES + k - order];
                    let below = k as i32 - order as i32;
                    let size = match below {
                        0.. => monomial(end, below + 1),
                        _ => nu.norm().powi(-1 - below),
                    };
                    bound[order] += factor.norm() * size;
                }
            }
        }
        add_derivatives(cluster, tau, end, &inner, &bound, local);
        // The contribution at the start follows from the state.
        if let Some(power) = powers.first() {
            local.derivatives[0] -= dot(power, &self.zeta).re;
        }
    }

    /// Adds the displacement of the state by the cluster at `tau`.
    pub fn add_state(&self, cluster: &Cluster, phases: &[[f64; 2]], tau: f64, out: &mut [f64]) {
        let values = self.evaluate(cluster, phases, tau) - &self.zeta;
        for (slot, row) in out.iter_mut().zip(cluster.columns.row_iter()) {
            *slot += row
                .iter()
                .zip(values.iter())
                .map(|(c, v)| (c * v).re)
                .sum::<f64>();
        }
    }

    /// Returns the cluster's coordinates at `tau`.
    fn evaluate(&self, cluster: &Cluster, phases: &[[f64; 2]], tau: f64) -> DVector<Complex<f64>> {
        let exponents = self.exponents(cluster, phases);
        let orders = DERIVATIVES + cluster.terms;
        let integrals: Vec<Vec<Complex<f64>>> = exponents
            .iter()
            .map(|(nu, _)| {
                let mut values = vec![Complex::new(0.0, 0.0); orders];
                integrals(*nu, tau, (nu * tau).exp(), &mut values);
                values
            })
            .collect();
        let mut powers = vec![0.0; cluster.terms];
        write_monomials(tau, &mut powers);
        let mut value = DVector::zeros(self.zeta.len());
        for k in (0..cluster.terms).rev() {
            value = &cluster.matrix * value + &self.zeta * Complex::new(powers[k], 0.0);
            for ((_, vector), values) in exponents.iter().zip(&integrals) {
                value += *vector * values[DERIVATIVES + k];
            }
        }
        value * (cluster.centre * tau).exp()
    }
}

/// Adds the derivatives of exp(centre tau) q(tau), given the derivatives of q and their bounds.
fn add_derivatives(
    cluster: &Cluster,
    tau: f64,
    end: f64,
    inner: &[Complex<f64>; 5],
    bound: &[f64; 5],
    local: &mut Local,
) {
    let decay = (cluster.centre * tau).exp();
    for (order, slot) in local.derivatives.iter_mut().enumerate() {
        let terms = (0..=order)
            .map(|j| inner[j] * cluster.centre.powu((order - j) as u32) * BINOMIALS[order][j]);
        *slot += (decay * terms.sum::<Complex<f64>>()).re;
    }
    let rate = cluster.centre.norm();
    let growth = (cluster.centre.re * end).exp().max(1.0);
    let fourth = (0..5).map(|j| bound[j] * rate.powi(4 - j as i32) * BINOMIALS[4][j]);
    local.fourth += fourth.sum::<f64>() * growth;
    local.noise += ROUNDING * bound[0] * growth;
    local.rate_noise += ROUNDING * (bound[1] + rate * bound[0]) * growth;
}

fn dot(a: &DVector<Complex<f64>>, b: &DVector<Complex<f64>>) -> Complex<f64> {
    a.iter().zip(b.iter()).map(|(a, b)| a * b).sum()
}
