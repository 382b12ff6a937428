//! Progress on standard error: bars on a terminal, plain lines elsewhere, nothing when quiet.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::Common;

/// What standard error shows.
pub struct Display {
    mode: Mode,
}

enum Mode {
    Quiet,
    Lines,
    Bar(ProgressBar),
}

impl Display {
    /// Chooses by the options and by what standard error is.
    pub fn new(common: &Common) -> Self {
        let mode = if common.quiet {
            Mode::Quiet
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
            bar.set_style(spinner());
            bar.enable_steady_tick(Duration::from_millis(100));
            Mode::Bar(bar)
        } else {
            Mode::Lines
        };
        Self { mode }
    }

    /// A stage begins.
    pub fn stage(&self, name: &str, seconds: f64) {
        match &self.mode {
            Mode::Quiet => {}
            Mode::Lines => eprintln!("{seconds:8.2} s  {name}"),
            Mode::Bar(bar) => bar.set_message(name.to_owned()),
        }
    }

    /// Work of known length begins.
    pub fn begin_count(&self, total: u64, what: &str) {
        if let Mode::Bar(bar) = &self.mode {
            bar.set_length(total);
            bar.set_position(0);
            bar.reset_eta();
            bar.set_style(counter());
            bar.set_message(what.to_owned());
        }
    }

    /// So much more of it is done.
    pub fn advance(&self, count: u64) {
        if let Mode::Bar(bar) = &self.mode {
            bar.inc(count);
        }
    }

    /// The work of known length is over.
    pub fn end_count(&self) {
        if let Mode::Bar(bar) = &self.mode {
            bar.set_style(spinner());
        }
    }

    /// A line for people, above any bar.
    pub fn note(&self, text: &str) {
        match &self.mode {
            Mode::Quiet => {}
            Mode::Lines => eprintln!("homeo: {text}"),
            Mode::Bar(bar) => bar.suspend(|| eprintln!("homeo: {text}")),
        }
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        if let Mode::Bar(bar) = &self.mode {
            bar.finish_and_clear();
        }
    }
}

fn spinner() -> ProgressStyle {
    ProgressStyle::with_template("{spinner} {msg} {elapsed}").unwrap_or_else(|_| ProgressStyle::default_spinner())
}

fn counter() -> ProgressStyle {
    ProgressStyle::with_template("{spinner} {msg} {wide_bar} {pos}/{len} {per_sec} {eta}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
