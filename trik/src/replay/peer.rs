//! A program that is connected to a player, and what it wants.
//!
//! Owns the first message. What is sent to it is known to the player.

use super::recording::Recording;
use crate::limits;
use std::os::fd::OwnedFd;
use std::time::{Duration, Instant};

/// What somebody who is connected wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wish {
    /// It has not said anything yet.
    Unknown,
    /// Reads this channel.
    Read(usize),
    /// Writes it.
    Write(usize),
    /// It has left, or said something else.
    Gone,
}

pub(super) struct Peer {
    pub(super) socket: OwnedFd,
    pub(super) wish: Wish,
    /// Until when nothing is given without it, as it may want that.
    shy_until: Instant,
}

impl Peer {
    /// One that has just come.
    pub(super) fn new(socket: OwnedFd, now: Instant) -> Self {
        Self {
            socket,
            wish: Wish::Unknown,
            shy_until: now + Duration::from_millis(limits::REPLAY_HELLO_MS),
        }
    }

    /// Until when it is waited for, if it has not said yet what it wants.
    pub(super) fn shy_until(&self, now: Instant) -> Option<Instant> {
        (self.wish == Wish::Unknown && self.shy_until > now).then_some(self.shy_until)
    }
}

/// What a first message asks for.
pub(super) fn wish(recording: &dyn Recording, said: &[u8]) -> Wish {
    let said = std::str::from_utf8(said).ok();
    let Some((direction, name)) = said.and_then(|said| said.split_once(' ')) else {
        return Wish::Gone;
    };
    let mut channels = recording.channels().iter();
    let found = channels.position(|channel| channel.path == name);
    match (direction, found) {
        ("read", Some(channel)) => Wish::Read(channel),
        ("write", Some(channel)) => Wish::Write(channel),
        _ => Wish::Gone,
    }
}
