//! Registers on a virtual bus, as files.

use crate::{mount_on, mount_with};
use harness::{Board, I2cBus, Mount};

/// The coprocessor, as the controller has it.
const MSP: u16 = 0x48;

const CONFIG: &str = "
    local function msp(register, transfer, more)
      local source = { path = '$DIR/i2c-2', address = 0x48, register = register, transfer = transfer }
      for key, value in pairs(more or {}) do source[key] = value end
      return i2c(source)
    end
    trikfs = {
      analog = { src = msp(0x25, 'word'), format = 'u16 raw', mode = 0444 },
      version = { src = msp(0x26, 'byte'), format = 'u8 number' },
      encoder = { src = msp(0x30, 'block', { write_transfer = 'byte' }), format = 'i32 ticks' },
      motor = { src = msp(0x14, 'byte', { readable = false }), format = 'i8 power', rest = 0 },
      period = { src = msp(0x10, 'word', { readable = false }), format = 'u16 period' },
      calibration = { src = i2c{ '$DIR/i2c-2', address = 0x33, register = 0x2400, register_bytes = 2,
                                 transfer = 'raw', once = true }, input_tuple_size = 4, format = '>u16 a, >u16 b' },
      stranger = { src = i2c{ '$DIR/i2c-2', address = 0x21, register = 0, transfer = 'byte' }, format = 'u8 x' },
      polled = { src = msp(0x24, 'word'), format = 'u16 raw', poll_ms = 5, timeout_ms = 300 },
    }";

fn mounted() -> Option<(I2cBus, Mount)> {
    mounted_with(CONFIG)
}

fn mounted_with(config: &str) -> Option<(I2cBus, Mount)> {
    let board = Board::new();
    let bus = I2cBus::start(&board.path("i2c-2"), MSP);
    bus.behaviour().present.push(0x33);
    bus.behaviour().register_bytes.insert(0x33, 2);
    mount_on(board, config).map(|m| (bus, m))
}

/// What was asked of a register, without the background.
fn asked(bus: &I2cBus, register: u8) -> Vec<(Vec<u8>, usize)> {
    let seen = bus.seen().into_iter();
    seen.filter(|one| one.address != MSP || one.written[0] != 0x24)
        .filter(|one| one.written[0] == register)
        .map(|one| (one.written, one.read))
        .collect()
}

#[test]
fn registers_of_every_width_are_read_and_written_with_the_bytes_of_the_wire() {
    let Some((bus, m)) = mounted() else { return };
    bus.set(MSP, 0x25, &[0xff, 0x03]);
    assert_eq!(m.text("analog/value"), "1023\n");
    assert_eq!(m.read("analog/device").unwrap(), [0xff, 0x03]);
    assert_eq!(asked(&bus, 0x25), vec![(vec![0x25], 2); 2]);
    assert_eq!(m.text("version/value"), "3\n");
    bus.set(MSP, 0x30, &(-100_000i32).to_le_bytes());
    assert_eq!(m.text("encoder/value"), "-100000\n");
    bus.seen();
    m.write("encoder/value", "0").unwrap();
    assert_eq!(
        asked(&bus, 0x30),
        [(vec![0x30, 0], 0)],
        "one byte resets it"
    );
    m.write("period/value", "4096").unwrap();
    assert_eq!(asked(&bus, 0x10), [(vec![0x10, 0, 0x10], 0)]);
    assert_eq!(m.errno("analog/value"), 0);
    assert_eq!(
        m.write("analog/value", "1").unwrap_err().raw_os_error(),
        Some(libc::EACCES)
    );
}

#[test]
fn a_motor_that_cannot_be_read_back_shows_what_was_written_last() {
    let Some((bus, mut m)) = mounted() else {
        return;
    };
    // It may have been driven by somebody who is dead now.
    assert_eq!(asked(&bus, 0x14), [(vec![0x14, 0], 0)], "at rest first");
    assert_eq!(m.text("motor/value"), "0\n");
    m.write("motor/value", "-100").unwrap();
    assert_eq!(m.text("motor/value"), "-100\n");
    assert_eq!(m.text("motor/value0"), "-100\n");
    assert_eq!(m.read("motor/bin_data").unwrap(), [0x9c]);
    assert_eq!(asked(&bus, 0x14), [(vec![0x14, 0x9c], 0)]);
    assert_eq!(
        m.write("motor/value", "128").unwrap_err().raw_os_error(),
        Some(libc::ERANGE)
    );
    assert_eq!(asked(&bus, 0x14), []);
    m.write("stop", "1").unwrap();
    assert_eq!(asked(&bus, 0x14), [(vec![0x14, 0], 0)]);
    m.write("motor/value", "50").unwrap();
    assert!(m.stop().success());
    // The guardian may do it once more after the daemon.
    let at_the_end = asked(&bus, 0x14);
    let (first, rest) = at_the_end.split_first().expect("what was written");
    assert_eq!(first, &(vec![0x14, 50], 0));
    assert!(
        !rest.is_empty() && rest.iter().all(|one| one == &(vec![0x14, 0], 0)),
        "at rest at the end: {at_the_end:?}"
    );
}

