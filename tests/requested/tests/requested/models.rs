//! Shipped specifications with all outputs that can be requested, each at its declared order.

use crate::dual::scalar_of;
use crate::tracked::tracked_scalar_of;

macro_rules! models {
    ($($module:ident = $spec:literal, $order:literal;)*) => {
        $(
            pub mod $module {
                eomgen::model! {
                    spec = $spec,
                    order = $order,
                    with = [
                        bias_forces, inverse_dynamics, guard_rates, jacobians, products, linearisation, regimes, lanes
                    ]
                }
            }
        )*
        scalar_of!($($module),*);
        #[allow(non_upper_case_globals)]
        pub mod specifications {
            use crate::evaluators::Specification;
            $(pub const $module: Specification = ($spec, $order);)*
        }
        tracked_scalar_of!($($module),*);
    };
}

models! {
    arm_rigid = "../../model-spec/models/planetary_arm.toml", 0;
    arm = "../../model-spec/models/planetary_arm.toml", 4;
    arm_of_nine_modes = "../../model-spec/models/planetary_arm.toml", 9;
    rig = "../../model-spec/models/planetary_arm_rig.toml", 2;
    beam = "../../model-spec/models/hub_beam_tip_mass.toml", 3;
    double_pendulum = "../../model-spec/models/double_pendulum.toml", 0;
    cart = "../../model-spec/models/cart_two_arms.toml", 0;
    furuta = "../../model-spec/models/furuta_pendulum.toml", 0;
    pendulum = "../../model-spec/models/pendulum.toml", 0;
    emps = "../../model-spec/models/emps.toml", 0;
    exponential_taper = "../features/exponential_taper.toml", 3;
    printed_basis = "../features/printed_basis.toml", 2;
    two_fields = "../features/two_fields.toml", 2;
    functions = "../features/functions.toml", 0;
    nonquadratic_kinetic = "../features/nonquadratic_kinetic.toml", 0;
    rheonomic = "../features/rheonomic.toml", 0;
    lever_mass_turning = "../features/lever_mass_turning.toml", 2;
    centrifugal_stiffening = "../features/centrifugal_stiffening.toml", 3;
}
