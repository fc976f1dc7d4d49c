//! Formulas for people, as plain text and as LaTeX, straight from the graph.
//!
//! Sums over modes are printed as sums over an index i; a node that the specification
//! names is printed by its name, except where its own formula is asked for.

use model_spec::model::{Function, Model};

use crate::graph::{Argument, Graph, Id, Operation, Shape, Variable};
use crate::table_text;
use crate::tables::Table;

/// How names and operators are written.
pub struct Notation {
    latex: bool,
    parameters: Vec<String>,
    coordinates: Vec<String>,
    inputs: Vec<String>,
    modes: Vec<String>,
}

impl Notation {
    /// Plain text with the specification's names.
    pub fn text(model: &Model) -> Self {
        Self::new(model, false)
    }

    /// LaTeX.
    pub fn latex(model: &Model) -> Self {
        Self::new(model, true)
    }

    fn new(model: &Model, latex: bool) -> Self {
        let write = |name: &String| {
            if latex {
                latex_name(name)
            } else {
                name.clone()
            }
        };
        Self {
            latex,
            parameters: model.parameters.iter().map(|p| write(&p.name)).collect(),
            coordinates: model.coordinates.iter().map(|c| write(&c.name)).collect(),
            inputs: model.inputs.iter().map(|i| write(&i.name)).collect(),
            modes: model.fields.iter().map(|f| write(&f.coordinates)).collect(),
        }
    }

    /// A name of the specification; a rate ends in `_dot`, an acceleration in `_ddot`.
    pub fn name(&self, name: &str) -> String {
        if let Some(stem) = name.strip_suffix("_dot") {
            return self.rate(&self.name(stem));
        }
        if let Some(stem) = name.strip_suffix("_ddot") {
            return self.acceleration(&self.name(stem));
        }
        if self.latex {
            latex_name(name)
        } else {
            name.to_owned()
        }
    }

    fn rate(&self, name: &str) -> String {
        if self.latex {
            format!("\\dot{{{name}}}")
        } else {
            format!("dot({name})")
        }
    }

    /// The second derivative by time of a coordinate, or of a field's mode coordinates.
    pub fn acceleration(&self, name: &str) -> String {
        if self.latex {
            format!("\\ddot{{{name}}}")
        } else {
            format!("ddot({name})")
        }
    }

    /// A coordinate.
    pub fn coordinate(&self, index: usize) -> &str {
        &self.coordinates[index]
    }

    /// A field's mode coordinates with the index i.
    pub fn mode(&self, field: usize) -> String {
        format!("{}_i", self.modes[field])
    }
}

const GREEK: [&str; 12] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "eta", "theta", "kappa", "mu", "rho", "phi",
    "omega",
];

/// `theta_s` as `\theta_{s}`; further underscores become commas.
fn latex_name(name: &str) -> String {
    let mut parts = name.split('_');
    let head = parts.next().unwrap_or_default();
    let head = match head {
        "dtheta" => "\\Delta\\theta".to_owned(),
        _ if GREEK.contains(&head) => format!("\\{head}"),
        _ if head.len() > 1 => format!("\\mathrm{{{head}}}"),
        _ => head.to_owned(),
    };
    let rest: Vec<String> = parts
        .map(|part| {
            if GREEK.contains(&part) {
                format!("\\{part}")
            } else {
                part.to_owned()
            }
        })
        .collect();
    if rest.is_empty() {
        head
    } else {
        format!("{head}_{{{}}}", rest.join(","))
    }
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
}

/// The formula of a node, whether or not it has a name.
pub fn formula(graph: &Graph, notation: &Notation, id: Id) -> String {
    Printer { graph, notation }.operation(id, Level::Sum)
}

/// The node by its name, or its formula.
pub fn expression(graph: &Graph, notation: &Notation, id: Id) -> String {
    Printer { graph, notation }.node(id, Level::Sum)
}

struct Printer<'a> {
    graph: &'a Graph,
    notation: &'a Notation,
}

