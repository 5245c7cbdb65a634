//! `attribute{ path }`: a file of sysfs or procfs, or one that is treated like these.
//!
//! State, read afresh from offset 0, whatever the file's type says.

use super::kind::{Constructor, Delivery, Kind};
use super::rest::{Form, Rest, put_path};
use std::path::{Path, PathBuf};

/// `attribute{ path }`
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeDescription {
    /// The file.
    pub path: PathBuf,
}

impl<T: AsRef<Path> + ?Sized> From<&T> for AttributeDescription {
    fn from(path: &T) -> Self {
        let path = path.as_ref().to_owned();
        Self { path }
    }
}

impl Kind for AttributeDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "attribute",
        keys: &["path"],
        read: |fields, _| fields.own_path("attribute").map(|path| Self { path }),
    }];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 2,
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
        Delivery::State
    }

    fn keeps_what_is_written(&self) -> bool {
        true
    }
}
