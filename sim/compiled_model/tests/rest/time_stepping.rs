//! Set-valued time stepping without surfaces, regimes and events (J. J. Moreau). The friction impulses of every step
//! stay within their bounds and bring the speeds as near to zero as possible.

/// Dry friction with the sliding speed J v - b and a force up to its level.
pub struct DryFriction<const N: usize> {
    pub along: [f64; N],
    pub drift: f64,
    pub level: f64,
}

/// Machine for the time stepping: M(q) v' = f(t, q, v) + friction.
pub struct Machine<'m, const N: usize> {
    pub inverse_mass: &'m dyn Fn([f64; N]) -> [[f64; N]; N],
    pub forces: &'m dyn Fn(f64, [f64; N], [f64; N]) -> [f64; N],
    pub rubbing: &'m dyn Fn([f64; N], [f64; N]) -> Vec<DryFriction<N>>,
}

impl<const N: usize> Machine<'_, N> {
    /// Returns positions and speeds after a number of steps.
    pub fn simulate_by_time_stepping(
        &self,
        start: ([f64; N], [f64; N]),
        until: f64,
        steps: u32,
    ) -> Vec<f64> {
        let h = until / f64::from(steps);
        let (mut q, mut v) = start;
        let mut impulses: Vec<f64> = Vec::new();
        for step in 0..steps {
            let middle: [f64; N] = std::array::from_fn(|i| q[i] + 0.5 * h * v[i]);
            let t = (f64::from(step) + 0.5) * h;
            let yields = (self.inverse_mass)(middle);
            let mut next = v;
            for _ in 0..2 {
                let mean: [f64; N] = std::array::from_fn(|i| 0.5 * (v[i] + next[i]));
                let forces = (self.forces)(t, middle, mean);
                let rubbing = (self.rubbing)(middle, v);
                impulses.resize(rubbing.len(), 0.0);
                let times = |force: [f64; N]| -> [f64; N] {
                    std::array::from_fn(|i| (0..N).map(|j| yields[i][j] * force[j]).sum())
                };
                let moved = times(forces);
                next = std::array::from_fn(|i| v[i] + h * moved[i]);
                for (rub, impulse) in rubbing.iter().zip(&impulses) {
                    let moved = times(rub.along);
                    next = std::array::from_fn(|i| next[i] + moved[i] * impulse);
                }
                for _ in 0..200 {
                    let mut changed = 0.0_f64;
                    for (rub, impulse) in rubbing.iter().zip(&mut impulses) {
                        let moved = times(rub.along);
                        let dot = |b: [f64; N]| (0..N).map(|i| rub.along[i] * b[i]).sum::<f64>();
                        let wanted = *impulse - (dot(next) - rub.drift) / dot(moved);
                        let wanted = wanted.clamp(-rub.level * h, rub.level * h);
                        next = std::array::from_fn(|i| next[i] + moved[i] * (wanted - *impulse));
                        changed = changed.max((wanted - *impulse).abs() / (rub.level * h));
                        *impulse = wanted;
                    }
                    if changed < 1e-13 {
                        break;
                    }
                }
            }
            for i in 0..N {
                q[i] += 0.5 * h * (v[i] + next[i]);
            }
            v = next;
        }
        [q, v].concat()
    }

    /// Asserts that the time stepping converges to the `wanted` state with order one.
    pub fn assert_converges_to(
        &self,
        start: ([f64; N], [f64; N]),
        until: f64,
        wanted: &[f64],
        step: f64,
    ) {
        let difference = |steps: u32| {
            let found = self.simulate_by_time_stepping(start, until, steps);
            let pairs = found.iter().zip(wanted);
            pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()))
        };
        let coarse = (until / step) as u32;
        let (before, after) = (difference(coarse), difference(8 * coarse));
        println!("{before:.2e} {after:.2e}");
        assert!(after < 2e-4, "{before:e} {after:e}");
        assert!(after < 0.3 * before || after < 1e-7, "{before:e} {after:e}");
    }
}
