//! Lists.
use discover::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let model = model_spec::load(a[1].as_ref()).unwrap().model;
    let s = sites::sites(&model);
    for x in &s { println!("{:?} {} {:?}", x.kind, x.name, x.words); }
    let c = candidates::candidates(&model, &catalogue::effects(None).unwrap(), &s, &Default::default());
    println!("{}", c.len());
    for c in c {
        let v: Vec<f64> = c.parameters.iter().map(|_| 1.0).collect();
        match c.written(&text, &a[1], &v, "x") { Ok(t) => {
           let p = plant::Plant::of(&t, "x", None, &[]); 
           if c.order.as_ref().is_none_or(|o| o.1 == 1) { println!("{} {:?} exact {:?}", c.label(), c.parameters.iter().map(|p| format!("{} [{}]", p.name, p.unit)).collect::<Vec<_>>(), p.map(|p| p.is_exact())); } }
         Err(e) => println!("{} {e}", c.label()) }
    }
}
