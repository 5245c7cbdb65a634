//! What all viewers of a class share.
//!
//! Owns nothing that happens.

use super::board::Board;
use crate::admission::Admission;
use crate::guests::Guests;
use std::sync::Arc;
use tokio::sync::Semaphore;

/// A class that is served.
pub struct Class {
    pub name: String,
    /// The page shows marks too, which have a socket of their own.
    pub has_marks: bool,
    pub board: Arc<Board>,
    pub guests: Arc<dyn Guests>,
    pub admission: Admission,
    /// Bytes of files that are on their way.
    pub uploads: Arc<Semaphore>,
}
