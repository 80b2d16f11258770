//! The command `redysim`: what ReDySim's user does with `inputs.m`, `runinv`, `runfor`, `plot_*` and `animate`, on any
//! mechanism in TOML, without writing Rust; and the way from there to compiled code.
//!
//! Exit codes: 0 all is well; 1 the input is at fault (a model, a scenario, a table); 2 the command line is; 3
//! something outside is (a file that cannot be read or written, an integration that cannot go on); 130 interrupted.

// They panic if the pipe is closed; `output` does not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod closed;
mod commands;
mod failure;
mod interrupt;
mod layout;
mod model;
mod number;
mod output;
mod page;
mod progress;
mod recorded;
mod results;
mod scenario;
mod summary;
mod table;
mod urdf;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use commands::{animate, check, completions, forward, generate, import, inverse, new, plot, show};

/// Dynamics of serial, tree-type and closed-loop mechanisms written in TOML.
#[derive(Parser)]
#[command(name = "redysim", version, propagate_version = true, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Print nothing but errors and what was asked for.
    #[arg(long, short, global = true)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    New(new::Arguments),
    Check(check::Arguments),
    Inverse(inverse::Arguments),
    Forward(forward::Arguments),
    Generate(generate::Arguments),
    Import(import::Arguments),
    Plot(plot::Arguments),
    Animate(animate::Arguments),
    Show(show::Arguments),
    Completions(completions::Arguments),
}

fn main() -> ExitCode {
    let Cli { command, quiet } = Cli::parse();
    let done = match command {
        Command::New(arguments) => new::run(&arguments, quiet),
        Command::Check(arguments) => check::run(&arguments, quiet),
        Command::Inverse(arguments) => inverse::run(&arguments, quiet),
        Command::Forward(arguments) => forward::run(&arguments, quiet),
        Command::Generate(arguments) => generate::run(&arguments, quiet),
        Command::Import(arguments) => import::run(&arguments, quiet),
        Command::Plot(arguments) => plot::run(&arguments, quiet),
        Command::Animate(arguments) => animate::run(&arguments, quiet),
        Command::Show(arguments) => show::run(&arguments, quiet),
        Command::Completions(arguments) => completions::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::to_stderr(&failure.to_string());
            failure.exit_code()
        }
    }
}
