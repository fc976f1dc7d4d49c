//! Which coordinates, rates, states and inputs each expression depends on, through definitions too,
//! and what of that is allowed where: energies hold no states and only inputs whose rates are
//! given, potentials no rates, a force
//! works on something that moves, and every coordinate has inertia.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::id_set::IdSet;
use crate::ids::{CoordinateId, FieldId, InputId};
use crate::model::{
    Constraint, Expr, ExprKind, MAX_CONSTRAINTS, MAX_IMPACTS, Model, Term, written_name,
};
use crate::rate_order::{WrittenOut, rate_order};
use crate::span::Span;

/// The deepest expression accepted once definitions are written out.
pub const MAX_EXPANDED_DEPTH: usize = 600;

/// The number of a coordinate among what has a rate.
fn coordinate_number(coordinate: CoordinateId) -> usize {
    2 * coordinate.index()
}

/// The number of a field among what has a rate.
fn field_number(field: FieldId) -> usize {
    2 * field.index() + 1
}

/// What an expression depends on.
#[derive(Clone, Debug, Default)]
struct Motion {
    /// Coordinates and fields, by their values.
    values: IdSet,
    /// Coordinates and fields, by their rates.
    rates: IdSet,
    /// Where a rate enters, if one does.
    rate: Option<Span>,
    /// The states that enter by their values.
    states: IdSet,
    /// Where a state, or the rate of one, enters, if one does.
    state: Option<Span>,
    /// Where the input enters of which the fewest rates are given, if one does, with how many.
    input: Option<(u8, Span)>,
    /// Where the multiplier or the residual of a constraint enters, if one does.
    reaction: Option<Span>,
    /// Where a function switches with what moves, if one does.
    switch: Option<Span>,
    /// Whether time enters.
    time: bool,
    /// Depth of the expression with definitions written out.
    depth: usize,
}

/// Checks what every expression of a model depends on, and fills in which constraints hold rates.
pub fn check(model: &mut Model, found: &mut Diagnostics) {
    let nonholonomic = check_expressions(model, found);
    for (constraint, is_nonholonomic) in model.constraints.iter_mut().zip(nonholonomic) {
        constraint.is_nonholonomic = is_nonholonomic;
    }
}

/// Whether each of the constraints holds rates.
fn check_expressions(model: &Model, found: &mut Diagnostics) -> Vec<bool> {
    let mut checker = Checker {
        definitions: vec![Motion::default(); model.definitions.len()],
        state_rates: vec![0; model.states.len()],
        model,
        found,
    };
    // Names lead to no circle here: those that do are refused where they are looked up.
    for written in rate_order(model).unwrap_or_default() {
        match written {
            WrittenOut::Definition(index) => {
                checker.definitions[index] = checker.motion(&model.definitions[index].value);
            }
            WrittenOut::Rate(index) => {
                checker.state_rates[index.index()] =
                    checker.motion(&model.states[index].rate).depth;
            }
            WrittenOut::RatesWithin(_) => {}
        }
    }
    checker.energies();
    checker.forces();
    let nonholonomic = checker.constraints();
    checker.impacts();
    for observable in &model.observables {
        checker.motion_with_reactions(&observable.value);
    }
    nonholonomic
}

struct Checker<'m, 'f> {
    model: &'m Model,
    definitions: Vec<Motion>,
    /// How deep the rates of the states are, definitions written out.
    state_rates: Vec<usize>,
    found: &'f mut Diagnostics,
}

impl Checker<'_, '_> {
    fn energies(&mut self) {
        let model = self.model;
        let mut inertial = IdSet::default();
        for term in &model.kinetic {
            let motion = self.motion(&term.value);
            self.refuse_driven(term, &motion, "the kinetic energy");
            inertial.extend(&motion.rates);
        }
        for term in &model.potential {
            let motion = self.motion(&term.value);
            self.refuse_driven(term, &motion, "the potential energy");
            if let Some(place) = motion.rate {
                self.found.push(
                    Diagnostic::error(format!("the potential energy `{}` holds a rate", term.name))
                        .at(place, "this is a rate")
                        .help("energies of motion belong in [kinetic], losses in [dissipation]"),
                );
            }
        }
        for term in &model.dissipation {
            let motion = self.motion(&term.value);
            self.refuse_driven(term, &motion, "the dissipation");
        }
        if self.found.is_empty() {
            self.refuse_massless(&inertial);
        }
    }

