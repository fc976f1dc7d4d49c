//! Finds the coordinates, rates, states and inputs of each expression, also through
//! definitions, and checks them: energies contain no states and only inputs with given rates,
//! potentials no rates, a force acts on a quantity that moves, every coordinate has inertia.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::id_set::IdSet;
use crate::ids::{CoordinateId, FieldId, InputId};
use crate::model::{
    Constraint, Expr, ExprKind, MAX_CONSTRAINTS, MAX_IMPACTS, Model, Term, written_name,
};
use crate::rate_order::{Expanded, rate_order};
use crate::span::Span;

/// Largest accepted depth of an expression after expansion of its definitions.
pub const MAX_EXPANDED_DEPTH: usize = 600;

/// Returns the index of a coordinate among coordinates and fields.
fn coordinate_index(coordinate: CoordinateId) -> usize {
    2 * coordinate.index()
}

/// Returns the index of a field among coordinates and fields.
fn field_index(field: FieldId) -> usize {
    2 * field.index() + 1
}

#[derive(Clone, Debug, Default)]
struct Dependencies {
    /// Coordinates and fields whose values occur.
    values: IdSet,
    /// Coordinates and fields whose rates occur.
    rates: IdSet,
    /// Position of the first rate.
    rate: Option<Span>,
    /// States whose values occur.
    states: IdSet,
    /// Position of the first state, or rate of a state.
    state: Option<Span>,
    /// Number of given rates and position of the input with the fewest given rates.
    input: Option<(u8, Span)>,
    /// Position of the first multiplier or residual of a constraint.
    reaction: Option<Span>,
    /// Position of the first function that switches during the motion.
    switch: Option<Span>,
    time: bool,
    /// Depth after expansion of definitions.
    depth: usize,
}

/// Checks the dependencies of every expression of a model, and sets `is_nonholonomic` of the
/// constraints.
pub fn check(model: &mut Model, found: &mut Diagnostics) {
    let nonholonomic = check_expressions(model, found);
    for (constraint, is_nonholonomic) in model.constraints.iter_mut().zip(nonholonomic) {
        constraint.is_nonholonomic = is_nonholonomic;
    }
}

/// Checks all expressions. Returns one flag per constraint, which is true if the constraint contains rates.
fn check_expressions(model: &Model, found: &mut Diagnostics) -> Vec<bool> {
    let mut checker = Checker {
        definitions: vec![Dependencies::default(); model.definitions.len()],
        state_rates: vec![0; model.states.len()],
        model,
        found,
    };
    // There are no cycles: `resolve` has rejected them.
    for written in rate_order(model).unwrap_or_default() {
        match written {
            Expanded::Definition(index) => {
                checker.definitions[index] =
                    checker.find_dependencies(&model.definitions[index].value);
            }
            Expanded::Rate(index) => {
                checker.state_rates[index.index()] =
                    checker.find_dependencies(&model.states[index].rate).depth;
            }
            Expanded::RatesWithin(_) => {}
        }
    }
    checker.check_energies();
    checker.check_forces();
    let nonholonomic = checker.check_constraints();
    checker.check_impacts();
    for observable in &model.observables {
        checker.find_dependencies_with_reactions(&observable.value);
    }
    nonholonomic
}

struct Checker<'m, 'f> {
    model: &'m Model,
    definitions: Vec<Dependencies>,
    /// Depth of the rates of the states, after expansion of definitions.
    state_rates: Vec<usize>,
    found: &'f mut Diagnostics,
}

