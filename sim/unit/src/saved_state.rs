//! Saved states of an instance, also in serialised form: a file mark, the token of the unit, the length of the
//! encoded condition, the encoded condition, and a checksum, which detects truncated or modified data.

use eomgen_codegen::program::encoding::Encoded;
use eomgen_codegen::stable_hash::StableHash;
use eomgen_sim::ode::SurfaceMode;

use crate::rejection::{Outcome, invalid};
use crate::resources::token;
use crate::unit::{Condition, Kind, Mode, Unit};

const FILE_MARK: &[u8] = b"eomgen 3";

/// Number of bytes of a length, and of a checksum.
const NUMBER_LENGTH: usize = 8;

const MODES: [Mode; 6] = [
    Mode::Instantiated,
    Mode::Initialization,
    Mode::Event,
    Mode::Continuous,
    Mode::Step,
    Mode::Terminated,
];

const SURFACE_MODES: [SurfaceMode; 6] = [
    SurfaceMode::Unknown,
    SurfaceMode::Negative,
    SurfaceMode::Positive,
    SurfaceMode::Held,
    SurfaceMode::Closed,
    SurfaceMode::Open,
];

/// Saved state of an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState {
    kind: Kind,
    condition: Condition,
}

impl Unit {
    /// Saves the current state.
    pub fn save(&mut self) -> SavedState {
        let mut surface_modes = self.surface_modes();
        surface_modes.resize(self.layout.indicators, SurfaceMode::Unknown);
        SavedState {
            kind: self.kind,
            condition: Condition {
                surface_modes,
                ..self.now.clone()
            },
        }
    }

    /// Continues from a saved state.
    pub fn restore(&mut self, saved: &SavedState) -> Outcome {
        if saved.kind != self.kind {
            return Err(invalid(
                "the saved state belongs to an instance of the other interface type (model exchange or co-simulation)",
            ));
        }
        self.set_condition(saved.condition.clone());
        Ok(())
    }

    /// Returns the bytes of a saved state.
    pub fn serialise(&self, saved: &SavedState) -> Vec<u8> {
        let now = &saved.condition;
        let mut bytes = vec![u8::from(saved.kind == Kind::CoSimulation)];
        bytes.push(now.mode as u8);
        bytes.push(u8::from(now.stop.is_some()));
        let surface_modes = now.surface_modes.iter();
        let place = |mode: &SurfaceMode| SURFACE_MODES.iter().position(|known| known == mode);
        bytes.extend(surface_modes.map(|mode| place(mode).unwrap_or(0) as u8));
        let scalars = [now.t, now.tolerance, now.stop.unwrap_or(0.0)];
        let vectors = [
            &now.state,
            &now.inputs,
            &now.earlier_inputs,
            &now.parameters,
        ];
        for number in scalars.iter().chain(vectors.into_iter().flatten()) {
            bytes.extend(number.to_le_bytes());
        }
        now.control.encode(&mut bytes);
        let length = (bytes.len() as u64).to_le_bytes();
        let head = [
            FILE_MARK,
            token(self.compiled.program()).as_bytes(),
            &length,
        ]
        .concat();
        let mut bytes = [head, bytes].concat();
        let sum = StableHash::new().include(&bytes).value().to_le_bytes();
        bytes.extend(sum);
        bytes
    }

    /// Reads a saved state from its bytes; further bytes are ignored.
    pub fn deserialise(&self, bytes: &[u8]) -> Outcome<SavedState> {
        let cut = || invalid("the bytes of a saved state are missing or truncated");
        let foreign = || invalid("these bytes are not a saved state of this FMU");
        let head = [FILE_MARK, token(self.compiled.program()).as_bytes()].concat();
        let known = bytes.get(..head.len()).ok_or_else(cut)?;
        if known != head {
            return Err(foreign());
        }
        let begin = head.len() + NUMBER_LENGTH;
        let length = bytes.get(head.len()..begin).ok_or_else(cut)?;
        let mut number = [0; NUMBER_LENGTH];
        number.copy_from_slice(length);
        let length = usize::try_from(u64::from_le_bytes(number)).ok();
        let end = length.and_then(|length| begin.checked_add(length));
        let end = end.ok_or_else(foreign)?;
        let sum_end = end.checked_add(NUMBER_LENGTH).ok_or_else(foreign)?;
        let sum = bytes.get(end..sum_end).ok_or_else(cut)?;
        if StableHash::new()
            .include(&bytes[..end])
            .value()
            .to_le_bytes()
            != *sum
        {
            return Err(foreign());
        }
        let content = &bytes[begin..end];
        let vectors = [
            self.layout.states,
            self.layout.inputs,
            self.layout.inputs,
            self.layout.parameters,
        ];
        let numbers = NUMBER_LENGTH * (3 + vectors.iter().sum::<usize>());
        let fixed = 3 + self.layout.indicators + numbers;
        let (fixed, mut control) = content.split_at_checked(fixed).ok_or_else(foreign)?;
        let (flags, rest) = fixed.split_at(3);
        let (surface_modes, numbers) = rest.split_at(self.layout.indicators);
        let mode = MODES.into_iter().find(|mode| *mode as u8 == flags[1]);
        let surface_modes: Option<Vec<SurfaceMode>> = surface_modes
            .iter()
            .map(|place| SURFACE_MODES.get(usize::from(*place)).copied())
            .collect();
        let mut numbers = numbers.chunks_exact(NUMBER_LENGTH).map(|chunk| {
            let mut bytes = [0; NUMBER_LENGTH];
            bytes.copy_from_slice(chunk);
            f64::from_le_bytes(bytes)
        });
        let mut next = |count: usize| numbers.by_ref().take(count).collect::<Vec<f64>>();
        let scalars = next(3);
        let condition = Condition {
            mode: mode.ok_or_else(foreign)?,
            t: scalars[0],
            tolerance: scalars[1],
            stop: (flags[2] == 1).then_some(scalars[2]),
            state: next(self.layout.states),
            inputs: next(self.layout.inputs),
            earlier_inputs: next(self.layout.inputs),
            parameters: next(self.layout.parameters),
            surface_modes: surface_modes.ok_or_else(foreign)?,
            control: Option::decode(&mut control).ok_or_else(foreign)?,
        };
        let kind = match flags[0] {
            0 => Kind::ModelExchange,
            _ => Kind::CoSimulation,
        };
        Ok(SavedState { kind, condition })
    }
}
