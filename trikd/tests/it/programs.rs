//! Programs: how they are run, what they say, and that all ways out lead to rest with nothing left behind.

use crate::rig::{Client, Robot, robot};
use harness::{eventually, processes};
use std::os::unix::fs::PermissionsExt;
use std::time::Instant;

/// Uploads and runs a program, and waits for the message that it has started.
pub fn run(client: &mut Client, name: &str, text: &str) {
    client.send(&format!("file:{name}:{text}"));
    client.send(&format!("run:{name}"));
    client.expect(&format!("info: {name} has started"));
}

/// Ends by `stop` whatever runs; insists on rest, on the message, and that no process is left.
fn stopped(robot: &Robot, client: &mut Client, name: &str) {
    robot.forget_rest();
    client.send("stop");
    let told = client.until("info: ");
    assert!(
        told.starts_with(&format!("info: {name} was stopped by a client after ")),
        "{told}"
    );
    assert!(robot.has_rested());
    assert_eq!(processes::children(robot.daemon()), [0u32; 0]);
}

#[test]
fn a_python_program_prints_line_by_line_and_uses_the_robot() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let text = "print('in', 'main')\n\
                print(brick.sensor(A1).read(), brick.sensor('D1').read(), brick.encoder(E1).read())\n\
                print(brick.motor('Z9'), brick.sensor('../A1'))\n\
                brick.motor(M1).setPower(250)\nprint('\u{43f}\u{440}', end='')";
    run(&mut client, "a.py", text);
    client.expect("print: in main\n");
    client.expect("print: 27 -1 90\n");
    client.expect("info: brick.motor(Z9): nothing is plugged in there; plugged in are M1");
    client.expect("info: brick.sensor(../A1): nothing is plugged in there; plugged in are A1, D1");
    client.expect("print: None None\n");
    client.expect("print: \u{43f}\u{440}");
    let told = client.next().unwrap();
    assert!(told.starts_with("info: a.py has ended after "), "{told}");
    assert_eq!(robot.home.content("tree/motors/M1/value"), b"100\n");
    assert!(robot.has_rested());
}

#[test]
fn threads_of_a_python_program_share_variables_and_send_messages() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let text = "count = 0\n\
                def work():\n  global count\n  count += 1\n  Threading.sendMessage('main', count)\n\
                def idle():\n  while True:\n    script.wait(1)\n\
                Threading.startThread('idle', idle)\n\
                Threading.startThread('work', work)\n\
                print(Threading.receiveMessage(), repr(Threading.receiveMessage(False)))\n\
                Threading.joinThread('work')\n\
                Threading.killThread('idle')\nThreading.joinThread('idle')\nprint(count)\n";
    run(&mut client, "t.py", text);
    client.expect("print: 1 ''\n");
    client.expect("print: 1\n");
    let told = client.next().unwrap();
    assert!(told.starts_with("info: t.py has ended after "), "{told}");
}

#[test]
fn a_python_program_draws_on_the_display() {
    let robot = robot(&[]);
    std::fs::create_dir_all(robot.home.path("tree/display")).unwrap();
    robot.home.file("tree/display/device", "");
    let mut client = robot.client("control");
    let text = "d = brick.display()\nd.setPainterColor('red')\nd.drawRect(10, 10, 20, 20, True)\n\
                d.addLabel('\u{43f}\u{440}\\n2', 100, 100, 20)\nd.redraw()\n\
                d.setPainterColor('reddish')\nd.setPainterColor('reddish')\n\
                print(brick.pwmCapture('S1'))\n\
                try:\n  brick.i2c(1, 2)\nexcept ValueError as e:\n  print(e)\n";
    run(&mut client, "d.py", text);
    let told = client.next().unwrap();
    assert!(
        told.starts_with("info: display.setPainterColor: 'reddish' is no colour;"),
        "{told}"
    );
    client.expect("print: None\n");
    client.expect("print: address 2 is not 3 to 119 (0x77)\n");
    let told = client.next().unwrap();
    assert!(told.starts_with("info: d.py has ended after "), "{told}");
    let bytes = robot.home.content("tree/display/device");
    let pixel = |x: usize, y: usize| [bytes[2 * (320 * y + x)], bytes[2 * (320 * y + x) + 1]];
    assert_eq!((pixel(15, 15), pixel(5, 5)), ([0x00, 0xf8], [0xff, 0xff]));
    assert!((100..140).any(|x| pixel(x, 110) == [0x00, 0xf8]), "no text");
    assert!(
        (100..140).any(|x| pixel(x, 130) == [0x00, 0xf8]),
        "no second line"
    );
}

