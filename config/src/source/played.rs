//! `played{ path, channel }`: one channel of a player, which gives out what was recorded when its clock comes to it.
//!
//! Owns the limits of a channel. A recording in a text file that runs by itself is `replay`; here somebody else has the clock,
//! and may stop it, turn it back, and hear what programs write.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::{Form, Rest, put_path};
use crate::fields::Fields;
use crate::limits::{CHANNEL_BYTES_MAX, PLAYED_BYTES_MAX};
use crate::problem::Problem;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

/// `played{ path = '/run/player.sock', channel = 'sensors/A1' }`
#[derive(Clone, Debug, PartialEq)]
pub struct PlayedDescription {
    /// The socket of the player.
    pub path: PathBuf,
    /// What the player calls it: 1 to [`CHANNEL_BYTES_MAX`] bytes without control characters.
    pub channel: String,
}

impl Kind for PlayedDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "played",
        keys: &["path", "channel"],
        read,
    }];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 8,
        put: |source, out| {
            put_path(&source.path, out)?;
            put_path(Path::new(OsStr::new(&source.channel)), out)
        },
        take: |bytes| {
            let path = bytes.path()?;
            let channel = bytes.path()?;
            let channel = std::str::from_utf8(channel.as_os_str().as_bytes()).ok()?;
            is_channel(channel).then(|| Self {
                path,
                channel: channel.to_owned(),
            })
        },
    });

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.path);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.path]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Stream
    }

    fn check_tuple_size(&self, size: usize, fields: &Fields<'_>) -> Result<(), Problem> {
        if size <= PLAYED_BYTES_MAX {
            return Ok(());
        }
        let what =
            format!("played: a tuple may have {PLAYED_BYTES_MAX} bytes, this one has {size}");
        Err(fields.problem("input_tuple_size", what))
    }
}

fn is_channel(name: &str) -> bool {
    (1..=CHANNEL_BYTES_MAX).contains(&name.len()) && !name.chars().any(char::is_control)
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<PlayedDescription, Problem> {
    let path = fields.own_path("played")?;
    let Some(channel) = fields.text("channel", CHANNEL_BYTES_MAX)? else {
        return Err(fields.problem("src", "played: channel is missing"));
    };
    if !is_channel(channel) {
        let what = format!(
            "played: channel must be 1 to {CHANNEL_BYTES_MAX} bytes without control characters"
        );
        return Err(fields.problem("src", what));
    }
    let channel = channel.to_owned();
    Ok(PlayedDescription { path, channel })
}
