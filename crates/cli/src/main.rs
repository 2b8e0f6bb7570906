//! The binary `toile`: words in, one call into the libraries, a report out.
//!
//! Exit codes: 0 when it did what was asked, 1 when the input or the result is not acceptable, 2 when the call's words
//! are wrong.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::exit,
    reason = "the binary is the one that speaks"
)]

mod commands;
mod failure;
mod speech;
mod words;

use std::process::ExitCode;

use clap::Parser;
use failure::Failure;
use speech::Speech;
use words::{Command, Words};

fn main() -> ExitCode {
    let words = Words::parse();
    if let Some(threads) = words.common.threads
        && let Err(e) = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global()
    {
        eprintln!("error: no {threads} threads to be had: {e}");
        return ExitCode::from(1);
    }
    let speech = Speech::new(&words.common);
    match run(&words.command, &speech) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            speech.end_progress();
            eprintln!("{failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(command: &Command, speech: &Speech) -> Result<(), Failure> {
    match command {
        Command::Regenerate(words) => commands::regenerate::run(words, speech),
        Command::Batch(words) => commands::batch::run(words, speech),
        Command::Features(words) => commands::features::run(words, speech),
        Command::Form(words) => commands::form::run(words, speech),
        Command::Check(words) => commands::check::run(words, speech),
        Command::Info(words) => commands::info::run(words, speech),
        Command::Flatten(words) => commands::flatten::run(words, speech),
        Command::Thicken(words) => commands::thicken::run(words, speech),
        Command::Deflate(words) => commands::deflate::run(words, speech),
        Command::Model(words) => commands::model::run(words, speech),
        Command::Bends(words) => commands::bends::run(words, speech),
        Command::Unfold(words) => commands::unfold::run(words, speech),
        Command::Render(words) => commands::render::run(words, speech),
        Command::View(words) => commands::view::run(words),
    }
}