#[test]
fn two_clients_hear_the_same_and_a_failure_is_a_traceback() {
    let robot = robot(&[]);
    let (mut one, mut other) = (robot.client("control"), robot.client("control"));
    other.sync();
    // Python may take longer to begin than a client may be silent.
    other.keep_alive();
    run(&mut one, "b.py", "x = 1\nprint(x)\ny = undefined\n");
    other.expect("info: b.py has started");
    for client in [&mut one, &mut other] {
        client.expect("print: 1\n");
        let told = client.next().unwrap();
        assert!(
            told.starts_with("error: Traceback (most recent call last):\n"),
            "{told}"
        );
        assert!(
            told.contains("b.py\", line 3")
                && told.ends_with("NameError: name 'undefined' is not defined\n"),
            "{told}"
        );
        assert!(!told.contains("trik.py"), "{told}");
        assert!(
            client
                .next()
                .unwrap()
                .starts_with("info: b.py has failed with exit code 1 ")
        );
    }
}

#[test]
fn executables_run_and_their_failures_are_told() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    run(
        &mut client,
        "s",
        "#!/bin/sh\necho out; echo err >&2; cat \"$TRIK_TREE/sensors/A1/value\"; read x || echo empty; exit 3\n",
    );
    let mut lines: Vec<String> = (0..4).map(|_| client.next().unwrap()).collect();
    lines.sort();
    assert_eq!(
        lines,
        [
            "print: 27\n",
            "print: empty\n",
            "print: err\n",
            "print: out\n"
        ]
    );
    let told = client.next().unwrap();
    assert!(
        told.starts_with("error: s has failed with exit code 3 after "),
        "{told}"
    );
    run(&mut client, "k", "#!/bin/sh\nkill -SEGV $$\n");
    let told = client.next().unwrap();
    assert!(
        told.starts_with("error: k was killed by SIGSEGV after "),
        "{told}"
    );
    run(&mut client, "i", "#!/no/such/interpreter\n");
    assert!(client.next().unwrap().starts_with("print: trikd: "));
    assert!(
        client
            .next()
            .unwrap()
            .starts_with("error: i has failed with exit code 1 ")
    );
}

#[test]
fn stop_ends_whatever_a_program_does_and_leaves_nothing() {
    let robot = robot(&["--memory-mib", "512"]);
    let mut client = robot.client("control");
    let ignores = "import signal, time\nfor s in range(1, 65):\n  try: signal.signal(s, signal.SIG_IGN)\n  except (OSError, ValueError): pass\n";
    for (name, text) in [
        ("wait.py", "print('go')\nscript.wait(100000)".to_owned()),
        ("loop.py", "print('go')\nwhile True: pass".to_owned()),
        ("motors.py", "print('go')\nwhile True: brick.motor(M1).setPower(50)".to_owned()),
        ("deaf.py", format!("{ignores}print('go')\ntime.sleep(1000)")),
        ("events.py", "t = script.timer(10)\nt.timeout.connect(lambda: print('go'))\nscript.run()".to_owned()),
        ("read.py", "import os\nos.mkfifo('f') if not os.path.exists('f') else 0\nprint('go')\nopen('f').read()".to_owned()),
        ("child", "#!/bin/sh\necho go; sleep 1000 & (setsid sleep 1000 &) ; setsid sh -c 'sleep 1000 & sleep 1000' & wait\n".to_owned()),
        ("orphan", "#!/bin/sh\n(setsid setsid sh -c 'trap \"\" TERM HUP; sleep 1000; sleep 1000' >/dev/null 2>&1 &); echo go; sleep 1000\n".to_owned()),
    ] {
        run(&mut client, name, &text);
        client.until("print: go");
        stopped(&robot, &mut client, name);
    }
}

