//! `fifo{ path }`: a named pipe, opened once and fanned out.
//!
//! What stands there before a writer comes is found out when it is opened, not here.

use super::kind::{Constructor, Delivery, Kind};
use super::rest::{Form, Rest, put_path};
use std::path::{Path, PathBuf};

/// `fifo{ path }`
#[derive(Clone, Debug, PartialEq)]
pub struct FifoDescription {
    /// The file.
    pub path: PathBuf,
}

impl<T: AsRef<Path> + ?Sized> From<&T> for FifoDescription {
    fn from(path: &T) -> Self {
        let path = path.as_ref().to_owned();
        Self { path }
    }
}

impl Kind for FifoDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "fifo",
        keys: &["path"],
        read: |fields, _| fields.own_path("fifo").map(|path| Self { path }),
    }];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 3,
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
        Delivery::Stream
    }
}
