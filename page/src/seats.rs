//! Places of connections: who gets one, and who loses one when there are no more.
//!
//! Owns the table of connections and the choice. A connection is judged by what it has brought about: one that is stuck before
//! the end of a message goes first, one that has never said anything after it, and one that is merely idle never. Knows no
//! sockets and no messages.

use crate::limits;
use std::cmp::Reverse;
use std::fmt;
use std::net::{IpAddr, Ipv6Addr};
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;

/// How many places there are, and how long one may be kept without a whole message while others wait for it.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// For everybody together.
    pub all: usize,
    /// Of these, for one computer.
    pub one: usize,
    /// Beside these, for this machine, and as many more for the computer in control.
    pub kept: usize,
    /// For a connection that is stuck in a message.
    pub stuck_time: Duration,
    /// For one that has said nothing yet.
    pub mute_time: Duration,
    /// One that is merely idle keeps its place; else it goes after all others.
    pub spares_idle: bool,
}

/// For whom a place is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Whom {
    /// Any computer.
    Anybody,
    /// This machine: its page, its own programs.
    Own,
    /// The computer that commands the robot.
    InControl,
}

/// Why there is no place for a connection; the client is to blame.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Full {
    /// All of so many are taken.
    All(usize),
    /// One computer has so many, and no more are for it.
    One(usize),
}

impl fmt::Display for Full {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All(limit) => write!(
                out,
                "there are {limit} connections already: close some, or wait"
            ),
            Self::One(most) => write!(
                out,
                "there are {most} connections from there already: close some"
            ),
        }
    }
}

/// What a connection has brought about.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Nothing has come since then.
    Mute(Instant),
    /// In the midst of a message since then, or since the last piece of it that counts; so many bytes have come after that.
    Stuck(Instant, usize),
    /// Everything that came was whole.
    Good,
}

#[derive(Debug)]
struct Entry {
    id: u32,
    /// Where its computer stands in the table.
    computer: usize,
    stage: Stage,
    /// Dropping it tells the connection that it has lost its place.
    _out: oneshot::Sender<()>,
}

#[derive(Debug, Default)]
struct Table {
    entries: Vec<Entry>,
    /// Computers with how many connections each has; one that has none gives its line to the next.
    computers: Vec<(IpAddr, usize)>,
    /// Of the newest.
    id: u32,
}

/// All places.
#[derive(Debug)]
pub struct Seats {
    room: Room,
    table: Mutex<Table>,
}

/// Whose connections are counted together: an IPv6 computer has a whole network of addresses.
fn origin(ip: IpAddr) -> IpAddr {
    match ip {
        IpAddr::V6(six) => Ipv6Addr::from_bits(six.to_bits() >> 64 << 64).into(),
        IpAddr::V4(_) => ip,
    }
}

impl Table {
    /// The line of a computer.
    fn computer(&mut self, ip: IpAddr) -> usize {
        let known = self.computers.iter().position(|(other, _)| *other == ip);
        let free = || self.computers.iter().position(|(_, count)| *count == 0);
        let index = known.or_else(free).unwrap_or(self.computers.len());
        match self.computers.get_mut(index) {
            Some(line) => line.0 = ip,
            None => self.computers.push((ip, 0)),
        }
        index
    }

    fn count(&self, computer: usize) -> usize {
        self.computers.get(computer).map_or(0, |(_, count)| *count)
    }

    fn remove(&mut self, index: usize) {
        let entry = self.entries.swap_remove(index);
        if let Some((_, count)) = self.computers.get_mut(entry.computer) {
            *count -= 1;
        }
    }

    /// Takes the place of one for a connection of a computer, of its own if `is_own`. False: all have a right to theirs.
    fn make_room(&mut self, room: &Room, computer: usize, is_own: bool, now: Instant) -> bool {
        let fair = self.count(computer) + limits::FAIR_LEAD;
        let rank = |entry: &Entry| {
            let (class, since, patience) = match entry.stage {
                Stage::Stuck(since, _) => (0, since, room.stuck_time),
                Stage::Mute(since) => (1, since, room.mute_time),
                Stage::Good if room.spares_idle => return None,
                Stage::Good => (2, now, Duration::ZERO),
            };
            let count = self.count(entry.computer);
            // A computer that has many more places than the newcomer does not keep one that does nothing.
            let is_over = now.saturating_duration_since(since) >= patience || count > fair;
            let is_wanted = is_over && (!is_own || entry.computer == computer);
            is_wanted.then_some((class, Reverse(count), entry.id))
        };
        let worst = (self.entries.iter().enumerate())
            .filter_map(|(index, entry)| rank(entry).map(|rank| (rank, index)))
            .min();
        if let Some((_, index)) = worst {
            self.remove(index);
        }
        worst.is_some()
    }
}

