//! The page in the browser for a robot of this machine.
//!
//! Owns where it is served, and opening it. What it shows is known to the crate `page`; the world around a virtual robot is handed
//! to it.

use super::args::ServingArgs;
use super::trikd::Trikd;
pub(crate) use super::trikd::reachable;
use crate::error::Error;
use crate::place::Place;
pub(super) use page::playback::Playback;
use page::world::World;
use page::{Everybody, Page, Settings};
use std::net::SocketAddr;
use std::process::{Command, Stdio};
use std::sync::Arc;

/// The port of the page, unless another one is wanted or it is taken.
const PORT: u16 = 8000;

/// What is below the tree, as far as the page shows it.
#[derive(Default)]
pub(crate) struct Beneath {
    /// The world around a virtual robot.
    pub(crate) world: Option<Arc<dyn World>>,
    /// A recording that is played.
    pub(crate) playback: Option<Arc<dyn Playback>>,
}

/// A page that is served.
pub(crate) struct Served {
    page: Page,
    /// A browser shall be started.
    opens: bool,
}

impl Served {
    /// Serves the page of the robot at this place; None if nobody wants it, or there is no trikd, from which it has all values.
    ///
    /// # Errors
    /// The port that was named is taken.
    pub(crate) fn start(
        args: &ServingArgs,
        place: &Place,
        trikd: Option<&Trikd>,
        name: String,
        beneath: Beneath,
    ) -> Result<Option<Self>, Error> {
        let Some(trikd) = trikd.filter(|_| !args.no_page) else {
            return Ok(None);
        };
        let settings = |port: u16| Settings {
            address: SocketAddr::new(trikd.bound(), port),
            name: name.clone(),
            tree: place.mountpoint.clone(),
            programs: Some(trikd.scripts.clone()),
            studio: page::studio::find(),
            world: beneath.world.clone(),
            playback: beneath.playback.clone(),
            // That of a recording is made from its nodes.
            configures: beneath.playback.is_none(),
            guests: Arc::new(Everybody),
        };
        let wanted = args.page_port.unwrap_or(PORT);
        let page = match (Page::start(settings(wanted)), args.page_port) {
            // Another robot has it, or another program.
            (Err(page::error::Error::Address(..)), None) => Page::start(settings(0)),
            (page, _) => page,
        };
        let page = page.map_err(|error| {
            Error::Refused(format!(
                "{error}; --page-port names another port, --no-page does without"
            ))
        })?;
        Ok(Some(Self {
            page,
            opens: args.open,
        }))
    }

    /// The robot takes programs there from now on.
    pub(super) fn robot_is_at(&self, address: SocketAddr) {
        self.page.robot_is_at(address);
    }

    /// What a person is told.
    pub(super) fn welcome(&self) -> String {
        format!("\nIn a browser: {}\n", self.link())
    }

    /// Where this computer reaches it.
    pub(super) fn address(&self) -> SocketAddr {
        let address = self.page.address();
        SocketAddr::new(reachable(address.ip()), address.port())
    }

    fn link(&self) -> String {
        format!("http://{}/", self.address())
    }

    /// Opens it in the browser of the person, if that is wanted. Why it did not, as a line.
    pub(super) fn open(&mut self) -> Option<String> {
        match std::mem::take(&mut self.opens) {
            true => browse(&self.link()),
            false => None,
        }
    }
}

/// Opens an address in the browser of the person. Why it did not, as a line.
pub(crate) fn browse(link: &str) -> Option<String> {
    let mut browser = Command::new("xdg-open");
    browser.arg(link).stdin(Stdio::null());
    browser.stdout(Stdio::null()).stderr(Stdio::null());
    match browser.spawn() {
        Ok(mut child) => {
            // It ends when the browser has taken the address; its state belongs to nobody.
            std::thread::spawn(move || child.wait());
            None
        }
        Err(error) => Some(format!(
            "trik: the browser is not opened, xdg-open: {error}"
        )),
    }
}
