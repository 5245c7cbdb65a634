//! Tests of the desk over a tree of plain files with rings of their own: it may go and come back as another one.

use super::*;
use crate::entry::Known;
use journal::node::Node;
use sample_bus::place::{self, Directory};
use sample_bus::{Rights, Writer};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::sync::mpsc::{Sender, channel};
use tempfile::{TempDir, tempdir};

/// Files and rings of a tree. Dropping it takes both away.
struct Tree {
    root: TempDir,
    rings: PathBuf,
    /// As a publisher has it: without the lock any mount of this machine takes the rings for those of a killed one.
    _directory: Directory,
    writers: Vec<Writer>,
}

impl Tree {
    fn new() -> Self {
        let root = tempdir().unwrap();
        let rings = place::directory(Path::new(place::SHARED_MEMORY), root.path()).unwrap();
        let directory = Directory::take(&rings, 0o700).unwrap();
        Self {
            root,
            rings,
            _directory: directory,
            writers: Vec::new(),
        }
    }

    fn file(&self, name: &str, text: &str) {
        let path = self.root.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    }

    /// One node of one byte, and the files by which a tree is known.
    fn mount(&mut self, node: &str) {
        for (file, text) in [
            ("format", "u8 x"),
            ("bin_data", ""),
            ("value", ""),
            ("poll_ms", "10\n"),
        ] {
            self.file(&format!("{node}/{file}"), text);
        }
        let ring = self.rings.join(place::file_name(node).unwrap());
        let rights = Rights {
            mode: 0o600,
            group: None,
        };
        self.writers.push(Writer::create(&ring, 1, rights).unwrap());
        self.file("config", node);
        self.file("status", "");
    }

    fn unmount(&mut self) {
        self.writers.clear();
        for entry in fs::read_dir(self.root.path()).unwrap().flatten() {
            let path = entry.path();
            let removed = match path.is_dir() {
                true => fs::remove_dir_all(path),
                false => fs::remove_file(path),
            };
            removed.unwrap();
        }
    }

    fn publish(&mut self, value: u8) {
        // Later than anything that looks has begun.
        self.publish_at(u64::MAX / 4, value);
    }

    fn publish_at(&mut self, time_ns: u64, value: u8) {
        self.writers[0].publish(time_ns, &[value]);
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.rings);
    }
}

struct Ear(Sender<Entry>);

impl Listener for Ear {
    fn wants(&self) -> Wants {
        Box::new(|_| Some(Wish::ByTheClock))
    }

    fn put(&mut self, entries: &[Entry], _now_ns: u64) -> bool {
        (entries.iter()).all(|entry| self.0.send(entry.clone()).is_ok())
    }
}

/// The next sample, whatever else comes.
fn sample(heard: &Receiver<Entry>) -> (Arc<Known>, u8) {
    loop {
        let entry = heard.recv_timeout(Duration::from_secs(60)).unwrap();
        if let Entry::Sample(known, _, tuple) = entry {
            return (known, tuple[0]);
        }
    }
}

fn desk(tree: &Tree) -> Desk {
    let settings = Settings {
        root: tree.root.path().to_owned(),
        library: "test".to_owned(),
        kept: None,
        world: None,
    };
    Desk::start(settings, |told| panic!("nothing is kept, but {told:?}")).unwrap()
}

#[test]
fn a_tree_that_comes_back_has_nodes_with_other_numbers() {
    let mut tree = Tree::new();
    tree.mount("a");
    let desk = desk(&tree);
    assert!(!desk.is_heard() && !desk.keeps());
    let (tell, heard) = channel();
    desk.listen(Box::new(Ear(tell)));
    tree.publish(5);
    let (first, value) = sample(&heard);
    assert_eq!((first.node.path.as_str(), value), ("a", 5));
    assert!(desk.is_heard());
    tree.unmount();
    tree.mount("b");
    tree.publish(7);
    let (second, value) = sample(&heard);
    assert_eq!((second.node.path.as_str(), value), ("b", 7));
    assert_ne!(first.number, second.number, "a file would take it for a");
}

/// One who needs all samples, and starts what gives them.
struct Needy(Sender<Entry>);

impl Listener for Needy {
    fn wants(&self) -> Wants {
        Box::new(|_| Some(Wish::Samples))
    }

    fn put(&mut self, entries: &[Entry], _now_ns: u64) -> bool {
        (entries.iter()).all(|entry| self.0.send(entry.clone()).is_ok())
    }
}

#[test]
fn one_who_needs_more_brings_nobody_a_sample_twice() {
    let mut tree = Tree::new();
    tree.mount("a");
    let desk = desk(&tree);
    let (tell, heard) = channel();
    desk.listen(Box::new(Ear(tell)));
    for value in 1..4 {
        tree.publish_at(u64::MAX / 4 + u64::from(value), value);
        assert_eq!(sample(&heard).1, value);
    }
    let (tell, late) = channel();
    desk.listen(Box::new(Needy(tell)));
    // What the node had then comes to one who is new.
    assert_eq!(sample(&late).1, 3);
    tree.publish_at(u64::MAX / 4 + 4, 4);
    assert_eq!(sample(&heard).1, 4);
    assert_eq!(sample(&late).1, 4);
}

