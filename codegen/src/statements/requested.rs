//! Optional stages: bias forces, inverse dynamics, rates of the guards, products with the Jacobian, Jacobians, and
//! the rates in a regime. `reactions` builds the stages of fixed-length steps with frictions and contacts.

use super::body::Body;
use super::emit_error::EmitResult;
use super::expression::Expression;
use super::file::File;
use super::index::Index;
use super::needed::RequiredFunctions;
use super::reactions::build_reaction_stages;
use super::roots::collect_entry_roots;
use super::rows::write_row_values;
use super::stage::{Argument, Outcome, Size, Stage};
use super::stages::{
    RATES_ORDER_DOC, build_guard_values, build_rates_stage, describe_by_positions,
    describe_rate_limits,
};
use super::statement::{Place, Statement};
use crate::program::{
    BlockPlace, Extent, GradientDerivative, Jacobian, JacobianBlock, Products, RowValues, ValueId,
    Variable,
};

/// Builds the requested stages, except Jacobians and rates in a regime.
pub fn build_requested_stages(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Vec<Stage>> {
    let outputs = &file.program.outputs;
    let mut stages = Vec::new();
    if let Some(rows) = &outputs.bias_forces {
        let doc = "Bias forces c - f of M q'' + c = f, in the order of the first half of\n\
                   [`STATE_NAMES`]: the additional forces for zero accelerations.";
        stages.push(build_forces_stage(file, "bias_forces", doc, rows, needed)?);
    }
    if let Some(rows) = &outputs.inverse_dynamics {
        let doc = "Inverse dynamics M a + c - f: the generalised forces needed in addition to\n\
                   those of the model for the accelerations a, in the order of the first half of\n\
                   [`STATE_NAMES`].";
        stages.push(Stage {
            arguments: vec![Argument::Accelerations],
            ..build_forces_stage(file, "inverse_dynamics", doc, rows, needed)?
        });
    }
    if let Some(rates) = &outputs.guard_rates {
        let line = "Rates of the switching surfaces along the motion, with constant inputs.";
        stages.push(build_guard_values(
            file,
            "guard_rates",
            line,
            rates,
            needed,
        )?);
    }
    if let Some(products) = &outputs.products {
        stages.push(build_jacobian_vector_product(file, products, needed)?);
        stages.push(build_vector_jacobian_product(file, products, needed)?);
        stages.push(build_product_by_parameters(file, products, needed)?);
    }
    if let Some(derivative) = &outputs.gradient_derivative {
        stages.push(build_gradient_derivative(file, derivative, needed)?);
    }
    if let Some(known) = &outputs.reactions {
        stages.extend(build_reaction_stages(file, known, needed)?);
    }
    Ok(stages)
}

/// Builds a stage that returns one number for each degree of freedom.
fn build_forces_stage(
    file: &File<'_>,
    name: &'static str,
    doc: &str,
    rows: &RowValues,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let mut body = file.body(&rows.all(), needed)?;
    let computed = body.take_statements();
    write_row_values(&mut body, "values", 0, rows)?;
    Ok(Stage {
        name,
        doc: describe_by_positions(file.program, doc),
        list: Vec::new(),
        arguments: Vec::new(),
        outcome: Outcome::Array("values", Size::DegreesOfFreedom),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

fn build_jacobian_vector_product(
    file: &File<'_>,
    products: &Products<ValueId, RowValues>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let degrees = file.program.degrees_of_freedom();
    let mut body = file.body(&products.forward_roots(), needed)?;
    let computed = body.take_statements();
    let rate = Expression::element("direction", [Index::from_first(degrees, "i")]);
    body.assign_each(degrees, Place::new("product", ["i".into()]), rate);
    write_row_values(&mut body, "product", degrees, &products.forward)?;
    for (index, id) in products.forward_first_order.iter().enumerate() {
        let value = body.scalar(*id)?;
        body.assign(Place::new("product", [(2 * degrees + index).into()]), value);
    }
    Ok(Stage {
        name: "jacobian_vector_product",
        doc: "Product of the Jacobian of the rates by state and inputs with a direction: the derivative\n\
              of the rates along it."
            .to_owned(),
        list: Vec::new(),
        arguments: vec![Argument::Direction, Argument::InputDirection],
        outcome: Outcome::Array("product", Size::States),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

fn build_vector_jacobian_product(
    file: &File<'_>,
    products: &Products<ValueId, RowValues>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let program = file.program;
    let degrees = program.degrees_of_freedom();
    let roots: Vec<ValueId> = products.reverse.iter().map(|(_, id)| *id).collect();
    let mut body = file.body(&roots, needed)?;
    let computed = body.take_statements();
    let weight = Expression::element("weights", ["i".into()]);
    let place = Place::new("product", [Index::from_first(degrees, "i")]);
    body.assign_each(degrees, place, weight);
    let mut inputs = vec![Expression::Number(0.0); program.inputs.len()];
    for (variable, id) in &products.reverse {
        let place = program.variable_place(*variable);
        let at = || Place::new("product", [Index::Number(place)]);
        let each = || Place::new("product", [Index::from_first(place, "i")]);
        match variable {
            Variable::Input(index) => inputs[*index] = body.scalar(*id)?,
            // The product contains only the derivatives with respect to state and inputs.
            Variable::Parameter(_) | Variable::Time => {}
            Variable::Coordinate(_) | Variable::State(_) => {
                let value = body.scalar(*id)?;
                body.assign(at(), value);
            }
            Variable::Rate(_) => {
                let value = body.scalar(*id)?;
                body.push(Statement::add_to(at(), &value));
            }
            Variable::ModeCoordinates(field) => {
                let value = body.element(*id)?;
                body.assign_each(program.fields[*field].order, each(), value);
            }
            Variable::ModeRates(field) => {
                let value = body.element(*id)?;
                let line = Statement::add_to(each(), &value);
                body.push(Statement::loop_over_elements(
                    program.fields[*field].order,
                    line,
                ));
            }
        }
    }
    let mut named = Vec::new();
    for (input, value) in program.inputs.iter().zip(inputs) {
        named.push((file.words.identifier(&input.name)?.to_owned(), value));
    }
    Ok(Stage {
        name: "vector_jacobian_product",
        doc: "Product of weights with the Jacobian of the rates by state and inputs: the gradient of\n\
              the weighted sum of the rates."
            .to_owned(),
        list: Vec::new(),
        arguments: vec![Argument::Weights],
        outcome: Outcome::ArrayAndInputs(named),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

fn build_product_by_parameters(
    file: &File<'_>,
    products: &Products<ValueId, RowValues>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let entries = &products.by_parameters.entries;
    let roots: Vec<ValueId> = entries.iter().map(|entry| entry.value).collect();
    let mut body = file.body(&roots, needed)?;
    let computed = body.take_statements();
    for entry in entries {
        let value = body.scalar(entry.value)?;
        body.assign(Place::new("product", [Index::Number(entry.column)]), value);
    }
    Ok(Stage {
        name: "vector_jacobian_product_by_parameters",
        doc:
            "Product of weights with the Jacobian of the rates by the parameters, in the order of\n\
              [`PARAMETER_NAMES`]: the gradient of the weighted sum of the rates."
                .to_owned(),
        list: Vec::new(),
        arguments: vec![Argument::Weights],
        outcome: Outcome::Array("product", Size::Parameters),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

fn build_gradient_derivative(
    file: &File<'_>,
    derivative: &GradientDerivative<ValueId>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let roots: Vec<ValueId> = derivative.rows.iter().map(|row| row.value).collect();
    let mut body = file.body(&roots, needed)?;
    let computed = body.take_statements();
    for row in &derivative.rows {
        let extent = body.program.value(row.value).extent;
        let value = body.element(row.value)?;
        if row.count == 1 && extent == Extent::Scalar {
            body.assign(Place::new("product", [Index::Number(row.first)]), value);
        } else {
            let place = Place::new("product", [Index::from_first(row.first, "i")]);
            body.assign_each(row.count, place, value);
        }
    }
    Ok(Stage {
        name: "gradient_derivative",
        doc: "Derivative of the gradient of the weighted sum of the rates along a direction: the product\n\
              of its Hessian with it, both by time, state, inputs and parameters in this order."
            .to_owned(),
        list: Vec::new(),
        arguments: vec![Argument::Weights, Argument::PointDirection],
        outcome: Outcome::Array("product", Size::Point),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

/// Builds the stage that writes the structural nonzeros of a Jacobian, row by row.
pub fn build_jacobian_stage(
    file: &File<'_>,
    jacobian: &Jacobian<ValueId>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Stage> {
    let mut body = file.body(&collect_entry_roots(file.program, jacobian), needed)?;
    let computed = body.take_statements();
    for (entry, BlockPlace { start, width }) in jacobian.entries.iter().zip(jacobian.places()) {
        write_entry(&mut body, entry, start, width)?;
    }
    let (what, by) = jacobian
        .name
        .split_once("_by_")
        .unwrap_or((jacobian.name, "state"));
    Ok(Stage {
        name: jacobian.name,
        doc: format!(
            "Jacobian of the {what} by the {by}: structural nonzeros, row by row, at the positions\n\
             given by [`{}`].",
            jacobian.name.to_uppercase()
        ),
        list: Vec::new(),
        arguments: Vec::new(),
        outcome: Outcome::Array("values", Size::Nonzeros(jacobian.name)),
        computed,
        written: body.take_statements(),
        notes: body.take_notes(),
    })
}

/// Writes a block whose first nonzero has index `start`; `width` is the distance from one row to the next.
fn write_entry(
    body: &mut Body<'_>,
    entry: &JacobianBlock<ValueId>,
    start: usize,
    width: usize,
) -> EmitResult<()> {
    let extent = body.program.value(entry.value).extent;
    if let (Extent::Matrix(..), false) = (extent, entry.diagonal) {
        let op = body.program.value(entry.value).op.clone();
        let place = |i: &'static str, j: &'static str| {
            let row = Index::from_first(start, Index::from_multiple(width, i));
            Place::new("values", [row.offset_by(j)])
        };
        let loops = body.block_loops(&op, (entry.rows, entry.columns), &place)?;
        body.push(loops);
        return Ok(());
    }
    let (count, stride) = if entry.columns > 1 && !entry.diagonal {
        (entry.columns, 1)
    } else {
        (entry.rows, width)
    };
    let value = body.element(entry.value)?;
    if count == 1 && extent == Extent::Scalar {
        body.assign(Place::new("values", [Index::Number(start)]), value);
        return Ok(());
    }
    let step = if stride == 1 {
        Index::Variable("i")
    } else {
        Index::from_multiple(stride, "i")
    };
    let place = Place::new("values", [Index::from_first(start, step)]);
    body.assign_each(count, place, value);
    Ok(())
}

/// Builds the stage for the rates in a regime, if requested.
pub fn build_rates_in_regime(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
) -> EmitResult<Option<Stage>> {
    let Some(switches) = &file.program.outputs.regimes else {
        return Ok(None);
    };
    let switches = switches.iter().map(|switch| (switch.value, switch.decided));
    let roots = file.program.rate_roots();
    let body = file.body_in_regime(&roots, needed, switches.collect())?;
    let program = file.program;
    let rates = (&program.accelerations, &program.first_order_rates[..]);
    let doc = format!(
        "Rates of the state in a regime, written to `rates`. They equal those of [`rates_into`] if\n\
         [`regime`] is `REGIME` and half-widths are not negative. Outside the regime its equations\n\
         are continued; on a surface they are those of the regime's side.\n\n{RATES_ORDER_DOC}{}",
        describe_rate_limits(file)
    );
    Ok(Some(Stage {
        arguments: vec![Argument::Regime],
        ..build_rates_stage(body, rates, "rates_in_regime_into", doc)?
    }))
}
