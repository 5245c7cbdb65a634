//! `edit`: the configuration of a mounted tree in an editor.
//!
//! Editors save by renaming, which the tree does not have; so the editor gets a copy, and the copy is written back as a
//! program would write it. Owns the copy, which outlives a refusal.

use crate::failure::Failure;
use crate::limits::STATUS_BYTES_MAX;
use config::limits::CONFIG_BYTES_MAX;
use nix::errno::Errno;
use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, BufRead, IsTerminal, Read, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Edits the configuration of the tree at `mountpoint` and applies it, again and again until it is accepted or the
/// user gives up.
///
/// # Errors
/// Why nothing was applied, and where the user's text is kept.
pub(super) fn edit(mountpoint: &Path) -> Result<(), Failure> {
    let ask = |reason: &str| {
        if !io::stdin().is_terminal() {
            return false;
        }
        let _ = write!(io::stderr(), "{reason}\nedit again? [Y/n] ");
        let mut answer = String::new();
        let read = io::stdin().lock().take(1000).read_line(&mut answer);
        matches!(read, Ok(1..)) && !answer.trim().to_ascii_lowercase().starts_with('n')
    };
    edit_with(mountpoint, &editor(), &ask)
}

/// What the user edits with, as words of the shell.
fn editor() -> String {
    ["VISUAL", "EDITOR"]
        .into_iter()
        .filter_map(|name| std::env::var(name).ok())
        .find(|value| !value.trim().is_empty())
        .unwrap_or_else(|| "vi".to_owned())
}

fn edit_with(mountpoint: &Path, editor: &str, again: &dyn Fn(&str) -> bool) -> Result<(), Failure> {
    let live = mountpoint.join("config");
    let before = read(&live)?;
    let copy = Copy::new(&before)?;
    loop {
        run_editor(editor, &copy.path).map_err(|failure| copy.keep(failure))?;
        let text = read(&copy.path)?;
        if text == before {
            let _ = writeln!(io::stderr(), "trikfs: nothing was changed");
            copy.remove();
            return Ok(());
        }
        let Err(error) = apply(&live, &text) else {
            copy.remove();
            return Ok(());
        };
        let reason = refusal(mountpoint, &live, &error);
        if !again(&reason) {
            return Err(copy.keep(Failure::NotApplied(reason)));
        }
    }
}

/// The user's text while it is not in force.
struct Copy {
    dir: PathBuf,
    path: PathBuf,
}

impl Copy {
    /// In a private directory: a configuration may hold what others should not read. Its name can be guessed, but what is
    /// there already is refused, and the directory has to stay when the text is not in force: `tempfile` would add
    /// nothing but itself to the program.
    fn new(text: &[u8]) -> Result<Self, Failure> {
        let name = format!(
            "trikfs-edit-{}-{}",
            nix::unistd::geteuid(),
            std::process::id()
        );
        let dir = std::env::temp_dir().join(name);
        let fail = |error: io::Error| Failure::file(&dir, error);
        DirBuilder::new().mode(0o700).create(&dir).map_err(fail)?;
        // The ending tells the editor what language it is.
        let path = dir.join("config.lua");
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .mode(0o600)
            .open(&path)
            .map_err(fail)?;
        file.write_all(text).map_err(fail)?;
        Ok(Self { dir, path })
    }

    fn remove(&self) {
        let _ = fs::remove_dir_all(&self.dir);
    }

    fn keep(&self, failure: Failure) -> Failure {
        Failure::Kept {
            why: Box::new(failure),
            path: self.path.clone(),
        }
    }
}

fn run_editor(editor: &str, path: &Path) -> Result<(), Failure> {
    // The variables hold words of the shell, for example `code --wait`.
    let status = Command::new("/bin/sh")
        .args(["-c", &format!("{editor} \"$1\""), "sh"])
        .arg(path)
        .status()
        .map_err(|error| Failure::system(format!("editor {editor}"), error))?;
    if status.success() {
        Ok(())
    } else {
        Err(Failure::Refused(format!("editor {editor}: {status}")))
    }
}

fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let limit = CONFIG_BYTES_MAX as u64;
    File::open(path)
        .and_then(|file| file.take(limit + 1).read_to_end(&mut text))
        .map_err(|error| Failure::file(path, error))?;
    if text.len() > CONFIG_BYTES_MAX {
        let why = format!("more than {CONFIG_BYTES_MAX} bytes");
        return Err(Failure::file(path, why));
    }
    Ok(text)
}