impl Seats {
    /// All of them free.
    pub fn new(room: Room) -> Arc<Self> {
        Arc::new(Self {
            room,
            table: Mutex::default(),
        })
    }

    fn table(&self) -> MutexGuard<'_, Table> {
        self.table.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lines for a status.
    pub fn describe(&self) -> String {
        let taken = self.table().entries.len();
        format!("connections {taken} of {}\n", self.room.all)
    }

    /// A place for a connection from there. One that brings nothing about gives way.
    ///
    /// # Errors
    /// There is none.
    pub fn take(self: &Arc<Self>, ip: IpAddr, whom: Whom) -> Result<Seat, Full> {
        let (room, ip, now) = (&self.room, origin(ip), Instant::now());
        let (kept, kept_of_one) = match whom {
            Whom::Anybody => (0, 0),
            Whom::Own => (room.kept, 0),
            Whom::InControl => (2 * room.kept, room.kept),
        };
        let mut table = self.table();
        let own = table.computer(ip);
        if table.count(own) >= room.one + kept_of_one && !table.make_room(room, own, true, now) {
            return Err(Full::One(room.one));
        }
        if table.entries.len() >= room.all + kept && !table.make_room(room, own, false, now) {
            return Err(Full::All(room.all));
        }
        table.computers[own].1 += 1;
        let (out, lost) = oneshot::channel();
        table.id = table.id.wrapping_add(1);
        let id = table.id;
        table.entries.push(Entry {
            id,
            computer: own,
            stage: Stage::Mute(now),
            _out: out,
        });
        drop(table);
        Ok(Seat {
            place: Place(Arc::clone(self), id),
            lost: Some(lost),
        })
    }
}

/// Where it is told what has come over one connection.
#[derive(Clone, Debug)]
pub struct Place(Arc<Seats>, u32);

impl Place {
    fn change(&self, change: impl FnOnce(Stage) -> Stage) {
        let mut table = self.0.table();
        if let Some(entry) = table.entries.iter_mut().find(|entry| entry.id == self.1) {
            entry.stage = change(entry.stage);
        }
    }

    /// So many bytes have come; whether a message has become whole by them, and whether another one has begun.
    pub fn hears(&self, bytes: usize, is_whole: bool, has_begun: bool) {
        self.change(|stage| match stage {
            _ if is_whole && !has_begun => Stage::Good,
            _ if is_whole => Stage::Stuck(Instant::now(), 0),
            Stage::Good if !has_begun => Stage::Good,
            // What is large may be slow, as long as it comes.
            Stage::Stuck(_, before) if before + bytes >= limits::PROGRESS_BYTES => {
                Stage::Stuck(Instant::now(), 0)
            }
            Stage::Stuck(since, before) => Stage::Stuck(since, before + bytes),
            Stage::Mute(since) => Stage::Stuck(since, bytes),
            Stage::Good => Stage::Stuck(Instant::now(), bytes),
        });
    }

    /// It has said all that it has to say.
    pub fn is_good(&self) {
        self.change(|_| Stage::Good);
    }
}

/// The place of one connection; dropping it gives it back.
#[derive(Debug)]
pub struct Seat {
    place: Place,
    /// None: it has lost it.
    lost: Option<oneshot::Receiver<()>>,
}

impl Seat {
    /// Where it is told what comes.
    pub fn place(&self) -> Place {
        self.place.clone()
    }

    /// Whether another one has got the place: the connection shall end at once.
    pub fn poll_lost(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if let Some(lost) = &mut self.lost {
            if Pin::new(lost).poll(cx).is_pending() {
                return Poll::Pending;
            }
            self.lost = None;
        }
        Poll::Ready(())
    }

