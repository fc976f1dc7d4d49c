//! Table of the study with a row for each kind of machine and a column for each host.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::cases::Case;
use super::compare::Verdict;
use super::host::Host;
use super::kind::Kind;

#[derive(Default)]
struct Cell {
    agreeing: usize,
    rejected: usize,
    differing: usize,
    missing: usize,
}

/// Counts of verdicts and reasons of rejections of all hosts.
#[derive(Default)]
pub struct Table {
    cells: BTreeMap<(Kind, usize), Cell>,
    /// Names of the rejected machines, by host, kind and reason.
    reasons: BTreeMap<(usize, Kind, String), Vec<String>>,
    missing: BTreeSet<String>,
}

impl Table {
    /// Adds one verdict; returns the text of a difference.
    pub fn add(&mut self, case: &Case, host: Host, verdict: Verdict) -> Option<String> {
        let kind = case.kind;
        let place = Host::ALL.iter().position(|known| *known == host)?;
        let cell = self.cells.entry((kind, place)).or_default();
        match verdict {
            Verdict::Compared(ratio) if ratio <= 1.0 => cell.agreeing += 1,
            Verdict::Compared(ratio) => {
                cell.differing += 1;
                return Some(format!(
                    "differs by {ratio:.1} times the allowed difference"
                ));
            }
            Verdict::Rejected(reason) => {
                cell.rejected += 1;
                let names = self.reasons.entry((place, kind, reason)).or_default();
                names.push(case.name.clone());
            }
            Verdict::Missing(reason) => {
                cell.missing += 1;
                self.missing.insert(reason);
            }
        }
        None
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = self.agreeing + self.rejected + self.differing + self.missing;
        match (self.agreeing, self.missing) {
            (_, missing) if missing > 0 => write!(f, "not run"),
            (agreeing, _) if agreeing == all => write!(f, "{all}"),
            (agreeing, _) => write!(f, "{agreeing} of {all}"),
        }
    }
}

impl Table {
    /// Returns true if every host ran every machine.
    pub fn is_complete(&self) -> bool {
        self.missing.is_empty()
    }

    /// Returns the reasons of all rejections and missing hosts, one line for each.
    pub fn notes(&self) -> String {
        let rejected = self.reasons.iter().map(|((place, kind, reason), names)| {
            let (host, kind, names) = (Host::ALL[*place].name(), kind.name(), names.join(", "));
            format!("- {host}, {kind} ({names}): {reason}\n")
        });
        let missing = self
            .missing
            .iter()
            .map(|reason| format!("- not run: {reason}\n"));
        rejected.chain(missing).collect()
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds: BTreeSet<Kind> = self.cells.keys().map(|(kind, _)| *kind).collect();
        let hosts = Host::ALL.map(Host::name);
        writeln!(f, "| machines with | {} |", hosts.join(" | "))?;
        writeln!(f, "|{}", " --- |".repeat(hosts.len() + 1))?;
        for kind in kinds {
            let cells = (0..hosts.len()).map(|place| {
                let cell = self.cells.get(&(kind, place));
                cell.map_or_else(String::new, Cell::to_string)
            });
            let cells: Vec<String> = cells.collect();
            writeln!(f, "| {} | {} |", kind.name(), cells.join(" | "))?;
        }
        Ok(())
    }
}
