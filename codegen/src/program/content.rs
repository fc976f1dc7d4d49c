//! Names of values by their content: a computation has the same name in every file, independent of the other values.

use super::{Argument, Op, Program, ValueId, Variable};
use crate::stable_hash::StableHash;

/// Largest number of characters of a name that is derived from a formula.
const MAX_SPELLED_LENGTH: usize = 24;
/// Largest number of operands in a formula from which a name is derived.
const MAX_SPELLED_OPERANDS: usize = 4;
/// Digits of hashes in names: letters and digits without characters that look alike.
const DIGITS: &[u8; 32] = b"abcdefghjkmnpqrstuvwxyz123456789";
/// Number of hash digits in a name. If two names are equal, more digits are used.
const HASH_LENGTH: usize = 5;

/// Hashes of the values of a program. A named operand is hashed by its name; therefore a change of a named quantity
/// does not change the names of the values that use it.
#[derive(Clone, Debug)]
pub struct Contents {
    hashes: Vec<u64>,
}

impl Contents {
    /// Computes the hash of each value.
    pub fn new(program: &Program) -> Self {
        let mut hashes: Vec<u64> = Vec::with_capacity(program.values.len());
        let mut named: Vec<u64> = Vec::with_capacity(program.values.len());
        for value in &program.values {
            let hash = hash_operation(program, &value.op, &named);
            hashes.push(hash);
            named.push(match &value.name {
                Some(name) => ContentHash::new("name").text(name).finish(),
                None => hash,
            });
        }
        Self { hashes }
    }

    /// Returns names for a value, the best first: its formula if the formula is short, then hashes of its content
    /// with an increasing number of digits.
    pub fn names(&self, program: &Program, id: ValueId) -> impl Iterator<Item = String> {
        let hash = self.hashes[id.index()];
        let digit = move |place: usize| DIGITS[(hash >> (5 * place)) as usize % 32] as char;
        let hashed = (HASH_LENGTH..=12).map(move |count| (0..count).map(digit).collect());
        write_formula_name(program, id).into_iter().chain(hashed)
    }
}

/// Hash of a value's content, to which the parts are added one by one.
struct ContentHash(StableHash);

impl ContentHash {
    fn new(kind: &str) -> Self {
        Self(StableHash::new()).text(kind)
    }

    fn number(self, number: u64) -> Self {
        Self(self.0.include(&number.to_le_bytes()))
    }

    fn text(self, text: &str) -> Self {
        Self(self.0.include(text.as_bytes())).number(text.len() as u64)
    }