#[test]
fn a_program_with_too_many_processes_is_ended_and_others_are_served_meanwhile() {
    let robot = robot(&["--processes", "20"]);
    let mut client = robot.client("control");
    // A number that any machine bears: as root the kernel sets no limit, and trikd counts.
    run(
        &mut client,
        "many",
        "#!/bin/sh\ni=0\nwhile [ $i -lt 60 ]; do sleep 1000 & i=$((i + 1)); done\nwait\n",
    );
    // As another user than root the fork fails, and the program ends by itself.
    let told = loop {
        let told = client.next().unwrap();
        if told.contains("many was stopped")
            || told.contains("many has ended")
            || told.starts_with("error: ")
        {
            break told;
        }
    };
    eventually("nobody is left", || {
        processes::children(robot.daemon()).is_empty()
    });
    client.sync();
    assert!(
        told.starts_with("error: ") || told.contains("was stopped"),
        "{told}"
    );
}

#[test]
fn a_program_that_eats_memory_fails_alone() {
    let robot = robot(&["--memory-mib", "200"]);
    let mut client = robot.client("control");
    run(
        &mut client,
        "greedy.py",
        "a = []\nwhile True: a.append(bytearray(1 << 20))",
    );
    let told = client.until("error: ");
    assert!(told.contains("MemoryError"), "{told}");
    client.sync();
}

#[test]
fn a_flood_of_output_is_cut_and_the_program_goes_on() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    run(
        &mut client,
        "flood.py",
        "import time\nfor i in range(20000): print(i)\nwhile True: time.sleep(0.1); print('end')",
    );
    let told = client.until("info: ");
    assert!(
        told.contains(" messages of the program were left out"),
        "{told}"
    );
    // Said until there is room for it again.
    client.until("print: end\n");
    client.send("stop");
    client.until("info: flood.py was stopped");
}

/// A burst kept its beginning and lost its end, where the reason for it stands.
#[test]
fn the_last_lines_of_a_chatty_program_arrive() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let text = "for i in range(5000): print(i)\nprint('the reason')\nraise SystemExit(3)";
    run(&mut client, "chatty.py", text);
    client.expect("print: 0\n");
    let told = client.until("info: ");
    assert!(
        told.contains(" messages of the program were left out"),
        "{told}"
    );
    client.until("print: 4999\n");
    client.expect("print: the reason\n");
}

#[test]
fn direct_commands_share_variables_and_survive_errors() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    // The language of the last program counts.
    run(&mut client, "p.py", "pass");
    client.until("info: p.py has ended");
    client.send("direct:x = 20");
    client.send("direct:y = undefined");
    client.send("direct:print(x + 1)");
    let told = client.next().unwrap();
    assert!(
        told.starts_with("error: Traceback") && told.contains("NameError"),
        "{told}"
    );
    client.expect("print: 21\n");
    robot.forget_rest();
    client.send("stop");
    eventually("rest", || robot.has_rested());
    client.send("direct:print(x)");
    assert!(client.next().unwrap().contains("NameError"));
}

#[test]
fn a_new_program_takes_the_place_of_the_old_one() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    run(&mut client, "one.py", "print('one')\nwhile True: pass");
    client.expect("print: one\n");
    robot.forget_rest();
    client.send("file:two.py:print('two')");
    client.send("run:two.py");
    assert!(
        client
            .next()
            .unwrap()
            .starts_with("info: one.py was stopped by another program ")
    );
    assert!(robot.has_rested());
    client.expect("info: two.py has started");
    client.expect("print: two\n");
    client.until("info: two.py has ended");
    client.send("run:none.py");
    let told = client.next().unwrap();
    assert!(
        told.starts_with("error: there is no program 'none.py' in "),
        "{told}"
    );
    // What Studio sends at every stop.
    client.send("stop");
    client.send("directScript:script.system(\"killall aplay\");");
    client.sync();
}

