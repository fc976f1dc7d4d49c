//! Error of the quadrature of an integrand at a state.

use eomgen_model_spec::evaluate::{evaluate, evaluate_with};
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use super::super::modes::Shapes;
use super::super::quadrature::QuadratureRule;
use super::super::rule::FieldRule;
use super::QuadratureIntegral;
use super::panels::{Profile, divide};

/// Time, parameters, state and inputs, in SI units.
#[derive(Clone, Copy, Debug)]
pub struct State<'s> {
    /// All parameters, in the order of the model.
    pub parameters: &'s [f64],
    /// Time, s.
    pub t: f64,
    /// Coordinates with modes, their rates, first-order states.
    pub state: &'s [f64],
    /// Inputs.
    pub inputs: &'s [f64],
}

/// Model at a state.
struct ModelAtState<'m> {
    model: &'m Model,
    orders: &'m [usize],
    at: State<'m>,
    shapes: Vec<Shapes>,
    /// Index of the mode i in `q[i]` and `phi[i]`, from 0.
    element: usize,
}

/// Field or mode shape, with the order of its derivatives with respect to time and position.
#[derive(Clone, Copy)]
struct FieldValue {
    is_rate: bool,
    is_shape: bool,
    derivative: u8,
}

/// Returns the quadrature error of an integral, relative to the integral of the magnitude; `None` if it is not finite
/// at this state. An integrand with `phi[i]` is evaluated for the first and for the last mode.
pub(super) fn error_at(
    model: &Model,
    orders: &[usize],
    integral: &QuadratureIntegral<'_>,
    at: State<'_>,
) -> Option<f64> {
    let order = orders[integral.field.index()];
    let shapes = model.fields.iter().zip(orders);
    let mut scene = ModelAtState {
        model,
        orders,
        at,
        shapes: shapes
            .map(|(field, order)| Shapes::new(&field.basis, *order))
            .collect(),
        element: 0,
    };
    let first = scene.error(integral)?;
    if !contains_element(integral.integrand) || order < 2 {
        return Some(first);
    }
    scene.element = order - 1;
    Some(first.max(scene.error(integral)?))
}

fn contains_element(integrand: &Expr) -> bool {
    let mut found = false;
    integrand.visit(&mut |part| {
        found |= matches!(
            part.kind,
            ExprKind::ModeShape(_) | ExprKind::ModeCoordinate(_)
        );
    });
    found
}

