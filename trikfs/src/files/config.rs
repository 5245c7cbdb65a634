//! An open `config`: the configuration in force, and the transaction that replaces it.
//!
//! Owns the bytes that one open file collects and the rule for when they are complete: when the process that wrote
//! them closes the file or asks for fsync, and is not being killed. The kernel tells of every close of every
//! duplicate, also of those that a forked child or a dying process makes; those must not apply half a configuration.

use super::OpenFile;
use crate::bytes::copy_at;
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::lock;
use crate::process::{is_being_killed, process_of};
use crate::reload::Reloader;
use crate::transport::{Answer, Caller, Outcome, RequestId, Transfer};
use config::limits::CONFIG_BYTES_MAX;
use std::sync::{Arc, Mutex};

/// One open `config`.
pub struct ConfigFile {
    engine: Arc<Engine>,
    reloader: Arc<Reloader>,
    shown: Mutex<Vec<u8>>,
    draft: Mutex<Draft>,
}

struct Draft {
    bytes: Vec<u8>,
    /// The bytes in force are still to be copied here before the first change.
    continues: bool,
    has_news: bool,
    is_too_long: bool,
    writer: u32,
    writer_thread: u32,
}

impl ConfigFile {
    /// `truncated`: the file was opened with O_TRUNC, so a draft starts empty.
    pub fn open(engine: &Arc<Engine>, reloader: &Arc<Reloader>, truncated: bool) -> Self {
        let draft = Draft {
            bytes: Vec::new(),
            continues: !truncated,
            has_news: false,
            is_too_long: false,
            writer: 0,
            writer_thread: 0,
        };
        Self {
            engine: engine.clone(),
            reloader: reloader.clone(),
            shown: Mutex::default(),
            draft: Mutex::new(draft),
        }
    }

    fn begin(&self, draft: &mut Draft) {
        if std::mem::take(&mut draft.continues) {
            draft.bytes = self.reloader.in_force();
        }
    }

    fn apply(&self, id: RequestId, draft: &mut Draft) -> Result<Outcome, Error> {
        if !std::mem::take(&mut draft.has_news) {
            return Ok(Outcome::Done(0));
        }
        if std::mem::take(&mut draft.is_too_long) {
            draft.bytes.clear();
            self.reloader.refuse(&format!(
                "config: more than {CONFIG_BYTES_MAX} bytes were written"
            ));
            return Err(Error::Invalid("the configuration is too long".to_owned()));
        }
        self.engine.park(id);
        let engine = self.engine.clone();
        self.reloader
            .apply_later(draft.bytes.clone(), move |result| {
                if engine.claim(id) {
                    let answer = result
                        .map(|()| Answer::Empty)
                        .map_err(|problem| Error::Invalid(problem.to_string()));
                    engine.answer(id, answer);
                }
            });
        Ok(Outcome::Wait)
    }
}

impl OpenFile for ConfigFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        let mut shown = lock(&self.shown);
        if request.offset == 0 {
            *shown = self.reloader.in_force();
        }
        Ok(Outcome::Done(copy_at(&shown, request.offset, out)))
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        let mut draft = lock(&self.draft);
        self.begin(&mut draft);
        let at = if request.append {
            draft.bytes.len()
        } else {
            usize::try_from(request.offset).unwrap_or(usize::MAX)
        };
        if draft.writer_thread != request.caller.pid {
            draft.writer_thread = request.caller.pid;
            draft.writer = process_of(request.caller.pid);
        }
        draft.has_news = true;
        let end = at.saturating_add(data.len());
        if end > CONFIG_BYTES_MAX {
            draft.is_too_long = true;
            return Err(Error::TooLarge);
        }
        if draft.bytes.len() < end {
            draft.bytes.resize(end, 0);
        }
        draft.bytes[at..end].copy_from_slice(data);
        Ok(Outcome::Done(data.len()))
    }

    fn truncate(&self, size: u64) -> Result<(), Error> {
        let mut draft = lock(&self.draft);
        self.begin(&mut draft);
        let size = usize::try_from(size)
            .ok()
            .filter(|&size| size <= CONFIG_BYTES_MAX)
            .ok_or(Error::TooLarge)?;
        draft.bytes.resize(size, 0);
        Ok(())
    }

    fn flush(&self, id: RequestId, caller: Caller) -> Result<Outcome, Error> {
        let mut draft = lock(&self.draft);
        if !draft.has_news || process_of(caller.pid) != draft.writer {
            return Ok(Outcome::Done(0));
        }
        if is_being_killed(caller.pid) {
            draft.has_news = false;
            draft.bytes.clear();
            self.reloader.refuse("config: the writer was killed before it closed the file; what it wrote was dropped");
            return Ok(Outcome::Done(0));
        }
        self.apply(id, &mut draft)
    }

    fn fsync(&self, id: RequestId, _caller: Caller) -> Result<Outcome, Error> {
        self.apply(id, &mut lock(&self.draft))
    }

    fn release(&self) {
        let mut draft = lock(&self.draft);
        if std::mem::take(&mut draft.has_news) {
            self.reloader.refuse("config: the file was closed by another process than the writer; what was written was dropped");
        }
    }
}
