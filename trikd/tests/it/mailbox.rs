//! Several robots on one machine: joining, rings, equal hull numbers, memory.

use crate::rig::{Client, Robot, robot, small_tree};
use harness::eventually;
use std::net::TcpListener;

/// A program that asks the mailbox and prints what it hears.
fn talk(robot: &Robot, words: &str) -> Client {
    let mut client = robot.client("control");
    let text = format!("{words}\nprint('ready')\nwhile True: print('got', mailbox.receive())");
    client.send(&format!("file:talk.py:{text}"));
    client.send("run:talk.py");
    client.until("print: ready");
    // Python may take long to start for the next robot, and who says nothing for 5 s is gone.
    client.keep_alive();
    client
}

fn join(other: &Robot, hull: u32) -> String {
    format!(
        "mailbox.joinNetwork('127.0.0.1', {}, {hull})",
        other.port("mailbox")
    )
}

/// Whether this is what the robot's file says by now: it is written by a task that nobody waits for.
fn remembers(robot: &Robot, text: &str) -> bool {
    std::fs::read(robot.home.path("state/mailbox")).is_ok_and(|bytes| bytes == text.as_bytes())
}

#[test]
fn joining_is_answered_byte_for_byte() {
    let robot = robot(&[]);
    let (mut x, mut y) = (robot.client("mailbox"), robot.client("mailbox"));
    x.send("register:8895:7");
    x.expect("self:0");
    y.send("register:8896:9");
    y.expect("connection:127.0.0.1:8895:7");
    y.expect("self:0");
    x.expect("connection:127.0.0.1:8896:9");
    let mut control = robot.client("control");
    control.sync();
    x.send("data:a:b \u{43f}");
    control.expect("mail: sender: 7 contents: a:b \u{43f}");
    let mut stranger = robot.client("mailbox");
    for nonsense in [
        "register:1",
        "register:x:y",
        "connection:1:2",
        "self:x",
        "hello",
        "",
    ] {
        stranger.send(nonsense);
    }
    stranger.send("data:who am I");
    control.expect("mail: sender: -1 contents: who am I");
    stranger.send("version");
    stranger.expect("version: 3.1.4");
}

#[test]
fn three_robots_in_a_ring_hear_all_and_equal_hulls() {
    let robots = [robot(&[]), robot(&[]), robot(&[])];
    let mut a = talk(&robots[0], "mailbox.setHullNumber(1)");
    let mut b = talk(&robots[1], &join(&robots[0], 2));
    let mut c = talk(&robots[2], &join(&robots[1], 2));
    // Everybody knows both others, through whomever they have joined.
    for robot in &robots {
        eventually("two other robots", || {
            robot
                .status()
                .lines()
                .filter(|line| line.starts_with("robot "))
                .count()
                == 2
        });
    }
    let send = |robot: &Robot, to: &str, text: &str| {
        let mut x = robot.client("control");
        // Another program would end the one that listens, so this one goes on in its place.
        x.send(&format!("file:say.py:mailbox.send({to}'{text}')\nprint('ready')\nwhile True: print('got', mailbox.receive())"));
        x.send("run:say.py");
        x.until("print: ready");
    };
    send(&robots[0], "", "to all");
    b.until("print: got to all\n");
    c.until("print: got to all\n");
    send(&robots[0], "2, ", "to hull 2");
    b.until("print: got to hull 2\n");
    c.until("print: got to hull 2\n");
    send(&robots[2], "1, ", "back");
    a.until("print: got back\n");
}

#[test]
fn messages_that_come_before_the_program_are_not_lost() {
    let robot = robot(&[]);
    let mut other = robot.client("mailbox");
    other.send("register:8895:4");
    other.expect("self:0");
    other.send("data:early");
    other.sync();
    let mut client = talk(&robot, "");
    client.until("print: got early\n");
}

#[test]
fn hull_number_and_joined_robot_are_remembered() {
    let leader = robot(&[]);
    let first = robot(&[]);
    drop(talk(&first, &join(&leader, 5)));
    eventually("joined", || leader.status().contains(" hull 5 linked"));
    let remembered = format!(
        "hullNumber=5\nserver=127.0.0.1:{}\n",
        leader.port("mailbox")
    );
    eventually("remembered", || remembers(&first, &remembered));
    drop(first);
    let home = small_tree();
    std::fs::create_dir(home.path("state")).unwrap();
    home.file("state/mailbox", remembered);
    let tree = home.path("tree");
    let again = Robot::start(home, tree, &[]);
    eventually("joined again", || {
        leader
            .status()
            .contains(&format!(":{} hull 5 linked", again.port("mailbox")))
    });
    assert!(
        again.status().contains("mailbox hull 5"),
        "{}",
        again.status()
    );
}

