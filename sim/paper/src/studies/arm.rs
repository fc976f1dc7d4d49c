//! Planetary arm with any values of the parameters that the paper does not disclose.

use std::f64::consts::{PI, TAU};

use eomgen_model_spec::model::Model;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;

use super::error::StudyError;
use eomgen_analysis::natural_modes::{NaturalMode, natural_modes};
use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_sim::piecewise_linear::Propagator;
use eomgen_validate::references::planetary_arm::mode_shapes::ModeShape;

/// Shipped specification of the arm.
const SPECIFICATION: &str = models::PLANETARY_ARM.text;

/// Parameters that the paper does not disclose. Both meshes have the same damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UndisclosedParameters {
    /// Second moment of area I of the arm, m^4.
    pub second_moment: f64,
    /// Constant motor torque a_m of Eq. (11), N m.
    pub a_m: f64,
    /// Decrease b_m of the motor torque with speed, N m s.
    pub b_m: f64,
    /// Amplitude F_w of the torque ripple, N m.
    pub f_w: f64,
    /// Damping of both meshes, c_sp = c_pr, N s/m.
    pub c: f64,
}

impl UndisclosedParameters {
    /// Assumed values of the shipped specification; the arm has a square section of 10 mm.
    pub const ASSUMED: Self = Self {
        second_moment: 8.333e-10,
        a_m: 2.0,
        b_m: 0.05,
        f_w: 5.0,
        c: 650.0,
    };
}

/// Case of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Modal truncation order S; 0 is the rigid arm.
    pub order: usize,
    /// Half the backlash b of both meshes, m.
    pub backlash: f64,
    /// Frequency of the torque ripple, rad/s.
    pub omega: f64,
    /// Undisclosed parameters.
    pub undisclosed: UndisclosedParameters,
}

impl Case {
    /// Returns the forcing period, s.
    pub fn period(&self) -> f64 {
        TAU / self.omega
    }
}

/// Mode shapes of the arm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ArmShapes {
    /// Mode shapes of a clamped-free beam.
    #[default]
    Corrected,
    /// Mode shapes by Eq. (18) and (19) as printed: a value that is not a root of the frequency equation, and a wrong
    /// sign.
    Printed,
}

impl ArmShapes {
    fn basis(self) -> &'static str {
        match self {
            Self::Corrected => "\"clamped_free\"",
            Self::Printed => "\"clamped_free_printed\"",
        }
    }

    fn shape(self, number: usize) -> ModeShape {
        match self {
            Self::Corrected => ModeShape::clamped_free(number),
            Self::Printed => {
                let z = PI * (number as f64 - 0.5);
                ModeShape::with_values(z, (z.cos() + z.cosh()) / (z.sin() + z.sinh()))
            }
        }
    }
}

/// Planetary arm, derived once per order.
pub struct Arm {
    shapes: ArmShapes,
    model: Model,
    derived: Vec<(usize, CompiledModel)>,
    names: Vec<String>,
    values: Vec<f64>,
}

impl Arm {
    /// Derives the shipped arm at these modal truncation orders.
    ///
    /// # Errors
    /// An order at which it cannot be derived.
    pub fn new(orders: &[usize]) -> Result<Self, StudyError> {
        Self::with_shapes(ArmShapes::Corrected, orders)
    }

    /// Derives the shipped arm with these mode shapes.
    ///
    /// # Errors
    /// An order at which it cannot be derived.
    pub fn with_shapes(shapes: ArmShapes, orders: &[usize]) -> Result<Self, StudyError> {
        let text = SPECIFICATION.replace(ArmShapes::Corrected.basis(), shapes.basis());
        let source = Source::new("planetary_arm.toml", text);
        let checked = eomgen_model_spec::check(source)
            .map_err(|diagnostics| StudyError::Request(diagnostics.render(false)))?;
        let model = checked.model;
        let values = model
            .parameter_values()
            .map_err(|error| StudyError::Request(error.diagnostic().message))?;
        let names = model.parameters.iter().map(|p| p.name.clone()).collect();
        let mut derived = Vec::with_capacity(orders.len());
        for &order in orders {
            let compiled = CompiledModel::derive(model.clone(), Orders::Uniform(order))?;
            compiled.piecewise_linear().map_err(Clone::clone)?;
            derived.push((order, compiled));
        }
        Ok(Self {
            shapes,
            model,
            derived,
            names,
            values,
        })
    }

    /// Returns the model of the specification.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Returns the mode shapes of the derivation.
    pub fn shapes(&self) -> ArmShapes {
        self.shapes
    }

    /// Creates the propagator of a case.
    ///
    /// # Errors
    /// An order that was not derived, or inadmissible values.
    pub fn propagator(&self, case: &Case) -> Result<Propagator, StudyError> {
        Ok(self
            .compiled(case)?
            .with_parameters(&settings(case))?
            .propagator()?)
    }

