//! The command line described for shells and for `man`, made from the same words as its help.
//!
//! Owns nothing else. Behind the feature `manual`, which is on by default: a robot with little memory has no use for it.

use super::Cli;
use crate::failure::Failure;
use clap::CommandFactory;
use clap_complete::Shell;

/// The completion script of a shell.
pub(super) fn completions(shell: Shell) -> Vec<u8> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "trikfs", &mut text);
    text
}

/// The manual page of the program, or of one of its commands.
///
/// # Errors
/// There is no such command.
pub(super) fn page(name: Option<&str>) -> Result<Vec<u8>, Failure> {
    let mut program = Cli::command();
    // Gives the commands their full names and the help options that a parse would give them.
    program.build();
    let page = match name {
        None => program,
        Some(name) => program
            .find_subcommand(name)
            .filter(|command| !command.is_hide_set())
            .cloned()
            .map(|command| {
                command
                    .display_name(format!("trikfs-{name}"))
                    .version(env!("CARGO_PKG_VERSION"))
            })
            .ok_or_else(|| Failure::Refused(format!("there is no command {name}")))?,
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page)
        .render(&mut text)
        .map_err(|error| Failure::Refused(error.to_string()))?;
    Ok(text)
}
