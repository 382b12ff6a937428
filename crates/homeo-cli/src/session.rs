//! One run: stages and their times, limits, interruption, and the moment after which nothing stops it.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use homeo::progress::Progress;
use serde_json::{Map, Value, json};

use crate::args::Common;
use crate::display::Display;
use crate::failure::{Exit, Failure, Result};
use crate::memory;

/// How long work may take to notice that it should stop.
const GRACE: Duration = Duration::from_millis(600);
/// How often limits are looked at.
const WATCH: Duration = Duration::from_millis(20);

const RUNNING: u8 = 0;
const TIMEOUT: u8 = 1;
const MEMORY: u8 = 2;
const INTERRUPT: u8 = 3;

/// One run of the program.
pub struct Session {
    /// Options of every verb.
    pub common: Common,
    verb: &'static str,
    start: Instant,
    display: Display,
    clock: Mutex<Clock>,
    facts: Mutex<Map<String, Value>>,
    /// Files to remove when the run does not come to its end.
    partial: Mutex<Vec<PathBuf>>,
    stop: AtomicU8,
    time_limit: Mutex<TimeLimit>,
    phase: Mutex<Phase>,
}

/// What it means that the time is over.
#[derive(Clone, Copy, PartialEq, Eq)]
enum TimeLimit {
    /// The run ends.
    EndsRun,
    /// The work is asked to end with what it has.
    EndsWork,
    /// Nothing.
    Lifted,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Phase {
    Working,
    /// Results are being put in place or printed.
    Closed,
}

#[derive(Default)]
struct Clock {
    stages: Vec<(&'static str, f64)>,
    current: Option<(&'static str, Instant)>,
}

/// A lock whose holder panicked still guards plain data.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Session {
    /// Begins a run and watches over its limits.
    pub fn begin(verb: &'static str, common: Common) -> Arc<Self> {
        let session = Arc::new(Self {
            display: Display::new(&common),
            verb,
            start: Instant::now(),
            common,
            clock: Mutex::default(),
            facts: Mutex::default(),
            partial: Mutex::default(),
            stop: AtomicU8::new(RUNNING),
            time_limit: Mutex::new(TimeLimit::EndsRun),
            phase: Mutex::new(Phase::Working),
        });
        let watched = Arc::clone(&session);
        std::thread::spawn(move || watched.watch());
        let interrupted = Arc::clone(&session);
        // Without a handler Ctrl-C simply ends the process, which is safe too.
        if let Err(error) = ctrlc::set_handler(move || interrupted.request_stop(INTERRUPT)) {
            log::debug!("no interrupt handler: {error}");
        }
        session
    }

    /// What is shown on standard error.
    pub fn display(&self) -> &Display {
        &self.display
    }

    /// Notes a field of the JSON object, known from now on whatever happens.
    pub fn fact(&self, name: &str, value: impl Into<Value>) {
        locked(&self.facts).insert(name.to_owned(), value.into());
    }

    /// Registers a file that must not survive a failure.
    pub fn register_partial(&self, path: PathBuf) {
        locked(&self.partial).push(path);
    }

    /// Forgets such a file: it has its final name now, or is gone.
    pub fn forget_partial(&self, path: &std::path::Path) {
        locked(&self.partial).retain(|known| known != path);
    }

    /// Removes what is half done.
    pub fn remove_partial(&self) {
        for path in locked(&self.partial).drain(..) {
            // Best effort: it may not exist yet.
            let _ = std::fs::remove_file(path);
        }
    }

    /// Whether the run may go on.
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(self.stopped()) } else { Ok(()) }
    }

    /// From here on there is a result: the time limit only asks the work to end, as soon as it can.
    pub fn let_time_end_work(&self) {
        *locked(&self.time_limit) = TimeLimit::EndsWork;
    }

    /// The work has ended; its result is written however long that takes.
    pub fn lift_time_limit(&self) {
        *locked(&self.time_limit) = TimeLimit::Lifted;
        // Any other reason to stop stays.
        let _ = self.stop.compare_exchange(TIMEOUT, RUNNING, Ordering::SeqCst, Ordering::SeqCst);
    }

    /// From here on the time limit ends the run again. Returns whether it ended the work meanwhile; then it is lifted.
    pub fn let_time_end_run(&self) -> bool {
        let mut time_limit = locked(&self.time_limit);
        let was_cut_short = self.stop.load(Ordering::SeqCst) == TIMEOUT;
        *time_limit = if was_cut_short { TimeLimit::Lifted } else { TimeLimit::EndsRun };
        drop(time_limit);
        if was_cut_short {
            self.lift_time_limit();
        }
        was_cut_short
    }

    /// Ends the stage that runs.
    pub fn end_stage(&self) {
        let mut clock = locked(&self.clock);
        if let Some((name, since)) = clock.current.take() {
            clock.stages.push((name, since.elapsed().as_secs_f64()));
        }
    }

