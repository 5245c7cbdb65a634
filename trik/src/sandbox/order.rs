//! What the steps of the sandbox are told, as words of a command line.
//!
//! Owns the form of these words. They come from this program alone and hold no secrets.

use super::layer::{self, Layer};
use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::PathBuf;

/// What stands before the program.
const PROGRAM: &str = "--";

/// Which step it is.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(super) enum Step {
    /// Makes namespaces, and waits.
    #[default]
    Outer,
    /// The first process in them, which becomes the program.
    Inner,
}

/// What is to be done.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub(super) struct Order {
    pub step: Step,
    /// Process id of the one that has started the outer step.
    pub parent: i32,
    /// The folders of the program; of several programs, where it is only asked what is missing.
    pub folders: Vec<PathBuf>,
    /// The control group in which programs get one each.
    pub group: Option<PathBuf>,
    /// What Python reads.
    pub reads: Vec<PathBuf>,
    /// Layers that are left out.
    pub without: Vec<Layer>,
    /// Layers that the outer step could not have.
    pub missing: Vec<Layer>,
    /// Seconds of processor time.
    pub cpu_s: u64,
    /// Only if nothing is missing.
    pub is_required: bool,
    /// Only says what is missing.
    pub is_probe: bool,
    /// The inner step is root of the computer, and becomes the user that the program sees itself as.
    pub is_dropping: bool,
    /// The inner step is root of a namespace of users.
    pub is_mapped: bool,
    /// Which user and group the program sees itself as.
    pub uid: u32,
    /// See [`Self::uid`].
    pub gid: u32,
    /// Threads that the user has already, where the kernel counts them all.
    pub threads: u64,
    /// The kernel does not count processes of this user, so there is to be one.
    pub is_alone: bool,
    /// The interpreter and its arguments.
    pub program: Vec<OsString>,
}

impl Order {
    /// As words.
    pub fn write(&self) -> Vec<OsString> {
        let mut words = Vec::new();
        let mut put = |key: &str, value: &OsStr| {
            let mut word = OsString::from(format!("{key}="));
            word.push(value);
            words.push(word);
        };
        if self.step == Step::Inner {
            put("step", "inner".as_ref());
        }
        let paths = [("folder", &self.folders), ("read", &self.reads)];
        for (key, paths) in paths {
            paths.iter().for_each(|path| put(key, path.as_os_str()));
        }
        if let Some(group) = &self.group {
            put("group", group.as_os_str());
        }
        for (key, layers) in [("without", &self.without), ("missing", &self.missing)] {
            layers.iter().for_each(|one| put(key, one.name().as_ref()));
        }
        let numbers = [
            ("parent", i64::from(self.parent).to_string()),
            ("cpu", self.cpu_s.to_string()),
            ("uid", self.uid.to_string()),
            ("gid", self.gid.to_string()),
            ("threads", self.threads.to_string()),
        ];
        for (key, number) in &numbers {
            put(key, number.as_ref());
        }
        let flags = [
            ("required", self.is_required),
            ("probe", self.is_probe),
            ("dropping", self.is_dropping),
            ("mapped", self.is_mapped),
            ("alone", self.is_alone),
        ];
        for (key, _) in flags.iter().filter(|(_, is_set)| *is_set) {
            put(key, "1".as_ref());
        }
        words.push(PROGRAM.into());
        words.extend(self.program.iter().cloned());
        words
    }

    /// Back from words; none of this program has others.
    pub fn read(mut words: impl Iterator<Item = OsString>) -> Option<Self> {
        let mut order = Self::default();
        for word in words.by_ref() {
            if word == PROGRAM {
                order.program = words.collect();
                return (!order.program.is_empty()).then_some(order);
            }
            let word = word.into_vec();
            let at = word.iter().position(|byte| *byte == b'=')?;
            let (key, value) = (str::from_utf8(&word[..at]).ok()?, &word[at + 1..]);
            order.take(key, OsStr::from_bytes(value))?;
        }
        None
    }

    fn take(&mut self, key: &str, value: &OsStr) -> Option<()> {
        let text = value.to_str();
        match key {
            "step" => self.step = Step::Inner,
            "folder" => self.folders.push(value.into()),
            "group" => self.group = Some(value.into()),
            "read" => self.reads.push(value.into()),
            "without" => self.without.push(layer::find(text?)?),
            "missing" => self.missing.push(layer::find(text?)?),
            "parent" => self.parent = text?.parse().ok()?,
            "cpu" => self.cpu_s = text?.parse().ok()?,
            "uid" => self.uid = text?.parse().ok()?,
            "gid" => self.gid = text?.parse().ok()?,
            "threads" => self.threads = text?.parse().ok()?,
            "required" => self.is_required = true,
            "probe" => self.is_probe = true,
            "dropping" => self.is_dropping = true,
            "mapped" => self.is_mapped = true,
            "alone" => self.is_alone = true,
            _ => return None,
        }
        Some(())
    }

    /// Whether a layer is to be tried.
    pub fn wants(&self, layer: Layer) -> bool {
        !self.without.contains(&layer)
    }

    /// Whether a layer is there.
    pub fn has(&self, layer: Layer) -> bool {
        !self.missing.contains(&layer)
    }

    /// Keeps that a layer is missing.
    pub fn miss(&mut self, layer: Layer) {
        if self.has(layer) {
            self.missing.push(layer);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_is_the_same_after_its_way_through_a_command_line() {
        let order = Order {
            step: Step::Inner,
            parent: 17,
            folders: vec!["/a=b".into(), OsString::from_vec(vec![b'/', 0xff]).into()],
            group: Some("/sys/fs/cgroup/a b".into()),
            reads: vec!["/usr".into()],
            without: vec![Layer::Files],
            missing: Layer::ALL.to_vec(),
            cpu_s: 62,
            is_required: true,
            is_probe: true,
            is_dropping: true,
            is_mapped: true,
            uid: 65534,
            gid: 1000,
            threads: 3,
            is_alone: true,
            program: ["python3", "-c", "--", "x=1"].map(OsString::from).to_vec(),
        };
        assert_eq!(Order::read(order.write().into_iter()), Some(order));
        for wrong in [
            &["fly=1", "--", "x"][..],
            &["cpu=1"],
            &["cpu=x", "--", "x"],
            &["--"],
        ] {
            let words = wrong.iter().map(OsString::from);
            assert_eq!(Order::read(words), None, "{wrong:?}");
        }
    }
}
