//! How much of the daemon each user may hold by open files: so many of them, and so much memory that they hold.
//!
//! Everything that an open file keeps in this process (a Lua state, a queue) is charged to the user who opened it and given
//! back when the file is closed. The owner of the tree and root may hold everything; others together may hold half of it, and
//! one of them a quarter, so that nobody who may merely read takes the tree away from the programs that drive the robot.
//!
//! Owns the counts and the limits that follow from the memory of the machine. Knows no file, and whose the memory is only by
//! what it is told.

use crate::errno::Error;
use crate::events::lock;
use crate::limits::{self, OPEN_PART_OF_ONE, OPEN_PART_OF_OTHERS};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

/// Root may do what the owner may.
const ROOT: u32 = 0;

/// What all open files hold, by user.
pub struct Admission {
    owner: u32,
    /// Everything that may be held.
    most: Holding,
    table: Mutex<BTreeMap<u32, Holding>>,
}

/// Open files and the memory that they hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Holding {
    files: usize,
    bytes: usize,
}

impl Holding {
    fn plus(self, other: Self) -> Self {
        Self {
            files: self.files + other.files,
            bytes: self.bytes.saturating_add(other.bytes),
        }
    }

    fn part(self, of: usize) -> Self {
        Self {
            files: self.files / of,
            bytes: self.bytes / of,
        }
    }
}

/// The place of one open file. What it holds is given back when it is dropped.
pub struct Place {
    admission: Arc<Admission>,
    user: u32,
    holding: Holding,
}

impl Admission {
    /// For the tree of `owner` where there is so much memory.
    pub fn new(owner: u32, machine_bytes: u64) -> Arc<Self> {
        let part = machine_bytes / limits::OPEN_MEMORY_PART;
        let bytes = usize::try_from(part).unwrap_or(usize::MAX);
        Arc::new(Self {
            owner,
            most: Holding {
                files: limits::OPEN_FILES_MAX,
                bytes: bytes.clamp(limits::OPEN_BYTES_LEAST, limits::OPEN_BYTES_MOST),
            },
            table: Mutex::default(),
        })
    }

    /// A place for one more file of this user.
    ///
    /// # Errors
    /// [`Error::TooManyOpen`], [`Error::NoMemory`]: the user has as much as is allowed.
    pub fn admit(self: &Arc<Self>, user: u32) -> Result<Place, Error> {
        let holding = Holding {
            files: 1,
            bytes: limits::OPEN_FILE_BYTES,
        };
        self.take(user, holding)?;
        Ok(Place {
            admission: Arc::clone(self),
            user,
            holding,
        })
    }

    fn is_trusted(&self, user: u32) -> bool {
        user == self.owner || user == ROOT
    }

    /// Books more for this user, unless it is too much.
    fn take(&self, user: u32, more: Holding) -> Result<(), Error> {
        let mut table = lock(&self.table);
        let sum = |counts: &dyn Fn(u32) -> bool| {
            table
                .iter()
                .filter(|(user, _)| counts(**user))
                .fold(more, |sum, (_, holding)| sum.plus(*holding))
        };
        self.check(sum(&|_| true), self.most, "all users together")?;
        if !self.is_trusted(user) {
            let all_others = sum(&|user| !self.is_trusted(user));
            let most = self.most.part(OPEN_PART_OF_OTHERS);
            self.check(all_others, most, "all users but the owner and root")?;
            let one = format!("user {user}");
            self.check(
                sum(&|other| other == user),
                self.most.part(OPEN_PART_OF_ONE),
                &one,
            )?;
        }
        let holding = table.entry(user).or_default();
        *holding = holding.plus(more);
        Ok(())
    }

    fn check(&self, wanted: Holding, most: Holding, who: &str) -> Result<(), Error> {
        if wanted.files > most.files {
            return Err(Error::TooManyOpen(format!(
                "{who} may have {} files open: close some",
                most.files
            )));
        }
        if wanted.bytes > most.bytes {
            return Err(Error::NoMemory(format!(
                "the open files of {who} may hold {} KiB, in converters and queues: close some",
                most.bytes / 1024
            )));
        }
        Ok(())
    }

    fn give_back(&self, user: u32, less: Holding) {
        let mut table = lock(&self.table);
        let Some(holding) = table.get_mut(&user) else {
            return;
        };
        holding.files -= less.files;
        holding.bytes = holding.bytes.saturating_sub(less.bytes);
        if holding.files == 0 {
            table.remove(&user);
        }
    }
}

impl Place {
    /// Charges the memory that the file turned out to keep.
    ///
    /// # Errors
    /// [`Error::NoMemory`]; then nothing more is charged, and the file must be closed.
    pub fn hold(&mut self, bytes: usize) -> Result<(), Error> {
        let more = Holding { files: 0, bytes };
        self.admission.take(self.user, more)?;
        self.holding = self.holding.plus(more);
        Ok(())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.admission.give_back(self.user, self.holding);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWNER: u32 = 1000;
    const NOBODY: u32 = 65534;

    fn admission() -> Arc<Admission> {
        Admission::new(OWNER, 64 << 30)
    }

    fn fill(admission: &Arc<Admission>, user: u32, bytes: usize) -> (Vec<Place>, Error) {
        let mut places = Vec::new();
        loop {
            let taken = admission.admit(user).and_then(|mut place| {
                place.hold(bytes)?;
                Ok(place)
            });
            match taken {
                Ok(place) => places.push(place),
                Err(error) => return (places, error),
            }
        }
    }

    #[test]
    fn others_leave_room_for_the_owner_in_files_and_in_memory() {
        for bytes in [0, 1 << 20] {
            let admission = admission();
            let (first, error) = fill(&admission, NOBODY, bytes);
            let is_expected = match error {
                Error::TooManyOpen(why) => bytes == 0 && why.contains("user 65534"),
                Error::NoMemory(why) => bytes > 0 && why.contains("user 65534"),
                other => panic!("{other}"),
            };
            assert!(is_expected);
            let (second, _) = fill(&admission, NOBODY - 1, bytes);
            let (third, error) = fill(&admission, NOBODY - 2, bytes);
            // The memory of the third one's few files is what the first two could not use.
            assert!(
                third.len() < first.len() / 2,
                "{} {}",
                third.len(),
                first.len()
            );
            assert!(error.to_string().contains("all users but"), "{error}");
            let (owner, error) = fill(&admission, OWNER, bytes);
            assert!(owner.len() >= first.len() + second.len() - 2);
            assert!(error.to_string().contains("all users together"), "{error}");
            let more = admission
                .admit(ROOT)
                .and_then(|mut place| place.hold(bytes));
            assert!(more.is_err(), "root has no more than everything");
        }
    }

    #[test]
    fn what_is_closed_is_given_back() {
        let admission = admission();
        let (places, _) = fill(&admission, NOBODY, 4096);
        let count = places.len();
        drop(places);
        assert_eq!(*lock(&admission.table), BTreeMap::new());
        assert_eq!(fill(&admission, NOBODY, 4096).0.len(), count);
    }

    #[test]
    fn a_charge_that_is_refused_changes_nothing() {
        let admission = admission();
        let mut place = admission.admit(NOBODY).expect("the first");
        let before = lock(&admission.table)[&NOBODY];
        assert!(matches!(place.hold(usize::MAX), Err(Error::NoMemory(_))));
        assert_eq!(lock(&admission.table)[&NOBODY], before);
        drop(place);
        assert_eq!(*lock(&admission.table), BTreeMap::new());
    }
}