impl Printer<'_> {
    fn node(&self, id: Id, level: Level) -> String {
        match self.graph.name(id) {
            Some(name) => self.indexed(self.notation.name(name), id),
            None => self.operation(id, level),
        }
    }

    fn indexed(&self, name: String, id: Id) -> String {
        match (self.graph.shape(id), self.notation.latex) {
            (Shape::Scalar, _) => name,
            (Shape::Vector(_), _) => format!("{name}_i"),
            (Shape::Matrix(..), false) => format!("{name}_ij"),
            (Shape::Matrix(..), true) => format!("{name}_{{ij}}"),
        }
    }

    fn operation(&self, id: Id, level: Level) -> String {
        let notation = self.notation;
        match self.graph.operation(id) {
            Operation::Constant(bits) => number(bits.value()),
            Operation::Parameter(index) => notation.parameters[*index].clone(),
            Operation::Coordinate(index) => notation.coordinates[*index].clone(),
            Operation::Rate(index) => notation.rate(&notation.coordinates[*index]),
            Operation::Input(index) => notation.inputs[*index].clone(),
            Operation::Time => "t".to_owned(),
            Operation::ModeCoordinates(field) => notation.mode(*field),
            Operation::ModeRates(field) => notation.rate(&notation.mode(*field)),
            Operation::Argument(argument, variable) => {
                let word = match argument {
                    Argument::Accelerations => "acceleration",
                    Argument::Direction => "direction",
                    Argument::Weights => "weight",
                };
                let name = match *variable {
                    Variable::Coordinate(index) => notation.coordinates[index].clone(),
                    Variable::Rate(index) => notation.rate(&notation.coordinates[index]),
                    Variable::ModeCoordinates(field) => notation.mode(field),
                    Variable::ModeRates(field) => notation.rate(&notation.mode(field)),
                    Variable::Input(index) => notation.inputs[index].clone(),
                };
                format!("{word}({name})")
            }
            Operation::Table(index) => self.table(self.graph.table(*index)),
            Operation::Sum(terms) => {
                parenthesised(self.sum(terms), level > Level::Sum, notation.latex)
            }
            Operation::Product(factors) => self.product(factors, level),
            Operation::Call(function, arguments) => self.call(*function, arguments),
            Operation::Power(base, exponent) => {
                let base = self.node(*base, Level::Power);
                let exponent = self.node(*exponent, Level::Sum);
                if notation.latex {
                    format!("{base}^{{{exponent}}}")
                } else {
                    format!("{base}^({exponent})")
                }
            }
            Operation::Select {
                a,
                b,
                then,
                otherwise,
            } => {
                let [a, b, then, otherwise] =
                    [a, b, then, otherwise].map(|id| self.node(*id, Level::Sum));
                if notation.latex {
                    format!(
                        "\\begin{{cases}}{then} & {a} > {b}\\\\ {otherwise} & \\text{{else}}\\end{{cases}}"
                    )
                } else {
                    format!("if({a} > {b}, {then}, {otherwise})")
                }
            }
            Operation::Total(a) => {
                let inner = self.node(*a, Level::Product);
                if notation.latex {
                    format!("\\sum_{{i=1}}^{{S}} {inner}")
                } else {
                    format!("sum_i({inner})")
                }
            }
            other => self.matrix_operation(other),
        }
    }

    fn matrix_operation(&self, operation: &Operation) -> String {
        let node = |id: &Id| self.node(*id, Level::Sum);
        match operation {
            Operation::Apply { matrix, vector, .. } => {
                format!("({} . {})_i", node(matrix), node(vector))
            }
            Operation::Gram {
                left,
                weight,
                right,
            } => format!("gram({}, {}, {})", node(left), node(weight), node(right)),
            Operation::GramDiagonal {
                left,
                weight,
                right,
            } => format!("gram_ii({}, {}, {})", node(left), node(weight), node(right)),
            Operation::Assemble(assembly) => {
                let mut parts = Vec::new();
                if let Some(diagonal) = assembly.diagonal {
                    parts.push(format!("diag({})", node(&diagonal)));
                }
                for (u, v) in &assembly.outer {
                    parts.push(format!("[{}]_i [{}]_j", node(u), node(v)));
                }
                for m in &assembly.matrices {
                    parts.push(format!(
                        "[{}]_i {} [{}]_j",
                        node(&m.row),
                        node(&m.matrix),
                        node(&m.column)
                    ));
                }
                parts.join(" + ")
            }
            Operation::Cholesky(matrix) => format!("cholesky({})", node(matrix)),
            Operation::CholeskySolve(factor, vector) => {
                format!("solve({}, {})", node(factor), node(vector))
            }
            Operation::PivotReciprocal(pivot) if self.notation.latex => {
                format!("\\frac{{1}}{{{}}}", node(pivot))
            }
            Operation::PivotReciprocal(pivot) => format!("1/({})", node(pivot)),
            _ => String::new(),
        }
    }

    fn sum(&self, terms: &[(crate::graph::Bits, Id)]) -> String {
        let mut text = String::new();
        for (place, (factor, id)) in terms.iter().enumerate() {
            let factor = factor.value();
            let sign = match (factor < 0.0, place) {
                (true, 0) => "-",
                (false, 0) => "",
                (true, _) => " - ",
                (false, _) => " + ",
            };
            text.push_str(sign);
            let magnitude = factor.abs();
            let level = if magnitude == 1.0 && factor > 0.0 {
                Level::Sum
            } else {
                Level::Product
            };
            let inner = self.node(*id, level);
            if magnitude == 1.0 {
                text.push_str(&inner);
            } else if self.graph.as_constant(*id).is_some() {
                text.push_str(&number(magnitude));
            } else {
                let number = factor_number(magnitude, self.notation.latex);
                text.push_str(&format!("{number}{}{inner}", self.times()));
            }
        }
        text
    }

    fn times(&self) -> &'static str {
        if self.notation.latex { "\\," } else { "*" }
    }

    fn product(&self, factors: &[(Id, i32)], level: Level) -> String {
        let factors: Vec<(Id, i32)> = factors
            .iter()
            .map(|&(id, exponent)| match self.graph.operation(id) {
                Operation::PivotReciprocal(pivot) => (*pivot, -exponent),
                _ => (id, exponent),
            })
            .collect();
        let side = |above: bool| {
            factors
                .iter()
                .filter(|(_, exponent)| (*exponent > 0) == above)
                .map(|(id, exponent)| self.factor(*id, exponent.abs()))
                .collect::<Vec<_>>()
        };
        let (above, below) = (side(true), side(false));
        let numerator = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join(self.times())
        };
        if below.is_empty() {
            return parenthesised(numerator, level > Level::Product, self.notation.latex);
        }
        if self.notation.latex {
            return format!("\\frac{{{numerator}}}{{{}}}", below.join(self.times()));
        }
        let denominator = below.join("*");
        let text = if below.len() > 1 {
            format!("{numerator}/({denominator})")
        } else {
            format!("{numerator}/{denominator}")
        };
        parenthesised(text, level > Level::Product, false)
    }

    fn factor(&self, id: Id, exponent: i32) -> String {
        if exponent == 1 {
            return self.node(id, Level::Product);
        }
        let base = self.node(id, Level::Power);
        if self.notation.latex {
            format!("{{{base}}}^{{{exponent}}}")
        } else {
            format!("{base}^{exponent}")
        }
    }

    fn call(&self, function: Function, arguments: &[Id]) -> String {
        let arguments: Vec<String> = arguments
            .iter()
            .map(|a| self.node(*a, Level::Sum))
            .collect();
        let list = arguments.join(", ");
        if !self.notation.latex {
            return format!("{}({list})", function.name());
        }
        match (function, arguments.as_slice()) {
            (Function::Deadzone, _) => format!("f_k({list})"),
            (Function::Contact, [p, b]) => format!("\\left[|{p}| > {b}\\right]"),
            (Function::Above, [p]) => format!("\\left[{p} > 0\\right]"),
            (Function::Sqrt, [a]) => format!("\\sqrt{{{a}}}"),
            (Function::Abs, [a]) => format!("\\left|{a}\\right|"),
            (Function::Exp, [a]) => format!("e^{{{a}}}"),
            (
                Function::Sin
                | Function::Cos
                | Function::Tan
                | Function::Sinh
                | Function::Cosh
                | Function::Tanh
                | Function::Ln
                | Function::Min
                | Function::Max,
                _,
            ) => format!("\\{}\\left({list}\\right)", function.name()),
            _ => format!("\\operatorname{{{}}}\\left({list}\\right)", function.name()),
        }
    }

    fn table(&self, table: &Table) -> String {
        if self.notation.latex {
            table_text::latex(table.kind)
        } else {
            table_text::plain(table.kind)
        }
    }
}

fn parenthesised(text: String, needed: bool, latex: bool) -> String {
    match (needed, latex) {
        (false, _) => text,
        (true, false) => format!("({text})"),
        (true, true) => format!("\\left({text}\\right)"),
    }
}

/// A magnitude in front of a product: a small fraction where it is one exactly.
fn factor_number(value: f64, latex: bool) -> String {
    for denominator in 2..=12_u32 {
        let numerator = value * f64::from(denominator);
        let exact = numerator.round() / f64::from(denominator) == value;
        if exact && value.fract() != 0.0 && (1.0..=1000.0).contains(&numerator.round()) {
            let numerator = numerator.round();
            return if latex {
                format!("\\tfrac{{{numerator}}}{{{denominator}}}")
            } else {
                format!("{numerator}/{denominator}")
            };
        }
    }
    number(value)
}

fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude != 0.0 && !(1e-4..1e6).contains(&magnitude) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}
