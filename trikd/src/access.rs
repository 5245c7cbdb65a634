//! Who may use the robot: an allow-list of addresses, and computers that a person at the robot has paired.
//!
//! Owns both lists and the file of paired addresses. Both are off by default: then everybody may do everything, which
//! is what desktop programs expect. Knows no sockets and no requests.

mod code;

pub use code::Refused;

use crate::limits;
use crate::protocol::mail::plain;
use code::Code;
use std::collections::BTreeSet;
use std::fmt;
use std::io;
use std::net::IpAddr;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Addresses that begin with the same bits.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Network {
    ip: IpAddr,
    bits: u32,
}

fn number(ip: IpAddr) -> (u128, u32) {
    match ip {
        // Left in 128 bits, so that both kinds are cut in the same way.
        IpAddr::V4(four) => (u128::from(four.to_bits()) << 96, 32),
        IpAddr::V6(six) => (six.to_bits(), 128),
    }
}

impl Network {
    /// Whether the address is one of them.
    pub fn contains(&self, ip: IpAddr) -> bool {
        let (mine, other) = (number(self.ip), number(plain(ip)));
        let differs = mine.0 ^ other.0;
        mine.1 == other.1 && (self.bits == 0 || differs >> (128 - self.bits) == 0)
    }
}

/// A text that is no network.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct NoNetwork(String);

impl fmt::Display for NoNetwork {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            out,
            "'{}' is no network: an address such as 192.168.77.5, or one with bits, 192.168.77.0/24",
            self.0
        )
    }
}

impl std::error::Error for NoNetwork {}

impl FromStr for Network {
    type Err = NoNetwork;

    fn from_str(text: &str) -> Result<Self, NoNetwork> {
        let why = || NoNetwork(text.to_owned());
        let (ip, bits) = text
            .split_once('/')
            .map_or((text, None), |(ip, bits)| (ip, Some(bits)));
        let ip: IpAddr = ip.parse().map_err(|_| why())?;
        let most = number(ip).1;
        let bits = bits.map_or(Ok(most), str::parse).map_err(|_| why())?;
        if bits > most {
            return Err(why());
        }
        Ok(Self { ip, bits })
    }
}

/// A computer that wants to be paired.
#[derive(Clone, Copy, Debug)]
struct PairingRequest {
    ip: IpAddr,
    when: Instant,
    /// When another one asked as well, if one did: nobody can know whom the key is meant for.
    rival: Option<Instant>,
}

/// Whether a key that is pressed now still has to do with that.
fn is_fresh(when: Instant) -> bool {
    when.elapsed() < Duration::from_millis(limits::PAIRING_MS)
}

/// The lists in force.
#[derive(Debug)]
pub struct Access {
    allowed: Vec<Network>,
    /// None: pairing is off.
    paired: Option<Mutex<BTreeSet<IpAddr>>>,
    file: PathBuf,
    /// Who asked last: a key that is pressed soon after that pairs it.
    asked: Mutex<Option<PairingRequest>>,
    /// The code that was given out last.
    code: Mutex<Option<Code>>,
    /// The page on this machine asks for its browsers, after it has asked here about each of them.
    has_page: bool,
}