    /// An energy is one of the mechanism alone.
    fn refuse_driven(&mut self, term: &Term, motion: &Motion, what: &str) {
        if let Some((0, place)) = motion.input {
            self.found.push(
                Diagnostic::error(format!("{what} `{}` holds an input", term.name))
                    .at(place, "this is an input whose rate is not given")
                    .help(
                        "inputs act through [forces]; of prescribed motion the rates are given: \
                         rates = 2",
                    ),
            );
        }
        if let Some(place) = motion.state {
            self.found.push(
                Diagnostic::error(format!("{what} `{}` holds a state", term.name))
                    .at(place, "this is a state")
                    .help("states act through [forces]"),
            );
        }
    }

    /// Without inertia there is no acceleration to solve for.
    fn refuse_massless(&mut self, inertial: &IdSet) {
        let mut refuse = |name: &str, kind: &str, span: Span| {
            self.found.push(
                Diagnostic::error(format!("the {kind} `{name}` has no inertia"))
                    .at(span, "its rate is in no term of [kinetic]")
                    .help(format!("add a kinetic energy such as 1/2*m*dot({name})^2")),
            );
        };
        for (index, coordinate) in self.model.coordinates.iter().enumerate() {
            if !inertial.contains(coordinate_number(CoordinateId::new(index))) {
                refuse(&coordinate.name, "coordinate", coordinate.span);
            }
        }
        for (index, field) in self.model.fields.iter().enumerate() {
            if !inertial.contains(field_number(FieldId::new(index))) {
                refuse(&field.name, "field", field.span);
            }
        }
    }

    fn forces(&mut self) {
        let model = self.model;
        for force in &model.forces {
            self.motion(&force.value);
            let on = self.motion(&force.on);
            let problem = if let Some(place) = on.rate {
                Some((place, "this is a rate"))
            } else if let Some((0, place)) = on.input {
                Some((place, "this is an input"))
            } else if let Some(place) = on.state {
                Some((place, "this is a state"))
            } else if on.values.is_empty() {
                Some((force.on.span, "this does not move"))
            } else {
                None
            };
            if let Some((place, why)) = problem {
                let name = written_name(&force.name, force.span, &self.model.source);
                self.found.push(
                    Diagnostic::error(format!("the force `{name}` can do no work here"))
                        .at(place, why)
                        .help("`on` is a coordinate, or an expression of coordinates"),
                );
            }
        }
    }

    /// Checks what may stay zero; whether each of the constraints holds rates.
    fn constraints(&mut self) -> Vec<bool> {
        let model = self.model;
        let degrees = model.coordinates.len();
        let most = match model.fields.is_empty() {
            true => degrees.min(MAX_CONSTRAINTS),
            false => MAX_CONSTRAINTS,
        };
        if let Some(excess) = model.constraints.get(most) {
            let help = match most < MAX_CONSTRAINTS {
                true => {
                    format!("{degrees} constraints already leave {degrees} coordinates no freedom")
                }
                false => format!("at most {MAX_CONSTRAINTS} are taken"),
            };
            self.found.push(
                Diagnostic::error(format!(
                    "{} constraints are too many",
                    model.constraints.len()
                ))
                .at(excess.span, "one more than can be held")
                .help(help),
            );
            return Vec::new();
        }
        model
            .constraints
            .iter()
            .map(|constraint| self.constraint(constraint))
            .collect()
    }

    /// Checks what stays zero; whether it holds rates.
    fn constraint(&mut self, constraint: &Constraint) -> bool {
        let motion = self.motion(&constraint.zero);
        let span = constraint.zero.span;
        let is_nonholonomic = motion.rate.is_some() && !motion.rates.is_empty();
        let needed = if is_nonholonomic { 1 } else { 2 };
        let problem = if let Some(place) = motion.state {
            let help = "a constraint is one of coordinates, their rates, prescribed motion and t";
            Some((place, "this is a state", help))
        } else if let Some((given, place)) = motion.input.filter(|(given, _)| *given < needed) {
            let help = "its accelerations must be known: an input whose rates are given, rates = 2";
            let why = match given {
                0 => "this is an input whose rate is not given",
                _ => "this is a rate whose own rate is not given",
            };
            Some((place, why, help))
        } else if let Some(place) = motion.switch {
            let help = "a constraint is smooth; what touches and leaves stands in [impacts]";
            Some((place, "this switches", help))
        } else if motion.values.is_empty() && motion.rates.is_empty() {
            let help = "give an expression of coordinates, such as x^2 + y^2 - l^2";
            Some((span, "this holds no coordinate", help))
        } else {
            None
        };
        if let Some((place, why, help)) = problem {
            self.found.push(
                Diagnostic::error(format!("`{}` is no constraint", constraint.name))
                    .at(place, why)
                    .help(help),
            );
        }
        is_nonholonomic
    }

