//! Random clients and faults for a while; afterwards nothing more is open, and nobody is left.
//!
//! The seed is printed; `TRIKD_SOAK_SEED` repeats a run, `TRIKD_SOAK_S` makes it longer.

use crate::rig::{Robot, robot};
use harness::{eventually, processes};
use needs::Random;
use nix::sys::signal::Signal;
use nix::sys::socket::{setsockopt, sockopt::Linger};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

fn number(name: &str, default: u32) -> u32 {
    std::env::var(name)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(default)
}

fn open_files(pid: u32) -> usize {
    std::fs::read_dir(format!("/proc/{pid}/fd")).map_or(0, Iterator::count)
}

/// How often a run tells of its memory.
const PARTS: u32 = 10;

const CONTROL: [&str; 17] = [
    "version",
    "configVersion",
    "stop",
    "file:a.py:print('go')\nwhile True: pass",
    "file:b:#!/bin/sh\necho go; (setsid sleep 100 &)\n",
    "file:c.py:for i in range(3000): print(i)\n1/0",
    "file:d/e/f.py:import os\nos.kill(os.getpid(), 9)",
    "file:../x:y",
    "run:a.py",
    "run:b",
    "run:c.py",
    "run:d/e/f.py",
    "run:none",
    "direct:x = 1",
    "debug:1 look",
    "debug:2 attach",
    "debug:3 leave",
];
const OTHERS: [(&str, &str); 12] = [
    ("telemetry", "4:data"),
    ("telemetry", "5:ports9:sensor:A118:sensor:button:Left"),
    ("telemetry", "99999999:"),
    ("mailbox", "17:register:8895:700"),
    ("mailbox", "15:register:8895:7"),
    ("mailbox", "29:connection:127.0.0.1:65001:777"),
    ("mailbox", "10:data:hello"),
    ("gamepad", "pad 1 5 5\nbtn 3\nkeepalive 1000\n"),
    ("gamepad", "wheel\nwheel 7\n\n\n"),
    ("video", "GET /?action=stream HTTP/1.1\r\n\r\n"),
    ("variables", "GET /web/ HTTP/1.0\r\n\r\n"),
    ("variables", "POST"),
];

/// One thing that somebody does. Errors are fine: connections are refused and reset.
fn act(random: &mut Random, robot: &Robot, open: &mut Vec<TcpStream>) {
    match random.below(12) {
        0..=4 => {
            let Ok(mut stream) = TcpStream::connect(("127.0.0.1", robot.port("control"))) else {
                return;
            };
            for _ in 0..=random.below(4) {
                let text = CONTROL[random.below(CONTROL.len())];
                let mut frame = format!("{}:{text}", text.len()).into_bytes();
                if random.below(6) == 0 {
                    frame.truncate(random.below(frame.len()));
                }
                if random.below(8) == 0 {
                    let at = random.below(frame.len());
                    frame.insert(at, b':');
                }
                let _ = stream.write_all(&frame);
            }
            open.push(stream);
        }
        5..=8 => {
            let (port, bytes) = OTHERS[random.below(OTHERS.len())];
            let Ok(mut stream) = TcpStream::connect(("127.0.0.1", robot.port(port))) else {
                return;
            };
            let _ = stream.write_all(bytes.as_bytes());
            open.push(stream);
        }
        9 => {
            for stream in open.drain(..) {
                if random.below(2) == 0 {
                    let _ = setsockopt(
                        &stream,
                        Linger,
                        &nix::libc::linger {
                            l_onoff: 1,
                            l_linger: 0,
                        },
                    );
                }
            }
        }
        10 => {
            for child in processes::children(robot.daemon()) {
                // No stop: it could hit a process between its birth and its program, which trikd waits for.
                let signals = [Signal::SIGKILL, Signal::SIGTERM];
                processes::signal(child, signals[random.below(2)]);
            }
        }
        _ => {
            for stream in open.iter_mut() {
                let _ = stream.set_nonblocking(true);
                let _ = stream.read(&mut [0; 65536]);
                let _ = stream.set_nonblocking(false);
            }
            let _ = robot.status();
        }
    }
    open.truncate(100);
}

#[test]
fn random_clients_and_faults_leave_nothing_open_and_nobody_behind() {
    let clock = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(1, |time| time.subsec_nanos());
    let seed = number("TRIKD_SOAK_SEED", clock).max(1);
    println!("soak: TRIKD_SOAK_SEED={seed}");
    let robot = robot(&["--processes", "40"]);
    let daemon = robot.daemon();
    let mut random = Random::new(seed);
    let mut open = Vec::new();
    // What is made once, such as buffers and threads, is made before anything is counted.
    for _ in 0..100 {
        act(&mut random, &robot, &mut open);
    }
    let settle = |open: &mut Vec<TcpStream>| {
        open.clear();
        let gone = || {
            eventually("all connections are gone", || {
                robot.status().contains("\nconnections 0 of ")
            });
        };
        // What a client sent before it went is still done, so a stop before all are gone need not be the last word.
        gone();
        let mut control = robot.client("control");
        control.send("stop");
        control.sync();
        drop(control);
        gone();
        eventually("no program", || processes::children(daemon).is_empty());
    };
    settle(&mut open);
    let (files, memory) = (open_files(daemon), processes::resident_bytes(daemon));
    let length = Duration::from_secs(u64::from(number("TRIKD_SOAK_S", 5)));
    let end = Instant::now() + length;
    let mut count = 0;
    // A long run tells whether memory goes on growing.
    for part in (0..PARTS).rev() {
        while Instant::now() + length * part / PARTS < end {
            act(&mut random, &robot, &mut open);
            count += 1;
        }
        println!(
            "soak: {count} actions; resident {:?}",
            processes::resident_bytes(daemon)
        );
    }
    settle(&mut open);
    println!(
        "soak: {count} actions; open files {files}, then {}; resident {memory:?}, then {:?}",
        open_files(daemon),
        processes::resident_bytes(daemon)
    );
    eventually("no more files are open than before", || {
        open_files(daemon) <= files
    });
    assert_eq!(robot.daemon(), daemon, "it has crashed:\n{}", robot.log());
    let grown = processes::resident_bytes(daemon)
        .unwrap_or(0)
        .saturating_sub(memory.unwrap_or(0));
    assert!(grown < 4 << 20, "{grown} bytes more than before");
}
