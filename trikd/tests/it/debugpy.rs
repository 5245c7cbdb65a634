//! Programs in Python under a debugger: how they come to it, and what is told if they do not.

use crate::rig::{Client, Robot, robot};
use socket2::{Domain, Socket, Type};
use std::io::Read;
use std::net::{SocketAddr, TcpListener};

/// The answer to an order.
fn ask(client: &mut Client, tag: u32, order: &str) -> String {
    client.send(&format!("debug:{tag} {order}"));
    loop {
        let told = client.until("debug: ");
        if told.contains(&format!("\"to\":{tag},\"done\":")) {
            return told;
        }
    }
}

/// A debugpy that only connects, as the real one does.
const STAND_IN: &str = "\
import socket
def configure(**_): pass
def wait_for_client(): pass
def connect(place):
    with socket.socket() as debugger:
        debugger.connect(place)
        debugger.sendall(b'Content-Length')
";

/// A port of this machine that nobody else gets, and at which nobody listens.
fn closed_door() -> (Socket, u16) {
    let door = Socket::new(Domain::IPV4, Type::STREAM, None).expect("a socket");
    let any = SocketAddr::from(([127, 0, 0, 1], 0));
    door.bind(&any.into()).expect("a port");
    let place = door.local_addr().expect("an address").as_socket();
    (door, place.expect("an address of IP").port())
}

/// A robot with this debugpy and the program a.py.
fn with_stand_in() -> (Robot, Client) {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.send(&format!("file:debugpy.py:{STAND_IN}"));
    client.send("file:a.py:print('on')\n");
    (robot, client)
}

#[test]
fn a_program_in_python_says_its_secret_before_all_else() {
    let (_robot, mut client) = with_stand_in();
    for (tag, secret, heard) in [
        (1, ":s3cret", "s3cret\nContent-Length"),
        (2, "", "Content-Length"),
    ] {
        let door = TcpListener::bind("127.0.0.1:0").expect("a port");
        let port = door.local_addr().expect("an address").port();
        let told = ask(&mut client, tag, &format!("python {port}{secret} a.py"));
        assert!(told.contains("\"folder\":"), "{told}");
        let (mut program, _) = door.accept().expect("the program");
        let mut all = String::new();
        program.read_to_string(&mut all).expect("what it says");
        assert_eq!(all, heard);
        client.until("print: on");
        client.until("info: a.py has ended");
    }
    for wrong in ["", "a b", "\u{e4}", "a-b", &"a".repeat(65)] {
        let told = ask(&mut client, 3, &format!("python 7:{wrong} a.py"));
        assert!(told.contains("\"done\":false"), "{wrong}: {told}");
    }
}

#[test]
fn a_program_that_does_not_reach_its_debugger_says_so_once_in_the_log() {
    let (robot, mut client) = with_stand_in();
    let (_door, port) = closed_door();
    ask(&mut client, 1, &format!("python {port}:x a.py"));
    let told = client.until("info: the debugger at ");
    assert!(told.ends_with("; trying again"), "{told}");
    client.until("error: the debugger at ");
    client.until("info: a.py has failed");
    let line =
        format!("warning programs: a.py: the debugger at 127.0.0.1:{port} cannot be reached: ");
    robot.expect_log(&line);
    assert_eq!(
        robot.log().matches("the debugger at").count(),
        1,
        "{}",
        robot.log()
    );
}

#[test]
fn a_debugger_that_comes_late_is_reached() {
    let (_robot, mut client) = with_stand_in();
    let (door, port) = closed_door();
    ask(&mut client, 1, &format!("python {port}:x a.py"));
    client.until("info: the debugger at ");
    door.listen(1).expect("an open door");
    let door = TcpListener::from(door);
    let (mut program, _) = door.accept().expect("the program");
    let mut all = String::new();
    program.read_to_string(&mut all).expect("what it says");
    assert_eq!(all, "x\nContent-Length");
    client.until("print: on");
    client.until("info: a.py has ended");
}
