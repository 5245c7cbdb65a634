//! The names: which files there are, with which numbers, modes and owners.
//!
//! Owns an immutable tree that a reload replaces as a whole. A node that a reload keeps, keeps its numbers, so that
//! the kernel's caches and open files of it stay true. Opens nothing.

use crate::clock::Stamp;
use crate::errno::Error;
use crate::files::value::View;
use crate::limits::{KEPT_LONG, KEPT_SHORT};
use crate::node::Node;
use crate::transport::{Attr, DirEntry, FileKind};
use config::description::{Alias, Pace};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

/// Number of the root directory, fixed by the kernel.
pub const ROOT: u64 = 1;

/// What `stat` shows as the size of a text that is made when it is read, as in sysfs.
const TEXT_SIZE: u64 = 4096;

/// What a number stands for.
#[derive(Clone)]
pub enum Kind {
    /// The root, a group or a node's directory.
    Directory,
    /// `config`
    Config,
    /// `status`
    Status,
    /// `log`
    Log,
    /// `stop`
    Stop,
    /// `device`
    Device(Arc<Node>),
    /// `bin_data`, `value`, `valueN` or an attribute.
    Value(Arc<Node>, View),
    /// `units`
    Units(Arc<Node>),
    /// `format`
    Format(Arc<Node>),
    /// `poll_ms`
    Period(Arc<Node>),
    /// `params/NAME`
    Param(Arc<Node>, Arc<str>),
    /// `fault`
    Fault(Arc<Node>),
    /// `stats`
    Stats(Arc<Node>),
    /// `stages`
    Stages(Arc<Node>),
    /// `owner`
    Owner(Arc<Node>),
}

/// One file or directory.
pub struct Entry {
    /// Number of the directory it is in.
    pub parent: u64,
    /// Name there.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    children: BTreeMap<String, u64>,
}

/// Owners and groups of the files, unless a description says otherwise.
#[derive(Clone, Copy, Debug)]
pub struct Owner {
    /// The mounting user.
    pub uid: u32,
    /// The mounting user's group.
    pub gid: u32,
    /// A group that may write `config` as well.
    pub config_group: Option<u32>,
    /// A group that may write the files of nodes as their owner may.
    pub group: Option<u32>,
}

/// All names of one configuration.
pub struct Tree {
    entries: HashMap<u64, Entry>,
    nodes: Vec<Arc<Node>>,
    owner: Owner,
    made: SystemTime,
}

/// A name that the kernel must forget: directory and name, and the number it had.
pub struct Gone {
    /// Directory.
    pub parent: u64,
    /// Name in it.
    pub name: String,
    /// Number of the file.
    pub ino: u64,
}

impl Tree {
    /// Builds the tree of these nodes (attributes included) and of their second names. Numbers of `before` are kept for everything that
    /// stands for the same thing; new ones are taken from `next_ino`.
    pub fn build(
        nodes: Vec<Arc<Node>>,
        aliases: &[Alias],
        owner: Owner,
        before: Option<&Self>,
        next_ino: &mut u64,
    ) -> Self {
        let mut builder = Builder {
            entries: HashMap::new(),
            before,
            next_ino,
            leased: nodes
                .iter()
                .filter(|node| node.description.rest.is_some())
                .map(|node| node.driving.lease.path().to_owned())
                .collect(),
        };
        let root = Entry {
            parent: ROOT,
            name: String::new(),
            kind: Kind::Directory,
            children: BTreeMap::new(),
        };
        builder.entries.insert(ROOT, root);
        for (name, kind) in [
            ("config", Kind::Config),
            ("status", Kind::Status),
            ("log", Kind::Log),
            ("stop", Kind::Stop),
        ] {
            builder.add(ROOT, name, kind);
        }
        for node in &nodes {
            builder.add_node(node.path(), node);
        }
        for Alias { path, node: target } in aliases {
            for node in &nodes {
                match node.path().strip_prefix(target.as_str()) {
                    Some(rest) if rest.is_empty() || node.is_attribute && rest.starts_with('/') => {
                        builder.add_node(&format!("{path}{rest}"), node);
                    }
                    _ => {}
                }
            }
        }
        Self {
            entries: builder.entries,
            nodes,
            owner,
            made: SystemTime::now(),
        }
    }

    /// All nodes, attributes included.
    pub fn nodes(&self) -> &[Arc<Node>] {
        &self.nodes
    }

    /// Number of files and directories.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Never true: there is a root.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// What a number stands for; ESTALE if it did in an earlier configuration.
    pub fn entry(&self, ino: u64) -> Result<&Entry, Error> {
        self.entries.get(&ino).ok_or(Error::Stale)
    }

    /// The number of a name in a directory.
    pub fn lookup(&self, parent: u64, name: &[u8]) -> Result<u64, Error> {
        let entry = self.entry(parent)?;
        if !matches!(entry.kind, Kind::Directory) {
            return Err(Error::NotADirectory);
        }
        let name = std::str::from_utf8(name).map_err(|_| Error::NotFound)?;
        entry.children.get(name).copied().ok_or(Error::NotFound)
    }

