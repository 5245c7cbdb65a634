//! What brings one actuator to rest when the daemon is dead, and its form as bytes of the ledger.
//!
//! Owns that form, which never leaves the machine. The bytes come from a process that may have died of anything:
//! decoding believes nothing, and every number is within the limits of a configuration.
//!
//! ```text
//! action:  length u32 | timeout_ms u32 | kind u8 | fields of the kind | tuple
//! text:    length u16 | bytes
//! ```
//! All numbers are little endian. The length counts what follows it.

use crate::limits;
use config::description::{
    GpioDescription, GpioDirection, I2cDescription, I2cTransfer, LinesDescription, PwmDescription,
    SourceDescription,
};
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

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

const PATH: u8 = 1;
const ATTRIBUTE: u8 = 2;
const FIFO: u8 = 3;
const I2C: u8 = 4;
const PWM: u8 = 5;
const GPIO: u8 = 6;
const LINES: u8 = 7;

const TRANSFERS: [I2cTransfer; 4] = [
    I2cTransfer::Byte,
    I2cTransfer::Word,
    I2cTransfer::Block,
    I2cTransfer::Raw,
];
const DIRECTIONS: [GpioDirection; 3] =
    [GpioDirection::Out, GpioDirection::High, GpioDirection::Low];

/// The actions as bytes; None if one of them goes to something that is no device, or does not fit.
pub(super) fn encode(actions: &[RestAction]) -> Option<Vec<u8>> {
    let mut all = Vec::new();
    for action in actions {
        let mut out = action.timeout_ms.to_le_bytes().to_vec();
        encode_sink(&action.sink, &mut out)?;
        out.extend_from_slice(&action.tuple);
        all.extend_from_slice(&u32::try_from(out.len()).ok()?.to_le_bytes());
        all.append(&mut out);
    }
    Some(all)
}

fn encode_sink(sink: &SourceDescription, out: &mut Vec<u8>) -> Option<()> {
    match sink {
        SourceDescription::Path(path) => {
            out.push(PATH);
            put_path(path, out)?;
        }
        SourceDescription::Attribute(path) => {
            out.push(ATTRIBUTE);
            put_path(path, out)?;
        }
        SourceDescription::Fifo(path) => {
            out.push(FIFO);
            put_path(path, out)?;
        }
        SourceDescription::I2c(i2c) => {
            out.push(I2C);
            put_path(&i2c.path, out)?;
            out.extend_from_slice(&i2c.address.to_le_bytes());
            out.extend_from_slice(&i2c.register.to_le_bytes());
            out.push(i2c.register_bytes);
            out.push(position(&TRANSFERS, &i2c.write_transfer)?);
        }
        SourceDescription::Pwm(pwm) => {
            out.push(PWM);
            put_path(&pwm.chip, out)?;
            out.extend_from_slice(&pwm.channel.to_le_bytes());
            out.extend_from_slice(&pwm.period_ns.to_le_bytes());
        }
        SourceDescription::Gpio(gpio) => {
            out.push(GPIO);
            put_path(&gpio.base, out)?;
            out.extend_from_slice(&gpio.number.to_le_bytes());
            out.push(position(&DIRECTIONS, &gpio.direction)?);
            out.push(gpio.active_low.into());
        }
        SourceDescription::Lines(lines) => {
            out.push(LINES);
            put_path(&lines.path, out)?;
            put_path(lines.input.as_ref()?, out)?;
        }
        // Made up here, or another node, whose own device is what counts.
        _ => return None,
    }
    Some(())
}

fn position<T: PartialEq>(all: &[T], one: &T) -> Option<u8> {
    all.iter()
        .position(|known| known == one)
        .and_then(|at| u8::try_from(at).ok())
}

fn put_path(path: &Path, out: &mut Vec<u8>) -> Option<()> {
    let bytes = path.as_os_str().as_bytes();
    out.extend_from_slice(&u16::try_from(bytes.len()).ok()?.to_le_bytes());
    out.extend_from_slice(bytes);
    Some(())
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
    let sink = match bytes.u8()? {
        PATH => SourceDescription::Path(bytes.path()?),
        ATTRIBUTE => SourceDescription::Attribute(bytes.path()?),
        FIFO => SourceDescription::Fifo(bytes.path()?),
        I2C => SourceDescription::I2c(decode_i2c(&mut bytes)?),
        PWM => SourceDescription::Pwm(PwmDescription {
            chip: bytes.path()?,
            channel: bytes.u32(config::limits::PWM_CHANNEL_MAX)?,
            period_ns: bytes.u32(u32::MAX)?,
        }),
        GPIO => SourceDescription::Gpio(GpioDescription {
            base: bytes.path()?,
            number: bytes.u32(config::limits::GPIO_NUMBER_MAX)?,
            direction: *DIRECTIONS.get(usize::from(bytes.u8()?))?,
            active_low: match bytes.u8()? {
                0 => false,
                1 => true,
                _ => return None,
            },
        }),
        LINES => SourceDescription::Lines(LinesDescription {
            path: bytes.path()?,
            input: Some(bytes.path()?),
            start: None,
            stop: None,
            answer: None,
            are_pictures: false,
        }),
        _ => return None,
    };
    let tuple = bytes.0;
    (tuple.len() <= config::limits::TUPLE_BYTES_MAX).then(|| RestAction {
        sink,
        tuple: tuple.to_vec(),
        timeout_ms,
    })
}

fn decode_i2c(bytes: &mut Bytes<'_>) -> Option<I2cDescription> {
    let path = bytes.path()?;
    let address = bytes.u16().filter(|address| *address < 128)?;
    let register = bytes.u16()?;
    let register_bytes = bytes.u8().filter(|count| (1..=2).contains(count))?;
    let transfer = *TRANSFERS.get(usize::from(bytes.u8()?))?;
    Some(I2cDescription {
        path,
        address,
        register,
        register_bytes,
        transfer,
        write_transfer: transfer,
        readable: true,
        once: false,
    })
}

/// What is left to decode.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*first)
    }

    fn u8(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    fn u32(&mut self, max: u32) -> Option<u32> {
        let number = self.array().map(u32::from_le_bytes)?;
        (number <= max).then_some(number)
    }

    fn path(&mut self) -> Option<PathBuf> {
        let length = usize::from(self.u16()?);
        let (path, rest): (&'a [u8], _) = self.0.split_at_checked(length)?;
        self.0 = rest;
        let fits = !path.is_empty() && path.len() < libc::PATH_MAX as usize && !path.contains(&0);
        fits.then(|| PathBuf::from(OsStr::from_bytes(path)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            sink: SourceDescription::Node("motor".to_owned()),
            tuple: vec![0],
            timeout_ms: 1,
        };
        assert_eq!(encode(std::slice::from_ref(&nobody)), None);
        assert!(!nobody.can_be_noted());
        let mut far = one_of_each().swap_remove(0);
        assert!(far.can_be_noted());
        far.sink = SourceDescription::Path("/x".repeat(5000).into());
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
