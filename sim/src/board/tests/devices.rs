//! Devices behind FIFOs, read as programs read them.

use super::{board, read, wait, write};
use crate::board::Board;
use crate::limits::SAYINGS_MAX;
use std::fs::File;
use std::io::Read;
use std::os::unix::fs::OpenOptionsExt;
use std::process::Command;
use tempfile::tempdir;

/// Opens a FIFO without waiting for the board.
fn open(board: &Board, name: &str) -> Option<File> {
    let mut options = File::options();
    options.read(true).custom_flags(libc::O_NONBLOCK);
    options.open(board.root().join(name)).ok()
}

/// Reads until there are `count` bytes.
fn bytes(file: &mut File, count: usize) -> Vec<u8> {
    let mut all = Vec::new();
    wait("bytes of a device", || {
        let mut some = vec![0; count - all.len()];
        let got = file.read(&mut some).unwrap_or(0);
        all.extend_from_slice(&some[..got]);
        (all.len() == count).then_some(())
    });
    all
}

/// One line of text.
fn line(file: &mut File) -> String {
    let mut text = Vec::new();
    loop {
        let next = bytes(file, 1)[0];
        if next == b'\n' {
            return String::from_utf8(text).unwrap();
        }
        text.push(next);
    }
}

fn enable(board: &Board, device: &str, channel: &str) {
    let folder = format!("sys/bus/iio/devices/{device}");
    for name in ["x", "y", "z"] {
        write(
            board,
            &format!("{folder}/scan_elements/in_{channel}_{name}_en"),
            "1",
        );
    }
    write(
        board,
        &format!("{folder}/scan_elements/in_timestamp_en"),
        "1",
    );
    write(board, &format!("{folder}/buffer/enable"), "1");
}

#[test]
fn the_accelerometer_gives_gravity_in_its_own_bytes() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let name = read(&board, "sys/bus/iio/devices/iio:device0/name").unwrap();
    assert_eq!(name, "mma8451\n");
    let mut file = open(&board, "dev/iio:device0").unwrap();
    enable(&board, "iio:device0", "accel");
    let scans = bytes(&mut file, 3 * 16);
    let time = |scan: &[u8]| i64::from_le_bytes(scan[8..16].try_into().unwrap());
    for scan in scans.chunks(16) {
        let z = i16::from_be_bytes([scan[4], scan[5]]) >> 2;
        assert!((4096 - z).abs() < 100, "{z}");
        assert_eq!(scan[6..8], [0, 0]);
    }
    let step_ns = time(&scans[32..]) - time(&scans[16..]);
    assert_eq!(step_ns, 20_000_000, "50 Hz");
}

#[test]
fn the_gyroscope_turns_with_the_robot_and_rests_while_its_buffer_is_off() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let mut file = open(&board, "dev/iio:device1").unwrap();
    enable(&board, "iio:device1", "anglvel");
    let z = |scan: &[u8]| i32::from(i16::from_le_bytes([scan[4], scan[5]]));
    let at_rest = z(&bytes(&mut file, 16));
    board.shared.machine().msp430.duty = [0, 0, 20, -20];
    // The left wheel goes back and the right one forward: counter-clockwise.
    wait("a turn to the left", || {
        (z(&bytes(&mut file, 16)) > at_rest + 5000).then_some(())
    });
    write(&board, "sys/bus/iio/devices/iio:device1/buffer/enable", "0");
    wait("silence", || {
        let mut rest = [0; 4096];
        let mut taken = 0;
        while let Ok(count @ 1..) = file.read(&mut rest) {
            taken += count;
        }
        let until = board.view().time_s + 0.05;
        wait("time", || (board.view().time_s > until).then_some(()));
        (taken == 0).then_some(())
    });
}

#[test]
fn an_unplugged_gyroscope_has_no_node_and_garbage_is_no_sample() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    write(&board, "faults/gyroscope", "unplug");
    wait("end of the node", || {
        (!board.root().join("dev/iio:device1").exists()).then_some(())
    });
    write(&board, "faults/gyroscope", "stuck");
    let mut file = wait("node", || open(&board, "dev/iio:device1"));
    enable(&board, "iio:device1", "anglvel");
    let scans = bytes(&mut file, 64);
    assert_eq!(scans[..6], scans[48..54], "stuck");
    write(&board, "faults/gyroscope", "garbage");
    wait("bytes in the padding", || {
        (bytes(&mut file, 16)[6..8] != [0, 0]).then_some(())
    });
}

