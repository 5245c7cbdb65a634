//! What stat(2) tells: modes, owners, sizes, times.

use crate::{mount, mount_with};
use harness::Board;
use std::os::unix::fs::{MetadataExt, PermissionsExt};

fn mode(m: &harness::Mount, name: &str) -> u32 {
    std::fs::metadata(m.path(name))
        .unwrap()
        .permissions()
        .mode()
        & 0o7777
}

#[test]
fn modes_follow_what_can_be_done() {
    let Some(m) = mount(
        "trikfs = {
          motor = { src = '/dev/null', input_tuple_size = 1 },
          gyro = { src = '/dev/zero', input_tuple_size = 6, poll_ms = 100, mode = '0640', owner = 12, group = 34 },
          sensor = { src = fake{ data = 'ab', period_ms = 0, loop = true }, input_tuple_size = 2 },
        }",
    ) else {
        return;
    };
    let expected = [
        ("", 0o555),
        ("config", 0o644),
        ("status", 0o444),
        ("log", 0o444),
        ("stop", 0o222),
        ("motor", 0o555),
        ("motor/device", 0o644),
        ("motor/value", 0o644),
        ("motor/units", 0o444),
        ("motor/fault", 0o444),
        ("motor/stats", 0o444),
        ("motor/format", 0o444),
        ("motor/poll_ms", 0o444),
        ("gyro/poll_ms", 0o644),
        ("gyro/device", 0o640),
        ("gyro/bin_data", 0o640),
        ("sensor/device", 0o444),
        ("sensor/bin_data", 0o444),
    ];
    for (name, bits) in expected {
        assert_eq!(mode(&m, name), bits, "{name}");
    }
    let gyro = std::fs::metadata(m.path("gyro/device")).unwrap();
    assert_eq!((gyro.uid(), gyro.gid()), (12, 34));
    let motor = std::fs::metadata(m.path("motor/device")).unwrap();
    assert_eq!(
        (motor.uid(), motor.gid()),
        (
            nix::unistd::getuid().as_raw(),
            nix::unistd::getgid().as_raw()
        )
    );
}

#[test]
fn sizes_are_those_of_a_tuple_so_that_nobody_sees_an_early_end() {
    let Some(m) = mount(
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 6, output_tuple_size = 6 } }",
    ) else {
        return;
    };
    let size = |name: &str| std::fs::metadata(m.path(name)).unwrap().len();
    assert_eq!(size("n/device"), 6);
    assert_eq!(size("n/bin_data"), 6);
    assert_eq!(size("n/value"), 4096);
    assert_eq!(size("status"), 4096);
    assert_eq!(size("config"), m.read("config").unwrap().len() as u64);
}

#[test]
fn a_group_may_be_given_the_configuration() {
    let Some(m) = mount_with(Board::new(), "trikfs = {}", &["--config-group", "4321"]) else {
        return;
    };
    let config = std::fs::metadata(m.path("config")).unwrap();
    assert_eq!(
        (config.permissions().mode() & 0o777, config.gid()),
        (0o664, 4321)
    );
}

#[test]
fn a_group_may_be_given_what_moves_and_not_the_configuration() {
    let config = "trikfs = {
      m = { src = '$DIR/m', input_tuple_size = 1, rest = 0, poll_ms = 50, format = 'u8 duty' },
      sensor = { src = '/dev/zero', input_tuple_size = 1, mode = 0444 },
      own = { src = '/dev/null', input_tuple_size = 1, group = 77 },
      private = { src = '/dev/null', input_tuple_size = 1, mode = '0600' },
    }";
    let board = Board::new();
    board.file("m", "x");
    let Some(m) = mount_with(board, config, &["--allow-other", "--group", "4321"]) else {
        return;
    };
    let rights = |name: &str| {
        let found = std::fs::metadata(m.path(name)).unwrap();
        (found.permissions().mode() & 0o777, found.gid())
    };
    for name in ["value", "device", "bin_data", "value0", "poll_ms", "owner"] {
        assert_eq!(rights(&format!("m/{name}")), (0o664, 4321), "{name}");
    }
    assert_eq!(rights("m/fault"), (0o444, 4321));
    assert_eq!(rights("sensor/value"), (0o444, 4321));
    assert_eq!(rights("own/value"), (0o644, 77));
    assert_eq!(rights("private/value"), (0o600, 4321));
    let mounting = nix::unistd::getgid().as_raw();
    assert_eq!(rights("config"), (0o644, mounting));
    assert_eq!(rights("stop"), (0o222, mounting));
}

#[test]
fn the_time_of_a_value_is_the_time_of_its_sample() {
    let Some(m) =
        mount("trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, on_event = true } }")
    else {
        return;
    };
    let mut pipe = m.board().pipe("in");
    let before = std::time::SystemTime::now();
    harness::eventually("a first sample", || {
        std::io::Write::write_all(&mut pipe, b"abcd").unwrap();
        m.errno("n/value") == 0
    });
    let after = std::time::SystemTime::now();
    let slack = std::time::Duration::from_millis(5);
    harness::eventually("the time of the sample", || {
        let modified = std::fs::metadata(m.path("n/value"))
            .unwrap()
            .modified()
            .unwrap();
        modified + slack >= before && modified <= after + slack
    });
}

#[test]
fn attributes_cannot_be_changed() {
    let Some(m) = mount("trikfs = { n = { src = '/dev/null', input_tuple_size = 1 } }") else {
        return;
    };
    m.python(
        "os.chdir(M)
for file in ('config', 'n/device', 'n'):
    expect('EPERM', os.chmod, file, 0o777)
    expect('EPERM', os.chown, file, 1, 1)
    expect('EPERM', os.utime, file, (1, 1))
",
    );
}
