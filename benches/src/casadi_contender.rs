//! Writes the energies of a model as a Python module with CasADi expressions.

use std::fmt::Write;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::ids::{DefinitionId, ParameterId};
use eomgen_model_spec::model::{Expr, ExprKind, Model, ParameterValue};

/// Returns the text of the module; `None` if the model contains an expression that rigid trees do not need.
pub fn definitions(model: &Model) -> Option<String> {
    let mut text = String::from("import casadi as ca\n\n\ndef energies():\n");
    let degrees = model.coordinates.len();
    _ = writeln!(
        text,
        "    q, v = ca.SX.sym(\"q\", {degrees}), ca.SX.sym(\"v\", {degrees})"
    );
    let inputs = model.inputs.len().max(1);
    _ = writeln!(
        text,
        "    u, given = ca.SX.sym(\"u\", {inputs}), []\n    p, d = {{}}, {{}}"
    );
    text += "    def dot(x):\n        return ca.jtimes(x, q, v)\n";
    for (index, parameter) in ParameterId::first(model.parameters.len()).zip(&model.parameters) {
        if let ParameterValue::Number(_) = parameter.value {
            let place = index.index();
            _ = writeln!(
                text,
                "    p[{place}] = ca.SX.sym(\"p{place}\")\n    given.append(p[{place}])"
            );
        }
    }
    for index in &model.parameter_order {
        if let ParameterValue::Expression(value) = &model.parameters[*index].value {
            _ = writeln!(text, "    p[{}] = {}", index.index(), python(value)?);
        }
    }
    for index in &model.definition_order {
        let value = python(&model.definitions[*index].value)?;
        _ = writeln!(
            text,
            "    d[{}] = ca.SX({value})",
            DefinitionId::index(*index)
        );
    }
    for (name, terms) in [("T", &model.kinetic), ("V", &model.potential)] {
        _ = writeln!(text, "    {name} = 0");
        for term in terms {
            _ = writeln!(text, "    {name} += {}", python(&term.value)?);
        }
    }
    _ = writeln!(text, "    Q = ca.SX.zeros({degrees})");
    for force in &model.forces {
        let (on, value) = (python(&force.on)?, python(&force.value)?);
        _ = writeln!(text, "    Q += ca.gradient({on}, q) * {value}");
    }
    text += "    return q, v, u, ca.vertcat(*given), T, V, Q\n";
    Some(text)
}

fn python(expr: &Expr) -> Option<String> {
    Some(match &expr.kind {
        ExprKind::Number(value) => format!("{value:?}"),
        ExprKind::Pi => "ca.pi".to_owned(),
        ExprKind::Parameter(index) => format!("p[{}]", index.index()),
        ExprKind::Coordinate(index) => format!("q[{}]", index.index()),
        ExprKind::Input(index) => format!("u[{}]", index.index()),
        ExprKind::Definition(index) => format!("d[{}]", index.index()),
        ExprKind::Dot(operand) => format!("dot({})", python(operand)?),
        ExprKind::Negate(operand) => format!("(-{})", python(operand)?),
        ExprKind::Call(function, arguments) => {
            let arguments: Option<Vec<String>> = arguments.iter().map(python).collect();
            format!("ca.{}({})", function.name(), arguments?.join(", "))
        }
        ExprKind::Binary(operator, left, right) => {
            let sign = match operator {
                BinaryOperator::Add => "+",
                BinaryOperator::Subtract => "-",
                BinaryOperator::Multiply => "*",
                BinaryOperator::Divide => "/",
                BinaryOperator::Power => "**",
            };
            format!("({} {sign} {})", python(left)?, python(right)?)
        }
        _ => return None,
    })
}