    /// Checks what may not fall below zero.
    fn impacts(&mut self) {
        let model = self.model;
        if let Some(excess) = model.impacts.get(MAX_IMPACTS) {
            self.found.push(
                Diagnostic::error(format!("{} impacts are too many", model.impacts.len()))
                    .at(excess.span, "one more than is taken")
                    .help(format!("at most {MAX_IMPACTS} are taken")),
            );
            return;
        }
        for impact in &model.impacts {
            let motion = self.motion(&impact.when);
            let problem = if let Some(place) = motion.rate {
                Some((place, "this is a rate", "give a distance"))
            } else if let Some(place) = motion.state {
                let help = "a distance is one of coordinates, prescribed motion and t";
                Some((place, "this is a state", help))
            } else if let Some((_, place)) = motion.input.filter(|(given, _)| *given < 2) {
                let help =
                    "its accelerations must be known: an input whose rates are given, rates = 2";
                Some((place, "this is an input whose rates are not given", help))
            } else if let Some(place) = motion.switch {
                let help = "give each of the smooth distances an impact of its own";
                Some((place, "this switches", help))
            } else if motion.values.is_empty() {
                let help = "give a distance between bodies, such as y, or x_2 - x_1 - d";
                Some((impact.when.span, "this holds no coordinate", help))
            } else {
                None
            };
            if let Some((place, why, help)) = problem {
                self.found.push(
                    Diagnostic::error(format!("`{}` is no impact", impact.name))
                        .at(place, why)
                        .help(help),
                );
            }
        }
    }

    /// How many rates of an input are given.
    fn given_rates(&self, input: InputId) -> u8 {
        let inputs = &self.model.inputs;
        let rates = std::iter::successors(inputs[input].rate, |rate| inputs[*rate].rate);
        u8::try_from(rates.count()).unwrap_or(u8::MAX)
    }

    /// What an expression depends on; reports what `dot` is used on wrongly, and reactions.
    fn motion(&mut self, expr: &Expr) -> Motion {
        let motion = self.motion_with_reactions(expr);
        if let Some(place) = motion.reaction {
            self.found.push(
                Diagnostic::error("what a constraint does is known when the motion is")
                    .at(place, "this belongs to a constraint")
                    .help("it may stand in [observables] alone"),
            );
        }
        motion
    }

    /// What an expression depends on; reports what `dot` is used on wrongly.
    fn motion_with_reactions(&mut self, expr: &Expr) -> Motion {
        let mut motion = Motion::default();
        self.add(expr, &mut motion, 1);
        if motion.depth > MAX_EXPANDED_DEPTH {
            self.found.push(
                Diagnostic::error(format!(
                    "with its definitions written out this is more than {MAX_EXPANDED_DEPTH} deep"
                ))
                .at(expr.span, "too deep"),
            );
            motion.depth = 0;
        }
        motion
    }

    fn add(&mut self, expr: &Expr, motion: &mut Motion, depth: usize) {
        motion.depth = motion.depth.max(depth);
        match &expr.kind {
            ExprKind::Time => motion.time = true,
            ExprKind::Input(index) => motion.hold_input(self.given_rates(*index), expr.span),
            ExprKind::State(index) => {
                motion.states.insert(index.index());
                motion.state = motion.state.or(Some(expr.span));
            }
            ExprKind::Coordinate(index) => {
                motion.values.insert(coordinate_number(*index));
            }
            ExprKind::Field(field) | ExprKind::ModeCoordinate(field) => {
                motion.values.insert(field_number(*field));
            }
            ExprKind::Definition(index) => {
                if let Some(known) = self.definitions.get(index.index()) {
                    motion.include(known, expr.span, depth);
                }
            }
            ExprKind::Dot(operand) => self.add_rate(operand, motion, depth),
            ExprKind::Diff(part, _) | ExprKind::Negate(part) => self.add(part, motion, depth + 1),
            ExprKind::Integral { integrand, .. } => self.add(integrand, motion, depth + 1),
            ExprKind::Sum { summand, .. } => self.add(summand, motion, depth + 1),
            ExprKind::At { value, .. } => self.add(value, motion, depth + 1),
            ExprKind::Binary(_, left, right) => {
                self.add(left, motion, depth + 1);
                self.add(right, motion, depth + 1);
            }
            ExprKind::Call(function, arguments) => {
                for argument in arguments {
                    self.add(argument, motion, depth + 1);
                }
                if function.switches() && arguments.iter().any(may_move) {
                    motion.switch = motion.switch.or(Some(expr.span));
                }
            }
            ExprKind::Multiplier(_) | ExprKind::Residual(_) => {
                motion.reaction = motion.reaction.or(Some(expr.span));
            }
            ExprKind::Number(_)
            | ExprKind::Pi
            | ExprKind::Position(_)
            | ExprKind::Parameter(_)
            | ExprKind::Coefficient(_)
            | ExprKind::ModeShape(_) => {}
        }
    }

