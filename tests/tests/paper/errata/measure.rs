//! Computes the coefficients of a right-hand side from its values at chosen states.
//!
//! In a regime of the meshes the accelerations are linear in the state. Half the difference between the accelerations
//! at a state and at its negative is a column of coefficients without the constant terms.

use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Derived right-hand side of the arm: accelerations of x_sp, x_pr, x_c, q_1 .. q_S (m/s^2) at
/// (parameters, order, t, state). The state has the coordinates in m, then their rates in m/s.
pub type DerivedModel<'a> = dyn Fn(&PlanetaryArmParameters, usize, f64, &[f64]) -> Vec<f64> + 'a;

/// Compression of a mesh beyond its dead band, in m. At this compression the spring force is comparable with the
/// damping force at 1 m/s.
const PROBE_COMPRESSION_M: f64 = 1e-6;

/// Derivatives of all accelerations by one quantity.
#[derive(Clone, Debug)]
pub struct Response(Vec<f64>);

impl Response {
    /// Returns the entry for coordinate `row`, or NaN if the derived model returned too few
    /// accelerations.
    pub fn entry(&self, row: usize) -> f64 {
        self.0.get(row).copied().unwrap_or(f64::NAN)
    }

    fn subtract(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a - b).collect())
    }
}

/// Responses of the derived model at one order.
#[derive(Clone, Debug)]
pub struct Responses {
    /// Accelerations at rest with open meshes at t = 0.
    pub constant: Response,
    /// Change of `constant` after a quarter of the motor's period.
    pub fluctuation: Response,
    /// Response to x_sp', x_pr', x_c' with both meshes open, 1/s.
    pub rate: [Response; 3],
    /// Response to f_k(x_sp) and f_k(x_pr), 1/s^2.
    pub spring: [Response; 2],
    /// Response to f_c(x_sp) and f_c(x_pr), 1/s.
    pub damping: [Response; 2],
    /// Response to q_1 .. q_S with both meshes open, 1/s^2.
    pub modes: Vec<Response>,
    /// Response to x_sp with both meshes open, 1/s^2.
    pub inside_dead_band: Response,
}

impl Responses {
    /// Computes the responses of `derived` at `order`.
    pub fn measure(
        derived: &DerivedModel<'_>,
        parameters: &PlanetaryArmParameters,
        order: usize,
    ) -> Self {
        let probe = Probe {
            derived,
            parameters,
            order,
        };
        let rate = |coordinate| probe.slope(&[(probe.rate_of(coordinate), 1.0)], 1.0, &[]);
        let pressed = [
            parameters.b_sp + PROBE_COMPRESSION_M,
            parameters.b_pr + PROBE_COMPRESSION_M,
        ];
        let quarter = std::f64::consts::FRAC_PI_2 / parameters.omega;
        let constant = probe.accelerations_at(0.0, &[]);
        Self {
            fluctuation: probe.accelerations_at(quarter, &[]).subtract(&constant),
            constant,
            rate: [0, 1, 2].map(rate),
            spring: [0, 1]
                .map(|mesh| probe.slope(&[(mesh, pressed[mesh])], PROBE_COMPRESSION_M, &[])),
            damping: [0, 1].map(|mesh| {
                let moving = [(probe.rate_of(mesh), 1.0)];
                probe
                    .slope(&moving, 1.0, &[(mesh, pressed[mesh])])
                    .subtract(&rate(mesh))
            }),
            modes: (0..order)
                .map(|i| probe.slope(&[(3 + i, 1e-3)], 1e-3, &[]))
                .collect(),
            inside_dead_band: {
                let inside = 0.5 * parameters.b_sp;
                probe.slope(&[(0, inside)], inside, &[])
            },
        }
    }
}

/// Evaluation of the derived model at states given by their nonzero entries.
struct Probe<'a> {
    derived: &'a DerivedModel<'a>,
    parameters: &'a PlanetaryArmParameters,
    order: usize,
}

impl Probe<'_> {
    fn rate_of(&self, coordinate: usize) -> usize {
        3 + self.order + coordinate
    }

    fn accelerations_at(&self, t: f64, entries: &[(usize, f64)]) -> Response {
        let mut state = vec![0.0; 2 * (3 + self.order)];
        for (index, value) in entries {
            state[*index] = *value;
        }
        Response((self.derived)(self.parameters, self.order, t, &state))
    }

    /// Computes half the difference of the accelerations between `entries` and their negatives, divided by `unit`. The
    /// entries `held` have the same sign in both states.
    fn slope(&self, entries: &[(usize, f64)], unit: f64, held: &[(usize, f64)]) -> Response {
        let with = |sign: f64| {
            let signed = entries.iter().map(|(index, value)| (*index, sign * value));
            self.accelerations_at(0.0, &signed.chain(held.iter().copied()).collect::<Vec<_>>())
        };
        let difference = with(1.0).subtract(&with(-1.0));
        Response(
            difference
                .0
                .iter()
                .map(|value| value / (2.0 * unit))
                .collect(),
        )
    }
}
