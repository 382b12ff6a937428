//! Log records: to a file with `--log`, to standard error with `-v`.

use std::fs::File;
use std::io::Write;
use std::sync::Mutex;
use std::time::Instant;

use log::{LevelFilter, Log, Metadata, Record};

use crate::args::Common;
use crate::failure::{Failure, Result};

struct Logger {
    start: Instant,
    file: Option<Mutex<File>>,
    on_screen: LevelFilter,
}

/// Starts logging as the options ask.
///
/// # Errors
/// When the log file cannot be made.
pub fn start(common: &Common) -> Result<()> {
    let on_screen = match common.verbose {
        0 => LevelFilter::Off,
        1 => LevelFilter::Info,
        _ => LevelFilter::Trace,
    };
    let file = match &common.log {
        Some(path) => Some(Mutex::new(
            File::create(path)
                .map_err(|error| Failure::usage(format!("the log file {} cannot be made: {error}", path.display())))?,
        )),
        None => None,
    };
    let most = if file.is_some() { LevelFilter::Trace } else { on_screen };
    if log::set_boxed_logger(Box::new(Logger { start: Instant::now(), file, on_screen })).is_ok() {
        log::set_max_level(most);
    }
    Ok(())
}

impl Log for Logger {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        self.file.is_some() || metadata.level() <= self.on_screen
    }

    fn log(&self, record: &Record<'_>) {
        let seconds = self.start.elapsed().as_secs_f64();
        let line = format!("{seconds:10.3} {:5} {}: {}", record.level(), record.target(), record.args());
        if record.level() <= self.on_screen {
            eprintln!("{line}");
        }
        if let Some(Ok(mut file)) = self.file.as_ref().map(Mutex::lock) {
            // A full disk must not end the work itself.
            let _ = writeln!(file, "{line}");
        }
    }

    fn flush(&self) {}
}
