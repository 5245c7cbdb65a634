//! What brings one actuator to rest when the daemon is dead, and its form as bytes of the ledger.
//!
//! Owns that form, which never leaves the machine; the fields of a device are those of its kind of source. The bytes come
//! from a process that may have died of anything: decoding believes nothing, and every number is within the limits of a configuration.
//!
//! ```text
//! action:  length u32 | timeout_ms u32 | kind u8 | fields of the kind | tuple
//! ```
//! All numbers are little endian. The length counts what follows it.

use crate::limits;
use config::description::SourceDescription;
use config::source::rest::Bytes;

/// One write that brings an actuator to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RestAction {
    /// The device itself, not a file of the tree: at that moment nobody serves the tree.
    pub sink: SourceDescription,
    /// One tuple, as the device takes it.
    pub tuple: Vec<u8>,
    /// How long the device may take.
    pub timeout_ms: u32,
}

impl RestAction {
    /// Whether it can stand in the ledger; one that cannot would make the whole list unreadable.
    pub fn can_be_noted(&self) -> bool {
        let noted = encode(std::slice::from_ref(self));
        noted.is_some_and(|bytes| decode(&bytes).is_some())
    }
}

/// The actions as bytes; None if one of them goes to something that is no device, or does not fit.
pub(super) fn encode(actions: &[RestAction]) -> Option<Vec<u8>> {
    let mut all = Vec::new();
    for action in actions {
        let mut out = action.timeout_ms.to_le_bytes().to_vec();
        action.sink.put(&mut out)?;
        out.extend_from_slice(&action.tuple);
        all.extend_from_slice(&u32::try_from(out.len()).ok()?.to_le_bytes());
        all.append(&mut out);
    }
    Some(all)
}

/// Nothing if the bytes are not exactly a list of actions.
pub(super) fn decode(mut bytes: &[u8]) -> Option<Vec<RestAction>> {
    let mut actions = Vec::new();
    while !bytes.is_empty() {
        let (length, rest) = bytes.split_first_chunk()?;
        let (action, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        if actions.len() == limits::REST_ACTIONS_MAX {
            return None;
        }
        actions.push(decode_one(Bytes(action))?);
        bytes = rest;
    }
    Some(actions)
}

fn decode_one(mut bytes: Bytes<'_>) -> Option<RestAction> {
    let timeout_ms = bytes.u32(config::limits::PERIOD_MS_MAX)?;
    let sink = SourceDescription::take(&mut bytes)?;
    let tuple = bytes.0;
    (tuple.len() <= config::limits::TUPLE_BYTES_MAX).then(|| RestAction {
        sink,
        tuple: tuple.to_vec(),
        timeout_ms,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::description::{
        GpioDescription, GpioDirection, I2cDescription, I2cTransfer, LinesDescription,
        PwmDescription,
    };
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::path::Path;

    /// One action of every kind.
    fn one_of_each() -> Vec<RestAction> {
        let i2c = I2cDescription {
            path: "/dev/i2c-2".into(),
            address: 0x48,
            register: 0x14,
            register_bytes: 1,
            transfer: I2cTransfer::Word,
            write_transfer: I2cTransfer::Word,
            readable: true,
            once: false,
        };
        let sinks = [
            SourceDescription::Path("/dev/motor".into()),
            SourceDescription::Attribute("/sys/x y".into()),
            SourceDescription::Fifo(OsStr::from_bytes(b"/run/\xff").into()),
            SourceDescription::I2c(i2c),
            SourceDescription::Pwm(PwmDescription {
                chip: "/sys/class/pwm/pwmchip2".into(),
                channel: 1,
                period_ns: 20_000_000,
            }),
            SourceDescription::Gpio(GpioDescription {
                base: "/sys/class/gpio".into(),
                number: 56,
                direction: GpioDirection::Low,
                active_low: true,
            }),
            SourceDescription::Lines(LinesDescription {
                path: "/run/out".into(),
                input: Some("/run/in".into()),
                start: None,
                stop: None,
                answer: None,
                are_pictures: false,
            }),
        ];
        let action = |(sink, size)| RestAction {
            sink,
            tuple: vec![7; size],
            timeout_ms: 1000,
        };
        sinks.into_iter().zip(0..).map(action).collect()
    }

    #[test]
    fn every_kind_of_device_comes_back_as_it_was() {
        let actions = one_of_each();
        let bytes = encode(&actions).expect("devices");
        assert_eq!(decode(&bytes), Some(actions));
        assert_eq!(decode(&[]), Some(vec![]));
    }

    #[test]
    fn what_is_no_device_has_no_form() {
        let nobody = RestAction {
            sink: SourceDescription::Node("motor".into()),
            tuple: vec![0],
            timeout_ms: 1,
        };
        assert_eq!(encode(std::slice::from_ref(&nobody)), None);
        assert!(!nobody.can_be_noted());
        let mut far = one_of_each().swap_remove(0);
        assert!(far.can_be_noted());
        far.sink = SourceDescription::Path(Path::new(&"/x".repeat(5000)).into());
        assert!(!far.can_be_noted());
    }

    #[test]
    fn any_bytes_decode_without_panic_and_only_to_what_can_be() {
        let good = encode(&one_of_each()).expect("devices");
        for at in 0..good.len() {
            for change in [1, 0x80, 0xff] {
                let mut bytes = good.clone();
                bytes[at] ^= change;
                if let Some(actions) = decode(&bytes) {
                    assert_eq!(encode(&actions), Some(bytes));
                }
            }
            // Cut at the end of an action it is a shorter list.
            if let Some(actions) = decode(&good[..at]) {
                assert_eq!(actions, one_of_each()[..actions.len()]);
            }
        }
        assert_eq!(decode(&u32::MAX.to_le_bytes()), None);
        let one = encode(&one_of_each()[..1]).expect("a device");
        assert!(decode(&one.repeat(limits::REST_ACTIONS_MAX)).is_some());
        assert_eq!(decode(&one.repeat(limits::REST_ACTIONS_MAX + 1)), None);
    }
}
