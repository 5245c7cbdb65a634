//! A virtual board, its mounted tree, and `trikd` above: what moves comes to rest, what is sensed arrives.
//!
//! `trik` of the same build starts the board; a build of this package alone may not have it.

use crate::rig::{BUILT, Client, Robot, trikd};
use harness::wait::note_skip;
use harness::{Board, eventually, processes};
use nix::libc;
use nix::sys::signal::Signal;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// A running `trik up`.
struct Up {
    process: Child,
    tree: PathBuf,
    devices: PathBuf,
}

impl Drop for Up {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("log of the tree:\n{}", log_of(&self.tree));
        }
        processes::signal(self.process.id(), Signal::SIGTERM);
        let _ = self.process.wait();
    }
}

/// What a tree has told so far.
fn log_of(tree: &Path) -> String {
    let mut bytes = Vec::new();
    let log = File::options()
        .read(true)
        .custom_flags(libc::O_NONBLOCK)
        .open(tree.join("log"));
    if let Ok(mut log) = log {
        // It ends with EAGAIN, and what came before is there.
        let _ = log.read_to_end(&mut bytes);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A robot on a virtual board; the board goes after it.
struct Virtual {
    robot: Robot,
    up: Up,
}

fn virtual_robot() -> Option<Virtual> {
    virtual_robot_with(&[], &[])
}

/// With further words for `trik up` and for `trikd serve`.
fn virtual_robot_with(up_words: &[&str], words: &[&str]) -> Option<Virtual> {
    let trik = Path::new(BUILT).with_file_name("trik");
    if let Some(why) = harness::mount::obstacle() {
        harness::skip(why);
        return None;
    }
    if !trik.exists() {
        note_skip("there is no trik beside trikd: `cargo build -p trik` makes it");
        return None;
    }
    let home = Board::new();
    let tree = home.path("mnt");
    let mut command = Command::new(trik);
    command
        .args(["up", "--no-view", "--no-trikd", "--cache"])
        .arg(home.path("cache"))
        .args(up_words)
        .arg(&tree);
    command
        .env("XDG_RUNTIME_DIR", home.dir())
        .stdin(Stdio::null())
        .stdout(Stdio::piped());
    let mut process = command.spawn().expect("trik");
    let mut lines = BufReader::new(process.stdout.take().expect("a pipe")).lines();
    let mut said = Vec::new();
    while !said
        .last()
        .is_some_and(|line: &String| line.contains("Ctrl-C ends it."))
    {
        said.push(
            lines
                .next()
                .unwrap_or_else(|| panic!("trik has ended: {said:?}"))
                .expect("a line"),
        );
    }
    std::thread::spawn(move || for _ in lines {});
    let mut devices = None;
    eventually("a board", || {
        let entries = std::fs::read_dir(home.path("trik"))
            .into_iter()
            .flatten()
            .flatten();
        devices = entries
            .map(|entry| entry.path())
            .find(|path| path.extension().is_some_and(|ending| ending == "board"));
        devices.is_some()
    });
    let up = Up {
        process,
        tree: tree.clone(),
        devices: devices.expect("a board"),
    };
    Some(Virtual {
        robot: Robot::start(home, tree, words),
        up,
    })
}

fn number(robot: &Robot, name: &str) -> Option<i32> {
    std::fs::read_to_string(robot.tree.join(name))
        .ok()?
        .trim()
        .parse()
        .ok()
}

fn run(client: &mut Client, name: &str, text: &str) {
    client.send(&format!("file:{name}:{text}"));
    client.send(&format!("run:{name}"));
    client.until("print: go");
}

#[test]
fn motors_rest_whatever_the_program_is_doing() {
    let Some(board) = virtual_robot() else { return };
    let robot = &board.robot;
    let mut client = robot.client("control");
    let start = "brick.motor(M3).setPower(60)\nbrick.motor(M4).setPower(60)\n";
    for (name, text) in [
        ("wait.py", format!("{start}print('go')\nscript.wait(60000)")),
        ("loop.py", format!("{start}print('go')\nwhile True: pass")),
        ("drive.py", format!("{start}print('go')\nwhile True: brick.motor(M3).setPower(60)")),
        ("read.py", format!("{start}print('go')\nopen(script and '{}').read()", robot.tree.join("log").display())),
        ("child", "#!/bin/sh\n(setsid sh -c 'while :; do echo 60 > $TRIK_TREE/motors/M3/value; done' &)\nwhile ! grep -qv '^0' $TRIK_TREE/motors/M3/raw; do :; done; echo go\nsleep 1000\n".to_owned()),
    ] {
        run(&mut client, name, &text);
        eventually("a motor that turns", || number(robot, "motors/M3/raw").is_some_and(|duty| duty != 0));
        client.send("stop");
        let told = client.until("info: ");
        assert!(told.starts_with(&format!("info: {name} was stopped")), "{told}");
        for motor in ["motors/M3/raw", "motors/M4/raw"] {
            assert_eq!(number(robot, motor), Some(0), "{name}: {motor}");
        }
    }
    let status = robot.status();
    println!(
        "{}",
        status
            .lines()
            .find(|line| line.starts_with("rest of the last"))
            .unwrap_or_default()
    );
}

/// What somebody without rights tries: each line that it prints is a thing that must not succeed.
const BREAKS_OUT: &str = "#!/bin/sh
for file in config; do (echo 'trikfs = {}' > $TRIK_TREE/$file) 2>/dev/null && echo \"writes $file\"; done
kill -9 $PPID 2>/dev/null && echo 'kills trikd'
for pid in $(cat /proc/[0-9]*/stat 2>/dev/null | grep -E '[(]trik(d|fs)?[)]' | cut -d' ' -f1); do
  kill -0 $pid 2>/dev/null && [ $(stat -c %u /proc/$pid) = 0 ] && echo \"kills $pid\"
done
(echo x > ../state/paired) 2>/dev/null && echo 'writes the state'
echo 40 > $TRIK_TREE/motors/M3/value && echo drives
echo go
sleep 1000
";

#[test]
fn a_user_without_rights_drives_and_does_nothing_else() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can start programs as another user");
    }
    let nobody = nix::unistd::User::from_name("nobody").ok().flatten();
    let Some(nobody) = nobody else {
        return note_skip("there is no user nobody");
    };
    let group = nobody.gid.to_string();
    let words = ["--user", "nobody", "--processes", "40"];
    let Some(board) = virtual_robot_with(&["--group", &group], &words) else {
        return;
    };
    let robot = &board.robot;
    assert!(!robot.log().contains("may not write"), "{}", robot.log());
    let mut client = robot.client("control");
    client.send(
        "directScript:brick.motor(M3).setPower(60); print(script.system('id -un', true)); print('go'); while (true) {}",
    );
    client.until("print: go");
    eventually("a motor that turns", || {
        number(robot, "motors/M3/raw").is_some_and(|duty| duty != 0)
    });
    let program = processes::children(robot.daemon());
    assert!(!program.is_empty());
    for pid in &program {
        let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
        let uid = format!("Uid:\t{0}\t{0}\t{0}\t{0}\n", nobody.uid);
        assert!(status.contains(&uid), "{status}");
    }
    client.send("stop");
    eventually("the end of the program and rest", || {
        number(robot, "motors/M3/raw") == Some(0)
            && program.iter().all(|pid| !processes::is_alive(*pid))
    });
    client.send(&format!("file:out:{BREAKS_OUT}"));
    client.send("run:out");
    client.until("info: out has started");
    client.expect("print: drives\n");
    client.expect("print: go\n");
    client.send("stop");
    client.until("info: out was stopped");
    assert_eq!(number(robot, "motors/M3/raw"), Some(0));
    assert!(robot.status().contains("programs run as nobody"));
}

