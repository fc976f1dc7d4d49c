//! Reactions of frictions and contacts in a step of fixed length, in Rust. `program::evaluator::fixed_step` contains
//! the same method with the same order of operations.

use super::expression::{array, write_loop};
use super::literals::{number, write_linked_doc};
use crate::program::evaluator::{
    MAX_LAST_CHANGE, MAX_SETTLED_ROUNDINGS, MAX_SWEEPS, SWEEPS_BETWEEN_CONTACTS,
};
use crate::program::{ProgramReactions, ReactionCounts};
use crate::statements::layout::{DEEPER, SHALLOWER, block};
use crate::statements::{APPLY_REACTIONS, CLOSE_CONTACTS, FIND_REACTIONS, SEPARATE_CONTACTS};

/// Writes the statements of a step with reactions. `declarations` and `runge_kutta` are those of the Runge-Kutta step
/// that it contains.
pub(super) fn write_step(
    known: &ProgramReactions,
    [declarations, runge_kutta]: [&str; 2],
) -> String {
    let ReactionCounts {
        sides,
        contacts,
        reactions: count,
    } = known.counts();
    let mut lines = declarations.to_owned();
    // Only contacts change the targets.
    let targets = if contacts > 0 {
        "mut targets"
    } else {
        "targets"
    };
    lines += &format!(
        "let mut next = *state;\n\
         let mut reactions = [T::number(0.0); {count}];\n\
         let mut applied = reactions;\n\
         let {targets} = reactions;\n\
         let mut delays = [half; {count}];\n",
    );
    let end_functions = "functions = reaction_functions(t + h, &next, inputs, coefficients);\n";
    let start_effects = "let effects = reaction_effects(t, state, inputs, coefficients);\n";
    let close = "close_contacts(h, &before, &functions, &effects, &reactions, &applied, &mut targets, &mut delays)";
    let open = write_loop_between(
        (sides, sides + contacts),
        "targets[r] = T::number(f64::NEG_INFINITY);\n",
    );
    let set_sides = write_loop(
        "r",
        sides,
        "sides[r] = T::number(0.5) + T::number(0.5) * (reactions[r] / h);\n",
    );
    let find = |sweeps: usize| {
        format!("find_reactions(h, {sweeps}, &effects, &targets, &mut functions, &mut reactions)")
    };
    let apply = "apply_reactions(&effects, &reactions, &applied, &delays, &mut next);\n";
    lines += "let before = reaction_functions(t, state, inputs, coefficients);\n";
    lines += &open;
    if sides > 0 {
        lines += start_effects;
        // Initial reactions: 0 if a reaction decelerates its own velocity, else the full impulse with the sign of the
        // velocity.
        let driving = format!(
            "let zero = T::number(0.0);\n\
             let below = T::select_greater(zero, before[r], -h, zero);\n\
             let sign = T::select_greater(before[r], zero, h, below);\n\
             reactions[r] = T::select_greater(zero, effects[{count} * r + r], zero, sign);\n"
        );
        lines += &write_loop("r", sides, &driving);
        lines += &format!("let mut sides = [T::number(0.5); {sides}];\n");
        lines += &set_sides;
        lines += "rates_with_sides(t, state, inputs, coefficients, &sides, &mut k1);\n";
        lines += &block(
            "for i in 0..STATES {",
            "next[i] = state[i] + h * k1[i];\n",
            "}",
        );
        lines += &format!("let mut {end_functions}");
        if contacts > 0 {
            lines += "applied = reactions;\n";
            lines += &format!("{close};\n");
        }
        lines += &format!("{};\n", find(MAX_SWEEPS));
        lines += &set_sides;
        lines += &write_loop_between((sides, count), "reactions[r] = T::number(0.0);\n");
        lines += &open;
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
    lines += "applied = reactions;\n";
    if contacts > 0 {
        // An impulse can close another contact.
        let end = block(
            "if T::all_greater(T::number(0.5), closes) {",
            "break;\n",
            "}",
        );
        let sweep = format!("{};\n", find(SWEEPS_BETWEEN_CONTACTS));
        let pass = format!("let closes = {close};\n{end}{sweep}");
        lines += &write_loop("_", contacts, &pass);
    }
    lines += &format!("{};\n{apply}{end_functions}", find(MAX_SWEEPS));
    if contacts > 0 {
        lines += "separate_contacts(&effects, &targets, &mut functions, &mut next);\n";
    }
    lines += "applied = reactions;\n";
    lines += &format!("let lost = {};\n", find(MAX_SWEEPS));
    lines += &format!("delays = [T::number(0.0); {count}];\n");
    lines += apply;
    lines
        + &block(
            "for i in 0..STATES {",
            "state[i] = T::select_greater(T::number(0.5), lost, next[i], T::number(f64::NAN));\n",
            "}",
        )
}

/// Writes the functions that the step calls.
pub(super) fn write_functions(known: &ProgramReactions) -> String {
    let contacts = match known.distances.len() {
        0 => String::new(),
        _ => write_close_contacts(known) + &write_separate_contacts(known),
    };
    contacts + &write_find_reactions(known) + &write_apply_reactions(known)
}

/// Writes a loop over the reactions `first..end`; writes nothing if this range is empty.
fn write_loop_between((first, end): (usize, usize), lines: &str) -> String {
    match first < end {
        true => block(&format!("for r in {first}..{end} {{"), lines, "}"),
        false => String::new(),
    }
}

fn function((doc, name): (&str, &str), arguments: &[&str], result: &str, lines: &str) -> String {
    let arguments: String = arguments
        .iter()
        .map(|argument| format!("{argument},\n"))
        .collect();
    let doc = write_linked_doc(doc);
    let head = format!("{doc}fn {name}<T: Scalar>(\n{DEEPER}{arguments}{SHALLOWER}){result} {{");
    block(&head, lines, "}")
}

fn write_contacts_of_frictions(known: &ProgramReactions) -> String {
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

/// Writes the function that closes open contacts whose distance is not positive. The emitted function returns 1 if a
/// contact closes, else 0.
fn write_close_contacts(known: &ProgramReactions) -> String {
    let ReactionCounts {
        sides,
        contacts,
        reactions: count,
    } = known.counts();
    let effects = known.effects.len();
    let infinity = "T::number(f64::NEG_INFINITY)";
    let moved = write_loop(
        "r",
        count,
        &format!(
            "let moved = effects[{count} * ({sides} + i) + r] * (reactions[r] - applied[r]);\n\
             after = after + delays[r] * moved;\n"
        ),
    );
    let each = format!(
        "let mut after = functions[{count} + i];\n{moved}\
         let before = before_step[{count} + i];\n\
         let (rate_before, rate) = (before_step[{sides} + i], functions[{sides} + i]);\n\
         let crossing = T::select_greater(before, zero, before / (before - after), zero);\n\
         let approach = rate_before + crossing * (rate - rate_before);\n\
         let bounce = T::select_greater(zero, approach, -(effects[{effects} + i] * approach), zero);\n\
         let rebound = bounce + (rate - approach);\n\
         let target = T::select_greater(rebound, zero, T::select_greater(bounce, zero, rebound, zero), zero);\n\
         let delay = T::select_greater(-(rate * h), -after, after / rate, half * h);\n\
         let is_closed = T::select_greater(targets[{sides} + i], {infinity}, one, zero);\n\
         let own_closes = T::select_greater(after, zero, zero, one - is_closed);\n\
         targets[{sides} + i] = T::select_greater(own_closes, half, target, targets[{sides} + i]);\n\
         delays[{sides} + i] = T::select_greater(own_closes, half, delay, delays[{sides} + i]);\n\
         closes = T::select_greater(own_closes, half, one, closes);\n"
    );
    let mut lines = "let (zero, half, one) = (T::number(0.0), T::number(0.5), T::number(1.0));\n\
                     let mut closes = zero;\n"
        .to_owned()
        + &write_contacts_of_frictions(known);
    lines += &write_loop("i", contacts, &each);
    if !known.coefficients.is_empty() {
        let first_friction = sides + contacts;
        let copied = format!("delays[{first_friction} + i] = delays[{sides} + contacts[i]];\n");
        lines += &write_loop("i", known.coefficients.len(), &copied);
    }
    let given = |name: &str| format!("{name}: &[T; {count}]");
    let reactions = |name: &str| format!("{name}: &mut [T; {count}]");
    let arguments = [
        "h: T",
        "before_step: &[T; REACTION_FUNCTIONS]",
        "functions: &[T; REACTION_FUNCTIONS]",
        "effects: &[T; REACTION_EFFECTS]",
        &given("reactions"),
        &given("applied"),
        &reactions("targets"),
        &reactions("delays"),
    ];
    lines += "closes\n";
    function(
        (CLOSE_CONTACTS, "close_contacts"),
        &arguments,
        " -> T",
        &lines,
    )
}

/// Writes the function that corrects the reactions. The emitted function returns 0 if the iteration converged, else
/// 1.
fn write_find_reactions(known: &ProgramReactions) -> String {
    let ReactionCounts {
        sides,
        contacts,
        reactions: count,
    } = known.counts();
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
    let end = branches.len() - 1;
    let mut law = String::new();
    for (place, (condition, lines)) in branches.iter().enumerate() {
        let opening = match (place, place == end) {
            (0, true) => "let next = {".to_owned(),
            (_, true) => "} else {".to_owned(),
            (0, false) => format!("let next = if {condition} {{"),
            _ => format!("}} else if {condition} {{"),
        };
        law += &format!("{opening}\n{DEEPER}{lines}{SHALLOWER}");
    }
    law += "};\n";
    let last = number(MAX_LAST_CHANGE);
    let each = format!(
        "let effect = effects[{count} * r + r];\n\
         let wanted = reactions[r] - (functions[r] - targets[r]) / effect;\n\
         {law}\
         let change = next - reactions[r];\n\
         reactions[r] = next;\n\
         {}\
         let step = change * effect;\n\
         let moved = {};\n\
         unsettled = T::select_greater(moved, settled * sizes[r], T::number(1.0), unsettled);\n\
         lost = T::select_greater(moved, T::number({last}) * sizes[r], T::number(1.0), lost);\n",
        write_loop(
            "i",
            count,
            &format!(
                "let part = effects[{count} * i + r] * change;\n\
                 functions[i] = functions[i] + part;\n\
                 sizes[i] = sizes[i] + {};\n",
                magnitude("part")
            ),
        ),
        magnitude("step"),
    );
    // `negative` is 3 times (4/3 - 1) less 1: the unit roundoff of the number type, apart from the sign.
    let mut lines = format!(
        "let zero = T::number(0.0);\n\
         let third = T::number(4.0) / T::number(3.0) - T::number(1.0);\n\
         let negative = T::number(3.0) * third - T::number(1.0);\n\
         let settled = T::number({}) * {};\n",
        number(MAX_SETTLED_ROUNDINGS),
        magnitude("negative")
    ) + &write_contacts_of_frictions(known);
    lines += &format!("let mut sizes = [zero; {count}];\nlet mut lost = T::number(1.0);\n");
    let sum = write_loop(
        "i",
        count,
        &format!(
            "let part = effects[{count} * r + i] * reactions[i];\nsize = size + {};\n",
            magnitude("part")
        ),
    );
    let size = format!(
        "let mut size = {};\n{sum}sizes[r] = size;\n",
        magnitude("functions[r]")
    );
    lines += &write_loop("r", count, &size);
    let sweep = "let mut unsettled = zero;\nlost = zero;\n".to_owned()
        + &write_loop("r", count, &each)
        + &block(
            "if T::all_greater(T::number(0.5), unsettled) {",
            "break;\n",
            "}",
        );
    lines += &block("for _ in 0..most_sweeps {", &sweep, "}");
    lines += "lost\n";
    let time = if sides > 0 { "h: T" } else { "_: T" };
    let arguments = [
        time,
        "most_sweeps: usize",
        "effects: &[T; REACTION_EFFECTS]",
        &format!("targets: &[T; {count}]"),
        "functions: &mut [T; REACTION_FUNCTIONS]",
        &format!("reactions: &mut [T; {count}]"),
    ];
    function(
        (FIND_REACTIONS, "find_reactions"),
        &arguments,
        " -> T",
        &lines,
    )
}

/// Writes the function that moves the positions so that closed contacts do not overlap.
fn write_separate_contacts(known: &ProgramReactions) -> String {
    let ReactionCounts {
        sides,
        contacts,
        reactions: count,
    } = known.counts();
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
    function(
        (SEPARATE_CONTACTS, "separate_contacts"),
        &arguments,
        "",
        &lines,
    )
}

/// Length of a column.
const LENGTH: &str = "const LENGTH: usize = STATES - DEGREES_OF_FREEDOM;\n";

/// Writes the function that adds the changes of the reactions to the state.
fn write_apply_reactions(known: &ProgramReactions) -> String {
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
    function((APPLY_REACTIONS, "apply_reactions"), &arguments, "", &lines)
}
