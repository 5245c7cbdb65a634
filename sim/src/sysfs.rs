//! The attributes of the controller: servos (PWM), measured pulses, LEDs and GPIO, and what their texts mean.

use crate::attributes::Attributes;
use crate::limits;
use crate::limits::GPIO_COUNT;
use crate::machine::Machine;
use crate::mistake::Mistake;
use std::io;

/// Chip and channel of S1 to S6.
const SERVOS: [(u8, u8); 6] = [(2, 0), (1, 0), (0, 0), (3, 1), (5, 0), (5, 1)];
/// Ports that can measure pulses, and their channels.
const CAPTURES: [(&str, &str); 3] = [
    ("S1", "sys/class/pwm/ecap_cap.2"),
    ("S2", "sys/class/pwm/ecap_cap.1"),
    ("S3", "sys/class/pwm/ecap_cap.0"),
];
/// Where a person says which pulses come in.
const PULSES: &str = "control/pulses";
const LEDS: [&str; 2] = ["led_green", "led_red"];
/// Lines that the controller has exported or that its start exports, with their levels.
const LINES: [(u32, &str); 7] = [
    (94, "0"),
    (35, "0"),
    (36, "0"),
    (37, "0"),
    (62, "1"),
    // Three cells.
    (56, "1"),
    (30, "0"),
];
/// The supply of the power motors.
const MOTOR_POWER: u32 = 62;

/// Makes all attributes.
pub fn make(attributes: &mut Attributes) -> io::Result<()> {
    for (chip, channel) in SERVOS {
        let chip = format!("sys/class/pwm/pwmchip{chip}");
        attributes.make(&format!("{chip}/export"), "")?;
        attributes.make(&format!("{chip}/unexport"), "")?;
        for name in ["enable", "duty_cycle", "period"] {
            attributes.make(&format!("{chip}/pwm{channel}/{name}"), "0")?;
        }
    }
    for (port, folder) in CAPTURES {
        attributes.make(&format!("{PULSES}/{port}"), "")?;
        for name in ["capture", "freq", "duty_percentage"] {
            attributes.make(&format!("{folder}/{name}"), "0")?;
        }
        measure(attributes, port, folder)?;
    }
    for led in LEDS {
        attributes.make(&format!("sys/class/leds/{led}/brightness"), "0")?;
        attributes.make(&format!("sys/class/leds/{led}/max_brightness"), "1")?;
    }
    // The loudspeaker's amplifier, as the boot scripts leave it; nothing is heard here.
    attributes.make("sys/bus/i2c/devices/2-0050/volume", "20")?;
    attributes.make("sys/class/gpio/export", "")?;
    attributes.make("sys/class/gpio/unexport", "")?;
    for (number, level) in LINES {
        export(attributes, number, level)?;
    }
    Ok(())
}

fn export(attributes: &mut Attributes, number: u32, level: &str) -> io::Result<()> {
    let folder = format!("sys/class/gpio/gpio{number}");
    if attributes.root().join(&folder).exists() {
        return Ok(());
    }
    attributes.make(&format!("{folder}/value"), level)?;
    attributes.make(&format!("{folder}/active_low"), "0")?;
    attributes.make(&format!("{folder}/direction"), "in")
}

/// The file `name` was written; whether it is one of ours.
pub fn changed(attributes: &mut Attributes, name: &str, machine: &mut Machine) -> bool {
    let is_at = |(port, folder): &&(&str, &str)| {
        name == format!("{PULSES}/{port}") || name == format!("{folder}/capture")
    };
    if let Some((port, folder)) = CAPTURES.iter().find(is_at) {
        // A board without a folder has nobody who could be told.
        let _ = measure(attributes, port, folder);
        return true;
    }
    let Some(path) = name.strip_prefix("sys/class/") else {
        return false;
    };
    let parts: Vec<&str> = path.split('/').collect();
    match parts[..] {
        ["pwm", chip, channel, name] => servo(attributes, chip, channel, name, machine),
        ["leds", led, "brightness"] => {
            let is_on = number(attributes, name).is_some_and(|value| value > 0);
            match led {
                "led_green" => machine.led.0 = is_on,
                _ => machine.led.1 = is_on,
            }
        }
        ["gpio", "export"] => {
            if let Some(line) = number(attributes, name).filter(|line| *line < GPIO_COUNT) {
                // If it cannot be made, the writer does not find it: there is nobody else to tell.
                let _ = export(attributes, line, "0");
            }
        }
        ["gpio", line, "direction"] => {
            let level = match attributes.line(name).as_deref() {
                Some("high") => "1",
                Some("low" | "out") => "0",
                _ => return true,
            };
            let _ = attributes.write(&format!("sys/class/gpio/{line}/value"), level);
        }
        ["gpio", line, "value"] if line == format!("gpio{MOTOR_POWER}") => {
            if let Some(level) = number(attributes, name) {
                machine.has_motor_power = level != 0;
            }
        }
        _ => {}
    }
    true
}

fn servo(attributes: &Attributes, chip: &str, channel: &str, name: &str, machine: &mut Machine) {
    let is_this = |servo: &(u8, u8)| {
        chip == format!("pwmchip{}", servo.0) && channel == format!("pwm{}", servo.1)
    };
    let Some(index) = SERVOS.iter().position(is_this) else {
        return;
    };
    let path = format!("sys/class/pwm/{chip}/{channel}/{name}");
    // A text that is no number changes nothing, as an attribute would refuse it.
    let Some(value) = number(attributes, &path) else {
        return;
    };
    let pwm = &mut machine.pwm[index];
    match name {
        "enable" => pwm.enable = value != 0,
        "duty_cycle" => pwm.duty_ns = value,
        "period" => pwm.period_ns = value,
        _ => {}
    }
}

/// Shows in the attributes what the channel measures: the pulses that come in, if it is to measure.
fn measure(attributes: &Attributes, port: &str, folder: &str) -> io::Result<()> {
    let control = format!("{PULSES}/{port}");
    let complaint = format!("{control}.error");
    let pulses = match attributes.line(&control).as_deref().map(pulses) {
        Some(Err(reason)) => return attributes.appear(&complaint, &reason.to_string()),
        Some(Ok(pulses)) => pulses,
        None => None,
    };
    attributes.remove(&complaint);
    let captures = number(attributes, &format!("{folder}/capture")) == Some(1);
    let (frequency, duty) = pulses.filter(|_| captures).map_or_else(
        || ("-1".to_owned(), "-1".to_owned()),
        |(hz, percent)| (hz.to_string(), percent.to_string()),
    );
    // The same files, since who reads them may have them open.
    attributes.write(
        &format!("{folder}/freq"),
        &format!("{frequency},{frequency},{frequency}"),
    )?;
    attributes.write(&format!("{folder}/duty_percentage"), &duty)
}

/// Frequency and duty from a line; none for `0`.
fn pulses(line: &str) -> Result<Option<(u32, u32)>, Mistake> {
    let numbers: Option<Vec<u32>> = line.split(' ').map(|word| word.parse().ok()).collect();
    match numbers.as_deref() {
        Some([0]) => Ok(None),
        Some(&[hz, percent]) if (1..=limits::PULSES_HZ_MAX).contains(&hz) && percent <= 100 => {
            Ok(Some((hz, percent)))
        }
        _ => Err(Mistake::Pulses(line.to_owned())),
    }
}

fn number(attributes: &Attributes, name: &str) -> Option<u32> {
    attributes.line(name)?.parse().ok()
}