impl Checker<'_, '_> {
    fn check_energies(&mut self) {
        let model = self.model;
        let mut inertial = IdSet::default();
        for term in &model.kinetic {
            let motion = self.find_dependencies(&term.value);
            self.reject_inputs_and_states(term, &motion, "the kinetic energy");
            inertial.extend(&motion.rates);
        }
        for term in &model.potential {
            let motion = self.find_dependencies(&term.value);
            self.reject_inputs_and_states(term, &motion, "the potential energy");
            if let Some(place) = motion.rate {
                self.found.push(
                    Diagnostic::error(format!(
                        "the potential energy `{}` contains a rate",
                        term.name
                    ))
                    .with_span(place, "this is a rate")
                    .with_help("move the term to [kinetic] if it is a kinetic energy, or to [dissipation] if it dissipates energy"),
                );
            }
        }
        for term in &model.dissipation {
            let motion = self.find_dependencies(&term.value);
            self.reject_inputs_and_states(term, &motion, "the dissipation");
        }
        if self.found.is_empty() {
            self.reject_massless(&inertial);
        }
    }

    /// Rejects inputs and states in an energy.
    fn reject_inputs_and_states(&mut self, term: &Term, motion: &Dependencies, what: &str) {
        if let Some((0, place)) = motion.input {
            self.found.push(
                Diagnostic::error(format!("{what} `{}` contains an input", term.name))
                    .with_span(place, "this input has no given rate")
                    .with_help(
                        "inputs act only through [forces]; declare the rates of a prescribed motion: \
                         rates = 2",
                    ),
            );
        }
        if let Some(place) = motion.state {
            self.found.push(
                Diagnostic::error(format!("{what} `{}` contains a state", term.name))
                    .with_span(place, "this is a state")
                    .with_help("states act only through [forces]"),
            );
        }
    }

    /// Rejects coordinates without inertia: their acceleration would be undetermined.
    fn reject_massless(&mut self, inertial: &IdSet) {
        let mut refuse = |name: &str, kind: &str, span: Span| {
            self.found.push(
                Diagnostic::error(format!("the {kind} `{name}` has no inertia"))
                    .with_span(span, "no term of [kinetic] contains its rate")
                    .with_help(format!(
                        "add a kinetic energy, for example 1/2*m*dot({name})^2"
                    )),
            );
        };
        for (index, coordinate) in self.model.coordinates.iter().enumerate() {
            if !inertial.contains(coordinate_index(CoordinateId::new(index))) {
                refuse(&coordinate.name, "coordinate", coordinate.span);
            }
        }
        for (index, field) in self.model.fields.iter().enumerate() {
            if !inertial.contains(field_index(FieldId::new(index))) {
                refuse(&field.name, "field", field.span);
            }
        }
    }

    fn check_forces(&mut self) {
        let model = self.model;
        for force in &model.forces {
            self.find_dependencies(&force.value);
            let on = self.find_dependencies(&force.on);
            let problem = if let Some(place) = on.rate {
                Some((place, "this is a rate"))
            } else if let Some((0, place)) = on.input {
                Some((place, "this is an input"))
            } else if let Some(place) = on.state {
                Some((place, "this is a state"))
            } else if on.values.is_empty() {
                Some((force.on.span, "this does not depend on a coordinate"))
            } else {
                None
            };
            if let Some((place, why)) = problem {
                let name = written_name(&force.name, force.span, &self.model.source);
                self.found.push(
                    Diagnostic::error(format!("`on` of the force `{name}` is not a displacement"))
                        .with_span(place, why)
                        .with_help("give `on` a coordinate, or an expression of coordinates"),
                );
            }
        }
    }

    fn check_constraints(&mut self) -> Vec<bool> {
        let model = self.model;
        if let Some(excess) = model.constraints.get(MAX_CONSTRAINTS) {
            self.found.push(
                Diagnostic::error(format!(
                    "the model has too many constraints: {}",
                    model.constraints.len()
                ))
                .with_span(excess.span, "one constraint too many")
                .with_help(format!("give at most {MAX_CONSTRAINTS} constraints")),
            );
            return Vec::new();
        }
        model
            .constraints
            .iter()
            .map(|constraint| self.check_constraint(constraint))
            .collect()
    }

