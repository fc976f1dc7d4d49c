use discover::*;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let model = model_spec::load(a[1].as_ref()).unwrap().model;
    let d = dataset::read(a[2].as_ref(), &model).unwrap();
    let plant = plant::Plant::of(&text, &a[1], None, &d.channels).unwrap();
    let mut plant = plant; let noise: Vec<f64> = d.channels.iter().map(|c| c.noise).collect();
    let f = starts::first_state(&plant, &d.train[0], &d.channels, &d.initial); plant.choose_steps(&d.train[0], &f, &noise); println!("steps {:?}", plant.steps);
    let values: Vec<(String, f64)> = plant.parameters.iter().cloned().zip(plant.values.clone()).collect();
    let unknowns = unknowns::of_null_model(&d, &plant.model, &values);
    let t = Instant::now();
    let w = windows::Windows::cut(&d.train, d.window);
    println!("{} windows, exact {}", w.list.len(), plant.is_exact());
    let ranges = starts::ranges(&plant, &d.train, &plant.initial());
    for (n, r) in plant.states.iter().zip(&ranges) { print!("{n} {r:.2e} "); }
    println!();
    let fitted = d.start == dataset::Start::Fitted;
    let sh = shooting::Shooting { plant: &plant, windows: &w, noise: &noise, unknowns: &unknowns, margin: 2, ranges: fitted.then_some(&ranges), part: 1.0 };
    let theta: Vec<f64> = unknowns.iter().map(|u| u.start).collect();
    let firsts: Vec<Vec<f64>> = d.train.iter().map(|r| starts::first_state(&plant, r, &d.channels, &d.initial)).collect();
    let show = |e: &estimate::Estimate| {
        let m: f64 = w.list.iter().map(|w| (w.times.len() - 4) as f64 * noise.len() as f64).sum();
        println!("cost {:.1} per number {:.4}; theta {:?}", e.cost, e.cost / m, unknowns.iter().zip(&e.theta).map(|(u, v)| format!("{:?} {v:.6e}", u.what)).collect::<Vec<_>>());
        let per: Vec<String> = e.squares.iter().zip(&w.list).map(|(s, w)| format!("{:.1}", s / ((w.times.len() - 4) as f64 * noise.len() as f64))).collect();
        println!("{}", per.join(" "));
    };

    let few: Vec<_> = unknowns.iter().filter(|u| matches!(u.what, unknowns::What::Parameter(_))).cloned().collect();
    let sh1 = shooting::Shooting { unknowns: &few, ..sh };
    let mut t1: Vec<f64> = few.iter().map(|u| u.start).collect();
    let h = [0.05, 0.12, 0.25, 0.5, 1.0];
    let follow = |t: &[f64], k: usize| { if fitted { starts::followed(&sh1, t, &firsts, &ranges, &h[..k]) } else { (estimate::StartPrior::default(), starts::read_smoothed(&plant, &w, &d.channels).unwrap()) } };
    let mut prior = estimate::StartPrior::default(); let mut st = vec![];
    for (k, part) in [(3, 0.25), (5, 1.0)] {
        let (p, e) = estimate::approach(&shooting::Shooting { part, ..sh1 }, &t1, &|t| follow(t, k), 6);
        println!("part {part} {:?} {:.1} {:?}", t.elapsed(), e.cost, e.theta);
        t1 = e.theta; st = e.starts; prior = p;
    }
    let e1 = estimate::estimate(&sh1, &prior, &t1, &st, 6);
    println!("stage one {:?} {:.1} {:?}", t.elapsed(), e1.cost, e1.theta);
    t1 = e1.theta; st = e1.starts;
    let mut theta = theta; theta[..few.len()].copy_from_slice(&t1);
    let e = estimate::estimate(&sh, &prior, &theta, &st, 6);
    println!("estimated {:?}", t.elapsed());
    show(&e);
}
