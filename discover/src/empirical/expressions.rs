//! Empirical expressions: products of few functions of a rate, a position and the inputs. Each
//! quantity is divided by its largest value in the training records. Expressions can be evaluated
//! along a motion and added to a specification.

use std::f64::consts::TAU;

use crate::residual_force::equations::OperatingPoint;
use crate::thresholds::{self, SIGN_WIDTH_FRACTION};

/// Argument of a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FactorArgument {
    /// Rate.
    Rate,
    /// Position.
    Position,
    /// Input, by its index in the model.
    Input(usize),
}

/// Function of one scaled quantity; sine and cosine are functions of the unscaled angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Function {
    /// Power with a given exponent.
    Power(u32),
    /// Absolute value.
    Absolute,
    /// Square with the sign of the argument.
    SignedSquare,
    /// Smooth sign function.
    SmoothSign,
    /// Cosine with an order per turn.
    Cosine(u32),
    /// Sine with an order per turn.
    Sine(u32),
    /// Amount by which the argument exceeds the position of a kink.
    Above(f64),
    /// Amount by which the argument is below the negative position of a kink.
    Below(f64),
}

/// Product of functions; the empty product is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Factors.
    pub factors: Vec<(FactorArgument, Function)>,
}

/// Scales of the quantities, SI; 0 for a constant quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Scales {
    /// Scale of the rate.
    pub rate: f64,
    /// Scale of the position.
    pub position: f64,
    /// Scale of each input.
    pub inputs: Vec<f64>,
}

/// Names of the quantities and of their scales in a specification.
pub struct ExpressionNames {
    /// Expression on which the force acts.
    pub target: String,
    /// Scales of rate and position.
    pub scales: [String; 2],
    /// Each input with its scale.
    pub inputs: Vec<(String, String)>,
}

impl Function {
    fn evaluate(self, scaled: f64, plain: f64) -> f64 {
        match self {
            Self::Power(power) => scaled.powi(power as i32),
            Self::Absolute => scaled.abs(),
            Self::SignedSquare => scaled * scaled.abs(),
            Self::SmoothSign => (scaled / SIGN_WIDTH_FRACTION).tanh(),
            Self::Cosine(order) => (f64::from(order) * plain).cos(),
            Self::Sine(order) => (f64::from(order) * plain).sin(),
            Self::Above(kink) => (scaled - kink).max(0.0),
            Self::Below(kink) => (scaled + kink).min(0.0),
        }
    }

    fn degree(self) -> u32 {
        match self {
            Self::Power(power) => power,
            Self::Absolute | Self::SmoothSign | Self::Cosine(_) | Self::Sine(_) => 1,
            Self::Above(_) | Self::Below(_) => 1,
            Self::SignedSquare => 2,
        }
    }

    /// Returns the text of the function of a quantity divided by its scale. `kink`: parameter for
    /// the position of the kink.
    fn format_function(self, quantity: &str, scale: &str, kink: &str) -> String {
        let times = |order: u32| match order {
            1 => quantity.to_owned(),
            order => format!("{order}*{quantity}"),
        };
        match self {
            Self::Power(1) => format!("({quantity}/{scale})"),
            Self::Power(power) => format!("({quantity}/{scale})^{power}"),
            Self::Absolute => format!("abs({quantity}/{scale})"),
            Self::SignedSquare => format!("({quantity}/{scale})*abs({quantity}/{scale})"),
            Self::SmoothSign => format!("tanh({quantity}/({SIGN_WIDTH_FRACTION}*{scale}))"),
            Self::Cosine(order) => format!("cos({})", times(order)),
            Self::Sine(order) => format!("sin({})", times(order)),
            Self::Above(_) => format!("max({quantity}/{scale} - {kink}, 0)"),
            Self::Below(_) => format!("min({quantity}/{scale} + {kink}, 0)"),
        }
    }

    fn is_scaled(self) -> bool {
        !matches!(self, Self::Cosine(_) | Self::Sine(_))
    }
}

