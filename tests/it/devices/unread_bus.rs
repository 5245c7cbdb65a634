//! A bus whose nodes are sampled by the clock: what it carries while nobody needs their samples, and after that.

use crate::mount_on;
use harness::i2c_bus::Transaction;
use harness::{Board, I2cBus, Mount, eventually};
use std::io::Read;
use std::os::unix::fs::FileExt;

const ADDRESS: u16 = 0x48;
/// Of the node that is always sampled: the clock of these tests.
const ALWAYS: u16 = 0x10;
const LIGHT: u16 = 0x20;
const MOTOR: u16 = 0x30;
const PAIR: u16 = 0x40;

const CONFIG: &str = "
    local function at(register, transfer, more)
      return i2c{ '$DIR/bus', address = 0x48, register = register, transfer = transfer, readable = more }
    end
    local same = function(a_s, a, b_s, b) ba.i8(b, 0, ba.i8(a, 0)) end
    trikfs = {
      kept = { src = at(0x10, 'word'), format = 'u16 raw', poll_ms = 10, always = true },
      light = { src = at(0x20, 'word'), format = 'u16 raw', poll_ms = 10 },
      at_once = { src = 'newest:light', format = 'u16 raw' },
      darkness = { src = 'newest:light', format = 'u16 raw', poll_ms = 10 },
      pair = { src = at(0x40, 'word'), format = 'u8 a, u8 b', poll_ms = 10 },
      motor = {
        src = at(0x30, 'byte', false), format = 'i8 power', rest = 0,
        attributes = {
          speed = {
            src = regulator{ feedback = 'trikfs:encoder', actuator = 'trikfs:motor' }, poll_ms = 10, format = 'i8 speed',
            converter = same, write_converter = same,
          },
        },
      },
      encoder = { src = at(0x50, 'byte'), format = 'i8 speed' },
    }";

const ENCODER: u16 = 0x50;

fn mounted() -> Option<(I2cBus, Mount)> {
    let board = Board::new();
    let bus = I2cBus::start(&board.path("bus"), ADDRESS);
    bus.set(ADDRESS, LIGHT, &[7, 0]);
    bus.set(ADDRESS, PAIR, &[1, 2]);
    mount_on(board, CONFIG).map(|m| (bus, m))
}

fn state(m: &Mount, node: &str) -> String {
    let status = m.text("status");
    let mut lines = status.lines().map(|line| line.split(' '));
    let line = lines.find_map(|mut words| (words.next() == Some(node)).then(|| words.next()));
    line.flatten().unwrap_or_default().to_owned()
}

/// Waits until the clock has stopped for this node.
fn at_rest(m: &Mount, node: &str) {
    eventually("rest", || state(m, node) == "ready");
}

/// How often a register was asked for among these.
fn asked_among(seen: &[Transaction], register: u16) -> usize {
    let of_it = seen
        .iter()
        .filter(|one| u16::from(one.written[0]) == register);
    of_it.count()
}

/// How often a register was asked for while the node that is always sampled was so often.
fn asked_during(bus: &I2cBus, samples: usize, register: u16) -> usize {
    let (mut clock, mut asked) = (0, 0);
    bus.seen();
    eventually("samples of the node that is always sampled", || {
        let seen = bus.seen();
        clock += asked_among(&seen, ALWAYS);
        asked += asked_among(&seen, register);
        clock >= samples
    });
    asked
}

#[test]
fn nothing_is_asked_of_a_sensor_that_nobody_reads() {
    let Some((bus, m)) = mounted() else { return };
    at_rest(&m, "light");
    for register in [LIGHT, PAIR, ENCODER] {
        assert_eq!(
            asked_during(&bus, 60, register),
            0,
            "register {register:#x}"
        );
    }
    assert_eq!(state(&m, "kept"), "sampled");
}

#[test]
fn a_reader_is_served_at_its_pace_and_the_traffic_ends_after_it() {
    let Some((bus, m)) = mounted() else { return };
    at_rest(&m, "light");
    let file = m.open("light/bin_data");
    let asked = asked_during(&bus, 60, LIGHT);
    assert!((55..=65).contains(&asked), "{asked} samples instead of 60");
    assert_eq!(state(&m, "light"), "sampled");
    bus.seen();
    drop(file);
    at_rest(&m, "light");
    let asked = asked_among(&bus.seen(), LIGHT);
    assert!(
        asked >= 15,
        "it goes on for a second, for a reader that comes back: {asked}"
    );
    assert_eq!(asked_during(&bus, 60, LIGHT), 0);
}