    /// Waits until another one has got the place. Can be given up at any point.
    pub async fn lost(&mut self) {
        std::future::poll_fn(|cx| self.poll_lost(cx)).await;
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let Place(seats, id) = &self.place;
        let mut table = seats.table();
        if let Some(index) = table.entries.iter().position(|entry| entry.id == *id) {
            table.remove(index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: Room = Room {
        all: 40,
        one: 30,
        kept: 2,
        stuck_time: Duration::from_secs(3600),
        mute_time: Duration::from_secs(7200),
        spares_idle: true,
    };

    fn ip(last: u8) -> IpAddr {
        [10, 0, 0, last].into()
    }

    /// As many places as there are for one computer, with what is said on each.
    fn fill(seats: &Arc<Seats>, last: u8, whom: Whom, say: impl Fn(&Place)) -> Vec<Seat> {
        let mut taken = Vec::new();
        while taken.len() < 1000 {
            let Ok(seat) = seats.take(ip(last), whom) else {
                break;
            };
            say(&seat.place());
            taken.push(seat);
        }
        taken
    }

    fn is_lost(seat: &mut Seat) -> bool {
        let mut cx = Context::from_waker(std::task::Waker::noop());
        seat.poll_lost(&mut cx).is_ready()
    }

    #[test]
    fn one_computer_never_has_all_places_and_a_place_comes_back() {
        let seats = Seats::new(ROOM);
        let mut one = fill(&seats, 1, Whom::Anybody, Place::is_good);
        assert_eq!(one.len(), 30);
        let other = fill(&seats, 2, Whom::Anybody, Place::is_good);
        assert_eq!(other.len(), 10);
        assert_eq!(seats.take(ip(1), Whom::Anybody).err(), Some(Full::One(30)));
        assert_eq!(seats.take(ip(3), Whom::Anybody).err(), Some(Full::All(40)));
        one.pop();
        let again = seats.take(ip(3), Whom::Anybody);
        assert!(again.is_ok());
        drop((one, other, again));
        assert_eq!(seats.describe(), "connections 0 of 40\n");
    }

    #[test]
    fn this_machine_and_who_is_in_control_have_places_when_there_are_none() {
        let seats = Seats::new(ROOM);
        let _all = [1, 2].map(|last| fill(&seats, last, Whom::Anybody, Place::is_good));
        assert!(seats.take(ip(3), Whom::Anybody).is_err());
        assert_eq!(fill(&seats, 3, Whom::Own, Place::is_good).len(), 2);
        let own = fill(&seats, 3, Whom::Own, Place::is_good);
        let driver = fill(&seats, 1, Whom::InControl, Place::is_good);
        assert_eq!((own.len(), driver.len()), (2, 2));
    }

    #[test]
    fn who_is_stuck_goes_first_then_who_is_mute_and_who_is_idle_never() {
        let patient = Room {
            all: 3,
            one: 3,
            ..ROOM
        };
        let hasty = Room {
            stuck_time: Duration::ZERO,
            mute_time: Duration::ZERO,
            ..patient
        };
        for (room, is_hasty) in [(patient, false), (hasty, true)] {
            let seats = Seats::new(room);
            let mut mute = seats.take(ip(1), Whom::Anybody).unwrap();
            let mut idle = seats.take(ip(1), Whom::Anybody).unwrap();
            let mut stuck = seats.take(ip(1), Whom::Anybody).unwrap();
            idle.place().hears(9, true, false);
            stuck.place().hears(9, true, false);
            stuck.place().hears(3, false, true);
            let fresh = seats.take(ip(1), Whom::Anybody);
            assert_eq!((fresh.is_ok(), is_lost(&mut stuck)), (is_hasty, is_hasty));
            if let Ok(fresh) = &fresh {
                fresh.place().is_good();
                let other = seats.take(ip(1), Whom::Anybody).unwrap();
                other.place().is_good();
            }
            assert_eq!(is_lost(&mut mute), is_hasty);
            assert_eq!(seats.take(ip(1), Whom::Anybody).is_err(), !is_hasty);
            assert!(!is_lost(&mut idle));
        }
    }

    #[test]
    fn a_crowd_of_one_computer_gives_way_at_once_to_another_computer() {
        let seats = Seats::new(ROOM);
        let crowd = fill(&seats, 1, Whom::Anybody, |_| {});
        let others = fill(&seats, 2, Whom::Anybody, |_| {});
        assert_eq!((crowd.len(), others.len() > 10), (30, true));
        let mut stranger = seats.take(ip(3), Whom::Anybody).unwrap();
        assert!(!is_lost(&mut stranger));
        assert_eq!(seats.describe(), "connections 40 of 40\n");
    }

    #[test]
    fn a_large_message_that_comes_is_no_half_one() {
        let seats = Seats::new(ROOM);
        let seat = seats.take(ip(1), Whom::Anybody).unwrap();
        let stage = || {
            let Stage::Stuck(since, bytes) = seats.table().entries[0].stage else {
                panic!("it is not stuck");
            };
            (since, bytes)
        };
        seat.place().hears(1, false, true);
        let (since, _) = stage();
        seat.place().hears(limits::PROGRESS_BYTES / 2, false, true);
        assert_eq!(stage(), (since, 1 + limits::PROGRESS_BYTES / 2));
        seat.place().hears(limits::PROGRESS_BYTES / 2, false, true);
        assert_eq!((stage().0 > since, stage().1), (true, 0));
    }
}
