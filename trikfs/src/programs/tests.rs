//! Tests of programs with small shell scripts.

use super::*;
use crate::scratch::Scratch;
use std::fs;
use std::os::unix::fs::PermissionsExt;

struct Rig {
    scratch: Scratch,
    programs: Arc<Programs>,
    commands: Commands,
}

impl Rig {
    /// A script that notes how it was called and then does this.
    fn new(script: &str) -> Self {
        let scratch = Scratch::new();
        let path = scratch.path("sensor");
        let calls = scratch.path("calls");
        let text = format!("#!/bin/sh\necho $1 >>{}\n{script}\n", calls.display());
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        fs::write(calls, "").unwrap();
        let command = |word: &str| CommandDescription {
            program: path.clone(),
            arguments: vec![word.to_owned()],
        };
        Self {
            scratch,
            programs: Programs::new(Arc::new(Log::new())),
            commands: Commands {
                start: command("start"),
                stop: Some(command("stop")),
            },
        }
    }

    fn use_one(&self) -> Result<Use, Error> {
        self.programs.use_one(&self.commands, true)
    }

    fn calls(&self) -> String {
        let calls = fs::read_to_string(self.scratch.path("calls")).unwrap();
        calls.replace('\n', " ")
    }
}

/// Waits for something that has to come.
fn eventually(what: &str, mut is_so: impl FnMut() -> bool) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !is_so() {
        assert!(Instant::now() < deadline, "{what}");
        std::thread::yield_now();
    }
}

fn settled(one: &Use) -> Progress {
    eventually("settled", || one.progress() != Progress::Starting);
    one.progress()
}

#[test]
fn the_first_user_starts_and_the_last_one_stops() {
    let rig = Rig::new("exit 0");
    let first = rig.use_one().unwrap();
    let second = rig.use_one().unwrap();
    assert!(matches!(settled(&first), Progress::Up(_)));
    drop(first);
    assert!(matches!(settled(&second), Progress::Up(_)));
    drop(second);
    // Who comes back at once finds it running.
    let third = rig.use_one().unwrap();
    assert!(matches!(third.progress(), Progress::Up(_)));
    drop(third);
    eventually("stopped", || rig.calls() == "start stop ");
    let again = rig.use_one().unwrap();
    assert!(matches!(settled(&again), Progress::Up(_)));
    assert_eq!(rig.calls(), "start stop start ");
}

#[test]
fn a_start_that_fails_is_told_and_not_tried_at_once() {
    let rig = Rig::new("echo first; echo no camera >&2; exit 3");
    let one = rig.use_one().unwrap();
    let Progress::Failed(reason) = settled(&one) else {
        panic!("not failed")
    };
    assert!(
        reason.ends_with("sensor start failed: exit status: 3, it said: no camera"),
        "{reason}"
    );
    drop(one);
    assert_eq!(rig.use_one().err(), Some(Error::NoDevice(reason)));
    assert_eq!(rig.calls(), "start ");
}

#[test]
fn a_program_that_is_missing_is_named() {
    let mut rig = Rig::new("");
    rig.commands.start.program = rig.scratch.path("absent");
    let one = rig.use_one().unwrap();
    let Progress::Failed(reason) = settled(&one) else {
        panic!("not failed")
    };
    assert!(
        reason.contains("absent start cannot be run: No such file or directory"),
        "{reason}"
    );
}

#[test]
fn what_a_start_leaves_running_can_go_on_writing() {
    let rig = Rig::new(
        "d=${0%/*}\ncase $1 in start) (while [ ! -e $d/go ]; do :; done; head -c 300000 /dev/zero; echo $? >$d/wrote) & ;; esac",
    );
    let one = rig.use_one().unwrap();
    assert!(matches!(settled(&one), Progress::Up(_)));
    fs::write(rig.scratch.path("go"), "").unwrap();
    eventually("all written", || {
        fs::read(rig.scratch.path("wrote")).is_ok_and(|text| text == b"0\n")
    });
}

#[test]
fn one_whose_work_has_vanished_is_stopped_and_started_again() {
    let rig = Rig::new("exit 0");
    let one = rig.use_one().unwrap();
    settled(&one);
    // Not seen yet: it is only slow.
    let second = rig.programs.use_one(&rig.commands, false).unwrap();
    assert!(matches!(second.progress(), Progress::Up(_)));
    one.saw_it();
    let third = rig.programs.use_one(&rig.commands, false).unwrap();
    eventually("restarted", || rig.calls() == "start stop start ");
    assert!(matches!(settled(&third), Progress::Up(_)));
}

#[test]
fn the_end_of_the_mount_stops_what_is_used() {
    let rig = Rig::new("exit 0");
    let one = rig.use_one().unwrap();
    settled(&one);
    rig.programs.stop_all(Duration::from_secs(60));
    assert_eq!(rig.calls(), "start stop ");
    assert_eq!(rig.use_one().err(), Some(Error::ShuttingDown));
}

#[test]
fn the_end_of_the_mount_cuts_a_start_that_hangs_short_and_stops_what_it_left() {
    let rig = Rig::new("[ $1 = stop ] || exec sleep 1000");
    let one = rig.use_one().unwrap();
    eventually("started", || rig.calls() == "start ");
    rig.programs.stop_all(Duration::from_secs(60));
    assert_eq!(rig.calls(), "start stop ");
    assert!(matches!(one.progress(), Progress::Failed(_)));
}
