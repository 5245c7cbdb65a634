//! `pwm{ chip, channel, period_ns }`: pulses of a PWM channel.
//!
//! Owns its keys, and which of them a rest needs.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::{Form, Rest, put_path};
use crate::fields::Fields;
use crate::limits::PWM_CHANNEL_MAX;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// `pwm{ chip = ..., channel = 0, period_ns = ... }`: a tuple is the pulse in ns as a little-endian u32.
#[derive(Clone, Debug, PartialEq)]
pub struct PwmDescription {
    /// Directory of the chip, `/sys/class/pwm/pwmchipN`.
    pub chip: PathBuf,
    /// Number within the chip.
    pub channel: u32,
    /// Nanoseconds from pulse to pulse.
    pub period_ns: u32,
}

impl Kind for PwmDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "pwm",
        keys: &["chip", "channel", "period_ns"],
        read,
    }];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 5,
        put: |pwm, out| {
            put_path(&pwm.chip, out)?;
            out.extend_from_slice(&pwm.channel.to_le_bytes());
            out.extend_from_slice(&pwm.period_ns.to_le_bytes());
            Some(())
        },
        take: |bytes| {
            Some(Self {
                chip: bytes.path()?,
                channel: bytes.u32(PWM_CHANNEL_MAX)?,
                period_ns: bytes.u32(u32::MAX)?,
            })
        },
    });

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.chip);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.chip]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::State
    }

    fn keeps_what_is_written(&self) -> bool {
        true
    }

    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(Some(4))
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<PwmDescription, Problem> {
    let Some(chip) = fields.get("chip") else {
        let reason = "pwm: chip is missing, for example chip = '/sys/class/pwm/pwmchip0'";
        return Err(fields.problem("src", reason));
    };
    let chip = fields.absolute("chip", chip)?;
    let channel = fields.whole("channel", 0, PWM_CHANNEL_MAX)?;
    // The kernel takes up to 2^63, but a tuple holds 32 bits.
    let Some(period_ns) = fields.whole("period_ns", 1, u32::MAX)? else {
        return Err(fields.problem("src", "pwm: period_ns is missing"));
    };
    Ok(PwmDescription {
        chip,
        channel: channel.unwrap_or(0),
        period_ns,
    })
}