impl Term {
    /// Returns the value at an operating point.
    pub fn evaluate(
        &self,
        operating_point: &OperatingPoint,
        inputs: &[f64],
        scales: &Scales,
    ) -> f64 {
        let factor = |(of, function): &(FactorArgument, Function)| {
            let (value, scale) = match of {
                FactorArgument::Rate => (operating_point.rate, scales.rate),
                FactorArgument::Position => (operating_point.position, scales.position),
                FactorArgument::Input(input) => (inputs[*input], scales.inputs[*input]),
            };
            function.evaluate(value / scale, value)
        };
        self.factors.iter().map(factor).product()
    }

    /// Returns the position of the kink as a fraction of the scale.
    pub fn kink(&self) -> Option<f64> {
        self.factors
            .iter()
            .find_map(|(_, function)| match function {
                Function::Above(kink) | Function::Below(kink) => Some(*kink),
                _ => None,
            })
    }

    /// Returns the term with another position of its kink.
    #[must_use]
    pub fn with_kink(mut self, at: f64) -> Self {
        for (_, function) in &mut self.factors {
            if let Function::Above(kink) | Function::Below(kink) = function {
                *kink = at;
            }
        }
        self
    }

    /// Returns the term in the notation of the specification, multiplied by `parameter`. The
    /// parameter `kink` is the position of its kink.
    pub fn format_term(&self, parameter: &str, kink: &str, arguments: &ExpressionNames) -> String {
        let mut text = parameter.to_owned();
        for (of, function) in &self.factors {
            let factor = match of {
                FactorArgument::Rate => {
                    let rate = format!("dot({})", arguments.target);
                    function.format_function(&rate, &arguments.scales[0], kink)
                }
                FactorArgument::Position => {
                    function.format_function(&arguments.target, &arguments.scales[1], kink)
                }
                FactorArgument::Input(input) => {
                    let (quantity, scale) = &arguments.inputs[*input];
                    function.format_function(quantity, scale, kink)
                }
            };
            text += &format!("*{factor}");
        }
        text
    }

    /// Returns true if the term contains the given quantity divided by its scale.
    pub fn uses_scale_of(&self, wanted: FactorArgument) -> bool {
        let takes =
            |(of, function): &(FactorArgument, Function)| *of == wanted && function.is_scaled();
        self.factors.iter().any(takes)
    }

    fn degree(&self) -> u32 {
        self.factors.iter().map(|factor| factor.1.degree()).sum()
    }
}

/// Returns the trial terms of a force on a coordinate. `width`: range of the coordinate.
pub fn list_terms(scales: &Scales, is_angle: bool, width: f64) -> Vec<Term> {
    use Function::{Above, Absolute, Below, Cosine, Power, SignedSquare, Sine, SmoothSign};
    let rates = [
        Power(1),
        Absolute,
        Power(2),
        SignedSquare,
        Power(3),
        SmoothSign,
    ]
    .map(|f| (FactorArgument::Rate, f));
    let rates = if scales.rate > 0.0 { &rates[..] } else { &[] };
    let (mut positions, mut kinks) = (Vec::new(), Vec::new());
    if scales.position > 0.0 && !(is_angle && width > TAU) {
        let both = thresholds::KINK_FRACTIONS
            .iter()
            .flat_map(|at| [Above(*at), Below(*at)]);
        kinks.extend(both.map(|f| (FactorArgument::Position, f)));
        positions.extend([Power(1), Power(2), Power(3)].map(|f| (FactorArgument::Position, f)));
    }
    if is_angle {
        positions.extend(
            [Cosine(1), Sine(1), Cosine(2), Sine(2)].map(|f| (FactorArgument::Position, f)),
        );
    }
    let mut inputs = Vec::new();
    for (input, scale) in scales.inputs.iter().enumerate() {
        if *scale > 0.0 {
            inputs.extend(
                [Power(1), Absolute, SignedSquare, Power(3)]
                    .map(|f| (FactorArgument::Input(input), f)),
            );
        }
    }
    let mut found = vec![Term {
        factors: Vec::new(),
    }];
    let alone = rates.iter().chain(&positions).chain(&kinks).chain(&inputs);
    found.extend(alone.map(|factor| Term {
        factors: vec![*factor],
    }));
    // The effect of an input may depend on the motion, but it is linear in the input.
    let drives = inputs.iter().filter(|factor| factor.1 == Power(1));
    let motion = rates.iter().chain(&positions);
    let with_inputs = drives.flat_map(|drive| motion.clone().map(move |factor| [*drive, *factor]));
    let both = rates
        .iter()
        .flat_map(|rate| positions.iter().map(move |position| [*rate, *position]));
    let products = with_inputs.chain(both).map(|factors| Term {
        factors: factors.to_vec(),
    });
    found.extend(products.filter(|term| term.degree() <= thresholds::MAX_PRODUCT_DEGREE));
    found
}

