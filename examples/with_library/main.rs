use eomgen::library::{CompiledModel, Orders, Solver};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = CompiledModel::load("model-spec/models/planetary_arm.toml", Orders::Declared)?;
    let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 1e-3).collect();
    for b in [0.0, 50e-6, 100e-6] {
        let run = model.with_parameters(&[("b_sp", b), ("b_pr", b)])?; // in the units of the file
        let motion = run.simulate(run.initial_state(), &times, &run.default_inputs(), Solver::Auto)?;
        let (switches, by) = (motion.trajectory.events.len(), motion.solver);
        println!("b = {b:e} m: {switches} switches, solver {by}");
    }
    Ok(())
}
