//! Signals that end the program: Ctrl-C (SIGINT), SIGTERM and SIGHUP.
//!
//! The first signal ends the program at once unless a command is writing. Then the
//! command has [`GRACE`] to end by itself, so that a table on standard output ends
//! with a whole row. A command that does not end in time, because it waits for input
//! or is inside a single long query, is ended by the thread that waits here, which
//! removes temporary files. A second signal does not wait.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::thread;
use std::time::Duration;

use anyhow::Context;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;

use super::ending::end_now;

/// How long a command may take to end by itself: the batches between which it looks
/// at the flag take some milliseconds each, and all is to be over within a second.
const GRACE: Duration = Duration::from_millis(500);

/// A signal ended the command.
#[derive(Clone, Copy, Debug, thiserror::Error)]
pub enum Interrupted {
    /// Before anything was written, or only to a temporary file.
    #[error("interrupted; nothing was written")]
    NothingWritten,
    /// While a checkpoint keeps the tiles that are finished.
    #[error("interrupted; the same command goes on from the checkpoint")]
    TilesKept,
    /// After a part was written to a stream.
    #[error("interrupted; the table written so far is incomplete")]
    PartWritten,
    /// After some pictures of a film were written.
    #[error("interrupted; pictures that are complete: {0}")]
    AfterPictures(usize),
}

impl Interrupted {
    /// After a number of pictures.
    pub fn after_pictures(count: usize) -> Self {
        match count {
            0 => Self::NothingWritten,
            count => Self::AfterPictures(count),
        }
    }
}

/// The error message of a command that did not end by itself.
const ENDED: &str =
    "interrupted; unfinished files are unchanged, a table written to a stream is incomplete";

/// Set when a command that is writing has to end.
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Whether a command is writing.
static ORDERLY: AtomicBool = AtomicBool::new(false);

/// The first signal; 0 before any.
static SIGNAL: AtomicI32 = AtomicI32::new(0);

/// Handles signals from now on.
pub fn install() -> anyhow::Result<()> {
    // A handler of any kind turns the signal for a file beyond the size limit, which
    // would end the program, into an error of the write.
    signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))
        .context("cannot handle the signal SIGXFSZ")?;
    let mut ending = vec![SIGINT, SIGTERM];
    if !is_ignored(SIGHUP) {
        ending.push(SIGHUP);
    }
    let mut signals = Signals::new(ending).context("cannot handle signals")?;
    let wait = move || {
        for signal in signals.forever() {
            received(signal);
        }
    };
    let waiting = thread::Builder::new().name("signals".to_owned());
    waiting
        .spawn(wait)
        .context("cannot start a thread that waits for signals")?;
    Ok(())
}

/// From now on the command checks the returned flag and ends in an orderly way if it is
/// set.
pub fn end_in_order() -> &'static AtomicBool {
    ORDERLY.store(true, Ordering::SeqCst);
    &REQUESTED
}

/// Returns an error after a signal.
pub fn check() -> Result<(), Interrupted> {
    if REQUESTED.load(Ordering::Relaxed) {
        Err(Interrupted::NothingWritten)
    } else {
        Ok(())
    }
}

/// The exit code that shells report for a program ended by the signal.
pub fn exit_code() -> u8 {
    let signal = SIGNAL.load(Ordering::SeqCst);
    u8::try_from(128 + signal).unwrap_or(u8::MAX)
}

/// Acts on a signal, in the thread that waits for signals.
fn received(signal: i32) {
    let is_first = SIGNAL
        .compare_exchange(0, signal, Ordering::SeqCst, Ordering::SeqCst)
        .is_ok();
    REQUESTED.store(true, Ordering::SeqCst);
    if !ORDERLY.load(Ordering::SeqCst) {
        end_now(&Interrupted::NothingWritten.to_string(), exit_code());
    }
    let grace = || {
        thread::sleep(GRACE);
        end_now(ENDED, exit_code());
    };
    // If no thread can be started there is no grace, as for a second signal.
    if !is_first || thread::Builder::new().spawn(grace).is_err() {
        end_now(ENDED, exit_code());
    }
}

/// Whether the program was started with the signal ignored, as `nohup` does with
/// SIGHUP. Without this file of the system, it was not.
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
