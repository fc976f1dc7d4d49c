//! Tests of the cases, the claims and the search of the paper. Measurements are compared with independent computations,
//! rules with constructed readings, and a resumed search with an uninterrupted one.

use std::collections::BTreeMap;

use eomgen_analysis::classify::Motion;
use eomgen_analysis::exponent::mean_exponent;
use eomgen_paper::studies::arm::{Arm, ArmShapes, Case, UndisclosedParameters};
use eomgen_paper::studies::case::{Amplitude, RunLength, measure};
use eomgen_paper::studies::claims::{CLAIMS, Claim, cases};
use eomgen_paper::studies::judge::{Readings, Verdict, judge};
use eomgen_paper::studies::reading::{CaseKey, Forcing, Kind, Reading};
use eomgen_paper::studies::search::{JudgedSet, SearchRequest, orders, search};
use eomgen_paper::studies::sets::{RANGES, create_parameter_set};
use eomgen_paper::studies::tally::{
    find_exclusive_pairs, histogram, share_with, shares, undecided,
};
use eomgen_sim::inputs::HeldInputs;

/// Returns a reading whose transmission error increases with b and whose deflection is constant.
fn reading(key: &CaseKey, kind: Kind) -> Reading {
    let of = |span: f64| Amplitude {
        largest: span / 2.0,
        mean: 0.0,
        rms: span / 3.0,
        span,
    };
    let b = f64::from(key.micrometres);
    Reading {
        kind,
        is_strictly_quasi_periodic: kind == Kind::Regular,
        sentence: String::new(),
        f_la: of(1e-3 + 2e-5 * b),
        f_la_signed: of(1e-3 + 2e-5 * b),
        transmission: of(2e-5 * b),
        dr: of(1e-3),
        vibration: vec![1.0, 0.1, if b > 99.0 { 2.0 } else { 0.2 }, 0.0],
    }
}

/// Returns readings for which the claims of the paper hold.
fn paper() -> Readings {
    let kind = |key: &CaseKey| match (key.order, key.forcing, key.micrometres) {
        (0, ..) => Kind::Regular,
        (_, Forcing::FivePi, 0..=25) | (_, Forcing::TenPi, 0..=10) => Kind::Regular,
        _ => Kind::Chaotic,
    };
    let keys = cases().into_iter();
    keys.map(|key| (key, reading(&key, kind(&key)))).collect()
}

fn claim(id: &str) -> &'static Claim {
    CLAIMS.iter().find(|claim| claim.id == id).unwrap()
}

#[test]
fn all_claims_hold_for_readings_of_the_paper() {
    let readings = paper();
    for claim in &CLAIMS {
        let judged = judge(claim, &readings);
        assert_eq!(judged.holding, Verdict::Holds, "{}", claim.id);
        assert_eq!(judged.strict, Verdict::Holds, "{}", claim.id);
    }
}

#[test]
fn each_claim_can_fail() {
    let mut readings = paper();
    for (key, reading) in &mut readings {
        let b = f64::from(key.micrometres);
        reading.kind = match reading.kind {
            Kind::Regular => Kind::Chaotic,
            _ => Kind::Regular,
        };
        reading.f_la.largest = 1.0;
        reading.f_la_signed.largest = 1.0;
        // The transmission error is the larger part for small b, and the deflection, which increases tenfold, for large
        // b.
        reading.dr.span = 1e-4 * (b / 10.0).powi(2) * (1.0 + key.order as f64);
        reading.dr.rms = reading.dr.span;
        reading.transmission.span = 2e-3 * (1.0 + b / 10.0);
        reading.transmission.rms = reading.transmission.span;
        reading.vibration = vec![0.0, 1.0];
        if key.order == 5 {
            reading.dr.span = 1.0;
            reading.dr.rms = 1.0;
        }
    }
    let reference = readings[&CaseKey::flexible(Forcing::FivePi, 0)].clone();
    readings.insert(
        CaseKey::flexible(Forcing::FivePi, 0),
        Reading {
            dr: Amplitude {
                span: 0.5,
                rms: 0.5,
                ..reference.dr
            },
            ..reference
        },
    );
    // The claims about frequency and flexibility still hold, because both compared sides were exchanged.
    let still = ["frequency", "flexibility"];
    for claim in CLAIMS.iter().filter(|claim| !still.contains(&claim.id)) {
        assert_eq!(
            judge(claim, &readings).holding,
            Verdict::Fails,
            "{}",
            claim.id
        );
    }
}

