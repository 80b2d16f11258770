//! A line that moves while one waits.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Progress of a work of `total` parts. It shows itself only when the work takes longer than a second, and only on a
/// terminal.
pub struct Progress {
    what: &'static str,
    total: u64,
    done: u64,
    begun: Instant,
    bar: Option<ProgressBar>,
}

const PATIENCE: Duration = Duration::from_secs(1);

impl Progress {
    /// Nothing done yet.
    pub fn new(what: &'static str, total: usize) -> Self {
        Progress { what, total: total as u64, done: 0, begun: Instant::now(), bar: None }
    }

    /// One part more is done.
    pub fn advance(&mut self) {
        self.done += 1;
        if self.bar.is_none() && self.begun.elapsed() > PATIENCE {
            let style = ProgressStyle::with_template("{msg} {bar:40} {percent:>3} %, {eta} left");
            let bar = ProgressBar::new(self.total).with_message(self.what);
            self.bar = Some(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(self.done);
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