    /// Seconds per stage in order of first appearance, and the total.
    pub fn seconds(&self) -> Vec<(&'static str, f64)> {
        let clock = locked(&self.clock);
        let running = clock.current.map(|(name, since)| (name, since.elapsed().as_secs_f64()));
        let mut sums: Vec<(&'static str, f64)> = Vec::new();
        for &(name, seconds) in clock.stages.iter().chain(&running) {
            match sums.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += seconds,
                None => sums.push((name, seconds)),
            }
        }
        sums.push(("total", self.start.elapsed().as_secs_f64()));
        sums
    }

    /// Nothing stops the run from here on.
    ///
    /// # Errors
    /// When it should have stopped before.
    pub fn close(&self) -> Result<()> {
        let mut phase = locked(&self.phase);
        self.check()?;
        *phase = Phase::Closed;
        self.display.clear();
        Ok(())
    }

    /// The same after a failure: an answer is on its way.
    pub fn close_failed(&self) {
        *locked(&self.phase) = Phase::Closed;
        self.display.clear();
        self.remove_partial();
    }

    /// The fields that every JSON object has.
    pub fn fields(&self, ok: bool) -> Map<String, Value> {
        let mut fields = locked(&self.facts).clone();
        let seconds: Map<String, Value> =
            self.seconds().into_iter().map(|(name, s)| (name.to_owned(), json!(s))).collect();
        fields.insert("verb".to_owned(), json!(self.verb));
        fields.insert("version".to_owned(), json!(env!("CARGO_PKG_VERSION")));
        fields.insert("ok".to_owned(), json!(ok));
        fields.insert("seconds".to_owned(), Value::Object(seconds));
        fields.insert("peak_bytes".to_owned(), json!(memory::peak_bytes()));
        fields
    }

    /// Why the run was stopped.
    pub fn stopped(&self) -> Failure {
        let stage = {
            let clock = locked(&self.clock);
            clock.current.map(|(name, _)| name).or(clock.stages.last().map(|s| s.0)).unwrap_or("start")
        };
        match self.stop.load(Ordering::SeqCst) {
            INTERRUPT => Failure::new(
                Exit::Interrupted,
                "interrupted",
                format!("interrupted during stage `{stage}`; nothing was written"),
            ),
            MEMORY => Failure::limits(
                "memory",
                format!(
                    "the memory limit of {} bytes was reached during stage `{stage}`; nothing was written. Raise --memory or give a smaller mesh",
                    self.common.memory.unwrap_or_default()
                ),
            ),
            _ => Failure::limits(
                "timeout",
                format!(
                    "the time limit of {} s was reached during stage `{stage}`; nothing was written. Raise --timeout or give a smaller mesh",
                    self.common.timeout.unwrap_or_default()
                ),
            ),
        }
    }

    fn request_stop(&self, reason: u8) {
        // The gravest reason stays.
        self.stop.fetch_max(reason, Ordering::SeqCst);
    }

    fn look_at_limits(&self) {
        let time_limit = locked(&self.time_limit);
        let is_over = |limit: f64| self.start.elapsed().as_secs_f64() > limit;
        if *time_limit != TimeLimit::Lifted && self.common.timeout.is_some_and(is_over) {
            self.request_stop(TIMEOUT);
        }
        drop(time_limit);
        if self.common.memory.is_some_and(|limit| memory::current_bytes().is_some_and(|now| now > limit)) {
            self.request_stop(MEMORY);
        }
    }

    /// Whether the run has to end, not only the work.
    fn must_end(&self) -> bool {
        match self.stop.load(Ordering::SeqCst) {
            RUNNING => false,
            TIMEOUT => *locked(&self.time_limit) == TimeLimit::EndsRun,
            _ => true,
        }
    }

    fn watch(&self) {
        let mut noticed = None;
        loop {
            std::thread::sleep(WATCH);
            self.look_at_limits();
            if !self.must_end() {
                noticed = None;
                continue;
            }
            if noticed.get_or_insert_with(Instant::now).elapsed() > GRACE {
                self.end_now();
                return;
            }
        }
    }

    /// The work does not listen: ends the process from here, unless results are on their way.
    #[allow(clippy::exit)] // the only way to end work that does not ask
    fn end_now(&self) {
        let mut phase = locked(&self.phase);
        if *phase == Phase::Closed {
            return;
        }
        *phase = Phase::Closed;
        self.display.clear();
        self.remove_partial();
        let code = crate::answer::print_failure(self, self.stopped());
        std::process::exit(i32::from(code));
    }
}

impl Progress for Session {
    fn stage(&self, name: &'static str) {
        let mut clock = locked(&self.clock);
        if clock.current.is_some_and(|(current, _)| current == name) {
            return;
        }
        if let Some((last, since)) = clock.current.replace((name, Instant::now())) {
            clock.stages.push((last, since.elapsed().as_secs_f64()));
        }
        drop(clock);
        self.display.stage(name, self.start.elapsed().as_secs_f64());
        log::info!("stage {name}");
    }

    fn is_cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed) != RUNNING
    }
}
