//! The example that ships, byte for byte as the thesis describes it.

use crate::mount_on;
use harness::{Board, Mount};

const HELLO: &str = include_str!("../../../config/lua/hello.lua");

fn hello() -> Option<Mount> {
    mount_on(Board::new(), HELLO)
}

#[test]
fn random_is_in_the_range_of_its_formula() {
    let Some(m) = hello() else { return };
    m.python(
        "fd = open_ro(M + '/random/device')
seen = [set(), set(), set()]
data = read_exactly(fd, 30000)
for index, byte in enumerate(data): seen[index % 3].add(byte)
# out[i] = in[i] % 10 + (i + 1) + 33
for i in range(3): assert seen[i] == set(range(i + 34, i + 44)), (i, seen[i])
",
    );
}

#[test]
fn random2_is_the_device_itself() {
    let Some(m) = hello() else { return };
    m.python(
        "data = read_exactly(open_ro(M + '/random2/device'), 30000)
assert len(set(data)) == 256
",
    );
}

#[test]
fn zero_and_zero2_are_exact() {
    let Some(m) = hello() else { return };
    assert_eq!(m.sh("head -c 8 zero/device"), "12341234");
    assert_eq!(m.sh("head -c 8 zero2/device"), "12341234");
    assert_eq!(m.sh("cat zero/bin_data"), "1234");
    assert_eq!(m.sh("cat zero/value"), "49 50 51 52\n");
    assert_eq!(
        m.sh("head -c 6 zero/device; dd if=zero2/device bs=1 count=5 2>/dev/null"),
        "12341212341"
    );
}

#[test]
fn devices_that_are_not_there_are_enodev() {
    let Some(m) = hello() else { return };
    for (node, device) in [
        ("mouse", "/dev/input/mouse0"),
        ("keyboard", "/dev/input/event2"),
    ] {
        if !std::path::Path::new(device).exists() {
            assert_eq!(m.errno(&format!("{node}/device")), libc::ENODEV, "{node}");
        }
    }
    assert!(m.ready_line().contains("(6 nodes)"), "{}", m.ready_line());
}

#[test]
fn the_configuration_is_read_back_and_replaced_at_once() {
    let Some(m) = hello() else { return };
    assert_eq!(m.text("config"), HELLO);
    m.sh("echo \"trikfs = { nul = { src = '/dev/zero', input_tuple_size = 2, output_tuple_size = 2, converter = id_create(2) } }\" > config");
    assert_eq!(
        m.sh("head -c 4 nul/device | od -An -tu1")
            .split_whitespace()
            .collect::<Vec<_>>(),
        ["0"; 4]
    );
    assert!(!m.path("zero").exists());
}

#[test]
fn two_readers_of_random_do_not_share_bytes() {
    let Some(m) = hello() else { return };
    m.python(
        "one, two = open_ro(M + '/random2/device'), open_ro(M + '/random2/device')
assert read_exactly(one, 30) != read_exactly(two, 30)
",
    );
}