/// Writes the text and closes the file: it is the close that applies it and that fails if it is refused.
fn apply(live: &Path, text: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().write(true).truncate(true).open(live)?;
    file.write_all(text)?;
    Ok(nix::unistd::close(file)?)
}

/// The reason in `status` for a configuration that is no good, and the error itself for everything else.
fn refusal(mountpoint: &Path, live: &Path, error: &io::Error) -> String {
    let mut status = Vec::new();
    let found = File::open(mountpoint.join("status"))
        .and_then(|file| file.take(STATUS_BYTES_MAX).read_to_end(&mut status));
    let status = String::from_utf8_lossy(&status);
    match status.lines().next() {
        Some(line)
            if found.is_ok()
                && error.raw_os_error().map(Errno::from_raw) == Some(Errno::EINVAL) =>
        {
            line.to_owned()
        }
        _ => format!("{}: {error}", live.display()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use std::cell::Cell;

    fn tree(text: &str) -> Scratch {
        let scratch = Scratch::new();
        fs::write(scratch.path("config"), text).expect("written");
        scratch
    }

    fn kept(refusal: &str) -> PathBuf {
        let path = refusal.rsplit("your text is in ").next().expect("a path");
        let text = PathBuf::from(path);
        assert!(text.is_file(), "{refusal}");
        text
    }

    /// One directory per process is enough for a user, but not for tests that run at once.
    static ONE_AT_A_TIME: std::sync::Mutex<()> = std::sync::Mutex::new(());

    #[test]
    fn what_the_editor_leaves_is_applied() {
        let _turn = ONE_AT_A_TIME.lock();
        let tree = tree("trikfs = {}\n");
        edit_with(tree.dir(), "sed -i s/{}/nil/", &|_| false).expect("applied");
        assert_eq!(
            fs::read_to_string(tree.path("config")).expect("read"),
            "trikfs = nil\n"
        );
    }

    #[test]
    fn an_editor_that_fails_applies_nothing_and_the_text_is_kept() {
        let _turn = ONE_AT_A_TIME.lock();
        let tree = tree("trikfs = {}\n");
        let refusal = edit_with(tree.dir(), "false", &|_| true)
            .expect_err("refused")
            .to_string();
        assert!(
            refusal.starts_with("editor false: exit status: 1\n"),
            "{refusal}"
        );
        fs::remove_dir_all(kept(&refusal).parent().expect("a directory")).expect("removed");
        assert_eq!(
            fs::read_to_string(tree.path("config")).expect("read"),
            "trikfs = {}\n"
        );
    }

    #[test]
    fn a_refusal_shows_the_reason_offers_another_try_and_keeps_the_text() {
        let _turn = ONE_AT_A_TIME.lock();
        let tree = tree("good\n");
        // Another directory in its place: writing fails, as a refused close does.
        let tries = Cell::new(0);
        let again = |reason: &str| {
            assert!(reason.contains("config: "), "{reason}");
            tries.set(tries.get() + 1);
            tries.get() < 3
        };
        let editor = format!(
            "rm -rf {0}; mkdir -p {0}; echo bad >",
            tree.path("config").display()
        );
        let refusal = edit_with(tree.dir(), &editor, &again)
            .expect_err("refused")
            .to_string();
        assert_eq!(tries.get(), 3);
        let text = kept(&refusal);
        assert_eq!(fs::read_to_string(&text).expect("read"), "bad\n");
        fs::remove_dir_all(text.parent().expect("a directory")).expect("removed");
    }

    #[test]
    fn the_first_line_of_status_is_the_reason_of_a_refused_configuration() {
        let tree = tree("");
        fs::write(
            tree.path("status"),
            "refused: config:3: no src\nrandom running\n",
        )
        .expect("written");
        let reason = |errno| {
            refusal(
                tree.dir(),
                &tree.path("config"),
                &io::Error::from_raw_os_error(errno),
            )
        };
        assert_eq!(reason(libc::EINVAL), "refused: config:3: no src");
        assert!(reason(libc::EACCES).ends_with("config: Permission denied (os error 13)"));
    }

    #[test]
    fn a_directory_without_a_configuration_is_no_tree() {
        let scratch = Scratch::new();
        let refusal = edit_with(scratch.dir(), "true", &|_| false)
            .expect_err("refused")
            .to_string();
        assert!(
            refusal.ends_with("config: No such file or directory (os error 2)"),
            "{refusal}"
        );
    }
}
