//! What one browser writes to the tree, and rest for it when the browser is gone.
//!
//! Owns which actuators it has moved. The filesystem checks every value, and knows leases: a program that has one keeps it.

use crate::control::Browser;
use crate::error::{Busy, Error};
use crate::limits;
use crate::tree::{NONBLOCK, node, read};
use crate::word::{News, Target};
use std::collections::HashMap;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::{Notify, mpsc, watch};

/// What a browser wants moved and what was not carried out yet. Nothing in it is ever refused for want of room but new
/// actuators: the newest value of each counts, and a rest or a stop drops what is older.
#[derive(Debug, Default)]
pub struct Moves {
    waiting: Mutex<Waiting>,
    news: Notify,
}

#[derive(Debug, Default)]
struct Waiting {
    values: Vec<(Target, String)>,
    rest: bool,
    stop: bool,
    is_over: bool,
}

impl Moves {
    fn tell(&self, change: impl FnOnce(&mut Waiting) -> bool) -> bool {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let done = change(&mut waiting);
        drop(waiting);
        self.news.notify_one();
        done
    }

    /// A value for an actuator, or for a param.
    ///
    /// # Errors
    /// So many others wait already.
    pub fn write(&self, target: Target, value: String) -> Result<(), Error> {
        let fits = self.tell(|waiting| {
            waiting.values.retain(|(other, _)| *other != target);
            let fits = waiting.values.len() < limits::ORDERS;
            if fits {
                waiting.values.push((target, value));
            }
            fits
        });
        let full = || Error::Busy(Busy::Values);
        fits.then_some(()).ok_or_else(full)
    }

    /// What this browser has moved comes to rest, unless somebody else has moved it since.
    pub fn rest(&self) {
        self.tell(|waiting| {
            waiting.values.clear();
            waiting.rest = true;
            true
        });
    }

    /// Everything comes to rest.
    pub fn stop(&self) {
        self.tell(|waiting| {
            waiting.values.clear();
            waiting.stop = true;
            true
        });
    }

    /// The browser is gone: what it has moved comes to rest, and nothing follows.
    pub fn end(&self) {
        self.tell(|waiting| {
            waiting.is_over = true;
            true
        });
        self.rest();
    }

    fn take(&self) -> Waiting {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let is_over = waiting.is_over;
        let taken = std::mem::take(&mut *waiting);
        waiting.is_over = is_over;
        taken
    }
}

/// Carries out moves until the browser is gone. When another one is in control, what this one has moved comes to rest, whatever
/// its connection does.
pub async fn run(
    tree: PathBuf,
    moves: Arc<Moves>,
    news: mpsc::Sender<News>,
    mut holder: watch::Receiver<Option<Browser>>,
    who: Browser,
) {
    let mut driven = HashMap::new();
    loop {
        tokio::select! {
            () = moves.news.notified() => {}
            changed = holder.changed() => if changed.is_err() { return },
        }
        let mut work = moves.take();
        let is_others = holder.borrow_and_update().is_some_and(|now| now != who);
        if is_others {
            work.values.clear();
            work.rest = true;
        }
        let is_over = work.is_over;
        let at = tree.clone();
        let carry = move || {
            let said = carry_out(&at, &mut driven, work);
            (driven, said)
        };
        let Ok((kept, said)) = tokio::task::spawn_blocking(carry).await else {
            return;
        };
        driven = kept;
        for one in said {
            // A browser that does not read is told nothing; the value is on its way anyway.
            let _ = news.try_send(one);
        }
        if is_over {
            return;
        }
    }
}

/// By the path of an actuator: what its file said after this browser had written it.
type Driven = HashMap<String, String>;

fn carry_out(tree: &Path, driven: &mut Driven, work: Waiting) -> Vec<News> {
    let mut said = Vec::new();
    if work.stop {
        driven.clear();
        if let Err(error) = fs::write(tree.join("stop"), "1") {
            said.push(News::Refused(Error::File("stop".to_owned(), error).words()));
        }
    }
    if work.rest {
        rest(tree, driven);
    }
    for (target, value) in work.values {
        let why = match &target.param {
            Some(param) => set(tree, &target.path, param, &value).err(),
            None => write(tree, driven, &target.path, &value).err(),
        };
        said.push(News::Written {
            target,
            value,
            why: why.map(|why| why.words()),
        });
    }
    said
}

/// The file of an actuator's value.
fn file(tree: &Path, path: &str) -> Result<PathBuf, Error> {
    Ok(node(tree, path)?.join("value"))
}

/// A number of a node's converters. It stays when the browser is gone: nothing moves by it alone.
fn set(tree: &Path, path: &str, param: &str, value: &str) -> Result<(), Error> {
    let params = node(tree, path)?.join("params");
    let file = node(&params, param)?;
    let mut options = OpenOptions::new();
    let wrote = options
        .write(true)
        .custom_flags(NONBLOCK)
        .open(file)
        .and_then(|mut opened| opened.write_all(format!("{}\n", value.trim_end()).as_bytes()));
    wrote.map_err(|error| Error::File(format!("{path}/params/{param}"), error))
}

