//! All names of the view: classes, devices, attributes, each with an inode number.
//!
//! Names are only added. A device that the tree does not have any more keeps its numbers and is not shown; one that comes
//! back as it was is the same device with the same name.

use crate::device::{Attribute, Device};
use crate::limits::DEVICES_MAX;
use crate::scan::{CLASSES, Found, Name};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The inode number of the top.
pub const ROOT: u64 = 1;

/// What an inode is.
#[derive(Clone)]
pub enum Node {
    /// The top or a class.
    Directory,
    /// The directory of a device, or one below it.
    Device(Arc<dyn Device>),
    /// A file.
    Attribute(Arc<dyn Device>, Attribute),
}

struct Entry {
    parent: u64,
    name: String,
    node: Node,
    /// Which device it belongs to.
    device: Option<usize>,
}

struct Known {
    found: Found,
    is_present: bool,
}

/// See the module's description.
pub struct Table {
    /// Inode number minus one.
    entries: Vec<Entry>,
    names: BTreeMap<(u64, String), u64>,
    known: Vec<Known>,
    /// The number for the next device of a class.
    next: BTreeMap<&'static str, usize>,
}

impl Default for Table {
    fn default() -> Self {
        let mut table = Self {
            entries: Vec::new(),
            names: BTreeMap::new(),
            known: Vec::new(),
            next: BTreeMap::new(),
        };
        table.add(ROOT, String::new(), Node::Directory, None);
        for class in CLASSES {
            table.add(ROOT, class.to_owned(), Node::Directory, None);
        }
        table
    }
}

impl Table {
    /// Takes what the tree has now; `make` makes a device that is new. The kernel forgets old names by itself.
    pub fn update(&mut self, found: &[Found], mut make: impl FnMut(&Found) -> Arc<dyn Device>) {
        for known in &mut self.known {
            known.is_present = found.contains(&known.found);
        }
        for one in found {
            let is_new = !self.known.iter().any(|known| known.found == *one);
            if is_new && self.known.len() < DEVICES_MAX {
                self.add_device(one, make(one));
            }
        }
    }

    /// How many devices there are.
    pub fn count(&self) -> usize {
        self.known.iter().filter(|known| known.is_present).count()
    }

    /// All devices, also those that are gone.
    pub fn devices(&self) -> Vec<Arc<dyn Device>> {
        let nodes = self.entries.iter().map(|entry| &entry.node);
        let devices = nodes.filter_map(|node| match node {
            Node::Device(device) => Some(Arc::clone(device)),
            Node::Directory | Node::Attribute(..) => None,
        });
        devices.collect()
    }

    /// How many names there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Never: there is always the top.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// What stands at this number; nothing if there never was anything or the device is gone.
    pub fn node(&self, inode: u64) -> Option<&Node> {
        let entry = self.entries.get(index(inode))?;
        self.is_present(entry).then_some(&entry.node)
    }

    /// The number of a name in a directory.
    pub fn find(&self, parent: u64, name: &str) -> Option<u64> {
        let inode = *self.names.get(&(parent, name.to_owned()))?;
        self.node(inode).map(|_| inode)
    }

    /// The directory above.
    pub fn parent(&self, inode: u64) -> u64 {
        self.entries
            .get(index(inode))
            .map_or(ROOT, |entry| entry.parent)
    }

    /// Names in a directory with their numbers, in the order in which they came.
    pub fn list(&self, parent: u64) -> impl Iterator<Item = (u64, &str, &Node)> {
        (ROOT..)
            .zip(&self.entries)
            .filter_map(move |(inode, entry)| {
                let is_in = entry.parent == parent && inode != ROOT;
                (is_in && self.is_present(entry)).then_some((
                    inode,
                    entry.name.as_str(),
                    &entry.node,
                ))
            })
    }

    fn is_present(&self, entry: &Entry) -> bool {
        entry
            .device
            .is_none_or(|number| self.known[number].is_present)
    }

    fn add(&mut self, parent: u64, name: String, node: Node, device: Option<usize>) -> u64 {
        self.entries.push(Entry {
            parent,
            name: name.clone(),
            node,
            device,
        });
        let inode = self.entries.len() as u64;
        // The top is in no directory.
        if !name.is_empty() {
            self.names.insert((parent, name), inode);
        }
        inode
    }

