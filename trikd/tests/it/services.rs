//! Status, variables, pictures, datagrams, discovery, autorun, and what is said at the start.

use crate::rig::{Robot, command, robot, small_tree, trikd};
use harness::wait::SOON;
use std::io::{Read, Write};
use std::net::{TcpListener, UdpSocket};
use std::process::Command;

fn get(robot: &Robot, port: &str, request: &str) -> String {
    let mut client = robot.client(port);
    client.raw(request);
    let mut bytes = Vec::new();
    client.stream.read_to_end(&mut bytes).unwrap();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn variables_of_a_program_are_shown_to_web_pages() {
    let robot = robot(&[]);
    let ask = || get(&robot, "variables", "GET /web/ HTTP/1.0\r\n\r\n");
    assert!(ask().starts_with("HTTP/1.0 503 "), "{}", ask());
    let mut client = robot.client("control");
    client.send("file:w.py:web['speed'] = 7\nprint('go')\nwhile True: pass");
    client.send("run:w.py");
    client.until("print: go");
    let answer = ask();
    assert!(
        answer.starts_with("HTTP/1.0 200 OK\r\n") && answer.ends_with("\r\n\r\n{\"speed\": \"7\"}"),
        "{answer}"
    );
    for (request, status) in [
        ("GET / HTTP/1.1\r\n\r\n", "404"),
        ("POST /web/ HTTP/1.1\r\n\r\n", "405"),
        ("\0\u{ff}\r\n\r\n", "400"),
    ] {
        assert!(get(&robot, "variables", request).starts_with(&format!("HTTP/1.0 {status} ")));
    }
}

#[test]
fn pictures_are_streamed_if_the_tree_has_them_and_else_there_is_a_reason() {
    let robot = robot(&[]);
    let none = get(
        &robot,
        "video",
        "GET /?action=stream HTTP/1.1\r\nHost: x\r\n\r\n",
    );
    assert!(
        none.starts_with("HTTP/1.0 503 ") && none.contains("there are no pictures"),
        "{none}"
    );
    std::fs::create_dir_all(robot.home.path("tree/camera/picture")).unwrap();
    robot
        .home
        .file("tree/camera/picture/bin_data", b"\xff\xd8JPEG\xff\xd9");
    let one = get(&robot, "video", "GET /?action=snapshot HTTP/1.1\r\n\r\n");
    assert!(one.contains("Content-Length: 8\r\n\r\n"), "{one}");
    let mut client = robot.client("video");
    client.raw("GET /?action=stream&filename=noname.jpg HTTP/1.1\r\n\r\n");
    let mut bytes = vec![0; 600];
    client.stream.read_exact(&mut bytes).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    assert!(
        text.contains("multipart/x-mixed-replace;boundary=picture\r\n\r\n--picture\r\n"),
        "{text}"
    );
    assert!(
        text.matches("Content-Length: 8\r\n\r\n").count() > 2,
        "{text}"
    );
}

#[test]
fn telemetry_comes_as_datagrams_of_json() {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(SOON)).unwrap();
    let to = socket.local_addr().unwrap().to_string();
    let _robot = robot(&["--udp-telemetry", &to, "--udp-period-ms", "10"]);
    let mut buffer = [0; 2000];
    for _ in 0..3 {
        let size = socket.recv(&mut buffer).unwrap();
        let text = std::str::from_utf8(&buffer[..size]).unwrap();
        assert!(
            text.starts_with("{\"timestamp\":") && text.contains("\"analog\":{\"A1\":27}"),
            "{text}"
        );
    }
}

#[test]
fn a_robot_is_found_by_who_asks_the_network() {
    let robot = robot(&["--name", "my robot"]);
    let mut question = vec![0, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0];
    for label in ["_trik", "_tcp", "local"] {
        question.push(u8::try_from(label.len()).unwrap());
        question.extend_from_slice(label.as_bytes());
    }
    question.extend_from_slice(&[0, 0, 12, 0, 1]);
    // Others on this machine may share the port: the kernel chooses one of them by the port of the asker.
    harness::eventually("an answer of this robot", || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket
            .set_read_timeout(Some(std::time::Duration::from_millis(200)))
            .unwrap();
        socket.send_to(&question, "127.0.0.1:5353").unwrap();
        let mut buffer = [0; 2000];
        let size = socket.recv(&mut buffer).unwrap_or(0);
        let has = |part: &[u8]| {
            buffer[..size]
                .windows(part.len())
                .any(|window| window == part)
        };
        has(b"\x08my-robot\x05_trik\x04_tcp\x05local\0")
            && has(&robot.port("control").to_be_bytes())
            && has(&[127, 0, 0, 1])
    });
}

