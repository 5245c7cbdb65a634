//! Uploads: names, sizes, binary content, a disk that is full.

use crate::rig::{frame, robot};
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
