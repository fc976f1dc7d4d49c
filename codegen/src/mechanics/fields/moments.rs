//! Graph nodes of mode shapes at a point and of integrals of integrand terms. The integrals are exact dimensionless
//! constants if possible, else quadrature.

use eomgen_model_spec::model::{Basis, End, Function};

use crate::mechanics::fields::beam::is_sinusoidal;
use crate::mechanics::fields::domain::Domain;
use crate::mechanics::fields::modes::is_orthogonal;
use crate::mechanics::fields::term::IntegrandTerm;
use crate::symbolic::graph::{Graph, NodeId, Operation, Space};
use crate::symbolic::tables::TableKind;

/// Returns phi_r^(a) at s, a vector over the modes: tables at the ends, formulas elsewhere.
///
/// # Errors
/// A tabulated shape at a position that depends on parameters.
pub(crate) fn build_shapes_at(
    graph: &mut Graph,
    domain: &Domain,
    s: NodeId,
    derivative: u8,
) -> Result<NodeId, String> {
    let place = graph.as_constant(s);
    match place {
        Some(0.0) => return Ok(domain.table(graph, TableKind::ShapeAtStart(derivative))),
        Some(1.0) => return Ok(domain.table(graph, TableKind::ShapeAtEnd(derivative))),
        _ => {}
    }
    match (&domain.basis, place) {
        (
            Basis::ClampedFreePrinted
            | Basis::Beam {
                from: End::Clamped, ..
            },
            _,
        ) => Ok(build_clamped_shapes(graph, domain, s, derivative)),
        (&Basis::Beam { from, to }, _) => Ok(build_beam_shapes(graph, domain, s, derivative, [from, to])),
        (Basis::Table { .. }, Some(s)) if (0.0..=1.0).contains(&s) => {
            let bits = s.to_bits();
            Ok(domain.table(graph, TableKind::ShapeAtPlace { bits, derivative }))
        }
        (Basis::Table { .. }, Some(_)) => Err("the position is outside the table of shapes".into()),
        (Basis::Table { .. }, None) => Err(
            "tabulated shapes need an end or a fixed fraction of the length as position, for example \
             at(w, 0.3*l)"
                .into(),
        ),
    }
}

/// Builds the shapes of Eq. (17) of the paper from xi_r and (1 + xi_r) exp(beta_r l).
fn build_clamped_shapes(graph: &mut Graph, domain: &Domain, s: NodeId, derivative: u8) -> NodeId {
    let beta = domain.table(graph, TableKind::Wavenumber);
    let xi = domain.table(graph, TableKind::Mixing);
    let growing = domain.table(graph, TableKind::GrowingAmplitude);
    let one = graph.one();
    let z = graph.multiply(beta, s);
    let sine = graph.call(Function::Sin, &[z]);
    let cosine = graph.call(Function::Cos, &[z]);
    let (first, second, sign) = match derivative % 4 {
        0 => (sine, cosine, [1.0, 1.0]),
        1 => (cosine, sine, [1.0, -1.0]),
        2 => (sine, cosine, [-1.0, -1.0]),
        _ => (cosine, sine, [-1.0, 1.0]),
    };
    let second = graph.multiply(xi, second);
    let left = graph.negate(z);
    let falling = graph.call(Function::Exp, &[left]);
    let right = graph.subtract(z, beta);
    let rising = graph.call(Function::Exp, &[right]);
    let rising = graph.multiply(growing, rising);
    let mixed = graph.subtract(one, xi);
    let falling = graph.multiply(mixed, falling);
    let falling_sign = if derivative.is_multiple_of(2) {
        0.5
    } else {
        -0.5
    };
    let shape = graph.combine(&[
        (sign[0], first),
        (sign[1], second),
        (-0.5, rising),
        (falling_sign, falling),
    ]);
    graph.product(&[(beta, i32::from(derivative)), (shape, 1)])
}

/// Builds sin z, sin z + xi cos z or cos z, depending on the end at the start, plus the decaying exponentials of
/// clamped and free ends.
fn build_beam_shapes(
    graph: &mut Graph,
    domain: &Domain,
    s: NodeId,
    derivative: u8,
    [from, to]: [End; 2],
) -> NodeId {
    let beta = domain.table(graph, TableKind::Wavenumber);
    let z = graph.multiply(beta, s);
    let mut terms = Vec::new();
    if from != End::Guided {
        terms.push(differentiate_sinusoid(graph, Function::Sin, z, derivative));
    }
    if from != End::Pinned {
        let (sign, mut cosine) = differentiate_sinusoid(graph, Function::Cos, z, derivative);
        if from != End::Guided {
            let xi = domain.table(graph, TableKind::Mixing);
            cosine = graph.multiply(xi, cosine);
        }
        terms.push((sign, cosine));
    }
    if !is_sinusoidal(from, to) {
        let left = graph.negate(z);
        let right = graph.subtract(z, beta);
        let parity = if derivative.is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        for (sign, exponent, amplitude) in [
            (parity, left, TableKind::FallingAmplitude),
            (1.0, right, TableKind::RisingAmplitude),
        ] {
            let exponential = graph.call(Function::Exp, &[exponent]);
            let amplitude = domain.table(graph, amplitude);
            terms.push((sign, graph.multiply(amplitude, exponential)));
        }
    }
    let shape = graph.combine(&terms);
    graph.product(&[(beta, i32::from(derivative)), (shape, 1)])
}

