//! Emitted expressions with their precedence, so that parentheses stand only where the
//! order of evaluation needs them, marked for their layout.

use super::layout::{
    BLOCK, BLOCK_OUT, BRACE, BRACE_OUT, CLOSE, COMMA_OUT, FIRM, FLOW, FLOW_EVEN, FLOW_OUT, SPACE,
    SPACE_OUT, ZERO,
};

/// How tightly an expression holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    And,
    Sum,
    Product,
    Negation,
    Atom,
}

/// An emitted expression.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    level: Level,
    /// How many operations stand in it.
    pub size: usize,
}

impl std::fmt::Display for Expression {
    /// Without parentheses around it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

/// An expression with the parentheses that its place needs.
struct At<'a>(&'a Expression, Level);

impl std::fmt::Display for At<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self(expression, level) = *self;
        if expression.level < level {
            write!(f, "({expression})")
        } else {
            write!(f, "{expression}")
        }
    }
}

impl Expression {
    /// A name, an element, a call or a literal without sign.
    pub fn atom(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            level: Level::Atom,
            size: 0,
        }
    }

    /// A number of the scalar type.
    pub fn number(value: f64) -> Self {
        Self::converted(super::literals::number(value))
    }

    /// An `f64`, a literal or the entry of a table, as a number of the scalar type.
    pub fn converted(number: impl Into<String>) -> Self {
        Self {
            size: 0,
            ..Self::call("T::number", &[Self::atom(number)])
        }
    }

    /// Element `index` of an array.
    pub fn element(array: &str, index: &str) -> Self {
        Self::atom(format!("{array}[{index}]"))
    }

    /// A field of a struct.
    pub fn field(of: &str, name: &str) -> Self {
        Self::atom(format!("{BLOCK}{BLOCK_OUT}{of}{CLOSE}{ZERO}.{name}{CLOSE}"))
    }

    fn new(text: String, level: Level, parts: &[&Self]) -> Self {
        Self {
            text,
            level,
            size: 1 + parts.iter().map(|part| part.size).sum::<usize>(),
        }
    }

    fn binary(
        operator: &str,
        level: Level,
        (a, left): (&Self, Level),
        (b, right): (&Self, Level),
    ) -> Self {
        let text = infix(operator, At(a, left), At(b, right));
        Self::new(text, level, &[a, b])
    }

    /// a + b
    pub fn add(a: &Self, b: &Self) -> Self {
        Self::binary("+", Level::Sum, (a, Level::Sum), (b, Level::Product))
    }

    /// a - b
    pub fn subtract(a: &Self, b: &Self) -> Self {
        Self::binary("-", Level::Sum, (a, Level::Sum), (b, Level::Product))
    }

    /// a b
    pub fn multiply(a: &Self, b: &Self) -> Self {
        Self::binary(
            "*",
            Level::Product,
            (a, Level::Product),
            (b, Level::Negation),
        )
    }

    /// a / b
    pub fn divide(a: &Self, b: &Self) -> Self {
        Self::binary(
            "/",
            Level::Product,
            (a, Level::Product),
            (b, Level::Negation),
        )
    }

    /// `a && b`
    pub fn and(a: &Self, b: &Self) -> Self {
        Self::binary("&&", Level::And, (a, Level::And), (b, Level::Atom))
    }

    /// -a
    pub fn negate(a: &Self) -> Self {
        Self::new(format!("-{}", At(a, Level::Atom)), Level::Negation, &[a])
    }

    /// A call of a function.
    pub fn call(name: &str, arguments: &[Self]) -> Self {
        let parts: Vec<&Self> = arguments.iter().collect();
        let text = format!(
            "{name}({BLOCK}{ZERO}{}{COMMA_OUT}{CLOSE})",
            listed(arguments)
        );
        Self::new(text, Level::Atom, &parts)
    }

    /// The call of a function that sums this many elements i. The number goes in the type of
    /// an array, where the function knows it as a constant.
    pub fn sum(function: &str, length: usize, element: &Self) -> Self {
        let body = if element.is_call() {
            element.text.clone()
        } else {
            format!("{BLOCK}{BRACE}{element}{BRACE_OUT}{CLOSE}")
        };
        let closure = format!("{FLOW_EVEN}{BLOCK}|{ZERO}i|{SPACE_OUT}{CLOSE}{FIRM}{body}{CLOSE}");
        let count = Self::atom(format!("[(); {length}]"));
        Self::call(function, &[count, Self::atom(closure)])
    }

    fn is_call(&self) -> bool {
        self.level == Level::Atom && self.text.ends_with(')')
    }
}

/// Two operands with an operator between them, broken before the operator.
pub fn infix(operator: &str, a: impl std::fmt::Display, b: impl std::fmt::Display) -> String {
    format!("{FLOW}{FLOW_OUT}{a}{CLOSE}{SPACE}{operator} {b}{CLOSE}")
}

/// An assignment to `target`, which may declare it.
pub fn assignment(target: &str, value: impl std::fmt::Display) -> String {
    format!("{target} = {FIRM}{value};")
}

/// Elements of an array or of a call, each on a line of its own if they do not fit on one.
pub fn listed<T: std::fmt::Display>(items: &[T]) -> String {
    let mut text = String::new();
    for (place, item) in items.iter().enumerate() {
        if place > 0 {
            text.push(',');
            text.push(SPACE);
        }
        text.push_str(&item.to_string());
    }
    text
}

/// An array of these elements.
pub fn array<T: std::fmt::Display>(items: &[T]) -> String {
    if items.is_empty() {
        return "[]".to_owned();
    }
    format!("[{BLOCK}{ZERO}{}{COMMA_OUT}{CLOSE}]", listed(items))
}

/// A reference to an array.
pub fn reference(array: String) -> Expression {
    Expression::atom(format!("&{array}"))
}
