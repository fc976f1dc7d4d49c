//! Impacts: rates of distances, and the effect of impulses on the rates.
//!
//! An impulse P at the distance g(q, t) changes the rates by D P with D = M^-1 A^T and A = dg/dq, and the rate of a
//! distance g_i by A_i D_j P_j; A_i D_j is Delassus' matrix (B. Brogliato, *Nonsmooth Mechanics*, chapter 5). A force
//! lambda at a closed contact changes the accelerations by the same column: a = a_0 + D lambda. The columns D are
//! solved for like the accelerations; a field costs O(S) operations. In a model with constraints, impulses do not
//! violate the constraints. The simulator finds the times and the results of impacts.
//!
//! For a tangential impulse of a contact with the slip s(q, q', t), which is linear in the rates, A is ds/dq'.

use eomgen_model_spec::model::{self, Model};

use crate::mechanics::constraints::Constraints;
use crate::mechanics::impact::{Friction, Impact};
use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::solve::solve;
use crate::mechanics::translate::{DeriveError, Derived, Translator, along_motion, explicit_rate};
use crate::mechanics::workless_rates::{RestTerms, set_rates_to_zero};
use crate::symbolic::graph::{Dependence, NodeId};

pub(crate) fn impacts(
    translator: &mut Translator,
    variables: &Variables,
    (kinetic, mass, constraints): (NodeId, &MassMatrix, &Constraints),
    accelerations: &RowNodes,
) -> Derived<Vec<Impact<NodeId, RowNodes>>> {
    let model: &Model = translator.model;
    let mut found = Vec::with_capacity(model.impacts.len());
    let mut gradients = Vec::with_capacity(model.impacts.len());
    let zero = translator.graph.zero();
    let along_constraints = Constraints {
        right: vec![zero; constraints.rows.len()],
        ..constraints.clone()
    };
    if model.impacts.is_empty() {
        return Ok(found);
    }
    let rest = RestTerms::derive(
        &mut translator.graph,
        model,
        variables,
        kinetic,
        constraints,
    );
    for impact in &model.impacts {
        let distance = translator.node(&impact.when)?;
        let restitution = translator.node(&impact.restitution)?;
        let graph = &mut translator.graph;
        let gradient = variables.gradient(graph, distance, GradientBy::Coordinates);
        // At order 0, a distance of a field depends on no mode.
        let is_rigid = model.fields.is_empty();
        if is_rigid && gradient.nodes().iter().all(|entry| graph.is_zero(*entry)) {
            return Err(describe_constant_distance(impact));
        }
        let rate = along_motion(graph, distance);
        let of_rates = along_motion(graph, rate);
        let of_accelerations = gradient.dot(graph, accelerations);
        let (solved, multipliers) = solve(graph, mass, &gradient, &along_constraints);
        let own_rate = explicit_rate(graph, distance);
        let effect = (&solved.rows, &multipliers[..]);
        found.push(Impact {
            distance,
            rate,
            workless_rate: rest.workless_rate(graph, own_rate, effect),
            acceleration: graph.add(of_rates, of_accelerations),
            restitution,
            row: gradient.clone(),
            column: solved.rows,
            delassus: Vec::new(),
            friction: None,
        });
        gradients.push(gradient);
    }
    let mut tangents = Vec::new();
    for (impact, own) in model.impacts.iter().zip(&mut found) {
        let Some(friction) = &impact.friction else {
            continue;
        };
        let coefficient = translator.node(&friction.coefficient)?;
        let slip = translator.node(&friction.slip)?;
        let graph = &mut translator.graph;
        let gradient = variables.gradient(graph, slip, GradientBy::Rates);
        let moves = |entry: &NodeId| graph.dependence(*entry).has(Dependence::RATE);
        if gradient.nodes().iter().any(moves) {
            return Err(describe_nonlinear_slip(impact, friction));
        }
        let of_rates = along_motion(graph, slip);
        let of_accelerations = gradient.dot(graph, accelerations);
        let (solved, multipliers) = solve(graph, mass, &gradient, &along_constraints);
        let own_slip = set_rates_to_zero(graph, slip);
        let effect = (&solved.rows, &multipliers[..]);
        own.friction = Some(Friction {
            coefficient,
            slip,
            workless_slip: rest.workless_rate(graph, own_slip, effect),
            acceleration: graph.add(of_rates, of_accelerations),
            column: solved.rows,
            delassus: Vec::new(),
        });
        tangents.push(gradient);
    }
    let normal = found.iter().map(|impact| impact.column.clone());
    let tangential = found.iter().filter_map(|impact| impact.friction.as_ref());
    let tangential = tangential.map(|friction| friction.column.clone());
    let columns: Vec<RowNodes> = normal.chain(tangential).collect();
    let graph = &mut translator.graph;
    let mut changes = |gradient: &RowNodes| -> Vec<NodeId> {
        let products = columns.iter().map(|column| gradient.dot(graph, column));
        products.collect()
    };
    for (impact, gradient) in found.iter_mut().zip(&gradients) {
        impact.delassus = changes(gradient);
    }
    let frictions = found
        .iter_mut()
        .filter_map(|impact| impact.friction.as_mut());
    for (friction, gradient) in frictions.zip(&tangents) {
        friction.delassus = changes(gradient);
    }
    Ok(found)
}

/// Returns the error for a slip that is not linear in the rates.
pub(crate) fn describe_nonlinear_slip(
    impact: &model::Impact,
    friction: &model::ContactFriction,
) -> DeriveError {
    DeriveError {
        span: friction.slip.span,
        message: format!("the slip of `{}` is not linear in the rates", impact.name),
        help: Some("give a velocity with a sign, for example dot(x) - r*dot(phi)".into()),
    }
}

/// Returns the error for a distance that depends on no coordinate.
pub(crate) fn describe_constant_distance(impact: &model::Impact) -> DeriveError {
    DeriveError {
        span: impact.when.span,
        message: format!(
            "the distance of the impact `{}` depends on no coordinate",
            impact.name
        ),
        help: Some(
            "write `when` as an expression of coordinates; an impact occurs when it falls through zero".into(),
        ),
    }
}