    fn compiled(&self, case: &Case) -> Result<&CompiledModel, StudyError> {
        let derived = self.derived.iter().find(|(order, _)| *order == case.order);
        let Some((_, compiled)) = derived else {
            return Err(StudyError::Request(format!(
                "the arm was not derived at order {}",
                case.order
            )));
        };
        Ok(compiled)
    }

    fn shipped_value(&self, name: &str) -> f64 {
        let index = self.names.iter().position(|known| known == name);
        let value = index.and_then(|index| self.values.get(index));
        value.copied().unwrap_or(f64::NAN)
    }

    /// Computes the natural frequencies of the machine while both meshes are in contact on one side, Hz.
    ///
    /// # Errors
    /// An order that was not derived, or inadmissible values.
    pub fn closed_mesh_frequencies(&self, case: &Case) -> Result<Vec<f64>, StudyError> {
        let compiled = self.compiled(case)?;
        let instance = compiled.with_parameters(&settings(case))?;
        // The deflection exceeds every backlash of the paper; the linearisation is the same in the whole regime.
        let beyond = 2.0 * case.backlash + 1e-3;
        let at = instance.operating_point(&[("x_sp", beyond), ("x_pr", beyond)])?;
        let linear = instance.linearise(at.point())?;
        let modes = natural_modes(&linear.a, compiled.program().degrees_of_freedom())?;
        let swinging = modes.iter().filter(|mode| mode.eigenvalue.im > 0.0);
        Ok(swinging.map(NaturalMode::frequency).collect())
    }

    /// Returns the conversion factors of a case.
    pub fn lengths(&self, case: &Case) -> ConversionFactors {
        let at = |name| self.shipped_value(name);
        let (rho, area, l) = (at("rho"), at("A"), at("l"));
        let bending = at("E") * case.undisclosed.second_moment / (rho * area * l.powi(4));
        let shapes = (1..=case.order).map(|number| self.shapes.shape(number));
        let shapes: Vec<ModeShape> = shapes.collect();
        let carrier =
            (at("I_c") + 3.0 * at("m_p") * at("r_c").powi(2) + rho * area * l.powi(3) / 3.0)
                / at("i_sH").powi(2);
        let planets = 3.0 * at("I_p") * (at("r_s") / (2.0 * at("r_p"))).powi(2);
        let inertia = at("I_s") + planets + carrier;
        ConversionFactors {
            transmission_factor: l / (at("r_s") * at("i_sH")),
            tip_amplitudes: shapes.iter().map(|shape| shape.value(1.0)).collect(),
            natural_frequencies: shapes
                .iter()
                .map(|shape| shape.beta_l.powi(2) * bending.sqrt() / TAU)
                .collect(),
            carrier_rate: (rho * area * l / inertia).sqrt() * at("r_s") / 2.0,
            mesh_deflection: (rho * area * l / (3.0 * at("k_sp"))).sqrt(),
            mesh_rate: (rho * area * l / at("M_s")).sqrt(),
            inertia,
        }
    }
}

/// Returns the parameters that a case sets, in SI.
fn settings(case: &Case) -> [(&'static str, f64); 9] {
    let UndisclosedParameters {
        second_moment,
        a_m,
        b_m,
        f_w,
        c,
    } = case.undisclosed;
    [
        ("I", second_moment),
        ("a_m", a_m),
        ("b_m", b_m),
        ("F_w", f_w),
        ("c_sp", c),
        ("c_pr", c),
        ("b_sp", case.backlash),
        ("b_pr", case.backlash),
        ("omega", case.omega),
    ]
}

/// Factors that convert a state to the quantities of the paper, and scales of the energy norm.
#[derive(Clone, Debug, PartialEq)]
pub struct ConversionFactors {
    /// Ratio l dtheta/(x_sp + x_pr) of Eq. (23), (24): l/(r_s i_sH).
    pub transmission_factor: f64,
    /// phi_i(l) of each mode.
    pub tip_amplitudes: Vec<f64>,
    /// Rate x_c' at which the drive has the kinetic energy that the arm has at unit rate.
    pub carrier_rate: f64,
    /// Deflection of a mesh at which it has the energy that the arm has at unit rate.
    pub mesh_deflection: f64,
    /// Rate of a mesh at which it has the energy that the arm has at unit rate, if the sun moves.
    pub mesh_rate: f64,
    /// Natural frequencies of the clamped arm, Hz.
    pub natural_frequencies: Vec<f64>,
    /// Inertia of the drive with a rigid arm and without backlash, referred to the sun, kg m^2.
    pub inertia: f64,
}