/// Type, code and value of the events in one packet.
#[cfg(target_pointer_width = "64")]
fn packet(file: &mut File) -> Vec<(u16, u16, i32)> {
    let mut events = Vec::new();
    loop {
        let event = bytes(file, 24);
        let word = |at: usize| u16::from_ne_bytes([event[at], event[at + 1]]);
        let value = i32::from_ne_bytes(event[20..].try_into().unwrap());
        if word(16) == 0 {
            return events;
        }
        events.push((word(16), word(18), value));
    }
}

#[test]
#[cfg(target_pointer_width = "64")]
fn an_ultrasonic_sensor_tells_its_distance_first_and_then_only_changes() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let expected = board.view().ultrasonic_m[0].unwrap() * 100.0;
    let mut file = open(&board, "dev/input/by-path/platform-trik_jd1-event").unwrap();
    let events = packet(&mut file);
    assert_eq!((events[0].0, events[0].1), (3, 0x19));
    assert!(
        (f64::from(events[0].2) - expected).abs() < 3.0,
        "{events:?} {expected}"
    );
    assert_eq!(events[1].1, 0x28);
    let mut last = [events[0].2, events[1].2];
    for _ in 0..3 {
        for (_, code, value) in packet(&mut file) {
            let index = usize::from(code == 0x28);
            assert_ne!(value, last[index], "no change is no event");
            last[index] = value;
        }
    }
    let mut empty = open(&board, "dev/input/by-path/platform-trik_jf1-event").unwrap();
    assert_eq!(packet(&mut empty)[0].2, -1, "nothing is plugged into D3");
}

#[test]
#[cfg(target_pointer_width = "64")]
fn keys_are_pressed_from_outside() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let mut file = open(
        &board,
        "dev/input/by-path/platform-soc@1c00000:gpio-keys-event",
    )
    .unwrap();
    assert_eq!(packet(&mut file).len(), 7, "all keys, as they are");
    write(
        &board,
        "control/keys",
        "press enter\npress nothing\nclick up\n",
    );
    assert_eq!(packet(&mut file), [(1, 28, 1)]);
    assert_eq!(packet(&mut file), [(1, 103, 1)]);
    assert_eq!(packet(&mut file), [(1, 103, 0)]);
    let complaint = board.root().join("control/keys.error");
    let told = || std::fs::read_to_string(&complaint).unwrap_or_default();
    for (text, reason) in [
        (
            "press nothing\n",
            "'press nothing' does not name one of the keys power, up, esc, left, right, down, enter\n",
        ),
        (
            "push up\n",
            "'push up' does not begin with press, release or click\n",
        ),
        (
            "press up now\n",
            "'press up now' does not name one of the keys power, up, esc, left, right, down, enter\n",
        ),
        (
            "press \u{7}up\n",
            "a line is printable and has at most 256 bytes\n",
        ),
    ] {
        write(&board, "control/keys", text);
        wait(reason, || (told() == reason).then_some(()));
    }
    write(&board, "control/keys", "press up\nrelease up\n");
    wait("no complaint", || (!complaint.exists()).then_some(()));
    assert_eq!(packet(&mut file), [(1, 103, 1)]);
    assert_eq!(packet(&mut file), [(1, 103, 0)]);
    drop(file);
    // At once, before the board can have seen that there was nobody.
    let mut file = open(
        &board,
        "dev/input/by-path/platform-soc@1c00000:gpio-keys-event",
    )
    .unwrap();
    let rest = packet(&mut file);
    assert!(rest.contains(&(1, 28, 1)), "it is still pressed: {rest:?}");
}

