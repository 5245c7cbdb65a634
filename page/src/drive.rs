//! What one browser writes to the tree, and rest for it when the browser is gone.
//!
//! Owns which actuators it has moved. The filesystem checks every value, and knows leases: a program that has one keeps it.

use crate::error::Error;
use crate::limits;
use crate::word::News;
use std::collections::HashMap;
use std::fs::{self, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Component, Path, PathBuf};
use tokio::sync::mpsc;

/// Nothing here waits for a device.
const NONBLOCK: i32 = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();

/// What the thread of the files is told.
#[derive(Debug)]
pub enum Move {
    /// A value for an actuator.
    Write(String, String),
    /// What this browser has moved comes to rest, unless somebody else has moved it since.
    Rest,
    /// Everything comes to rest.
    Stop,
}

/// Carries out moves until there are no more, and brings to rest what is left then. Of several values that wait for one
/// actuator the newest is written.
pub async fn run(tree: PathBuf, mut moves: mpsc::Receiver<Move>, news: mpsc::Sender<News>) {
    let mut driven = HashMap::new();
    while let Some(first) = moves.recv().await {
        let mut batch = vec![first];
        while let Ok(more) = moves.try_recv() {
            batch.push(more);
        }
        let at = tree.clone();
        let work = move || {
            let said = carry_out(&at, &mut driven, batch);
            (driven, said)
        };
        let Ok((kept, said)) = tokio::task::spawn_blocking(work).await else {
            return;
        };
        driven = kept;
        for one in said {
            // A browser that does not read is told nothing; the value is on its way anyway.
            let _ = news.try_send(one);
        }
    }
    let _ = tokio::task::spawn_blocking(move || rest(&tree, &mut driven)).await;
}

/// By the path of an actuator: what its file said after this browser had written it.
type Driven = HashMap<String, String>;

fn carry_out(tree: &Path, driven: &mut Driven, batch: Vec<Move>) -> Vec<News> {
    let mut said = Vec::new();
    let mut newest: Vec<(String, String)> = Vec::new();
    for one in batch {
        match one {
            Move::Write(path, value) => {
                newest.retain(|(other, _)| *other != path);
                newest.push((path, value));
            }
            // What waits is older than this.
            Move::Rest => {
                newest.clear();
                rest(tree, driven);
            }
            Move::Stop => {
                newest.clear();
                driven.clear();
                if let Err(error) = fs::write(tree.join("stop"), "1") {
                    said.push(News::Refused(
                        Error::File("stop".to_owned(), error).to_string(),
                    ));
                }
            }
        }
    }
    for (path, value) in newest {
        let why = write(tree, driven, &path, &value).err();
        said.push(News::Written {
            path,
            value,
            why: why.map(|why| why.to_string()),
        });
    }
    said
}

/// The file of an actuator's value.
fn file(tree: &Path, path: &str) -> Result<PathBuf, Error> {
    let is_plain = |part: Component| matches!(part, Component::Normal(_));
    let is_path = !path.is_empty()
        && path.len() <= limits::PATH_BYTES_MAX
        && !path.contains('\0')
        && Path::new(path).components().all(is_plain);
    if !is_path {
        return Err(Error::Path(path.chars().take(80).collect()));
    }
    Ok(tree.join(path).join("value"))
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

/// What the file of a value says now. One that would have to be waited for is an error.
pub fn read(file: &Path) -> io::Result<String> {
    let mut text = String::new();
    let mut options = OpenOptions::new();
    let opened = options.read(true).custom_flags(NONBLOCK).open(file)?;
    opened
        .take(limits::WORDS_BYTES_MAX as u64)
        .read_to_string(&mut text)?;
    Ok(text)
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
            // Whoever holds a lease has it now, and drives.
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

    fn order(path: &str, value: &str) -> Move {
        Move::Write(path.to_owned(), value.to_owned())
    }

    #[test]
    fn the_newest_value_of_each_actuator_is_written_and_a_stop_drops_those_before_it() {
        let tree = tree();
        let mut driven = Driven::new();
        let moves = vec![order("motors/M1", "10"), order("motors/M1", "20")];
        let said = carry_out(tree.path(), &mut driven, moves);
        assert_eq!(said.len(), 1);
        assert_eq!(read(&tree.path().join("motors/M1/value")).unwrap(), "20\n");
        let moves = vec![order("motors/M1", "30"), Move::Stop];
        assert_eq!(carry_out(tree.path(), &mut driven, moves), []);
        assert_eq!(read(&tree.path().join("motors/M1/value")).unwrap(), "20\n");
        assert_eq!(read(&tree.path().join("stop")).unwrap(), "1");
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
            let said = carry_out(tree.path(), &mut Driven::new(), vec![order(path, "5")]);
            assert!(
                matches!(&said[..], [News::Written { why: Some(_), .. }]),
                "{path}: {said:?}"
            );
        }
        assert_eq!(read(&tree.path().join("secret")).unwrap(), "x");
    }
}
