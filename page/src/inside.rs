//! The inside of a node, for a person who works on its converters: its params, and a sample's bytes on their way through them.
//!
//! Owns how both are found in the tree, and how often it is looked while a browser wants to see one. Knows no converter: `stages`
//! of a node says what they made, in hexadecimal.

use crate::{limits, tree};
use serde_json::{Value, json};
use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::unix::fs::{FileExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use tokio::sync::{Semaphore, watch};
use tokio::time::{MissedTickBehavior, interval, sleep};

/// The extended attribute with the range of a param.
const RANGE: &str = "user.trik.range";

/// All nodes that have converters or params, as JSON; a side of a range without a limit is null.
pub fn list(tree: &Path) -> Value {
    let mut nodes = Vec::new();
    visit(tree, "", 0, &mut nodes);
    nodes.sort_by(|(one, _), (other, _)| one.cmp(other));
    nodes.into_iter().map(|(_, node)| node).collect()
}

fn visit(at: &Path, path: &str, depth: usize, nodes: &mut Vec<(String, Value)>) {
    for entry in fs::read_dir(at).into_iter().flatten().flatten() {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if !is_folder || depth >= limits::FOLDERS_MAX || nodes.len() >= limits::ROWS_MAX {
            continue;
        }
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = match path {
            "" => name,
            before => format!("{before}/{name}"),
        };
        let directory = entry.path();
        if !directory.join("format").is_file() {
            visit(&directory, &path, depth + 1, nodes);
            continue;
        }
        let has_stages = directory.join("stages").is_file();
        let params = params(&directory.join("params"));
        if has_stages || !params.is_empty() {
            let text = |file: &str| tree::read(&directory.join(file)).unwrap_or_default();
            let node = json!({
                "path": path, "format": text("format").trim(), "units": text("units").trim(),
                "stages": has_stages, "params": params,
            });
            nodes.push((path, node));
        }
    }
}

fn params(at: &Path) -> Vec<Value> {
    let mut files: Vec<_> = fs::read_dir(at).into_iter().flatten().flatten().collect();
    files.sort_by_key(fs::DirEntry::file_name);
    let one = |entry: &fs::DirEntry| {
        let value: f64 = tree::read(&entry.path()).ok()?.trim().parse().ok()?;
        let (min, max) = range(&entry.path());
        let name = entry.file_name().into_string().ok()?;
        Some(json!({"name": name, "value": value, "min": min, "max": max}))
    };
    files
        .iter()
        .take(limits::PARAMS_MAX)
        .filter_map(one)
        .collect()
}

fn range(file: &Path) -> (Option<f64>, Option<f64>) {
    let mut bytes = [0; 80];
    let size = rustix::fs::getxattr(file, RANGE, &mut bytes[..]).unwrap_or(0);
    let text = String::from_utf8_lossy(&bytes[..size.min(bytes.len())]);
    let mut sides = text.split(' ').map(|side| side.parse().ok());
    (sides.next().flatten(), sides.next().flatten())
}

/// The tuples of a sample on their way.
#[derive(Clone, Debug, PartialEq)]
pub struct Stages {
    /// The node.
    pub path: String,
    /// When it was looked, since 1970.
    pub at: Duration,
    /// That of the source, then what each converter has made of it, as far as it came; in hexadecimal.
    pub tuples: Vec<String>,
}

/// Looks into the node that a browser wants to see, until the browser is gone; `told` changes with what is there.
pub async fn run(
    tree: PathBuf,
    mut wanted: watch::Receiver<Option<String>>,
    told: watch::Sender<Option<Stages>>,
    looks: Arc<Semaphore>,
) {
    loop {
        let path = wanted.borrow_and_update().clone();
        let ended = match path {
            None => wanted.changed().await.is_err(),
            Some(path) => tokio::select! {
                changed = wanted.changed() => changed.is_err(),
                () = watch_one(&tree, &path, &told, &looks) => true,
            },
        };
        if ended {
            return;
        }
    }
}

/// Goes on until it is dropped, or nobody hears it.
async fn watch_one(
    tree: &Path,
    path: &str,
    told: &watch::Sender<Option<Stages>>,
    looks: &Arc<Semaphore>,
) {
    let mut pace = interval(limits::PICTURE_TIME);
    pace.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut open = None;
    while !told.is_closed() {
        pace.tick().await;
        // Nobody closes the semaphore.
        let turn = looks.clone().acquire_owned().await;
        let (at, wanted) = (tree.to_owned(), path.to_owned());
        let look = move || {
            // A device that hangs keeps its turn: the other threads are for what moves.
            let _turn = turn;
            look(&at, &wanted, open)
        };
        let looked = tokio::task::spawn_blocking(look).await.ok();
        let (kept, tuples) = looked.flatten().unzip();
        let tuples = tuples.unwrap_or_default();
        open = kept;
        // Between two pieces of a tuple the last one is the newest; of a device that is gone there is none.
        let is_between = tuples.is_empty() && open.is_some();
        told.send_if_modified(|last| {
            let is_same =
                |last: &Stages| last.path == path && (last.tuples == tuples || is_between);
            // A node that says nothing at all says that once.
            let is_news = !last.as_ref().is_some_and(is_same);
            if is_news {
                let at = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
                *last = Some(Stages {
                    path: path.to_owned(),
                    at: at.unwrap_or_default(),
                    tuples,
                });
            }
            is_news
        });
        if open.is_none() {
            // The node is not there, has no converters, or its device is gone.
            sleep(limits::RETURN_TIME).await;
        }
    }
}

/// What `stages` of a node says now, with the file, which is opened if it is not; None: it cannot be read.
fn look(tree: &Path, path: &str, open: Option<File>) -> Option<(File, Vec<String>)> {
    let file = match open {
        Some(file) => file,
        None => {
            let at = tree::node(tree, path).ok()?.join("stages");
            let mut options = OpenOptions::new();
            options
                .read(true)
                .custom_flags(tree::NONBLOCK)
                .open(at)
                .ok()?
        }
    };
    let text = text(&file).ok()?;
    let tuples = text.lines().map(str::to_owned).collect();
    Some((file, tuples))
}

fn text(file: &File) -> io::Result<String> {
    let mut bytes = vec![0; limits::STAGES_BYTES_MAX];
    let mut size = 0;
    loop {
        let got = file.read_at(&mut bytes[size..], size as u64)?;
        size += got;
        if got == 0 {
            return Ok(String::from_utf8_lossy(&bytes[..size]).into_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> tempfile::TempDir {
        let tree = tempfile::tempdir().unwrap();
        for (file, text) in [
            ("sensors/A1/format", "i32 distance\n"),
            ("sensors/A1/units", "cm\n"),
            ("sensors/A1/stages", "4201\n19000000\n"),
            ("sensors/A1/params/alpha", "0.25\n"),
            ("sensors/A1/params/odd", "none\n"),
            ("sensors/A2/format", "u8 raw\n"),
            ("lamp/format", "u8 on\n"),
            ("lamp/params/gain", "2\n"),
        ] {
            let file = tree.path().join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, text).unwrap();
        }
        tree
    }

    #[test]
    fn nodes_with_converters_or_params_are_listed_with_them() {
        let tree = tree();
        let none = Value::Null;
        let param = |name: &str, value: f64| json!({"name": name, "value": value, "min": none, "max": none});
        assert_eq!(
            list(tree.path()),
            json!([
                {"path": "lamp", "format": "u8 on", "units": "", "stages": false, "params": [param("gain", 2.0)]},
                {"path": "sensors/A1", "format": "i32 distance", "units": "cm", "stages": true, "params": [param("alpha", 0.25)]},
            ])
        );
    }

    #[test]
    fn what_a_browser_wants_to_see_is_told_as_often_as_it_changes() {
        let tree = tree();
        let (want, wanted) = watch::channel(None);
        let (tell, mut told) = watch::channel(None);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .build()
            .unwrap();
        runtime.block_on(async {
            let looks = Arc::new(Semaphore::new(1));
            let task = tokio::spawn(run(tree.path().to_owned(), wanted, tell, looks));
            for path in ["../sensors/A1", "sensors/A2"] {
                want.send(Some(path.to_owned())).unwrap();
                told.changed().await.unwrap();
                let said = told.borrow_and_update().clone().unwrap();
                assert_eq!((said.path.as_str(), said.tuples.len()), (path, 0));
            }
            want.send(Some("sensors/A1".to_owned())).unwrap();
            told.changed().await.unwrap();
            let first = told.borrow_and_update().clone().unwrap();
            assert_eq!(first.tuples, ["4201", "19000000"]);
            fs::write(tree.path().join("sensors/A1/stages"), "4301\n1a000000\n").unwrap();
            loop {
                told.changed().await.unwrap();
                let next = told.borrow_and_update().clone().unwrap();
                // A plain file can be seen while it is written.
                if next.tuples == ["4301", "1a000000"] {
                    assert!(next.at >= first.at);
                    break;
                }
            }
            drop(want);
            task.await.unwrap();
        });
    }
}