#[test]
fn a_calibration_is_read_once_with_a_register_of_two_bytes() {
    let Some((bus, m)) = mounted() else { return };
    bus.set(0x33, 0x2400, &[0x12, 0x34, 0xff, 0xfe]);
    for _ in 0..3 {
        assert_eq!(m.text("calibration/value"), "4660 65534\n");
    }
    assert_eq!(asked(&bus, 0x24), [(vec![0x24, 0x00], 4)]);
    m.write("calibration/value", "1 2").unwrap();
    assert_eq!(asked(&bus, 0x24), [(vec![0x24, 0, 0, 1, 0, 2], 0)]);
    assert_eq!(m.text("calibration/value"), "1 2\n");
}

#[test]
fn a_device_that_does_not_answer_is_a_fault_with_its_address() {
    let Some((bus, m)) = mounted() else { return };
    assert_eq!(m.errno("stranger/value"), libc::EIO);
    let fault = m.text("stranger/fault");
    let path = m.board().path("i2c-2");
    assert_eq!(
        fault,
        format!(
            "device: no answer from 0x21 on {}: Remote I/O error (os error 121)\n",
            path.display()
        )
    );
    bus.behaviour().present.push(0x21);
    assert_eq!(m.text("stranger/value"), "0\n");
    assert_eq!(m.text("stranger/fault"), "");
}

#[test]
fn a_bus_that_goes_and_comes_back_is_used_again() {
    let Some((mut bus, m)) = mounted() else {
        return;
    };
    bus.set(MSP, 0x24, &[7, 0]);
    harness::eventually("a sample", || m.text("polled/value") == "7\n");
    bus.unplug();
    harness::eventually("the end of the value", || {
        m.errno("polled/value") == libc::ENODEV
    });
    assert_eq!(m.errno("analog/value"), libc::ENODEV);
    let fault = m.text("analog/fault");
    assert!(
        fault.starts_with("device: ") && fault.contains("i2c-2: "),
        "{fault}"
    );
    bus.plug_in();
    bus.set(MSP, 0x24, &[8, 0]);
    harness::eventually("a sample of the new bus", || {
        m.read("polled/value").is_ok_and(|text| text == b"8\n")
    });
    assert_eq!(m.text("analog/value"), "0\n");
}

#[test]
fn a_bus_that_hangs_is_given_up_in_time() {
    // Polls that wait for the bus may fill its line before the read comes, which is EBUSY at once then.
    let is_quiet = |line: &&str| !line.contains("poll_ms");
    let quiet: Vec<&str> = CONFIG.lines().filter(is_quiet).collect();
    let Some((bus, m)) = mounted_with(&quiet.join("\n")) else {
        return;
    };
    bus.behaviour().is_dead = true;
    let begin = std::time::Instant::now();
    assert_eq!(m.errno("stranger/value"), libc::ETIMEDOUT);
    let took = begin.elapsed();
    assert!(
        (900..60_000).contains(&took.as_millis()),
        "timeout_ms is 1000, it took {took:?}"
    );
    let fault = m.text("stranger/fault");
    assert!(
        fault.contains("within 1000 ms") || fault.contains("for 1000 ms"),
        "{fault}"
    );
    bus.behaviour().is_dead = false;
    harness::eventually("an answer", || m.errno("analog/value") == 0);
}

#[test]
fn a_port_that_the_board_does_not_have_says_why() {
    let Some(m) = mount_with(
        Board::new(),
        "trikfs = { S7 = { src = absent{ reason = 'this board has no S7' }, format = 'u8 x', rest = 0 },
                    polled = { src = absent{ reason = 'nor this' }, format = 'u8 x', poll_ms = 5 } }",
        &[],
    ) else {
        return;
    };
    assert_eq!(m.errno("S7/value"), libc::ENODEV);
    assert_eq!(m.text("S7/fault"), "device: this board has no S7\n");
    assert_eq!(
        m.write("S7/value", "1").unwrap_err().raw_os_error(),
        Some(libc::ENODEV)
    );
    harness::eventually("a fault", || m.text("polled/fault") == "device: nor this\n");
    assert_eq!(m.errno("polled/value"), libc::ENODEV);
}
