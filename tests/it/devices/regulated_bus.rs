//! A motor on a bus that a regulator drives: who has the last word, and what becomes of it when the bus fails.

use crate::mount_on;
use harness::{Board, I2cBus, Mount, eventually};
use std::time::Duration;

const MOTOR: (u16, u16) = (0x48, 0x14);

/// A file plays the encoder.
const CONFIG: &str = "
trikfs = {
  encoder = { src = '$DIR/encoder', format = 'i8 speed' },
  motor = {
    src = i2c{ '$DIR/bus', address = 0x48, register = 0x14, transfer = 'byte', readable = false },
    format = 'i8 power', rest = 0,
    attributes = {
      speed = {
        src = regulator{ feedback = 'trikfs:encoder', actuator = 'trikfs:motor' },
        poll_ms = 5, format = 'i8 speed',
        converter = function(a_s, a, b_s, b) ba.i8(b, 0, ba.i8(a, 0)) end,
        write_converter = function(a_s, a, b_s, b) ba.i8(b, 0, ba.i8(a, 0)) end,
      },
    },
  },
}";

fn mounted() -> Option<(I2cBus, Mount)> {
    let board = Board::new();
    board.file("encoder", [1]);
    let bus = I2cBus::start(&board.path("bus"), MOTOR.0);
    mount_on(board, CONFIG).map(|m| (bus, m))
}

fn power(bus: &I2cBus) -> Option<u8> {
    bus.behaviour().registers.get(&MOTOR).copied()
}

/// Steps of the regulator that have begun and ended, whatever they did.
fn some_steps(m: &Mount) {
    m.python(
        "
stamp = lambda: os.getxattr(M + '/motor/speed', 'user.trik.time_ns')
for _ in range(4):
    before = stamp()
    eventually(lambda: stamp() != before)
",
    );
}

#[test]
fn a_regulator_never_writes_behind_who_takes_its_motor() {
    let Some((bus, m)) = mounted() else {
        return;
    };
    // Long enough that a write meets a step of the regulator on the bus.
    bus.behaviour().delay = Duration::from_millis(15);
    for round in 0..12 {
        m.write("motor/speed", "50").expect("an order");
        eventually("the order", || power(&bus) == Some(50));
        m.write("motor/value", "7").expect("a power");
        some_steps(&m);
        assert_eq!(power(&bus), Some(7), "round {round}");
    }
}

#[test]
fn a_rest_that_the_bus_did_not_take_comes_when_it_does() {
    let Some((bus, m)) = mounted() else {
        return;
    };
    m.write("motor/speed", "50").expect("an order");
    eventually("the order", || power(&bus) == Some(50));
    let present = std::mem::take(&mut bus.behaviour().present);
    eventually("a reason", || m.text("motor/fault").contains("no answer"));
    some_steps(&m);
    assert_eq!(power(&bus), Some(50), "nobody can reach it");
    bus.behaviour().present = present;
    eventually("rest", || power(&bus) == Some(0));
    // The reason stays until somebody drives the motor again.
    some_steps(&m);
    assert!(m.text("motor/fault").contains("no answer"));
    m.write("motor/value", "9").expect("a power");
    some_steps(&m);
    assert_eq!(power(&bus), Some(9));
    assert_eq!(m.text("motor/fault"), "");
}