    /// Lists a directory; position 0 is the beginning.
    pub fn list(
        &self,
        ino: u64,
        from: u64,
        add: &mut dyn FnMut(DirEntry<'_>) -> bool,
    ) -> Result<(), Error> {
        let entry = self.entry(ino)?;
        if !matches!(entry.kind, Kind::Directory) {
            return Err(Error::NotADirectory);
        }
        let dots = [(".", ino), ("..", entry.parent)];
        let children = entry
            .children
            .iter()
            .map(|(name, &ino)| (name.as_str(), ino));
        let from = usize::try_from(from).unwrap_or(usize::MAX);
        for (index, (name, ino)) in dots.into_iter().chain(children).enumerate().skip(from) {
            let is_directory = self
                .entries
                .get(&ino)
                .is_some_and(|entry| matches!(entry.kind, Kind::Directory));
            let kind = if is_directory {
                FileKind::Directory
            } else {
                FileKind::File
            };
            if !add(DirEntry {
                ino,
                kind,
                name,
                next: index as u64 + 1,
            }) {
                break;
            }
        }
        Ok(())
    }

    /// Attributes. `sizes`: bytes of `config` and of `log` now.
    pub fn attr(&self, ino: u64, sizes: (u64, u64)) -> Result<Attr, Error> {
        let entry = self.entry(ino)?;
        let Owner {
            uid,
            gid,
            config_group,
            group,
        } = self.owner;
        let mut attr = Attr {
            ino,
            kind: FileKind::File,
            size: TEXT_SIZE,
            mode: 0o444,
            uid,
            gid,
            modified: self.made,
            attr_ttl: KEPT_LONG,
            entry_ttl: KEPT_LONG,
        };
        match &entry.kind {
            Kind::Directory => {
                attr.kind = FileKind::Directory;
                attr.size = 0;
                attr.mode = 0o555;
            }
            Kind::Config => {
                attr.size = sizes.0;
                attr.mode = if config_group.is_some() { 0o664 } else { 0o644 };
                attr.gid = config_group.unwrap_or(gid);
                attr.attr_ttl = Duration::ZERO;
            }
            Kind::Log => {
                attr.size = sizes.1;
                attr.modified = SystemTime::now();
                attr.attr_ttl = Duration::ZERO;
            }
            Kind::Status | Kind::Units(_) | Kind::Format(_) | Kind::Fault(_) | Kind::Stats(_) => {}
            Kind::Stop => {
                attr.mode = 0o222;
                attr.size = 0;
            }
            Kind::Period(node) => {
                attr.mode = if matches!(node.description.pace, Pace::Every { .. }) {
                    0o644
                } else {
                    0o444
                }
            }
            Kind::Owner(node) => attr.mode = 0o444 | node.driving.lease.write_mode(),
            Kind::Param(..) => attr.mode = 0o644,
            Kind::Stages(node) => attr.mode = node.description.mode & 0o444,
            Kind::Device(node) => {
                attr.mode = node.description.mode;
                attr.size = node.description.output_tuple_size as u64;
            }
            Kind::Value(node, view) => self.value_attr(node, *view, &mut attr),
        }
        if let Some(node) = entry.kind.node() {
            attr.uid = node.description.owner.unwrap_or(attr.uid);
            attr.gid = node.description.group.or(group).unwrap_or(attr.gid);
            if group.is_some() && node.description.group.is_none() {
                attr.mode |= group_rights(attr.mode);
            }
        }
        Ok(attr)
    }

    fn value_attr(&self, node: &Node, view: View, attr: &mut Attr) {
        let stamp = node.sampling.newest.stamp();
        attr.mode = node.description.mode;
        attr.modified = stamp.map_or(self.made, Stamp::system_time);
        attr.attr_ttl = KEPT_SHORT;
        if view == View::Bytes {
            attr.size = node.description.output_tuple_size as u64;
            // A read beyond the size of a cached file asks for attributes that are not kept.
            if node.description.pace != Pace::OnRead {
                attr.attr_ttl = KEPT_LONG;
            }
        }
    }

    /// The names of `before` that no longer exist or stand for something else.
    pub fn gone_since(&self, before: &Self) -> Vec<Gone> {
        let gone = before
            .entries
            .iter()
            .filter(|(ino, _)| !self.entries.contains_key(ino));
        gone.map(|(&ino, entry)| Gone {
            parent: entry.parent,
            name: entry.name.clone(),
            ino,
        })
        .collect()
    }
}

/// What the group of the mount gets of a mode: to write what its owner writes, unless it may not even read.
fn group_rights(mode: u16) -> u16 {
    match mode & 0o040 {
        0 => 0,
        _ => (mode & 0o200) >> 3,
    }
}

impl Kind {
    /// Its node.
    pub fn node(&self) -> Option<&Arc<Node>> {
        match self {
            Self::Directory | Self::Config | Self::Status | Self::Log | Self::Stop => None,
            Self::Device(node)
            | Self::Value(node, _)
            | Self::Units(node)
            | Self::Format(node)
            | Self::Period(node)
            | Self::Param(node, _)
            | Self::Fault(node)
            | Self::Stats(node)
            | Self::Stages(node)
            | Self::Owner(node) => Some(node),
        }
    }

