//! Reactions of frictions and contacts in a step of fixed length, in Rust; the evaluator has the same method with the same
//! order of operations, `program::evaluator::fixed_step`.

use super::expression::{array, write_loop};
use super::literals::number;
use super::step::RATES_OF_STAGES;
use crate::program::evaluator::{MAX_SETTLED_CHANGE, MAX_SWEEPS};
use crate::program::{Reactions, RowValues, ValueId};
use crate::statements::layout::{DEEPER, SHALLOWER, block};

type ProgramReactions = Reactions<ValueId, RowValues>;

/// Sizes of the arrays of a step.
struct Sizes {
    sides: usize,
    contacts: usize,
    reactions: usize,
}

impl Sizes {
    fn new(known: &ProgramReactions) -> Self {
        Self {
            sides: known.sides(),
            contacts: known.distances.len(),
            reactions: known.functions.len(),
        }
    }
}

/// Writes the statements of the step around those of the Runge-Kutta method.
pub(super) fn step(known: &ProgramReactions, runge_kutta: &str) -> String {
    let Sizes {
        sides,
        contacts,
        reactions: count,
    } = Sizes::new(known);
    let mut lines = RATES_OF_STAGES.to_owned();
    // Only contacts change the targets.
    let targets = if contacts > 0 {
        "mut targets"
    } else {
        "targets"
    };
    lines += &format!(
        "let mut next = *state;\n\
         let mut reactions = [T::number(0.0); {count}];\n\
         let {targets} = reactions;\n\
         let mut delays = [half; {count}];\n",
    );
    let end_functions = "functions = reaction_functions(t + h, &next, inputs, coefficients);\n";
    let start_effects = "let effects = reaction_effects(t, state, inputs, coefficients);\n";
    let meet = match contacts {
        0 => "",
        _ => "meet_contacts(h, &before, &functions, &effects, &mut targets, &mut delays);\n",
    };
    let find = "find_reactions(h, &effects, &targets, &mut functions, &mut reactions)";
    let apply = "apply_reactions(&effects, &reactions, &applied, &delays, &mut next);\n";
    if contacts > 0 {
        lines += "let before = reaction_functions(t, state, inputs, coefficients);\n";
    }
    if sides > 0 {
        lines += start_effects;
        lines += &format!("let mut sides = [T::number(0.5); {sides}];\n");
        lines += "rates_with_sides(t, state, inputs, coefficients, &sides, &mut k1);\n";
        lines += &block(
            "for i in 0..STATES {",
            "next[i] = state[i] + h * k1[i];\n",
            "}",
        );
        lines += &format!("let mut {end_functions}");
        lines += meet;
        lines += &format!("{find};\n");
        lines += &write_loop(
            "r",
            sides,
            "sides[r] = T::number(0.5) + T::number(0.5) * (reactions[r] / h);\n",
        );
        if count > sides {
            let head = format!("for r in {sides}..{count} {{");
            lines += &block(&head, "reactions[r] = T::number(0.0);\n", "}");
        }
    }
    lines += runge_kutta;
    if sides > 0 {
        lines += end_functions;
    } else {
        lines += &format!("let mut {end_functions}");
        let is_open = block(
            &format!("if !T::all_greater(functions[{count} + i], T::number(0.0)) {{"),
            "is_open = false;\n",
            "}",
        );
        lines += "let mut is_open = true;\n";
        lines += &write_loop("i", contacts, &is_open);
        lines += &block("if is_open {", "*state = next;\nreturn;\n", "}");
        lines += start_effects;
    }
    lines += meet;
    lines += "let mut applied = reactions;\n";
    lines += &format!("let first_unsettled = {find};\n");
    lines += apply;
    lines += end_functions;
    if contacts > 0 {
        lines += "separate_contacts(&effects, &targets, &mut functions, &mut next);\n";
    }
    lines += "applied = reactions;\n";
    lines += &format!("let unsettled = first_unsettled + {find};\n");
    lines += &format!("delays = [T::number(0.0); {count}];\n");
    lines += apply;
    lines
        + &block(
            "for i in 0..STATES {",
            "state[i] = T::select_greater(T::number(0.5), unsettled, next[i], T::number(f64::NAN));\n",
            "}",
        )
}

/// Writes the functions that the step calls.
pub(super) fn functions(known: &ProgramReactions) -> String {
    let contacts = match known.distances.len() {
        0 => String::new(),
        _ => meet_contacts(known) + &separate_contacts(known),
    };
    contacts + &find_reactions(known) + &apply_reactions(known)
}