#[test]
fn a_tree_in_which_programs_cannot_drive_is_told_with_what_to_do() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can start programs as another user");
    }
    let Some(board) = virtual_robot_with(&[], &["--user", "nobody"]) else {
        return;
    };
    let told = "programs run as nobody, who may not write";
    eventually("a warning", || board.robot.log().contains(told));
    assert!(
        board
            .robot
            .log()
            .contains("mount with --allow-other --group")
    );
}

#[test]
fn all_sensors_of_the_board_arrive() {
    let Some(board) = virtual_robot() else { return };
    let robot = &board.robot;
    let mut client = robot.client("telemetry");
    let mut ports = String::new();
    // Before the tree is looked through for the first time there are no names.
    eventually("the tree answers", || {
        client.send("ports");
        ports = client.next().expect("an answer");
        ports != "ports:analog:;digital:;special:;encoders:"
    });
    assert!(
        ports.starts_with("ports:analog:A1,A2,A3,A4,A5,A6;digital:D1,D2"),
        "{ports}"
    );
    assert!(ports.ends_with(";special:;encoders:E1,E2,E3,E4"), "{ports}");
    let mut data = String::new();
    eventually("the gyroscope is calibrated and everything is read", || {
        client.send("data");
        data = client.next().expect("an answer");
        let gyroscope = data
            .split("GyroscopePort:")
            .nth(1)
            .and_then(|rest| rest.split(';').next());
        gyroscope.is_some_and(|list| list.split(',').count() == 7)
            && !data.contains("AccelerometerPort:;")
            && data.contains(";D3:-1:-1;")
            && !data.contains("D1::")
    });
    for entry in data.trim_start_matches("allData:").split(';') {
        let fields: Vec<&str> = entry.split(':').collect();
        assert!(fields.len() >= 2 && !fields[0].is_empty(), "{data}");
        if ["A", "D", "E"].contains(&&fields[0][..1]) && fields[0].len() == 2 {
            assert!(
                fields.len() == 3 && fields[1..].iter().all(|field| field.parse::<i32>().is_ok()),
                "{entry}"
            );
        }
    }
}

