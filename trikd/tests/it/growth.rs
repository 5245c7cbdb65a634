//! Load that goes leaves nothing behind: descriptors and threads are as before, and memory does not grow with each wave.
//!
//! What is kept on purpose is open before anything is counted: `stop`, sockets of the ports, and one thread for each part.

use crate::rig::{Client, Robot, small_tree};
use harness::{eventually, processes};
use std::io::Read;

/// What is open in a process, by name; sockets and pipes have numbers, which do not count.
fn open_files(pid: u32) -> Vec<String> {
    let entries = std::fs::read_dir(format!("/proc/{pid}/fd"));
    let links = entries.into_iter().flatten().flatten();
    let names = links.filter_map(|entry| std::fs::read_link(entry.path()).ok());
    let plain = names.map(|name| {
        let name = name.to_string_lossy().into_owned();
        name.split_once(":[")
            .map_or(name.clone(), |(kind, _)| kind.to_owned())
    });
    let mut names: Vec<_> = plain.collect();
    names.sort();
    names
}

/// Names of threads.
fn threads(pid: u32) -> Vec<String> {
    let tasks = std::fs::read_dir(format!("/proc/{pid}/task"));
    let names = tasks.into_iter().flatten().flatten();
    let mut names: Vec<_> = names
        .filter_map(|task| std::fs::read_to_string(task.path().join("comm")).ok())
        .collect();
    names.sort();
    names
}

/// What the page answers.
fn page(robot: &Robot, request: &str, headers: &str) -> (Client, String) {
    let port = robot.port("page");
    let mut client = robot.client("page");
    client.raw(format!(
        "GET {request} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n{headers}\r\n"
    ));
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        client.stream.read_exact(&mut byte).expect("a head");
        head.push(byte[0]);
    }
    (client, String::from_utf8(head).expect("a head"))
}

/// A browser that looks and asks for a recording of everything.
fn browser(robot: &Robot, cookie: &str) -> Client {
    let headers = format!(
        "Cookie: {cookie}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    );
    let (mut client, head) = page(robot, "/socket", &headers);
    assert!(head.starts_with("HTTP/1.1 101 "), "{head}");
    // Bytes, masked by zeros.
    client.raw([&[0x82, 0x87, 0, 0, 0, 0][..], b"stream:"].concat());
    client
        .stream
        .read_exact(&mut [0; 64])
        .expect("what it is told");
    client
}

/// Everything that clients do at once, and its end.
fn wave(robot: &Robot) {
    let (_, head) = page(robot, "/plain", "");
    let cookie = head
        .split("set-cookie: ")
        .nth(1)
        .and_then(|rest| rest.split(';').next());
    let cookie = cookie
        .unwrap_or_else(|| panic!("no cookie: {head}"))
        .to_owned();
    let mut asking: Vec<Client> = (0..60).map(|_| robot.client("telemetry")).collect();
    for client in &mut asking {
        client.send("data");
        client.send("sensor:sensors/A1");
        client.until("sensor:");
        client.send("stream:");
    }
    let browsers: Vec<Client> = (0..20).map(|_| browser(robot, &cookie)).collect();
    let mut pictures: Vec<Client> = (0..5).map(|_| robot.client("video")).collect();
    for client in &mut pictures {
        client.raw("GET /?action=stream HTTP/1.1\r\n\r\n");
        assert_eq!(client.exactly(8), b"HTTP/1.0");
    }
    let mut control = robot.client("control");
    control.keep_alive();
    for name in ["a", "b", "c"] {
        control.send(&format!(
            "file:{name}:#!/bin/sh\n(sleep 1000 &)\necho go\nexec sleep 1000\n"
        ));
        control.send(&format!("run:{name}"));
        control.until("print: go");
    }
    control.send("stop");
    control.until("info: c was stopped");
    drop((browsers, asking));
}

#[test]
fn what_a_wave_of_clients_and_programs_takes_is_given_back() {
    let home = small_tree();
    for file in [
        "sound/tone/value",
        "led/red/value",
        "led/green/value",
        "camera/picture/bin_data",
    ] {
        let path = home.path(&format!("tree/{file}"));
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, b"\xff\xd8JPEG\xff\xd9").expect("a file");
    }
    let tree = home.path("tree");
    let robot = Robot::start(home, tree, &["--page-port", "0"]);
    let daemon = robot.daemon();
    let mut stop = robot.client("control");
    stop.send("stop");
    stop.send("status");
    stop.until("status: ");
    drop(stop);
    let is_quiet = || robot.status().contains("\nconnections 0 of ");
    eventually("nobody", is_quiet);
    let (files, names) = (open_files(daemon), threads(daemon));
    let mut memory = Vec::new();
    for _ in 0..4 {
        wave(&robot);
        eventually("nobody", is_quiet);
        eventually("the descriptors of before", || open_files(daemon) == files);
        eventually("the threads of before", || threads(daemon) == names);
        memory.extend(processes::resident_bytes(daemon));
    }
    println!(
        "{} descriptors, {} threads, memory after each wave {memory:?}",
        files.len(),
        names.len()
    );
    // The allocator keeps what the first waves took, for the next ones, and on a busy computer a later wave is higher than
    // those before it; what is not given back is there again after each.
    let growths = memory.windows(2).skip(1);
    let grown = growths.map(|pair| pair[1].saturating_sub(pair[0])).min();
    assert!(grown.is_some_and(|grown| grown < 2 << 20), "{memory:?}");
    assert_eq!(robot.daemon(), daemon, "{}", robot.log());
}