    /// Checks a constraint. Returns true if it contains rates.
    fn check_constraint(&mut self, constraint: &Constraint) -> bool {
        let motion = self.find_dependencies(&constraint.zero);
        let span = constraint.zero.span;
        let is_nonholonomic = motion.rate.is_some() && !motion.rates.is_empty();
        let needed = if is_nonholonomic { 1 } else { 2 };
        let problem = if let Some(place) = motion.state {
            let help =
                "a constraint contains only coordinates, their rates, prescribed motion and t";
            Some((place, "this is a state", help))
        } else if let Some((given, place)) = motion.input.filter(|(given, _)| *given < needed) {
            let help = "its second derivative must be given: declare the input with rates = 2";
            let why = match given {
                0 => "this input has no given rate",
                _ => "this rate has no given second derivative",
            };
            Some((place, why, help))
        } else if let Some(place) = motion.switch {
            let help =
                "a constraint must be smooth; move a contact that opens and closes to [impacts]";
            Some((place, "this switches", help))
        } else if motion.values.is_empty() && motion.rates.is_empty() {
            let help = "give an expression of coordinates, for example x^2 + y^2 - l^2";
            Some((span, "this contains no coordinate", help))
        } else {
            None
        };
        if let Some((place, why, help)) = problem {
            self.found.push(
                Diagnostic::error(format!("`{}` is not a valid constraint", constraint.name))
                    .with_span(place, why)
                    .with_help(help),
            );
        }
        is_nonholonomic
    }

    fn check_impacts(&mut self) {
        let model = self.model;
        if let Some(excess) = model.impacts.get(MAX_IMPACTS) {
            self.found.push(
                Diagnostic::error(format!(
                    "the model has too many impacts: {}",
                    model.impacts.len()
                ))
                .with_span(excess.span, "one impact too many")
                .with_help(format!("give at most {MAX_IMPACTS} impacts")),
            );
            return;
        }
        for impact in &model.impacts {
            let motion = self.find_dependencies(&impact.when);
            let problem = if let Some(place) = motion.rate {
                Some((place, "this is a rate", "give a distance"))
            } else if let Some(place) = motion.state {
                let help = "a distance contains only coordinates, prescribed motion and t";
                Some((place, "this is a state", help))
            } else if let Some((_, place)) = motion.input.filter(|(given, _)| *given < 2) {
                let help = "its second derivative must be given: declare the input with rates = 2";
                Some((place, "this input has no given rates", help))
            } else if let Some(place) = motion.switch {
                let help = "declare an impact for each smooth distance, and give prescribed motion without max, min, abs and above";
                Some((place, "this switches", help))
            } else if motion.values.is_empty() {
                let help = "give a distance between bodies, for example y, or x_2 - x_1 - d";
                Some((impact.when.span, "this contains no coordinate", help))
            } else {
                None
            };
            if let Some((place, why, help)) = problem {
                self.found.push(
                    Diagnostic::error(format!("`{}` is not a valid impact", impact.name))
                        .with_span(place, why)
                        .with_help(help),
                );
            }
            if let Some(friction) = &impact.friction {
                self.check_slip(&impact.name, &friction.slip);
            }
        }
    }

    /// Checks the slip of a contact with friction.
    fn check_slip(&mut self, impact: &str, slip: &Expr) {
        let motion = self.find_dependencies(slip);
        let problem = if let Some(place) = motion.state {
            let help = "a slip contains only coordinates, their rates, prescribed motion and t";
            Some((place, "this is a state", help))
        } else if let Some((_, place)) = motion.input.filter(|(given, _)| *given < 1) {
            let help = "its rate must be given: declare the input with rates = 2";
            Some((place, "this input has no given rate", help))
        } else if let Some(place) = motion.switch {
            let help = "a slip is smooth: give the velocity with its sign, because friction acts against it. Declare a motion \
                        that switches with the time, as of a belt, as an input with rates = 2";
            Some((place, "this switches", help))
        } else if motion.rates.is_empty() {
            let help = "give a velocity, for example dot(x) - r*dot(phi)";
            Some((slip.span, "this contains no rate of a coordinate", help))
        } else {
            None
        };
        if let Some((place, why, help)) = problem {
            self.found.push(
                Diagnostic::error(format!("the slip of `{impact}` is not valid"))
                    .with_span(place, why)
                    .with_help(help),
            );
        }
    }