#[test]
fn a_gamepad_reaches_the_tree_and_a_tree_that_leaves_is_told() {
    let Some(board) = virtual_robot() else { return };
    let fifo = board.up.devices.join("run/gamepad-service.out.fifo");
    let home = Board::new();
    let fifo = fifo.to_str().expect("UTF-8").to_owned();
    let mut command = crate::rig::command(&home, &board.robot.tree, &[]);
    // The last word about an option counts for clap only once, so this one is started by hand.
    let arguments: Vec<_> = command
        .get_args()
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let arguments = arguments.iter().map(|word| {
        if word.ends_with("gamepad.fifo") {
            fifo.as_str()
        } else {
            word
        }
    });
    command = Command::new(trikd());
    let mut process = command
        .args(arguments)
        .stdout(Stdio::piped())
        .spawn()
        .expect("trikd");
    let mut ready = String::new();
    BufReader::new(process.stdout.take().expect("a pipe"))
        .read_line(&mut ready)
        .expect("a line");
    let port = |name: &str| -> u16 {
        let words: Vec<&str> = ready.split([' ', ',']).collect();
        words[words.iter().position(|word| *word == name).expect("a port") + 1]
            .trim()
            .parse()
            .expect("a number")
    };
    let (mut gamepad, mut telemetry) =
        (Client::new(port("gamepad")), Client::new(port("telemetry")));
    eventually("the pad arrives", || {
        gamepad.raw("pad 1 -20 30\n");
        telemetry.send("sensor:GamepadPad1PosPort");
        telemetry.next().as_deref() == Some("sensor:GamepadPad1PosPort:(-20,30)")
    });
    let mut control = Client::new(port("control"));
    control.sync();
    // The end of the board may take longer than a client may be silent.
    control.keep_alive();
    telemetry.keep_alive();
    let Virtual { robot, up } = board;
    drop(up);
    control.send("stop");
    let told = control.until("error: ");
    assert!(
        told.contains("there is no tree at") || told.contains("is gone"),
        "{told}"
    );
    telemetry.send("data");
    assert!(telemetry.next().expect("an answer").starts_with("allData:"));
    processes::signal(process.id(), Signal::SIGTERM);
    process.wait().expect("an end");
    drop(robot);
}

