//! `absent{ reason }`: something that this board does not have.
//!
//! A port that is absent is described like one that is there, so it takes writes; opening it tells why it is not.

use super::kind::{Constructor, Delivery, Kind};
use super::rest::Rest;
use crate::limits::ABSENT_REASON_BYTES_MAX;
use std::path::{Path, PathBuf};

/// `absent{ reason = 'no such port on this board' }`
#[derive(Clone, Debug, PartialEq)]
pub struct AbsentDescription {
    /// Why it is not there.
    pub reason: String,
}

impl Kind for AbsentDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "absent",
        keys: &["reason"],
        read: |fields, _| {
            let reason = fields.text("reason", ABSENT_REASON_BYTES_MAX)?;
            let reason = reason.unwrap_or_default().to_owned();
            if reason.trim().is_empty() {
                return Err(fields.problem("src", "absent: reason is missing: say why"));
            }
            Ok(Self { reason })
        },
    }];
    const REST: Rest<Self> = Rest::Absent;

    fn each_path(&mut self, _take: &mut dyn FnMut(&mut PathBuf)) {}

    fn needed_paths(&self) -> Vec<&Path> {
        Vec::new()
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Unknown
    }
}
