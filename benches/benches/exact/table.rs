//! Search for the loosest tolerance of each peer that satisfies the error limit, and the table of times.

use std::hint::black_box;
use std::time::Instant;

use eomgen_sim::ode::Method;

use crate::Exact;
use crate::arm::STATES;
use crate::peers::{ALL, Peer, Problem};

/// Error limit of all peers, in m.
const ERROR: f64 = 1e-9;

/// Loosest tolerance of the search.
const LOOSEST: f64 = 1e-4;

/// Tightest tolerance of the search.
const TIGHTEST: f64 = 1e-12;

/// Number of rounds. Each round measures all peers, so that all are measured under the same load of the machine.
const ROUNDS: usize = 12;

/// Duration of each measurement in s. It is equal for all peers, because other work on the machine disturbs long
/// measurements more.
const MEASURED: f64 = 0.04;

/// Peers with the tolerances that satisfy the error limit.
pub struct TunedPeers {
    /// Equations to solve.
    pub problem: Problem,
    /// Peers that satisfy the error limit, with their tolerances.
    pub peers: Vec<(Peer, f64)>,
}

/// Finds the tolerances and prints the tables; `orders` must contain order 4.
pub fn print(orders: &mut [Exact]) -> TunedPeers {
    let times: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
    let arm = orders.iter_mut().find(|arm| arm.order == 4);
    let arm = arm.expect("order 4 is among the orders");
    let trajectory = arm.simulate_cached(&times);
    let reference: Vec<f64> = trajectory.states.iter().map(|state| state[0]).collect();
    let problem = Problem::new(magnitudes(&trajectory.states));
    let error = |peer: Peer, tolerance: f64| -> f64 {
        peer.samples(&problem, tolerance, &times)
            .map_or(f64::INFINITY, |samples| distance(&samples, &reference))
    };
    let found: Vec<(Peer, f64, f64)> = ALL
        .into_iter()
        .filter_map(|peer| {
            let (tolerance, error) = find_loosest_tolerance(|tolerance| error(peer, tolerance))?;
            Some((peer, tolerance, error))
        })
        .collect();
    print_peers(arm, &problem, &found);
    let tightest = error(Peer::Located(Method::DormandPrince853), TIGHTEST);
    println!("DOP853, located, at {TIGHTEST:e} differs from exact by {tightest:.1e} m\n");
    print_switches(orders);
    let peers = found.iter().map(|found| (found.0, found.1)).collect();
    TunedPeers { problem, peers }
}

fn print_peers(arm: &mut Exact, problem: &Problem, found: &[(Peer, f64, f64)]) {
    let mut exact = f64::INFINITY;
    let mut anew = f64::INFINITY;
    let mut best = vec![f64::INFINITY; found.len()];
    for _ in 0..ROUNDS {
        anew = anew.min(seconds(|| arm.simulate_uncached()));
        exact = exact.min(seconds(|| arm.simulate_cached(&[])));
        for ((peer, tolerance, _), best) in found.iter().zip(&mut best) {
            *best = best.min(seconds(|| peer.end(problem, *tolerance)));
        }
    }
    println!("\none second of the arm, S = 4; the shortest of {ROUNDS} rounds");
    println!(
        "{:<26}{:>10}{:>12}{:>10}{:>10}",
        "method", "tolerance", "error, m", "ms", "ratio"
    );
    let row = |name: &str, tolerance: &str, error: &str, time: f64| {
        let (ms, ratio) = (1e3 * time, time / exact);
        println!("{name:<26}{tolerance:>10}{error:>12}{ms:>10.3}{ratio:>10.1}");
    };
    row("exact", "-", "-", exact);
    row("exact, regimes anew", "-", "-", anew);
    for ((peer, tolerance, error), time) in found.iter().zip(best) {
        row(
            peer.name(),
            &format!("{tolerance:.1e}"),
            &format!("{error:.1e}"),
            time,
        );
    }
}

fn print_switches(orders: &mut [Exact]) {
    println!("{:<26}{:>10}{:>12}", "exact", "switches", "us/switch");
    for arm in orders {
        let switches = arm.simulate_cached(&[]).events.len();
        let times = (0..ROUNDS).map(|_| seconds(|| arm.simulate_cached(&[])));
        let each = 1e6 * times.fold(f64::INFINITY, f64::min) / switches as f64;
        println!(
            "{:<26}{switches:>10}{each:>12.2}",
            format!("S = {}", arm.order)
        );
    }
    println!();
}

/// Returns the seconds per call of `work`.
fn seconds<T>(mut work: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    let mut calls = 0.0;
    loop {
        black_box(work());
        calls += 1.0;
        let elapsed = start.elapsed().as_secs_f64();
        if elapsed >= MEASURED {
            return elapsed / calls;
        }
    }
}

/// Returns the loosest tolerance with an error of at most [`ERROR`], and the error. The tolerance is decreased by
/// decades until the error limit is satisfied, then by tenths within the last decade. The first tolerance that
/// satisfies the limit is used, even if a tighter one does not, because errors jump at switches that are not located.
fn find_loosest_tolerance(error: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let step = |from: f64, tenths: i32| from * 10.0_f64.powf(-f64::from(tenths) / 10.0);
    let decades = (0..).map(|decade| step(LOOSEST, 10 * decade));
    let kept = decades
        .take_while(|tolerance| *tolerance > TIGHTEST)
        .find(|tolerance| error(*tolerance) <= ERROR)?;
    (-9..=0)
        .map(|tenths| step(kept, tenths))
        .map(|tolerance| (tolerance, error(tolerance)))
        .find(|(_, error)| *error <= ERROR)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let each = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    each.fold(0.0, f64::max)
}

fn magnitudes(states: &[Vec<f64>]) -> [f64; STATES] {
    std::array::from_fn(|place| {
        let each = states.iter().map(|state| state[place].abs());
        each.fold(0.0, f64::max)
    })
}
