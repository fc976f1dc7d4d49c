//! Reasons for the rejection of a call.

use eomgen_compiled_model::Error;

/// Status of a call, with the values of the FMI standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// The call succeeded.
    Ok = 0,
    /// The call failed at this time or state; the importer may try a shorter step or another state.
    Discard = 2,
    /// The call is invalid, and the instance is unchanged.
    Error = 3,
}

/// Rejection of a call, with a message for the importer's logger.
#[derive(Clone, Debug)]
pub struct Rejection {
    pub status: Status,
    pub message: String,
}

pub type Outcome<T = ()> = Result<T, Rejection>;

/// Returns the rejection of an invalid call.
pub fn invalid(message: impl Into<String>) -> Rejection {
    Rejection {
        status: Status::Error,
        message: message.into(),
    }
}

/// Returns the rejection of a value that the unit cannot compute at the current time and state.
pub fn unavailable(message: impl Into<String>) -> Rejection {
    Rejection {
        status: Status::Discard,
        message: message.into(),
    }
}

impl From<Error> for Rejection {
    fn from(error: Error) -> Self {
        match &error {
            Error::Stopped { .. } => unavailable(error.to_string()),
            _ => invalid(error.to_string()),
        }
    }
}