#[test]
fn a_program_goes_on_when_its_client_leaves_and_ends_with_trikd() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    run(&mut client, "on.py", "print('go')\nwhile True: pass");
    client.expect("print: go\n");
    drop(client);
    let mut other = robot.client("control");
    other.sync();
    let children = processes::children(robot.daemon());
    assert_eq!(children.len(), 1, "{}", robot.log());
    robot.forget_rest();
    let stop = robot.tree.join("stop");
    let start = Instant::now();
    let tree_had_rest = {
        // The folder goes with the robot, so it is looked at in between.
        harness::processes::signal(robot.guardian(), nix::sys::signal::Signal::SIGTERM);
        eventually("rest", || {
            std::fs::read(&stop).is_ok_and(|text| text == b"1\n")
        });
        eventually("no program", || !processes::is_alive(children[0]));
        start.elapsed()
    };
    println!("rest and end after {tree_had_rest:?}");
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn the_stop_key_ends_the_program() {
    let home = crate::rig::small_tree();
    let path = home.path("tree/keys/device");
    nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU).unwrap();
    let tree = home.path("tree");
    let robot = Robot::start(home, tree, &[]);
    let mut client = robot.client("control");
    run(&mut client, "on.py", "print('go')\nwhile True: pass");
    client.expect("print: go\n");
    robot.forget_rest();
    let event = |power: i32, up: i32| -> Vec<u8> {
        [power, up, 0, 0, 0, 0, 0]
            .iter()
            .flat_map(|key| key.to_ne_bytes())
            .collect()
    };
    let mut keys = std::fs::File::options().write(true).open(path).unwrap();
    for bytes in [event(0, 1), event(0, 0), event(1, 0)] {
        std::io::Write::write_all(&mut keys, &bytes).unwrap();
    }
    let told = client.next().unwrap();
    assert!(
        told.starts_with("info: on.py was stopped by the stop key after "),
        "{told}"
    );
    assert!(robot.has_rested());
}

#[test]
fn programs_of_another_user_have_its_rights_and_leave_nobody_behind() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can start programs as another user");
    }
    let home = crate::rig::small_tree();
    for name in ["scripts", "run"] {
        std::fs::create_dir_all(home.path(name)).unwrap();
    }
    let tree = home.path("tree");
    let robot = Robot::start(home, tree, &["--user", "games", "--processes", "30"]);
    let mut client = robot.client("control");
    run(
        &mut client,
        "who",
        "#!/bin/sh\nid -un; echo x > $TRIK_TREE/motors/M1/value; kill -9 $PPID; cd /tmp; (setsid setsid sleep 1000 &); echo go; sleep 1000\n",
    );
    client.until("print: games\n");
    client.until("print: go\n");
    assert_eq!(
        robot.home.content("tree/motors/M1/value"),
        b"0\n",
        "the plain tree is root's"
    );
    stopped(&robot, &mut client, "who");
    run(
        &mut client,
        "py.py",
        "import os\nprint(os.getuid() != 0)\nopen('own', 'w').write('x')",
    );
    client.expect("print: True\n");
    client.until("info: py.py has ended");
    run(
        &mut client,
        "bomb",
        "#!/bin/sh\nbomb() { setsid $0 & setsid $0 & }\nbomb 2>/dev/null\nsleep 1000\n",
    );
    let user = nix::unistd::User::from_name("games").unwrap().unwrap();
    eventually("a bomb", || trikd::program::kill::of_user(user.uid) > 10);
    client.send("stop");
    client.until("info: bomb was stopped by a client");
    eventually("nobody is left", || {
        processes::children(robot.daemon()).is_empty()
    });
    let unknown = crate::rig::command(
        &crate::rig::small_tree(),
        &robot.tree,
        &["--user", "nosuchuser"],
    )
    .output()
    .unwrap();
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("there is no such user"));
}

#[test]
fn without_a_tree_programs_run_and_the_lack_of_rest_is_told() {
    let home = harness::Board::new();
    let tree = home.path("nothing");
    let robot = Robot::start(home, tree, &[]);
    let mut client = robot.client("control");
    client.send("stop");
    let told = client.next().unwrap();
    assert!(
        told.starts_with("error: there is no tree at ") && told.contains("trikfs mount"),
        "{told}"
    );
    assert!(robot.status().contains("NOT MOUNTED"));
    let mut telemetry = robot.client("telemetry");
    telemetry.send("data");
    assert!(
        telemetry
            .next()
            .unwrap()
            .starts_with("allData:AccelerometerPort:;")
    );
}

