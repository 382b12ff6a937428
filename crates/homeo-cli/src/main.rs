//! The `homeo` command: thin glue between the command line and the library.
//!
//! `args` is the command line, one module per verb does the work, `session` holds stages and limits,
//! `answer` prints. Outputs get their names last, when nothing can go wrong any more.
#![allow(clippy::print_stderr)] // this is what a command-line program is for

mod answer;
mod args;
mod bundle;
mod display;
mod eval;
mod failure;
mod hyperbolic;
mod info;
mod inside;
mod logging;
mod map;
mod memory;
mod mesh_input;
mod morph;
mod outputs;
mod points;
mod proof;
mod refuse;
mod report;
mod sampled;
mod session;
mod shell;
mod text;
mod verify;
mod warp;
mod welded;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};

use answer::Answer;
use args::{Arguments, Verb};
use clap::Parser;
use failure::{Exit, Failure, Result};
use outputs::Outputs;
use session::Session;

/// As typed; wrong usage is reported before the command line is understood.
const VERBS: [&str; 16] = [
    "info",
    "map",
    "shell",
    "simplify",
    "remesh",
    "transfer",
    "pl",
    "warp",
    "morph",
    "blend",
    "hyperbolic",
    "bundle",
    "eval",
    "compose",
    "verify",
    "report",
];

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return ExitCode::from(explain_usage(&error)),
    };
    ExitCode::from(run(arguments))
}

/// Help and version are no errors; everything else is wrong usage.
fn explain_usage(error: &clap::Error) -> u8 {
    if error.use_stderr() {
        let typed: Vec<String> = std::env::args().skip(1).collect();
        let verb = typed.iter().find(|word| VERBS.contains(&word.as_str()));
        let message = error.to_string();
        let json = typed.iter().any(|word| word == "--json");
        answer::print_early(verb.map(String::as_str), json, "usage", message.trim_end());
    }
    // A closed standard error or output changes nothing.
    let _ = error.print();
    if error.use_stderr() { Exit::Usage.code() } else { 0 }
}

fn run(arguments: Arguments) -> u8 {
    let panicked = remember_panics();
    let session = Session::begin(arguments.verb.name(), arguments.common);
    let outcome = catch_unwind(AssertUnwindSafe(|| perform(&session, &arguments.verb)));
    let outcome = outcome.unwrap_or_else(|_| {
        let what = panicked.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Err(Failure::bug(format!("internal error: {what}")))
    });
    match outcome {
        Ok(answer) => answer::print_answer(&session, answer),
        Err(failure) => {
            session.close_failed();
            answer::print_failure(&session, failure)
        }
    }
}

/// The verb's work, then its files, then its answer: a failure anywhere leaves no file behind.
fn perform(session: &Arc<Session>, verb: &Verb) -> Result<Answer> {
    logging::start(&session.common)?;
    if let Some(threads) = session.common.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(usize::from(threads))
            .build_global()
            .map_err(|e| Failure::limits("threads", format!("{threads} threads cannot be started: {e}")))?;
    }
    if session.common.memory.is_some() && memory::current_bytes().is_none() {
        session.display().note("this system does not say how much memory is in use; --memory has no effect");
    }
    let mut outputs = Outputs::default();
    let answer = match verb {
        Verb::Info(options) => info::run(session, options),
        Verb::Map(options) => map::run(session, options, &mut outputs),
        Verb::Shell(options) => shell::run(session, options, &mut outputs),
        Verb::Simplify(options) => inside::simplify(session, options, &mut outputs),
        Verb::Remesh(options) => inside::remesh(session, options, &mut outputs),
        Verb::Transfer(options) => inside::transfer(session, options, &mut outputs),
        Verb::Pl(options) => inside::pl(session, options, &mut outputs),
        Verb::Warp(options) => warp::run(session, options, &mut outputs),
        Verb::Morph(options) => morph::run(session, options, &mut outputs),
        Verb::Blend(options) => morph::blend(session, options, &mut outputs),
        Verb::Bundle(options) => bundle::run(session, options, &mut outputs),
        Verb::Hyperbolic(options) => hyperbolic::run(session, options, &mut outputs),
        Verb::Eval(options) => eval::run(session, options, &mut outputs),
        Verb::Compose(options) => eval::compose::run(session, options, &mut outputs),
        Verb::Verify(options) => verify::run(session, options),
        Verb::Report(options) => report::run(session, options, &mut outputs),
    }?;
    session.close()?;
    outputs.commit(session)?;
    Ok(answer)
}

/// Keeps what a panic says, instead of printing it.
fn remember_panics() -> Arc<Mutex<String>> {
    let last = Arc::new(Mutex::new(String::new()));
    let keeper = Arc::clone(&last);
    std::panic::set_hook(Box::new(move |info| {
        let mut text = keeper.lock().unwrap_or_else(PoisonError::into_inner);
        if text.is_empty() {
            *text = info.to_string().replace('\n', " ");
        }
    }));
    last
}
