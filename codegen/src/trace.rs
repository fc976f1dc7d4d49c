//! Terms of the specification that contribute to each value of a program.
//!
//! The contribution of each term to the equations is derived again, alone, on the graph of the equations. Each node
//! of this contribution is attributed to the term. A value without an attributed node, such as a sum of terms or a
//! step of the solution, gets the terms of its operands. If the operands have no terms, it gets the terms of the
//! values that use it.

use eomgen_model_spec::model::Model;

use crate::mechanics::contributions::{
    Contribution, collect_observable_contributions, derive_contributions,
};
use crate::mechanics::equations::Equations;
use crate::program::units::infer_units;
use crate::program::{Op, Program, Trace, TraceTerm, ValueId, ValueTrace};
use crate::symbolic::graph::NodeId;

/// Set of term indices, one bit for each term.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct TermSet(Vec<u64>);

impl TermSet {
    fn insert(&mut self, term: usize) {
        let word = term / 64;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (term % 64);
    }

    fn extend(&mut self, others: &Self) {
        if self.0.len() < others.0.len() {
            self.0.resize(others.0.len(), 0);
        }
        for (own, other) in self.0.iter_mut().zip(&others.0) {
            *own |= other;
        }
    }

    fn common(&self, others: &Self) -> Self {
        let pairs = self.0.iter().zip(&others.0);
        Self(pairs.map(|(own, other)| own & other).collect())
    }

    fn is_empty(&self) -> bool {
        self.0.iter().all(|word| *word == 0)
    }

    fn indices(&self) -> Vec<usize> {
        let has = |term: &usize| self.0[term / 64] >> (term % 64) & 1 == 1;
        (0..64 * self.0.len()).filter(has).collect()
    }
}

/// Returns terms and units of the values of `program`; `values` are the values of the nodes of `equations`.
pub(crate) fn trace_program(
    model: &Model,
    equations: &Equations,
    program: &Program,
    values: impl Iterator<Item = (NodeId, ValueId)>,
) -> Trace {
    let mut graph = equations.graph.clone();
    let known = graph.len();
    let mut contributions = derive_contributions(model, equations, &mut graph);
    let first_observable = contributions.len();
    contributions.extend(collect_observable_contributions(model, equations));
    let mut by_node = vec![TermSet::default(); known];
    let mut observed = vec![TermSet::default(); known];
    for (term, part) in contributions.iter().enumerate() {
        let by_node = match term < first_observable {
            true => &mut by_node,
            false => &mut observed,
        };
        for node in graph.reachable(&part.nodes) {
            if let Some(terms) = by_node.get_mut(node.index()) {
                terms.insert(term);
            }
        }
    }
    let pairs: Vec<(NodeId, ValueId)> = values.filter(|(node, _)| node.index() < known).collect();
    let spread = |by_node: &[TermSet]| {
        let mut found = vec![TermSet::default(); program.values.len()];
        for (node, value) in &pairs {
            found[value.index()].extend(&by_node[node.index()]);
        }
        spread_terms(program, found)
    };
    let found = spread(&by_node);
    let observed = spread(&observed);
    let units = infer_units(program);
    let trace = |(index, terms): (usize, &TermSet)| ValueTrace {
        unit: units[index].si_text(),
        terms: match terms.is_empty() {
            true => observed[index].indices(),
            false => terms.indices(),
        },
    };
    Trace {
        values: found.iter().enumerate().map(trace).collect(),
        terms: contributions.into_iter().map(term_of).collect(),
    }
}

fn term_of(part: Contribution) -> TraceTerm {
    TraceTerm {
        section: part.section.to_owned(),
        name: part.name,
    }
}

/// Assigns terms to the values that have none: the terms of their operands, else the terms of the values that use
/// them. Several terms can share a parameter or a product of parameters. Therefore a product of such factors gets
/// only the terms that all its factors have in common, if there are any.
fn spread_terms(program: &Program, mut found: Vec<TermSet>) -> Vec<TermSet> {
    // True for values of the solution, which depend on all terms of their operands.
    let mut is_combined = vec![false; found.len()];
    for (index, value) in program.values.iter().enumerate() {
        if !found[index].is_empty() {
            continue;
        }
        let operands = value.op.operands();
        let is_sum = matches!(value.op, Op::Add(..) | Op::Subtract(..) | Op::Negate(_));
        let of_kind = |is_parameter: bool| -> Vec<ValueId> {
            let is_wanted = |id: &ValueId| match &program.value(*id).op {
                // A leaf as a summand can be a force.
                Op::Parameter(_) | Op::Input(_) | Op::State(_) if is_sum => true,
                Op::Parameter(_) => is_parameter,
                op => !is_parameter && !op.operands().is_empty(),
            };
            let known = |id: &ValueId| !found[id.index()].is_empty();
            operands
                .iter()
                .copied()
                .filter(is_wanted)
                .filter(known)
                .collect()
        };
        let mut sources = of_kind(false);
        if sources.is_empty() {
            sources = of_kind(true);
        }
        let is_product = matches!(value.op, Op::Multiply(..) | Op::Divide(..));
        let is_monomial =
            value.parameter_only && is_product && sources.iter().all(|id| !is_combined[id.index()]);
        let mut all = sources.iter().map(|id| found[id.index()].clone());
        let mut terms = all.next().unwrap_or_default();
        let shared = all
            .clone()
            .fold(terms.clone(), |shared, other| shared.common(&other));
        if is_monomial && !shared.is_empty() {
            terms = shared;
        } else {
            all.for_each(|other| terms.extend(&other));
        }
        found[index] = terms;
        is_combined[index] = !is_monomial;
    }
    let mut from_users = vec![TermSet::default(); found.len()];
    for (index, value) in program.values.iter().enumerate().rev() {
        if found[index].is_empty() {
            found[index] = std::mem::take(&mut from_users[index]);
        }
        for operand in value.op.operands() {
            if found[operand.index()].is_empty() {
                from_users[operand.index()].extend(&found[index]);
            }
        }
    }
    found
}

