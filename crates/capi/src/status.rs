//! What a call came to: a code, and for errors a message kept by the thread.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

/// The call did what it is for.
pub const CYLTRACE_OK: c_int = 0;
/// The check ran and found wrong answers, or could not judge enough of them.
pub const CYLTRACE_VIOLATIONS: c_int = 1;
/// The call could not do what it is for; [`cyltrace_last_error`] says why.
pub const CYLTRACE_ERROR: c_int = 2;

thread_local! {
    static LAST_ERROR: RefCell<Option<CString>> = const { RefCell::new(None) };
}

/// The message of the last call on this thread that failed; null if none has.
/// It belongs to the library and lives until the next call that fails.
#[unsafe(no_mangle)]
pub extern "C" fn cyltrace_last_error() -> *const c_char {
    let message = |last: &RefCell<Option<CString>>| {
        let last = last.try_borrow().ok()?;
        last.as_deref().map(CStr::as_ptr)
    };
    let found = LAST_ERROR.try_with(message).ok().flatten();
    found.unwrap_or(ptr::null())
}

/// Runs a call. A failure and a panic leave their message for
/// [`cyltrace_last_error`] and give `None`.
pub(super) fn guarded<T>(call: impl FnOnce() -> Result<T, String>) -> Option<T> {
    // What a call was writing to when it panicked is never read again: outputs
    // are written when all is known, and handles are only read.
    let outcome = catch_unwind(AssertUnwindSafe(call));
    let message = match outcome {
        Ok(Ok(value)) => return Some(value),
        Ok(Err(message)) => message,
        Err(panic) => format!("cyltrace panicked: {}", panic_text(panic.as_ref())),
    };
    let message = c_text(message);
    // A thread that ends may have lost the place; then there is nobody to read.
    let _ = LAST_ERROR.try_with(|last| last.replace(Some(message)));
    None
}

/// The text for C, which ends at the first NUL.
pub(super) fn c_text(text: String) -> CString {
    let mut bytes = text.into_bytes();
    bytes.retain(|&byte| byte != 0);
    CString::new(bytes).unwrap_or_default()
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("without a message")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last_error() -> Option<String> {
        let message = cyltrace_last_error();
        // SAFETY: invariant 2: it is null or a text of this thread's.
        (!message.is_null())
            .then(|| unsafe { CStr::from_ptr(message) })
            .map(|text| text.to_string_lossy().into_owned())
    }

    #[test]
    fn failures_and_panics_leave_their_message_on_their_thread() {
        assert_eq!((guarded(|| Ok(7)), last_error()), (Some(7), None));
        assert_eq!(guarded(|| Err::<(), _>("no\0 way".into())), None);
        assert_eq!(last_error().as_deref(), Some("no way"));
        assert_eq!(guarded::<()>(|| panic!("broken {}", 1)), None);
        let broken = Some("cyltrace panicked: broken 1".to_owned());
        assert_eq!(last_error(), broken);
        assert_eq!((guarded(|| Ok(7)), last_error()), (Some(7), broken));
        let elsewhere = std::thread::spawn(last_error).join();
        assert_eq!(elsewhere.expect("no panic"), None);
    }
}
