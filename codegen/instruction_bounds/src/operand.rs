//! Operands of instructions.

use crate::value::Shift;

/// Operand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operand {
    /// Core register.
    Register(u8),
    /// Core register with write-back, for example the base of `ldmia`.
    Updated(u8),
    /// Constant.
    Number(u32),
    /// Core registers in braces.
    Registers(Vec<u8>),
    /// Registers of the floating-point unit, one or several in braces: their number of 32-bit words.
    Floats(u32),
    /// Address in memory.
    Memory(Memory),
    /// Shift of the preceding operand by a constant.
    Shifted(Shift, u32),
    /// Shift of the preceding operand by a register.
    ShiftedBy(Shift, u8),
    /// Target of a jump: offset in the section.
    Target(u64),
    /// Any other word.
    Word(String),
}

/// Address in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Register.
    pub base: u8,
    /// Constant offset.
    pub offset: i32,
    /// Register that is added, and the number of bits by which it is shifted to the left.
    pub index: Option<(u8, u32)>,
    /// True if the address is stored in the register before the access.
    pub is_updated: bool,
}

/// Parses the operands of an instruction.
pub fn parse_operands(text: &str) -> Vec<Operand> {
    split_operands(text)
        .into_iter()
        .map(parse_operand)
        .collect()
}

/// Returns the number of a core register.
pub fn register(name: &str) -> Option<u8> {
    match name {
        "sb" => Some(9),
        "sl" => Some(10),
        "fp" => Some(11),
        "ip" => Some(12),
        "sp" => Some(13),
        "lr" => Some(14),
        "pc" => Some(15),
        _ => {
            let number: u8 = name.strip_prefix('r')?.parse().ok()?;
            (number < 16).then_some(number)
        }
    }
}

/// Splits a text at the commas outside brackets and braces.
fn split_operands(text: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut begin) = (Vec::new(), 0, 0);
    for (place, letter) in text.char_indices() {
        match letter {
            '[' | '{' => depth += 1,
            ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(text[begin..place].trim());
                begin = place + 1;
            }
            _ => {}
        }
    }
    parts.push(text[begin..].trim());
    parts.retain(|part| !part.is_empty());
    parts
}

fn parse_operand(text: &str) -> Operand {
    let word = || Operand::Word(text.to_owned());
    if let Some(number) = text.strip_prefix('#') {
        return parse_number(number).map_or_else(word, Operand::Number);
    }
    if let Some(register) = register(text) {
        return Operand::Register(register);
    }
    if let Some(register) = text.strip_suffix('!').and_then(register) {
        return Operand::Updated(register);
    }
    if let Some(list) = text.strip_prefix('{') {
        return parse_list(list.trim_end_matches('}')).unwrap_or_else(word);
    }
    if let Some(inner) = text.strip_prefix('[') {
        return parse_memory(inner).map_or_else(word, Operand::Memory);
    }
    if let Some(words) = float_words(text) {
        return Operand::Floats(words);
    }
    if let Some(shift) = shift(text) {
        return shift;
    }
    let target = text.split_whitespace().next().unwrap_or_default();
    match u64::from_str_radix(target, 16) {
        Ok(target) => Operand::Target(target),
        Err(_) => word(),
    }
}

fn parse_number(text: &str) -> Option<u32> {
    let number: i64 = match text.strip_prefix("0x") {
        Some(digits) => i64::from_str_radix(digits, 16).ok()?,
        None => text.parse().ok()?,
    };
    Some(number as u32)
}

/// Returns the number of 32-bit words of a register such as `s5`, `d5` or `d5[1]`.
fn float_words(text: &str) -> Option<u32> {
    let words = match text.chars().next()? {
        's' => 1,
        'd' => 2,
        _ => return None,
    };
    let number = text[1..].split('[').next()?;
    number.parse::<u8>().ok().map(|_| words)
}

fn parse_list(list: &str) -> Option<Operand> {
    let mut cores = Vec::new();
    let mut words = 0;
    for item in list.split(',').map(str::trim) {
        let (first, last) = item.split_once('-').unwrap_or((item, item));
        if let (Some(first), Some(last)) = (register(first), register(last)) {
            cores.extend(first..=last);
        } else {
            let each = float_words(first)?;
            let number = |name: &str| name[1..].parse::<u32>().ok();
            words += each * (number(last)?.checked_sub(number(first)?)? + 1);
        }
    }
    match (cores.is_empty(), words) {
        (false, 0) => Some(Operand::Registers(cores)),
        (true, words) => Some(Operand::Floats(words)),
        _ => None,
    }
}

/// Parses the text after `[`.
fn parse_memory(inner: &str) -> Option<Memory> {
    let (inside, after) = inner.split_once(']')?;
    let mut parts = inside.split(',').map(str::trim);
    let base = register(parts.next()?)?;
    let (mut offset, mut index) = (0, None);
    if let Some(part) = parts.next() {
        match part.strip_prefix('#') {
            Some(number) => offset = parse_number(number)? as i32,
            None => {
                let places = match parts.next() {
                    None => 0,
                    Some(shift) => parse_number(shift.strip_prefix("lsl #")?)?,
                };
                index = Some((register(part)?, places));
            }
        }
    }
    Some(Memory {
        base,
        offset,
        index,
        is_updated: after == "!",
    })
}

fn shift(text: &str) -> Option<Operand> {
    let (kind, by) = text.split_once(' ').unwrap_or((text, ""));
    let kind = match kind {
        "lsl" => Shift::Left,
        "lsr" => Shift::Right,
        "asr" => Shift::Arithmetic,
        "ror" => Shift::Rotate,
        "rrx" => return Some(Operand::Shifted(Shift::Extended, 1)),
        _ => return None,
    };
    match by.strip_prefix('#') {
        Some(places) => Some(Operand::Shifted(kind, parse_number(places)?)),
        None => Some(Operand::ShiftedBy(kind, register(by)?)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operands_of_objdump_are_read() {
        let of_stack = |offset, is_updated| {
            Operand::Memory(Memory {
                base: 13,
                offset,
                index: None,
                is_updated,
            })
        };
        let cases = [
            (
                "sl, fp, [sp, #40]",
                vec![
                    Operand::Register(10),
                    Operand::Register(11),
                    of_stack(40, false),
                ],
            ),
            (
                "lr, [sp, #-8]!",
                vec![Operand::Register(14), of_stack(-8, true)],
            ),
            (
                "r0, [sp], #4",
                vec![Operand::Register(0), of_stack(0, false), Operand::Number(4)],
            ),
            (
                "sp!, {r4-r6, pc}",
                vec![Operand::Updated(13), Operand::Registers(vec![4, 5, 6, 15])],
            ),
            ("{d8-d9}", vec![Operand::Floats(4)]),
            (
                "r1, r1, lsr #12",
                vec![
                    Operand::Register(1),
                    Operand::Register(1),
                    Operand::Shifted(Shift::Right, 12),
                ],
            ),
            (
                "r0, rrx",
                vec![Operand::Register(0), Operand::Shifted(Shift::Extended, 1)],
            ),
            (
                "r0, 15ae <rates+0x3e>",
                vec![Operand::Register(0), Operand::Target(0x15ae)],
            ),
            (
                "ip, #4294967295",
                vec![Operand::Register(12), Operand::Number(u32::MAX)],
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(parse_operands(text), expected, "{text}");
        }
    }
}