fn function(name: &str, arguments: &[&str], result: &str, lines: &str) -> String {
    let arguments: String = arguments
        .iter()
        .map(|argument| format!("{argument},\n"))
        .collect();
    let head = format!("fn {name}<T: Scalar>(\n{DEEPER}{arguments}{SHALLOWER}){result} {{");
    block(&head, lines, "}")
}

fn contacts_of_frictions(known: &ProgramReactions) -> String {
    let contacts = known
        .coefficients
        .iter()
        .map(|(contact, _)| contact.to_string());
    let contacts: Vec<String> = contacts.collect();
    match contacts.len() {
        0 => String::new(),
        length => format!("let contacts: [usize; {length}] = {};\n", array(&contacts)),
    }
}

/// Writes the function that sets the rates after contacts and the times for which impulses act.
fn meet_contacts(known: &ProgramReactions) -> String {
    let Sizes {
        sides,
        contacts,
        reactions: count,
    } = Sizes::new(known);
    let effects = known.effects.len();
    let infinity = "T::number(f64::NEG_INFINITY)";
    let each = format!(
        "let (before, after) = (before_step[{count} + i], functions[{count} + i]);\n\
         let (rate_before, rate) = (before_step[{sides} + i], functions[{sides} + i]);\n\
         let crossing = T::select_greater(before, zero, before / (before - after), zero);\n\
         let approach = rate_before + crossing * (rate - rate_before);\n\
         let bounce = T::select_greater(zero, approach, -(effects[{effects} + i] * approach), zero);\n\
         let rebound = bounce + (rate - approach);\n\
         let target = T::select_greater(rebound, zero, rebound, zero);\n\
         let delay = T::select_greater(-(rate * h), -after, after / rate, h);\n\
         targets[{sides} + i] = T::select_greater(after, zero, {infinity}, target);\n\
         delays[{sides} + i] = T::select_greater(after, zero, zero, delay);\n"
    );
    let mut lines = "let zero = T::number(0.0);\n".to_owned() + &contacts_of_frictions(known);
    lines += &write_loop("i", contacts, &each);
    if !known.coefficients.is_empty() {
        let first_friction = sides + contacts;
        let copied = format!("delays[{first_friction} + i] = delays[{sides} + contacts[i]];\n");
        lines += &write_loop("i", known.coefficients.len(), &copied);
    }
    let reactions = |name: &str| format!("{name}: &mut [T; {count}]");
    let arguments = [
        "h: T",
        "before_step: &[T; REACTION_FUNCTIONS]",
        "functions: &[T; REACTION_FUNCTIONS]",
        "effects: &[T; REACTION_EFFECTS]",
        &reactions("targets"),
        &reactions("delays"),
    ];
    function("meet_contacts", &arguments, "", &lines)
}

/// Writes the function that corrects the reactions. It returns 0 if they settle.
fn find_reactions(known: &ProgramReactions) -> String {
    let Sizes {
        sides,
        contacts,
        reactions: count,
    } = Sizes::new(known);
    let first_friction = sides + contacts;
    let coefficients = known.effects.len() + contacts;
    let magnitude = |x: &str| format!("T::select_greater(zero, {x}, -{x}, {x})");
    let clamped = "let below = T::select_greater(wanted, limit, limit, wanted);\n\
                   let between = T::select_greater(-limit, below, -limit, below);\n";
    let mut branches: Vec<(String, String)> = Vec::new();
    if sides > 0 {
        let law = "T::select_greater(zero, effect, between, reactions[r])\n";
        branches.push((
            format!("r < {sides}"),
            format!("let limit = h;\n{clamped}{law}"),
        ));
    }
    if contacts > 0 {
        let law = "T::select_greater(effect, zero, T::select_greater(wanted, zero, wanted, zero), zero)\n";
        branches.push((format!("r < {first_friction}"), law.to_owned()));
    }
    if count > first_friction {
        let law = "T::select_greater(effect, zero, between, zero)\n";
        let limit = format!(
            "let limit = effects[{coefficients} + r - {first_friction}] * \
             reactions[{sides} + contacts[r - {first_friction}]];\n"
        );
        branches.push((String::new(), limit + clamped + law));
    }
    let last = branches.len() - 1;
    let mut law = String::new();
    for (place, (condition, lines)) in branches.iter().enumerate() {
        let opening = match (place, place == last) {
            (0, true) => "let next = {".to_owned(),
            (_, true) => "} else {".to_owned(),
            (0, false) => format!("let next = if {condition} {{"),
            _ => format!("}} else if {condition} {{"),
        };
        law += &format!("{opening}\n{DEEPER}{lines}{SHALLOWER}");
    }
    law += "};\n";
    let settled = number(MAX_SETTLED_CHANGE);
    let each = format!(
        "let effect = effects[{count} * r + r];\n\
         let wanted = reactions[r] - (functions[r] - targets[r]) / effect;\n\
         {law}\
         let change = next - reactions[r];\n\
         reactions[r] = next;\n\
         {}\
         let size = {};\n\
         sizes[r] = T::select_greater(size, sizes[r], size, sizes[r]);\n\
         let step = change * effect;\n\
         let moved = {};\n\
         unsettled = T::select_greater(moved, T::number({settled}) * sizes[r], T::number(1.0), unsettled);\n",
        write_loop(
            "i",
            count,
            &format!("functions[i] = functions[i] + effects[{count} * i + r] * change;\n"),
        ),
        magnitude("functions[r]"),
        magnitude("step"),
    );
    let mut lines = "let zero = T::number(0.0);\n".to_owned() + &contacts_of_frictions(known);
    lines += &format!("let mut sizes = [zero; {count}];\nlet mut unsettled = T::number(1.0);\n");
    lines += &write_loop(
        "r",
        count,
        &format!("sizes[r] = {};\n", magnitude("functions[r]")),
    );
    let sweep = "unsettled = zero;\n".to_owned()
        + &write_loop("r", count, &each)
        + &block(
            "if T::all_greater(T::number(0.5), unsettled) {",
            "break;\n",
            "}",
        );
    lines += &write_loop("_", MAX_SWEEPS, &sweep);
    lines += "unsettled\n";
    let time = if sides > 0 { "h: T" } else { "_: T" };
    let arguments = [
        time,
        "effects: &[T; REACTION_EFFECTS]",
        &format!("targets: &[T; {count}]"),
        "functions: &mut [T; REACTION_FUNCTIONS]",
        &format!("reactions: &mut [T; {count}]"),
    ];
    function("find_reactions", &arguments, " -> T", &lines)
}

