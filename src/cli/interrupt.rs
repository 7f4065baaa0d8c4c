//! Ctrl-C.
//!
//! Work that owns a temporary file ends in order, so that the file is
//! removed; before it starts there is nothing to tidy up, and the program just
//! ends.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The command was stopped by the user.
#[derive(Debug, thiserror::Error)]
pub enum Interrupted {
    /// Before anything was written, or only to a temporary file.
    #[error("interrupted; nothing was written")]
    NothingWritten,
    /// After a part was written to a stream.
    #[error("interrupted; the table written so far is incomplete")]
    PartWritten,
}

/// Set when work in order has to end.
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Whether there is work to end in order. The handler holds the lock while it
/// ends the program, so that no such work starts meanwhile.
static ORDERLY: Mutex<bool> = Mutex::new(false);

/// Handles Ctrl-C (and the signals that ask a program to end) from now on.
pub fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        let orderly = ORDERLY.lock().unwrap_or_else(PoisonError::into_inner);
        if !*orderly {
            super::print::print_error(&Interrupted::NothingWritten);
            std::process::exit(i32::from(super::INTERRUPTED));
        }
        REQUESTED.store(true, Ordering::Relaxed);
    })?;
    Ok(())
}

/// From now on the program looks at the flag that this gives, and ends in
/// order when it is set.
pub fn end_in_order() -> &'static AtomicBool {
    *ORDERLY.lock().unwrap_or_else(PoisonError::into_inner) = true;
    &REQUESTED
}

/// An error when the user asked to stop.
pub fn check() -> Result<(), Interrupted> {
    if REQUESTED.load(Ordering::Relaxed) {
        Err(Interrupted::NothingWritten)
    } else {
        Ok(())
    }
}
