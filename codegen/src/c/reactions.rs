//! Reactions of frictions and contacts in a step of fixed length, in C. `program::evaluator::fixed_step` contains the
//! same method with the same order of operations.

use super::comments::comment;
use super::expression::{write_initialiser, write_loop};
use super::names::fill_template;
use super::stages::write_head;
use crate::program::evaluator::{
    MAX_LAST_CHANGE, MAX_SETTLED_ROUNDINGS, MAX_SWEEPS, SWEEPS_BETWEEN_CONTACTS,
};
use crate::program::{Program, ProgramReactions, ReactionCounts};
use crate::statements::layout::{DEEPER, SHALLOWER, block};
use crate::statements::{APPLY_REACTIONS, CLOSE_CONTACTS, FIND_REACTIONS, SEPARATE_CONTACTS};

/// Writes the functions that the step calls.
pub(super) fn write_functions(program: &Program, known: &ProgramReactions) -> String {
    let mut functions = Vec::new();
    if !known.distances.is_empty() {
        functions.push((CLOSE_CONTACTS, write_close_contacts(program, known)));
        functions.push((SEPARATE_CONTACTS, write_separate_contacts(program, known)));
    }
    functions.push((FIND_REACTIONS, write_find_reactions(program, known)));
    functions.push((APPLY_REACTIONS, write_apply_reactions(program, known)));
    let functions = functions.into_iter();
    functions
        .map(|(doc, text)| {
            let lines: Vec<String> = doc.split('\n').map(str::to_owned).collect();
            comment(&lines) + &fill_template(program, &text)
        })
        .collect()
}

/// Writes the statements of a step with reactions. `declarations` and `runge_kutta` are those of the Runge-Kutta step
/// that it contains.
pub(super) fn write_step(
    program: &Program,
    known: &ProgramReactions,
    [declarations, runge_kutta]: [&str; 2],
) -> String {
    let sizes = known.counts();
    let [functions, effects] = program.reaction_sizes();
    let (count, states) = (sizes.reactions, program.states());
    let mut lines = declarations.to_owned();
    for (name, length) in [
        ("next", states),
        ("before", functions),
        ("functions", functions),
        ("effects", effects),
        ("reactions", count),
        ("applied", count),
        ("targets", count),
        ("delays", count),
    ] {
        lines += &format!("NAME_real {name}[{length}];\n");
    }
    lines += "NAME_real lost;\n";
    if sizes.sides > 0 {
        lines += &format!("NAME_real sides[{}];\n", sizes.sides);
    }
    let given = |stage: &str, t: &str, state: &str, out: &str| {
        format!("NAME_{stage}({t}, {state}, inputs, coefficients, {out});\n")
    };
    let end_functions = given("reaction_functions", "t + h", "next", "functions");
    let start_effects = given("reaction_effects", "t", "state", "effects");
    let close =
        "NAME_close_contacts(h, before, functions, effects, reactions, applied, targets, delays)";
    let open = write_loop_between(
        (sizes.sides, sizes.sides + sizes.contacts),
        "targets[r] = R(-NAME_UNBOUNDED);\n",
    );
    let set_sides = write_loop(
        "r",
        sizes.sides,
        "sides[r] = R(0.5) + R(0.5) * (reactions[r] / h);\n",
    );
    let find = |sweeps: usize| {
        format!("NAME_find_reactions(h, {sweeps}, effects, targets, functions, reactions)")
    };
    let apply = "NAME_apply_reactions(effects, reactions, applied, delays, next);\n";
    let copy = write_loop("r", count, "applied[r] = reactions[r];\n");
    lines += &given("reaction_functions", "t", "state", "before");
    lines += &write_loop(
        "r",
        count,
        "reactions[r] = R(0.0);\ntargets[r] = R(0.0);\ndelays[r] = half;\n",
    );
    lines += &open;
    if sizes.sides > 0 {
        lines += &start_effects;
        // Initial reactions: 0 if a reaction decelerates its own velocity, else the full impulse with the sign of the
        // velocity.
        let driving = format!(
            "const NAME_real below = (R(0.0) > before[r]) ? -h : R(0.0);\n\
             const NAME_real sign = (before[r] > R(0.0)) ? h : below;\n\
             reactions[r] = (R(0.0) > effects[{count} * r + r]) ? R(0.0) : sign;\n"
        );
        lines += &write_loop("r", sizes.sides, &driving);
        lines += &set_sides;
        lines += "NAME_rates_with_sides(t, state, inputs, coefficients, sides, k1);\n";
        lines += &write_loop("i", states, "next[i] = state[i] + h * k1[i];\n");
        lines += &end_functions;
        if sizes.contacts > 0 {
            lines += &copy;
            lines += &format!("(void){close};\n");
        }
        lines += &format!("(void){};\n", find(MAX_SWEEPS));
        lines += &set_sides;
        lines += &write_loop_between((sizes.sides, count), "reactions[r] = R(0.0);\n");
        lines += &open;
    }
    lines += runge_kutta;
    lines += &end_functions;
    if sizes.sides == 0 {
        let is_open = block(
            &format!("if (!(functions[{} + i] > R(0.0))) {{", count),
            "is_open = 0;\n",
            "}",
        );
        lines += "int is_open = 1;\n";
        lines += &write_loop("i", sizes.contacts, &is_open);
        let copied = write_loop("i", states, "state[i] = next[i];\n") + "return;\n";
        lines += &block("if (is_open != 0) {", &copied, "}");
        lines += &start_effects;
    }
    lines += &copy;
    if sizes.contacts > 0 {
        // An impulse can close another contact.
        let end = block("if (!(closes > R(0.5))) {", "break;\n", "}");
        let sweep = format!("(void){};\n", find(SWEEPS_BETWEEN_CONTACTS));
        let pass = format!("const NAME_real closes = {close};\n{end}{sweep}");
        lines += &write_loop("pass", sizes.contacts, &pass);
    }
    lines += &format!("(void){};\n{apply}{end_functions}", find(MAX_SWEEPS));
    if sizes.contacts > 0 {
        lines += "NAME_separate_contacts(effects, targets, functions, next);\n";
    }
    lines += &copy;
    lines += &format!("lost = {};\n", find(MAX_SWEEPS));
    lines += &write_loop("r", count, "delays[r] = R(0.0);\n");
    lines += apply;
    lines
        + &write_loop(
            "i",
            states,
            "state[i] = (R(0.5) > lost) ? next[i] : (R(NAME_UNBOUNDED) - R(NAME_UNBOUNDED));\n",
        )
}

