//! The page for browsers: served by the crate `page` on a thread of its own, which talks to the control port as every client does.
//!
//! Owns where it is served, and which computers may use it: those that may use the other ports.

use crate::access::{Access, Refused};
use crate::blame::Os;
use crate::error::Error;
use crate::log;
use crate::panics;
use crate::protocol::mail::plain;
use crate::settings::Settings;
use page::{Guests, NotPaired, Page};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;

/// Who comes to the page of a robot.
struct Visitors {
    access: Arc<Access>,
    tree: PathBuf,
}

impl Guests for Visitors {
    fn comes(&self, _: IpAddr) {
        panics::seam("page", || self.tree.join("panic").exists());
    }

    fn may_look(&self, ip: IpAddr) -> bool {
        self.access.lists(plain(ip))
    }

    fn may_drive(&self, ip: IpAddr) -> bool {
        self.access.is_paired(ip)
    }

    fn asks(&self, ip: IpAddr) {
        self.access.remember(ip);
    }

    fn pair(&self, ip: IpAddr, code: &str) -> Result<(), NotPaired> {
        match self.access.pair_by(plain(ip), code) {
            Ok(()) => {
                tracing::info!(target: log::CLIENTS, "{ip} is paired by a code");
                Ok(())
            }
            // Not told: there may be many of them.
            Err(Refused::Wrong) => Err(NotPaired::Code),
            Err(Refused::Unpaired(why)) => {
                tracing::warn!(target: log::CLIENTS, "{ip} is not paired: {why}");
                Err(NotPaired::Robot(why.to_string()))
            }
        }
    }
}

/// Serves it, if it is wanted; the robot itself is at this control port.
///
/// # Errors
/// The port is taken, or there are no more threads.
pub fn start(
    settings: &Settings,
    access: &Arc<Access>,
    control_port: u16,
) -> Result<Option<Page>, Error> {
    let Some(port) = settings.page_port else {
        return Ok(None);
    };
    let guests = Arc::new(Visitors {
        access: access.clone(),
        tree: settings.tree.clone(),
    });
    let own = settings.address.first();
    let serve = |ip: IpAddr| {
        Page::start(page::Settings {
            address: SocketAddr::new(ip, port),
            name: settings.name.clone().unwrap_or_else(host_name),
            tree: settings.tree.clone(),
            programs: Some(settings.scripts.clone()),
            studio: page::studio::find(),
            world: None,
            playback: None,
            configures: settings.page_configures,
            guests: guests.clone(),
        })
    };
    let page = match (
        own,
        serve(own.copied().unwrap_or(Ipv6Addr::UNSPECIFIED.into())),
    ) {
        // A kernel without IPv6.
        (None, Err(page::error::Error::Address(_, why)))
            if why.raw_os_error() == Some(libc::EAFNOSUPPORT) =>
        {
            serve(Ipv4Addr::UNSPECIFIED.into())
        }
        (_, page) => page,
    };
    let page = page.map_err(|error| {
        if let page::error::Error::Address(_, why) = error {
            Error::Port("page", port, Os::from(why))
        } else {
            Error::Page(error.to_string())
        }
    })?;
    let robot = match own {
        Some(ip) if !ip.is_unspecified() => *ip,
        _ => Ipv4Addr::LOCALHOST.into(),
    };
    page.robot_is_at(SocketAddr::new(robot, control_port));
    Ok(Some(page))
}

fn host_name() -> String {
    let name = rustix::system::uname();
    name.nodename().to_string_lossy().into_owned()
}