/// Returns a derivative of sin z or cos z by z as a function and a sign.
fn differentiate_sinusoid(
    graph: &mut Graph,
    function: Function,
    z: NodeId,
    derivative: u8,
) -> (f64, NodeId) {
    let quarters = derivative + u8::from(function == Function::Cos);
    let own = if quarters.is_multiple_of(2) {
        Function::Sin
    } else {
        Function::Cos
    };
    let sign = if quarters % 4 < 2 { 1.0 } else { -1.0 };
    (sign, graph.call(own, &[z]))
}

/// Returns the integral over s of s^power weight atom_1 atom_2; a vector over the modes if one atom is a bare
/// shape.
pub(crate) fn integrate_term(graph: &mut Graph, domain: &Domain, term: &IntegrandTerm) -> NodeId {
    if let Some(weight) = term.weight {
        return integrate_with_weight(graph, domain, term, weight);
    }
    let modes = Space::Modes(domain.field);
    match *term.atoms.as_slice() {
        [a, b] => {
            let (left, right) = (a.derivative(), b.derivative());
            let orthogonal = is_orthogonal(&domain.basis, term.power, left, right);
            let amplitudes = [
                a.amplitudes(graph, domain.field),
                b.amplitudes(graph, domain.field),
            ];
            let own = TableKind::OwnMoment {
                power: term.power,
                left,
                right,
            };
            let pair = TableKind::PairMoment {
                power: term.power,
                left,
                right,
            };
            match amplitudes {
                [None, None] => domain.table(graph, own),
                [Some(u), Some(v)] if orthogonal => {
                    let table = domain.table(graph, own);
                    let product = graph.product(&[(table, 1), (u, 1), (v, 1)]);
                    graph.sum_over_space(modes, product)
                }
                [Some(u), Some(v)] => {
                    let table = domain.table(graph, pair);
                    let applied = graph.apply(table, false, v);
                    let product = graph.multiply(u, applied);
                    graph.sum_over_space(modes, product)
                }
                [Some(u), None] if orthogonal => {
                    let table = domain.table(graph, own);
                    graph.multiply(table, u)
                }
                [None, Some(u)] if orthogonal => {
                    let table = domain.table(graph, own);
                    graph.multiply(table, u)
                }
                [Some(u), None] => {
                    let table = domain.table(graph, pair);
                    graph.apply(table, true, u)
                }
                [None, Some(u)] => {
                    let table = domain.table(graph, pair);
                    graph.apply(table, false, u)
                }
            }
        }
        [a] => {
            let table = domain.table(
                graph,
                TableKind::Moment {
                    power: term.power,
                    derivative: a.derivative(),
                },
            );
            match a.amplitudes(graph, domain.field) {
                Some(u) => {
                    let product = graph.multiply(table, u);
                    graph.sum_over_space(modes, product)
                }
                None => table,
            }
        }
        _ => graph.constant(1.0 / f64::from(term.power + 1)),
    }
}

fn integrate_with_weight(
    graph: &mut Graph,
    domain: &Domain,
    term: &IntegrandTerm,
    weight: NodeId,
) -> NodeId {
    let s = domain.table(graph, TableKind::NodePosition);
    let quadrature = domain.table(graph, TableKind::NodeWeight);
    let weight = graph.product(&[(quadrature, 1), (s, term.power as i32), (weight, 1)]);
    let modes = Space::Modes(domain.field);
    let nodes = Space::Nodes(domain.field);
    let amplitudes: Vec<Option<NodeId>> = term
        .atoms
        .iter()
        .map(|atom| atom.amplitudes(graph, domain.field))
        .collect();
    let shapes: Vec<NodeId> = term
        .atoms
        .iter()
        .map(|atom| domain.table(graph, TableKind::ShapeAtNodes(atom.derivative())))
        .collect();
    match (amplitudes.as_slice(), shapes.as_slice()) {
        (&[Some(u), Some(v)], &[left, right]) if graph.dependence(weight).is_parameter_only() => {
            let gram = graph.intern(Operation::Gram {
                left,
                weight,
                right,
            });
            let applied = graph.apply(gram, false, v);
            let product = graph.multiply(u, applied);
            graph.sum_over_space(modes, product)
        }
        (&[Some(u), Some(v)], &[left, right]) => {
            let at_nodes = [graph.apply(left, false, u), graph.apply(right, false, v)];
            let product = graph.product(&[(weight, 1), (at_nodes[0], 1), (at_nodes[1], 1)]);
            graph.sum_over_space(nodes, product)
        }
        (&[Some(u), None], &[left, right]) => {
            let at_nodes = graph.apply(left, false, u);
            let product = graph.multiply(weight, at_nodes);
            graph.apply(right, true, product)
        }
        (&[None, Some(v)], &[left, right]) => {
            let at_nodes = graph.apply(right, false, v);
            let product = graph.multiply(weight, at_nodes);
            graph.apply(left, true, product)
        }
        (&[None, None], &[left, right]) => graph.intern(Operation::GramDiagonal {
            left,
            weight,
            right,
        }),
        (&[Some(u)], &[shape]) => {
            let moment = graph.apply(shape, true, weight);
            let product = graph.multiply(moment, u);
            graph.sum_over_space(modes, product)
        }
        (&[None], &[shape]) => graph.apply(shape, true, weight),
        _ => graph.sum_over_space(nodes, weight),
    }
}