#[test]
fn periodic_motion_is_quasi_periodic_only_in_the_generous_reading() {
    let key = CaseKey::flexible(Forcing::FivePi, 10);
    let mut readings = paper();
    readings.get_mut(&key).unwrap().is_strictly_quasi_periodic = false;
    for id in ["regular_5pi_10", "route_5pi"] {
        let judged = judge(claim(id), &readings);
        assert_eq!(judged.holding, Verdict::Holds);
        assert_eq!(judged.strict, Verdict::Fails);
    }
}

#[test]
fn route_with_a_possible_return_is_undecided() {
    use Kind::{Chaotic as C, Regular as R, Unknown as U};
    for (kinds, expected) in [
        ([R, R, C, C], Verdict::Holds),
        // One unknown case between regular and chaotic motion may be regular or chaotic.
        ([R, U, C, C], Verdict::Holds),
        ([R, R, U, C], Verdict::Holds),
        // Two unknown cases may be chaotic and then regular, which contradicts the claim. The same applies to one
        // unknown case after chaotic or before regular motion.
        ([R, U, U, C], Verdict::Undecided),
        ([R, C, U, C], Verdict::Undecided),
        ([R, U, R, C], Verdict::Undecided),
        ([R, C, R, C], Verdict::Fails),
        ([R, R, C, R], Verdict::Fails),
        ([C, U, C, C], Verdict::Fails),
        ([U, C, C, C], Verdict::Undecided),
    ] {
        let mut readings = paper();
        for (b, kind) in [10, 25, 50, 100].into_iter().zip(kinds) {
            let key = CaseKey::flexible(Forcing::FivePi, b);
            readings.insert(key, reading(&key, kind));
        }
        let judged = judge(claim("route_5pi"), &readings);
        assert_eq!(judged.holding, expected, "{kinds:?}");
    }
}

#[test]
fn missing_cases_leave_claims_undecided() {
    for claim in &CLAIMS {
        let judged = judge(claim, &BTreeMap::new());
        assert_eq!(judged.holding, Verdict::Undecided, "{}", claim.id);
    }
}

/// Returns the arm with the assumed values and the order of the paper.
fn assumed(forcing: Forcing, backlash: f64) -> Case {
    Case {
        order: 4,
        backlash,
        omega: forcing.omega(),
        undisclosed: UndisclosedParameters::ASSUMED,
    }
}

/// Returns, for each forcing period, the logarithmic growth of the distance between two motions. The distance is
/// rescaled four times per period (G. Benettin, L. Galgani, J.-M. Strelcyn, Phys. Rev. A 14 (1976) 2338-2345).
fn parting(arm: &Arm, case: &Case, transient: usize, periods: usize) -> Vec<f64> {
    const DISTANCE: f64 = 1e-9;
    let mut propagator = arm.propagator(case).unwrap();
    let none = HeldInputs::zero(0);
    let mut follow = |state: &[f64], span: (f64, f64)| {
        let followed = propagator.simulate(state, span, &[], &none, &mut |_| {});
        followed.unwrap().final_state
    };
    let quarter = |count: usize| count as f64 * case.period() / 4.0;
    let mut here = follow(&[0.0; 14], (0.0, quarter(4 * transient)));
    let mut difference = vec![1.0; here.len()];
    let mut growths = vec![0.0; periods];
    for (period, step) in (0..4 * periods).map(|step| (step / 4, step + 4 * transient)) {
        // No force depends on the position of the carrier.
        difference[2] = 0.0;
        let length = difference.iter().map(|d| d * d).sum::<f64>().sqrt();
        let beside = here.iter().zip(&difference);
        let beside: Vec<f64> = beside.map(|(y, d)| y + DISTANCE * d / length).collect();
        let span = (quarter(step), quarter(step + 1));
        let there = follow(&beside, span);
        here = follow(&here, span);
        difference = there.iter().zip(&here).map(|(a, b)| a - b).collect();
        let parted = difference
            .iter()
            .enumerate()
            .filter(|(place, _)| *place != 2);
        let parted = parted.map(|(_, d)| d * d).sum::<f64>().sqrt();
        growths[period] += (parted / DISTANCE).ln();
    }
    growths
}