    /// Stands for the same thing in two configurations.
    fn is_same(&self, other: &Self) -> bool {
        let same_node = match (self.node(), other.node()) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        // What a variant has beside its node is compared here: one that is new has to say so.
        let same_view = match self {
            Self::Value(_, view) => matches!(other, Self::Value(_, of_other) if view == of_other),
            Self::Param(_, name) => matches!(other, Self::Param(_, of_other) if name == of_other),
            Self::Directory
            | Self::Config
            | Self::Status
            | Self::Log
            | Self::Stop
            | Self::Device(_)
            | Self::Units(_)
            | Self::Format(_)
            | Self::Period(_)
            | Self::Fault(_)
            | Self::Stats(_)
            | Self::Stages(_)
            | Self::Owner(_) => std::mem::discriminant(self) == std::mem::discriminant(other),
        };
        same_node && same_view
    }
}

struct Builder<'a> {
    entries: HashMap<u64, Entry>,
    before: Option<&'a Tree>,
    next_ino: &'a mut u64,
    /// Names of the leases at whose end something comes to rest.
    leased: HashSet<String>,
}

impl Builder<'_> {
    fn add(&mut self, parent: u64, name: &str, kind: Kind) -> u64 {
        let kept = self.before.and_then(|before| {
            let ino = before.lookup(parent, name.as_bytes()).ok()?;
            before
                .entries
                .get(&ino)
                .filter(|entry| entry.kind.is_same(&kind))
                .map(|_| ino)
        });
        let ino = kept.unwrap_or_else(|| {
            *self.next_ino += 1;
            *self.next_ino
        });
        let entry = Entry {
            parent,
            name: name.to_owned(),
            kind,
            children: BTreeMap::new(),
        };
        self.entries.insert(ino, entry);
        if let Some(directory) = self.entries.get_mut(&parent) {
            directory.children.insert(name.to_owned(), ino);
        }
        ino
    }

    fn directory(&mut self, parent: u64, name: &str) -> u64 {
        let existing = self
            .entries
            .get(&parent)
            .and_then(|entry| entry.children.get(name).copied());
        existing.unwrap_or_else(|| self.add(parent, name, Kind::Directory))
    }

    /// A node's directory with its files at a path, or an attribute's file.
    fn add_node(&mut self, path: &str, node: &Arc<Node>) {
        let mut at = ROOT;
        let mut parts = path.split('/').peekable();
        while let Some(part) = parts.next() {
            if parts.peek().is_none() && node.is_attribute {
                self.add(at, part, Kind::Value(node.clone(), View::Text));
                self.add_params(at, &format!("{part}."), node);
            } else {
                at = self.directory(at, part);
            }
        }
        if !node.is_attribute {
            self.add_node_files(at, node);
        }
    }

    /// Whether a node's directory shows a lease: there is something to rest, and a link can be written.
    fn has_owner(&self, node: &Node) -> bool {
        let is_link = node.driving.lease.path() != node.directory();
        let is_written = node.description.mode & 0o222 != 0;
        self.leased.contains(node.driving.lease.path()) && (is_written || !is_link)
    }

    fn add_node_files(&mut self, at: u64, node: &Arc<Node>) {
        self.add(at, "device", Kind::Device(node.clone()));
        self.add(at, "bin_data", Kind::Value(node.clone(), View::Bytes));
        self.add(at, "value", Kind::Value(node.clone(), View::Text));
        if let Some(format) = &node.description.format {
            for index in 0..format.len() {
                self.add(
                    at,
                    &format!("value{index}"),
                    Kind::Value(node.clone(), View::Field(index)),
                );
            }
        }
        self.add(at, "units", Kind::Units(node.clone()));
        self.add(at, "format", Kind::Format(node.clone()));
        self.add(at, "poll_ms", Kind::Period(node.clone()));
        self.add(at, "fault", Kind::Fault(node.clone()));
        self.add(at, "stats", Kind::Stats(node.clone()));
        if !node.description.converter.is_empty() {
            self.add(at, "stages", Kind::Stages(node.clone()));
        }
        if self.has_owner(node) {
            self.add(at, "owner", Kind::Owner(node.clone()));
        }
        self.add_params(at, "", node);
    }

    /// The params of a node, or of one of its attributes, whose name and a dot then stand before theirs.
    fn add_params(&mut self, at: u64, before: &str, node: &Arc<Node>) {
        if node.description.params.is_empty() {
            return;
        }
        let directory = self.directory(at, "params");
        for name in node.description.params.keys() {
            let kind = Kind::Param(node.clone(), name.as_str().into());
            self.add(directory, &format!("{before}{name}"), kind);
        }
    }
}
