//! The command `redysim`: what ReDySim's user does with `inputs.m`, `runinv`, `runfor`, `plot_*` and `animate`, on any
//! mechanism in TOML, without writing Rust; and the way from there to compiled code.
//!
//! Exit codes: 0 all is well; 1 the input is at fault (a model, a scenario, a table); 2 the command line is; 3
//! something outside is (a file that cannot be read or written, an integration that cannot go on); 130 interrupted.

use std::process::ExitCode;

fn main() -> ExitCode {
    redysim_cli::run()
}