/// Line of an emitted file that defines a value or a field of `Coefficients`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TracedLine {
    /// Number of the line, from 1.
    pub line: usize,
    /// Name of the function that contains the line, or `coefficients` for a field.
    pub function: String,
    /// Name of the value.
    pub name: String,
    /// SI unit; `None` if it is not known.
    pub unit: Option<String>,
    /// Terms of the specification, as `section.name`.
    pub terms: Vec<String>,
}

/// Finds the lines of an emitted Rust or C file that are preceded by a comment with the terms of a value.
pub fn find_traced_lines(source: &str, trace: &Trace) -> Vec<TracedLine> {
    let mut found = Vec::new();
    let mut function = String::new();
    let mut note: Option<&str> = None;
    if trace.values.is_empty() {
        return found;
    }
    for (index, line) in source.lines().enumerate() {
        let text = line.trim();
        if let Some(name) = function_name(line) {
            name.clone_into(&mut function);
        }
        if let Some(comment) = read_comment_text(text) {
            note = Some(comment);
            continue;
        }
        if let (Some(comment), Some(name)) = (note.take(), read_defined_name(text))
            && let Some((unit, terms)) = read_note(comment, trace)
        {
            // Comments of coefficients have a formula; comments of parameters and inputs have only a unit.
            let is_coefficient = comment.starts_with('`');
            if function.is_empty() && !is_coefficient {
                continue;
            }
            found.push(TracedLine {
                line: index + 1,
                function: match is_coefficient {
                    true => "coefficients".to_owned(),
                    false => function.clone(),
                },
                name: name.to_owned(),
                unit,
                terms,
            });
        }
    }
    found
}

/// Returns the name of the function that begins on a line, empty if a structure begins there.
fn function_name(line: &str) -> Option<&str> {
    let text = line.strip_prefix("    ").unwrap_or(line);
    if let Some((_, rest)) = text
        .split_once("fn ")
        .filter(|(before, _)| is_words(before))
    {
        return rest.split(['<', '(']).next();
    }
    if text.starts_with("pub struct ") || text.starts_with("typedef struct {") {
        return Some("");
    }
    let is_c = line.ends_with('{') || line.ends_with('(');
    let head = line
        .split_once('(')
        .filter(|_| is_c && !line.starts_with([' ', '/', '*', '#']));
    head.and_then(|(head, _)| head.rsplit(' ').next())
        .filter(|name| is_words(name))
}

fn is_words(text: &str) -> bool {
    let is_own = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == ' ';
    text.chars().all(is_own)
}

/// Returns the text of a comment of one line.
fn read_comment_text(line: &str) -> Option<&str> {
    let c = |open: &str| line.strip_prefix(open)?.strip_suffix(" */");
    let rust = |open: &str| line.strip_prefix(open);
    c("/** ")
        .or_else(|| c("/* "))
        .or_else(|| rust("/// "))
        .or_else(|| rust("// "))
}

/// Returns the name that a line of Rust or C defines.
fn read_defined_name(line: &str) -> Option<&str> {
    let line = line.strip_suffix(';').unwrap_or(line);
    let words = line.split(" = ").next()?.split([':', ',']).next()?;
    let name = words.rsplit(' ').next()?.split('[').next()?;
    (!name.is_empty() && is_words(name) && words.contains(' ')).then_some(name)
}

/// Reads the unit and the terms at the end of a comment.
fn read_note(comment: &str, trace: &Trace) -> Option<(Option<String>, Vec<String>)> {
    // The formula of a coefficient precedes its note.
    let note = comment.rsplit("` ").next()?;
    let note = note
        .strip_prefix("with prepared intermediate values ")
        .unwrap_or(note);
    let note = note.replace("\\[", "[");
    let (unit, rest) = match note.strip_prefix('[') {
        Some(rest) => {
            let (unit, rest) = rest.split_once(']')?;
            (Some(unit.to_owned()), rest.trim_start())
        }
        None => (None, &*note),
    };
    let mut terms = Vec::new();
    for word in rest.split(", ").filter(|word| !word.is_empty()) {
        let (section, name) = word.split_once('.')?;
        let own = trace.terms.iter().filter(|term| term.section == section);
        let own = own.filter(|term| name == "*" || term.name == name);
        let before = terms.len();
        terms.extend(own.map(|term| format!("{section}.{}", term.name)));
        if terms.len() == before {
            return None;
        }
    }
    Some((unit, terms))
}