    /// Returns the hash after mixing its bits, because the low bits of products depend on only few bits.
    fn finish(self) -> u64 {
        let hash = self.0.value();
        let mixed = (hash ^ (hash >> 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    }
}

fn hash_operation(program: &Program, op: &Op, operands: &[u64]) -> u64 {
    let hash = ContentHash::new(kind(op));
    let hash = match op {
        Op::Constant(number) => hash.number(number.to_bits()),
        Op::Call(function, _) => hash.text(function.name()),
        Op::Apply { transposed, .. } => hash.number(u64::from(*transposed)),
        Op::Assemble {
            diagonal,
            outer,
            matrices,
        } => {
            let shape = hash
                .number(u64::from(diagonal.is_some()))
                .number(outer.len() as u64);
            (matrices.iter()).fold(shape, |hash, part| hash.number(u64::from(part.transposed)))
        }
        _ => match leaf_name(program, op) {
            Some(name) => hash.text(&name),
            None => hash,
        },
    };
    let all = op.operands().into_iter();
    all.fold(hash, |hash, id| hash.number(operands[id.index()]))
        .finish()
}

fn kind(op: &Op) -> &'static str {
    match op {
        Op::Constant(_) => "constant",
        Op::Table(_) => "table",
        Op::Parameter(_) => "parameter",
        Op::Coordinate(_) => "coordinate",
        Op::Rate(_) => "rate",
        Op::ModeCoordinates(_) => "modes",
        Op::ModeRates(_) => "mode rates",
        Op::State(_) => "state",
        Op::Input(_) => "input",
        Op::Time => "time",
        Op::Argument(Argument::Accelerations, _) => "accelerations",
        Op::Argument(Argument::Direction, _) => "direction",
        Op::Argument(Argument::PointDirection, _) => "point direction",
        Op::Argument(Argument::Weights, _) => "weights",
        Op::Argument(Argument::Sides, _) => "sides",
        Op::Negate(_) => "negate",
        Op::Add(..) => "add",
        Op::Subtract(..) => "subtract",
        Op::Multiply(..) => "multiply",
        Op::Divide(..) => "divide",
        Op::Power(..) => "power",
        Op::Call(..) => "call",
        Op::Select { .. } => "select",
        Op::PivotReciprocal(_) => "pivot reciprocal",
        Op::Total(_) => "total",
        Op::Apply { .. } => "apply",
        Op::Gram { .. } => "gram",
        Op::GramDiagonal { .. } => "gram diagonal",
        Op::Assemble { .. } => "assemble",
        Op::Cholesky(_) => "cholesky",
        Op::CholeskySolve(..) => "cholesky solve",
    }
}

/// Returns the name of a leaf: time, parameter, state, input, argument or table.
pub(super) fn leaf_name(program: &Program, op: &Op) -> Option<String> {
    let variable = |variable: &Variable| match variable {
        Variable::Time => "t".to_owned(),
        Variable::Coordinate(index) => program.coordinates[*index].name.clone(),
        Variable::Rate(index) => format!("{}_dot", program.coordinates[*index].name),
        Variable::ModeCoordinates(field) => program.fields[*field].coordinates.clone(),
        Variable::ModeRates(field) => format!("{}_dot", program.fields[*field].coordinates),
        Variable::State(index) => program.first_order[*index].name.clone(),
        Variable::Input(index) => program.inputs[*index].name.clone(),
        Variable::Parameter(index) => program.parameters[index.index()].quantity.name.clone(),
    };
    Some(match op {
        Op::Table(place) => program.tables[*place].name.clone(),
        Op::Parameter(place) => program.parameters[*place].quantity.name.clone(),
        Op::Coordinate(index) => variable(&Variable::Coordinate(*index)),
        Op::Rate(index) => variable(&Variable::Rate(*index)),
        Op::ModeCoordinates(field) => variable(&Variable::ModeCoordinates(*field)),
        Op::ModeRates(field) => variable(&Variable::ModeRates(*field)),
        Op::State(index) => variable(&Variable::State(*index)),
        Op::Input(index) => variable(&Variable::Input(*index)),
        Op::Time => "t".to_owned(),
        Op::Argument(Argument::Sides, Variable::Input(index)) => format!("side_{}", index.index()),
        Op::Argument(_, of) => variable(of),
        _ => return None,
    })
}

/// Writes a short formula as part of a name: `3*k_sp` becomes `3_k_sp`, and `l/r_s` becomes `l_per_r_s`.
fn write_formula_name(program: &Program, id: ValueId) -> Option<String> {
    let mut operands = 0;
    let text = spell(program, id, true, &mut operands)?;
    let fits = text.len() <= MAX_SPELLED_LENGTH && operands > 1;
    fits.then_some(text)
}

fn spell(program: &Program, id: ValueId, root: bool, operands: &mut usize) -> Option<String> {
    let value = program.value(id);
    let name = match (&value.name, root) {
        (Some(name), false) => Some(name.clone()),
        _ => match &value.op {
            Op::Constant(number) if *number >= 0.0 && *number < 1e3 && number.fract() == 0.0 => {
                Some(format!("{number}"))
            }
            Op::Argument(..) => None,
            op => leaf_name(program, op),
        },
    };
    if let Some(name) = name {
        *operands += 1;
        return (*operands <= MAX_SPELLED_OPERANDS).then_some(name);
    }
    let is_sum = |id: ValueId| {
        let value = program.value(id);
        value.name.is_none() && matches!(value.op, Op::Add(..) | Op::Subtract(..) | Op::Negate(_))
    };
    let (a, word, b) = match value.op {
        Op::Multiply(a, b) if !is_sum(a) && !is_sum(b) => (a, "_", b),
        Op::Divide(a, b) if !is_sum(a) && !is_sum(b) => (a, "_per_", b),
        Op::Add(a, b) => (a, "_plus_", b),
        Op::Subtract(a, b) if !is_sum(b) => (a, "_minus_", b),
        Op::Negate(a) if !is_sum(a) => {
            return Some(format!("minus_{}", spell(program, a, false, operands)?));
        }
        _ => return None,
    };
    let a = spell(program, a, false, operands)?;
    let b = spell(program, b, false, operands)?;
    Some(format!("{a}{word}{b}"))
}
