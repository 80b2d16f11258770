//! A line that moves while one waits.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How far a computation is. It shows itself only when that takes longer than a second, and only on a terminal.
pub struct Progress {
    begun: Instant,
    shown: bool,
    /// Hidden at first: it has to know from the start on how fast the computation is.
    bar: ProgressBar,
    quiet: bool,
}

const PATIENCE: Duration = Duration::from_secs(1);

impl Progress {
    /// Nothing of `total` parts is done yet.
    pub fn new(total: usize, quiet: bool) -> Self {
        let style = ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left");
        let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::hidden());
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Progress { begun: Instant::now(), shown: false, bar, quiet }
    }

    /// So many parts are done.
    pub fn reach(&mut self, done: usize) {
        if !self.shown && !self.quiet && self.begun.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.shown = true;
        }
        self.bar.set_position(done as u64);
    }

    /// Prints a line above it.
    pub fn report(&self, text: &str) {
        self.bar.suspend(|| crate::output::to_stderr(text));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