#[test]
fn the_lidar_sends_whole_packets_and_sees_the_room() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let mut file = open(&board, "dev/ttyS1").unwrap();
    let mut seen = Vec::new();
    for _ in 0..16 {
        let head = bytes(&mut file, 8);
        assert_eq!([head[0], head[3], head[4], head[5]], [0xAA, 1, 0x61, 0xAD]);
        let length = usize::from(u16::from_be_bytes([head[1], head[2]]));
        let rest = bytes(&mut file, length + 2 - 8);
        let whole = [head, rest].concat();
        let sum: u32 = whole[..length].iter().map(|&byte| u32::from(byte)).sum();
        assert_eq!(whole[length..], ((sum & 0xFFFF) as u16).to_be_bytes());
        let start = u16::from_be_bytes([whole[11], whole[12]]);
        let raw = u16::from_be_bytes([whole[14], whole[15]]);
        seen.push((start, f64::from(raw) / 4000.0));
    }
    seen.sort_by_key(|probe| probe.0);
    let angles: Vec<u16> = seen.iter().map(|probe| probe.0).collect();
    assert_eq!(angles, (0..16).map(|n| n * 2250).collect::<Vec<_>>());
    // It stands at (0.8, 1.0) and looks to the right: a box at x = 1.3, walls at y = 0 (clockwise), x = 0 and y = 2.
    for (index, metres) in [(0, 0.5), (4, 1.0), (8, 0.8), (12, 1.0)] {
        assert!((seen[index].1 - metres).abs() < 0.02, "{:?}", seen[index]);
    }
}

fn sensor(board: &Board, name: &str, order: &str) -> std::process::ExitStatus {
    let script = board
        .root()
        .join(format!("etc/init.d/{name}-sensor-ov7670"));
    Command::new(script).arg(order).status().unwrap()
}

#[test]
fn a_line_sensor_is_started_read_told_and_stopped() {
    let scratch = tempdir().unwrap();
    let body = crate::robots::by_name("line-follower").unwrap().body();
    let board = Board::start(
        &scratch.path().join("board"),
        body,
        super::Options::default(),
    )
    .unwrap();
    assert!(open(&board, "run/line-sensor.out.fifo").is_none());
    assert!(sensor(&board, "line", "start").success());
    let mut file = open(&board, "run/line-sensor.out.fifo").unwrap();
    let first = line(&mut file);
    let numbers: Vec<i32> = first
        .strip_prefix("loc: ")
        .unwrap()
        .split(' ')
        .map(|word| word.parse().unwrap())
        .collect();
    assert!(
        numbers[0].abs() < 10 && numbers[2] > 2,
        "the line is ahead: {first}"
    );
    write(&board, "run/line-sensor.in.fifo", "detect\n");
    let found = wait("colours", || {
        Some(line(&mut file)).filter(|line| line.starts_with("hsv: "))
    });
    assert_eq!(found.split(' ').count(), 7);
    // What is searched for is white now, and nearly all is white.
    write(
        &board,
        "run/line-sensor.in.fifo",
        "hsv 0 359 0 30 80 100\nvideo_out 0\nnonsense\n",
    );
    wait("a white line", || {
        let text = line(&mut file);
        (text.rsplit(' ').next()?.parse::<i32>().ok()? > 70).then_some(())
    });
    assert!(sensor(&board, "object", "start").success());
    wait("end of the line sensor", || {
        (!board.root().join("run/line-sensor.out.fifo").exists()).then_some(())
    });
    let mut file = open(&board, "run/object-sensor.out.fifo").unwrap();
    assert!(line(&mut file).starts_with("loc: "));
    assert!(sensor(&board, "object", "stop").success());
    wait("end of the object sensor", || {
        (!board.root().join("run/object-sensor.in.fifo").exists()).then_some(())
    });
}

#[test]
fn a_colour_sensor_tells_a_grid_and_an_unplugged_camera_ends_it() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    assert!(sensor(&board, "mxn", "start").success());
    let mut file = open(&board, "run/mxn-sensor.out.fifo").unwrap();
    assert_eq!(line(&mut file).split(' ').count(), 10);
    write(&board, "run/mxn-sensor.in.fifo", "mxn 4 4\nmxn 1 2\n");
    wait("a smaller grid", || {
        (line(&mut file).split(' ').count() == 3).then_some(())
    });
    write(&board, "faults/camera", "garbage");
    wait("garbage", || {
        let mut some = [0; 256];
        let count = file.read(&mut some).unwrap_or(0);
        some[..count]
            .iter()
            .any(|byte| !byte.is_ascii())
            .then_some(())
    });
    write(&board, "faults/camera", "unplug");
    wait("end of the sensor", || {
        (!board.root().join("run/mxn-sensor.out.fifo").exists()).then_some(())
    });
}

