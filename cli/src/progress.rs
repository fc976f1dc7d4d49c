//! Progress bars and notes on stderr, only on a terminal and after two seconds of work.

use std::cell::Cell;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Delay before a bar is shown.
const DELAY: Duration = Duration::from_secs(2);

/// Resolution of a bar.
const PARTS: f64 = 1000.0;

/// Progress bar, shown after a delay.
pub struct Bar {
    bar: ProgressBar,
    whole: f64,
    started: Instant,
    shown: Cell<bool>,
}

impl Bar {
    /// Creates a bar for `whole` units of work.
    pub fn new(what: &'static str, whole: f64, unit: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(PARTS as u64), ProgressDrawTarget::hidden());
        let template =
            format!("{{msg}} [{{bar:40}}] {{percent}} % of {whole} {unit}, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        bar.set_message(what);
        Self {
            bar,
            whole,
            started: Instant::now(),
            shown: Cell::new(false),
        }
    }

    /// Sets the completed work.
    pub fn set(&self, done: f64) {
        if !self.shown.get() {
            if self.started.elapsed() < DELAY {
                return;
            }
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.shown.set(true);
        }
        self.bar.set_position((PARTS * done / self.whole) as u64);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Line that names the current work, on a terminal.
pub struct Note {
    bar: ProgressBar,
}

impl Note {
    /// Shows `what` until dropped.
    pub fn new(what: impl Into<String>) -> Self {
        let bar = ProgressBar::new_spinner();
        bar.set_message(what.into());
        bar.enable_steady_tick(Duration::from_millis(120));
        Self { bar }
    }
}

impl Drop for Note {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