#[test]
fn bytes_of_devices_come_to_those_who_ask() {
    let mut tree = Tree::new();
    tree.mount("a");
    let raw = tree.rings.join(place::raw_file_name("a").unwrap());
    let rights = Rights {
        mode: 0o600,
        group: None,
    };
    let mut raw = Writer::create(&raw, 2, rights).unwrap();
    let desk = desk(&tree);
    let (tell, plain) = channel();
    desk.listen(Box::new(Ear(tell)));
    let (tell, all) = channel();
    desk.listen(Box::new(Asking(tell)));
    // Both are there once they have a sample.
    tree.publish_at(u64::MAX / 4, 1);
    assert_eq!((sample(&plain).1, sample(&all).1), (1, 1));
    raw.publish(u64::MAX / 4 + 1, &[7, 7]);
    let (known, value) = sample(&all);
    assert_eq!((known.node.is_raw, value), (true, 7));
    tree.publish_at(u64::MAX / 4 + 2, 2);
    let (known, value) = sample(&plain);
    assert_eq!((known.node.is_raw, value), (false, 2));
}

/// One who asks for bytes of devices.
struct Asking(Sender<Entry>);

impl Listener for Asking {
    fn wants(&self) -> Wants {
        Box::new(|_| Some(Wish::ByTheClock))
    }

    fn wants_raw(&self) -> bool {
        true
    }

    fn put(&mut self, entries: &[Entry], _now_ns: u64) -> bool {
        (entries.iter()).all(|entry| self.0.send(entry.clone()).is_ok())
    }
}

/// Waits until something holds.
fn eventually(what: &str, holds: impl Fn() -> bool) {
    let end = Instant::now() + Duration::from_secs(60);
    while !holds() {
        assert!(Instant::now() < end, "{what}");
        std::thread::yield_now();
    }
}

#[test]
fn nothing_stays_open_when_the_last_listener_has_gone() {
    let mut tree = Tree::new();
    tree.mount("a");
    tree.file("log", "");
    let desk = desk(&tree);
    let open = || {
        let all = fs::read_dir("/proc/self/fd").unwrap().flatten();
        let names = all.filter_map(|one| fs::read_link(one.path()).ok());
        names
            .filter(|name| name.starts_with(tree.root.path()))
            .count()
    };
    let (tell, heard) = channel();
    desk.listen(Box::new(Ear(tell)));
    eventually("it looks", || open() > 0);
    drop(heard);
    desk.line(Story::Output, "a.js", Level::Info, "it hears nothing more");
    eventually("nobody listens", || !desk.is_heard());
    eventually("all is closed", || open() == 0);
}

/// One that fails.
struct Broken;

impl Listener for Broken {
    fn wants(&self) -> Wants {
        Box::new(|_| Some(Wish::ByTheClock))
    }

    fn put(&mut self, _: &[Entry], _now_ns: u64) -> bool {
        panic!("a test wants that")
    }
}

#[test]
fn a_listener_that_fails_does_not_keep_the_next_one_from_hearing() {
    let mut tree = Tree::new();
    tree.mount("a");
    let desk = desk(&tree);
    desk.listen(Box::new(Broken));
    let (tell, heard) = channel();
    desk.listen(Box::new(Ear(tell)));
    tree.publish(5);
    assert_eq!(sample(&heard).1, 5);
}

#[test]
fn lines_reach_who_listens_and_nobody_is_waited_for_at_the_end() {
    let tree = Tree::new();
    let desk = desk(&tree);
    let (tell, heard) = channel();
    desk.listen(Box::new(Ear(tell)));
    desk.line(Story::Output, "a.js", Level::Info, "print: x");
    let Entry::Line(Story::Output, _, line) = heard.recv().unwrap() else {
        panic!("another entry");
    };
    assert_eq!(
        (line.name.as_str(), line.text.as_str()),
        ("a.js", "print: x")
    );
    let (answer, answered) = channel();
    desk.save(
        SaveReason::Asked,
        Box::new(move |saved| answer.send(saved).unwrap()),
    );
    let why = answered.recv().unwrap().unwrap_err().to_string();
    assert!(why.contains("--box-minutes"), "{why}");
    drop(desk);
    assert!(heard.recv().is_err(), "its thread is over");
}

#[test]
fn only_a_node_that_had_a_value_can_lose_it() {
    let node = Node::sensor("a", "u8 x");
    let known = Arc::new(Known { number: 1, node });
    let fault = || Entry::Fault(known.clone(), 1, 5, "".into());
    let sample = || Entry::Sample(known.clone(), 1, Arc::new([1]));
    let mut values = Values::default();
    assert!(!values.have_gone(&[fault(), fault()]));
    assert!(!values.have_gone(&[sample()]));
    assert!(values.have_gone(&[fault()]));
    assert!(!values.have_gone(&[fault()]), "it has gone already");
    assert!(values.have_gone(&[sample(), fault()]));
}
