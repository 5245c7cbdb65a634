//! A path of the system: `src = '/dev/ttyS1'`.
//!
//! What it is (regular file, character device, FIFO, terminal) is found out when it is opened, not here.

use super::kind::{Constructor, Delivery, Kind};
use super::rest::{Form, Rest, put_path};
use std::path::{Path, PathBuf};

/// `src = '/dev/ttyS1'`
#[derive(Clone, Debug, PartialEq)]
pub struct PathDescription {
    /// The path.
    pub path: PathBuf,
}

impl<T: AsRef<Path> + ?Sized> From<&T> for PathDescription {
    fn from(path: &T) -> Self {
        let path = path.as_ref().to_owned();
        Self { path }
    }
}

impl Kind for PathDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 1,
        put: |source, out| put_path(&source.path, out),
        take: |bytes| bytes.path().map(|path| Self { path }),
    });

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.path);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.path]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Unknown
    }

    fn keeps_what_is_written(&self) -> bool {
        true
    }
}
