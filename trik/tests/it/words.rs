//! What is said to a person, and what is refused.

use crate::rig::{Home, Robot, TRIK, robot};
use std::sync::Arc;

#[test]
fn the_ready_text_says_where_the_robot_is_and_every_command_in_it_works() {
    let Some(one) = robot(&[]) else { return };
    its_text_is_right(&one, "two-wheels");
    drop(one);
    let Some(other) = robot(&["--robot", "line-follower"]) else {
        return;
    };
    its_text_is_right(&other, "line-follower");
}

fn its_text_is_right(robot: &Robot, name: &str) {
    let root = robot.root.display();
    assert!(
        robot
            .said()
            .starts_with(&format!("trik: the robot {name} is ready on {root} (")),
        "{}",
        robot.said()
    );
    let board = robot.devices.display();
    assert!(robot.devices.join("pose").exists());
    assert!(
        robot.said().contains(&format!(
            "\nIts virtual board, with pose, control/keys and faults, is {board}\n"
        )),
        "{}",
        robot.said()
    );
    let commands: Vec<&str> = robot
        .said()
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("  cd "))
        .collect();
    assert!(commands.len() >= 4, "{}", robot.said());
    for command in commands {
        let output = robot.sh(&format!("set -e\n{command}"));
        assert_eq!(output.stderr, "", "{command}");
        output.good();
    }
}

#[test]
fn a_mount_point_of_the_users_own_is_used_and_what_is_not_empty_is_refused() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let full = home.0.path("full");
    std::fs::create_dir_all(full.join("x")).unwrap();
    let refusal = home.run(&["up", "full"]);
    assert_eq!(refusal.code(), 1);
    assert_eq!(
        refusal.stderr,
        format!(
            "trik: {} is not empty: name an empty directory, or none\n",
            full.display()
        )
    );
    let robot = Robot::start(home.clone(), &["mine"]);
    assert_eq!(robot.root, home.0.path("mine"));
    let refusal = home.run(&["up", "mine"]);
    assert_eq!(refusal.code(), 1);
    assert!(
        refusal
            .stderr
            .contains("something is mounted there already"),
        "{}",
        refusal.stderr
    );
    drop(robot);
    assert!(!home.base().exists());
}

#[test]
fn what_cannot_be_is_refused_with_a_reason_and_leaves_nothing() {
    let Some(home) = Home::new() else { return };
    home.0.file("bad.lua", "trikfs = { x = 3 }");
    for (words, code, reason) in [
        (
            &["up", "--robot", "tank"] as &[&str],
            2,
            "there is no such robot",
        ),
        (&["up", "--speed", "0"], 2, "not a number from 0.1 to 20"),
        (
            &["up", "--config", "none.lua"],
            1,
            "trik: none.lua: no such configuration\n",
        ),
        (&["up", "--config", "bad.lua"], 1, "bad.lua:1: "),
        (
            &["fault", "D1", "unplug"],
            1,
            "trik: no robot of yours runs: start one with trik up\n",
        ),
        (
            &["fault", "D9", "unplug"],
            1,
            "trik: there is no device 'D9'",
        ),
        (
            &["fault", "D1", "explode"],
            1,
            "trik: there is no fault 'explode' here; possible are ",
        ),
    ] {
        let output = home.run(words);
        assert_eq!(output.code(), code, "{words:?}: {}", output.stderr);
        assert!(
            output.stderr.contains(reason),
            "{words:?}: {}",
            output.stderr
        );
        assert!(!home.base().exists(), "{words:?}");
    }
}

#[test]
fn without_a_terminal_there_are_no_control_characters() {
    let Some(robot) = robot(&[]) else { return };
    let said = robot.said();
    assert!(
        said.chars().all(|c| c == '\n' || !c.is_control()),
        "{said:?}"
    );
}

#[test]
fn without_a_terminal_every_sound_is_told_in_a_line() {
    let Some(robot) = robot(&[]) else { return };
    for (file, text, line) in [
        ("sound/say/value", "hello", "said: hello"),
        // A negative number is no option of the program that speaks.
        ("sound/say/value", "-5", "said: -5"),
        ("sound/say/value", "hello", "said: hello"),
        (
            "sound/tone/value",
            "440 100",
            "said: (a tone of 440 Hz for 100 ms)",
        ),
        (
            "sound/play/value",
            "/dev/null",
            "said: (/dev/null is played)",
        ),
    ] {
        robot.write(file, text).expect(file);
        let heard = std::iter::from_fn(|| Some(robot.next_line())).find(|line| !line.is_empty());
        assert_eq!(heard.as_deref(), Some(line));
    }
}

