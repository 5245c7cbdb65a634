//! The configuration of the tree: what is in force, and another one that a person has written in the browser.
//!
//! Owns how it is read and replaced: by the file `config`, whose fsync waits until it is in force or refused, and by the first line
//! of `status`, which says why; its other lines say what is wrong with nodes. Knows no Lua. What was refused changes nothing.

use crate::error::Error;
use crate::limits;
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::Path;

/// What is in force, as JSON: its `text`, what the filesystem says about the last one it was given, as `status`, and pairs of a node
/// and what is wrong with it, as `faults`.
///
/// # Errors
/// The tree is not there.
pub fn read(tree: &Path) -> Result<Value, Error> {
    let failed = |error| Error::File("config".to_owned(), error);
    let file = File::open(tree.join("config")).map_err(failed)?;
    let mut bytes = Vec::new();
    let most = limits::CONFIGURATION_BYTES_MAX as u64;
    file.take(most).read_to_end(&mut bytes).map_err(failed)?;
    let text = String::from_utf8_lossy(&bytes);
    let status = status(tree);
    let mut lines = status.lines();
    let first = lines.next().unwrap_or_default();
    let faults: Vec<_> = lines.filter_map(fault).collect();
    Ok(json!({"text": text, "status": first, "faults": faults}))
}

/// Gives the filesystem another one. It is in force when this returns.
///
/// # Errors
/// The filesystem refuses it; then that one stays which was in force.
pub fn replace(tree: &Path, text: &str) -> Result<(), Error> {
    let failed = |error| Error::File("config".to_owned(), error);
    let most = limits::CONFIGURATION_BYTES_MAX;
    if text.len() > most {
        return Err(Error::Long(text.len(), most));
    }
    let mut options = fs::OpenOptions::new();
    let mut file = options
        .write(true)
        .truncate(true)
        .open(tree.join("config"))
        .map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    file.sync_all().map_err(|error| {
        let status = status(tree);
        match status.lines().next() {
            Some(said) if said.starts_with(REFUSED) => Error::Configuration(said.to_owned()),
            _ => failed(error),
        }
    })
}

/// How the first line of `status` begins if the last configuration was refused.
const REFUSED: &str = "config refused: ";

/// The node of a line of `status`, and what is wrong with it: `m fault 0.0Hz converter: config:4: reason`.
fn fault(line: &str) -> Option<(&str, &str)> {
    let mut words = line.splitn(4, ' ');
    let (path, state, _rate, fault) = (words.next()?, words.next()?, words.next()?, words.next()?);
    (state == "fault").then_some((path, fault))
}

/// What `status` says; empty if the tree is not there.
fn status(tree: &Path) -> String {
    let mut bytes = Vec::new();
    if let Ok(file) = File::open(tree.join("status")) {
        // What was read before an error counts.
        let _ = file
            .take(limits::STATUS_BYTES_MAX as u64)
            .read_to_end(&mut bytes);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_read_and_replaced_by_the_file_of_the_tree() {
        let tree = tempfile::tempdir().unwrap();
        let path = tree.path();
        assert!(matches!(read(path), Err(Error::File(..))));
        assert!(matches!(replace(path, "x"), Err(Error::File(..))));
        fs::write(path.join("config"), "a longer one").unwrap();
        fs::write(
            path.join("status"),
            "config ok: 1 nodes\nled ready 0.0Hz -\nm fault 0.0Hz converter: config:4: no\n",
        )
        .unwrap();
        let said = read(path).unwrap();
        assert_eq!(
            said,
            json!({
                "text": "a longer one",
                "status": "config ok: 1 nodes",
                "faults": [["m", "converter: config:4: no"]],
            })
        );
        replace(path, "short").unwrap();
        assert_eq!(fs::read_to_string(path.join("config")).unwrap(), "short");
        let long = "x".repeat(limits::CONFIGURATION_BYTES_MAX + 1);
        assert!(matches!(replace(path, &long), Err(Error::Long(..))));
        assert_eq!(fs::read_to_string(path.join("config")).unwrap(), "short");
    }
}
