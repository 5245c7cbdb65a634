//! The command line of `trikd`: what can be said, and which part of the crate does it.
//!
//! Owns the words, the help and the exit codes: 0 done, 1 refused or failed, 2 not understood. The hidden commands are
//! what `trikd` starts itself as: each is one child process.

use crate::brick::Brick;
use crate::engine::Engine;
use crate::host::Host;
use crate::js;
use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// The daemon of a robot that desktop clients, gamepads and programs talk to.
#[derive(Parser)]
#[command(name = "trikd", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// The process of one JavaScript program; its standard input is the channel to the daemon.
    #[command(hide = true)]
    Js {
        /// Where the tree is mounted.
        #[arg(long, env = "TRIK_TREE", value_name = "DIR")]
        tree: PathBuf,
    },
}

/// The program: reads the arguments of the process, does it, gives the exit code.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match cli.command {
        Command::Js { tree } => run_engine(&mut js::engine(), &tree),
    }
}

/// Runs one program of an engine in this process.
fn run_engine(engine: &mut impl Engine, tree: &std::path::Path) -> ExitCode {
    let host = match Host::from_standard_input() {
        Ok(host) => host,
        Err(error) => {
            eprintln!(
                "trikd: standard input is no channel to the daemon ({error}): this command is for trikd itself"
            );
            return ExitCode::FAILURE;
        }
    };
    let brick = Brick::new(tree);
    let outcome = match host.start() {
        Ok(start) => engine.run(start, &brick, &host),
        Err(error) => Err(format!("the daemon does not say what to run: {error}")),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(text) => {
            // The daemon that would show it may be gone.
            let _ = host.error(&text);
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }
}
