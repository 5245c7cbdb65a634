//! Frames on the control and telemetry ports: handshakes, nonsense, limits, and the two clocks.

use crate::rig::{Client, frame, robot};
use std::io::Write;
use std::time::{Duration, Instant};

#[test]
fn both_ports_are_connected_to_and_asked_as_desktop_programs_do() {
    let robot = robot(&["--config-version", "model-2014"]);
    let (mut control, mut telemetry) = (robot.client("control"), robot.client("telemetry"));
    control.send("version");
    control.send("configVersion");
    control.expect("version: 3.1.4");
    control.expect("configVersion: model-2014");
    for _ in 0..200 {
        telemetry.send("data");
    }
    for _ in 0..200 {
        let data = telemetry.next().unwrap();
        assert!(
            data.starts_with("allData:A1:27:281;D1:-1:-1;E1:90:-384;AccelerometerPort:;Gyro"),
            "{data}"
        );
        assert!(data.ends_with(";Esc:0"), "{data}");
    }
    for (asked, answer) in [
        ("ports", "ports:analog:A1;digital:D1;special:;encoders:E1"),
        ("sensor:A1", "sensor:A1:27"),
        ("sensor:D1", "sensor:D1:-1"),
        ("sensor:GyroscopePortX", "sensor:GyroscopePortX:"),
        ("sensor:button:Esc", "sensor:Esc:0"),
        ("button:Left", ""),
        ("version", "version: 3.1.4"),
    ] {
        telemetry.send(asked);
        telemetry.expect(answer);
    }
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn nonsense_between_frames_is_skipped_as_the_official_parser_does() {
    let robot = robot(&[]);
    for nonsense in [
        "abc:",
        ":::",
        "99999999999:",
        "2147483648:",
        "0:",
        "-5:",
        "1.5:",
        "0x7:",
        " :",
        "\0\u{ff}:",
    ] {
        let mut client = robot.client("control");
        client.raw(format!("{nonsense} 7 :version"));
        client.expect("version: 3.1.4");
    }
    let mut client = robot.client("control");
    for byte in frame("version") {
        client.raw([byte]);
    }
    client.expect("version: 3.1.4");
    client.raw(b"5:\xff\xfe\xfd\xfc\xfb7:version+7:version");
    client.expect("version: 3.1.4");
    client.expect("version: 3.1.4");
}

#[test]
fn a_stream_that_cannot_be_followed_is_closed_with_a_reason_and_others_do_not_notice() {
    let robot = robot(&["--upload-mib", "1"]);
    let mut other = robot.client("control");
    for (bytes, why) in [
        (b"4294967295:".to_vec(), None),
        (
            b"2147483647:file:".to_vec(),
            Some("a message of 2147483647 bytes"),
        ),
        (b"1048577:x".to_vec(), Some("at most 1048576 are taken")),
        (vec![b'7'; 5000], Some("no colon")),
    ] {
        let mut client = robot.client("control");
        client.raw(&bytes);
        match why {
            Some(why) => {
                let told = client.next().unwrap_or_default();
                assert!(told.starts_with("error: ") && told.contains(why), "{told}");
                assert_eq!(client.next(), None);
            }
            // Out of the range of the count, so it is no count.
            None => client.sync(),
        }
    }
    let mut telemetry = robot.client("telemetry");
    telemetry.raw("70000:");
    assert_eq!(telemetry.next(), None);
    other.sync();
}

#[test]
fn a_silent_client_is_dropped_and_one_that_keeps_alive_is_not() {
    let robot = robot(&[]);
    let (mut silent, mut alive) = (robot.client("control"), robot.client("telemetry"));
    let start = Instant::now();
    let mut kept = 0;
    // Its own keepalives are answered by `next` below, which is what keeps it alive.
    std::thread::scope(|scope| {
        let dropped = scope.spawn(|| {
            let mut buffer = Vec::new();
            // A read to the end: what came was one keepalive, and then the connection ended.
            std::io::Read::read_to_end(&mut silent.stream, &mut buffer).unwrap();
            (buffer, start.elapsed())
        });
        while !dropped.is_finished() {
            alive.send("keepalive");
            std::thread::sleep(Duration::from_millis(500));
            kept += 1;
        }
        let (buffer, after) = dropped.join().unwrap();
        assert_eq!(buffer, frame("keepalive"));
        assert!(after > Duration::from_millis(4_900), "{after:?}");
    });
    assert!(kept > 5);
    alive.sync();
}

#[test]
fn a_client_that_does_not_read_loses_messages_and_nobody_else_does() {
    let robot = robot(&[]);
    let (mut deaf, mut hears) = (robot.client("control"), robot.client("control"));
    deaf.sync();
    // More than all buffers between both sides hold, at the rate that a program may have.
    let text = "import time\nfor i in range(2000):\n  print('x' * 2000)\n  time.sleep(0.002)\nwhile True: time.sleep(0.1); print('last')";
    hears.send(&format!("file:flood.py:{text}"));
    hears.send("run:flood.py");
    let alive = deaf.stream.try_clone().unwrap();
    let stopped = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !stopped.load(std::sync::atomic::Ordering::Relaxed) {
                (&alive).write_all(&frame("keepalive")).unwrap();
                std::thread::sleep(Duration::from_millis(500));
            }
        });
        hears.until("print: last\n");
        stopped.store(true, std::sync::atomic::Ordering::Relaxed);
    });
    let told = loop {
        let told = deaf.until("info: ");
        if told.contains("this computer reads more slowly") {
            break told;
        }
    };
    assert!(told.contains(" messages were left out"), "{told}");
    deaf.sync();
}

#[test]
fn connections_beyond_the_limit_are_refused_and_places_are_given_again() {
    // One computer may have six of eight.
    let robot = robot(&["--connections", "8"]);
    let mut clients: Vec<Client> = (0..6).map(|_| robot.client("control")).collect();
    clients.iter_mut().for_each(Client::sync);
    for _ in 0..300 {
        let mut refused = robot.client("telemetry");
        // It may be reset before the words are out.
        let _ = refused.stream.write_all(b"7:version");
        assert_eq!(refused.next(), None);
    }
    clients.truncate(4);
    clients[0].sync();
    harness::eventually("a free place", || {
        let mut client = robot.client("telemetry");
        let _ = client.stream.write_all(b"7:version");
        client.next().is_some()
    });
}

#[test]
fn one_computer_cannot_keep_the_others_out() {
    let robot = robot(&["--connections", "8", "--address", "0.0.0.0"]);
    let mut crowd: Vec<Client> = (0..6).map(|_| robot.client("gamepad")).collect();
    harness::eventually("a full crowd", || {
        robot.status().contains("\nconnections 6 of ")
    });
    let mut refused = robot.client("control");
    assert_eq!(
        refused.next().as_deref(),
        Some("error: there are 6 connections from there already: close some")
    );
    assert_eq!(refused.next(), None);
    // The same machine by another of its addresses stands for another computer.
    let other = socket2::Socket::new(socket2::Domain::IPV4, socket2::Type::STREAM, None).unwrap();
    let at = |ip: [u8; 4], port: u16| std::net::SocketAddr::from((ip, port));
    other.bind(&at([127, 0, 0, 77], 0).into()).unwrap();
    other
        .connect(&at([127, 0, 0, 1], robot.port("control")).into())
        .unwrap();
    let mut other = Client::over(other.into());
    other.send("version");
    other.expect("version: 3.1.4");
    crowd.clear();
    harness::eventually("room again", || {
        robot.status().contains("\nconnections 1 of ")
    });
}