fn write(tree: &Path, driven: &mut Driven, path: &str, value: &str) -> Result<(), Error> {
    let file = file(tree, path)?;
    let mut line = value.trim_end_matches('\n').to_owned();
    line.push('\n');
    let mut options = OpenOptions::new();
    let wrote = options
        .write(true)
        .custom_flags(NONBLOCK)
        .open(&file)
        .and_then(|mut opened| opened.write_all(line.as_bytes()));
    wrote.map_err(|error| {
        if error.kind() == io::ErrorKind::NotFound {
            Error::Path(path.to_owned())
        } else {
            Error::File(path.to_owned(), error)
        }
    })?;
    if let Ok(text) = read(&file) {
        driven.insert(path.to_owned(), text);
    }
    Ok(())
}

fn rest(tree: &Path, driven: &mut Driven) {
    for (path, text) in driven.drain() {
        let Ok(file) = file(tree, &path) else {
            continue;
        };
        let mut bytes = vec![0; limits::PATH_BYTES_MAX];
        let size = rustix::fs::getxattr(&file, "user.trik.rest", &mut bytes[..]).unwrap_or(0);
        bytes.truncate(size);
        // Without such a value it is a display or a sound, which moves nothing.
        if size > 0 && read(&file).is_ok_and(|now| now == text) {
            bytes.push(b'\n');
            // The program that holds a lease has it now, and drives.
            let _ = fs::write(&file, &bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> tempfile::TempDir {
        let tree = tempfile::tempdir().unwrap();
        fs::create_dir_all(tree.path().join("motors/M1")).unwrap();
        fs::write(tree.path().join("motors/M1/value"), "0\n").unwrap();
        fs::write(tree.path().join("secret"), "x").unwrap();
        fs::write(tree.path().join("stop"), "").unwrap();
        tree
    }

    fn own(path: &str) -> Target {
        Target {
            path: path.to_owned(),
            param: None,
        }
    }

    #[test]
    fn a_param_is_written_and_nothing_else_of_its_node() {
        let tree = tree();
        let node = tree.path().join("motors/M1");
        fs::create_dir_all(node.join("params")).unwrap();
        fs::write(node.join("params/gain"), "1\n").unwrap();
        let moves = Moves::default();
        let mut driven = Driven::new();
        for param in ["gain", "none", "../value", "..", "", "/etc/passwd"] {
            let param = Some(param.to_owned());
            let path = "motors/M1".to_owned();
            moves
                .write(Target { path, param }, "2.5".to_owned())
                .unwrap();
        }
        let said = carry_out(tree.path(), &mut driven, moves.take());
        let is_done = |news: &News| matches!(news, News::Written { why: None, .. });
        assert_eq!(
            said.iter().map(is_done).collect::<Vec<_>>(),
            [true, false, false, false, false, false]
        );
        assert_eq!(read(&node.join("params/gain")).unwrap(), "2.5\n");
        assert_eq!(read(&node.join("value")).unwrap(), "0\n");
        assert!(driven.is_empty());
    }

    #[test]
    fn the_newest_value_of_each_actuator_is_written_and_a_stop_drops_those_before_it() {
        let tree = tree();
        let mut driven = Driven::new();
        let moves = Moves::default();
        let write = |value: i32| moves.write(own("motors/M1"), value.to_string());
        for value in 0..=300 {
            write(value).unwrap();
        }
        write(20).unwrap();
        let said = carry_out(tree.path(), &mut driven, moves.take());
        assert_eq!(said.len(), 1);
        assert_eq!(read(&tree.path().join("motors/M1/value")).unwrap(), "20\n");
        write(30).unwrap();
        moves.stop();
        assert_eq!(carry_out(tree.path(), &mut driven, moves.take()), []);
        assert_eq!(read(&tree.path().join("motors/M1/value")).unwrap(), "20\n");
        assert_eq!(read(&tree.path().join("stop")).unwrap(), "1");
        for at in 0..limits::ORDERS {
            moves.write(own(&at.to_string()), "1".to_owned()).unwrap();
        }
        assert!(moves.write(own("one more"), "1".to_owned()).is_err());
        moves.end();
        let last = moves.take();
        assert!(last.values.is_empty() && last.rest && last.is_over);
    }

    #[test]
    fn no_path_leads_out_of_the_tree_or_to_another_file() {
        let tree = tree();
        for path in [
            "",
            "..",
            "../motors/M1",
            "/motors/M1",
            "motors/../../x",
            "a\0b",
            "secret",
            "motors",
            "none",
            &"a/".repeat(2000),
        ] {
            let said = {
                let moves = Moves::default();
                moves.write(own(path), "5".to_owned()).unwrap();
                carry_out(tree.path(), &mut Driven::new(), moves.take())
            };
            assert!(
                matches!(&said[..], [News::Written { why: Some(_), .. }]),
                "{path}: {said:?}"
            );
        }
        assert_eq!(read(&tree.path().join("secret")).unwrap(), "x");
    }
}
