//! What every device of a class is to the view: a list of attributes that are shown and stored as text.
//!
//! Owns the rules of sysfs texts (one line, whole numbers to the base ten, a line break at the end is not part of it) and
//! what is notified when an attribute changes. Knows no device and no inode.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use trikfs::errno::Error;
use trikfs::transport::{Kernel, PollHandle};

/// Who may do what with an attribute; the modes are those of ev3dev, whose libraries look at the bits of the group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// 0444
    Read,
    /// 0220
    Write,
    /// 0664
    ReadWrite,
}

impl Access {
    /// Permission bits.
    pub fn mode(self) -> u16 {
        match self {
            Self::Read => 0o444,
            Self::Write => 0o220,
            Self::ReadWrite => 0o664,
        }
    }
}

/// One file in the directory of a device. A name with a slash stands in a directory of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// For example `position` or `speed_pid/Kp`.
    pub name: &'static str,
    /// What can be done with it.
    pub access: Access,
}

/// Attributes that can be read.
pub const fn read(name: &'static str) -> Attribute {
    Attribute {
        name,
        access: Access::Read,
    }
}

/// Attributes that can be written.
pub const fn write(name: &'static str) -> Attribute {
    Attribute {
        name,
        access: Access::Write,
    }
}

/// Attributes that can be read and written.
pub const fn read_write(name: &'static str) -> Attribute {
    Attribute {
        name,
        access: Access::ReadWrite,
    }
}

/// A device of a class. Calls come from several threads.
pub trait Device: Send + Sync {
    /// Its files.
    fn attributes(&self) -> &'static [Attribute];

    /// The content of an attribute, without the line break of a text.
    ///
    /// # Errors
    /// Why there is none now.
    fn show(&self, attribute: &str) -> Result<Shown, Error>;

    /// Takes what was written, without the line break.
    ///
    /// # Errors
    /// Why it is refused.
    fn store(&self, attribute: &str, text: &str) -> Result<(), Error>;

    /// Brings to rest what it drives, because nobody could do so after this process; whether it drove something. A program
    /// may drive it again.
    fn rest(&self, _why: &str) -> bool {
        false
    }

    /// What is notified when this attribute changes; none if it never notifies.
    fn changes(&self, _attribute: &str) -> Option<&Arc<Changes>> {
        None
    }

    /// A file of it was opened.
    fn opened(&self) {}

    /// A file of it was closed.
    fn closed(&self) {}
}

/// Content of an attribute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shown {
    /// One line; the break is added.
    Line(String),
    /// Bytes as they are.
    Bytes(Vec<u8>),
}

impl Shown {
    /// The bytes of the file.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Line(mut text) => {
                text.push('\n');
                text.into_bytes()
            }
            Self::Bytes(bytes) => bytes,
        }
    }
}

/// A line from anything that can be printed.
///
/// # Errors
/// None; the type is that of [`Device::show`].
pub fn line(value: impl ToString) -> Result<Shown, Error> {
    Ok(Shown::Line(value.to_string()))
}

/// The refusal of a text that is none of the words.
pub fn no_such_word(attribute: &str, text: &str) -> Error {
    Error::Invalid(format!("{attribute}: {text:?} means nothing here"))
}

/// A whole number as sysfs takes it: a sign, digits, nothing else.
///
/// # Errors
/// EINVAL for anything else; ERANGE beyond 32 bits.
pub fn whole_number(attribute: &str, text: &str) -> Result<i32, Error> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err(Error::Invalid(format!(
            "{attribute}: {text:?} is no whole number"
        )));
    }
    text.parse()
        .map_err(|_| Error::OutOfRange(format!("{attribute}: {text} does not fit 32 bits")))
}

/// A whole number between two others.
///
/// # Errors
/// As [`whole_number`]; EINVAL if it is not between them.
pub fn number_within(attribute: &str, text: &str, least: i32, greatest: i32) -> Result<i32, Error> {
    let number = whole_number(attribute, text)?;
    if (least..=greatest).contains(&number) {
        Ok(number)
    } else {
        Err(Error::Invalid(format!(
            "{attribute}: {number} is not between {least} and {greatest}"
        )))
    }
}

/// Takes a lock that a panic may have left.
pub fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The way to the kernel; empty before the mount is live.
pub type KernelSlot = Arc<OnceLock<Arc<dyn Kernel>>>;

/// How often an attribute has changed, and who polls for that.
pub struct Changes {
    kernel: KernelSlot,
    count: AtomicU32,
    watchers: Mutex<Vec<(u64, PollHandle)>>,
}

impl Changes {
    /// Nothing has changed yet.
    pub fn new(kernel: KernelSlot) -> Arc<Self> {
        Arc::new(Self {
            kernel,
            count: AtomicU32::new(0),
            watchers: Mutex::default(),
        })
    }

    /// Grows with each change, and wraps.
    pub fn count(&self) -> u32 {
        self.count.load(Ordering::SeqCst)
    }

    /// The open file `fh` wants to be told.
    pub fn watch(&self, fh: u64, handle: PollHandle) {
        let mut watchers = lock(&self.watchers);
        watchers.retain(|(other, _)| *other != fh);
        watchers.push((fh, handle));
    }

    /// The open file `fh` is gone.
    pub fn forget(&self, fh: u64) {
        lock(&self.watchers).retain(|(other, _)| *other != fh);
    }

    /// Counts a change and wakes programs that poll. Call it without any lock that an operation takes.
    pub fn notify(&self) {
        self.count.fetch_add(1, Ordering::SeqCst);
        let handles: Vec<PollHandle> = lock(&self.watchers)
            .iter()
            .map(|(_, handle)| *handle)
            .collect();
        if let Some(kernel) = self.kernel.get() {
            for handle in handles {
                kernel.notify_poll(handle);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_taken_as_sysfs_takes_them() {
        for (text, number) in [("0", 0), ("-17", -17), ("+5", 5), ("007", 7)] {
            assert_eq!(whole_number("x", text), Ok(number));
        }
        for text in [
            "", "-", " 5", "5 ", "0x10", "1.0", "1e3", "five", "--1", "5\0",
        ] {
            let error = whole_number("x", text).unwrap_err();
            assert_eq!(error.errno(), libc::EINVAL, "{text:?}");
        }
        let error = whole_number("x", "2147483648").unwrap_err();
        assert_eq!(error.errno(), libc::ERANGE);
        assert!(number_within("x", "101", -100, 100).is_err());
        assert_eq!(number_within("x", "-100", -100, 100), Ok(-100));
    }

    #[test]
    fn who_is_gone_is_not_told() {
        let changes = Changes::new(KernelSlot::default());
        changes.watch(1, PollHandle(10));
        changes.watch(1, PollHandle(11));
        changes.watch(2, PollHandle(12));
        changes.forget(2);
        assert_eq!(*lock(&changes.watchers), [(1, PollHandle(11))]);
        changes.notify();
        assert_eq!(changes.count(), 1);
    }
}
