//! Large tuples, many nodes, many open files at once, and memory that does not grow.

use crate::{mount, mount_on};
use harness::Board;

#[test]
fn the_largest_tuple_passes_whole_and_a_larger_one_is_refused() {
    const LARGEST: usize = 4 << 20;
    let board = Board::new();
    board.file("in", vec![5; LARGEST]);
    let config = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4194304 } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    let whole = |bytes: &[u8]| bytes.len() == LARGEST && bytes.iter().all(|byte| *byte == 5);
    assert!(whole(&m.read("n/bin_data").unwrap()));
    assert!(whole(&m.read("n/device").unwrap()));
    assert_eq!(m.text("n/value").len(), 2 * LARGEST);
    let line = m.apply(&config.replace("4194304", "4194305")).unwrap_err();
    assert!(line.contains("4194304"), "{line}");
}

#[test]
fn a_large_tuple_is_converted_whole() {
    let board = Board::new();
    board.file("in", [5; 65536]);
    let config = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 65536, output_tuple_size = 65536, budget_us = 1000000,
      converter = function(a_s, a, b_s, b) for i = 0, b_s - 1 do ba.set(b, i, ba.get(a, i) + 1) end end } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    assert_eq!(m.read("n/bin_data").unwrap(), [6; 65536]);
    assert_eq!(m.read("n/device").unwrap(), [6; 65536]);
    assert_eq!(m.text("n/value").len(), 2 * 65536);
}

#[test]
fn more_nodes_than_allowed_are_refused() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    let config = |count| {
        format!(
            "trikfs = {{}} for i = 1, {count} do trikfs['n' .. i] = {{ src = '/dev/zero', input_tuple_size = 1 }} end"
        )
    };
    m.apply(&config(4096)).unwrap();
    let line = m.apply(&config(4097)).unwrap_err();
    assert!(line.contains("4096"), "{line}");
    assert_eq!(m.result(), line);
}

#[test]
fn opening_and_closing_does_not_make_the_daemon_grow() {
    let Some(m) = mount(
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4,
          converter = function(a_s, a, b_s, b) ba.set(b, 0, 1) end } }",
    ) else {
        return;
    };
    let rounds = "for _ in range(1000):
    fd = open_ro(M + '/n/device')
    assert os.read(fd, 4) == b'\\1\\0\\0\\0'
    os.close(fd)
";
    m.python(rounds);
    let before = harness::processes::resident_bytes(m.daemon()).unwrap();
    m.python(rounds);
    m.python(rounds);
    let after = harness::processes::resident_bytes(m.daemon()).unwrap();
    assert!(after < before + (4 << 20), "{before} bytes became {after}");
}

#[test]
fn reloading_does_not_make_the_daemon_grow() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    let reload = |count: u32| {
        for number in 0..count {
            let config = format!(
                "trikfs = {{ n = {{ src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = function(a_s, a, b_s, b) ba.set(b, 0, {number}) end }} }}"
            );
            m.apply(&config).unwrap();
            let expected = u8::try_from(number % 256).unwrap();
            assert_eq!(m.read("n/bin_data").unwrap(), [expected, 0, 0, 0]);
        }
    };
    reload(100);
    let before = harness::processes::resident_bytes(m.daemon()).unwrap();
    reload(300);
    let after = harness::processes::resident_bytes(m.daemon()).unwrap();
    assert!(after < before + (6 << 20), "{before} bytes became {after}");
}
