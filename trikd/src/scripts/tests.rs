//! Names of programs, files that are replaced whole, and ways out of the folder that are none.

use super::*;
use harness::put;
use tempfile::tempdir;

#[test]
fn an_ending_is_the_same_in_capital_letters() {
    let given = ["a.FLOW", "b/A.Qrs", "a", ".js"].map(|name| ending(Path::new(name)));
    assert_eq!(given, ["flow", "qrs", "", ""]);
}

#[test]
fn only_files_that_are_really_in_the_folder_are_opened_to_be_read() {
    let home = tempdir().unwrap();
    let folder = home.path().join("scripts");
    fs::create_dir_all(folder.join("sub")).unwrap();
    put(home.path(), "secret", "x");
    put(&folder.join("sub"), "a.js", "1");
    let is_open = |name: &str| {
        let opened = open(&folder, &folder.join(name));
        opened.is_ok_and(|file| file.is_some())
    };
    assert!(is_open("sub/a.js"));
    std::os::unix::fs::symlink("../secret", folder.join("link.js")).unwrap();
    std::os::unix::fs::symlink("..", folder.join("up")).unwrap();
    fs::hard_link(home.path().join("secret"), folder.join("second.js")).unwrap();
    nix::unistd::mkfifo(&folder.join("pipe.js"), nix::sys::stat::Mode::S_IRWXU).unwrap();
    for name in [
        "link.js",
        "up/secret",
        "second.js",
        "pipe.js",
        "sub",
        "none.js",
    ] {
        assert!(!is_open(name), "{name}");
    }
    assert!(open(&folder, &home.path().join("secret")).is_ok_and(|file| file.is_none()));
    // To read makes nothing.
    let none = open(&folder, &folder.join("none/a.js"));
    assert_eq!(none.unwrap_err().kind(), std::io::ErrorKind::NotFound);
    assert!(!folder.join("none").exists());
}

#[test]
fn names_that_lead_elsewhere_are_refused_with_a_reason() {
    let folder = Path::new("/scripts");
    for (name, why) in [
        ("", "is empty"),
        ("../x", "leads out"),
        ("a/../../x", "leads out"),
        ("/etc/passwd", "absolute"),
        ("./x", "'.'"),
        (".hidden", "dot"),
        ("a/.b/c", "dot"),
        ("a/", "folder"),
        ("a\0b", "control"),
        ("a\nb", "control"),
        ("1/2/3/4/5/6/7/8/9/x", "too many"),
        (&"x".repeat(300), "too long"),
    ] {
        let refusal = locate(folder, name.as_bytes()).unwrap_err();
        assert!(refusal.to_string().contains(why), "{name}: {refusal}");
    }
    assert!(
        locate(folder, b"\xff")
            .unwrap_err()
            .to_string()
            .contains("UTF-8")
    );
    assert_eq!(
        locate(folder, b"a/b c.js").unwrap(),
        Path::new("/scripts/a/b c.js")
    );
}

#[test]
fn uploads_are_whole_binary_and_in_folders_that_are_made() {
    let scratch = tempdir().unwrap();
    let folder = scratch.path().join("new/scripts");
    let path = store(&folder, b"a/b.bin", b"x\0\xff").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"x\0\xff");
    store(&folder, b"a/b.bin", b"#!/bin/sh\n").unwrap();
    let mode = std::os::unix::fs::PermissionsExt::mode(&fs::metadata(&path).unwrap().permissions());
    assert_eq!(mode & 0o111, 0o111);
    assert_eq!(fs::read_dir(folder.join("a")).unwrap().count(), 1);
    assert_eq!(find(&folder, b"a/b.bin").unwrap(), path);
    assert!(
        find(&folder, b"none.js")
            .unwrap_err()
            .to_string()
            .contains("there is no program 'none.js'")
    );
    assert!(
        store(&folder, b"a", b"")
            .unwrap_err()
            .to_string()
            .contains("folder of this name")
    );
    assert!(
        store(&folder, b"a/b.bin/c", b"")
            .unwrap_err()
            .to_string()
            .contains("was not kept")
    );
}

#[test]
fn links_lead_nowhere() {
    let scratch = tempdir().unwrap();
    let folder = scratch.path().join("scripts");
    put(scratch.path(), "outside/x.js", "");
    fs::create_dir_all(&folder).unwrap();
    std::os::unix::fs::symlink(scratch.path().join("outside"), folder.join("l")).unwrap();
    assert!(
        store(&folder, b"l/y.js", b"")
            .unwrap_err()
            .to_string()
            .contains("link")
    );
    assert!(
        find(&folder, b"l/x.js")
            .unwrap_err()
            .to_string()
            .contains("link")
    );
    assert!(!scratch.path().join("outside/y.js").exists());
    assert!(
        store(&folder, b"l/new/y.js", b"")
            .unwrap_err()
            .to_string()
            .contains("link")
    );
    assert!(
        !scratch.path().join("outside/new").exists(),
        "no folder is made through a link"
    );
    std::os::unix::fs::symlink(scratch.path().join("outside/x.js"), folder.join("x.js")).unwrap();
    store(&folder, b"x.js", b"new").unwrap();
    assert_eq!(fs::read(scratch.path().join("outside/x.js")).unwrap(), b"");
    assert_eq!(fs::read(folder.join("x.js")).unwrap(), b"new");
}

#[test]
fn a_folder_that_becomes_a_link_while_an_upload_comes_leads_nowhere() {
    use std::sync::atomic::AtomicBool;
    let scratch = tempdir().unwrap();
    let (folder, outside) = (
        scratch.path().join("scripts"),
        scratch.path().join("outside"),
    );
    fs::create_dir_all(folder.join("f")).unwrap();
    fs::create_dir_all(&outside).unwrap();
    let link = scratch.path().join("link");
    std::os::unix::fs::symlink(&outside, &link).unwrap();
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                // What a program does that wants a file of the daemon elsewhere.
                nix::fcntl::renameat2(
                    nix::fcntl::AT_FDCWD,
                    &link,
                    nix::fcntl::AT_FDCWD,
                    &folder.join("f"),
                    nix::fcntl::RenameFlags::RENAME_EXCHANGE,
                )
                .unwrap();
            }
        });
        for _ in 0..300 {
            let _ = store(&folder, b"f/deep/x.js", b"");
        }
        is_over.store(true, Ordering::Relaxed);
    });
    assert_eq!(fs::read_dir(&outside).unwrap().count(), 0);
}

#[test]
fn a_file_that_cannot_be_replaced_stays_as_it_was() {
    let scratch = tempdir().unwrap();
    put(scratch.path(), "d/keep", "old");
    assert!(replace(&scratch.path().join("d"), b"new", 0o644).is_err());
    assert!(replace(&scratch.path().join("none/x"), b"new", 0o644).is_err());
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
}
