//! A command line described for shells and for `man`, made from the same words as its help.
//!
//! Owns nothing else; `trik` takes it for its own command line. Behind the feature `manual`, which is on by default: a robot with little memory has no use for it.

use crate::error::Error;
use clap_complete::Shell;

/// The completion script of a shell.
pub fn completions(shell: Shell, mut program: clap::Command) -> Vec<u8> {
    let mut text = Vec::new();
    let name = program.get_name().to_owned();
    clap_complete::generate(shell, &mut program, name, &mut text);
    text
}

/// The manual page of the program, or of the command with these names: `dcml` and `plan` for `trik dcml plan`.
///
/// # Errors
/// There is no such command.
pub fn page(names: &[impl AsRef<str>], mut program: clap::Command) -> Result<Vec<u8>, Error> {
    // Gives the commands their full names and the help options that a parse would give them.
    program.build();
    let (mut title, version) = (program.get_name().to_owned(), env!("CARGO_PKG_VERSION"));
    let mut page = program;
    for name in names.iter().map(AsRef::as_ref) {
        title = format!("{title}-{name}");
        page = page
            .find_subcommand(name)
            .filter(|command| !command.is_hide_set())
            .cloned()
            .map(|command| command.display_name(&title).version(version))
            .ok_or_else(|| Error::NoCommand(name.to_owned()))?;
    }
    let mut text = Vec::new();
    clap_mangen::Man::new(page)
        .render(&mut text)
        .map_err(|error| Error::Os(error.into()))?;
    Ok(text)
}
