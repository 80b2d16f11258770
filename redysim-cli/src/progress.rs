//! A line that moves while one waits.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// How far a computation is. It shows itself only when that takes longer than a second, and only on a terminal.
pub struct Progress {
    total: u64,
    begun: Instant,
    bar: Option<ProgressBar>,
    quiet: bool,
}

const PATIENCE: Duration = Duration::from_secs(1);

impl Progress {
    /// Nothing of `total` parts is done yet.
    pub fn new(total: usize, quiet: bool) -> Self {
        Progress { total: total as u64, begun: Instant::now(), bar: None, quiet }
    }

    /// So many parts are done.
    pub fn reach(&mut self, done: usize) {
        if self.bar.is_none() && !self.quiet && self.begun.elapsed() > PATIENCE {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left");
            self.bar =
                Some(ProgressBar::new(self.total).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