    fn add_device(&mut self, found: &Found, device: Arc<dyn Device>) {
        let Some(class) = self.find(ROOT, found.class) else {
            return;
        };
        let name = match found.name {
            Name::Exact(name) => name.to_owned(),
            Name::Numbered(prefix) => {
                let next = self.next.entry(found.class).or_default();
                *next += 1;
                format!("{prefix}{}", *next - 1)
            }
        };
        let number = self.known.len();
        let inode = self.add(class, name, Node::Device(Arc::clone(&device)), Some(number));
        self.known.push(Known {
            found: found.clone(),
            is_present: true,
        });
        for attribute in device.attributes() {
            let (folder, name) = match attribute.name.split_once('/') {
                Some((folder, name)) => {
                    let there = self.find(inode, folder);
                    let folder = there.unwrap_or_else(|| {
                        let node = Node::Device(Arc::clone(&device));
                        self.add(inode, folder.to_owned(), node, Some(number))
                    });
                    (folder, name)
                }
                None => (inode, attribute.name),
            };
            let node = Node::Attribute(Arc::clone(&device), *attribute);
            self.add(folder, name.to_owned(), node, Some(number));
        }
    }
}

fn index(inode: u64) -> usize {
    usize::try_from(inode.wrapping_sub(1)).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Shown, line, read, read_write};
    use crate::scan::{Options, scan};
    use crate::tree::Tree;
    use trikfs::errno::Error;

    struct Dummy;

    impl Device for Dummy {
        fn attributes(&self) -> &'static [Attribute] {
            const ALL: [Attribute; 3] = [read("address"), read_write("a/x"), read_write("a/y")];
            &ALL
        }

        fn show(&self, attribute: &str) -> Result<Shown, Error> {
            line(attribute)
        }

        fn store(&self, _attribute: &str, _text: &str) -> Result<(), Error> {
            Ok(())
        }
    }

    /// What a folder with these nodes gives.
    fn found(nodes: &[&str]) -> Vec<Found> {
        let folder = tempfile::tempdir().unwrap();
        for node in nodes {
            std::fs::create_dir_all(folder.path().join(node)).unwrap();
        }
        std::fs::write(folder.path().join("status"), "").unwrap();
        let options = Options {
            max_speed: 1000,
            encoders: BTreeMap::new(),
        };
        scan(&Tree::new(folder.path().to_owned()), &options).unwrap()
    }

    fn names(table: &Table, parent: u64) -> Vec<&str> {
        table.list(parent).map(|(_, name, _)| name).collect()
    }

    #[test]
    fn devices_keep_their_numbers_when_they_go_and_come_back() {
        let mut table = Table::default();
        let make = |_: &Found| Arc::new(Dummy) as Arc<dyn Device>;
        let two = found(&["sensors/A1", "sensors/A2"]);
        let one = found(&["sensors/A2"]);
        table.update(&two, make);
        let class = table.find(ROOT, "lego-sensor").unwrap();
        assert_eq!(names(&table, class), ["sensor0", "sensor1"]);
        let second = table.find(class, "sensor1").unwrap();
        let first = table.find(class, "sensor0").unwrap();
        assert_eq!(names(&table, first), ["address", "a"]);
        let folder = table.find(first, "a").unwrap();
        assert_eq!(names(&table, folder), ["x", "y"]);
        let x = table.find(folder, "x").unwrap();
        table.update(&one, make);
        assert_eq!(names(&table, class), ["sensor1"]);
        assert_eq!(table.find(class, "sensor1"), Some(second));
        assert!(table.node(x).is_none() && table.find(class, "sensor0").is_none());
        let lengths = table.len();
        table.update(&two, make);
        assert_eq!(table.find(class, "sensor0"), Some(first));
        assert_eq!(table.len(), lengths);
        assert_eq!(table.count(), 3);
    }

    #[test]
    fn numbers_that_nobody_gave_out_are_nothing() {
        let table = Table::default();
        for inode in [0, 9, u64::MAX] {
            assert!(table.node(inode).is_none());
        }
        assert!(table.find(ROOT, "tacho-motor").is_some() && table.find(ROOT, "").is_none());
    }
}
