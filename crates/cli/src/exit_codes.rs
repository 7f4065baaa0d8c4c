//! The exit codes of the program, also as the table in the help and in
//! docs/command-line.md.

/// The command succeeded.
pub const GOOD: u8 = 0;

/// A check failed.
pub const CHECK_FAILED: u8 = 1;

/// The command could not run.
pub const COULD_NOT_RUN: u8 = 2;

/// Every exit code and its meaning.
pub const TABLE: [(u8, &str); 6] = [
    (
        GOOD,
        "Success, also if the reader of standard output closes it early, as `head` does",
    ),
    (
        CHECK_FAILED,
        "A check failed: `check` found a wrong answer or a class of rays without a bound, `stress` a broken promise, or `bench traversal` a wrong answer of this library",
    ),
    (
        COULD_NOT_RUN,
        "The command could not run: wrong arguments, invalid input or an output that cannot be written; standard error has the reason",
    ),
    (
        129,
        "Ended by SIGHUP, unless the program was started with SIGHUP ignored, as by `nohup`",
    ),
    (130, "Ended by Ctrl-C (SIGINT)"),
    (143, "Ended by SIGTERM"),
];

/// The table as a section of the help.
pub fn help() -> String {
    let lines = TABLE.map(|(code, meaning)| format!("\n  {code:>3}  {meaning}"));
    format!("Exit codes:{}", lines.concat())
}
