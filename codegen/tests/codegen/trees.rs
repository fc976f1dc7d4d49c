//! Random expressions as trees, and their text in a specification.

use std::fmt::Write;

use proptest::prelude::*;

/// Expression tree.
#[derive(Clone, Debug)]
pub enum Tree {
    /// One of x, y, z.
    Coordinate(usize),
    /// One of a, b.
    Parameter(usize),
    Number(f64),
    Unary(&'static str, Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Integer(Box<Tree>, i32),
    /// (1 + base^2)^exponent
    Power(Box<Tree>, Box<Tree>),
}

/// Names of the coordinates.
pub const COORDINATES: [&str; 3] = ["x", "y", "z"];
/// Names and values of the parameters.
pub const PARAMETERS: [(&str, f64); 2] = [("a", 1.7), ("b", -0.6)];

/// Generates trees of up to forty nodes.
pub fn trees() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        4 => (0..3_usize).prop_map(Tree::Coordinate),
        1 => (0..2_usize).prop_map(Tree::Parameter),
        2 => prop::sample::select(vec![0.0, 1.0, 2.0, 0.5, 3.0, 0.1]).prop_map(Tree::Number),
    ];
    leaf.prop_recursive(6, 40, 2, |inner| {
        let unary = prop::sample::select(vec![
            "-", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln",
            "sqrt", "abs", "sign", "above",
        ]);
        let binary = prop::sample::select(vec![
            "+", "+", "-", "-", "*", "*", "*", "/", "min", "max", "atan2", "deadzone", "contact",
        ]);
        let boxed = inner.clone().prop_map(Box::new);
        prop_oneof![
            2 => (unary, boxed.clone()).prop_map(|(f, a)| Tree::Unary(f, a)),
            4 => (binary, boxed.clone(), boxed.clone()).prop_map(|(f, a, b)| Tree::Binary(f, a, b)),
            1 => (boxed.clone(), -3..5_i32).prop_map(|(a, n)| Tree::Integer(a, n)),
            1 => (boxed.clone(), prop::sample::select(vec![0.5, 1.5, -0.5, 2.25]))
                .prop_map(|(a, e)| Tree::Power(a, Box::new(Tree::Number(e)))),
            1 => (boxed.clone(), boxed).prop_map(|(a, b)| Tree::Power(a, b)),
        ]
    })
}

impl Tree {
    /// Writes the tree. If a function has a limited domain, its argument is mapped to this domain, for example
    /// asin(u/(2 + abs(u))).
    pub fn write(&self, out: &mut String) {
        let written = |tree: &Self| {
            let mut text = String::new();
            tree.write(&mut text);
            text
        };
        match self {
            Self::Coordinate(index) => out.push_str(COORDINATES[*index]),
            Self::Parameter(index) => out.push_str(PARAMETERS[*index].0),
            Self::Number(value) => write!(out, "{value}").unwrap(),
            Self::Unary(function, a) => {
                let a = written(a);
                match *function {
                    "-" => write!(out, "(-{a})").unwrap(),
                    "asin" | "acos" => write!(out, "{function}({a}/(2 + abs({a})))").unwrap(),
                    "ln" | "sqrt" => write!(out, "{function}(1 + {a}^2)").unwrap(),
                    _ => write!(out, "{function}({a})").unwrap(),
                }
            }
            Self::Binary(function, a, b) => {
                let (a, b) = (written(a), written(b));
                match *function {
                    "+" | "-" | "*" => write!(out, "({a} {function} {b})").unwrap(),
                    "/" => write!(out, "({a}/(2 + sin({b})))").unwrap(),
                    "deadzone" | "contact" => write!(out, "{function}({a}, abs({b}))").unwrap(),
                    _ => write!(out, "{function}({a}, {b})").unwrap(),
                }
            }
            Self::Integer(a, n) if *n < 0 => {
                write!(out, "((2 + cos({}))^({n}))", written(a)).unwrap()
            }
            Self::Integer(a, n) => write!(out, "({}^{n})", written(a)).unwrap(),
            Self::Power(a, e) => write!(out, "((1 + {}^2)^({}))", written(a), written(e)).unwrap(),
        }
    }
}
