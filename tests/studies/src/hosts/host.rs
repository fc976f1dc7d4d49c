//! Hosts and their results for one machine.

/// Motion of one machine in one host.
pub(crate) struct HostRun {
    pub host: Host,
    pub answer: Answer,
}

/// Result of a host for one machine.
pub(crate) enum Answer {
    /// States at the sample times, SI.
    Motion(Vec<Vec<f64>>),
    /// The host rejects the model or stops; the text is the message.
    Rejected(String),
    /// The host is not installed; the text is the reason.
    Missing(String),
}

/// Host that simulates motions. Units of FMI 2 and FMI 3 count as the same host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Host {
    Rk,
    Radau,
    Adams,
    Exact,
    Sweep,
    Python,
    CoSimulation,
    ModelExchange,
    Page,
}

impl Host {
    pub(crate) const ALL: [Self; 9] = [
        Self::Rk,
        Self::Radau,
        Self::Adams,
        Self::Exact,
        Self::Sweep,
        Self::Python,
        Self::CoSimulation,
        Self::ModelExchange,
        Self::Page,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rk => "`rk`",
            Self::Radau => "`radau`",
            Self::Adams => "`adams`",
            Self::Exact => "`exact`",
            Self::Sweep => "sweep",
            Self::Python => "Python",
            Self::CoSimulation => "FMI co-simulation",
            Self::ModelExchange => "FMI model exchange",
            Self::Page => "page",
        }
    }
}
