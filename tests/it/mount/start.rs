//! Starting: the line that says so, in the background, for a service manager, for somebody else than root, or not at all.

use crate::{mount_on, program, trikfs};
use harness::{Board, Mount, Setting, eventually};
use std::os::unix::net::UnixDatagram;
use std::process::Command;

const PIPE: &str = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1 }, z = { src = '/dev/zero', input_tuple_size = 1, poll_ms = 5 } }";

fn mounted() -> Option<Mount> {
    let board = Board::new();
    board.fifo("in");
    mount_on(board, PIPE)
}

#[test]
fn one_line_says_where_the_tree_is_and_what_to_try() {
    let Some(m) = mounted() else { return };
    let root = m.root().display();
    assert_eq!(
        m.ready_line(),
        format!("trikfs: ready on {root} (2 nodes); try: cat {root}/status")
    );
    let command = m
        .ready_line()
        .split("try: ")
        .nth(1)
        .unwrap_or_default()
        .to_owned();
    assert!(m.sh(&command).starts_with("config ok: 2 nodes\n"));
}

#[test]
fn in_the_background_the_command_returns_when_the_tree_can_be_used() {
    if let Some(why) = harness::mount::obstacle() {
        return harness::skip(why);
    }
    let board = Board::new();
    std::fs::create_dir(board.path("mnt")).unwrap();
    board.file(
        "robot.lua",
        "trikfs = { z = { src = '/dev/zero', input_tuple_size = 3 } }",
    );
    let socket = UnixDatagram::bind(board.path("socket")).unwrap();
    socket.set_read_timeout(Some(harness::wait::SOON)).unwrap();
    let mut command = Command::new(program());
    command.args([
        "mount",
        "--background",
        "--config",
        "robot.lua",
        "--cache",
        "cache",
        "--transport",
    ]);
    command
        .arg(harness::mount::transport())
        .arg("mnt")
        .current_dir(board.dir())
        .env("NOTIFY_SOCKET", board.path("socket"));
    let line = harness::run(&mut command, b"").good();
    assert!(
        line.starts_with("trikfs: ready on /") && line.lines().count() == 1,
        "{line}"
    );
    assert_eq!(std::fs::read(board.path("mnt/z/bin_data")).unwrap(), [0; 3]);
    let mut said = [0; 100];
    let n = socket.recv(&mut said).unwrap();
    assert!(String::from_utf8_lossy(&said[..n]).contains("READY=1"));
    assert_eq!(trikfs(&board, &["umount", "mnt"], b"").code(), 0);
    eventually("the end of the mount", || {
        harness::board::mounts_below(board.dir()).is_empty()
    });
}

#[test]
fn a_configuration_is_not_needed_to_begin() {
    let Some(m) = crate::mount_with(Board::new(), "trikfs = {}", &[]) else {
        return;
    };
    let root = m.root().to_str().unwrap().to_owned();
    let mut m = m;
    m.stop();
    let mut command = Command::new(program());
    command
        .args(["mount", "--background", "--cache"])
        .arg(m.board().path("cache"))
        .arg(&root);
    let line = harness::run(&mut command, b"").good();
    assert!(line.contains("(0 nodes)"), "{line}");
    m.apply("trikfs = { z = { src = '/dev/zero', input_tuple_size = 3 } }")
        .unwrap();
    assert_eq!(m.read("z/bin_data").unwrap(), [0; 3]);
    assert_eq!(trikfs(m.board(), &["umount", &root], b"").code(), 0);
    eventually("the end of the mount", || !m.is_mounted());
}

#[test]
fn a_second_program_at_the_same_place_is_refused() {
    let Some(m) = mounted() else { return };
    let root = m.root().to_str().unwrap().to_owned();
    let file = m.board().path("robot.lua");
    let output = trikfs(
        m.board(),
        &["mount", "--config", file.to_str().unwrap(), &root],
        b"",
    );
    assert_eq!(output.code(), 1);
    assert!(output.stderr.contains("already"), "{}", output.stderr);
    assert_eq!(m.read("z/bin_data").unwrap(), [0]);
}

#[test]
fn what_cannot_be_mounted_is_refused_with_a_reason() {
    let board = Board::new();
    if let Some(why) = harness::mount::obstacle() {
        return harness::skip(why);
    }
    std::fs::create_dir(board.path("m")).unwrap();
    board.file("file", "");
    board.file("bad.lua", "trikfs = {\n  n = { src = 5 },\n}");
    board.file("good.lua", "trikfs = {}");
    let cases: [(&[&str], i32, &str); 6] = [
        (&["mount", "--config", "bad.lua", "m"], 1, "bad.lua:2: "),
        (&["mount", "--config", "absent.lua", "m"], 1, "absent.lua"),
        (&["mount", "--config", "good.lua", "file/m"], 1, "file/m"),
        (&["mount", "--config", "good.lua", "file"], 1, "file"),
        (&["mount"], 2, "MOUNTPOINT"),
        (&["mount", "--no-such-option", "m"], 2, "--no-such-option"),
    ];
    for (arguments, code, words) in cases {
        let output = trikfs(&board, arguments, b"");
        assert_eq!(output.code(), code, "{arguments:?}: {}", output.stderr);
        assert!(
            output.stderr.contains(words),
            "{arguments:?}: {}",
            output.stderr
        );
        assert!(
            harness::board::mounts_below(board.dir()).is_empty(),
            "{arguments:?}"
        );
    }
}

#[test]
fn somebody_else_than_root_mounts_through_the_helper() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("every mount of this user is such a mount");
    }
    if std::process::Command::new("fusermount3")
        .arg("-V")
        .output()
        .is_err()
    {
        return harness::skip("no fusermount3");
    }
    let nobody = [
        "setpriv",
        "--reuid=65534",
        "--regid=65534",
        "--clear-groups",
        "env",
        "HOME=/nonexistent",
    ];
    let board = Board::new();
    let tried = harness::run(
        harness::tools::shell(format!("{} test -w /dev/fuse", nobody.join(" "))).current_dir("/"),
        b"",
    );
    if tried.code() != 0 {
        return harness::skip("the user nobody may not use /dev/fuse");
    }
    // The checkout may be in a folder that nobody else can enter.
    let copy = board.path("trikfs");
    std::fs::copy(program(), &copy).unwrap();
    board.fifo("in");
    let user = nix::unistd::Uid::from_raw(65534);
    let group = nix::unistd::Gid::from_raw(65534);
    std::fs::create_dir(board.path("mnt")).unwrap();
    std::fs::create_dir(board.path("cache")).unwrap();
    for name in ["", "in", "mnt", "cache"] {
        nix::unistd::chown(&board.path(name), Some(user), Some(group)).unwrap();
    }
    std::fs::set_permissions(
        board.path("cache"),
        std::os::unix::fs::PermissionsExt::from_mode(0o700),
    )
    .unwrap();
    let setting = Setting {
        program: copy.to_str().unwrap(),
        board,
        config: PIPE,
        options: &[],
        launcher: &nobody,
    };
    let Some(m) = Mount::new(setting) else { return };
    let script = "test $(stat -c %u config) = 65534; head -c 1 z/bin_data | od -An -tu1; echo 'trikfs = {}' > config; ls";
    let command = format!("cd $MNT; {script}");
    let output = harness::run(
        std::process::Command::new(nobody[0])
            .args(&nobody[1..])
            .args(["sh", "-ec", &command])
            .env("MNT", m.root())
            .current_dir("/"),
        b"",
    );
    assert_eq!(
        output.good().split_whitespace().collect::<Vec<_>>(),
        ["0", "config", "log", "status", "stop"]
    );
}