#[test]
fn the_gamepad_and_speech_go_through() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let mut file = open(&board, "run/gamepad-service.out.fifo").unwrap();
    // The board finds its new reader within its tick.
    let text = wait("a line of the gamepad", || {
        write(&board, "control/gamepad", "pad 1 50 0\n");
        let mut some = [0; 11];
        (file.read(&mut some).ok()? == 11).then(|| some.to_vec())
    });
    assert_eq!(text, b"pad 1 50 0\n");
    let say = Command::new(board.root().join("etc/trik/say"))
        .args(["hello", "world"])
        .status();
    assert!(say.unwrap().success());
    wait("words", || {
        (board.view().said == "hello world").then_some(())
    });
    for (program, words, heard) in [
        (
            "usr/lib/trikfs/tone",
            "440 500",
            "(a tone of 440 Hz for 500 ms)",
        ),
        ("usr/bin/aplay", "/dev/null", "(/dev/null is played)"),
    ] {
        let status = Command::new(board.root().join(program)).arg(words).status();
        assert!(status.unwrap().success(), "{program}");
        wait(heard, || (board.view().said == heard).then_some(()));
    }
    let all = [
        "hello world",
        "(a tone of 440 Hz for 500 ms)",
        "(/dev/null is played)",
    ];
    assert_eq!(board.take_said(), all);
    assert!(board.take_said().is_empty());
    let lines: Vec<String> = (0..=SAYINGS_MAX).map(|number| number.to_string()).collect();
    for line in &lines {
        write(&board, "control/say", &format!("{line}\n"));
        wait(line, || (board.view().said == *line).then_some(()));
    }
    assert_eq!(board.take_said(), lines[1..]);
}

#[test]
fn a_reader_that_never_reads_stops_nobody() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "board");
    let _lazy: Vec<File> = ["dev/ttyS1", "dev/iio:device0", "dev/iio:device1"]
        .map(|name| open(&board, name).unwrap())
        .into();
    enable(&board, "iio:device0", "accel");
    write(
        &board,
        "sys/bus/iio/devices/iio:device0/sampling_frequency",
        "800",
    );
    // Long enough to fill a FIFO of 4096 bytes with the lidar's 111 bytes 96 times a second.
    let until = board.view().time_s + 0.6;
    wait("time", || (board.view().time_s > until).then_some(()));
    write(&board, "control/say", "still here\n");
    wait("words", || {
        (board.view().said == "still here").then_some(())
    });
}

#[test]
fn what_is_written_to_the_frame_buffer_can_be_seen_as_a_picture() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "bare");
    let picture = board.root().join("display.ppm");
    let head = b"P6\n320 240\n255\n";
    let dark = std::fs::read(&picture).unwrap();
    assert!(dark.starts_with(head) && dark[head.len()..].iter().all(|&byte| byte == 0));
    assert_eq!(dark.len(), head.len() + 3 * 320 * 240);
    let display = File::options()
        .write(true)
        .open(board.root().join("dev/fb0"));
    // The second pixel is red.
    std::os::unix::fs::FileExt::write_all_at(&display.unwrap(), &[0x00, 0xf8], 2).unwrap();
    wait("a picture", || {
        let seen = std::fs::read(&picture).unwrap();
        (seen[head.len()..][..9] == [0, 0, 0, 255, 0, 0, 0, 0, 0]).then_some(())
    });
}

#[test]
fn the_encoder_gives_pictures_of_what_the_camera_sees() {
    let scratch = tempdir().unwrap();
    let board = board(&scratch, "two-wheels");
    let script = board.root().join("etc/init.d/mjpg-encoder-ov7670");
    let run = |word: &str| {
        Command::new(&script)
            .args([word, "--jpeg-qual", "50"])
            .status()
            .unwrap()
    };
    assert!(run("start").success());
    let mut out = open(&board, "run/mjpg-encoder.out.fifo").unwrap();
    let mut file = bytes(&mut out, 2);
    assert_eq!(file, [0xff, 0xd8]);
    while !file.ends_with(&[0xff, 0xd9]) {
        file.extend(bytes(&mut out, 1));
    }
    let seen = screen::picture::decode(&file).unwrap();
    assert_eq!((seen.width(), seen.height()), (320, 240));
    // At (0.8, 1.0) it looks at a box: floor at the bottom.
    let floor = seen.at(160, 235).unwrap();
    assert!(floor.red > 200 && floor.green > 200, "{floor:?}");
    assert!(run("stop").success());
    let fifo = board.root().join("run/mjpg-encoder.out.fifo");
    wait("no pipe", || (!fifo.exists()).then_some(()));
}