#[test]
fn the_log_of_a_healthy_robot_tells_of_no_problem() {
    let Some(robot) = robot(&[]) else { return };
    let log = robot.log();
    let left_out = log.lines().find(|line| line.contains("setup["));
    assert!(
        left_out.is_some_and(|line| line.contains(
            "left out, which is no problem: a virtual board runs only programs of its own, and has no "
        ) && line.ends_with("/sbin/modprobe")),
        "{log}"
    );
}

/// Runs a program on a terminal of its own, ends it with the key Ctrl-C once a text was there, and prints what it said,
/// whether the terminal showed typed characters meanwhile and whether it does so afterwards.
const ON_A_TERMINAL: &str = r#"
import fcntl, os, pty, select, struct, sys, termios, time
text, program = sys.argv[1].encode(), sys.argv[2:]
master, slave = pty.openpty()
fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack('HHHH', 24, 60, 0, 0))
shows = lambda: bool(termios.tcgetattr(slave)[3] & termios.ECHO)
pid = os.fork()
if pid == 0:
    os.setsid()
    fcntl.ioctl(slave, termios.TIOCSCTTY, 0)
    for fd in (0, 1, 2):
        os.dup2(slave, fd)
    os.execv(program[0], program)
said, during, deadline = b'', None, time.time() + 80
while time.time() < deadline:
    if os.waitpid(pid, os.WNOHANG)[0]:
        break
    if select.select([master], [], [], 0.05)[0]:
        said += os.read(master, 65536)
    if during is None and said.count(text) > 3:
        during = shows()
        os.write(master, b'\x03')
sys.stdout.write('%s %s\n' % (during, shows()))
while select.select([master], [], [], 0)[0]:
    said += os.read(master, 65536)
sys.stdout.write(said.decode())
"#;

#[test]
fn on_a_terminal_the_robot_is_shown_in_place_and_the_terminal_is_given_back() {
    let Some(home) = Home::new() else { return };
    let mut command = std::process::Command::new(harness::tools::python_program());
    command
        .args([
            "-c",
            ON_A_TERMINAL,
            "motors, %",
            TRIK,
            "up",
            "--no-trikd",
            "--cache",
        ])
        .arg(home.0.path("cache"))
        .env("XDG_RUNTIME_DIR", home.0.dir())
        .env("TERM", "xterm");
    let output = harness::run(&mut command, b"").good();
    let (echo, said) = output.split_once('\n').expect("lines");
    assert_eq!(echo, "False True", "{said}");
    // Drawn again where it was.
    assert!(said.contains("\x1b[7A\r"), "{said:?}");
    assert!(said.trim_end().ends_with("\x1b[?25h"), "{said:?}");
    let shown = said.split("\x1b[?25l").nth(1).expect("a view");
    let row = shown.lines().find(|line| line.starts_with("analog, raw"));
    // As wide as the terminal is: 60 columns, and the last one stays free.
    let text = row.and_then(|row| row.split('\x1b').next()).expect("a row");
    assert_eq!(text.len(), 59, "{text:?}");
    assert!(!home.base().exists());
}

#[test]
fn every_robot_has_a_file_that_names_what_is_plugged_into_it() {
    let root = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let manual = std::fs::read_to_string(root.join("docs/user/trik.md")).expect("the manual");
    for name in sim::robots::names() {
        let file = format!("robots/{name}.lua");
        let text = std::fs::read_to_string(root.join("config/lua").join(&file)).expect(&file);
        for plug in sim::robots::by_name(name).expect(name).ports {
            let entry = format!("{{ port = '{}', type = '{}'", plug.port, plug.kind);
            assert!(
                plug.kind.is_empty() || text.contains(&entry),
                "{file}: {entry}"
            );
        }
        assert!(manual.contains(&format!("| `{file}` |")), "{file}");
    }
}
