//! Names of Greek letters.

/// Greek letters and their names in English.
const GREEK: [(&str, &str); 24] = [
    ("αΑ", "alpha"),
    ("βΒ", "beta"),
    ("γΓ", "gamma"),
    ("δΔ", "delta"),
    ("εΕ", "epsilon"),
    ("ζΖ", "zeta"),
    ("ηΗ", "eta"),
    ("θΘϑ", "theta"),
    ("ιΙ", "iota"),
    ("κΚ", "kappa"),
    ("λΛ", "lambda_1"),
    ("μΜµ", "mu"),
    ("νΝ", "nu"),
    ("ξΞ", "xi"),
    ("οΟ", "omicron"),
    ("πΠ", "pi_1"),
    ("ρΡ", "rho"),
    ("σΣς", "sigma"),
    ("τΤ", "tau"),
    ("υΥ", "upsilon"),
    ("φΦϕ", "phi"),
    ("χΧ", "chi"),
    ("ψΨ", "psi"),
    ("ωΩ", "omega"),
];

/// Returns a name with its Greek letters spelled out in English; `None` if it contains no Greek letter.
pub(crate) fn spell_greek(name: &str) -> Option<String> {
    let spelled = name.chars().map(|letter| {
        let mut greek = GREEK.iter();
        match greek.find(|(letters, _)| letters.contains(letter)) {
            Some((_, word)) => (*word).to_owned(),
            None => letter.to_string(),
        }
    });
    let spelled: String = spelled.collect();
    (spelled != name).then_some(spelled)
}
