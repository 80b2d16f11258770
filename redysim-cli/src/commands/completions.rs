//! `redysim completions SHELL`: what a shell needs to complete the command.

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use super::Cli;
use crate::failure::Failure;
use crate::output::print;

/// Print the completions of a shell.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim completions bash > ~/.local/share/bash-completion/completions/redysim")]
pub struct Arguments {
    /// The shell.
    shell: Shell,
}

/// Prints them.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut Cli::command(), "redysim", &mut script);
    print(&String::from_utf8_lossy(&script))
}
