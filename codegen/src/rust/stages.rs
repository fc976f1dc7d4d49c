//! The emitted functions that are called with prepared coefficients, one per stage.

use super::body::{Body, looped};
use super::emit_error::Emitted;
use super::expression::{Expression, array, assignment, infix};
use super::file::{File, quantity_line};
use super::functions::Needed;
use super::layout::{DEEPER, SHALLOWER};
use super::literals::{block, doc};
use super::roots::mass_roots;
use crate::program::{Extent, Op, Request, ValueId};

/// What arguments and results of the rates are.
pub(super) const ORDER: &str = "`t` in s; `state` and the rates in the order of [`STATE_NAMES`].";

/// What an emitted function is called with and returns, beside what all are called with.
pub(super) struct Signature<'a> {
    pub(super) name: &'a str,
    /// Constants among the generic parameters, each with its comma.
    pub(super) constant: &'a str,
    /// Further arguments, a line each.
    pub(super) arguments: &'a str,
    /// Empty for nothing.
    pub(super) result: &'a str,
}

impl<'a> Signature<'a> {
    /// No more than a name and a result.
    pub(super) fn of(name: &'a str, result: &'a str) -> Self {
        Self {
            name,
            constant: "",
            arguments: "",
            result,
        }
    }
}

/// Of a mass matrix that varies with the state.
const NOT_DEFINITE: &str = "///\n\
    /// The mass matrix varies with the state. Where it is not positive definite, rates of velocities \
    are\n/// NaN, though [`Coefficients::positive_definite`], which knows the parameters alone, is true.\n";

/// The most numbers whose copy every compiler writes out: one cache line.
const COPIED_AT_ONCE: usize = 8;