#[test]
fn a_port_that_is_taken_is_named_with_what_to_do_and_nothing_is_started() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let number = taken.local_addr().unwrap().port().to_string();
    let home = small_tree();
    for port in ["control", "telemetry", "gamepad", "video"] {
        let option = format!("--{port}-port");
        let output = command(&home, &home.path("tree"), &[&option, &number])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1));
        assert!(
            text.starts_with(&format!(
                "trikd: port {number} ({port}) cannot be served: another program has it"
            )),
            "{text}"
        );
        assert!(
            text.contains(&format!("--{port}-port")) && output.stdout.is_empty(),
            "{text}"
        );
        assert!(!home.path("run").exists());
    }
    let robot = Robot::start(home, taken_tree(), &["--mailbox-port", &number]);
    assert_ne!(robot.port("mailbox").to_string(), number);
}

#[test]
fn a_folder_that_cannot_be_used_is_named_with_its_option() {
    for (in_the_way, option) in [
        ("scripts", "--scripts"),
        ("state", "--state"),
        ("run", "--run"),
        ("run/python", "--run"),
        ("run/status.sock/x", "--run"),
    ] {
        let home = small_tree();
        std::fs::create_dir_all(home.path(in_the_way).parent().unwrap()).unwrap();
        home.file(in_the_way, "");
        let output = command(&home, &home.path("tree"), &[]).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1));
        assert!(
            text.trim_end()
                .ends_with(&format!("name another directory with {option}")),
            "{in_the_way}: {text}"
        );
        assert!(output.stdout.is_empty());
    }
}

fn taken_tree() -> std::path::PathBuf {
    "/nonexistent".into()
}

#[test]
fn the_status_shows_ports_tree_program_and_who_is_in_control() {
    let robot = robot(&[]);
    let (mut one, mut other) = (robot.client("control"), robot.client("telemetry"));
    one.send("file:s.py:while True: pass");
    one.send("run:s.py");
    one.until("info: s.py has started");
    other.sync();
    let status = robot.status();
    for part in [
        "ports control ",
        " mounted\n",
        "program s.py (Python, process ",
        "programs 1 started, 0 failed",
        "connections 2 of 256",
        " telemetry for ",
        ", in control\n",
        "access everybody; pairing is off",
    ] {
        assert!(status.contains(part), "no {part:?} in\n{status}");
    }
    let nobody = Command::new(trikd())
        .args(["status", "--run", "/nonexistent"])
        .output()
        .unwrap();
    assert_eq!(nobody.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&nobody.stderr).contains("trikd does not run"));
}

#[test]
fn a_program_runs_by_itself_unless_a_key_is_held() {
    let prepared = |key: &str| {
        let home = small_tree();
        std::fs::create_dir_all(home.path("scripts")).unwrap();
        let mark = home.path("mark");
        home.file(
            "scripts/autorun.py",
            format!("open('{}', 'w').close()", mark.display()),
        );
        home.file("tree/keys/value", format!("0 0 {key} 0 0 0 0\n"));
        let tree = home.path("tree");
        Robot::start(home, tree, &[])
    };
    let robot = prepared("0");
    harness::eventually("autorun", || robot.home.path("mark").exists());
    let held = prepared("1");
    harness::eventually("a reason", || held.log().contains("a key is held down"));
    assert!(!held.home.path("mark").exists());
}

#[test]
fn half_requests_and_strangers_cost_nothing() {
    let robot = robot(&[]);
    let mut clients: Vec<_> = ["video", "variables", "control", "telemetry", "mailbox"]
        .map(|port| robot.client(port))
        .into();
    for client in &mut clients {
        client.stream.write_all(b"GET / HTT").unwrap();
    }
    robot.client("control").sync();
}
