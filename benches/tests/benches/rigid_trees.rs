//! Tests of the operation counts of rigid trees, and of their expressions in CasADi.

use eomgen_benches::casadi_contender::definitions;
use eomgen_benches::rigid_specifications as specifications;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

fn model(text: String) -> Model {
    match eomgen_model_spec::check(Source::new("rigid_tree.toml", text)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", found.render(false)),
    }
}

fn operations(text: String) -> usize {
    match Variant::derive(&model(text), &[]) {
        Ok(variant) => {
            let roots = variant.program.accelerations.all();
            variant.program.operations(&roots)
        }
        Err(found) => panic!("{}", found.render(false)),
    }
}

#[test]
fn cartesian_definitions_take_at_most_15_percent_more_than_energies_by_hand() {
    let pairs = [
        (
            specifications::spherical_pendulum(),
            specifications::spherical_pendulum_by_hand(),
        ),
        (
            specifications::planar_arm(2),
            specifications::planar_arm_by_hand(2),
        ),
        (
            specifications::planar_arm(3),
            specifications::planar_arm_by_hand(3),
        ),
    ];
    for (cartesian, by_hand) in pairs {
        let (cartesian, by_hand) = (operations(cartesian), operations(by_hand));
        assert!(100 * cartesian <= 115 * by_hand, "{cartesian} {by_hand}");
    }
}

#[test]
fn energies_of_every_tree_convert_to_casadi() {
    for text in [
        specifications::planar_arm(3),
        specifications::puma(4),
        specifications::puma(6),
        specifications::chain(10),
    ] {
        let model = model(text);
        let module = definitions(&model).expect("expressions that CasADi supports");
        assert_eq!(module.matches("T += ").count(), model.kinetic.len());
        assert_eq!(
            module.matches("d[").count() > 0,
            !model.definitions.is_empty()
        );
    }
}
