//! Reserved words of the language: functions, special forms, constants and keywords.

use crate::model::Function;

const FUNCTIONS: [(&str, Function, &[&str]); 20] = [
    ("sin", Function::Sin, &["x"]),
    ("cos", Function::Cos, &["x"]),
    ("tan", Function::Tan, &["x"]),
    ("asin", Function::Asin, &["x"]),
    ("acos", Function::Acos, &["x"]),
    ("atan", Function::Atan, &["x"]),
    ("atan2", Function::Atan2, &["y", "x"]),
    ("sinh", Function::Sinh, &["x"]),
    ("cosh", Function::Cosh, &["x"]),
    ("tanh", Function::Tanh, &["x"]),
    ("exp", Function::Exp, &["x"]),
    ("ln", Function::Ln, &["x"]),
    ("sqrt", Function::Sqrt, &["x"]),
    ("abs", Function::Abs, &["x"]),
    ("sign", Function::Sign, &["x"]),
    ("min", Function::Min, &["a", "b"]),
    ("max", Function::Max, &["a", "b"]),
    ("deadzone", Function::Deadzone, &["p", "b"]),
    ("contact", Function::Contact, &["p", "b"]),
    ("above", Function::Above, &["p"]),
];

/// Forms that are not functions of scalars.
pub const FORMS: [&str; 5] = ["dot", "diff", "at", "integral", "sum"];

/// Functions of vectors and rotations. They are expanded to scalars before names are resolved,
/// so they reserve no name.
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

/// Keywords of Rust and C99: names become identifiers of emitted code.
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
        found.map(|(_, function, _)| *function)
    }

    /// Returns the name in a specification.
    pub fn name(self) -> &'static str {
        self.entry().map_or("", |(name, ..)| name)
    }

    /// Returns the names of the arguments.
    pub fn arguments(self) -> &'static [&'static str] {
        self.entry().map_or(&[], |(_, _, arguments)| arguments)
    }

    /// Returns true if the function has a kink or a jump.
    pub fn has_switches(self) -> bool {
        matches!(
            self,
            Self::Abs
                | Self::Sign
                | Self::Min
                | Self::Max
                | Self::Deadzone
                | Self::Contact
                | Self::Above
        )
    }

    /// Returns true if the value of the function jumps: at its surface, or at the cut of an angle.
    pub fn has_jump(self) -> bool {
        matches!(self, Self::Sign | Self::Contact | Self::Above | Self::Atan2)
    }

    fn entry(self) -> Option<&'static (&'static str, Self, &'static [&'static str])> {
        FUNCTIONS.iter().find(|(_, function, _)| *function == self)
    }
}

pub fn callable_names() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.iter().map(|(name, ..)| *name).chain(FORMS)
}

/// Returns the reason that a word is reserved, as the rest of a sentence.
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

    #[test]
    fn every_function_is_found_by_name() {
        for (name, function, arguments) in FUNCTIONS {
            assert_eq!(Function::from_name(name), Some(function));
            assert_eq!((function.name(), function.arguments()), (name, arguments));
            assert!(reservation_reason(name).is_some());
        }
        assert_eq!(Function::from_name("dot"), None);
    }
}
