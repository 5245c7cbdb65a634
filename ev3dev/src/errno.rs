//! Numbers of errors: what an errno of the tree means for those who use the view.
//!
//! Owns the choice of numbers of this crate: a tree that is gone is a device that is gone, and what the tree says without
//! sense is a failed device. Knows no files.

use std::io;
use trikfs::errno::Error;

/// A device that gives something else than it should; `what` says which and what.
pub fn no_answer(what: String) -> Error {
    Error::Device(libc::EIO, what)
}

/// What an errno of a file of the tree means for who uses the view: a tree or node that is gone is ENODEV, everything
/// else stays what it is.
pub fn of_tree(error: &io::Error, name: &str) -> Error {
    let errno = error.raw_os_error().unwrap_or(libc::EIO);
    let told = format!("{name}: {error}");
    match errno {
        libc::ENOENT
        | libc::ENOTDIR
        | libc::ENODEV
        | libc::ENOTCONN
        | libc::ECONNABORTED
        | libc::ESTALE => Error::NoDevice(told),
        libc::EINVAL => Error::Invalid(told),
        libc::ERANGE => Error::OutOfRange(told),
        libc::EBUSY => Error::Busy(told),
        libc::ETIMEDOUT => Error::TimedOut(told),
        libc::EINTR => Error::Interrupted,
        _ => Error::Device(errno, name.to_owned()),
    }
}
