//! One of all browsers drives, the others look.
//!
//! Owns who is in control, and how it comes and goes. What needs control is known to `browser`.

use crate::error::Error;
use std::net::SocketAddr;
use tokio::sync::watch;

/// A browser, by a number of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Browser {
    /// No other browser has it.
    pub number: usize,
    /// Where it is.
    pub address: SocketAddr,
}

/// The browser that is in control, if one is.
#[derive(Debug)]
pub struct Control {
    holder: watch::Sender<Option<Browser>>,
}

impl Default for Control {
    fn default() -> Self {
        Self {
            holder: watch::Sender::new(None),
        }
    }
}

impl Control {
    /// Hears of every change.
    pub fn watch(&self) -> watch::Receiver<Option<Browser>> {
        self.holder.subscribe()
    }

    /// This one wants to do something: it may if it is in control, and it is if nobody was.
    ///
    /// # Errors
    /// Somebody else is in control.
    pub fn need(&self, who: Browser) -> Result<(), Error> {
        let mut taken = None;
        self.holder.send_if_modified(|holder| match holder {
            None => {
                *holder = Some(who);
                true
            }
            Some(other) => {
                if *other != who {
                    taken = Some(*other);
                }
                false
            }
        });
        match taken {
            None => Ok(()),
            Some(other) => Err(Error::Taken(other.address.ip().to_string())),
        }
    }

    /// This one is in control from now on, also if another one was.
    pub fn take(&self, who: Browser) {
        self.holder.send_replace(Some(who));
    }

    /// This one is not in control any more.
    pub fn leave(&self, who: Browser) {
        self.holder.send_if_modified(|holder| {
            let is_mine = *holder == Some(who);
            if is_mine {
                *holder = None;
            }
            is_mine
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn who(number: usize) -> Browser {
        Browser {
            number,
            address: "127.0.0.1:1".parse().unwrap(),
        }
    }

    #[test]
    fn the_first_one_is_in_control_until_it_leaves_or_another_one_takes_it() {
        let control = Control::default();
        let mut watch = control.watch();
        assert!(control.need(who(1)).is_ok());
        assert!(watch.has_changed().unwrap());
        watch.mark_unchanged();
        assert!(control.need(who(1)).is_ok());
        assert!(!watch.has_changed().unwrap());
        assert!(matches!(control.need(who(2)), Err(Error::Taken(_))));
        control.leave(who(2));
        assert_eq!(*watch.borrow(), Some(who(1)));
        control.take(who(2));
        assert!(control.need(who(1)).is_err());
        control.leave(who(2));
        assert!(control.need(who(1)).is_ok());
    }
}
