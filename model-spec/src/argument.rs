//! Names of arguments in messages: command-line options, or arguments of Python functions.

use std::fmt::{self, Display, Formatter};
use std::sync::atomic::{AtomicBool, Ordering};

/// True if messages name arguments of Python functions instead of command-line options.
static IS_PYTHON: AtomicBool = AtomicBool::new(false);

/// Sets the names in messages to those of Python arguments. The Python package calls this function when it is loaded.
pub fn name_python_arguments() {
    IS_PYTHON.store(true, Ordering::Relaxed);
}

fn is_python() -> bool {
    IS_PYTHON.load(Ordering::Relaxed)
}

/// Argument of a command or Python function. It is displayed as a command-line option, such as `--max-step`, or as a
/// Python argument, such as `max_step`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Values that an equilibrium keeps.
    Fixed,
    /// Additional functions of emitted code.
    Extras,
    /// Parameter that is the angular frequency of the forcing.
    Frequency,
    /// Initial state of a motion.
    InitialState,
    /// Inputs.
    Inputs,
    /// Measures of a sweep.
    Measure,
    /// State of a linearisation, and start of the search for an equilibrium.
    OperatingState,
    /// Order of the fields.
    Order,
    /// Folder of the results.
    Out,
    /// Values of parameters.
    Parameters,
    /// Number of evaluated periods of the forcing.
    Periods,
    /// Record that drives the inputs.
    Record,
    /// Number of random samples.
    Samples,
    /// Poincaré section.
    Section,
    /// Seed of random samples.
    Seed,
    /// Solver.
    Solver,
    /// State of a motion or of a linearisation.
    State,
    /// Length of fixed steps.
    StepLength,
    /// Target of emitted code.
    Target,
    /// Number of discarded periods of the forcing.
    Transient,
    /// End of the motion.
    Until,
    /// Parameters that a sweep varies.
    Vary,
}

impl Argument {
    /// Returns the command-line option and the Python argument.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Fixed => ("--fix", "fixed"),
            Self::Extras => ("--with", "extras"),
            Self::Frequency => ("--frequency", "frequency"),
            Self::InitialState => ("--state", "state"),
            Self::Inputs => ("--input", "inputs"),
            Self::Measure => ("--measure", "measure"),
            Self::OperatingState => ("--state", "x"),
            Self::Order => ("--order", "order"),
            Self::Out => ("--out", "out"),
            Self::Parameters => ("--set", "with_parameters"),
            Self::Periods => ("--periods", "periods"),
            Self::Record => ("--record", "record"),
            Self::Samples => ("--samples", "samples"),
            Self::Section => ("--section", "section"),
            Self::Seed => ("--seed", "seed"),
            Self::Solver => ("--solver", "solver"),
            Self::State => ("--state", "state or x"),
            Self::StepLength => ("--step", "max_step"),
            Self::Target => ("--target", "target"),
            Self::Transient => ("--transient", "transient"),
            Self::Until => ("--until", "until"),
            Self::Vary => ("--vary", "vary"),
        }
    }

    /// Returns the name of the argument.
    pub fn name(self) -> &'static str {
        self.name_for(is_python())
    }

    fn name_for(self, is_python: bool) -> &'static str {
        let (option, python) = self.names();
        if is_python { python } else { option }
    }

    /// Returns the argument with a text as its value, such as `--solver rk` or `solver="rk"`.
    pub fn with_text(self, value: &str) -> String {
        self.text_for(value, is_python())
    }

    fn text_for(self, value: &str, is_python: bool) -> String {
        let name = self.name_for(is_python);
        match is_python {
            true => format!("{name}=\"{value}\""),
            false => format!("{name} {value}"),
        }
    }

    /// Returns the argument with a number as its value, such as `--until 2.0` or `until=2.0`.
    pub fn with_number(self, value: impl Display) -> String {
        self.number_for(value, is_python())
    }

    fn number_for(self, value: impl Display, is_python: bool) -> String {
        let separator = if is_python { "=" } else { " " };
        format!("{}{separator}{value}", self.name_for(is_python))
    }

    /// Returns the argument with a value for a name, such as `--input u=...` or `inputs={"u": ...}`.
    pub fn with_entry(self, name: &str, value: &str) -> String {
        self.entry_for((name, value), is_python())
    }

    fn entry_for(self, (name, value): (&str, &str), is_python: bool) -> String {
        let argument = self.name_for(is_python);
        match is_python {
            true => format!("{argument}={{\"{name}\": {value}}}"),
            false => format!("{argument} {name}={value}"),
        }
    }
}

impl Display for Argument {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_have_names_of_both_interfaces() {
        for (argument, option, python) in [
            (Argument::StepLength, "--step", "max_step"),
            (Argument::Fixed, "--fix", "fixed"),
            (Argument::OperatingState, "--state", "x"),
            (Argument::Extras, "--with", "extras"),
        ] {
            assert_eq!(argument.name_for(false), option);
            assert_eq!(argument.name_for(true), python);
        }
        assert_eq!(Argument::Until.to_string(), "--until");
    }

    #[test]
    fn values_are_written_as_the_interface_reads_them() {
        assert_eq!(Argument::Solver.text_for("rk", false), "--solver rk");
        assert_eq!(Argument::Solver.text_for("rk", true), "solver=\"rk\"");
        assert_eq!(Argument::Until.number_for(2.5, false), "--until 2.5");
        assert_eq!(Argument::Until.number_for(2.5, true), "until=2.5");
        let entry = ("u", "...");
        assert_eq!(Argument::Inputs.entry_for(entry, false), "--input u=...");
        assert_eq!(
            Argument::Inputs.entry_for(entry, true),
            "inputs={\"u\": ...}"
        );
    }
}