impl ModelAtState<'_> {
    fn error(&self, integral: &QuadratureIntegral<'_>) -> Option<f64> {
        let field = integral.field;
        let spec = &self.model.fields[field];
        let order = self.orders[field.index()];
        let [from, to] = [&spec.from, &spec.to].map(|end| evaluate(end, self.at.parameters));
        let value = |s: f64| self.value(integral.integrand, field, from + (to - from) * s);
        let profile = Profile {
            value: &value,
            bounds: None,
        };
        let rule = FieldRule::new(self.model, field, order);
        let ends: Vec<f64> = rule
            .knots()
            .windows(2)
            .flat_map(|ends| {
                let [a, b] = [ends[0], ends[1]];
                (0..=order).map(move |k| a + (b - a) * k as f64 / (order + 1) as f64)
            })
            .chain([1.0])
            .collect();
        let fine = divide(&ends, &profile).rule;
        let own = rule.quadrature();
        let [exact, found] = [&fine, &own].map(|rule| integrate(rule, &value));
        let error = (found[0] - exact[0]).abs() / exact[1];
        error.is_finite().then_some(error)
    }

    fn value(&self, expr: &Expr, field: FieldId, x: f64) -> f64 {
        evaluate_with(expr, &|leaf| self.leaf(leaf, field, x))
    }

    fn leaf(&self, leaf: &ExprKind, field: FieldId, x: f64) -> f64 {
        let entry = |place: usize| self.at.state.get(place).copied().unwrap_or(f64::NAN);
        match leaf {
            ExprKind::Parameter(index) => self
                .at
                .parameters
                .get(index.index())
                .copied()
                .unwrap_or(f64::NAN),
            ExprKind::Time => self.at.t,
            ExprKind::Position(_) => x,
            ExprKind::Coordinate(index) => entry(index.index()),
            ExprKind::State(index) => entry(2 * self.size() + index.index()),
            ExprKind::Input(index) => self
                .at
                .inputs
                .get(index.index())
                .copied()
                .unwrap_or(f64::NAN),
            ExprKind::Definition(index) => {
                self.value(&self.model.definitions[*index].value, field, x)
            }
            ExprKind::ModeCoordinate(of) => entry(self.first_mode(*of) + self.element),
            ExprKind::SingleMode { field, mode } => entry(self.first_mode(*field) + mode - 1),
            ExprKind::At {
                field,
                value,
                position,
            } => {
                let position = evaluate(position, self.at.parameters);
                self.value(value, *field, position)
            }
            ExprKind::Dot(operand) => match &operand.kind {
                ExprKind::Coordinate(index) => entry(self.size() + index.index()),
                ExprKind::ModeCoordinate(of) => {
                    entry(self.size() + self.first_mode(*of) + self.element)
                }
                ExprKind::SingleMode { field, mode } => {
                    entry(self.size() + self.first_mode(*field) + mode - 1)
                }
                _ => self.field_value(leaf, field, x),
            },
            other => self.field_value(other, field, x),
        }
    }

    /// Returns the value of the field or of a shape at a position; NaN for other leaves.
    fn field_value(&self, leaf: &ExprKind, field: FieldId, x: f64) -> f64 {
        let Some(found) = field_value(leaf) else {
            return f64::NAN;
        };
        let spec = &self.model.fields[field];
        let [from, to] = [&spec.from, &spec.to].map(|end| evaluate(end, self.at.parameters));
        let shapes =
            self.shapes[field.index()].values_at(found.derivative, (x - from) / (to - from));
        let scale = (to - from).powi(-i32::from(found.derivative));
        if found.is_shape {
            return scale * shapes.get(self.element).copied().unwrap_or(0.0);
        }
        let rates = if found.is_rate { self.size() } else { 0 };
        let amplitudes = self.at.state.iter().skip(rates + self.first_mode(field));
        let sum: f64 = shapes
            .iter()
            .zip(amplitudes)
            .map(|(shape, q)| shape * q)
            .sum();
        scale * sum
    }

    fn first_mode(&self, field: FieldId) -> usize {
        let before = &self.orders[..field.index()];
        self.model.coordinates.len() + before.iter().sum::<usize>()
    }

    fn size(&self) -> usize {
        self.model.coordinates.len() + self.orders.iter().sum::<usize>()
    }
}

fn field_value(leaf: &ExprKind) -> Option<FieldValue> {
    let itself = |is_shape| FieldValue {
        is_rate: false,
        is_shape,
        derivative: 0,
    };
    match leaf {
        ExprKind::Field(_) => Some(itself(false)),
        ExprKind::ModeShape(_) => Some(itself(true)),
        ExprKind::Dot(operand) => Some(FieldValue {
            is_rate: true,
            ..field_value(&operand.kind)?
        }),
        ExprKind::Diff(operand, times) => {
            let found = field_value(&operand.kind)?;
            Some(FieldValue {
                derivative: found.derivative + times,
                ..found
            })
        }
        _ => None,
    }
}

/// Returns the integrals of a function and of its magnitude.
fn integrate(rule: &QuadratureRule, value: &dyn Fn(f64) -> f64) -> [f64; 2] {
    let nodes = rule.nodes.iter().zip(&rule.weights);
    nodes.fold([0.0; 2], |[sum, magnitude], (s, weight)| {
        let addend = weight * value(*s);
        [sum + addend, magnitude + addend.abs()]
    })
}
