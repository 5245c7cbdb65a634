//! A fresh directory for one test, removed with it.

use crate::convert::shared::Cache;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The directory; everything in it goes when this is dropped.
pub(crate) struct Scratch(TempDir);

impl Scratch {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a fresh directory"))
    }

    pub(crate) fn dir(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn cache(&self) -> Cache {
        Cache::open(Some(&self.path("cache"))).expect("a private cache")
    }
}
