//! Emitted expressions with their precedence, so that parentheses stand only where the
//! order of evaluation needs them.

use proc_macro2::TokenStream;
use quote::quote;

/// How tightly an expression holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Choice,
    Sum,
    Product,
    Negation,
    Atom,
}

/// An emitted expression.
#[derive(Clone, Debug)]
pub struct Expression {
    tokens: TokenStream,
    level: Level,
    /// How many operations stand in it.
    pub size: usize,
}

impl Expression {
    /// A name, an element, a call or a literal without sign.
    pub fn atom(tokens: TokenStream) -> Self {
        Self {
            tokens,
            level: Level::Atom,
            size: 0,
        }
    }

    /// A number.
    pub fn number(value: f64) -> Self {
        let level = if value.is_sign_negative() {
            Level::Negation
        } else {
            Level::Atom
        };
        Self {
            tokens: super::literals::number(value),
            level,
            size: 0,
        }
    }

    /// Without parentheses around it.
    pub fn tokens(&self) -> TokenStream {
        self.tokens.clone()
    }

    fn at_least(&self, level: Level) -> TokenStream {
        let tokens = &self.tokens;
        if self.level < level {
            quote!((#tokens))
        } else {
            quote!(#tokens)
        }
    }

    fn new(tokens: TokenStream, level: Level, parts: &[&Self]) -> Self {
        Self {
            tokens,
            level,
            size: 1 + parts.iter().map(|part| part.size).sum::<usize>(),
        }
    }

    /// a + b
    pub fn add(a: &Self, b: &Self) -> Self {
        let (left, right) = (a.at_least(Level::Sum), b.at_least(Level::Product));
        Self::new(quote!(#left + #right), Level::Sum, &[a, b])
    }

    /// a - b
    pub fn subtract(a: &Self, b: &Self) -> Self {
        let (left, right) = (a.at_least(Level::Sum), b.at_least(Level::Product));
        Self::new(quote!(#left - #right), Level::Sum, &[a, b])
    }

    /// a b
    pub fn multiply(a: &Self, b: &Self) -> Self {
        let (left, right) = (a.at_least(Level::Product), b.at_least(Level::Negation));
        Self::new(quote!(#left * #right), Level::Product, &[a, b])
    }

    /// a / b
    pub fn divide(a: &Self, b: &Self) -> Self {
        let (left, right) = (a.at_least(Level::Product), b.at_least(Level::Negation));
        Self::new(quote!(#left / #right), Level::Product, &[a, b])
    }

    /// -a
    pub fn negate(a: &Self) -> Self {
        let operand = a.at_least(Level::Atom);
        Self::new(quote!(-#operand), Level::Negation, &[a])
    }

    /// A call of a function.
    pub fn call(name: &proc_macro2::Ident, arguments: &[Self]) -> Self {
        let tokens = arguments.iter().map(Self::tokens);
        let parts: Vec<&Self> = arguments.iter().collect();
        Self::new(quote!(#name(#(#tokens),*)), Level::Atom, &parts)
    }

    /// `if a OPERATOR b { then } else { otherwise }`
    pub fn choice(operator: TokenStream, [a, b, then, otherwise]: [&Self; 4]) -> Self {
        let (left, right) = (a.at_least(Level::Sum), b.at_least(Level::Sum));
        let (yes, no) = (then.tokens(), otherwise.tokens());
        Self::new(
            quote!(if #left #operator #right { #yes } else { #no }),
            Level::Choice,
            &[a, b, then, otherwise],
        )
    }
}