    fn count_given_rates(&self, input: InputId) -> u8 {
        let inputs = &self.model.inputs;
        let rates = std::iter::successors(inputs[input].rate, |rate| inputs[*rate].rate);
        u8::try_from(rates.count()).unwrap_or(u8::MAX)
    }

    /// Returns the dependencies of an expression. Reports invalid uses of `dot`, multipliers and
    /// residuals.
    fn find_dependencies(&mut self, expr: &Expr) -> Dependencies {
        let motion = self.find_dependencies_with_reactions(expr);
        if let Some(place) = motion.reaction {
            self.found.push(
                Diagnostic::error("multipliers and residuals are allowed only in [observables]")
                    .with_span(place, "this is the multiplier or residual of a constraint")
                    .with_help(
                        "they follow from the motion, so the motion cannot depend on them; for friction proportional to \
                         the force of a guide, replace its constraint by two [impacts] with `friction`",
                    ),
            );
        }
        motion
    }

    fn find_dependencies_with_reactions(&mut self, expr: &Expr) -> Dependencies {
        let mut motion = Dependencies::default();
        self.add_dependencies(expr, &mut motion, 1);
        if motion.depth > MAX_EXPANDED_DEPTH {
            self.found.push(
                Diagnostic::error(format!(
                    "the expression has more than {MAX_EXPANDED_DEPTH} nested levels after its definitions are inserted"
                ))
                .with_span(expr.span, "too deep"),
            );
            motion.depth = 0;
        }
        motion
    }

