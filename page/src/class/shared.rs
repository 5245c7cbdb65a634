//! What all viewers of a class share.
//!
//! Owns nothing that happens.

use super::board::Board;
use crate::guests::Guests;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use tokio::sync::Semaphore;

/// A class that is served.
pub struct Class {
    pub name: String,
    pub board: Arc<Board>,
    pub guests: Arc<dyn Guests>,
    /// Places of browsers that only look.
    pub viewers: Arc<Semaphore>,
    /// Places of those that may command.
    pub commanders: Arc<Semaphore>,
    /// Bytes of files that are on their way.
    pub uploads: Arc<Semaphore>,
    pub number: AtomicUsize,
}
