//! The nodes of a mounted tree, as its files tell them.
//!
//! Owns finding them, and what is known of each for a recording. Reads names and texts, and no value.

use crate::limits;
use journal::node::Node;
use sample_bus::place;
use std::collections::HashMap;
use std::fs;
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// Files that a directory of a node has.
const FORMAT: &str = "format";
const NEWEST: &str = "bin_data";

/// All nodes below a mount point, in the order of their paths; second names are with their nodes.
pub fn find(root: &Path) -> Vec<Node> {
    let mut found: Vec<Node> = Vec::new();
    let mut directories = vec![(root.to_owned(), 0)];
    while let Some((directory, depth)) = directories.pop() {
        let mut names: Vec<PathBuf> = match fs::read_dir(&directory) {
            Ok(entries) => entries.flatten().map(|entry| entry.path()).collect(),
            // It has just gone.
            Err(_) => continue,
        };
        names.sort();
        for path in names {
            if depth < limits::TREE_DEPTH_MAX && found.len() < limits::NODES_MAX && path.is_dir() {
                if let Some(node) = node(root, &path) {
                    found.push(node);
                } else {
                    directories.push((path, depth + 1));
                }
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    with_aliases(root, found)
}

/// The node of a directory; None for a group.
fn node(root: &Path, directory: &Path) -> Option<Node> {
    let format = text(&directory.join(FORMAT))?;
    let path = directory.strip_prefix(root).ok()?.to_str()?.to_owned();
    let file = fs::metadata(directory.join(NEWEST)).ok()?;
    let value = directory.join("value");
    Some(Node {
        units: text(&directory.join("units")).unwrap_or_default(),
        about: String::new(),
        is_written: file.permissions().mode() & 0o200 != 0,
        rest: attribute(&value, "user.trik.rest").unwrap_or_default(),
        aliases: Vec::new(),
        is_raw: false,
        path,
        format,
    })
}

/// The rings of a tree have a link for each second name, also of a node that has no ring.
fn with_aliases(root: &Path, found: Vec<Node>) -> Vec<Node> {
    let directory = place::directory(Path::new(place::SHARED_MEMORY), root);
    let target = |node: &Node| -> Option<String> {
        let link = directory
            .as_ref()
            .ok()?
            .join(place::file_name(&node.path).ok()?);
        fs::read_link(link).ok()?.to_str().map(str::to_owned)
    };
    let (aliases, mut nodes): (Vec<_>, Vec<_>) = found
        .into_iter()
        .map(|node| (target(&node), node))
        .partition(|(target, _)| target.is_some());
    let mut by_ring: HashMap<String, usize> = HashMap::new();
    for (at, (_, node)) in nodes.iter().enumerate() {
        if let Ok(name) = place::file_name(&node.path) {
            by_ring.insert(name, at);
        }
    }
    for (target, alias) in aliases {
        match target.and_then(|target| by_ring.get(&target)) {
            Some(&at) => nodes[at].1.aliases.push(alias.path),
            // Its node has just gone.
            None => nodes.push((None, alias)),
        }
    }
    nodes.into_iter().map(|(_, node)| node).collect()
}

/// The text of a small file, without the end of its line; None if there is no such file.
pub(crate) fn text(path: &Path) -> Option<String> {
    let mut text = String::new();
    let file = fs::File::open(path).ok()?;
    let most = limits::TEXT_BYTES_MAX;
    file.take(most).read_to_string(&mut text).ok()?;
    Some(text.trim_end_matches('\n').to_owned())
}

/// An extended attribute as text; None if there is none.
fn attribute(path: &Path, name: &str) -> Option<String> {
    let mut bytes = [0; limits::REST_BYTES_MAX];
    let size = rustix::fs::getxattr(path, name, &mut bytes[..]).ok()?;
    String::from_utf8(bytes[..size].to_vec()).ok()
}