    fn add_dependencies(&mut self, expr: &Expr, motion: &mut Dependencies, depth: usize) {
        motion.depth = motion.depth.max(depth);
        match &expr.kind {
            ExprKind::Time => motion.time = true,
            ExprKind::Input(index) => motion.add_input(self.count_given_rates(*index), expr.span),
            ExprKind::State(index) => {
                motion.states.insert(index.index());
                motion.state = motion.state.or(Some(expr.span));
            }
            ExprKind::Coordinate(index) => {
                motion.values.insert(coordinate_index(*index));
            }
            ExprKind::Field(field)
            | ExprKind::ModeCoordinate(field)
            | ExprKind::SingleMode { field, .. } => {
                motion.values.insert(field_index(*field));
            }
            ExprKind::Definition(index) => {
                if let Some(known) = self.definitions.get(index.index()) {
                    motion.add_definition(known, expr.span, depth);
                }
            }
            ExprKind::Dot(operand) => self.add_rate(operand, motion, depth),
            ExprKind::Diff(part, _) | ExprKind::Negate(part) => {
                self.add_dependencies(part, motion, depth + 1)
            }
            ExprKind::Integral { integrand, .. } => {
                self.add_dependencies(integrand, motion, depth + 1)
            }
            ExprKind::Sum { summand, .. } => self.add_dependencies(summand, motion, depth + 1),
            ExprKind::At { value, .. } => self.add_dependencies(value, motion, depth + 1),
            ExprKind::Binary(_, left, right) => {
                self.add_dependencies(left, motion, depth + 1);
                self.add_dependencies(right, motion, depth + 1);
            }
            ExprKind::Call(function, arguments) => {
                for argument in arguments {
                    self.add_dependencies(argument, motion, depth + 1);
                }
                if function.has_switches() && arguments.iter().any(may_move) {
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

    fn add_rate(&mut self, operand: &Expr, motion: &mut Dependencies, depth: usize) {
        let mut inner = Dependencies::default();
        self.add_dependencies(operand, &mut inner, depth + 1);
        if let Some(diagnostic) = rate_error(operand.span, &inner) {
            self.found.push(diagnostic);
        }
        motion.state = motion.state.or(inner.state.map(|_| operand.span));
        motion.reaction = motion.reaction.or(inner.reaction);
        motion.switch = motion.switch.or(inner.switch);
        let deepest = inner.states.iter().map(|state| self.state_rates[state]);
        motion.depth = motion.depth.max(depth + 1 + deepest.max().unwrap_or(0));
        if !inner.is_function_of_time() {
            motion.rate = motion.rate.or(Some(operand.span));
        }
        motion.rates.extend(&inner.values);
        // The rate of a definition or of `at` depends on the coordinates, too.
        if matches!(operand.kind, ExprKind::Definition(_) | ExprKind::At { .. }) {
            motion.values.extend(&inner.values);
            motion.states.extend(&inner.states);
        }
        if let Some((rates, _)) = inner.input {
            motion.add_input(rates.saturating_sub(1), operand.span);
        }
        motion.time |= inner.time;
        motion.depth = motion.depth.max(inner.depth);
    }
}

impl Dependencies {
    /// Returns true if the value depends only on parameters and the time.
    fn is_function_of_time(&self) -> bool {
        let is_moved = self.rate.is_some() || !self.values.is_empty() || !self.states.is_empty();
        !is_moved && self.input.is_none()
    }

    /// Adds an input with this number of given rates.
    fn add_input(&mut self, rates: u8, span: Span) {
        if self.input.is_none_or(|(fewest, _)| rates < fewest) {
            self.input = Some((rates, span));
        }
    }

    /// Adds the dependencies of a definition that is named at `span`.
    fn add_definition(&mut self, known: &Self, span: Span, depth: usize) {
        self.values.extend(&known.values);
        self.rates.extend(&known.rates);
        self.states.extend(&known.states);
        self.state = self.state.or(known.state.map(|_| span));
        self.rate = self.rate.or(known.rate.map(|_| span));
        if let Some((rates, _)) = known.input {
            self.add_input(rates, span);
        }
        self.reaction = self.reaction.or(known.reaction.map(|_| span));
        self.switch = self.switch.or(known.switch.map(|_| span));
        self.time |= known.time;
        self.depth = self.depth.max(depth + known.depth);
    }
}

/// Returns true if an expression contains more than numbers and parameters.
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
                | ExprKind::SingleMode { .. }
        );
    });
    moves
}

fn rate_error(span: Span, inner: &Dependencies) -> Option<Diagnostic> {
    if let Some(place) = inner.reaction {
        let diagnostic = Diagnostic::error("dot() of a multiplier or a residual is not available")
            .with_span(place, "this is the multiplier or residual of a constraint")
            .with_help("give dot() a coordinate, a definition with one, or a field");
        return Some(diagnostic);
    }
    if inner.rate.is_some() {
        let diagnostic = Diagnostic::error("dot() of a rate is an acceleration")
            .with_span(span, "this contains a rate")
            .with_help("a specification contains no accelerations: they follow from the energies");
        return Some(diagnostic);
    }
    if matches!(inner.input, Some((0, _))) {
        let diagnostic = Diagnostic::error("the input has no given rate")
            .with_span(span, "this contains an input")
            .with_help("add `rates = 2` to the input to supply its rates");
        return Some(diagnostic);
    }
    let is_still = inner.values.is_empty() && inner.states.is_empty() && inner.input.is_none();
    if is_still && !inner.time {
        let diagnostic = Diagnostic::error("dot() of a quantity without a rate")
            .with_span(span, "this contains no coordinate")
            .with_help("give dot() a coordinate, a definition with one, or a field");
        return Some(diagnostic);
    }
    None
}
