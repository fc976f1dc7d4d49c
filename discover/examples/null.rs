//! Tries.
use discover::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let model = model_spec::load(a[1].as_ref()).unwrap().model;
    let d = dataset::read(a[2].as_ref(), &model).unwrap();
    let s = fitting::Setting::new(&d, None, &a[1]);
    let t = std::time::Instant::now();
    let null = search::null_fit(&s, &text).unwrap();
    println!("{:?} null train {:.3} test {:.3} tau {:.1} W {:.2e} {:?}", t.elapsed(), null.train.pooled, null.test.pooled, null.train.correlation, null.prior_weight, null.train.channels);
    for (i, u) in null.unknowns.iter().enumerate() { println!("  {:?} {:.6e} +- {:.1e}", u.what, null.train.estimate.theta[i], null.sd[i]); }
    for (w, r) in s.test.list.iter().zip(&null.test.estimate.squares) { print!("{:.1} ", r / w.times.len() as f64 / 3.0); }
    println!();
    for (w, r) in s.train.list.iter().zip(&null.train.estimate.squares) { print!("{:.1} ", r / w.times.len() as f64 / 3.0); }
    println!();
}