#[cfg(test)]
mod tests {
    use super::{ExpressionNames, FactorArgument, Function, Scales, Term, list_terms};
    use crate::residual_force::equations::OperatingPoint;

    #[test]
    fn term_matches_its_text() {
        let arguments = ExpressionNames {
            target: "theta".to_owned(),
            scales: ["w_0", "theta_0"].map(str::to_owned),
            inputs: vec![("u".to_owned(), "u_0".to_owned())],
        };
        let term = |factors: &[(FactorArgument, Function)]| Term {
            factors: factors.to_vec(),
        };
        let operating_point = OperatingPoint {
            position: 0.5,
            rate: -2.0,
            time: 0.0,
        };
        let scales = Scales {
            rate: 4.0,
            position: 1.0,
            inputs: vec![10.0],
        };
        let product = term(&[
            (FactorArgument::Rate, Function::SignedSquare),
            (FactorArgument::Position, Function::Sine(2)),
        ]);
        assert_eq!(
            product.format_term("e_1", "", &arguments),
            "e_1*(dot(theta)/w_0)*abs(dot(theta)/w_0)*sin(2*theta)"
        );
        let value = product.evaluate(&operating_point, &[3.0], &scales);
        assert!((value + 0.25 * 1.0_f64.sin()).abs() < 1e-15);
        let with_inputs = term(&[
            (FactorArgument::Input(0), Function::Power(1)),
            (FactorArgument::Position, Function::Power(2)),
        ]);
        assert_eq!(
            with_inputs.format_term("e_2", "", &arguments),
            "e_2*(u/u_0)*(theta/theta_0)^2"
        );
        assert!(
            (with_inputs.evaluate(&operating_point, &[3.0], &scales) - 0.3 * 0.25).abs() < 1e-15
        );
        assert!(
            with_inputs.uses_scale_of(FactorArgument::Input(0))
                && !product.uses_scale_of(FactorArgument::Position)
        );
        assert_eq!(term(&[]).format_term("e_3", "", &arguments), "e_3");
        for (function, text, value) in [
            (Function::Above(0.2), "e_4*max(theta/theta_0 - e_k, 0)", 0.3),
            (Function::Below(0.2), "e_4*min(theta/theta_0 + e_k, 0)", 0.0),
        ] {
            let kinked = term(&[(FactorArgument::Position, function)]);
            assert_eq!(kinked.format_term("e_4", "e_k", &arguments), text);
            assert!((kinked.evaluate(&operating_point, &[3.0], &scales) - value).abs() < 1e-15);
            assert_eq!(kinked.kink(), Some(0.2));
            assert_eq!(kinked.with_kink(0.4).kink(), Some(0.4));
        }
    }

    #[test]
    fn terms_omit_constant_quantities() {
        let scales = Scales {
            rate: 1.0,
            position: 0.0,
            inputs: vec![0.0, 2.0],
        };
        let all = list_terms(&scales, false, 0.0);
        let still = |term: &&Term| {
            term.uses_scale_of(FactorArgument::Position)
                || term.uses_scale_of(FactorArgument::Input(0))
        };
        assert_eq!(all.iter().filter(still).count(), 0);
        assert!(
            all.iter()
                .any(|term| term.uses_scale_of(FactorArgument::Input(1)))
        );
        for (number, term) in all.iter().enumerate() {
            assert!(!all[..number].contains(term), "{term:?} is there twice");
        }
    }
}
