//! `trik class page`: the page of a class is served until somebody ends it.
//!
//! Owns where it is served, who may command, and where each robot is. What it shows is known to the crate `page`.

use super::PageArgs;
use crate::error::Error;
use crate::output::standard;
use crate::refusal::Refusal;
use crate::remote::roster::{Class, Robot};
use crate::up::page::{browse, reachable};
use crate::up::session::signals;
use lang_text::problem::Words;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use page::Guests;
use page::class::{ClassPage, ClassSettings, Found, Member, OwnPage, Whereabouts};
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::os::fd::AsFd;
use std::sync::Arc;

/// The port of the page, unless another one is wanted or it is taken. That of one robot is 8000.
const PORT: u16 = 8100;

/// Everybody looks, and this computer commands.
struct Teacher;

impl Guests for Teacher {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    /// A browser of this computer comes from an address of this computer, whichever it has opened the page by.
    fn may_drive(&self, ip: IpAddr) -> bool {
        let ip = ip.to_canonical();
        ip.is_loopback() || is_own(ip)
    }

    fn asks(&self, _: IpAddr) {}
}

/// Whether this computer has the address: nobody else's can be bound.
fn is_own(ip: IpAddr) -> bool {
    !ip.is_unspecified() && !ip.is_multicast() && UdpSocket::bind((ip, 0)).is_ok()
}

impl Whereabouts for Robot {
    fn find(&self) -> Result<Found, Words> {
        let why = |error: Error| {
            let text = error.to_string();
            Words::new(text.clone(), text)
        };
        let target = self.target().map_err(why)?;
        let known = self.page.map(OwnPage::Port);
        Ok(Found {
            addresses: target.addresses().map_err(why)?,
            page: known.or_else(|| target.page().map(OwnPage::At)),
        })
    }
}

/// Serves it.
///
/// # Errors
/// The address cannot be had.
pub(super) fn serve(args: &PageArgs) -> Result<u8, Refusal> {
    // Threads inherit what is blocked.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let start = |port: u16| {
        let at = SocketAddr::new(args.address, port);
        ClassPage::start(at, settings(&args.class))
    };
    let page = match (start(args.port.unwrap_or(PORT)), args.port) {
        // Another class has it, or another program.
        (Err(page::error::Error::Address(..)), None) => start(0),
        (page, _) => page,
    };
    let page =
        page.map_err(|error| Error::Refused(format!("{error}; --port names another port")))?;
    let at = page.address();
    let at = SocketAddr::new(reachable(at.ip()), at.port());
    let link = format!("http://{at}{}", ClassPage::path());
    let count = args.class.robots.len();
    standard(format!("{count} robots, in a browser: {link}\nCtrl-C ends it\n").as_bytes())?;
    if let Some(complaint) = args.open.then(|| browse(&link)).flatten() {
        eprintln!("{complaint}");
    }
    loop {
        if let Ok(Some(_)) = signals.read_signal() {
            return Ok(0);
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        // A signal that interrupts this is read above.
        let _ = poll(&mut fds, PollTimeout::NONE);
    }
}

/// A class as pages have it: this computer commands its robots, and everybody may look.
pub(crate) fn settings(class: &Class) -> ClassSettings {
    ClassSettings {
        name: class.name.clone(),
        robots: class.robots.iter().map(member).collect(),
        guests: Arc::new(Teacher),
    }
}

fn member(robot: &Robot) -> Member {
    Member {
        name: robot.name.clone(),
        group: robot.group.clone(),
        at: robot.at.clone(),
        whereabouts: Arc::new(robot.clone()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_computer_commands_and_others_look() {
        let ip = |text: &str| text.parse::<IpAddr>().expect("an address");
        for (text, may) in [
            ("127.0.0.1", true),
            ("::1", true),
            ("::ffff:127.0.0.1", true),
            // Of documents, nobody's (RFC 5737).
            ("192.0.2.5", false),
            ("0.0.0.0", false),
            ("224.0.0.251", false),
        ] {
            assert_eq!(Teacher.may_drive(ip(text)), may, "{text}");
            assert!(Teacher.may_look(ip(text)));
        }
        // The address by which this computer reaches others, if it has a network.
        let out = UdpSocket::bind("0.0.0.0:0").expect("a socket");
        if out.connect("192.0.2.1:9").is_ok() {
            let own = out.local_addr().expect("an address").ip();
            assert!(Teacher.may_drive(own), "{own}");
        }
    }

    #[test]
    fn words_of_a_robot_are_the_same_on_both_sides() {
        use page::class::{BATTERY, COMMANDER, DEBUGGER, EXPLAINED, REFUSALS, STARTED};
        use trikd::protocol::news;
        assert_eq!(EXPLAINED, trikd::program::rest::EXPLAINED);
        let [upload, pairing] = REFUSALS;
        assert_eq!(upload, news::UPLOAD_FAILED);
        assert!(news::NOT_PAIRED.starts_with(pairing), "{pairing}");
        let at = SocketAddr::from(([10, 0, 0, 1], 5));
        assert_eq!(
            news::battery("11.8 V", 3),
            format!("{BATTERY}11.8 V, 3 s ago\n")
        );
        assert_eq!(news::commands(at), format!("{COMMANDER}10.0.0.1:5\n"));
        assert!(news::debugs("10.0.0.1:5").starts_with(&format!("{DEBUGGER}10.0.0.1:5 ")));
        assert_eq!(news::started("a.js"), format!("a.js{STARTED}"));
    }
}
