use super::*;
use crate::random_numbers::Numbers;

/// Returns random contacts of a body or machine with this number of degrees of freedom.
fn random_problem(seed: u64, count: usize, degrees: usize, most: f64) -> ContactProblem {
    let mut numbers = Numbers::new(seed);
    let rows: Vec<Vec<f64>> = (0..2 * count)
        .map(|_| (0..degrees).map(|_| numbers.draw()).collect())
        .collect();
    let motion: Vec<f64> = (0..degrees).map(|_| numbers.draw()).collect();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let w: Vec<f64> = rows
        .iter()
        .flat_map(|row| rows.iter().map(|other| product(row, other)))
        .collect();
    let c: Vec<f64> = rows.iter().map(|row| product(row, &motion)).collect();
    let friction = (0..count).map(|_| ContactFriction {
        coefficient: most * (0.5 + 0.5 * numbers.draw()),
        direction: None,
    });
    ContactProblem::new(friction.collect(), &w, &c)
}

/// Returns the scaled rates of all consistent cases.
fn enumerate(problem: &ContactProblem) -> Vec<Vec<f64>> {
    let count: usize = problem
        .friction
        .iter()
        .map(|one| one.modes().len())
        .product();
    let cases = (0..count).filter_map(|case| problem.solution(&problem.modes_of_case(case)));
    let scaled = |found: ContactDecision| -> Vec<f64> {
        let pairs = found.impulses.iter().zip(&problem.scale);
        problem.rates(&pairs.map(|(p, scale)| p * scale).collect::<Vec<f64>>())
    };
    cases.map(scaled).collect()
}

#[test]
fn lemke_agrees_with_enumeration_on_random_problems() {
    let mut rays = 0;
    for seed in 1..=500 {
        let count = 1 + (seed % 3) as usize;
        let degrees = 2 * count + (seed / 3 % 3) as usize;
        let problem = random_problem(seed, count, degrees, 0.6);
        let known = enumerate(&problem);
        assert!(!known.is_empty(), "{seed}: no consistent modes");
        let Some(modes) = problem.find_modes_by_lemke() else {
            rays += 1;
            continue;
        };
        let found = problem.solution(&modes);
        let found = found.unwrap_or_else(|| panic!("{seed}: {modes:?} violate a condition"));
        let pairs = found.impulses.iter().zip(&problem.scale);
        let rates = problem.rates(&pairs.map(|(p, scale)| p * scale).collect::<Vec<f64>>());
        let is_known = known.iter().any(|known| {
            let mut pairs = known.iter().zip(&rates);
            pairs.all(|(a, b)| (a - b).abs() < 1e-8)
        });
        assert!(is_known, "{seed}: {rates:?} is not among {known:?}");
    }
    assert_eq!(rays, 0);
}

#[test]
fn many_contacts_are_decided_by_lemke() {
    for seed in 1..=100 {
        let count = 5 + (seed % 4) as usize;
        let problem = random_problem(seed, count, 2 * count, 0.5);
        assert!(problem.decide(None, &[]).is_some(), "{seed}: no solution");
    }
}

#[test]
fn plastic_impacts_gain_no_energy() {
    for seed in 1..=500 {
        let count = 1 + (seed % 3) as usize;
        let problem = random_problem(seed, count, 2 * count, 2.0);
        let found = problem.decide(None, &[]).expect("a solution");
        let pairs = found.impulses.iter().zip(&problem.scale);
        let impulses: Vec<f64> = pairs.map(|(p, scale)| p * scale).collect();
        let (before, after) = (&problem.c, problem.rates(&impulses));
        let sums = before.iter().zip(&after).map(|(a, b)| 0.5 * (a + b));
        let gained: f64 = sums.zip(&impulses).map(|(sum, p)| sum * p).sum();
        assert!(gained <= 1e-9, "{seed}: {gained:e}");
    }
}

#[test]
fn previous_modes_are_kept_and_excluded_modes_are_not() {
    // Friction on a slope at its limit: both sticking and sliding are consistent.
    let friction = ContactFriction {
        coefficient: 0.5,
        direction: None,
    };
    let problem = ContactProblem::new(vec![friction], &[1.0, 0.0, 0.0, 1.0], &[-1.0, 0.5]);
    for mode in [ContactMode::Sticks, ContactMode::Slides(1.0)] {
        let kept = problem.decide(Some(&[mode]), &[]).expect("a solution");
        assert_eq!(kept.modes, [mode]);
        let other = problem.decide(Some(&[mode]), &[(0, mode)]);
        assert_ne!(other.expect("a solution").modes, [mode]);
    }
}