#[test]
fn the_first_read_after_a_rest_is_of_now() {
    let Some((bus, m)) = mounted() else { return };
    for (round, file) in [
        "light/value",
        "light/bin_data",
        "at_once/value",
        "darkness/value",
    ]
    .into_iter()
    .enumerate()
    {
        at_rest(&m, "light");
        let now = u8::try_from(round + 100).expect("a small number");
        bus.set(ADDRESS, LIGHT, &[now, 0]);
        let read = m.read(file).expect("a value");
        let text = format!("{now}\n");
        let good = if file.ends_with("bin_data") {
            vec![now, 0]
        } else {
            text.into_bytes()
        };
        assert_eq!(read, good, "{file}");
        at_rest(&m, "darkness");
    }
}

#[test]
fn a_number_is_written_beside_one_of_now() {
    let Some((bus, m)) = mounted() else { return };
    at_rest(&m, "pair");
    bus.set(ADDRESS, PAIR, &[50, 60]);
    m.write("pair/value0", "9").expect("a write");
    eventually("both", || {
        let registers = &bus.behaviour().registers;
        registers[&(ADDRESS, PAIR)] == 9 && registers[&(ADDRESS, PAIR + 1)] == 60
    });
}

#[test]
fn a_program_that_waits_is_woken_by_samples_and_its_numbers_grow() {
    let Some((bus, m)) = mounted() else { return };
    at_rest(&m, "light");
    bus.seen();
    m.python(
        "
import select
f = os.open(M + '/light/value', os.O_RDONLY)
poller = select.poll()
poller.register(f, select.POLLIN)
times = []
for _ in range(5):
    assert poller.poll(60000)
    os.pread(f, 100, 0)
    times.append(int(os.getxattr(M + '/light/value', 'user.trik.time_ns')))
assert times == sorted(times), times
",
    );
}

#[test]
fn a_bin_data_that_ends_a_rest_is_in_the_page_cache_and_stays_true() {
    let Some((bus, m)) = mounted() else { return };
    at_rest(&m, "light");
    let file = m.open("light/bin_data");
    let mut tuple = [0; 2];
    for number in 1..20 {
        bus.set(ADDRESS, LIGHT, &[number, 0]);
        eventually("the new sample", || {
            file.read_at(&mut tuple, 0).expect("a value") == 2 && tuple == [number, 0]
        });
    }
    // Rest, and another reader: nothing of before is left.
    drop(file);
    at_rest(&m, "light");
    bus.set(ADDRESS, LIGHT, &[200, 0]);
    m.open("light/bin_data")
        .read_exact(&mut tuple)
        .expect("a value");
    assert_eq!(tuple, [200, 0]);
}

#[test]
fn a_sensor_that_failed_while_nobody_looked_is_noticed_at_the_next_read() {
    let Some((bus, m)) = mounted() else { return };
    assert_eq!(m.text("light/value"), "7\n");
    at_rest(&m, "light");
    let present = std::mem::take(&mut bus.behaviour().present);
    assert_eq!(m.errno("light/value"), libc::EIO);
    assert!(
        m.text("light/fault").contains("no answer"),
        "{}",
        m.text("light/fault")
    );
    bus.behaviour().present = present;
    eventually("its return", || m.errno("light/value") == 0);
}

#[test]
fn a_regulator_works_for_as_long_as_its_order_stands() {
    let Some((bus, m)) = mounted() else { return };
    eventually("rest", || state(&m, "motor/speed") == "ready");
    assert_eq!(asked_during(&bus, 30, ENCODER), 0);
    m.write("motor/speed", "40").expect("an order");
    let power = bus.behaviour().registers.get(&(ADDRESS, MOTOR)).copied();
    assert_eq!(power, Some(40), "the first step is made by the write");
    let asked = asked_during(&bus, 150, ENCODER);
    assert!(
        asked >= 100,
        "{asked} steps in a second and a half without any open file"
    );
    m.write("stop", "1").expect("a stop");
    eventually("rest", || state(&m, "motor/speed") == "ready");
    assert_eq!(asked_during(&bus, 60, ENCODER), 0);
}