#[test]
fn exponent_matches_the_divergence_of_two_motions() {
    let arm = Arm::new(&[4]).unwrap();
    let case = assumed(Forcing::TenPi, 100e-6);
    let length = RunLength {
        strong_growth_periods: None,
        ..RunLength::SCREENING
    };
    let measured = measure(&arm, &case, &length).unwrap();
    let reading = Reading::from_measurement(&measured);
    assert_eq!(reading.kind, Kind::Chaotic, "{}", reading.sentence);
    let carried = measured.evidence.exponent.unwrap();
    let parted = mean_exponent(&parting(&arm, &case, 40, 200), case.period()).unwrap();
    // The exponents of two parts of one chaotic motion, by tangent vectors and by differences, must agree within four
    // combined standard errors.
    let error = carried.standard_error.hypot(parted.standard_error);
    assert!(
        (carried.value - parted.value).abs() < 4.0 * error,
        "{carried:?} {parted:?}"
    );
    // The response at the forcing frequency is not evidence of regular motion.
    let lines = measured.evidence.line_share.unwrap();
    assert!(lines < 0.1, "{lines}");
}

#[test]
fn standard_errors_of_exponents_match_their_scatter() {
    let arm = Arm::new(&[4]).unwrap();
    let length = RunLength {
        transient: (200, 200),
        modes: 1,
        ..RunLength::FULL
    };
    // The motion is intermittently chaotic over hundreds of periods.
    let exponents: Vec<_> = (0..16)
        .map(|place| {
            let case = assumed(Forcing::FivePi, 100e-6 + 1e-8 * f64::from(place));
            let measured = measure(&arm, &case, &length);
            measured.unwrap().evidence.exponent.unwrap()
        })
        .collect();
    let count = exponents.len() as f64;
    let mean = exponents.iter().map(|e| e.value).sum::<f64>() / count;
    let squares = exponents.iter().map(|e| (e.value - mean).powi(2));
    let scatter = (squares.sum::<f64>() / (count - 1.0)).sqrt();
    let stated = exponents.iter().map(|e| e.standard_error.powi(2));
    let stated = (stated.sum::<f64>() / count).sqrt();
    // 16 exponents determine the standard deviation to 18 %. Standard errors from batches of 20 of 400 periods would be
    // only 0.4 of it.
    assert!(
        (0.65..1.6).contains(&(stated / scatter)),
        "{stated} {scatter} {exponents:?}"
    );
}

#[test]
fn undecided_cases_are_extended() {
    let arm = Arm::new(&[4]).unwrap();
    let case = assumed(Forcing::FivePi, 10e-6);
    let motion = |most: usize| {
        let length = RunLength {
            transient: (150, 150),
            classified_periods: (100, most),
            ..RunLength::SCREENING
        };
        let measured = measure(&arm, &case, &length).unwrap();
        // The length of the record does not increase with the number of periods.
        let last = measured.record.times.last().unwrap() - measured.record.times[0];
        assert!((last / case.period() - 100.0).abs() < 1e-9);
        (measured.verdict.motion, measured.periods)
    };
    assert_eq!(motion(100), (Motion::Undecided, 100));
    let (decided, periods) = motion(2000);
    assert_eq!(decided, Motion::Chaotic);
    assert!((200..2000).contains(&periods), "{periods}");
}

#[test]
fn printed_mode_shapes_give_chaos_without_a_dominant_third_mode() {
    let arm = Arm::with_shapes(ArmShapes::Printed, &[4]).unwrap();
    let length = RunLength {
        modes: 1,
        ..RunLength::FULL
    };
    for micrometres in [10, 25, 50, 100] {
        for forcing in [Forcing::FivePi, Forcing::TenPi] {
            let key = CaseKey::flexible(forcing, micrometres);
            let measured = measure(&arm, &key.case(UndisclosedParameters::ASSUMED), &length);
            let reading = Reading::from_measurement(&measured.unwrap());
            // One of the eight cases becomes periodic.
            let settles = (forcing, micrometres) == (Forcing::FivePi, 50);
            let kind = if settles {
                Kind::Regular
            } else {
                Kind::Chaotic
            };
            assert_eq!(reading.kind, kind, "{key}: {}", reading.sentence);
            assert_eq!(reading.dominant_mode(), Some(2), "{:?}", reading.vibration);
        }
    }
}

#[test]
fn motion_without_backlash_is_regular_and_matches_observables() {
    let arm = Arm::new(&[4]).unwrap();
    let case = Case {
        order: 4,
        backlash: 0.0,
        omega: Forcing::TenPi.omega(),
        undisclosed: UndisclosedParameters::ASSUMED,
    };
    let measured = measure(&arm, &case, &RunLength::SCREENING).unwrap();
    assert_eq!(Reading::from_measurement(&measured).kind, Kind::Regular);
    // Check of the magnitude by quasi-static bending due to the acceleration a of the tip. The tip of a cantilever
    // under the load rho A x a/l deflects by 11 rho A a l^4/(120 E I).
    let torque = case.undisclosed.f_w;
    let lengths = arm.lengths(&case);
    let i_sh = 1.0 + 99.0 / 27.0;
    let acceleration = torque / lengths.inertia / i_sh * 0.5;
    let tip = 11.0 * 7900.0 * 1e-4 * acceleration * 0.5_f64.powi(4) / (120.0 * 2e11 * 8.333e-10);
    // Motor damping, and the resonance at 230 rad/s with a forcing of 31 rad/s, change the deflection by a few per
    // cent.
    assert!(
        (0.5 * measured.dr.span / tip - 1.0).abs() < 0.1,
        "{tip} {:?}",
        measured.dr
    );
}

