//! Output of `objdump -t -d -r`: symbols, instructions, words of data and relocations.

use std::collections::BTreeMap;

/// Address of an instruction: number of the section in the upper, offset in the lower half.
pub type Place = u64;

/// Disassembled object.
#[derive(Debug, Default)]
pub struct Listing {
    /// Instructions and data by place.
    pub lines: BTreeMap<Place, Line>,
    /// Numbers of the symbols of relocations.
    pub symbols: BTreeMap<String, usize>,
    /// Functions by name.
    pub functions: BTreeMap<String, Function>,
    /// Names of functions by place; of several at one place the last.
    names: BTreeMap<Place, String>,
    sections: Vec<String>,
}

/// Function of the symbol table.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// First instruction.
    pub place: Place,
    /// Bytes.
    pub size: u64,
    /// True if it is visible outside the object.
    pub is_global: bool,
}

/// Line of the disassembly.
#[derive(Debug, Default)]
pub struct Line {
    /// Bytes as hexadecimal digits, as printed.
    pub bytes: String,
    /// Mnemonic; of data `.word` and its like.
    pub mnemonic: String,
    /// Operands without comment.
    pub operands: String,
    /// Symbol of the relocation.
    pub symbol: Option<String>,
}

/// Format of objects.
const FORMAT: &str = "elf32-littlearm";

impl Line {
    /// Returns the number of bytes.
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
    /// If the output is not that of an object for a Cortex-M with instructions.
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
            } else if let Some((place, symbol)) = relocation(line) {
                let place = section << 32 | place;
                // The relocation of a 32-bit instruction has its address, that of a word too.
                let line = listing
                    .lines
                    .get_mut(if place < last { &last } else { &place });
                if let Some(line) = line {
                    let number = listing.symbols.len();
                    listing.symbols.entry(symbol.clone()).or_insert(number);
                    line.symbol = Some(symbol);
                }
            } else if let Some((offset, line)) = instruction(line) {
                last = section << 32 | offset;
                listing.lines.insert(last, line);
            } else if let Some(symbol) = symbol(line) {
                symbols.push(symbol);
            }
        }
        for (name, section, offset, size, is_global) in symbols {
            let place = listing.section(&section) << 32 | offset;
            let function = Function {
                place,
                size,
                is_global,
            };
            listing.names.insert(place, name.clone());
            listing.functions.insert(name, function);
        }
        // Instructions of 32 bits are printed as two halves in Thumb.
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

    /// Returns true if a function of the symbol table begins here.
    pub fn is_function(&self, place: Place) -> bool {
        self.names.contains_key(&place)
    }

    /// Returns the place as `FUNCTION+0x1c`.
    pub fn describe(&self, place: Place) -> String {
        match self.names.range(..=place).next_back() {
            Some((begin, name)) if *begin == place => name.clone(),
            Some((begin, name)) if begin >> 32 == place >> 32 => {
                format!("{name}+{:#x}", place - begin)
            }
            _ => format!("{:#x}", place & 0xffff_ffff),
        }
    }

    /// Returns the bytes of a function as hexadecimal digits, without relocations.
    pub fn bytes(&self, function: Function) -> String {
        let lines = self
            .lines
            .range(function.place..function.place + function.size);
        let bytes = lines.map(|(_, line)| line.bytes.as_str());
        bytes.collect::<String>().replace(' ', "")
    }
}

/// Reads `  686: R_ARM_THM_CALL  NAME`.
fn relocation(line: &str) -> Option<(u64, String)> {
    let mut words = line.split_whitespace();
    let place = words.next()?.strip_suffix(':')?;
    let kind = words.next()?;
    let symbol = words.next()?;
    (kind.starts_with("R_ARM_") && words.next().is_none()).then_some(())?;
    Some((u64::from_str_radix(place, 16).ok()?, symbol.to_owned()))
}

/// Reads `  65a:  ed90 0b00   vldr  d0, [r0]  @ comment`.
fn instruction(line: &str) -> Option<(u64, Line)> {
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
fn symbol(line: &str) -> Option<(String, String, u64, u64, bool)> {
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
