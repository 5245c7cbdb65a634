//! Tests of the kinds of sources: constructors and their refusals, and the forms of devices that can be brought to rest.

mod bus;
mod ports;

use super::rest::{Bytes, Resting};
use super::{
    GpioDescription, GpioDirection, I2cDescription, I2cTransfer, LinesDescription,
    PlayedDescription, PwmDescription, SourceDescription, TAGS, constructors, is_constructor,
    taken,
};

/// One device of each form.
fn devices() -> Vec<SourceDescription> {
    vec![
        SourceDescription::Path("/dev/motor".into()),
        SourceDescription::Attribute("/sys/x y".into()),
        SourceDescription::Fifo("/run/x".into()),
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
        SourceDescription::I2c(I2cDescription {
            path: "/dev/i2c-2".into(),
            address: 0x48,
            register: 0x14,
            register_bytes: 1,
            transfer: I2cTransfer::Raw,
            write_transfer: I2cTransfer::Raw,
            readable: true,
            once: false,
        }),
        SourceDescription::Played(PlayedDescription {
            path: "/run/player.sock".into(),
            channel: "motors/M3".to_owned(),
        }),
    ]
}

#[test]
fn every_device_comes_back_from_its_form() {
    let mut tags = Vec::new();
    for device in devices() {
        assert_eq!(device.resting(), Resting::Device);
        let mut form = Vec::new();
        device.put(&mut form).expect("a device");
        tags.push(Some(form[0]));
        let mut bytes = Bytes(&form);
        assert_eq!(SourceDescription::take(&mut bytes).as_ref(), Some(&device));
        assert!(bytes.0.is_empty());
        for size in 0..form.len() {
            assert_eq!(SourceDescription::take(&mut Bytes(&form[..size])), None);
        }
    }
    let known: Vec<_> = TAGS.iter().copied().filter(Option::is_some).collect();
    assert_eq!(tags, known, "a form without an example, or two of one");
}

#[test]
fn what_cannot_be_written_has_no_form() {
    let mut line = devices().remove(4);
    let SourceDescription::Gpio(gpio) = &mut line else {
        panic!("not a line")
    };
    gpio.direction = GpioDirection::In;
    for source in [line, SourceDescription::Newest("x".into())] {
        assert_eq!(source.resting(), Resting::ReadOnly);
        assert_eq!(source.put(&mut Vec::new()), None);
    }
    assert_eq!(taken(0, &mut Bytes(&[0; 64])), None);
}

#[test]
fn the_words_of_constructors_are_those_of_the_manual() {
    let manual = include_str!("../../../docs/user/config.md");
    let row = manual.lines().find_map(|line| {
        let (words, what) = line.strip_prefix("| `")?.split_once("` | ")?;
        (what == "constructors of sources |").then_some(words)
    });
    let mut written: Vec<_> = row.expect("a row of words").split(' ').collect();
    written.sort_unstable();
    let mut known = constructors();
    known.sort_unstable();
    assert_eq!(written, known);
    known.dedup();
    assert_eq!(written, known, "two constructors have the same word");
    for word in written {
        assert!(is_constructor(word.as_bytes()), "{word}");
    }
    for word in ["", "path", "trikfs", "newest", "several", "evde"] {
        assert!(!is_constructor(word.as_bytes()), "{word}");
    }
}
