//! Second names of nodes, nodes that are written through others, and converters that say who is to blame.

use crate::{mount, mount_on, trikfs};
use harness::Board;

const MOTOR: &str = "
    local function write(a_s, a, b_s, b)
      local power = ba.i16(a, 0)
      if power > 100 then error('ERANGE: power is at most 100, not ' .. power, 0) end
      if power < 0 then error('EINVAL: there is no reverse', 0) end
      ba.set(b, 0, power)
    end
    trikfs = {
      motors = {
        M1 = {
          src = '$DIR/M1', input_tuple_size = 1, format = 'i16 power', rest = 0,
          converter = function(a_s, a, b_s, b)
            if ba.get(a, 0) == 255 then error('ENODEV: no motor', 0) end
            if ba.get(a, 0) == 254 then error('ETIMEDOUT: no echo', 0) end
            if ba.get(a, 0) == 253 then error('EIO: nonsense', 0) end
            if ba.get(a, 0) == 252 then error('ERANGE: too much', 0) end
            ba.i16(b, 0, ba.get(a, 0))
          end,
          write_converter = write,
          attributes = { half = {
            src = 'trikfs:motors/M1', format = 'i16 half',
            converter = function(a_s, a, b_s, b) ba.i16(b, 0, ba.i16(a, 0) / 2) end,
            write_converter = function(a_s, a, b_s, b) ba.i16(b, 0, ba.i16(a, 0) * 2) end,
          } },
        },
        left = { alias = 'motors/M1' },
      },
      sensor = { src = 'trikfs:motors/M1', converter = id_create(2), output_tuple_size = 2 },
    }";

fn board() -> Board {
    let board = Board::new();
    board.file("M1", [7]);
    board
}

#[test]
fn a_second_name_has_the_same_files_and_the_same_node() {
    let Some(m) = mount_on(board(), MOTOR) else {
        return;
    };
    assert_eq!(m.sh("ls motors/left"), m.sh("ls motors/M1"));
    assert_eq!(m.text("motors/left/value"), "0\n");
    m.write("motors/left/value", "50").unwrap();
    assert_eq!(m.text("motors/M1/value"), "50\n");
    assert_eq!(m.text("motors/left/half"), "25\n");
    assert_eq!(
        m.stat("motors/M1", "writes"),
        m.stat("motors/left", "writes")
    );
    assert_eq!(m.stat("motors/left", "writes"), 1.0);
    // One node, one line.
    assert_eq!(m.result(), "config ok: 2 nodes");
    assert!(!m.text("status").contains("left"));
}

#[test]
fn a_second_name_comes_and_goes_with_the_configuration() {
    let Some(m) = mount_on(board(), MOTOR) else {
        return;
    };
    let config = m.text("config");
    let open = m.open("motors/M1/value");
    m.apply(&config.replace("left = {", "right = {")).unwrap();
    assert_eq!(m.errno("motors/left/value"), libc::ENOENT);
    assert_eq!(m.text("motors/right/value"), "0\n");
    // The node itself did not change.
    assert_eq!(std::io::read_to_string(open).unwrap(), "0\n");
}

#[test]
fn a_sampled_node_is_read_rightly_under_both_names() {
    let Some(m) = mount(
        "trikfs = { a = { src = '/dev/zero', input_tuple_size = 4, format = 'u32 n', poll_ms = 5,
           converter = function(a_s, a, b_s, b) n = (n or 0) + 1 ba.u32(b, 0, n) end }, b = { alias = 'a' } }",
    ) else {
        return;
    };
    let number = |name: &str| u32::from_le_bytes(m.read(name).unwrap().try_into().unwrap());
    // Each name has a page of its own in the kernel, and they are stored one after the other: so only a name by itself
    // never goes back.
    let mut seen = [("a/bin_data", 0), ("b/bin_data", 0)];
    for _ in 0..200 {
        for (name, last) in &mut seen {
            let now = number(name);
            assert!(now >= *last, "{name}: {now} after {last}");
            *last = now;
        }
    }
    let last = seen[0].1.max(seen[1].1);
    harness::eventually("newer samples under both names", || {
        number("a/bin_data") > last + 5 && number("b/bin_data") > last + 5
    });
}

#[test]
fn writing_goes_through_a_node_that_can_be_written() {
    let Some(m) = mount_on(board(), MOTOR) else {
        return;
    };
    m.write("motors/M1/half", "20").unwrap();
    assert_eq!(m.text("motors/M1/value"), "40\n");
    // Without a write_converter of its own a node with a converter only reads.
    assert_eq!(m.sh("stat -c %a sensor/value").trim(), "444");
    let refused = m.write("motors/M1/half", "60").unwrap_err();
    assert_eq!(refused.raw_os_error(), Some(libc::ERANGE));
}

#[test]
fn the_first_word_of_a_converter_says_who_is_to_blame() {
    let Some(m) = mount_on(board(), MOTOR) else {
        return;
    };
    let refused = m.write("motors/M1/value", "101").unwrap_err();
    assert_eq!(refused.raw_os_error(), Some(libc::ERANGE));
    let refused = m.write("motors/M1/value", "-1").unwrap_err();
    assert_eq!(refused.raw_os_error(), Some(libc::EINVAL));
    assert_eq!(std::fs::read(m.board().path("M1")).unwrap(), [0]);
    // Nothing is wrong with the motor: the log alone tells.
    assert_eq!(m.text("motors/M1/fault"), "");
    assert_eq!(m.stat("motors/M1", "faults"), 0.0);
    let log = m.log();
    for reason in ["power is at most 100, not 101", "there is no reverse"] {
        let line = format!("motors/M1: caller: {reason}\n");
        assert!(log.contains(&line), "{log}");
    }
    std::fs::write(m.board().path("M1"), [255]).unwrap();
    assert_eq!(m.errno("motors/M1/value"), libc::ENODEV);
    assert_eq!(m.text("motors/M1/fault"), "device: no motor\n");
    for (byte, errno, fault) in [
        (254, libc::ETIMEDOUT, "device: no echo\n"),
        (253, libc::EIO, "device: nonsense\n"),
        // Who reads has written nothing wrong.
        (252, libc::EIO, "converter: too much\n"),
    ] {
        std::fs::write(m.board().path("M1"), [byte]).unwrap();
        assert_eq!(m.errno("motors/M1/value"), errno);
        assert_eq!(m.text("motors/M1/fault"), fault);
    }
}

#[test]
fn a_second_name_of_nothing_is_refused() {
    let cases = [
        ("b = { alias = 'x' }", "b: there is no node 'x'"),
        (
            "b = { alias = 'a/t' }",
            "b: 'a/t' is an attribute and can have no second name",
        ),
        (
            "b = { alias = 'c' }, c = { alias = 'a' }",
            "b: 'c' is a second name itself; name the node that it stands for",
        ),
        (
            "b = { alias = 'a', mode = 0444 }",
            "b: with 'alias' there is nothing else to say: the files are those of 'a'",
        ),
        (
            "b = { alias = 5 }",
            "b/alias: a number stands where a node or a group belongs",
        ),
    ];
    for (entry, reason) in cases {
        let board = Board::new();
        let source = "src = '/dev/zero', input_tuple_size = 1";
        let text = format!(
            "trikfs = {{ a = {{ {source}, attributes = {{ t = {{ {source} }} }} }}, {entry} }}"
        );
        board.file("robot.lua", text);
        let output = trikfs(&board, &["check", "--cache", "cache", "robot.lua"], b"");
        assert_eq!(output.code(), 1, "{entry}");
        assert!(output.stderr.contains(reason), "{entry}: {}", output.stderr);
    }
}