#[test]
fn a_message_waits_for_the_next_program_until_a_stop() {
    let robot = robot(&[]);
    let mut mail = robot.client("mailbox");
    let mut client = robot.client("control");
    client.send("file:first.py:print('got', mailbox.receive())");
    client.send("file:second.py:script.wait(300)\nprint('got', mailbox.receive(False))");
    // Only those who are there hear of mail.
    client.sync();
    // Python may take longer to begin than a robot may be silent.
    mail.keep_alive();
    mail.send("register:8895:7");
    mail.send("data:one");
    client.until("mail: ");
    client.send("run:first.py");
    client.until("print: got one\n");
    client.until("info: first.py has ended");
    mail.send("data:two");
    client.until("mail: ");
    client.send("stop");
    client.send("run:second.py");
    let told = client.until("print: got");
    assert!(!told.contains("two"), "{told}");
}

#[test]
fn a_robot_is_connected_when_its_hull_number_is_known() {
    let robot = robot(&[]);
    let door = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = door.local_addr().expect("an address").port();
    let mut client = robot.client("control");
    client.keep_alive();
    client.send(&format!(
        "file:join.py:mailbox.joinNetwork('127.0.0.1', {port}, 5)\nprint('joined', mailbox.isConnected())\n\
         while not mailbox.isConnected(): script.wait(5)\nmailbox.send(7, 'hello')\nprint('sent')\n"
    ));
    client.send("run:join.py");
    client.until("print: joined False\n");
    let (peer, _) = door.accept().expect("the robot");
    let mut peer = Client::over(peer);
    peer.until("register:");
    peer.send("self:7");
    client.until("print: sent\n");
    peer.until("data:hello");
}

#[test]
fn robots_that_do_not_exist_keep_nobody_out() {
    let robot = robot(&[]);
    let mut liar = robot.client("mailbox");
    liar.send("register:2:1");
    liar.until("self:");
    for number in 0..400 {
        // Addresses that lead nowhere (RFC 5737).
        liar.send(&format!("connection:192.0.2.1:{}:5", 1000 + number));
    }
    liar.send("version");
    liar.until("version: ");
    let mut honest = robot.client("mailbox");
    honest.send("register:8895:7");
    honest.until("self:");
    let status = robot.status();
    assert!(
        status.contains("robot 127.0.0.1:8895 hull 7 linked\n"),
        "{status}"
    );
    let known = status
        .lines()
        .filter(|line| line.starts_with("robot "))
        .count();
    assert_eq!(known, 256, "{status}");
}

#[test]
fn behind_one_connection_is_one_robot() {
    let robot = robot(&[]);
    let mut liar = robot.client("mailbox");
    for number in 0..400 {
        liar.send(&format!("register:{}:1", 1 + number));
    }
    liar.until("self:");
    liar.sync();
    let status = robot.status();
    let known = |line: &&str| line.starts_with("robot ");
    assert_eq!(
        status.lines().filter(known).collect::<Vec<_>>(),
        ["robot 127.0.0.1:1 hull 1 linked"]
    );
}

#[test]
fn a_program_that_floods_the_mailbox_hangs_nobody() {
    let robot = robot(&[]);
    let daemon = robot.daemon();
    let mut client = robot.client("control");
    // The channel of the program, without waiting for answers.
    client.send(
        "file:flood.py:import os, stat, time\n\
         socket = next(fd for fd in range(3, 50) if stat.S_ISSOCK(os.fstat(fd).st_mode))\n\
         print('go')\n\
         end = time.monotonic() + 3\n\
         while time.monotonic() < end:\n    os.write(socket, b'14:mailbox:hull 114:mailbox:hull 2' * 100)\n\
         os.write(socket, b'14:mailbox:hull 3')\n\
         print('done')\n\
         time.sleep(1000)\n",
    );
    client.send("run:flood.py");
    client.until("print: go");
    robot.client("control").sync();
    client.until("print: done");
    eventually("the last number is heard", || {
        robot.status().contains("mailbox hull 3\n")
    });
    client.send("stop");
    client.until("info: flood.py was stopped");
    assert_eq!(robot.daemon(), daemon, "{}", robot.log());
    eventually("the last number is kept", || {
        remembers(&robot, "hullNumber=3\n")
    });
}
