//! Reserved words of the language: functions, special forms, constants and keywords.

use crate::model::Function;

use Property::{Cut, Even, Kink, Odd, Step};

/// Property of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Property {
    /// f(-x) = f(x).
    Even,
    /// f(-x) = -f(x).
    Odd,
    /// Continuous, with a kink at a switching surface.
    Kink,
    /// Jump at a switching surface; constant on each side.
    Step,
    /// Jump at the branch cut of an angle.
    Cut,
}

/// Name of a function in a specification, function, names of its arguments, and its properties.
type Entry = (
    &'static str,
    Function,
    &'static [&'static str],
    &'static [Property],
);

const FUNCTIONS: [Entry; 20] = [
    ("sin", Function::Sin, &["x"], &[Odd]),
    ("cos", Function::Cos, &["x"], &[Even]),
    ("tan", Function::Tan, &["x"], &[Odd]),
    ("asin", Function::Asin, &["x"], &[Odd]),
    ("acos", Function::Acos, &["x"], &[]),
    ("atan", Function::Atan, &["x"], &[Odd]),
    ("atan2", Function::Atan2, &["y", "x"], &[Cut]),
    ("sinh", Function::Sinh, &["x"], &[Odd]),
    ("cosh", Function::Cosh, &["x"], &[Even]),
    ("tanh", Function::Tanh, &["x"], &[Odd]),
    ("exp", Function::Exp, &["x"], &[]),
    ("ln", Function::Ln, &["x"], &[]),
    ("sqrt", Function::Sqrt, &["x"], &[]),
    ("abs", Function::Abs, &["x"], &[Even, Kink]),
    ("sign", Function::Sign, &["x"], &[Odd, Step]),
    ("min", Function::Min, &["a", "b"], &[Kink]),
    ("max", Function::Max, &["a", "b"], &[Kink]),
    ("deadzone", Function::Deadzone, &["p", "b"], &[Kink]),
    ("contact", Function::Contact, &["p", "b"], &[Step]),
    ("above", Function::Above, &["p"], &[Step]),
];

/// Forms that are not functions of scalars.
pub const FORMS: [&str; 5] = ["dot", "diff", "at", "integral", "sum"];

/// Functions of vectors and rotations. They are expanded to scalars before names are resolved, so their names are not
/// reserved.
pub const VECTOR_FUNCTIONS: [&str; 7] = [
    "cross",
    "norm",
    "rotation",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "transpose",
];

/// Constants and quantities of every model.
const CONSTANTS: [&str; 4] = ["t", "pi", "energy", "power"];

/// Keywords of Rust and C99. Names must differ from them because they become identifiers of emitted code.
const KEYWORDS: [&str; 73] = [
    "abstract", "as", "async", "auto", "await", "become", "box", "break", "case", "char", "const",
    "continue", "crate", "default", "do", "double", "dyn", "else", "enum", "extern", "false",
    "final", "float", "fn", "for", "gen", "goto", "if", "impl", "in", "inline", "int", "let",
    "long", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "register", "restrict", "return", "self", "Self", "short", "signed", "sizeof", "static",
    "struct", "super", "switch", "trait", "true", "try", "type", "typedef", "typeof", "union",
    "unsafe", "unsigned", "unsized", "use", "virtual", "void", "volatile", "where", "while",
    "yield",
];

impl Function {
    /// Returns the function of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        let found = FUNCTIONS.iter().find(|(known, ..)| *known == name);
        found.map(|(_, function, ..)| *function)
    }

    /// Returns the name in a specification.
    pub fn name(self) -> &'static str {
        self.entry().map_or("", |(name, ..)| name)
    }

    /// Returns the names of the arguments.
    pub fn arguments(self) -> &'static [&'static str] {
        self.entry().map_or(&[], |(_, _, arguments, _)| arguments)
    }

    /// Returns true if the function has a switching surface.
    pub fn has_switches(self) -> bool {
        self.has(Kink) || self.has(Step)
    }

    /// Returns true if the value of the function jumps at its switching surface or at the branch cut of an angle.
    pub fn has_jump(self) -> bool {
        self.has(Step) || self.has(Cut)
    }

    /// Returns true if the function jumps and is constant elsewhere.
    pub fn is_step(self) -> bool {
        self.has(Step)
    }

    /// Returns true if f(-x) = f(x).
    pub fn is_even(self) -> bool {
        self.has(Even)
    }

    /// Returns true if f(-x) = -f(x).
    pub fn is_odd(self) -> bool {
        self.has(Odd)
    }

    fn has(self, property: Property) -> bool {
        self.entry()
            .is_some_and(|(.., properties)| properties.contains(&property))
    }

    fn entry(self) -> Option<&'static Entry> {
        FUNCTIONS.iter().find(|(_, function, ..)| *function == self)
    }
}

pub fn callable_names() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.iter().map(|(name, ..)| *name).chain(FORMS)
}

/// Returns the reason why a word is reserved, worded to follow the word in a sentence.
pub fn reservation_reason(word: &str) -> Option<&'static str> {
    if callable_names().any(|name| name == word) {
        Some("is a function of the language")
    } else if CONSTANTS.contains(&word) {
        Some("is a built-in quantity of every model")
    } else if KEYWORDS.contains(&word) {
        Some("is a keyword of Rust or C")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::function::call;

    #[test]
    fn every_function_is_found_by_name() {
        for (name, function, arguments, _) in FUNCTIONS {
            assert_eq!(Function::from_name(name), Some(function));
            assert_eq!((function.name(), function.arguments()), (name, arguments));
            assert!(reservation_reason(name).is_some());
        }
        assert_eq!(Function::from_name("dot"), None);
    }

    #[test]
    fn properties_agree_with_values() {
        for (name, function, arguments, _) in FUNCTIONS {
            let value = |x: f64| call(function, x, 0.25);
            let holds = |is_equal: &dyn Fn(f64) -> bool| [0.1, 0.4, 0.9].into_iter().all(is_equal);
            if arguments.len() == 1 {
                assert_eq!(
                    holds(&|x| value(-x) == value(x)),
                    function.is_even(),
                    "{name}"
                );
                assert_eq!(
                    holds(&|x| value(-x) == -value(x)),
                    function.is_odd(),
                    "{name}"
                );
            }
            let is_constant = value(0.5) == value(0.75) && value(-0.5) == value(-0.75);
            assert_eq!(is_constant, function.is_step(), "{name}");
        }
    }
}
