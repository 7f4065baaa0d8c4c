//! Progress bars: on a terminal only.

use std::io::{IsTerminal, stderr};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::arguments::Common;

/// A bar on standard error over `length` units, or an invisible one in a pipe
/// and under `--quiet`.
pub fn bar(common: &Common, length: u64, unit: &str) -> ProgressBar {
    if common.quiet || !stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let template = format!("{{wide_bar}} {{percent:>3}} % of {{len}} {unit}, {{eta}} left");
    let style = ProgressStyle::with_template(&template).expect("the template is well formed");
    ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr()).with_style(style)
}

/// A sign of life on standard error for work of unknown length.
pub fn spinner(common: &Common, message: &'static str) -> ProgressBar {
    if common.quiet || !stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::new_spinner().with_message(message);
    spinner.enable_steady_tick(std::time::Duration::from_millis(120));
    spinner
}
