//! What people do to the controller from outside: a gamepad, and speech that somebody hears.
//!
//! Lines in `control/gamepad` go to the FIFO of the gamepad service as they are; `etc/trik/say` says its words.

use crate::attributes::Attributes;
use crate::fifo::{In, Out};
use crate::files::{Part, script};
use crate::shared::Shared;
use std::io;
use std::os::fd::BorrowedFd;

/// Gamepad and ears.
pub struct Control {
    gamepad: In,
    gamepad_out: Out,
    say: In,
}

impl Control {
    /// The FIFOs and the script.
    pub fn make(attributes: &Attributes) -> io::Result<Self> {
        let root = attributes.root();
        script(
            &root.join("etc/trik/say"),
            "\ncontrol=$root/control/say\n[ -p \"$control\" ] || { echo \"the virtual board is not running\" >&2; exit 1; }\nprintf '%s\\n' \"$*\" 1<>\"$control\"\n",
        )?;
        Ok(Self {
            gamepad: In::make(root.join("control/gamepad"))?,
            gamepad_out: Out::make(root.join("run/gamepad-service.out.fifo"))?,
            say: In::make(root.join("control/say"))?,
        })
    }
}

impl Part for Control {
    fn run(&mut self, shared: &Shared) -> f64 {
        self.gamepad_out.reader();
        for line in self.gamepad.lines() {
            self.gamepad_out.send(format!("{line}\n").as_bytes());
        }
        if let Some(words) = self.say.lines().pop() {
            shared.machine().said = words;
        }
        f64::INFINITY
    }

    fn inputs(&self) -> Vec<BorrowedFd<'_>> {
        vec![self.gamepad.fd(), self.say.fd()]
    }
}
