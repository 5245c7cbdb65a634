//! Uploads: names, sizes, binary content, a disk that is full.

use crate::rig::{Robot, frame, robot};
use harness::eventually;
use std::process::Command;

#[test]
fn hostile_names_are_refused_one_by_one_and_nothing_is_written_outside() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    for name in [
        "../esc.txt",
        "/etc/trikd-test",
        "a/../../esc.txt",
        ".hidden",
        "",
        "a/",
        "..",
        "x\u{1}y",
    ] {
        client.send(&format!("file:{name}:text"));
        let told = client.next().unwrap();
        assert!(
            told.starts_with("error: '") && told.contains("cannot be the name"),
            "{name}: {told}"
        );
    }
    client.raw(b"13:file:\xff\xfe:textx");
    assert!(client.next().unwrap().contains("UTF-8"));
    client.send("file:no second colon");
    client.sync();
    assert!(!robot.home.path("esc.txt").exists());
    assert_eq!(
        std::fs::read_dir(robot.home.path("scripts"))
            .unwrap()
            .count(),
        0
    );
}

#[test]
fn uploads_keep_every_byte_make_folders_and_replace_what_was_there() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let bytes: Vec<u8> = (0..1_000_000u32)
        .map(|number| number.to_le_bytes()[1])
        .collect();
    for (name, content) in [
        ("deep/er/big.bin", &bytes[..]),
        ("a.js", b"old and longer"),
        ("a.js", b"new"),
    ] {
        let mut payload = format!("file:{name}:").into_bytes();
        payload.extend_from_slice(content);
        client.raw(format!("{}:", payload.len()));
        client.raw(&payload);
    }
    client.sync();
    assert_eq!(robot.home.content("scripts/deep/er/big.bin"), bytes);
    assert_eq!(robot.home.content("scripts/a.js"), b"new");
    let names = std::fs::read_dir(robot.home.path("scripts"))
        .unwrap()
        .count();
    assert_eq!(names, 2, "nothing unfinished is left");
}

#[test]
fn an_upload_that_is_broken_off_leaves_the_old_program() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.send("file:a.js:good");
    client.sync();
    let whole = frame("file:a.js:half of it");
    client.raw(&whole[..whole.len() - 3]);
    drop(client);
    robot.client("control").sync();
    assert_eq!(robot.home.content("scripts/a.js"), b"good");
}

#[test]
fn a_full_disk_is_told_and_the_old_program_stays() {
    let home = crate::rig::small_tree();
    let scripts = home.path("scripts");
    std::fs::create_dir_all(&scripts).unwrap();
    let mount = |words: &[&str]| Command::new("mount").args(words).arg(&scripts).status();
    if !mount(&["-t", "tmpfs", "-o", "size=64k", "none"]).is_ok_and(|status| status.success()) {
        return harness::skip("nothing can be mounted here");
    }
    let tree = home.path("tree");
    let robot = crate::rig::Robot::start(home, tree, &[]);
    let mut client = robot.client("control");
    client.send("file:a.js:good");
    client.sync();
    client.send(&format!("file:a.js:{}", "x".repeat(200_000)));
    let told = client.next().unwrap();
    client.sync();
    let content = robot.home.content("scripts/a.js");
    let _ = Command::new("umount").arg("-l").arg(&scripts).status();
    assert!(
        told.starts_with("error: 'a.js' was not kept") && told.contains("the disk is full"),
        "{told}"
    );
    assert_eq!(content, b"good");
}

#[test]
fn an_upload_is_heard_and_the_end_of_a_program_is_seen() {
    let prepared = |words: &[&str]| {
        let home = crate::rig::small_tree();
        for (file, content) in [
            ("sound/tone/value", ""),
            ("led/green/value", "0\n"),
            ("led/red/value", "1\n"),
        ] {
            let path = home.path(&format!("tree/{file}"));
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, content).unwrap();
        }
        let tree = home.path("tree");
        Robot::start(home, tree, words)
    };
    let run = |robot: &Robot| {
        let mut client = robot.client("control");
        client.send("file:a.py:print(1)");
        client.send("run:a.py");
        client.until("info: a.py has ended");
    };
    let robot = prepared(&[]);
    run(&robot);
    let content = |robot: &Robot, name: &str| robot.home.content(&format!("tree/{name}/value"));
    eventually("a beep and a green light", || {
        content(&robot, "sound/tone") == b"2500 150\n"
            && content(&robot, "led/green") == b"1\n"
            && content(&robot, "led/red") == b"0\n"
    });
    let robot = prepared(&["--without", "feedback"]);
    run(&robot);
    assert_eq!(content(&robot, "sound/tone"), b"");
    assert_eq!(content(&robot, "led/green"), b"0\n");
}