#[test]
fn painleve_rod_has_no_solution() {
    // Sliding rod at 60 degrees, mu = 1.5: W_nn - mu W_nt < 0.
    let angle = 60_f64.to_radians();
    let (s, c) = angle.sin_cos();
    let w = [
        1.0 + 3.0 * c * c,
        3.0 * s * c,
        3.0 * s * c,
        1.0 + 3.0 * s * s,
    ];
    for (mu, is_solved) in [(1.2, true), (1.5, false)] {
        let friction = ContactFriction {
            coefficient: mu,
            direction: Some(1.0),
        };
        let problem = ContactProblem::new(vec![friction], &w, &[-9.81, 0.0]);
        assert_eq!(problem.decide(None, &[]).is_some(), is_solved, "{mu}");
    }
}

#[test]
fn single_impact_follows_the_closed_forms_of_a_ball() {
    // A ball of radius 1 and mass 1: the slip has the mobility 1 + 5/2.
    let w = [[1.0, 0.0], [0.0, 3.5]];
    let (mu, e, v) = (0.2, 0.7, 3.0);
    for slip in [5.0, -5.0, 1.0] {
        let impact = SingleImpact {
            w,
            rates: [-v, slip],
            friction: mu,
            restitution: e,
        };
        let [normal, tangential] = energetic_impulse(&impact).expect("impulses");
        let sliding = mu * (1.0 + e) * v;
        let rolling = 2.0 / 7.0 * slip.abs();
        assert!((normal - (1.0 + e) * v).abs() < 1e-14);
        let expected = -slip.signum() * sliding.min(rolling);
        assert!(
            (tangential - expected).abs() < 1e-14,
            "{slip}: {tangential}"
        );
    }
}

/// Integrates the rates over the normal impulse in small steps, and returns the tangential impulse and the works of the
/// normal impulse in compression and in restitution.
fn integrate_works(impact: &SingleImpact, normal_impulse: f64) -> (f64, [f64; 2]) {
    const STEPS: usize = 100_000;
    let w = &impact.w;
    let length = normal_impulse / STEPS as f64;
    let [mut normal_rate, mut slip] = impact.rates;
    let (mut tangential_impulse, mut works) = (0.0, [0.0; 2]);
    for _ in 0..STEPS {
        // Tangential impulse that stops the slip in this step, within the friction cone.
        let limit = impact.friction * length;
        let tangential = (-(slip + w[1][0] * length) / w[1][1]).clamp(-limit, limit);
        let change = w[0][0] * length + w[0][1] * tangential;
        let mean = normal_rate + 0.5 * change;
        works[usize::from(mean > 0.0)] += mean * length;
        normal_rate += change;
        slip += w[1][0] * length + w[1][1] * tangential;
        tangential_impulse += tangential;
    }
    (tangential_impulse, works)
}

#[test]
fn single_impacts_lose_energy_and_obey_the_ratio_of_works() {
    let mut numbers = Numbers::new(7);
    for case in 0..1000 {
        let rows: Vec<[f64; 3]> = (0..2).map(|_| [0; 3].map(|_| numbers.draw())).collect();
        let product = |a: usize, b: usize| (0..3).map(|k| rows[a][k] * rows[b][k]).sum::<f64>();
        let w = [
            [product(0, 0), product(0, 1)],
            [product(1, 0), product(1, 1)],
        ];
        let impact = SingleImpact {
            w,
            rates: [-numbers.draw().abs(), numbers.draw()],
            friction: 1.0 + numbers.draw(),
            restitution: 0.5 + 0.5 * numbers.draw(),
        };
        let p = energetic_impulse(&impact).expect("impulses");
        let after = [0, 1].map(|i| impact.rates[i] + w[i][0] * p[0] + w[i][1] * p[1]);
        let gained: f64 = (0..2)
            .map(|i| 0.5 * p[i] * (impact.rates[i] + after[i]))
            .sum();
        assert!(gained <= 1e-12, "{case}: {gained:e}");
        assert!(after[0] >= -1e-12, "{case}: {after:?}");
        assert!(
            p[1].abs() <= impact.friction * p[0] + 1e-12,
            "{case}: {p:?}"
        );
        if case % 20 == 0 {
            let (tangential, [compression, restitution]) = integrate_works(&impact, p[0]);
            let expected = -impact.restitution.powi(2) * compression;
            let size = compression.abs();
            assert!(
                (restitution - expected).abs() < 1e-3 * size,
                "{case}: {restitution} {expected}"
            );
            assert!((tangential - p[1]).abs() < 1e-3 * p[0], "{case}: {p:?}");
        }
    }
}