/// Writes a loop over the reactions `first..end`; writes nothing if this range is empty.
fn write_loop_between((first, end): (usize, usize), lines: &str) -> String {
    match first < end {
        true => block(
            &format!("for (int r = {first}; r < {end}; ++r) {{"),
            lines,
            "}",
        ),
        false => String::new(),
    }
}

fn write_contacts_of_frictions(known: &ProgramReactions) -> String {
    let contacts = known
        .coefficients
        .iter()
        .map(|(contact, _)| contact.to_string());
    let contacts: Vec<String> = contacts.collect();
    format!(
        "static const int contacts[{}] = {};\n",
        contacts.len(),
        write_initialiser(&contacts)
    )
}

/// Writes the function that closes open contacts whose distance is not positive. The emitted function returns 1 if a
/// contact closes, else 0.
fn write_close_contacts(program: &Program, known: &ProgramReactions) -> String {
    let ReactionCounts {
        sides,
        contacts,
        reactions,
    } = known.counts();
    let first_friction = sides + contacts;
    let effects = known.effects.len();
    let moved = write_loop(
        "r",
        reactions,
        &format!(
            "const NAME_real moved = effects[{reactions} * ({sides} + i) + r] * (reactions[r] - applied[r]);\n\
             after = after + delays[r] * moved;\n"
        ),
    );
    let each = format!(
        "NAME_real after = functions[{reactions} + i];\n{moved}\
         const NAME_real before = before_step[{reactions} + i];\n\
         const NAME_real rate_before = before_step[{sides} + i];\n\
         const NAME_real rate = functions[{sides} + i];\n\
         const NAME_real crossing = (before > R(0.0)) ? (before / (before - after)) : R(0.0);\n\
         const NAME_real approach = rate_before + crossing * (rate - rate_before);\n\
         const NAME_real bounce = (R(0.0) > approach) ? -(effects[{effects} + i] * approach) : R(0.0);\n\
         const NAME_real rebound = bounce + (rate - approach);\n\
         const NAME_real target = ((rebound > R(0.0)) && (bounce > R(0.0))) ? rebound : R(0.0);\n\
         const NAME_real delay = (-(rate * h) > -after) ? (after / rate) : R(0.5) * h;\n\
         const NAME_real is_closed = (targets[{sides} + i] > R(-NAME_UNBOUNDED)) ? R(1.0) : R(0.0);\n\
         const NAME_real own_closes = (after > R(0.0)) ? R(0.0) : (R(1.0) - is_closed);\n\
         targets[{sides} + i] = (own_closes > R(0.5)) ? target : targets[{sides} + i];\n\
         delays[{sides} + i] = (own_closes > R(0.5)) ? delay : delays[{sides} + i];\n\
         closes = (own_closes > R(0.5)) ? R(1.0) : closes;\n"
    );
    let mut lines = "NAME_real closes = R(0.0);\n".to_owned();
    if !known.coefficients.is_empty() {
        lines += &write_contacts_of_frictions(known);
    }
    lines += &write_loop("i", contacts, &each);
    if !known.coefficients.is_empty() {
        lines += &write_loop(
            "i",
            known.coefficients.len(),
            &format!("delays[{first_friction} + i] = delays[{sides} + contacts[i]];\n"),
        );
    }
    let arguments = [
        ("NAME_real ", "h"),
        ("const NAME_real *", "before_step"),
        ("const NAME_real *", "functions"),
        ("const NAME_real *", "effects"),
        ("const NAME_real *", "reactions"),
        ("const NAME_real *", "applied"),
        ("NAME_real *", "targets"),
        ("NAME_real *", "delays"),
    ];
    lines += "return closes;\n";
    let result = ("static NAME_real ", "close_contacts");
    let head = write_head(program, result, &arguments, true);
    block(&format!("{head} {{"), &lines, "}")
}

