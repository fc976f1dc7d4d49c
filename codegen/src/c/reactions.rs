//! Reactions of frictions and contacts in a step of fixed length, in C; the evaluator has the same method with the same
//! order of operations, `program::evaluator::fixed_step`.

use super::expression::{initialiser, write_loop};
use super::names::fill_template;
use super::stages::head;
use super::step::RATES_OF_STAGES;
use crate::program::evaluator::{MAX_SETTLED_CHANGE, MAX_SWEEPS};
use crate::program::{Program, Reactions, RowValues, ValueId};
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

    /// Returns the index of the first contact friction.
    fn first_friction(&self) -> usize {
        self.sides + self.contacts
    }
}

/// Writes the functions that the step calls.
pub(super) fn functions(program: &Program, known: &ProgramReactions) -> String {
    let mut text = String::new();
    if !known.distances.is_empty() {
        text += &meet_contacts(program, known);
        text += &separate_contacts(program, known);
    }
    text += &find_reactions(program, known);
    text += &apply_reactions(program, known);
    fill_template(program, &text)
}

/// Writes the statements of the step around those of the Runge-Kutta method.
pub(super) fn step(program: &Program, known: &ProgramReactions, runge_kutta: &str) -> String {
    let sizes = Sizes::new(known);
    let [functions, effects] = program.reaction_sizes();
    let (count, states) = (sizes.reactions, program.states());
    let mut lines = RATES_OF_STAGES.to_owned();
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
    lines += "NAME_real unsettled;\n";
    if sizes.sides > 0 {
        lines += &format!("NAME_real sides[{}];\n", sizes.sides);
    }
    let given = |stage: &str, t: &str, state: &str, out: &str| {
        format!("NAME_{stage}({t}, {state}, inputs, coefficients, {out});\n")
    };
    let end_functions = given("reaction_functions", "t + h", "next", "functions");
    let start_effects = given("reaction_effects", "t", "state", "effects");
    let meet = match sizes.contacts {
        0 => "",
        _ => "NAME_meet_contacts(h, before, functions, effects, targets, delays);\n",
    };
    let find = "NAME_find_reactions(h, effects, targets, functions, reactions)";
    let apply = "NAME_apply_reactions(effects, reactions, applied, delays, next);\n";
    let copy = write_loop("r", count, "applied[r] = reactions[r];\n");
    lines += &given("reaction_functions", "t", "state", "before");
    lines += &write_loop(
        "r",
        count,
        "reactions[r] = R(0.0);\ntargets[r] = R(0.0);\ndelays[r] = half;\n",
    );
    if sizes.sides > 0 {
        lines += &start_effects;
        lines += &write_loop("r", sizes.sides, "sides[r] = R(0.5);\n");
        lines += "NAME_rates_with_sides(t, state, inputs, coefficients, sides, k1);\n";
        lines += &write_loop("i", states, "next[i] = state[i] + h * k1[i];\n");
        lines += &end_functions;
        lines += meet;
        lines += &format!("(void){find};\n");
        lines += &write_loop(
            "r",
            sizes.sides,
            "sides[r] = R(0.5) + R(0.5) * (reactions[r] / h);\n",
        );
        if count > sizes.sides {
            let head = format!("for (int r = {}; r < {count}; ++r) {{", sizes.sides);
            lines += &block(&head, "reactions[r] = R(0.0);\n", "}");
        }
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
    lines += meet;
    lines += &copy;
    lines += &format!("unsettled = {find};\n");
    lines += apply;
    lines += &end_functions;
    if sizes.contacts > 0 {
        lines += "NAME_separate_contacts(effects, targets, functions, next);\n";
    }
    lines += &copy;
    lines += &format!("unsettled = unsettled + {find};\n");
    lines += &write_loop("r", count, "delays[r] = R(0.0);\n");
    lines += apply;
    lines
        + &write_loop(
            "i",
            states,
            "state[i] = (R(0.5) > unsettled) ? next[i] : (R(NAME_UNBOUNDED) - R(NAME_UNBOUNDED));\n",
        )
}

fn contacts_of_frictions(known: &ProgramReactions) -> String {
    let contacts = known
        .coefficients
        .iter()
        .map(|(contact, _)| contact.to_string());
    let contacts: Vec<String> = contacts.collect();
    format!(
        "static const int contacts[{}] = {};\n",
        contacts.len(),
        initialiser(&contacts)
    )
}

/// Writes the function that sets the rates after contacts and the times for which impulses act.
fn meet_contacts(program: &Program, known: &ProgramReactions) -> String {
    let Sizes {
        sides,
        contacts,
        reactions,
    } = Sizes::new(known);
    let first_friction = sides + contacts;
    let effects = known.effects.len();
    let each = format!(
        "const NAME_real before = before_step[{reactions} + i];\n\
         const NAME_real after = functions[{reactions} + i];\n\
         const NAME_real rate_before = before_step[{sides} + i];\n\
         const NAME_real rate = functions[{sides} + i];\n\
         const NAME_real crossing = (before > R(0.0)) ? (before / (before - after)) : R(0.0);\n\
         const NAME_real approach = rate_before + crossing * (rate - rate_before);\n\
         const NAME_real bounce = (R(0.0) > approach) ? -(effects[{effects} + i] * approach) : R(0.0);\n\
         const NAME_real rebound = bounce + (rate - approach);\n\
         const NAME_real target = (rebound > R(0.0)) ? rebound : R(0.0);\n\
         const NAME_real delay = (-(rate * h) > -after) ? (after / rate) : h;\n\
         targets[{sides} + i] = (after > R(0.0)) ? R(-NAME_UNBOUNDED) : target;\n\
         delays[{sides} + i] = (after > R(0.0)) ? R(0.0) : delay;\n"
    );
    let mut lines = String::new();
    if !known.coefficients.is_empty() {
        lines += &contacts_of_frictions(known);
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
        ("NAME_real *", "targets"),
        ("NAME_real *", "delays"),
    ];
    let head = head(program, ("static void ", "meet_contacts"), &arguments, true);
    block(&format!("{head} {{"), &lines, "}")
}

/// Writes the function that corrects the reactions. It returns 0 if they settle.
fn find_reactions(program: &Program, known: &ProgramReactions) -> String {
    let sizes = Sizes::new(known);
    let Sizes {
        sides,
        contacts,
        reactions: count,
    } = sizes;
    let first_friction = sizes.first_friction();
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
         const NAME_real size = {};\n\
         sizes[r] = (size > sizes[r]) ? size : sizes[r];\n\
         const NAME_real step = change * effect;\n\
         const NAME_real moved = {};\n{}",
        write_loop(
            "i",
            count,
            &format!("functions[i] = functions[i] + effects[{count} * i + r] * change;\n"),
        ),
        magnitude("functions[r]"),
        magnitude("step"),
        block(
            &format!("if (moved > R({MAX_SETTLED_CHANGE:e}) * sizes[r]) {{"),
            "unsettled = R(1.0);\n",
            "}",
        ),
    );
    let mut lines = String::new();
    if count > first_friction {
        lines += &contacts_of_frictions(known);
    }
    lines += &format!("NAME_real sizes[{count}];\nNAME_real unsettled = R(1.0);\n");
    lines += &write_loop(
        "r",
        count,
        &format!("sizes[r] = {};\n", magnitude("functions[r]")),
    );
    let sweep = "unsettled = R(0.0);\n".to_owned() + &write_loop("r", count, &each);
    let opening =
        format!("for (int sweep = 0; (sweep < {MAX_SWEEPS}) && (unsettled > R(0.5)); ++sweep) {{");
    lines += &block(&opening, &sweep, "}");
    lines += "return unsettled;\n";
    if sides == 0 {
        lines = "(void)h;\n".to_owned() + &lines;
    }
    let arguments = [
        ("NAME_real ", "h"),
        ("const NAME_real *", "effects"),
        ("const NAME_real *", "targets"),
        ("NAME_real *", "functions"),
        ("NAME_real *", "reactions"),
    ];
    let result = ("static NAME_real ", "find_reactions");
    let head = head(program, result, &arguments, true);
    block(&format!("{head} {{"), &lines, "}")
}

/// Writes the function that moves the positions so that closed contacts do not overlap.
fn separate_contacts(program: &Program, known: &ProgramReactions) -> String {
    let Sizes {
        sides,
        contacts,
        reactions: count,
    } = Sizes::new(known);
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
    let head = head(program, result, &arguments, true);
    block(
        &format!("{head} {{"),
        &write_loop("i", contacts, &each),
        "}",
    )
}

/// Writes the function that adds the changes of the reactions to the state.
fn apply_reactions(program: &Program, known: &ProgramReactions) -> String {
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
    let head = head(
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