#[test]
fn a_program_in_javascript_drives_and_hears_the_gamepad() {
    let Some(board) = virtual_robot() else { return };
    let mut client = board.robot.client("control");
    client.send(
        "directScript:var before = brick.encoder(E3).read();\n\
         brick.motor(M3).setPower(60); brick.motor(M4).setPower(60);\n\
         while (brick.encoder(E3).read() - before < 90) script.wait(5);\n\
         print(brick.sensor(D3).read(), ' ', brick.sensor(D1).readRawData() > 0);\n\
         print(brick.motor(M3).power(), ' ', brick.sensor(A1).read() >= 0, ' ', brick.keys().wasPressed(KeysEnum.Up));\n\
         gamepad.pad.connect(function(pad, x, y) { print(pad, ' ', gamepad.padX(pad), ' ', y); });\n\
         gamepad.button.connect(function(number) { print('button ', number); script.quit(); });\n\
         print('listens'); script.run()",
    );
    assert_eq!(client.until("print: "), "print: -1 true\n");
    client.expect("print: 60 true false\n");
    client.expect("print: listens\n");
    std::fs::write(
        board.up.devices.join("control/gamepad"),
        "pad 1 20 -30\nbtn 3\n",
    )
    .unwrap();
    assert_eq!(client.until("print: "), "print: 1 20 -30\n");
    client.expect("print: button 3\n");
    eventually("rest at the end of the program", || {
        number(&board.robot, "motors/M3/value") == Some(0)
    });
}

/// Parts of a stream of pictures: the JPEG file of each.
fn pictures(client: &mut Client, count: usize) -> Vec<Vec<u8>> {
    let mut reader = BufReader::new(client.stream.try_clone().expect("a socket"));
    let mut found = Vec::new();
    let mut length = 0;
    while found.len() < count {
        let mut line = String::new();
        assert!(
            reader.read_line(&mut line).expect("a head") > 0,
            "{found:?}"
        );
        if let Some(number) = line.trim().strip_prefix("Content-Length: ") {
            length = number.parse().expect("a number");
        } else if line == "\r\n" && length > 0 {
            let mut file = vec![0; length];
            reader.read_exact(&mut file).expect("a picture");
            found.push(file);
            length = 0;
        }
    }
    found
}

#[test]
fn viewers_and_programs_see_what_the_camera_sees() {
    let Some(board) = virtual_robot() else { return };
    let robot = &board.robot;
    let mut viewers: Vec<Client> = (0..3).map(|_| robot.client("video")).collect();
    for viewer in &mut viewers {
        viewer.raw("GET /?action=stream&filename=noname.jpg HTTP/1.1\r\nHost: robot\r\n\r\n");
    }
    for viewer in &mut viewers {
        for file in pictures(viewer, 2) {
            let seen = screen::picture::decode(&file).expect("a JPEG file");
            assert_eq!((seen.width(), seen.height()), (320, 240));
            let floor = seen.at(160, 235).expect("a point");
            assert!(floor.red > 200 && floor.blue > 200, "{floor:?}");
        }
    }
    // All of them are one reader of the tree.
    let open = std::fs::read_dir(format!("/proc/{}/fd", robot.daemon())).expect("descriptors");
    let picture = robot.tree.join("camera/picture/bin_data");
    let readers = open
        .flatten()
        .filter(|entry| std::fs::read_link(entry.path()).is_ok_and(|target| target == picture));
    assert_eq!(readers.count(), 1);
    drop(viewers);
    let mut client = robot.client("control");
    for (name, text) in [
        (
            "photo.py",
            "p = getPhoto()\nprint(len(p), p[-1] >> 16 > 200)\nprint(len(brick.getStillImage()))\n",
        ),
        (
            "photo.js",
            "var p = getPhoto();\nprint(p.length, ' ', p[p.length - 1] >> 16 > 200);\nprint(brick.getStillImage().length);\n",
        ),
    ] {
        client.send(&format!("file:{name}:{text}"));
        client.send(&format!("run:{name}"));
        let told = client.until("print: 19200 ");
        assert!(
            told.trim().eq_ignore_ascii_case("print: 19200 true"),
            "{told}"
        );
        client.until("print: 230400\n");
        client.until(&format!("info: {name} has ended"));
    }
    let encoder = board.up.devices.join("run/mjpg-encoder.out.fifo");
    eventually("an encoder that was stopped", || !encoder.exists());
}