/// Writes the function that moves the positions so that closed contacts do not overlap.
fn separate_contacts(known: &ProgramReactions) -> String {
    let Sizes {
        sides,
        contacts,
        reactions: count,
    } = Sizes::new(known);
    let first = known.first_column();
    let each = format!(
        "let distance = functions[{count} + i];\n\
         let effect = effects[{count} * ({sides} + i) + {sides} + i];\n\
         let overlap = T::select_greater(zero, distance, -distance / effect, zero);\n\
         let is_open = T::number(f64::NEG_INFINITY);\n\
         let push = T::select_greater(targets[{sides} + i], is_open, overlap, zero);\n"
    ) + &block(
        "for j in 0..DEGREES_OF_FREEDOM {",
        &format!("state[j] = state[j] + effects[{first} + LENGTH * ({sides} + i) + j] * push;\n"),
        "}",
    ) + &write_loop(
        "j",
        contacts,
        &format!(
            "let moved = effects[{count} * ({sides} + j) + {sides} + i] * push;\n\
             functions[{count} + j] = functions[{count} + j] + moved;\n"
        ),
    );
    let lines =
        LENGTH.to_owned() + "let zero = T::number(0.0);\n" + &write_loop("i", contacts, &each);
    let arguments = [
        "effects: &[T; REACTION_EFFECTS]",
        &format!("targets: &[T; {count}]"),
        "functions: &mut [T; REACTION_FUNCTIONS]",
        "state: &mut [T; STATES]",
    ];
    function("separate_contacts", &arguments, "", &lines)
}

/// Length of a column.
const LENGTH: &str = "const LENGTH: usize = STATES - DEGREES_OF_FREEDOM;\n";

/// Writes the function that adds the changes of the reactions to the state.
fn apply_reactions(known: &ProgramReactions) -> String {
    let count = known.functions.len();
    let first = known.first_column();
    let position = block(
        "if i < DEGREES_OF_FREEDOM {",
        "state[i] = state[i] + delays[r] * moved;\n",
        "}",
    );
    let element = format!(
        "let moved = effects[{first} + LENGTH * r + i] * change;\n\
         state[DEGREES_OF_FREEDOM + i] = state[DEGREES_OF_FREEDOM + i] + moved;\n{position}"
    );
    let each = "let change = reactions[r] - applied[r];\n".to_owned()
        + &block("for i in 0..LENGTH {", &element, "}");
    let lines = LENGTH.to_owned() + &write_loop("r", count, &each);
    let reactions = |name: &str| format!("{name}: &[T; {count}]");
    let arguments = [
        "effects: &[T; REACTION_EFFECTS]",
        &reactions("reactions"),
        &reactions("applied"),
        &reactions("delays"),
        "state: &mut [T; STATES]",
    ];
    function("apply_reactions", &arguments, "", &lines)
}
