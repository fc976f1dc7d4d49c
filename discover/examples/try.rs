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
    let f = search::search(&s, null, &catalogue::effects(None).unwrap(), 1.0, &|m| println!("{:.1} {m}", t.elapsed().as_secs_f64())).unwrap();
    for x in &f.accepted { println!("ACCEPTED {} {:?} {:?}", x.candidate.label(), x.evidence, x.test_gap); }
    println!("{:?} end train {:.3} test {:.3}", t.elapsed(), f.best().train.pooled, f.best().test.pooled);
    for (i, u) in f.best().unknowns.iter().enumerate() { println!("  {:?} {:.6e} +- {:.1e}", u.what, f.best().train.estimate.theta[i], f.best().sd[i]); }
}