/// Writes the function that corrects the reactions. The emitted function returns 0 if the iteration converged, else
/// 1.
fn write_find_reactions(program: &Program, known: &ProgramReactions) -> String {
    let sizes = known.counts();
    let ReactionCounts {
        sides,
        contacts,
        reactions: count,
    } = sizes;
    let first_friction = sizes.sides + sizes.contacts;
    let coefficients = known.effects.len() + contacts;
    let magnitude = |x: &str| format!("((R(0.0) > {x}) ? -{x} : {x})");
    let clamped = "const NAME_real below = (wanted > limit) ? limit : wanted;\n\
                   const NAME_real between = (-limit > below) ? -limit : below;\n";
    let mut branches: Vec<(String, String)> = Vec::new();
    if sides > 0 {
        branches.push((
            format!("r < {sides}"),
            format!(
                "const NAME_real limit = h;\n{clamped}next = (R(0.0) > effect) ? between : reactions[r];\n"
            ),
        ));
    }
    if contacts > 0 {
        branches.push((
            format!("r < {first_friction}"),
            "next = ((effect > R(0.0)) && (wanted > R(0.0))) ? wanted : R(0.0);\n".to_owned(),
        ));
    }
    if count > first_friction {
        branches.push((
            String::new(),
            format!(
                "const NAME_real limit = effects[{coefficients} + r - {first_friction}] * \
                 reactions[{sides} + contacts[r - {first_friction}]];\n\
                 {clamped}next = (effect > R(0.0)) ? between : R(0.0);\n"
            ),
        ));
    }
    let last = branches.len() - 1;
    let mut law = String::new();
    for (place, (condition, lines)) in branches.iter().enumerate() {
        let opening = match (place, place == last) {
            (0, true) => "{".to_owned(),
            (_, true) => "} else {".to_owned(),
            (0, false) => format!("if ({condition}) {{"),
            _ => format!("}} else if ({condition}) {{"),
        };
        law += &format!("{opening}\n{DEEPER}{lines}{SHALLOWER}");
    }
    law += "}\n";
    let each = format!(
        "const NAME_real effect = effects[{count} * r + r];\n\
         const NAME_real wanted = reactions[r] - (functions[r] - targets[r]) / effect;\n\
         NAME_real next;\n\
         {law}\
         const NAME_real change = next - reactions[r];\n\
         reactions[r] = next;\n\
         {}\
         const NAME_real step = change * effect;\n\
         const NAME_real moved = {};\n\
         unsettled = (moved > settled * sizes[r]) ? R(1.0) : unsettled;\n\
         lost = (moved > R({MAX_LAST_CHANGE:e}) * sizes[r]) ? R(1.0) : lost;\n",
        write_loop(
            "i",
            count,
            &format!(
                "const NAME_real part = effects[{count} * i + r] * change;\n\
                 functions[i] = functions[i] + part;\n\
                 sizes[i] = sizes[i] + {};\n",
                magnitude("part")
            ),
        ),
        magnitude("step"),
    );
    let mut lines = String::new();
    if count > first_friction {
        lines += &write_contacts_of_frictions(known);
    }
    // `negative` is 3 times (4/3 - 1) less 1: the unit roundoff of the number type, apart from the sign.
    lines += &format!(
        "const NAME_real third = R(4.0) / R(3.0) - R(1.0);\n\
         const NAME_real negative = R(3.0) * third - R(1.0);\n\
         const NAME_real settled = R({MAX_SETTLED_ROUNDINGS:?}) * {};\n\
         NAME_real sizes[{count}];\nNAME_real unsettled = R(1.0);\nNAME_real lost = R(1.0);\n",
        magnitude("negative")
    );
    let sum = write_loop(
        "i",
        count,
        &format!(
            "const NAME_real part = effects[{count} * r + i] * reactions[i];\nsize = size + {};\n",
            magnitude("part")
        ),
    );
    let size = format!(
        "NAME_real size = {};\n{sum}sizes[r] = size;\n",
        magnitude("functions[r]")
    );
    lines += &write_loop("r", count, &size);
    let sweep = "unsettled = R(0.0);\nlost = R(0.0);\n".to_owned() + &write_loop("r", count, &each);
    let opening = "for (int sweep = 0; (sweep < most_sweeps) && (unsettled > R(0.5)); ++sweep) {";
    lines += &block(opening, &sweep, "}");
    lines += "return lost;\n";
    if sides == 0 {
        lines = "(void)h;\n".to_owned() + &lines;
    }
    let arguments = [
        ("NAME_real ", "h"),
        ("int ", "most_sweeps"),
        ("const NAME_real *", "effects"),
        ("const NAME_real *", "targets"),
        ("NAME_real *", "functions"),
        ("NAME_real *", "reactions"),
    ];
    let result = ("static NAME_real ", "find_reactions");
    let head = write_head(program, result, &arguments, true);
    block(&format!("{head} {{"), &lines, "}")
}