#[test]
fn sets_fill_their_ranges() {
    let sets: Vec<UndisclosedParameters> = (0..1000)
        .map(|index| create_parameter_set(index, 1))
        .collect();
    let values =
        |set: &UndisclosedParameters| [set.second_moment, set.a_m, set.b_m, set.f_w, set.c];
    for (axis, range) in RANGES.iter().enumerate() {
        let (low, high) = range.bounds;
        let mut counts = [0; 10];
        let inside = sets
            .iter()
            .map(|set| values(set)[axis])
            .filter(|value| *value > 0.0);
        for value in inside {
            assert!((low..=high).contains(&value));
            counts[(10.0 * (value / low).ln() / (high / low).ln()) as usize] += 1;
        }
        let all: usize = counts.iter().sum();
        // In a random sequence, the counts of the ten intervals would differ by a third.
        let even = |count: &usize| (*count as f64 * 10.0 / all as f64 - 1.0).abs() < 0.2;
        assert!(counts.iter().all(even), "{} {counts:?}", range.name);
    }
    assert!(sets.iter().filter(|set| set.b_m == 0.0).count() == 250);
}

#[test]
fn interrupted_search_resumes_to_the_same_bytes() {
    let arm = Arm::new(&orders()).unwrap();
    let short = RunLength {
        transient: (2, 2),
        periods: 100,
        classified_periods: (100, 100),
        strong_growth_periods: Some(30),
        modes: 1,
    };
    let request = SearchRequest {
        sets: 3,
        seed: 7,
        confirmed: 1,
        neighbours: 1,
        screening: short,
        confirming: short,
    };
    let folder = tempfile::tempdir().unwrap();
    let run = |request: &SearchRequest| search(&arm, request, folder.path(), &mut |_| {});
    let first = run(&request).unwrap();
    let part = folder.path().join("screened_00000.csv");
    let bytes = std::fs::read(&part).unwrap();
    // The folder is in the state after an interruption: a chunk is missing, and a temporary file is incomplete.
    std::fs::remove_file(&part).unwrap();
    std::fs::write(folder.path().join("screened_00000.unfinished"), "0,1").unwrap();
    assert_eq!(run(&request).unwrap(), first);
    assert_eq!(std::fs::read(&part).unwrap(), bytes);
    for judged in &first.screened {
        assert_eq!(JudgedSet::parse(&judged.to_line()).as_ref(), Some(judged));
    }
    let other = SearchRequest { seed: 8, ..request };
    assert!(run(&other).is_err());
}

#[test]
fn tally_counts_verdicts() {
    let judged = |index: usize, first: &str| {
        let letters = |first: &str| {
            let rest = std::iter::repeat_n('F', CLAIMS.len() - first.len());
            first.chars().chain(rest).collect()
        };
        JudgedSet {
            index,
            undisclosed: UndisclosedParameters::ASSUMED,
            verdicts: letters(first),
            strict: letters(&first.replacen('H', "F", 1)),
        }
    };
    // The first two claims hold in some sets, but never together; the first and the third hold
    // together.
    let sets = [
        judged(0, "HFH"),
        judged(1, "FHU"),
        judged(2, "HUF"),
        judged(3, "FFF"),
    ];
    let all = shares(&sets);
    let of = |place: usize| {
        (
            all[place].holds,
            all[place].fails,
            all[place].undecided_share,
        )
    };
    assert_eq!(of(0), (0.5, 0.5, 0.0));
    assert_eq!(of(1), (0.25, 0.5, 0.25));
    assert_eq!(of(2), (0.25, 0.5, 0.25));
    assert_eq!((all[0].holds_strictly, all[2].holds_strictly), (0.0, 0.25));
    assert!((undecided(&sets) - 0.5 / CLAIMS.len() as f64).abs() < 1e-15);
    assert_eq!(histogram(&sets)[..4], [1, 2, 1, 0]);
    assert_eq!(find_exclusive_pairs(&sets), [(0, 1), (1, 2)]);
    assert_eq!((share_with(&sets, 1), share_with(&sets, 2)), (0.75, 0.25));
}