/// Doubles for some seconds, counts how often it is refused, and is bounded by itself: by depth and by time.
const BOMB: &str = "import os, time
end = time.time() + 4
refused = 0
print('go')
while time.time() < end:
    try:
        os.fork()
    except OSError:
        refused += 1
        if refused == 20:
            os.write(1, b'refused\\n')
        time.sleep(0.01)
time.sleep(1000)
";

#[test]
fn a_fork_bomb_of_another_user_is_held_by_the_kernel() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can start programs as another user");
    }
    // Each test has a user of its own: they count and kill all processes of it.
    let Ok(Some(user)) = nix::unistd::User::from_name("news") else {
        return harness::wait::note_skip("there is no user news");
    };
    let of_user = || trikd::program::kill::of_user(user.uid);
    let before = of_user();
    let home = crate::rig::small_tree();
    for name in ["scripts", "run"] {
        std::fs::create_dir_all(home.path(name)).unwrap();
    }
    let tree = home.path("tree");
    let robot = Robot::start(home, tree, &["--user", "news", "--processes", "20"]);
    let mut client = robot.client("control");
    run(&mut client, "bomb.py", BOMB);
    client.until("print: go\n");
    client.until("print: refused\n");
    let most = of_user() - before;
    assert!((2..=20).contains(&most), "{most} processes");
    // Others are served meanwhile, and a stop ends all of it.
    client.sync();
    client.send("stop");
    client.until("info: bomb.py was stopped by a client");
    eventually("nobody is left", || {
        processes::children(robot.daemon()).is_empty() && of_user() <= before
    });
    assert!(!robot.log().contains("cannot be killed"), "{}", robot.log());
}

#[test]
fn what_stops_motors_goes_before_programs() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    run(
        &mut client,
        "nice.py",
        "import os\nprint(os.getpriority(os.PRIO_PROCESS, 0))",
    );
    client.expect("print: 5\n");
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can go before others");
    }
    let nice_of = |name: &str| {
        let tasks = std::fs::read_dir(format!("/proc/{}/task", robot.daemon())).unwrap();
        let stats = tasks
            .filter_map(|task| std::fs::read_to_string(task.unwrap().path().join("stat")).ok());
        // proc(5): the name in brackets is field 2, nice is field 19.
        let of_name = stats
            .filter(|stat| stat.contains(&format!("({name})")))
            .filter_map(|stat| {
                stat.rsplit(')')
                    .next()?
                    .split_whitespace()
                    .nth(16)?
                    .parse()
                    .ok()
            });
        of_name.collect::<Vec<i32>>()
    };
    eventually("priorities", || {
        nice_of("rest") == [-20] && nice_of("keys") == [-20] && nice_of("trikd") == [-5]
    });
}

#[test]
fn what_programs_need_is_made_again_where_somebody_has_removed_it() {
    let robot = robot(&[]);
    std::fs::remove_dir_all(robot.home.path("run")).unwrap();
    let mut client = robot.client("control");
    run(
        &mut client,
        "a.py",
        "import os\nprint(brick.sensor(A1).read(), os.path.exists(os.environ['TRIKD']))",
    );
    client.expect("print: 27 True\n");
}

#[test]
fn the_status_answers_again_where_somebody_has_removed_its_socket() {
    let robot = robot(&[]);
    let run = robot.home.path("run");
    for _ in 0..2 {
        std::fs::remove_dir_all(&run).unwrap();
        eventually("a status", || robot.status().starts_with("trikd "));
        let mode = std::fs::metadata(run.join("status.sock"))
            .unwrap()
            .permissions();
        assert_eq!(mode.mode() & 0o777, 0o600);
    }
    // Nothing can be made there, which is told once.
    std::fs::remove_dir_all(&run).unwrap();
    std::fs::write(&run, "").unwrap();
    robot.expect_log("status.sock: `trikd status` has no answer, since this was removed: ");
    std::fs::remove_file(&run).unwrap();
    eventually("a status", || robot.status().starts_with("trikd "));
    assert_eq!(robot.log().matches("since this was removed").count(), 1);
}
