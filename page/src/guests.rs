//! Which computers may look and do things, as far as this crate is told.
//!
//! Owns the border: who they are is known to the program that serves a page.

use std::net::IpAddr;

/// Which computers may do what.
pub trait Guests: Send + Sync {
    /// It connects; what it may is asked later.
    fn comes(&self, _: IpAddr) {}

    /// It may look.
    fn may_look(&self, ip: IpAddr) -> bool;

    /// It may do things. Asked often; a person at the robot may say yes meanwhile.
    fn may_drive(&self, ip: IpAddr) -> bool;

    /// It wants to do something and may not: a person at the robot may say yes now.
    fn asks(&self, ip: IpAddr);

    /// Somebody has typed a pairing code there. A program that gives out none takes none.
    ///
    /// # Errors
    /// It may do no more than before.
    fn pair(&self, _: IpAddr, _: &str) -> Result<(), NotPaired> {
        Err(NotPaired::Code)
    }
}

/// Why a pairing code changes nothing.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NotPaired {
    /// It is none that counts.
    Code,
    /// The robot cannot pair, in its words.
    Robot(String),
}

/// Every computer may do everything.
#[derive(Clone, Copy, Debug)]
pub struct Everybody;

impl Guests for Everybody {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        true
    }

    fn asks(&self, _: IpAddr) {}

    fn pair(&self, _: IpAddr, _: &str) -> Result<(), NotPaired> {
        Ok(())
    }
}
