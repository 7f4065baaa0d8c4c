//! A worker ends when the process that started it is killed.

/// The environment variable with the number of the process that started a worker.
pub const PARENT: &str = "CYLTRACE_PARENT";

/// Lets the system end this process when its parent ends, if it is a worker.
#[cfg(target_os = "linux")]
pub fn end_with_parent() -> anyhow::Result<()> {
    use rustix::process::{Signal, getppid, set_parent_process_death_signal};

    let Some(parent) = std::env::var(PARENT).ok() else {
        return Ok(());
    };
    set_parent_process_death_signal(Some(Signal::TERM))?;
    // It may have ended before that.
    let own = getppid().map(|process| process.as_raw_nonzero().to_string());
    if own != Some(parent) {
        anyhow::bail!("the process that started this worker has ended");
    }
    Ok(())
}

/// Other systems have no such signal: a worker completes its part.
#[cfg(not(target_os = "linux"))]
pub fn end_with_parent() -> anyhow::Result<()> {
    Ok(())
}