/// What is in a lock, also after a thread that held it has failed: these are plain values.
fn held<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Access {
    /// Everybody in `allowed`, or everybody if that is empty; with `pairs`, programs only from those in `file`.
    ///
    /// # Errors
    /// The file exists and cannot be read.
    pub fn new(allowed: Vec<Network>, pairs: bool, file: &Path) -> io::Result<Self> {
        let paired = if pairs {
            Some(Mutex::new(read(file)?))
        } else {
            None
        };
        Ok(Self {
            allowed,
            paired,
            file: file.to_owned(),
            asked: Mutex::default(),
            code: Mutex::default(),
            has_page: false,
        })
    }

    /// The same, with a page on this machine, which then has all rights: it looks after those of its browsers itself.
    pub fn with_page(self) -> Self {
        Self {
            has_page: true,
            ..self
        }
    }

    /// Whether a connection from there is served at all.
    pub fn admits(&self, ip: IpAddr) -> bool {
        self.is_page(ip) || self.lists(ip)
    }

    fn is_page(&self, ip: IpAddr) -> bool {
        self.has_page && plain(ip).is_loopback()
    }

    /// Whether the allow-list has it.
    pub fn lists(&self, ip: IpAddr) -> bool {
        self.allowed.is_empty() || self.allowed.iter().any(|network| network.contains(ip))
    }

    /// Whether programs from there are run. A computer that is refused is remembered for [`Access::pair_last`].
    pub fn may_control(&self, ip: IpAddr) -> bool {
        let may = self.is_page(ip) || self.is_paired(ip);
        if !may {
            self.remember(ip);
        }
        may
    }

    /// Whether it is paired, or pairing is off.
    pub fn is_paired(&self, ip: IpAddr) -> bool {
        let paired = self.paired.as_ref();
        paired.is_none_or(|paired| held(paired).contains(&plain(ip)))
    }

    /// This computer has asked: a key that is pressed soon pairs it.
    pub fn remember(&self, ip: IpAddr) {
        let ip = plain(ip);
        let mut last = held(&self.asked);
        let before = last.filter(|asked| is_fresh(asked.when));
        let rival = before.and_then(|asked| {
            if asked.ip == ip {
                asked.rival
            } else {
                Some(asked.when)
            }
        });
        *last = Some(PairingRequest {
            ip,
            when: Instant::now(),
            rival,
        });
    }

    /// Whether pairing is on.
    pub fn pairs(&self) -> bool {
        self.paired.is_some()
    }

    /// Pairs the computer that asked within the last [`limits::PAIRING_MS`]; returns which.
    ///
    /// # Errors
    /// It is paired, but cannot be remembered for the next start; or several computers have asked in that time, of which
    /// none is paired.
    pub fn pair_last(&self) -> io::Result<Option<IpAddr>> {
        let asked = held(&self.asked).take();
        match asked.filter(|asked| is_fresh(asked.when)) {
            Some(PairingRequest {
                ip,
                rival: Some(at),
                ..
            }) if is_fresh(at) => Err(io::Error::other(format!(
                "{ip} and others have asked within {} s, so none of them is paired: try again when only one asks, or use `trikd pair ADDRESS`",
                limits::PAIRING_MS / 1000
            ))),
            Some(PairingRequest { ip, .. }) => self.pair(ip).map(|()| Some(ip)),
            None => Ok(None),
        }
    }

    /// A new pairing code; the one before counts no longer.
    ///
    /// # Errors
    /// Pairing is off; the system has no random numbers.
    pub fn new_code(&self) -> io::Result<String> {
        self.set()?;
        let code = Code::new()?;
        let digits = code.digits().to_owned();
        *held(&self.code) = Some(code);
        Ok(digits)
    }

    /// Pairs a computer at which somebody has typed the code.
    ///
    /// # Errors
    /// It is another one, or counts no longer; as [`Access::pair`].
    pub fn pair_by(&self, ip: IpAddr, typed: &str) -> Result<(), Refused> {
        // It is for a computer that needs one.
        if self.is_paired(ip) {
            return Ok(());
        }
        let mut code = held(&self.code);
        if !code.as_mut().is_some_and(|code| code.is(plain(ip), typed)) {
            return Err(Refused::Wrong);
        }
        *code = None;
        drop(code);
        self.pair(ip).map_err(Refused::Unpaired)
    }

    /// The paired computers.
    fn set(&self) -> io::Result<&Mutex<BTreeSet<IpAddr>>> {
        let why = "pairing is off: everybody may run programs";
        let off = || io::Error::new(io::ErrorKind::InvalidInput, why);
        self.paired.as_ref().ok_or_else(off)
    }

    /// Pairs a computer.
    ///
    /// # Errors
    /// As [`Access::pair_last`]; `InvalidInput` if there are too many, or pairing is off.
    pub fn pair(&self, ip: IpAddr) -> io::Result<()> {
        let mut paired = held(self.set()?);
        if ip.is_unspecified() || ip.is_multicast() {
            let why = format!("{ip} is the address of no computer");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        if paired.len() >= limits::PAIRED && !paired.contains(&plain(ip)) {
            let why =
                "too many computers are paired: remove some from the file 'paired' and start again";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        paired.insert(plain(ip));
        let lines: Vec<_> = paired.iter().map(|ip| format!("{ip}\n")).collect();
        crate::scripts::replace(&self.file, lines.concat().as_bytes(), 0o600)
    }

    /// One line for the status.
    pub fn describe(&self) -> String {
        let networks: Vec<_> = self
            .allowed
            .iter()
            .map(|network| format!("{}/{}", network.ip, network.bits))
            .collect();
        let allowed = if networks.is_empty() {
            "everybody".to_owned()
        } else {
            networks.join(", ")
        };
        match &self.paired {
            None => format!("{allowed}; pairing is off"),
            Some(paired) => {
                let paired: Vec<_> = held(paired).iter().map(IpAddr::to_string).collect();
                format!(
                    "{allowed}; programs only from paired computers: {}",
                    paired.join(", ")
                )
            }
        }
    }
}

fn read(file: &Path) -> io::Result<BTreeSet<IpAddr>> {
    match std::fs::read_to_string(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(BTreeSet::new()),
        Err(error) => Err(io::Error::new(
            error.kind(),
            format!("{}: {error}", file.display()),
        )),
        Ok(text) => Ok(text
            .lines()
            .take(limits::PAIRED)
            .filter_map(|line| line.trim().parse().ok())
            .collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn networks_are_addresses_with_equal_first_bits() {
        let network: Network = "192.168.77.0/24".parse().unwrap();
        let has = |ip: &str| network.contains(ip.parse().unwrap());
        assert!(has("192.168.77.200") && has("::ffff:192.168.77.1"));
        assert!(!has("192.168.78.1") && !has("::1"));
        let one: Network = "fe80::1".parse().unwrap();
        assert!(
            one.contains("fe80::1".parse().unwrap()) && !one.contains("fe80::2".parse().unwrap())
        );
        let all: Network = "0.0.0.0/0".parse().unwrap();
        assert!(all.contains("1.2.3.4".parse().unwrap()));
        for bad in ["", "1.2.3", "1.2.3.4/33", "1.2.3.4/-1", "robot"] {
            assert!(
                bad.parse::<Network>()
                    .unwrap_err()
                    .to_string()
                    .contains("is no network"),
                "{bad}"
            );
        }
    }

    #[test]
    fn a_key_pairs_nobody_when_two_computers_have_asked() {
        let scratch = tempdir().unwrap();
        let access = Access::new(Vec::new(), true, &scratch.path().join("paired")).unwrap();
        let (owner, thief): (IpAddr, IpAddr) =
            ("10.0.0.7".parse().unwrap(), "10.0.0.8".parse().unwrap());
        for asks in [&[owner, thief][..], &[thief, owner], &[owner, thief, thief]] {
            for ip in asks {
                assert!(!access.may_control(*ip));
            }
            let why = access.pair_last().unwrap_err().to_string();
            assert!(why.contains("none of them is paired"), "{why}");
            assert_eq!(access.pair_last().unwrap(), None);
        }
        assert!(!access.may_control(owner) && !access.may_control(owner));
        assert_eq!(access.pair_last().unwrap(), Some(owner));
        assert!(!access.may_control(thief));
    }

    #[test]
    fn a_code_pairs_one_computer_and_the_newest_one_counts() {
        let scratch = tempdir().unwrap();
        let file = scratch.path().join("paired");
        let (owner, other): (IpAddr, IpAddr) =
            ("10.0.0.7".parse().unwrap(), "10.0.0.8".parse().unwrap());
        let open = Access::new(Vec::new(), false, &file).unwrap();
        let why = open.new_code().unwrap_err().to_string();
        assert!(why.contains("pairing is off"), "{why}");
        let access = Access::new(Vec::new(), true, &file).unwrap();
        assert!(matches!(
            access.pair_by(owner, "000000"),
            Err(Refused::Wrong)
        ));
        let old = access.new_code().unwrap();
        let mut new = access.new_code().unwrap();
        while new == old {
            new = access.new_code().unwrap();
        }
        assert!(matches!(access.pair_by(owner, &old), Err(Refused::Wrong)));
        access.pair_by(owner, &new).unwrap();
        assert!(access.is_paired(owner) && !access.is_paired(other));
        // One that is paired already uses none up.
        let next = access.new_code().unwrap();
        access.pair_by(owner, &next).unwrap();
        access.pair_by(owner, "wrong").unwrap();
        access.pair_by("10.0.0.9".parse().unwrap(), &next).unwrap();
        for none in ["0.0.0.0", "::", "224.0.0.1"] {
            assert!(access.pair(none.parse().unwrap()).is_err(), "{none}");
        }
        assert!(matches!(access.pair_by(other, &new), Err(Refused::Wrong)));
    }

    #[test]
    fn the_page_of_this_machine_has_all_rights_and_no_other_does() {
        let scratch = tempdir().unwrap();
        let file = scratch.path().join("paired");
        let allowed = vec!["10.0.0.0/8".parse().unwrap()];
        let here: IpAddr = "127.0.0.1".parse().unwrap();
        let access = Access::new(allowed.clone(), true, &file).unwrap();
        assert!(!access.admits(here) && !access.may_control(here));
        let access = Access::new(allowed, true, &file).unwrap().with_page();
        assert!(access.admits(here) && access.may_control(here));
        // A browser on this machine has the rights of any other computer.
        assert!(!access.lists(here) && !access.is_paired(here));
        assert!(!access.may_control("10.0.0.1".parse().unwrap()));
    }

    #[test]
    fn a_paired_computer_is_remembered() {
        let scratch = tempdir().unwrap();
        let file = scratch.path().join("paired");
        let ip: IpAddr = "::ffff:10.0.0.7".parse().unwrap();
        let access = Access::new(Vec::new(), true, &file).unwrap();
        assert_eq!(access.pair_last().unwrap(), None);
        assert!(access.admits(ip) && !access.may_control(ip));
        assert_eq!(
            access.pair_last().unwrap(),
            Some("10.0.0.7".parse().unwrap())
        );
        assert!(access.may_control(ip));
        let again = Access::new(Vec::new(), true, &file).unwrap();
        assert!(again.may_control("10.0.0.7".parse().unwrap()));
        assert!(
            Access::new(Vec::new(), false, &file)
                .unwrap()
                .may_control("1.1.1.1".parse().unwrap())
        );
    }
}
