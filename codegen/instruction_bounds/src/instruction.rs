//! Instructions with their conditions, decoded from lines of the disassembly.

use std::collections::{BTreeMap, BTreeSet};

use crate::listing::{CodeAddress, Line, Listing};
use crate::operand::{Operand, parse_operands};
use crate::value::Flags;

/// Decoded instruction.
#[derive(Clone, Debug)]
pub struct Instruction {
    /// Mnemonic without the suffixes for width, type, condition and flags (`s`).
    pub name: String,
    /// True if the instruction sets the flags.
    pub sets_flags: bool,
    /// Condition.
    pub condition: Condition,
    /// Operands.
    pub operands: Vec<Operand>,
    /// Length, in bytes.
    pub size: u64,
    /// Symbol of the relocation, if there is one.
    pub symbol: Option<String>,
}

impl Instruction {
    /// Returns the register that is the operand with this index.
    pub fn register(&self, place: usize) -> Option<u8> {
        match self.operands.get(place) {
            Some(Operand::Register(number)) => Some(*number),
            _ => None,
        }
    }
}

/// Condition of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The instruction is always executed.
    Always,
    /// Condition with this suffix.
    If(&'static str),
}

const CONDITIONS: [&str; 16] = [
    "eq", "ne", "cs", "cc", "hs", "lo", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le",
];

impl Condition {
    fn from_suffix(suffix: &str) -> Option<Self> {
        let known = CONDITIONS.iter().find(|known| **known == suffix);
        known.map(|known| Self::If(known))
    }

    /// Returns the opposite condition, which is adjacent in the list.
    fn opposite(self) -> Self {
        match self {
            Self::Always => self,
            Self::If(suffix) => {
                let place = CONDITIONS.iter().position(|known| *known == suffix);
                Self::If(CONDITIONS[place.unwrap_or_default() ^ 1])
            }
        }
    }

    /// Returns the value of the condition, if known.
    pub fn value(self, flags: Flags) -> Option<bool> {
        let Self::If(suffix) = self else {
            return Some(true);
        };
        let Flags { n, z, c, v } = flags;
        let not = |flag: Option<bool>| flag.map(|flag| !flag);
        let signed = n.zip(v).map(|(n, v)| n == v);
        let both = |left: Option<bool>, right: Option<bool>| match (left, right) {
            (Some(true), Some(true)) => Some(true),
            (Some(false), _) | (_, Some(false)) => Some(false),
            _ => None,
        };
        match suffix {
            "eq" => z,
            "ne" => not(z),
            "cs" | "hs" => c,
            "cc" | "lo" => not(c),
            "mi" => n,
            "pl" => not(n),
            "vs" => v,
            "vc" => not(v),
            "hi" => both(c, not(z)),
            "ls" => not(both(c, not(z))),
            "ge" => signed,
            "lt" => not(signed),
            "gt" => both(signed, not(z)),
            _ => not(both(signed, not(z))),
        }
    }
}

/// Decodes all instructions of a listing. Returns the instructions and the targets of jumps.
pub fn decode(listing: &Listing) -> (BTreeMap<CodeAddress, Instruction>, BTreeSet<CodeAddress>) {
    let mut instructions = BTreeMap::new();
    let mut targets = BTreeSet::new();
    let mut conditions: Vec<Condition> = Vec::new();
    for (&place, line) in &listing.lines {
        if line.is_data() {
            conditions.clear();
            continue;
        }
        let condition = conditions.pop();
        let instruction = parse_instruction(line, condition);
        if let Some(rest) = instruction.name.strip_prefix("it") {
            conditions = read_block(rest, &line.operands);
        } else if instruction.name != "bl" {
            for operand in &instruction.operands {
                if let Operand::Target(target) = operand {
                    targets.insert(place >> 32 << 32 | target);
                }
            }
        }
        instructions.insert(place, instruction);
    }
    (instructions, targets)
}

/// Returns the conditions of the instructions in the block after `it`, in reverse order. `rest` are the letters after
/// `it` in the mnemonic.
fn read_block(rest: &str, suffix: &str) -> Vec<Condition> {
    let Some(first) = Condition::from_suffix(suffix) else {
        return Vec::new();
    };
    let rest = rest.chars().map(|letter| match letter {
        'e' => first.opposite(),
        _ => first,
    });
    let mut conditions: Vec<Condition> = std::iter::once(first).chain(rest).collect();
    conditions.reverse();
    conditions
}

fn parse_instruction(line: &Line, in_block: Option<Condition>) -> Instruction {
    let mut name = line
        .mnemonic
        .split('.')
        .next()
        .unwrap_or_default()
        .to_owned();
    let mut condition = in_block.unwrap_or(Condition::Always);
    match in_block {
        Some(Condition::If(suffix)) => {
            if let Some(stripped) = name.strip_suffix(suffix) {
                name = stripped.to_owned();
            }
        }
        _ => {
            let of_branch = name.strip_prefix('b').and_then(Condition::from_suffix);
            if let Some(of_branch) = of_branch {
                condition = of_branch;
                name = "b".to_owned();
            }
        }
    }
    let mut sets_flags = matches!(&*name, "cmp" | "cmn" | "tst" | "teq" | "vmrs");
    let has_s = name.ends_with('s') && !name.starts_with('v') && name.len() > 3;
    if has_s {
        name.pop();
        sets_flags = true;
    }
    Instruction {
        name,
        sets_flags,
        condition,
        operands: parse_operands(&line.operands),
        size: line.size(),
        symbol: line.symbol.clone(),
    }
}
