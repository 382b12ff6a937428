//! Log records: to a file with `--log`, to standard error with `-v`.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

use log::{LevelFilter, Log, Metadata, Record};

use crate::args::Common;
use crate::failure::{Failure, Result};
use crate::outputs::is_same;

struct Logger {
    start: Instant,
    file: Option<Mutex<File>>,
    on_screen: LevelFilter,
}

/// Starts logging as the options ask.
///
/// # Errors
/// When the log file cannot be made, or would take the place of another file of the command line.
pub fn start(common: &Common) -> Result<()> {
    let on_screen = match common.verbose {
        0 => LevelFilter::Off,
        1 => LevelFilter::Info,
        _ => LevelFilter::Trace,
    };
    let file = match &common.log {
        Some(path) => Some(Mutex::new(made(path)?)),
        None => None,
    };
    let most = if file.is_some() { LevelFilter::Trace } else { on_screen };
    if log::set_boxed_logger(Box::new(Logger { start: Instant::now(), file, on_screen })).is_ok() {
        log::set_max_level(most);
    }
    Ok(())
}

/// An empty file; not in the place of one that is named for something else, as that would be lost.
fn made(path: &Path) -> Result<File> {
    let words: Vec<String> = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let others = (0..words.len()).filter(|&k| !words[k].starts_with("--log=") && (k == 0 || words[k - 1] != "--log"));
    let name =
        |k: usize| words[k].split_once('=').filter(|_| words[k].starts_with("--")).map_or(&*words[k], |(_, name)| name);
    if others.map(name).any(|name| is_same(Path::new(name), path)) {
        let message = format!("{} is named twice; give the log another name", path.display());
        return Err(Failure::usage(message));
    }
    File::create(path)
        .map_err(|error| Failure::usage(format!("the log file {} cannot be made: {error}", path.display())))
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
