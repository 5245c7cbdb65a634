//! Opening: who may, what is missing, and what this filesystem does not do.

use crate::{mount, mount_with};
use harness::Board;

#[test]
fn a_missing_device_costs_its_own_node_only() {
    let Some(m) = mount(
        "trikfs = {
          absent = { src = '$DIR/absent', input_tuple_size = 4, units = 'mm' },
          zero = { src = '/dev/zero', input_tuple_size = 4 },
        }",
    ) else {
        return;
    };
    for file in ["absent/device", "absent/bin_data", "absent/value"] {
        assert_eq!(m.errno(file), libc::ENODEV, "{file}");
    }
    assert_eq!(m.text("absent/units"), "mm\n");
    let fault = m.text("absent/fault");
    assert!(
        fault.starts_with("device: ") && fault.contains("/absent"),
        "{fault}"
    );
    assert_eq!(m.read("zero/bin_data").unwrap(), [0; 4]);
    m.board().file("absent", "abcd");
    assert_eq!(m.read("absent/bin_data").unwrap(), b"abcd");
    assert_eq!(m.text("absent/fault"), "");
}

#[test]
fn a_sensor_cannot_be_opened_for_writing_not_even_by_root() {
    let Some(m) = mount(
        "trikfs = {
          sensor = { src = fake{ data = 'ab', period_ms = 0, loop = true }, input_tuple_size = 2 },
          marked = { src = '/dev/null', input_tuple_size = 1, mode = '0444' },
          zero = { src = '/dev/zero', input_tuple_size = 1 },
        }",
    ) else {
        return;
    };
    m.python(
        "for file in ('sensor/device', 'sensor/bin_data', 'sensor/value', 'marked/device', 'status', 'log', 'zero/fault', 'zero/stats', 'zero/units', 'zero/format'):
    for flags in (os.O_WRONLY, os.O_RDWR, os.O_WRONLY | os.O_TRUNC):
        expect('EACCES', os.open, M + '/' + file, flags)
expect('EACCES', os.open, M + '/stop', os.O_RDONLY)
expect('EACCES', os.open, M + '/stop', os.O_RDWR)
expect('EISDIR', os.open, M + '/zero', os.O_WRONLY)
",
    );
}

#[test]
fn names_cannot_be_made_moved_or_removed() {
    let Some(m) = mount("trikfs = { n = { src = '/dev/null', input_tuple_size = 1 } }") else {
        return;
    };
    m.python(
        "os.chdir(M)
expect('EPERM', os.mkdir, 'new')
expect('EPERM', os.rmdir, 'n')
expect('EPERM', os.unlink, 'config')
expect('EPERM', os.rename, 'config', 'config2')
expect('EPERM', os.symlink, 'a', 'b')
expect('EPERM', os.link, 'config', 'b')
expect('EPERM', os.mkfifo, 'f')
expect('EPERM', os.open, 'new', os.O_CREAT | os.O_WRONLY)
assert os.listdir() == ['config', 'log', 'n', 'status', 'stop'], os.listdir()
",
    );
}

#[test]
fn two_thousand_opens_each_get_a_state_of_their_own() {
    let Some(m) = mount(
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = (function()
          local count = 0
          return function(a_s, a, b_s, b) count = count + 1; ba.set(b, 0, count) end
        end)() } }",
    ) else {
        return;
    };
    m.python(
        "resource.setrlimit(resource.RLIMIT_NOFILE, (4096, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
fds = [open_ro(M + '/n/device') for _ in range(2000)]
for fd in fds:
    assert os.read(fd, 2) == b'\\x01\\x02'
for fd in fds[::7]:
    assert os.read(fd, 1) == b'\\x03'
for fd in fds:
    os.close(fd)
fd = open_ro(M + '/n/device')
assert os.read(fd, 1) == b'\\x01'
",
    );
}

#[test]
fn other_users_come_in_only_when_they_are_let_in() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can be somebody else");
    }
    let config = "trikfs = {
      open = { src = '/dev/zero', input_tuple_size = 1 },
      closed = { src = '/dev/zero', input_tuple_size = 1, mode = '0600' },
    }";
    let nobody = "setpriv --reuid=65534 --regid=65534 --clear-groups";
    let Some(m) = mount(config) else { return };
    // From outside: the tree cannot be the working directory of a user who has no access.
    let outside = m.try_sh(&format!("cd /; {nobody} cat $MNT/open/bin_data"));
    assert_ne!(outside.code(), 0);
    assert!(
        outside.stderr.contains("Permission denied"),
        "{}",
        outside.stderr
    );
    drop(m);
    let Some(m) = mount_with(Board::new(), config, &["--allow-other"]) else {
        return;
    };
    assert_eq!(
        m.sh(&format!("{nobody} head -c 1 open/device | od -An -tu1"))
            .trim(),
        "0"
    );
    let closed = m.try_sh(&format!("{nobody} cat closed/bin_data"));
    assert!(
        closed.stderr.contains("Permission denied"),
        "{}",
        closed.stderr
    );
    let config = m.try_sh(&format!(
        "echo 'trikfs = {{}}' | {nobody} dd of=config conv=notrunc"
    ));
    assert!(
        config.code() != 0 && config.stderr.contains("Permission denied"),
        "{}",
        config.stderr
    );
    assert_eq!(m.result(), "config ok: 2 nodes");
}
