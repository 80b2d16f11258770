//! The subcommands, a file each: what they take, and what they do.

mod animate;
mod check;
mod completions;
pub mod forward;
mod generate;
mod import;
pub mod inverse;
mod new;
mod plot;
mod show;
mod sweep;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::output;

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
    Sweep(sweep::Arguments),
    Generate(generate::Arguments),
    Import(import::Arguments),
    Plot(plot::Arguments),
    Animate(animate::Arguments),
    Show(show::Arguments),
    Completions(completions::Arguments),
}

/// Does what the command line asks for.
pub fn run() -> ExitCode {
    let Cli { command, quiet } = Cli::parse();
    let done = match command {
        Command::New(arguments) => new::run(&arguments, quiet),
        Command::Check(arguments) => check::run(&arguments, quiet),
        Command::Inverse(arguments) => inverse::run(&arguments, quiet),
        Command::Forward(arguments) => forward::run(&arguments, quiet),
        Command::Sweep(arguments) => sweep::run(&arguments, quiet),
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
