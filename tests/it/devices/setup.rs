//! `setup` and `--device-root`: done once, tolerant, and never with the host's programs.

use crate::{mount_on, mount_with, trikfs};
use harness::{Board, I2cBus};

fn read(board: &Board, name: &str) -> String {
    std::fs::read_to_string(board.path(name)).unwrap_or_default()
}

fn script(board: &Board, name: &str, text: &str) {
    use std::os::unix::fs::PermissionsExt;
    let path = board.file(name, format!("#!/bin/sh\n{text}\n"));
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn actions_are_done_in_order_before_the_tree_is_ready_and_not_again_at_a_reload() {
    let board = Board::new();
    board.file("value", "0");
    board.file("there", "");
    board.file("untouched", "0");
    script(
        &board,
        "note",
        "cat $1/value >> $1/notes; echo \" $2\" >> $1/notes",
    );
    let bus = I2cBus::start(&board.path("i2c-2"), 0x48);
    let setup = "setup = {
        { path = '$DIR/value', write = '1' },
        { run = { '$DIR/note', '$DIR', 'one' } },
        { path = '$DIR/value', write = '2' },
        { run = { '$DIR/note', '$DIR', 'two' } },
        { path = '$DIR/untouched', write = '9', unless = '$DIR/there' },
        { to = i2c{ '$DIR/i2c-2', address = 0x48, register = 0x10, transfer = 'word' }, write = '\\0\\16' },
      ";
    let Some(m) = mount_on(board, &format!("trikfs = {{}} {setup} }}")) else {
        return;
    };
    let notes = || read(m.board(), "notes");
    assert_eq!(notes(), "1 one\n2 two\n");
    assert_eq!(read(m.board(), "untouched"), "0");
    let seen: Vec<_> = bus.seen().into_iter().map(|one| one.written).collect();
    assert_eq!(seen, [[0x10, 0, 0x10]]);
    assert_eq!(m.text("status"), "config ok: 0 nodes\n");
    let more = format!("trikfs = {{}} {setup} {{ run = {{ '$DIR/note', '$DIR', 'three' }} }} }}");
    m.apply(&more).unwrap();
    assert_eq!(notes(), "1 one\n2 two\n2 three\n");
    assert_eq!(bus.seen(), []);
}

#[test]
fn what_fails_is_told_and_refuses_nothing() {
    let board = Board::new();
    script(&board, "bad", "echo no such module >&2; exit 3");
    script(&board, "slow", "sleep 1000");
    let Some(m) = mount_on(
        board,
        "trikfs = { zero = { src = '/dev/zero', input_tuple_size = 1 } }
         setup = {
           { path = '$DIR/missing/export', write = '94' },
           { run = { '$DIR/bad' } },
           { run = { '$DIR/slow' }, timeout_ms = 100 },
           { path = '/dev/full', write = '1' },
           { path = '/dev/null', write = '1' },
           { to = i2c{ '$DIR/i2c-9', address = 3, register = 0, transfer = 'byte' }, write = '1' },
         }",
    ) else {
        return;
    };
    let status = m.text("status");
    let lines: Vec<&str> = status.lines().collect();
    assert_eq!(lines[0], "config ok: 1 node");
    assert_eq!(lines.len(), 7, "{status}");
    let expected = [
        ("setup[1] fault 0.0Hz device: ", "export: No such file"),
        (
            "setup[2] fault 0.0Hz device: ",
            "bad: exit status: 3: no such module",
        ),
        (
            "setup[3] fault 0.0Hz device: ",
            "slow was killed after 100 ms",
        ),
        ("setup[4] fault 0.0Hz device: ", "/dev/full"),
        ("setup[6] fault 0.0Hz device: ", "i2c-9: No such file"),
    ];
    for (line, (start, part)) in lines[1..].iter().zip(expected) {
        assert!(line.starts_with(start) && line.contains(part), "{line}");
    }
    assert!(lines[6].starts_with("zero ready "), "{status}");
    let log = m.log();
    assert!(log.contains("robot.lua:2: setup[2]: device: "), "{log}");
    m.apply("trikfs = {}").unwrap();
    assert_eq!(m.text("status"), "config ok: 0 nodes\n");
}

#[test]
fn the_same_configuration_runs_below_the_root_of_a_virtual_board() {
    let board = Board::new();
    for folder in [
        "root/dev",
        "root/sys/class/gpio",
        "root/etc/init.d",
        "root/sbin",
    ] {
        std::fs::create_dir_all(board.path(folder)).unwrap();
    }
    board.file("root/sys/class/gpio/export", "");
    script(
        &board,
        "root/etc/init.d/camera",
        "echo started > ${0%/etc/*}/camera",
    );
    // A way out of the root.
    std::os::unix::fs::symlink("/bin/touch", board.path("root/sbin/touch")).unwrap();
    let bus = I2cBus::start(&board.path("root/dev/i2c-2"), 0x48);
    bus.set(0x48, 0x26, &[0x22, 0x03]);
    let config = "trikfs = { battery = { src = i2c{ '/dev/i2c-2', address = 0x48, register = 0x26, transfer = 'word' },
                     format = 'u16 raw', mode = 0444 } }
         setup = {
           { path = '/sys/class/gpio/export', write = '94', unless = '/sys/class/gpio/gpio94' },
           { run = { '/etc/init.d/camera', 'start' } },
           { run = { '/sbin/touch', '$DIR/touched' } },
           { run = { '/bin/touch', '$DIR/touched' } },
         }";
    let root = board.path("root").display().to_string();
    let file = board
        .file("board.lua", board.fill_in(config))
        .display()
        .to_string();
    let checked = trikfs(&board, &["check", "--device-root", &root, &file], b"");
    assert_eq!(checked.code(), 0, "{}", checked.stderr);
    assert_eq!(checked.stderr, "", "all devices are there");
    let elsewhere = trikfs(&board, &["check", "--device-root", "/nowhere", &file], b"");
    assert_eq!(elsewhere.code(), 1);
    assert_eq!(
        elsewhere.stderr,
        "trikfs: --device-root /nowhere: not a directory\n"
    );
    let Some(m) = mount_with(board, config, &["--device-root", &root]) else {
        return;
    };
    assert_eq!(m.text("battery/value"), "802\n");
    assert_eq!(read(m.board(), "root/sys/class/gpio/export"), "94");
    assert_eq!(read(m.board(), "root/camera"), "started\n");
    assert!(!m.board().path("touched").exists());
    let log = m.log();
    let skipped = log
        .lines()
        .filter(|line| line.contains("runs only programs of its own"))
        .count();
    assert_eq!(skipped, 2, "{log}");
    assert_eq!(m.text("status").lines().count(), 2);
}

#[test]
fn a_board_that_hangs_at_start_does_not_keep_the_tree_from_being_ready() {
    let board = Board::new();
    let bus = I2cBus::start(&board.path("i2c-2"), 0x48);
    bus.behaviour().is_dead = true;
    let send = "{ to = i2c{ '$DIR/i2c-2', address = 0x48, register = 1, transfer = 'byte' }, write = '1', timeout_ms = 60000 },";
    let begin = std::time::Instant::now();
    let Some(m) = mount_on(board, &format!("trikfs = {{}} setup = {{ {send} }}")) else {
        return;
    };
    assert!(begin.elapsed() < std::time::Duration::from_secs(30));
    assert!(m.log().contains("setup: not done after 3000 ms"));
}
