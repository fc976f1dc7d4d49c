//! Names of the Greek letters with their LaTeX commands and characters.

const GREEK: [(&str, &str, &str); 36] = [
    ("alpha", "\\alpha", "α"),
    ("beta", "\\beta", "β"),
    ("gamma", "\\gamma", "γ"),
    ("delta", "\\delta", "δ"),
    ("epsilon", "\\epsilon", "ε"),
    ("eps", "\\epsilon", "ε"),
    ("zeta", "\\zeta", "ζ"),
    ("eta", "\\eta", "η"),
    ("theta", "\\theta", "θ"),
    ("iota", "\\iota", "ι"),
    ("kappa", "\\kappa", "κ"),
    ("lambda", "\\lambda", "λ"),
    ("mu", "\\mu", "μ"),
    ("nu", "\\nu", "ν"),
    ("xi", "\\xi", "ξ"),
    ("rho", "\\rho", "ρ"),
    ("sigma", "\\sigma", "σ"),
    ("tau", "\\tau", "τ"),
    ("upsilon", "\\upsilon", "υ"),
    ("phi", "\\phi", "φ"),
    ("chi", "\\chi", "χ"),
    ("psi", "\\psi", "ψ"),
    ("omega", "\\omega", "ω"),
    ("Gamma", "\\Gamma", "Γ"),
    ("Delta", "\\Delta", "Δ"),
    ("Theta", "\\Theta", "Θ"),
    ("Lambda", "\\Lambda", "Λ"),
    ("Xi", "\\Xi", "Ξ"),
    ("Pi", "\\Pi", "Π"),
    ("Sigma", "\\Sigma", "Σ"),
    ("Upsilon", "\\Upsilon", "Υ"),
    ("Phi", "\\Phi", "Φ"),
    ("Psi", "\\Psi", "Ψ"),
    ("Omega", "\\Omega", "Ω"),
    ("dtheta", "\\Delta\\theta", "Δθ"),
    ("dphi", "\\Delta\\phi", "Δφ"),
];

pub(super) fn command(name: &str) -> Option<&'static str> {
    entry(name).map(|(_, command, _)| *command)
}

/// Returns the Greek letter for a name, for example θ for `theta`.
pub fn letter(name: &str) -> Option<&'static str> {
    entry(name).map(|(_, _, letter)| *letter)
}

pub(super) fn find_command(letter: char) -> Option<&'static str> {
    GREEK
        .iter()
        .find(|(_, _, known)| known.chars().eq([letter]))
        .map(|(_, command, _)| *command)
}

fn entry(name: &str) -> Option<&'static (&'static str, &'static str, &'static str)> {
    GREEK.iter().find(|(known, ..)| *known == name)
}