    fn add_rate(&mut self, operand: &Expr, motion: &mut Motion, depth: usize) {
        let mut inner = Motion::default();
        self.add(operand, &mut inner, depth + 1);
        if let Some(diagnostic) = rate_error(operand.span, &inner) {
            self.found.push(diagnostic);
        }
        motion.state = motion.state.or(inner.state.map(|_| operand.span));
        motion.reaction = motion.reaction.or(inner.reaction);
        motion.switch = motion.switch.or(inner.switch);
        let deepest = inner.states.iter().map(|state| self.state_rates[state]);
        motion.depth = motion.depth.max(depth + 1 + deepest.max().unwrap_or(0));
        motion.rate = motion.rate.or(Some(operand.span));
        motion.rates.extend(&inner.values);
        // The rate of a definition, or of a field's function, depends on the coordinates too.
        if matches!(operand.kind, ExprKind::Definition(_) | ExprKind::At { .. }) {
            motion.values.extend(&inner.values);
            motion.states.extend(&inner.states);
        }
        if let Some((rates, _)) = inner.input {
            motion.hold_input(rates.saturating_sub(1), operand.span);
        }
        motion.time |= inner.time;
        motion.depth = motion.depth.max(inner.depth);
    }
}

impl Motion {
    /// Holds an input of which so many rates are given.
    fn hold_input(&mut self, rates: u8, span: Span) {
        if self.input.is_none_or(|(fewest, _)| rates < fewest) {
            self.input = Some((rates, span));
        }
    }

    /// Adds what a definition depends on that is named at `span`.
    fn include(&mut self, known: &Self, span: Span, depth: usize) {
        self.values.extend(&known.values);
        self.rates.extend(&known.rates);
        self.states.extend(&known.states);
        self.state = self.state.or(known.state.map(|_| span));
        self.rate = self.rate.or(known.rate.map(|_| span));
        if let Some((rates, _)) = known.input {
            self.hold_input(rates, span);
        }
        self.reaction = self.reaction.or(known.reaction.map(|_| span));
        self.switch = self.switch.or(known.switch.map(|_| span));
        self.time |= known.time;
        self.depth = self.depth.max(depth + known.depth);
    }
}

/// Whether an expression holds more than numbers and parameters.
fn may_move(expr: &Expr) -> bool {
    let mut moves = false;
    expr.visit(&mut |part| {
        moves |= matches!(
            part.kind,
            ExprKind::Time
                | ExprKind::Coordinate(_)
                | ExprKind::Input(_)
                | ExprKind::State(_)
                | ExprKind::Definition(_)
                | ExprKind::Field(_)
                | ExprKind::ModeCoordinate(_)
        );
    });
    moves
}

fn rate_error(span: Span, inner: &Motion) -> Option<Diagnostic> {
    if let Some(place) = inner.reaction {
        let diagnostic = Diagnostic::error("the rate of what a constraint does is not known")
            .at(place, "this belongs to a constraint")
            .help("dot() takes a coordinate, a definition that holds one, or a field");
        return Some(diagnostic);
    }
    if inner.rate.is_some() {
        let diagnostic = Diagnostic::error("dot() of a rate is an acceleration")
            .at(span, "this holds a rate")
            .help("accelerations follow from the energies and appear nowhere in them");
        return Some(diagnostic);
    }
    if matches!(inner.input, Some((0, _))) {
        let diagnostic = Diagnostic::error("the rate of an input is not known")
            .at(span, "this holds an input")
            .help("`rates = 2` in its entry says that its rates are given as well");
        return Some(diagnostic);
    }
    let is_still = inner.values.is_empty() && inner.states.is_empty() && inner.input.is_none();
    if is_still && !inner.time {
        let diagnostic = Diagnostic::error("dot() of something that has no rate")
            .at(span, "this holds no coordinate")
            .help("dot() takes a coordinate, a definition that holds one, or a field");
        return Some(diagnostic);
    }
    None
}
