//! Numbers of errors that a virtual bus answers with, as Linux gives them to what uses a real one.
//!
//! Owns the choice of numbers of this crate. Knows no chip and no packet.

/// A chip that does not acknowledge, as the controller's bus driver has it.
pub const NACK: i32 = libc::EREMOTEIO;
/// A packet that makes no sense.
pub const MALFORMED: i32 = libc::EINVAL;
/// A packet that is too long, or one that was cut off.
pub const TOO_LONG: i32 = libc::EMSGSIZE;
/// A packet of another version, or with flags that this one does not have.
pub const OTHER_VERSION: i32 = libc::EPROTONOSUPPORT;
