//! Sorts entries by their references, or reports a cycle. The algorithm is iterative, because a chain can be as long
//! as the specification.

use crate::diagnostic::Diagnostic;
use crate::span::Span;

/// Index of the target of a reference, and its position.
pub type Reference = (usize, Span);

/// Returns the indices of the entries in an order in which each entry follows the entries to which it refers.
///
/// # Errors
/// The references have a cycle. The error contains its entries in order, each with the position of the reference to
/// the next entry.
pub fn sort_by_references(references: &[Vec<Reference>]) -> Result<Vec<usize>, Vec<Reference>> {
    let mut state = vec![State::Untouched; references.len()];
    let mut sorted = Vec::with_capacity(references.len());
    for start in 0..references.len() {
        if state[start] == State::Untouched {
            visit(start, references, &mut state, &mut sorted)?;
        }
    }
    Ok(sorted)
}

pub fn cycle_error<'n>(
    kind: &str,
    circle: &[Reference],
    named: impl Fn(usize) -> &'n str,
) -> Diagnostic {
    let Some((&(first, place), rest)) = circle.split_first() else {
        return Diagnostic::error(format!("a {kind} refers to itself"));
    };
    let mut chain: Vec<&str> = circle.iter().map(|(index, _)| named(*index)).collect();
    chain.push(named(first));
    // A long cycle is truncated.
    if chain.len() > 8 {
        chain.truncate(7);
        chain.push("...");
    }
    let message = format!("the {kind} `{}` refers to itself", named(first));
    let mut diagnostic =
        Diagnostic::error(message).with_span(place, format!("here: {}", chain.join(" -> ")));
    for &(index, place) in rest.iter().take(4) {
        diagnostic = diagnostic.with_related_span(place, format!("in `{}`", named(index)));
    }
    diagnostic.with_help("break the cycle: one of them must not depend on the others")
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Untouched,
    Open,
    Done,
}

fn visit(
    start: usize,
    references: &[Vec<Reference>],
    state: &mut [State],
    sorted: &mut Vec<usize>,
) -> Result<(), Vec<Reference>> {
    // Entries on the path from `start`, each with the index of its next reference.
    let mut path = vec![(start, 0)];
    state[start] = State::Open;
    while let Some((entry, next)) = path.last_mut() {
        let entry = *entry;
        let Some(&(target, _)) = references[entry].get(*next) else {
            state[entry] = State::Done;
            sorted.push(entry);
            path.pop();
            continue;
        };
        *next += 1;
        match state[target] {
            State::Done => {}
            State::Untouched => {
                state[target] = State::Open;
                path.push((target, 0));
            }
            State::Open => {
                let from = path
                    .iter()
                    .position(|(entry, _)| *entry == target)
                    .unwrap_or(0);
                let place =
                    |&(entry, next): &(usize, usize)| (entry, references[entry][next - 1].1);
                return Err(path[from..].iter().map(place).collect());
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn to(targets: &[usize]) -> Vec<Reference> {
        targets
            .iter()
            .map(|&target| (target, Span::new(target, target)))
            .collect()
    }

    #[test]
    fn order_follows_the_references() {
        let references = [to(&[2]), to(&[]), to(&[1])];
        assert_eq!(sort_by_references(&references), Ok(vec![1, 2, 0]));
    }

    #[test]
    fn cycle_excludes_the_path_into_it() {
        let references = [to(&[1]), to(&[2]), to(&[1])];
        let circle = sort_by_references(&references).expect_err("1 and 2 refer to each other");
        let entries: Vec<usize> = circle.iter().map(|(entry, _)| *entry).collect();
        assert_eq!(entries, [1, 2]);
    }

    #[test]
    fn long_chains_do_not_exhaust_the_stack() {
        let count = 100_000;
        let mut references: Vec<_> = (1..count).map(|next| to(&[next])).collect();
        references.push(Vec::new());
        assert_eq!(
            sort_by_references(&references).map(|sorted| sorted[0]),
            Ok(count - 1)
        );
    }
}
