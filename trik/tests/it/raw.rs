//! Buses and input devices as they are, from programs on a virtual robot.

use crate::programs::Reachable;
use crate::rig::Home;
use harness::eventually;
use std::sync::Arc;

/// With an infrared camera on bus 1.
const ROBOT: &str = "local trik = include 'trik.lua'
trikfs = trik.robot { { port = 'ir_camera' } }
";

/// A word of the camera's registers is written and read back, one of its memory is read; what belongs to others is
/// refused, and so is what cannot be.
const I2C_JS: &str = "
var camera = brick.i2c(1, 0x33, 2), words = brick.smBusI2c(1, 0x33);
camera.send(0x800D, 0x1902, 'w');
print(camera.readX(0x800D, 2).join(' '), ' ', camera.read(0x800D, 'w'), ' ', camera.read(0x800D));
function refused(attempt) { try { attempt(); print('done'); } catch (error) { print(error.name, ': ', error.message); } }
refused(function () { brick.i2c(2, 0x48).send(0x14, 50); });
refused(function () { brick.i2c(2, 0x21).read(1); });
refused(function () { brick.i2c(3, 0x21); });
refused(function () { brick.i2c(1, 2); });
refused(function () { words.read(0x100); });
refused(function () { camera.readX(0, 8193); });
";
const I2C_PY: &str = "
camera = brick.i2c(1, 0x33, 2)
camera.send(0x800D, 0x1903, 'w')
print(camera.readX(0x800D, 2), camera.read(0x800D, 'w'), camera.read(0x800D))
for attempt in (lambda: brick.i2c(2, 0x48).send(0x14, 50), lambda: brick.i2c(2, 0x21).read(1),
                lambda: brick.i2c(3, 0x21).read(1), lambda: brick.i2c(1, 2), lambda: brick.smBusI2c(1, 0x33).read(256)):
    try:
        attempt()
        print('done')
    except (OSError, ValueError) as error:
        print(type(error).__name__)
";

fn with_camera() -> Option<Reachable> {
    let home = Arc::new(Home::new()?);
    let config = home.0.file("camera.lua", ROBOT);
    let config = config.to_str().expect("UTF-8").to_owned();
    Some(Reachable::beside(&home, &["--config", &config]))
}

#[test]
fn programs_speak_with_any_device_on_a_bus_but_with_those_of_others() {
    let Some(one) = with_camera() else { return };
    let output = one.run("i2c.js", I2C_JS);
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let lines: Vec<&str> = output.stdout.lines().collect();
    // High byte first on the wire; words that are read take the first byte for the low one.
    assert_eq!(lines[0], format!("25 2 {} 25", 0x0219));
    assert!(
        lines[1].contains("Permission denied") && lines[1].contains("log"),
        "{lines:?}"
    );
    assert!(lines[2].contains("no answer from 0x21"), "{lines:?}");
    assert!(
        lines[3].starts_with("RangeError: there is no bus 3"),
        "{lines:?}"
    );
    assert!(
        lines[4].starts_with("RangeError: address 2 is not"),
        "{lines:?}"
    );
    assert!(
        lines[5].starts_with("RangeError: register 256 is not"),
        "{lines:?}"
    );
    assert!(lines[6].starts_with("RangeError: 8193 bytes"), "{lines:?}");
    assert_eq!(one.robot.duty(1).expect("the bus"), 0);
    let log = one.robot.log();
    assert!(
        log.contains("the device at address 0x48 has nodes or a driver of its own"),
        "{log}"
    );

    let output = one.run("i2c.py", I2C_PY);
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let expected = format!(
        "[25, 3] {} 25\nPermissionError\nOSError\nFileNotFoundError\nValueError\nValueError\n",
        0x0319
    );
    assert_eq!(output.stdout, expected);

    // What is no transfer is refused, and the other files of the node say what to do.
    let device = one.robot.path("i2c/bus1/device");
    let errno = |error: std::io::Error| error.raw_os_error();
    assert_eq!(
        std::fs::write(&device, "x").map_err(errno),
        Err(Some(libc::EINVAL))
    );
    assert_eq!(one.robot.errno("i2c/bus1/value"), libc::EINVAL);
}

const EVENTS_JS: &str = "
var keys = brick.eventDevice('/dev/input/by-path/platform-soc@1c00000:gpio-keys-event');
keys.on.connect(function (event, code, value, time) { if (value == 1) print('all ', event, ' ', code, ' ', time > 0); });
keys.onEvent(1).on.connect(function (code, value) { if (value == 1) print('key ', code); });
keys.onEvent(1).code(103).on.connect(function (value) {
    if (value == 1) {
        print('up');
        brick.stopEventDevice('/dev/input/by-path/platform-soc@1c00000:gpio-keys-event');
        script.quit();
    }
});
print(brick.eventDevice('/dev/input/event0'));
print('listens');
script.run();
";
const EVENTS_PY: &str = "
keys = brick.eventDevice('/dev/input/by-path/platform-soc@1c00000:gpio-keys-event')
keys.on.connect(lambda event, code, value, time: value == 1 and print('all', event, code, time > 0))
keys.onEvent(1).on.connect(lambda code, value, time: value == 1 and print('key', code))
keys.onEvent(1).code(103).on.connect(lambda value, time: value == 1 and (print('up'), script.quit()))
print(brick.eventDevice('/dev/input/event0'))
print('listens')
script.run()
";

#[test]
fn programs_hear_every_event_of_an_input_device() {
    let Some(one) = Reachable::new() else { return };
    let press = |words: &str| {
        let control = one.robot.devices.join("control/keys");
        std::fs::write(control, format!("{words}\n")).expect("keys");
    };
    for (name, text, expected) in [
        (
            "events.js",
            EVENTS_JS,
            "null\nlistens\nall 1 103 true\nkey 103\nup",
        ),
        (
            "events.py",
            EVENTS_PY,
            "None\nlistens\nall 1 103 True\nkey 103\nup",
        ),
    ] {
        let mut running = one.spawn(name, text);
        running.says("listens\n");
        // A press counts from when the program has the device open.
        eventually("the program hears a key", || {
            press("press up");
            press("release up");
            running.said().contains("up\n")
        });
        assert_eq!(running.code(), Some(0), "{name}");
        let said = running.said();
        let printed: Vec<&str> = said
            .lines()
            .filter(|line| !line.starts_with("trik: "))
            .collect();
        assert!(printed.join("\n").starts_with(expected), "{name}: {said}");
    }
}
