//! Output of `objdump -t -d -r`: symbols, instructions, words of data and relocations.

use std::collections::BTreeMap;

/// Address of an instruction. The upper half is the number of the section, the lower half the offset in the section.
pub type CodeAddress = u64;

/// Disassembled object.
#[derive(Debug, Default)]
pub struct Listing {
    /// Instructions and data by address.
    pub lines: BTreeMap<CodeAddress, Line>,
    /// Numbers assigned to the symbols of relocations.
    pub symbols: BTreeMap<String, usize>,
    /// Functions by name.
    pub functions: BTreeMap<String, Function>,
    /// Names of functions by address. If several functions have one address, this is the last name.
    names: BTreeMap<CodeAddress, String>,
    sections: Vec<String>,
}

/// Function of the symbol table.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Address of the first instruction.
    pub code_address: CodeAddress,
    /// Length, in bytes.
    pub size: u64,
    /// True if the function is visible outside the object.
    pub is_global: bool,
}

/// Line of the disassembly.
#[derive(Debug, Default)]
pub struct Line {
    /// Bytes as hexadecimal digits, as printed.
    pub bytes: String,
    /// Mnemonic; for data a directive such as `.word`.
    pub mnemonic: String,
    /// Operands without comment.
    pub operands: String,
    /// Symbol of the relocation, if there is one.
    pub symbol: Option<String>,
}

/// Required format of the object, as objdump prints it.
const FORMAT: &str = "elf32-littlearm";

impl Line {
    /// Returns the length of the line, in bytes.
    pub fn size(&self) -> u64 {
        (self.bytes.bytes().filter(u8::is_ascii_hexdigit).count() / 2) as u64
    }

    /// Returns true for data between instructions.
    pub fn is_data(&self) -> bool {
        self.mnemonic.starts_with('.')
    }
}

impl Listing {
    /// Reads the output of objdump.
    ///
    /// # Errors
    /// The output does not describe an object for a Cortex-M that contains instructions.
    pub fn read(text: &str) -> Result<Self, String> {
        if !text.contains(FORMAT) {
            let format = text.split_once("file format ").map_or("", |(_, rest)| rest);
            let format = format.lines().next().unwrap_or_default();
            return Err(format!("the object is {format} instead of {FORMAT}"));
        }
        let mut listing = Self::default();
        let mut symbols = Vec::new();
        let mut section = 0;
        let mut last = 0;
        for line in text.lines() {
            if let Some(name) = line.strip_prefix("Disassembly of section ") {
                section = listing.section(name.trim_end_matches(':'));
            } else if let Some((code_address, symbol)) = parse_relocation(line) {
                let code_address = section << 32 | code_address;
                // The relocation of a 32-bit instruction or of a word has the address of this instruction or word.
                let line = listing.lines.get_mut(if code_address < last {
                    &last
                } else {
                    &code_address
                });
                if let Some(line) = line {
                    let number = listing.symbols.len();
                    listing.symbols.entry(symbol.clone()).or_insert(number);
                    line.symbol = Some(symbol);
                }
            } else if let Some((offset, line)) = parse_instruction(line) {
                last = section << 32 | offset;
                listing.lines.insert(last, line);
            } else if let Some(symbol) = parse_symbol(line) {
                symbols.push(symbol);
            }
        }
        for (name, section, offset, size, is_global) in symbols {
            let code_address = listing.section(&section) << 32 | offset;
            let function = Function {
                code_address,
                size,
                is_global,
            };
            listing.names.insert(code_address, name.clone());
            listing.functions.insert(name, function);
        }
        // In Thumb code, objdump prints 32-bit instructions as two halves.
        let mut instructions = listing.lines.values().filter(|line| !line.is_data());
        if instructions.any(|line| line.bytes.len() == 8) {
            return Err(
                "the object has instructions in ARM state: a Cortex-M executes Thumb".to_owned(),
            );
        }
        Ok(listing)
    }

    /// Returns the number of a section.
    fn section(&mut self, name: &str) -> u64 {
        let known = self.sections.iter().position(|known| known == name);
        known.unwrap_or_else(|| {
            self.sections.push(name.to_owned());
            self.sections.len() - 1
        }) as u64
    }

    /// Returns true if a function of the symbol table begins at this address.
    pub fn is_function(&self, code_address: CodeAddress) -> bool {
        self.names.contains_key(&code_address)
    }

    /// Returns the address as `FUNCTION+0x1c`.
    pub fn describe(&self, code_address: CodeAddress) -> String {
        match self.names.range(..=code_address).next_back() {
            Some((begin, name)) if *begin == code_address => name.clone(),
            Some((begin, name)) if begin >> 32 == code_address >> 32 => {
                format!("{name}+{:#x}", code_address - begin)
            }
            _ => format!("{:#x}", code_address & 0xffff_ffff),
        }
    }

    /// Returns the bytes of a function as hexadecimal digits, without relocations.
    pub fn bytes(&self, function: Function) -> String {
        let lines = self
            .lines
            .range(function.code_address..function.code_address + function.size);
        let bytes = lines.map(|(_, line)| line.bytes.as_str());
        bytes.collect::<String>().replace(' ', "")
    }
}

/// Reads `  686: R_ARM_THM_CALL  NAME`.
fn parse_relocation(line: &str) -> Option<(u64, String)> {
    let mut words = line.split_whitespace();
    let code_address = words.next()?.strip_suffix(':')?;
    let kind = words.next()?;
    let symbol = words.next()?;
    (kind.starts_with("R_ARM_") && words.next().is_none()).then_some(())?;
    Some((
        u64::from_str_radix(code_address, 16).ok()?,
        symbol.to_owned(),
    ))
}

/// Reads `  65a:  ed90 0b00   vldr  d0, [r0]  @ comment`.
fn parse_instruction(line: &str) -> Option<(u64, Line)> {
    let mut parts = line.split('\t');
    let offset = u64::from_str_radix(parts.next()?.trim().strip_suffix(':')?, 16).ok()?;
    let bytes = parts.next()?.trim().to_owned();
    let mnemonic = parts.next()?.trim().to_owned();
    let operands = parts.next().unwrap_or_default();
    let operands = operands.split(['@', ';']).next().unwrap_or_default();
    Some((
        offset,
        Line {
            bytes,
            mnemonic,
            operands: operands.trim().to_owned(),
            symbol: None,
        },
    ))
}

/// Reads `00000654 g     F .text  0000028c crane_rates`: name, section, offset, size, and whether it is global.
fn parse_symbol(line: &str) -> Option<(String, String, u64, u64, bool)> {
    let (left, right) = line.split_once('\t')?;
    let mut left = left.split_whitespace();
    let offset = u64::from_str_radix(left.next()?, 16).ok()?;
    let words: Vec<&str> = left.collect();
    let (section, flags) = words.split_last()?;
    flags.contains(&"F").then_some(())?;
    let mut right = right.split_whitespace();
    let size = u64::from_str_radix(right.next()?, 16).ok()?;
    let name = right.next_back()?;
    let is_hidden = right.next() == Some(".hidden");
    let is_global = !is_hidden && flags.iter().any(|flag| flag.starts_with(['g', 'w', 'u']));
    Some((
        name.to_owned(),
        (*section).to_owned(),
        offset,
        size,
        is_global,
    ))
}
