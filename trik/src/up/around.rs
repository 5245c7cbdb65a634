//! The world around a virtual robot for its page: what is seen there, and what people order.
//!
//! Owns which orders a page may give. Looking and moving is the simulator's part, faults are files of the board, as `trik fault`
//! writes them, and a world that a person drops comes in the order itself: a page names no files of this machine.

use super::{words, world};
use crate::fault;
use page::world::{Refused, World};
use sim::arena::floor::picture;
use sim::faults::Faults;
use sim::show::Watcher;
use std::path::PathBuf;

/// The world around a virtual robot.
pub(crate) struct Around {
    watcher: Watcher,
    /// The directory of its board.
    board: PathBuf,
}

impl Around {
    /// Of the board there.
    pub(crate) fn new(watcher: Watcher, board: PathBuf) -> Self {
        Self { watcher, board }
    }

    /// `fault DEVICE KIND NUMBER`; without a kind the device is whole again.
    fn fault(&self, rest: &str) -> Result<(), Refused> {
        let (device, text) = rest.split_once(' ').unwrap_or((rest, ""));
        let text = text.trim();
        let checked = Faults::default().set(device, text);
        checked.map_err(|why| Refused(why.words()))?;
        let done = fault::set(&self.board, device, text);
        done.map_err(|why| Refused(words::unwritten(&why)))
    }

    /// `load BASE64`: the bytes of a world model or a project.
    fn load(&self, base64: &str) -> Result<(), Refused> {
        let bytes = picture::base64(base64).map_err(|why| Refused(why.words()))?;
        let found = world::of(bytes).map_err(|why| Refused(words::unfit(&why)))?;
        let entered = self.watcher.enter(&found.field, found.locks);
        entered.map_err(|why| Refused(why.words()))
    }
}

impl World for Around {
    fn scene(&self) -> (u64, String) {
        let (version, text) = self.watcher.scene();
        (version.into(), text)
    }

    fn version(&self) -> u64 {
        self.watcher.version().into()
    }

    fn state(&self) -> String {
        self.watcher.state()
    }

    fn order(&self, words: &str) -> Result<(), Refused> {
        let order = words.trim();
        match order.split_once(' ') {
            Some(("fault", rest)) => self.fault(rest.trim()),
            Some(("load", rest)) => self.load(rest),
            Some(("field", _)) => Err(Refused(words::no_files())),
            _ => {
                let done = self.watcher.order(order);
                done.map_err(|why| Refused(why.words()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::board::{Board, Options};

    const EMPTY: &str = "<root version=\"20251219\"><settings/><world/></root>";

    /// Of a few letters, so without padding only if there are threes of them.
    fn base64(text: &str) -> String {
        const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let three = |part: &[u8]| {
            let bits = part.iter().fold(0, |all, byte| all << 8 | u32::from(*byte));
            let bits = bits << (8 * (3 - part.len()));
            let letter = |at: usize| char::from(LETTERS[(bits >> (18 - 6 * at)) as usize & 63]);
            (0..=part.len()).map(letter).collect::<String>()
        };
        text.as_bytes().chunks(3).map(three).collect()
    }

    fn around(home: &tempfile::TempDir) -> (Board, Around) {
        let field = sim::field::Field::default();
        let body = Box::new(sim::body::studio::Studio::new(&field, 1));
        let board = Board::start(&home.path().join("board"), body, Options::default()).unwrap();
        let watcher = board.watcher().unwrap();
        let root = board.root().to_owned();
        (board, Around::new(watcher, root))
    }

    #[test]
    fn a_page_orders_worlds_and_faults_and_names_no_files() {
        let home = tempfile::tempdir().unwrap();
        let (board, around) = around(&home);
        let (version, _) = around.scene();
        around.order(&format!("load {}", base64(EMPTY))).unwrap();
        assert_eq!(around.version(), version + 1);
        around.order("fault A1 unplug").unwrap();
        assert!(board.root().join("faults/A1").exists());
        around.order("fault A1").unwrap();
        assert!(!board.root().join("faults/A1").exists());
        around.order("robot 0.5 -0.5 10").unwrap();
        let model = format!("load {}", base64("<root><world>"));
        let project = format!("load {}", base64("not a world at all"));
        for words in [
            "",
            "rubbish",
            "load",
            "load ????",
            &model,
            &project,
            "fault",
            "fault ../../x unplug",
            "fault A1 fly",
            "fault A1 noise nan",
            "field /etc/passwd",
            "robot 1e400 0 0",
        ] {
            assert!(around.order(words).is_err(), "{words}");
        }
        assert_eq!(around.version(), version + 1);
    }
}