impl File<'_> {
    /// The rates written to where the caller wants them, and the same returned: what is
    /// returned has to be filled with zeros first.
    pub(super) fn rates(&self, needed: &mut Needed) -> Emitted<String> {
        let body = self.body(&self.program.accelerations.all(), needed)?;
        let written = self.stage_with(
            &format!(
                "/// Rates of the state, written to `rates`.\n///\n/// {ORDER}\n{}\
                 #[allow(unused_variables)]\n",
                self.where_not_definite()
            ),
            &Signature {
                arguments: "rates: &mut [T; STATES],\n",
                ..Signature::of("rates_into", "")
            },
            &self.rates_statements(body)?,
        );
        let call = format!(
            "let mut rates = [T::number(0.0); STATES];\n\
             {}rates_into(t, state, inputs, coefficients, &mut rates);\n\
             rates\n",
            self.inlined()
        );
        let head = format!(
            "/// Rates of the state, returned.\n///\n/// {ORDER}\n{}",
            self.where_not_definite()
        );
        Ok(written + &self.stage(&head, "rates", "[T; STATES]", &call))
    }

    /// What is said of rates where the mass matrix may lose its definiteness.
    pub(super) fn where_not_definite(&self) -> &'static str {
        if self.program.may_lose_definiteness() {
            NOT_DEFINITE
        } else {
            ""
        }
    }

    /// The statements that write the rates out of a body that has their values.
    pub(super) fn rates_statements(&self, mut body: Body<'_>) -> Emitted<String> {
        let degrees = self.program.degrees_of_freedom();
        self.write_rates_of_positions(&mut body);
        self.write_row_values(&mut body, "rates", degrees, &self.program.accelerations)?;
        Ok(body.statements())
    }

    /// The first half of the rates stands in the state. Many numbers are copied two in a turn:
    /// one by one the compiler takes the loop for a copy of memory and calls a function for
    /// it, which costs more than the copy. For few it writes the copy out.
    fn write_rates_of_positions(&self, body: &mut Body<'_>) {
        let degrees = self.program.degrees_of_freedom();
        if degrees <= COPIED_AT_ONCE {
            let from = infix("+", degrees, "i");
            body.push_loop("i", degrees, &format!("rates[i] = state[{from}];"));
            return;
        }
        let from = |first: usize| infix("+", first, "2 * k");
        let pair = format!(
            "rates[2 * k] = state[{}];\nrates[2 * k + 1] = state[{}];",
            from(degrees),
            from(degrees + 1)
        );
        body.push_loop("k", degrees / 2, &pair);
        if degrees % 2 == 1 {
            let last = degrees - 1;
            body.push(&format!("rates[{last}] = state[{}];", degrees + last));
        }
    }

    pub(super) fn observables(&self, needed: &mut Needed) -> Emitted<String> {
        let program = self.program;
        let ids = &program.observable_values;
        let mut body = self.body(ids, needed)?;
        let values = ids
            .iter()
            .map(|id| body.scalar(*id))
            .collect::<Emitted<Vec<_>>>()?;
        body.push(&array(&values));
        let mut lines = Vec::new();
        for observable in &program.observables {
            lines.push(format!(
                "- `{}`: {}",
                observable.name,
                quantity_line(&observable.doc, &observable.unit, "")
            ));
        }
        let mut text = self.stage(
            &format!(
                "/// The observables, in the order of [`OBSERVABLE_NAMES`]:\n///\n\
                 {}#[allow(unused_variables)]\n",
                doc(&lines)
            ),
            "observables",
            "[T; OBSERVABLES]",
            &body.statements(),
        );
        for (name, id, line) in [
            (
                "energy",
                ids.len() - 2,
                "Kinetic plus potential energy, in J.",
            ),
            (
                "power",
                ids.len() - 1,
                "Power of all non-conservative forces, in W: the rate of the energy.",
            ),
        ] {
            text.push_str(&self.scalar_function(name, line, ids[id], needed)?);
        }
        Ok(text)
    }

    fn scalar_function(
        &self,
        name: &str,
        line: &str,
        id: ValueId,
        needed: &mut Needed,
    ) -> Emitted<String> {
        let mut body = self.body(&[id], needed)?;
        let value = body.scalar(id)?;
        body.push(&value.to_string());
        let head = format!("/// {line}\n#[allow(unused_variables)]\n");
        Ok(self.stage(&head, name, "T", &body.statements()))
    }

    pub(super) fn guards(&self, needed: &mut Needed) -> Emitted<String> {
        let ids: Vec<ValueId> = self.program.guards.iter().map(|g| g.value).collect();
        let line = "Switching surfaces: the equations change where one of these changes sign.";
        self.guard_values("guards", line, &ids, needed)
    }

    /// A function that returns a value for each guard.
    pub(super) fn guard_values(
        &self,
        name: &str,
        line: &str,
        ids: &[ValueId],
        needed: &mut Needed,
    ) -> Emitted<String> {
        let program = self.program;
        let mut body = self.body(ids, needed)?;
        body.push("let mut values = [T::number(0.0); GUARDS];");
        let mut place = 0;
        let mut lines = vec![line.to_owned(), String::new()];
        for (guard, id) in program.guards.iter().zip(ids) {
            match program.value(guard.value).extent {
                Extent::Vector(length) => {
                    let value = body.element(*id)?;
                    let at = infix("+", place, "i");
                    body.push_loop("i", length, &assignment(&format!("values[{at}]"), value));
                    place += length;
                }
                _ => {
                    let value = body.scalar(*id)?;
                    body.push(&assignment(&format!("values[{place}]"), value));
                    place += 1;
                }
            }
            lines.push(format!("- `{}`", guard.formula));
        }
        body.push("values");
        Ok(self.stage(
            &format!("{}#[allow(unused_variables, unused_mut)]\n", doc(&lines)),
            name,
            "[T; GUARDS]",
            &body.statements(),
        ))
    }

    pub(super) fn mass_matrix(&self, needed: &mut Needed) -> Emitted<String> {
        let program = self.program;
        let roots = mass_roots(program);
        let mut body = self.body(&roots, needed)?;
        body.push("let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];");
        for (row, entries) in program.mass.scalars.iter().enumerate() {
            for (column, id) in entries.iter().enumerate() {
                if matches!(program.value(*id).op, Op::Constant(0.0)) {
                    continue;
                }
                let value = body.scalar(*id)?;
                body.push(&assignment(&format!("values[{row}][{column}]"), value));
            }
        }
        self.write_coupling(&mut body)?;
        self.write_modal_blocks(&mut body)?;
        body.push("values");
        Ok(self.stage(
            "/// The mass matrix, in the order of the first half of [`STATE_NAMES`].\n\
             #[allow(unused_variables, unused_mut)]\n",
            "mass_matrix",
            "[[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM]",
            &body.statements(),
        ))
    }

    fn write_coupling(&self, body: &mut Body<'_>) -> Emitted<()> {
        let program = self.program;
        for (row, entries) in program.mass.coupling.iter().enumerate() {
            for (field, id) in entries.iter().enumerate() {
                let order = program.fields[field].order;
                if order == 0 || matches!(program.value(*id).op, Op::Constant(0.0)) {
                    continue;
                }
                let value = body.element(*id)?;
                let place = infix("+", program.mode_offset(field), "i");
                let entry = format!("values[{row}][{place}]");
                let upper = assignment(&entry, value);
                let lower = assignment(&format!("values[{place}][{row}]"), entry);
                body.push(looped("i", order, &format!("{upper}\n{lower}\n")).trim_end());
            }
        }
        Ok(())
    }

    fn write_modal_blocks(&self, body: &mut Body<'_>) -> Emitted<()> {
        let program = self.program;
        for (row, blocks) in program.mass.modal.iter().enumerate() {
            for (column, block) in blocks.iter().enumerate() {
                let Some(id) = block else { continue };
                let (rows, columns) = (program.fields[row].order, program.fields[column].order);
                if rows == 0 || columns == 0 {
                    continue;
                }
                let first_row = program.mode_offset(row);
                let first_column = program.mode_offset(column);
                let place = |i: &str, j: &str| {
                    let (row, column) = (infix("+", first_row, i), infix("+", first_column, j));
                    format!("values[{row}][{column}]")
                };
                let loops = body.block_loops(&program.value(*id).op, (rows, columns), &place)?;
                body.push(loops.trim_end());
            }
        }
        Ok(())
    }

    /// A function that is called with prepared coefficients.
    pub(super) fn stage(&self, head: &str, name: &str, result: &str, statements: &str) -> String {
        self.stage_with(head, &Signature::of(name, result), statements)
    }

    /// The same with more than a name and a result.
    pub(super) fn stage_with(&self, head: &str, with: &Signature<'_>, statements: &str) -> String {
        let &Signature {
            name,
            constant,
            arguments,
            result,
        } = with;
        let returned = if result.is_empty() {
            String::new()
        } else {
            format!(" -> {result}")
        };
        let signature = |name: &str, generics: &str, coefficients: &str| {
            format!(
                "pub fn {name}<{constant}{generics}>(\n\
                 {DEEPER}t: T,\n\
                 state: &[T; STATES],\n\
                 inputs: &{},\n\
                 coefficients: &{coefficients},\n\
                 {arguments}{SHALLOWER}){returned} {{",
                self.generic("Inputs"),
            )
        };
        let coefficients = self.generic("Coefficients");
        let whole = format!("{head}{}", signature(name, "T: Scalar", &coefficients));
        if !self.for_lanes() {
            return block(&whole, statements, "}");
        }
        let further: Vec<&str> = arguments
            .lines()
            .filter_map(|line| line.split(':').next())
            .collect();
        let passed = [
            &["t", "state", "inputs", "coefficients"],
            further.as_slice(),
        ]
        .concat();
        let passed: Vec<Expression> = passed.into_iter().map(Expression::atom).collect();
        let inlined = format!("{}{name}", self.inlined());
        let call = Expression::call(&format!("{inlined}{}", self.given(constant)), &passed);
        let call = format!("{call}\n");
        let allowed = head.lines().filter(|line| line.starts_with("#["));
        let allowed: String = allowed.map(|line| format!("{line}\n")).collect();
        let inlined_head = format!(
            "/// [`{name}`], inlined where it is called, to be compiled for the registers there.\n\
             {allowed}#[inline(always)]\n"
        );
        let generics = if self.fields.is_empty() {
            "T: Scalar"
        } else {
            "T: Scalar, C: Coefficient<T>"
        };
        let read = coefficients.replace("<T>", "<C>");
        let signature = signature(&inlined, generics, &read);
        block(&whole, &call, "}") + &block(&format!("{inlined_head}{signature}"), statements, "}")
    }

    /// What follows the name of a function for lanes that is called with constants.
    fn given(&self, constant: &str) -> String {
        let constants: Vec<&str> = constant
            .split(", ")
            .filter_map(|one| one.strip_prefix("const ")?.split(':').next())
            .collect();
        match (constants.is_empty(), self.fields.is_empty()) {
            (true, _) => String::new(),
            (false, true) => format!("::<{}, _>", constants.join(", ")),
            (false, false) => format!("::<{}, _, _>", constants.join(", ")),
        }
    }

    /// Whether every function is written a second time, for lanes.
    pub(super) fn for_lanes(&self) -> bool {
        self.program.requested.requests.contains(&Request::Lanes)
    }

    /// What the names of functions that emitted functions call begin with.
    pub(super) fn inlined(&self) -> &'static str {
        if self.for_lanes() { "inlined_" } else { "" }
    }
}
