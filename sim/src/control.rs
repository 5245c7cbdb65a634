//! What people do to the controller from outside: a gamepad, and speech that somebody hears.
//!
//! Lines in `control/gamepad` go to the FIFO of the gamepad service as they are, and those in `control/world` to the world;
//! what is wrong with one of these is in `control/world.error` until a good one comes. The loudspeaker is what it would give
//! to an ear, in words: what `etc/trik/say` says, and in brackets the tones of `usr/lib/trikfs/tone` and the files of
//! `usr/bin/aplay`.

use crate::attributes::{Attributes, appear};
use crate::fifo::{In, Out};
use crate::files::{Part, script};
use crate::shared::Shared;
use std::io;
use std::os::fd::BorrowedFd;
use std::path::PathBuf;

const WORLD: &str = "control/world";

/// Programs that are heard, and what is heard of their arguments.
const SPEAKERS: [(&str, &str); 3] = [
    // The blank before a minus sign is not heard.
    ("etc/trik/say", "words=$*\nwords=${words# }\n"),
    (
        "usr/lib/trikfs/tone",
        "words=\"(a tone of ${1%% *} Hz for ${1##* } ms)\"\n",
    ),
    (
        "usr/bin/aplay",
        "for file; do :; done\n[ -r \"$file\" ] || { echo \"$file: no such sound file\" >&2; exit 1; }\nwords=\"($file is played)\"\n",
    ),
];
const SPEAK: &str = r#"control=$root/control/say
[ -p "$control" ] || { echo "the virtual board is not running" >&2; exit 1; }
printf '%s\n' "$words" 1<>"$control"
"#;

/// Gamepad and ears.
pub struct Control {
    gamepad: In,
    gamepad_out: Out,
    say: In,
    world: In,
    root: PathBuf,
}

impl Control {
    /// The FIFOs and the script.
    pub fn make(attributes: &Attributes) -> io::Result<Self> {
        let root = attributes.root();
        for (name, words) in SPEAKERS {
            script(root, name, &format!("{words}{SPEAK}"))?;
        }
        Ok(Self {
            gamepad: In::make(root.join("control/gamepad"))?,
            gamepad_out: Out::make(root.join("run/gamepad-service.out.fifo"))?,
            say: In::make(root.join("control/say"))?,
            world: In::make(root.join(WORLD))?,
            root: root.to_owned(),
        })
    }
}

impl Part for Control {
    fn run(&mut self, shared: &Shared) -> f64 {
        self.gamepad_out.reader();
        for line in self.gamepad.lines() {
            self.gamepad_out.send(format!("{line}\n").as_bytes());
        }
        for words in self.say.lines() {
            shared.machine().say(words);
        }
        for words in self.world.lines() {
            let name = format!("{WORLD}.error");
            // If this cannot be told, the folder of the board is lost.
            match shared.machine().order(&words) {
                Ok(()) => drop(std::fs::remove_file(self.root.join(name))),
                Err(reason) => drop(appear(&self.root, &name, &reason.to_string())),
            }
        }
        f64::INFINITY
    }

    fn inputs(&self) -> Vec<BorrowedFd<'_>> {
        vec![self.gamepad.fd(), self.say.fd(), self.world.fd()]
    }
}
