//! An open `owner`: a claim on the lease of a directory.
//!
//! Owns the claim and its end: the last close, or the end of the process that opened the file, whichever is first.
//! What a claim means is the lease's business.

use super::{OpenFile, READY};
use crate::bytes::copy_at;
use crate::errno::Error;
use crate::events::{Ready, lock};
use crate::lease::{Lease, Wish};
use crate::node::Node;
use crate::process::{is_ending, process_of};
use crate::transport::{Caller, Outcome, PollHandle, RequestId, Transfer};
use std::sync::{Arc, Mutex, OnceLock};

/// One `owner` that is open for writing.
pub struct OwnerFile {
    node: Arc<Node>,
    lease: Arc<Lease>,
    claim: OnceLock<u32>,
    reads: bool,
    shown: Mutex<String>,
    poll: OnceLock<PollHandle>,
}

impl OwnerFile {
    /// Claims the lease of the node's directory. A program that opens for reading as well may wait and ask with a priority.
    pub fn open(node: &Arc<Node>, reads: bool, caller: Caller) -> Result<Arc<Self>, Error> {
        if node.is_retired() {
            return Err(Error::Stale);
        }
        let file = Arc::new(Self {
            node: node.clone(),
            lease: node.driving.lease.clone(),
            claim: OnceLock::new(),
            reads,
            shown: Mutex::default(),
            poll: OnceLock::new(),
        });
        let me: Arc<dyn Ready> = file.clone();
        let process = process_of(caller.pid);
        let claim = file.lease.claim(process, reads, Arc::downgrade(&me));
        let claim = claim.inspect_err(|error| node.report(error))?;
        let _ = file.claim.set(claim);
        Ok(file)
    }

    fn claim(&self) -> Result<u32, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let claim = self.claim.get().copied();
        claim.ok_or_else(|| Error::Internal("owner without a claim".to_owned()))
    }
}

impl OpenFile for OwnerFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        self.claim()?;
        if !self.reads {
            return Err(Error::AccessDenied);
        }
        let mut shown = lock(&self.shown);
        if request.offset == 0 {
            *shown = self.lease.line();
        }
        Ok(Outcome::Done(copy_at(
            shown.as_bytes(),
            request.offset,
            out,
        )))
    }

    fn write(&self, _request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        let text = std::str::from_utf8(data);
        let text = text.map_err(|_| Error::Invalid("not a text".to_owned()))?;
        let wish = Wish::parse(text)?;
        self.lease.ask(self.claim()?, wish)?;
        Ok(Outcome::Done(data.len()))
    }

    /// Without the lease there is an error, and nobody else is at the other end.
    fn poll(&self, handle: PollHandle, events: u32) -> Result<u32, Error> {
        let _ = self.poll.set(handle);
        let is_held = self.claim().is_ok_and(|claim| self.lease.is_held_by(claim));
        Ok(if is_held {
            events & READY
        } else {
            (events & READY) | (libc::POLLERR | libc::POLLHUP) as u32
        })
    }

    fn flush(&self, _id: RequestId, caller: Caller) -> Result<Outcome, Error> {
        if is_ending(caller.pid)
            && let Some(claim) = self.claim.get()
        {
            self.lease.end(*claim, process_of(caller.pid));
        }
        Ok(Outcome::Done(0))
    }

    fn release(&self) {
        if let Some(claim) = self.claim.get() {
            self.lease.leave(*claim);
        }
    }

    fn retire(&self) {
        if self.node.is_retired() {
            self.release();
            self.ready();
        }
    }
}

impl Ready for OwnerFile {
    fn ready(&self) {
        self.node.engine.notify(self.poll.get().copied());
    }
}