/// Writes the function that moves the positions so that closed contacts do not overlap.
fn write_separate_contacts(program: &Program, known: &ProgramReactions) -> String {
    let ReactionCounts {
        sides,
        contacts,
        reactions: count,
    } = known.counts();
    let degrees = program.degrees_of_freedom();
    let length = program.states() - degrees;
    let first = known.first_column() + sides * length;
    let diagonal = format!("effects[{count} * ({sides} + i) + {sides} + i]");
    let each = format!(
        "const NAME_real distance = functions[{count} + i];\n\
         const NAME_real overlap = (R(0.0) > distance) ? (-distance / {diagonal}) : R(0.0);\n\
         const NAME_real push = (targets[{sides} + i] > R(-NAME_UNBOUNDED)) ? overlap : R(0.0);\n"
    ) + &write_loop(
        "j",
        degrees,
        &format!("state[j] = state[j] + effects[{first} + {length} * i + j] * push;\n"),
    ) + &write_loop(
        "j",
        contacts,
        &format!(
            "functions[{count} + j] = functions[{count} + j] + effects[{count} * ({sides} + j) + {sides} + i] * push;\n"
        ),
    );
    let arguments = [
        ("const NAME_real *", "effects"),
        ("const NAME_real *", "targets"),
        ("NAME_real *", "functions"),
        ("NAME_real *", "state"),
    ];
    let result = ("static void ", "separate_contacts");
    let head = write_head(program, result, &arguments, true);
    block(
        &format!("{head} {{"),
        &write_loop("i", contacts, &each),
        "}",
    )
}

/// Writes the function that adds the changes of the reactions to the state.
fn write_apply_reactions(program: &Program, known: &ProgramReactions) -> String {
    let degrees = program.degrees_of_freedom();
    let length = program.states() - degrees;
    let first = known.first_column();
    let position = block(
        &format!("if (i < {degrees}) {{"),
        "state[i] = state[i] + delays[r] * moved;\n",
        "}",
    );
    let element = format!(
        "const NAME_real moved = effects[{first} + {length} * r + i] * change;\n\
         state[{degrees} + i] = state[{degrees} + i] + moved;\n{position}"
    );
    let each = "const NAME_real change = reactions[r] - applied[r];\n".to_owned()
        + &write_loop("i", length, &element);
    let arguments = [
        ("const NAME_real *", "effects"),
        ("const NAME_real *", "reactions"),
        ("const NAME_real *", "applied"),
        ("const NAME_real *", "delays"),
        ("NAME_real *", "state"),
    ];
    let head = write_head(
        program,
        ("static void ", "apply_reactions"),
        &arguments,
        true,
    );
    block(
        &format!("{head} {{"),
        &write_loop("r", known.functions.len(), &each),
        "}",
    )
}
