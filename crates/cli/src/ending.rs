//! The end of the program without waiting for its threads.
//!
//! It is not `std::process::exit`: that runs the destructors of libraries, Embree's
//! among them, while other threads still trace.

use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use cyltrace_output::remove_unfinished;

use super::print::print_error;

/// How long a file system may take to remove a file, and standard error to take a
/// message; together well below the second within which a signal ends the program.
const PATIENCE: Duration = Duration::from_millis(150);

/// Removes unfinished outputs, prints `error: {message}` and ends the program,
/// without waiting for its other threads.
pub fn end_now(message: &str, code: u8) -> ! {
    // Kept, so that no output is begun or replaced from here on.
    let _unfinished = remove_unfinished(PATIENCE);
    print_in_time(message);
    signal_hook::low_level::exit(i32::from(code));
}

/// Like [`end_now`], after a failed allocation of `size` bytes. It allocates as little as
/// possible.
pub fn end_without_memory(size: usize, code: u8) -> ! {
    let _unfinished = remove_unfinished(PATIENCE);
    print_error(&format_args!(
        "out of memory: the system cannot allocate {size} bytes"
    ));
    signal_hook::low_level::exit(i32::from(code));
}

/// Prints a message, but does not wait for a pipe that nobody reads.
fn print_in_time(message: &str) {
    let (printed, is_printed) = mpsc::channel();
    let text = message.to_owned();
    let printer = thread::Builder::new().spawn(move || {
        print_error(&text);
        // Nobody waits any more when it took too long.
        let _ = printed.send(());
    });
    match printer {
        Ok(_) => {
            let _ = is_printed.recv_timeout(PATIENCE);
        }
        // No thread can be started: better to risk a wait than to lose the message.
        Err(_) => print_error(&message),
    }
}
